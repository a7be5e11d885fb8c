//! Data files: tables of named columns and matrices of numbers, in text, whatever program wrote them.
//!
//! - Text is UTF-8 or UTF-16, with or without a byte order mark, with the line ends of any system. Empty lines and lines that begin
//!   with `#` are passed over.
//! - Cells are separated by commas, semicolons, tabs, vertical bars or blanks, which is found out; quotation marks may enclose a cell.
//! - Numbers have a decimal point, or a decimal comma where commas do not separate cells. There, where one of them has both signs
//!   (`1.000,5`) or one of them twice, the other sign or this one groups thousands in all.
//! - A cell may say that its number is missing. In tables of what was measured its row is passed over or the cell left out; a table
//!   that prescribes something is refused.
//! - A column is asked for by its names and its dimension, and comes in SI units. The header gives the unit: `time_s`, `Time [s]`,
//!   `time (ms)`, `Time / s`; or a row of units below it does. In names joined by `_` case does not matter: `mpa` is MPa.
//!
//! Every problem is shown at its place, all of a file at once.

pub(crate) mod grid;
mod header;
mod rows;
mod text;

use std::path::Path;
use std::sync::Arc;

use super::diagnostic::{Diagnostic, Diagnostics, Location, Problems, Source};
use super::document::{Located, cannot_read, read_limited};
use crate::quantity::{self, Dimension, QuantityError};
use header::{Found, Header};
pub(crate) use rows::Table;
use rows::{Holes, Rows, line_at, plain_number};
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

    /// Whether a name of one letter stands for this column: with a unit, by its dimension, and `t` without one is no `T`.
    fn is_symbol(&self, name: &str, unit: Option<&str>) -> bool {
        match unit {
            Some(unit) => factor(unit, self.dimension).is_ok(),
            None => self.dimension != Dimension::Time || name == "t",
        }
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
                // `T (°C)` and `D (mm)` are symbols of something else, and so is `T` alone.
                (None, _) if rest.is_empty() && known.len() == 1 && !self.is_symbol(head, unit) => {
                    None
                }
                (None, _) if rest.is_empty() => Some(unit.map(str::to_owned)),
                (Some(suffix), None) => unit_of_suffix(suffix, self.dimension).map(Some),
                _ => None,
            }
        })
    }
}

/// Name and unit in `Time [s]`, `Time (s)` and `Time / s`; the argument of `E(t)` is no unit.
pub(crate) fn split_unit(cell: &str) -> (&str, Option<&str>) {
    let bracketed = [('[', ']'), ('(', ')')]
        .into_iter()
        .find_map(|(open, close)| cell.strip_suffix(close)?.rsplit_once(open))
        .filter(|(_, unit)| *unit != "t");
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

/// What is made of the file that a key names, from what messages call it and its bytes. `None` where a problem was reported.
pub(super) fn made_of<T>(
    file: &Located<String>,
    folder: &Path,
    problems: &Problems,
    make: impl FnOnce(&str, &[u8]) -> Result<T, Diagnostics>,
) -> Option<T> {
    let (name, bytes) = named(file, folder, problems)?;
    accepted(make(&name, &bytes), file, problems)
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

    /// The headings that name one of these columns, and all others, each in the order of the table; without those that are empty.
    pub(crate) fn headings(&self, wanted: &[Column]) -> (Vec<String>, Vec<String>) {
        let header = self.header(wanted);
        let cells = header.map(|header| header.texts()).unwrap_or_default();
        let is_wanted = |cell: &str| wanted.iter().any(|column| column.unit_in(cell).is_some());
        let named = cells
            .into_iter()
            .map(str::trim)
            .filter(|cell| !cell.is_empty());
        named.map(str::to_owned).partition(|cell| is_wanted(cell))
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
        self.columns_read(wanted, without_number, Holes::Refused)
    }

    /// The same of what was measured: a row in which one of these numbers is missing (empty, `NaN`, `NA`, a dash) is passed over.
    ///
    /// # Errors
    /// As [`DataFile::columns`].
    pub(crate) fn columns_of_whole_rows(
        &self,
        wanted: &[Column],
        without_number: &str,
    ) -> Result<Table, Diagnostics> {
        self.columns_read(wanted, without_number, Holes::PassedOver)
    }

    /// The same where the other numbers of such a row count: the missing one is read as a NaN.
    ///
    /// # Errors
    /// As [`DataFile::columns`].
    pub(crate) fn columns_with_holes(
        &self,
        wanted: &[Column],
        without_number: &str,
    ) -> Result<Table, Diagnostics> {
        self.columns_read(wanted, without_number, Holes::Kept)
    }

    fn columns_read(
        &self,
        wanted: &[Column],
        without_number: &str,
        holes: Holes,
    ) -> Result<Table, Diagnostics> {
        let Some(header) = self.header(wanted) else {
            let names: Vec<String> = wanted.iter().map(Column::name_in_si).collect();
            let example = names.join(",");
            return Err(Diagnostic::at(&self.first_line(), "the table is empty")
                .help(format!("begin it with a line of column names: `{example}`"))
                .into());
        };
        let found = wanted.iter().map(|column| header.find(column));
        let found: Vec<Found> = found.collect::<Result<_, _>>()?;
        let mut lines = header.after.clone();
        let units = header.units_row(&mut lines, &found);
        let places = found.iter().map(|found| found.place).collect();
        let mut rows = Rows::new(&header, places, holes);
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
            let number = |cell: &str| plain_number(cell, first.delimiter).is_some();
            let mut cells = first.texts().into_iter();
            usize::from(cells.all(|cell| cell.is_empty() || number(cell)))
        };
        let Some(first) = self.first(is_numeric) else {
            let help = "give one line of numbers per row, or per point";
            return Err(self.no_numbers(help).into());
        };
        let mut rows = Rows::new(&first, (0..first.cells.len()).collect(), Holes::Refused);
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
        let cut = cut.into_iter().rev();
        cut.max_by_key(|line| (score(line), line.cells.len() > 1))
    }
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
            ("f_hz;E' [Pa]\n1;1.23,4,5\n", "2:3", "not a number"),
            (
                "f_hz;E' [Pa]\n1;1.234,5\n2;2.5\n",
                "3:3",
                "not a number where thousands are grouped",
            ),
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
        // A number with both signs, or with one of them twice, tells which one groups thousands.
        let grouped = read("f_hz;E' [Pa]\n0,25;1.234,5\n1.000;2.500\n").unwrap();
        assert_eq!(grouped, [[0.25, 1234.5], [1000.0, 2500.0]]);
        let grouped = read("f_hz;E' [Pa]\n0.25;1,234,567\n").unwrap();
        assert_eq!(grouped, [[0.25, 1_234_567.0]]);
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
