//! The rows of a data file as numbers, each with its place.

use std::ops::Range;
use std::sync::Arc;

use super::grid::{Cell, MISSING, grouped_number, grouping_sign};
use super::header::Header;
use super::text::{self, Lines};
use crate::input::diagnostic::{Diagnostics, Location, Problems, Source};

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
    /// Of every row that was passed over, since one of its numbers is missing, how many rows were read before it.
    passed_over: Vec<usize>,
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
pub(super) fn line_at(source: &Arc<Source>, start: usize) -> Location {
    let rest = source.text().get(start..).unwrap_or_default();
    let line = rest.split('\n').next().unwrap_or_default();
    Location::new(source, start..start + line.trim_end().len())
}

/// What is made of a cell that is empty or says that there is no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Holes {
    /// An error: what prescribes something has no holes.
    Refused,
    /// The row is passed over, and counted.
    PassedOver,
    /// A NaN.
    Kept,
}

/// Reads rows, and remembers how their numbers separate decimals.
pub(super) struct Rows<'a> {
    header: &'a Header<'a>,
    pub(super) table: Table,
    problems: Problems,
    signs: DecimalSigns,
    holes: Holes,
    /// The sign that groups thousands, where one does.
    grouping: Option<char>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(header: &'a Header<'a>, places: Vec<usize>, holes: Holes) -> Self {
        let table = Table {
            source: Arc::clone(header.source),
            delimiter: header.delimiter,
            places,
            values: Vec::new(),
            starts: Vec::new(),
            passed_over: Vec::new(),
        };
        Self {
            header,
            table,
            problems: Problems::new(),
            signs: DecimalSigns::default(),
            holes,
            grouping: None,
        }
    }

    pub(super) fn read(
        &mut self,
        mut lines: Lines<'_>,
        without_number: &str,
    ) -> Result<(), Diagnostics> {
        let (text, expected) = (lines.text, self.header.cells.len());
        let mut cells = Vec::with_capacity(expected);
        self.grouping = self.grouping_in(lines.clone());
        while let Some(start) = lines.cells(self.header.delimiter, &mut cells) {
            if cells.len() != expected {
                let found = cells.len();
                let s = if found == 1 { "" } else { "s" };
                let message = format!("a row of {found} cell{s} in a table of {expected} columns");
                let report = (self.problems).at(&line_at(self.header.source, start), message);
                report.help(
                    "give every row one cell per column; where commas separate cells, numbers have a decimal point",
                );
                continue;
            }
            let is_passed_over = self.holes == Holes::PassedOver
                && (self.table.places.iter()).any(|place| is_hole(&text[cells[*place].clone()]));
            if is_passed_over {
                self.table.passed_over.push(self.table.starts.len());
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

    /// The sign that groups thousands in all numbers, where one of them tells, as `1.000,5` does: only where commas do not separate
    /// cells.
    fn grouping_in(&self, mut lines: Lines<'_>) -> Option<char> {
        let (text, delimiter) = (lines.text, self.header.delimiter);
        if delimiter == ',' || !text.contains(',') {
            return None;
        }
        let mut cells = Vec::new();
        while lines.cells(delimiter, &mut cells).is_some() {
            let spans = self
                .table
                .places
                .iter()
                .filter_map(|place| cells.get(*place));
            let mut with_comma = spans
                .map(|span| &text[span.clone()])
                .filter(|cell| cell.contains(','));
            if let Some(sign) = with_comma.find_map(grouping_sign) {
                return Some(sign);
            }
        }
        None
    }

    /// The number in a cell, or why there is none.
    fn number(&mut self, cell: &str, span: &Range<usize>) -> Result<f64, &'static str> {
        let delimiter = self.header.delimiter;
        if self.holes == Holes::Kept && is_hole(cell) {
            return Ok(f64::NAN);
        }
        let why = match cell {
            "" => "empty",
            _ if is_hole(cell) => "marked as missing",
            _ => "not a number",
        };
        if let (Some(sign), false) = (self.grouping, is_hole(cell)) {
            return match grouped_number(cell, sign) {
                Cell::Number(number) => Ok(number),
                Cell::Bad(why) => Err(why),
                Cell::Missing => Err("empty"),
            };
        }
        let number = plain_number(cell, delimiter).ok_or(why)?;
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
        let report = self.problems.at(&cell, message);
        report.because(why).help(without_number);
    }
}

/// How the numbers of a file separate decimals.
#[derive(Debug, Default)]
pub(super) struct DecimalSigns {
    /// The first number with a decimal point, where a comma could stand for it.
    point: Option<Range<usize>>,
    /// The first number with a comma.
    comma: Option<Range<usize>>,
    /// Whether some comma separates no thousands.
    is_decimal: bool,
}

impl DecimalSigns {
    pub(super) fn see(&mut self, cell: &str, span: &Range<usize>) {
        if self.point.is_none() && cell.contains('.') {
            self.point = Some(span.clone());
        }
        if !self.is_decimal && cell.contains(',') {
            self.comma.get_or_insert_with(|| span.clone());
            self.is_decimal = !is_like_thousands(cell);
        }
    }

    /// Commas must separate decimals, and do it everywhere.
    pub(super) fn check(&self, source: &Arc<Source>, problems: &Problems) {
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
            let [point, none] = [".", ""].map(|sign| comma.text().replace(',', sign));
            problems
                .at(&comma, "this comma may separate decimals or thousands")
                .help(format!("write `{point}` or `{none}`"));
        }
    }
}

/// A number with a decimal point, or with a decimal comma where commas do not separate cells.
pub(super) fn plain_number(cell: &str, delimiter: char) -> Option<f64> {
    let with_comma = || match delimiter {
        ',' => None,
        _ => cell.replacen(',', ".", 1).parse().ok(),
    };
    cell.parse().ok().or_else(with_comma)
}

/// Whether a cell says that there is no number.
fn is_hole(cell: &str) -> bool {
    MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word))
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
