//! Data files: tables of named columns and matrices of numbers, in text, whatever program wrote them.
//!
//! - Text is UTF-8 or UTF-16, with or without a byte order mark, with the line ends of any system. Empty lines and lines that begin
//!   with `#` are passed over.
//! - Cells are separated by commas, semicolons, tabs, vertical bars or blanks, which is found out; quotation marks may enclose a cell.
//! - Numbers have a decimal point, or a decimal comma where commas do not separate cells.
//! - A column is asked for by its names and its dimension, and comes in SI units. The header gives the unit: `time_s`, `Time [s]`,
//!   `time (ms)`, `Time / s`; or a row of units below it does. In names joined by `_` case does not matter: `mpa` is MPa.
//!
//! Every problem is shown at its place, all of a file at once.

pub(crate) mod grid;
mod text;

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::diagnostic::{Diagnostic, Diagnostics, Location, Problems, Source};
use super::document::{Located, cannot_read, read_limited};
use crate::quantity::{self, Dimension, QuantityError};
use text::{DELIMITERS, Lines};

/// Largest file read, bytes: a map of 4096 x 4096 points with 30 characters each.
pub const MAX_BYTES: usize = 512_000_000;

/// Units as they are written in lower case, behind the name of a column.
const SUFFIXES: [(&str, &str); 8] = [
    ("pa", "Pa"),
    ("kpa", "kPa"),
    ("mpa", "MPa"),
    ("gpa", "GPa"),
    ("n", "N"),
    ("kn", "kN"),
    ("hz", "Hz"),
    ("j", "J"),
];

/// A column that is looked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Column {
    /// Its names without unit, in lower case and joined by `_`.
    pub(crate) names: &'static [&'static str],
    pub(crate) dimension: Dimension,
    /// What it holds, in the plural: `times`.
    pub(crate) what: &'static str,
    /// Whether it may be without a unit, and is then in SI units.
    pub(crate) unit_may_be_absent: bool,
}

/// Times, of any table.
pub(crate) const TIME: Column = Column {
    names: &["time"],
    dimension: Dimension::Time,
    what: "times",
    unit_may_be_absent: true,
};

impl Column {
    /// A column that must have a unit.
    pub(crate) const fn new(
        names: &'static [&'static str],
        dimension: Dimension,
        what: &'static str,
    ) -> Self {
        Self {
            names,
            dimension,
            what,
            unit_may_be_absent: false,
        }
    }

    /// The name with its SI unit, as this program writes it: `creep_compliance_per_pa`.
    pub(crate) fn name_in_si(&self) -> String {
        let unit = self.dimension.si_unit().to_lowercase();
        let unit = match unit.strip_prefix("1/") {
            Some(divisor) => format!("per_{divisor}"),
            None => unit.replace('/', "_per_").replace(' ', "_"),
        };
        format!("{}_{unit}", self.names.first().unwrap_or(&""))
    }

    /// The unit that a cell of the header gives this column, if any; `None` where it names another column.
    fn unit_in(&self, cell: &str) -> Option<Option<String>> {
        let (name, unit) = split_unit(cell);
        let name = name.trim().replace([' ', '-'], "_");
        self.names.iter().find_map(|known| {
            let (head, rest) = name.split_at_checked(known.len())?;
            if !head.eq_ignore_ascii_case(known) {
                return None;
            }
            match (rest.strip_prefix('_'), unit) {
                (None, _) if rest.is_empty() => Some(unit.map(str::to_owned)),
                (Some(suffix), None) => unit_of_suffix(suffix, self.dimension).map(Some),
                _ => None,
            }
        })
    }
}

/// Name and unit in `Time [s]`, `Time (s)` and `Time / s`.
pub(crate) fn split_unit(cell: &str) -> (&str, Option<&str>) {
    let bracketed = [('[', ']'), ('(', ')')]
        .into_iter()
        .find_map(|(open, close)| cell.strip_suffix(close)?.rsplit_once(open));
    match bracketed.or_else(|| cell.rsplit_once(" / ")) {
        Some((name, unit)) => (name, Some(unit.trim())),
        None => (cell, None),
    }
}

/// The unit that `per_mpa`, `ms` or `rad_per_s` stand for, where it is one of this dimension.
pub(crate) fn unit_of_suffix(suffix: &str, dimension: Dimension) -> Option<String> {
    let spelt = |word: &str| {
        let lower = word.to_lowercase();
        let usual = SUFFIXES.iter().find(|(suffix, _)| *suffix == lower);
        usual.map_or(word.to_owned(), |(_, unit)| (*unit).to_owned())
    };
    let words = |text: &str| text.split('_').map(spelt).collect::<Vec<_>>().join(" ");
    let unit = |text: &str| words(text).replace("per ", "/").replace(" /", "/");
    let candidates = [unit(suffix), unit(&suffix.to_lowercase())];
    let unit = candidates
        .into_iter()
        .find(|unit| factor(unit, dimension).is_ok())?;
    Some(match unit.starts_with('/') {
        true => format!("1{unit}"),
        false => unit,
    })
}

/// What a number in this unit is multiplied by to be in SI units.
fn factor(unit: &str, dimension: Dimension) -> Result<f64, QuantityError> {
    quantity::parse(&format!("1 {unit}"), dimension)
}

/// The bytes of the file that a key names, and what messages call it. `None` where a problem was reported.
pub(super) fn named(
    file: &Located<String>,
    folder: &Path,
    problems: &Problems,
) -> Option<(String, Vec<u8>)> {
    let path = file.path_from(folder);
    let name = path.display().to_string();
    match read_limited(&path, MAX_BYTES) {
        Ok(bytes) => Some((name, bytes)),
        Err(error) => {
            problems
                .at(file, format!("cannot read `{name}`: {error}"))
                .help(file.path_rule());
            None
        }
    }
}

/// What was made of a data file; where it was refused, that is reported, with the place where the file is named.
pub(super) fn accepted<T>(
    made: Result<T, Diagnostics>,
    file: &Located<String>,
    problems: &Problems,
) -> Option<T> {
    made.map_err(|refused| problems.extend(refused.label_first(file, "the file is named here")))
        .ok()
}

/// The text of a data file.
pub(crate) struct DataFile {
    source: Arc<Source>,
}

impl DataFile {
    /// Opens a file.
    ///
    /// # Errors
    /// It cannot be read, or [`DataFile::from_bytes`] refuses it.
    pub(crate) fn read(path: &Path) -> Result<Self, Diagnostics> {
        let name = path.display().to_string();
        let bytes = read_limited(path, MAX_BYTES).map_err(|error| cannot_read(&name, &error))?;
        Self::from_bytes(&name, &bytes)
    }

    /// Takes the bytes of a file that messages call `name`.
    ///
    /// # Errors
    /// More than [`MAX_BYTES`], or no text.
    pub(crate) fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, Diagnostics> {
        if bytes.len() > MAX_BYTES {
            let message = format!("`{name}` is larger than {} MB", MAX_BYTES / 1_000_000);
            return Err(Diagnostic::new(message)
                .help("save fewer rows of a table, and a map as .npy or with fewer points")
                .into());
        }
        let source = Source::file(name, text::decode(name, bytes)?);
        Ok(Self { source })
    }

    /// Whether the header has one of these columns.
    pub(crate) fn has_any(&self, columns: &[Column]) -> bool {
        let header = self.header(columns);
        let cells = header.map(|header| header.texts()).unwrap_or_default();
        let is_wanted = |cell| columns.iter().any(|column| column.unit_in(cell).is_some());
        cells.into_iter().any(is_wanted)
    }

    /// Of each of these columns the first of its names that the header has, and that name alone; `None` where it has none.
    pub(crate) fn first_named(&self, columns: &[Column]) -> Vec<Option<Column>> {
        let header = self.header(columns);
        let cells = header.map(|header| header.texts()).unwrap_or_default();
        let first = |column: &Column| {
            let one_name = |place: usize| Column {
                names: &column.names[place..=place],
                ..*column
            };
            let mut names = (0..column.names.len()).map(one_name);
            names.find(|named| cells.iter().any(|cell| named.unit_in(cell).is_some()))
        };
        columns.iter().map(first).collect()
    }

    /// The columns asked for, in SI units. `without_number` says what to do about a cell that has none.
    ///
    /// # Errors
    /// No header, an absent column or two of it, an absent or wrong unit; rows of the wrong number of cells, cells that are no
    /// numbers; commas that may separate decimals or thousands.
    pub(crate) fn columns(
        &self,
        wanted: &[Column],
        without_number: &str,
    ) -> Result<Table, Diagnostics> {
        self.columns_read(wanted, without_number, false)
    }

    /// The same, where a cell may say that there is no number (empty, `NaN`, `NA`, a dash): it is read as a NaN.
    ///
    /// # Errors
    /// As [`DataFile::columns`].
    pub(crate) fn columns_with_holes(
        &self,
        wanted: &[Column],
        without_number: &str,
    ) -> Result<Table, Diagnostics> {
        self.columns_read(wanted, without_number, true)
    }

    fn columns_read(
        &self,
        wanted: &[Column],
        without_number: &str,
        may_have_holes: bool,
    ) -> Result<Table, Diagnostics> {
        let Some(header) = self.header(wanted) else {
            let names: Vec<String> = wanted.iter().map(Column::name_in_si).collect();
            let example = names.join(",");
            return Err(Diagnostic::at(&self.first_line(), "the table is empty")
                .help(format!("begin it with a line of column names: `{example}`"))
                .into());
        };
        let found: Vec<Found> = wanted
            .iter()
            .map(|column| header.find(column))
            .collect::<Result<_, _>>()?;
        let mut lines = header.after.clone();
        let units = header.units_row(&mut lines, &found);
        let mut rows = Rows::new(&header, found.iter().map(|found| found.place).collect());
        rows.may_have_holes = may_have_holes;
        rows.read(lines, without_number)?;
        let mut table = rows.table;
        for (which, ((column, found), unit)) in wanted.iter().zip(&found).zip(&units).enumerate() {
            let factor = header.factor(column, found, unit.as_ref())?;
            let values = table.values.iter_mut().skip(which);
            values
                .step_by(wanted.len())
                .for_each(|value| *value *= factor);
        }
        Ok(table)
    }

    /// All cells as numbers: a matrix without a header.
    ///
    /// # Errors
    /// Nothing but comments, rows of different length, cells that are no numbers.
    pub(crate) fn matrix(&self, without_number: &str) -> Result<Table, Diagnostics> {
        let is_numeric = |first: &Header<'_>| {
            let number = |cell: &&str| plain_number(cell, first.delimiter).is_some();
            usize::from(
                first
                    .texts()
                    .iter()
                    .all(|cell| cell.is_empty() || number(cell)),
            )
        };
        let Some(first) = self.first(is_numeric) else {
            let help = "give one line of numbers per row, or per point";
            return Err(self.no_numbers(help).into());
        };
        let mut rows = Rows::new(&first, (0..first.cells.len()).collect());
        rows.read(self.lines(), without_number)?;
        Ok(rows.table)
    }

    /// A problem of a file without numbers.
    pub(crate) fn no_numbers(&self, help: &str) -> Diagnostic {
        Diagnostic::at(&Location::whole(&self.source), "the file holds no numbers").help(help)
    }

    /// The first line, for messages.
    pub(crate) fn first_line(&self) -> Location {
        match self.lines().start() {
            Some(start) => line_at(&self.source, start),
            None => Location::whole(&self.source),
        }
    }

    fn lines(&self) -> Lines<'_> {
        Lines {
            text: self.source.text(),
            position: 0,
        }
    }

    /// The first line, cut by the delimiter that shows most of the columns.
    fn header(&self, wanted: &[Column]) -> Option<Header<'_>> {
        self.first(|header| {
            let cells = header.texts();
            let is_there = |c: &&Column| cells.iter().any(|cell| c.unit_in(cell).is_some());
            wanted.iter().filter(is_there).count()
        })
    }

    /// The first line, cut by the delimiter that does best; of equal ones the first that is there.
    fn first(&self, score: impl Fn(&Header<'_>) -> usize) -> Option<Header<'_>> {
        let start = self.lines().start()?;
        let cut = DELIMITERS.map(|(delimiter, _)| Header::new(&self.source, start, delimiter));
        cut.into_iter()
            .rev()
            .max_by_key(|line| (score(line), line.cells.len() > 1))
    }
}

/// A line cut into cells, the names of columns in most files.
struct Header<'a> {
    source: &'a Arc<Source>,
    delimiter: char,
    start: usize,
    cells: Vec<Range<usize>>,
    /// The lines below it.
    after: Lines<'a>,
}

/// A column that was found.
struct Found {
    place: usize,
    /// As the header gives it.
    unit: Option<String>,
}

impl<'a> Header<'a> {
    fn new(source: &'a Arc<Source>, start: usize, delimiter: char) -> Self {
        let (text, mut cells) = (source.text(), Vec::new());
        let position = text::cells_from(text, start, delimiter, &mut cells);
        Self {
            source,
            delimiter,
            start,
            cells,
            after: Lines { text, position },
        }
    }

    fn texts(&self) -> Vec<&'a str> {
        let text = self.source.text();
        self.cells.iter().map(|cell| &text[cell.clone()]).collect()
    }

    fn location(&self, place: usize) -> Location {
        Location::new(
            self.source,
            self.cells.get(place).cloned().unwrap_or_default(),
        )
    }

    /// The one column of these names.
    fn find(&self, column: &Column) -> Result<Found, Diagnostic> {
        let cells = self.texts().into_iter().enumerate();
        let mut found = cells.filter_map(|(place, cell)| {
            let unit = column.unit_in(cell)?;
            Some(Found { place, unit })
        });
        match (found.next(), found.next()) {
            (Some(found), None) => Ok(found),
            (None, _) => Err(self.missing(column)),
            (Some(first), Some(second)) => {
                let message = format!("the table has two columns of {}", column.what);
                Err(Diagnostic::at(&self.location(second.place), message)
                    .label(&self.location(first.place), "the other one")
                    .help("keep one of them"))
            }
        }
    }

    fn missing(&self, column: &Column) -> Diagnostic {
        let line = line_at(self.source, self.start);
        let name = column.name_in_si();
        let problem = Diagnostic::at(&line, format!("no column `{name}`"));
        if self
            .texts()
            .iter()
            .any(|cell| plain_number(cell, self.delimiter).is_some())
        {
            return problem
                .because("numbers")
                .help("begin the table with a line of column names");
        }
        let by = DELIMITERS
            .iter()
            .find(|(delimiter, _)| *delimiter == self.delimiter);
        let because = match (self.cells.len(), by) {
            (1, _) | (_, None) => "one column".to_owned(),
            (count, Some((_, by))) => format!("{count} columns, separated by {by}"),
        };
        let example = column.dimension.example();
        let unit = example.split_once(' ').map_or("", |(_, unit)| unit);
        problem.because(because).help(format!(
            "name the column of {} with its unit, such as `{name}` or `{} [{unit}]`",
            column.what,
            column.names.first().unwrap_or(&""),
        ))
    }

    /// The units of the columns in the line below, where that is a row of units; `lines` then stands behind it.
    fn units_row(&self, lines: &mut Lines<'_>, found: &[Found]) -> Vec<Option<(String, Location)>> {
        let (text, mut ahead, mut cells) = (self.source.text(), lines.clone(), Vec::new());
        ahead.cells(self.delimiter, &mut cells);
        let unit = |found: &Found| {
            let span = cells.get(found.place)?.clone();
            let unit = text[span.clone()].trim_matches(['[', ']', '(', ')', ' ']);
            Some((unit.to_owned(), Location::new(self.source, span)))
        };
        let units: Vec<Option<(String, Location)>> = found.iter().map(unit).collect();
        let is_unit = |unit: &str| {
            let read = factor(unit, Dimension::Time);
            matches!(read, Ok(_) | Err(QuantityError::WrongDimension { .. }))
        };
        let some = || units.iter().flatten().map(|(unit, _)| unit.as_str());
        let is_row = some().any(is_unit) && !some().any(|unit| unit.parse::<f64>().is_ok());
        if !is_row || cells.len() != self.cells.len() {
            return found.iter().map(|_| None).collect();
        }
        *lines = ahead;
        let is_given = |unit: &(String, Location)| !["", "-"].contains(&unit.0.as_str());
        units
            .into_iter()
            .map(|unit| unit.filter(is_given))
            .collect()
    }

    /// What the numbers of a column are multiplied by.
    fn factor(
        &self,
        column: &Column,
        found: &Found,
        below: Option<&(String, Location)>,
    ) -> Result<f64, Diagnostic> {
        let name = self.location(found.place);
        let read = |unit: &str, place: &Location| {
            factor(unit, column.dimension).map_err(|error| {
                let message = format!("`{unit}` is no unit of the column of {}", column.what);
                Diagnostic::at(place, message).because(error.to_string())
            })
        };
        match (found.unit.as_deref(), below) {
            (Some(unit), None) => read(unit, &name),
            (None, Some((unit, place))) => read(unit, place),
            (Some(above), Some((unit, place))) => {
                let (factor, other) = (read(above, &name)?, read(unit, place)?);
                match factor == other {
                    true => Ok(factor),
                    false => Err(Diagnostic::at(place, "the header gives another unit")
                        .label(&name, "this one")
                        .help("keep one of the two")),
                }
            }
            (None, None) if column.unit_may_be_absent => Ok(1.0),
            (None, None) => {
                let message = format!("the column of {} has no unit", column.what);
                let written = name.text();
                let si = column.dimension.si_unit();
                Err(Diagnostic::at(&name, message).help(format!("write `{written} [{si}]`")))
            }
        }
    }
}

/// Numbers in rows, every one with its place.
pub(crate) struct Table {
    source: Arc<Source>,
    delimiter: char,
    /// Place in a line of every column.
    places: Vec<usize>,
    /// Row by row.
    pub(crate) values: Vec<f64>,
    /// Where the lines begin.
    starts: Vec<usize>,
}

impl Table {
    /// Numbers in a row.
    pub(crate) fn width(&self) -> usize {
        self.places.len()
    }

    /// Rows.
    pub(crate) fn len(&self) -> usize {
        self.starts.len()
    }

    /// One column, by its place among those asked for.
    pub(crate) fn column(&self, which: usize) -> Vec<f64> {
        let column = self.values.iter().skip(which).step_by(self.width());
        column.copied().collect()
    }

    /// The line of a row.
    pub(crate) fn row(&self, row: usize) -> Location {
        match self.starts.get(row) {
            Some(start) => line_at(&self.source, *start),
            None => Location::whole(&self.source),
        }
    }

    /// The cell of a row in one of the columns.
    pub(crate) fn cell(&self, row: usize, which: usize) -> Location {
        let (Some(start), Some(place)) = (self.starts.get(row), self.places.get(which)) else {
            return Location::whole(&self.source);
        };
        let mut cells = Vec::new();
        text::cells_from(self.source.text(), *start, self.delimiter, &mut cells);
        Location::new(&self.source, cells.get(*place).cloned().unwrap_or_default())
    }

    /// The file as a whole.
    pub(crate) fn whole(&self) -> Location {
        Location::whole(&self.source)
    }
}

/// The line that begins at `start`.
fn line_at(source: &Arc<Source>, start: usize) -> Location {
    let rest = source.text().get(start..).unwrap_or_default();
    let line = rest.split('\n').next().unwrap_or_default();
    Location::new(source, start..start + line.trim_end().len())
}

/// Reads rows, and remembers how their numbers separate decimals.
struct Rows<'a> {
    header: &'a Header<'a>,
    table: Table,
    problems: Problems,
    signs: DecimalSigns,
    /// Whether a cell without a number is read as a NaN.
    may_have_holes: bool,
}

impl<'a> Rows<'a> {
    fn new(header: &'a Header<'a>, places: Vec<usize>) -> Self {
        let table = Table {
            source: Arc::clone(header.source),
            delimiter: header.delimiter,
            places,
            values: Vec::new(),
            starts: Vec::new(),
        };
        Self {
            header,
            table,
            problems: Problems::new(),
            signs: DecimalSigns::default(),
            may_have_holes: false,
        }
    }

    fn read(&mut self, mut lines: Lines<'_>, without_number: &str) -> Result<(), Diagnostics> {
        let (text, expected) = (lines.text, self.header.cells.len());
        let mut cells = Vec::with_capacity(expected);
        while let Some(start) = lines.cells(self.header.delimiter, &mut cells) {
            if cells.len() != expected {
                let found = cells.len();
                let s = if found == 1 { "" } else { "s" };
                self.problems
                    .at(
                        &line_at(self.header.source, start),
                        format!("a row of {found} cell{s} in a table of {expected} columns"),
                    )
                    .help(
                        "give every row one cell per column; where commas separate cells, numbers have a decimal point",
                    );
                continue;
            }
            self.table.starts.push(start);
            for which in 0..self.table.places.len() {
                let span = cells[self.table.places[which]].clone();
                match self.number(&text[span.clone()], &span) {
                    Ok(number) => self.table.values.push(number),
                    Err(why) => self.no_number(which, span, why, without_number),
                }
            }
        }
        self.signs.check(self.header.source, &self.problems);
        std::mem::take(&mut self.problems).into_result(Some(()))
    }

    /// The number in a cell, or why there is none.
    fn number(&mut self, cell: &str, span: &Range<usize>) -> Result<f64, &'static str> {
        let delimiter = self.header.delimiter;
        if self.may_have_holes && is_hole(cell) {
            return Ok(f64::NAN);
        }
        let number = match plain_number(cell, delimiter) {
            Some(number) => number,
            None if cell.is_empty() => return Err("empty"),
            None => return Err("not a number"),
        };
        if delimiter != ',' {
            self.signs.see(cell, span);
        }
        match number.is_finite() {
            true => Ok(number),
            false => Err("not a finite number"),
        }
    }

    fn no_number(&self, which: usize, span: Range<usize>, why: &str, without_number: &str) {
        let place = self.table.places[which];
        let cell = Location::new(self.header.source, span);
        // In a matrix the first line is one of numbers.
        let column = match self.table.starts.first() == Some(&self.header.start) {
            true => format!("column {}", place + 1),
            false => format!("the column `{}`", self.header.location(place).text()),
        };
        let message = format!("a cell of {column} must be a number");
        self.problems
            .at(&cell, message)
            .because(why)
            .help(without_number);
    }
}

/// How the numbers of a file separate decimals.
#[derive(Debug, Default)]
struct DecimalSigns {
    /// The first number with a decimal point, where a comma could stand for it.
    point: Option<Range<usize>>,
    /// The first number with a comma.
    comma: Option<Range<usize>>,
    /// Whether some comma separates no thousands.
    is_decimal: bool,
}

impl DecimalSigns {
    fn see(&mut self, cell: &str, span: &Range<usize>) {
        if self.point.is_none() && cell.contains('.') {
            self.point = Some(span.clone());
        }
        if !self.is_decimal && cell.contains(',') {
            self.comma.get_or_insert_with(|| span.clone());
            self.is_decimal = !is_like_thousands(cell);
        }
    }

    /// Commas must separate decimals, and do it everywhere.
    fn check(&self, source: &Arc<Source>, problems: &Problems) {
        let Some(comma) = &self.comma else {
            return;
        };
        let comma = Location::new(source, comma.clone());
        if let Some(point) = &self.point {
            problems
                .at(&comma, "a decimal comma in a file with decimal points")
                .label(&Location::new(source, point.clone()), "a decimal point")
                .help("write decimal points, and nothing between thousands");
        } else if !self.is_decimal {
            let (point, none) = (
                comma.text().replace(',', "."),
                comma.text().replace(',', ""),
            );
            problems
                .at(&comma, "this comma may separate decimals or thousands")
                .help(format!("write `{point}` or `{none}`"));
        }
    }
}

/// A number with a decimal point, or with a decimal comma where commas do not separate cells.
fn plain_number(cell: &str, delimiter: char) -> Option<f64> {
    let with_comma = || match delimiter {
        ',' => None,
        _ => cell.replacen(',', ".", 1).parse().ok(),
    };
    cell.parse().ok().or_else(with_comma)
}

/// Whether a cell says that there is no number.
fn is_hole(cell: &str) -> bool {
    let words = ["nan", "na", "n/a", "-", "--", "---"];
    cell.is_empty() || words.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// Whether a number with a comma could be an integer with its thousands apart: `1,234`.
fn is_like_thousands(number: &str) -> bool {
    let number = number.trim_start_matches(['+', '-']);
    number.split_once(',').is_some_and(|(before, after)| {
        (1..=3).contains(&before.len())
            && !before.starts_with('0')
            && after.len() == 3
            && after.bytes().all(|byte| byte.is_ascii_digit())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MODULUS: Column = Column::new(&["e'", "storage_modulus"], Dimension::Stress, "moduli");
    const FREQUENCY: Column = Column::new(&["f", "frequency"], Dimension::Frequency, "frequencies");

    fn read(text: &str) -> Result<Vec<[f64; 2]>, String> {
        let file = DataFile::from_bytes("dma.txt", text.as_bytes());
        let table = file.and_then(|file| file.columns(&[FREQUENCY, MODULUS], "leave it out"));
        let table = table.map_err(|refused| refused.to_string())?;
        Ok(table.values.chunks(2).map(|row| [row[0], row[1]]).collect())
    }

    #[test]
    fn one_table_in_every_dialect_is_the_same() {
        for text in [
            "frequency_hz,storage_modulus_mpa\n0.5,1\n1e3,2.5\n",
            "Frequency [Hz];E' [MPa]\n0,5;1\n1e3;2,5\n",
            "Frequency / Hz\tStorage modulus / MPa\tRemark\n0.5\t1\tx\n1000\t2.5\t\n",
            "f (mHz) | T (C) | E' (kPa)\n500 | 20 | 1000\n1e6 | 20 | 2500\n",
            "# NREL\nf,E',T\nHz, MPa, C\n0.5,1,-\n1000,2.5,-\n",
            "  f      E'  \n  [Hz]   [MPa]\n  0.5    1\n  1000   2.5\n",
            "\"Frequency\",\"Storage modulus\"\n\"Hz\",\"MPa\"\n\"0.5\",\"1\"\n\"1000\",\"2.5\"\n",
        ] {
            let ends = ["\n", "\r\n", "\r"].map(|end| text.replace('\n', end));
            for text in ends {
                assert_eq!(
                    read(&text).unwrap(),
                    [[0.5, 1e6], [1000.0, 2.5e6]],
                    "{text}"
                );
            }
        }
    }

    #[test]
    fn a_name_with_its_unit_is_taken_apart() {
        for (cell, unit) in [
            ("storage_modulus_pa", Some(Some("Pa"))),
            ("Storage_Modulus_MPA", Some(Some("MPa"))),
            ("storage modulus (mPa)", Some(Some("mPa"))),
            ("Storage-Modulus[N/mm^2]", Some(Some("N/mm^2"))),
            ("E' / GPa", Some(Some("GPa"))),
            ("E'", Some(None)),
            ("E''", None),
            ("storage_modulus_error", None),
            ("storage_modulus_s", None),
            ("modulus", None),
        ] {
            let found = MODULUS.unit_in(cell);
            let found = found.as_ref().map(|unit| unit.as_deref());
            assert_eq!(found, unit, "{cell}");
        }
        let compliance = Column::new(&["d"], Dimension::Compliance, "values");
        assert_eq!(compliance.name_in_si(), "d_per_pa");
        assert_eq!(
            compliance.unit_in("D_per_GPa"),
            Some(Some("1/GPa".to_owned()))
        );
        let rate = Column::new(&["w"], Dimension::AngularFrequency, "frequencies");
        assert_eq!(rate.name_in_si(), "w_rad_per_s");
        assert_eq!(rate.unit_in("w_rad_per_s"), Some(Some("rad/s".to_owned())));
    }

    #[test]
    fn what_is_ambiguous_or_wrong_is_refused_at_its_place() {
        for (text, place, reason) in [
            (
                "f,E'\n1,2\n",
                "1:1",
                "the column of frequencies has no unit",
            ),
            ("f [Hz],E' [psi]\n1,2\n", "1:8", "1 psi is 6894.7573 Pa"),
            (
                "f,E'\nHz,s\n1,2\n",
                "2:4",
                "`s` is no unit of the column of moduli",
            ),
            (
                "f [Hz],E'\nkHz,MPa\n1,2\n",
                "2:1",
                "the header gives another unit",
            ),
            (
                "f_hz;E' [Pa]\n1,5;2.5\n",
                "2:1",
                "a decimal comma in a file with decimal points",
            ),
            (
                "f_hz;E' [Pa]\n1;2,500\n3;4\n",
                "2:3",
                "may separate decimals or thousands",
            ),
            ("f_hz;E' [Pa]\n1;1.234,5\n", "2:3", "not a number"),
            ("f_hz;E' [Pa]\n1;1,234,567\n", "2:3", "not a number"),
            (
                "f_hz,E' [Pa]\n1,2,5\n",
                "2:1",
                "a row of 3 cells in a table of 2 columns",
            ),
            (
                "w_hz,E' [Pa]\n1,2\n",
                "1:1",
                "2 columns, separated by commas",
            ),
        ] {
            let refused = read(text).unwrap_err();
            let words = refused.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains(&format!("dma.txt:{place}")), "{refused}");
            assert!(words.contains(reason), "{refused}");
        }
        // Where one comma separates no thousands, none does.
        assert_eq!(read("f_hz;E' [Pa]\n0,25;2,500\n").unwrap(), [[0.25, 2.5]]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn any_text_is_read_or_refused_but_never_panics(
            pieces in prop::collection::vec(
                prop::sample::select(vec![
                    "f", "E'", "f_hz", "E' [MPa]", "[", "]", " / ", "Hz", "MPa", ",", ";", "\t", "|", " ", "\n", "\r\n", "\r",
                    "\"", "\"\"", "1", "2,5", "1,234", "2e3", "-1", "NaN", "1e999", "#", "µ", "\u{feff}", "\0", "f_hz;E' [Pa]\n1;2\n",
                ]),
                0..40,
            ),
        ) {
            let text = pieces.concat();
            if let Err(refused) = read(&text) {
                prop_assert!(refused.contains("dma.txt"), "{}", refused);
            }
            if let Ok(matrix) = DataFile::from_bytes("a", text.as_bytes()).and_then(|file| file.matrix("")) {
                prop_assert_eq!(matrix.values.len(), matrix.len() * matrix.width());
                prop_assert!(matrix.values.iter().all(|value| value.is_finite()));
            }
        }
    }
}
