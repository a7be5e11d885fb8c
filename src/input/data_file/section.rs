//! One table of a grid: the names of its columns, their units and its rows, read as numbers in SI units with their places.

use std::ops::Range;
use std::sync::Arc;

use super::column::{self, Column};
use super::grid::{Grid, Line, line_at};
use super::numbers::{self, Cell, Numbers};
use super::units::{self, Scale};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems, Source};

/// What is made of a cell that is empty or says that there is no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Holes {
    /// An error: what prescribes something has no holes.
    Refused,
    /// The row is passed over, and counted.
    PassedOver,
    /// A NaN.
    Kept,
}

/// Where one table of a grid stands.
pub(crate) struct Section<'a> {
    pub(crate) grid: &'a Grid,
    pub(crate) header: Line<'a>,
    has_names: bool,
    /// The row of units.
    pub(crate) units: Option<Line<'a>>,
    /// Lines of numbers.
    pub(crate) rows: Range<usize>,
    /// Of these, those that are passed over, ascending.
    pub(crate) skipped: Vec<usize>,
    /// Whether an instrument wrote it: rows may be shorter or longer than the header.
    pub(crate) by_instrument: bool,
}

/// A column that is read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Asked {
    /// Its place in a row.
    pub(crate) place: usize,
    pub(crate) scale: Scale,
    /// What it holds, in the plural; where the table has no names, that is what messages call it.
    pub(crate) what: &'static str,
}

impl<'a> Section<'a> {
    /// The table whose header is this line: the rows down to `end`, the first of which may be one of units. `is_known` says which
    /// columns are known by their names.
    pub(crate) fn new(
        grid: &'a Grid,
        header: usize,
        end: usize,
        is_known: impl Fn(usize) -> bool,
    ) -> Self {
        let names = grid.header(header);
        let below = grid.line(header + 1).aligned(names.len());
        let mut known = (0..below.len()).filter(|place| is_known(*place));
        let has_units = header + 1 < end
            && grid.is_comment(header + 1) <= grid.is_comment(header)
            && known.clone().any(|place| units::is_unit(below.text(place)))
            && !known.any(|place| below.is_number(place));
        Self {
            grid,
            header: names,
            has_names: true,
            units: has_units.then_some(below),
            rows: header + 1 + usize::from(has_units)..end,
            skipped: Vec::new(),
            by_instrument: false,
        }
    }

    /// The same of a table down to the end, of which these columns are wanted.
    pub(crate) fn of(grid: &'a Grid, header: usize, wanted: &[Column]) -> Self {
        let names = grid.header(header);
        Self::new(grid, header, grid.len(), |place| {
            let ways = column::ways(names.text(place));
            wanted.iter().any(|column| column.named(&ways).is_some())
        })
    }

    /// Rows of numbers without names, from this line on.
    pub(crate) fn without_names(grid: &'a Grid, first: usize) -> Self {
        Self {
            header: grid.line(first),
            has_names: false,
            rows: first..grid.len(),
            ..Self::new(grid, first, grid.len(), |_| false)
        }
    }

    /// The columns asked for, in SI units.
    ///
    /// # Errors
    /// An absent column or two of it, an absent or wrong unit, or what [`Section::read`] reports.
    pub(crate) fn table(
        &self,
        wanted: &[Column],
        holes: Holes,
        without_number: &str,
    ) -> Result<Table, Diagnostics> {
        let found = wanted.iter().map(|column| column.found(self));
        let found = found.collect::<Result<Vec<_>, _>>()?.into_iter();
        let asked = wanted.iter().zip(found).map(|(column, found)| {
            let asked = found.map(|(place, unit)| self.asked(column, place, unit.as_deref()));
            asked.transpose()
        });
        let asked: Vec<Option<Asked>> = asked.collect::<Result<_, _>>()?;
        let problems = Problems::new();
        let table = self.read(&asked, holes, without_number, &problems);
        problems.into_result(Some(table))
    }

    /// What is read of a column, whose name gives the unit `above`, or none.
    ///
    /// # Errors
    /// No unit, one that cannot be read, another one below the name.
    pub(crate) fn asked(
        &self,
        column: &Column,
        place: usize,
        above: Option<&str>,
    ) -> Result<Asked, Diagnostic> {
        let (what, name) = (column.what, self.header.place(place));
        let below = self.units.as_ref();
        let below = below.and_then(|row| Some((units::given(row.text(place))?, row.place(place))));
        let scale = |unit: Option<&str>| column.scale(self.header.text(place), unit);
        let read_at = |unit: &str, at: &Location| {
            scale(Some(unit)).map_err(|why| {
                Diagnostic::at(at, format!("`{unit}` is no unit of the column of {what}"))
                    .because(why)
            })
        };
        let scale = match (above.and_then(units::given), below) {
            (Some(unit), None) => read_at(unit, &name)?,
            (None, Some((unit, at))) => read_at(unit, &at)?,
            (Some(above), Some((below, at))) => {
                let scale = read_at(above, &name)?;
                if scale != read_at(below, &at)? {
                    return Err(Diagnostic::at(&at, "the header gives another unit")
                        .label(&name, "this one")
                        .help("keep one of the two"));
                }
                scale
            }
            (None, None) => scale(None).map_err(|help| {
                Diagnostic::at(&name, format!("the column of {what} has no unit")).help(help)
            })?,
        };
        Ok(Asked { place, scale, what })
    }

    /// Two columns where one is meant.
    pub(crate) fn twice(&self, [first, second]: [usize; 2], what: &str) -> Diagnostic {
        let message = format!("the table has two columns of {what}");
        Diagnostic::at(&self.header.place(second), message)
            .label(&self.header.place(first), "the other one")
            .help("keep one of them")
    }

    /// The rows in SI units, but for those with problems, which are reported: rows of the wrong number of cells, cells that are no
    /// numbers, commas that may separate decimals or thousands. `without_number` says what to do about a cell that has no number.
    /// The numbers of a column that is not there are NaN.
    pub(crate) fn read(
        &self,
        asked: &[Option<Asked>],
        holes: Holes,
        without_number: &str,
        problems: &Problems,
    ) -> Table {
        let mut numbers = self.numbers(asked);
        let mut table = Table {
            source: Arc::clone(&self.grid.source),
            delimiter: self.grid.delimiter(),
            columns: self.header.len(),
            places: asked
                .iter()
                .map(|column| Some(column.as_ref()?.place))
                .collect(),
            values: Vec::new(),
            starts: Vec::new(),
            passed_over: Vec::new(),
        };
        let mut number = |row: &Line<'_>, column: &Asked| {
            let why = match numbers.read(row, column.place) {
                Cell::Number(number) => return Some(column.scale.of(number)),
                Cell::Missing if holes == Holes::Kept => return Some(f64::NAN),
                Cell::Missing => numbers::why_missing(row.text(column.place)),
                Cell::Bad(why) => why,
            };
            let message = format!("a cell of {} must be a number", self.called(column));
            let report = problems.at(&row.place(column.place), message);
            report.because(why).help(without_number);
            None
        };
        for line in self.lines() {
            let row = self.row(line);
            let mut cells = table.places.iter().flatten().map(|place| row.text(*place));
            if self.is_ragged(&row) {
                self.report_ragged(line, &row, problems);
            } else if holes == Holes::PassedOver && cells.any(numbers::is_hole) {
                table.passed_over.push(table.starts.len());
            } else {
                let before = table.values.len();
                let read = |column: &Option<Asked>| match column {
                    Some(column) => number(&row, column),
                    None => Some(f64::NAN),
                };
                table.values.extend(asked.iter().filter_map(read));
                match table.values.len() == before + asked.len() {
                    true => table.starts.push(self.grid.start(line)),
                    false => table.values.truncate(before),
                }
            }
        }
        numbers.check(&table.source, problems);
        table
    }

    /// Lines that are read.
    fn lines(&self) -> impl Iterator<Item = usize> + '_ {
        let is_read = |line: &usize| {
            !self.grid.is_comment(*line) && self.skipped.binary_search(line).is_err()
        };
        self.rows.clone().filter(is_read)
    }

    fn row(&self, line: usize) -> Line<'a> {
        self.grid.line(line).aligned(self.header.len())
    }

    /// Thousands may be grouped where there are commas that do not separate cells.
    fn numbers(&self, asked: &[Option<Asked>]) -> Numbers {
        let text = self.grid.source.text();
        if !text.contains(',') || (self.grid.delimiter() == ',' && !text.contains('"')) {
            return Numbers::default();
        }
        let cells = self.lines().flat_map(|line| {
            let row = self.row(line);
            let cells = asked.iter().flatten().map(|column| row.text(column.place));
            cells.collect::<Vec<_>>()
        });
        Numbers::like(cells)
    }

    fn is_ragged(&self, row: &Line<'_>) -> bool {
        let (found, expected) = (row.len(), self.header.len());
        let is_empty = |cell: usize| row.text(cell).is_empty();
        !self.by_instrument && (found < expected || !(expected..found).all(is_empty))
    }

    fn report_ragged(&self, line: usize, row: &Line<'_>, problems: &Problems) {
        let (found, expected) = (row.len(), self.header.len());
        let s = if found == 1 { "" } else { "s" };
        let message = format!("a row of {found} cell{s} in a table of {expected} columns");
        problems.at(&self.grid.place(line), message).help(
            "give every row one cell per column; where commas separate cells, numbers have a decimal point",
        );
    }

    /// What messages call a column.
    fn called(&self, column: &Asked) -> String {
        match self.has_names {
            true => format!("the column `{}`", self.header.text(column.place)),
            false if column.what.is_empty() => format!("column {}", column.place + 1),
            false => format!("the column of {}", column.what),
        }
    }
}

/// Numbers in rows, every one with its place.
pub(crate) struct Table {
    source: Arc<Source>,
    delimiter: char,
    /// Cells of the header.
    columns: usize,
    /// Place in a line of every column that was asked for, where the table has it.
    places: Vec<Option<usize>>,
    /// Row by row.
    pub(crate) values: Vec<f64>,
    /// Where the lines begin.
    starts: Vec<usize>,
    /// Of every row that was passed over, since one of its numbers is missing, how many rows were read before it.
    passed_over: Vec<usize>,
}

impl Table {
    /// Numbers in a row.
    pub(crate) fn width(&self) -> usize {
        self.places.len()
    }

    /// Whether the table has one of the columns, by its place among those asked for.
    pub(crate) fn has(&self, which: usize) -> bool {
        self.places.get(which).is_some_and(Option::is_some)
    }

    /// The number of a row in one of the columns; `None` where there is none.
    pub(crate) fn number(&self, row: usize, which: usize) -> Option<f64> {
        let value = self.values.get(row * self.width() + which).copied();
        value.filter(|value| !value.is_nan())
    }

    /// Rows.
    pub(crate) fn len(&self) -> usize {
        self.starts.len()
    }

    /// Rows that were passed over.
    pub(crate) fn passed_over(&self) -> usize {
        self.passed_over.len()
    }

    /// The number of a row in the file, from 1, those that were passed over included.
    pub(crate) fn number_of(&self, row: usize) -> usize {
        row + 1 + self.passed_over.partition_point(|before| *before <= row)
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
            None => self.whole(),
        }
    }

    /// The cells of a row, those of columns that were not asked for too.
    pub(crate) fn line(&self, row: usize) -> Line<'_> {
        let end = self.source.text().len();
        let start = self.starts.get(row).copied().unwrap_or(end);
        Line::cut(&self.source, self.delimiter, start..end).aligned(self.columns)
    }

    /// The cell of a row in one of the columns.
    pub(crate) fn cell(&self, row: usize, which: usize) -> Location {
        match (self.starts.get(row), self.places.get(which)) {
            (Some(_), Some(Some(place))) => self.line(row).place(*place),
            _ => self.whole(),
        }
    }

    /// The file as a whole.
    pub(crate) fn whole(&self) -> Location {
        Location::whole(&self.source)
    }
}
