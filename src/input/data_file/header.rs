//! The line of a data file that names its columns.

use std::ops::Range;
use std::sync::Arc;

use super::rows::{line_at, plain_number};
use super::text::{self, DELIMITERS, Lines};
use super::{Column, factor};
use crate::input::diagnostic::{Diagnostic, Location, Source};
use crate::quantity::{Dimension, QuantityError, QuantityProblem};

/// A line cut into cells, the names of columns in most files.
pub(super) struct Header<'a> {
    pub(super) source: &'a Arc<Source>,
    pub(super) delimiter: char,
    pub(super) start: usize,
    pub(super) cells: Vec<Range<usize>>,
    /// The lines below it.
    pub(super) after: Lines<'a>,
}

/// A column that was found.
pub(super) struct Found {
    pub(super) place: usize,
    /// As the header gives it.
    unit: Option<String>,
}

impl<'a> Header<'a> {
    pub(super) fn new(source: &'a Arc<Source>, start: usize, delimiter: char) -> Self {
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

    pub(super) fn texts(&self) -> Vec<&'a str> {
        let text = self.source.text();
        self.cells.iter().map(|cell| &text[cell.clone()]).collect()
    }

    pub(super) fn location(&self, place: usize) -> Location {
        let cell = self.cells.get(place).cloned();
        Location::new(self.source, cell.unwrap_or_default())
    }

    /// The one column of these names.
    pub(super) fn find(&self, column: &Column) -> Result<Found, Diagnostic> {
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
        let is_number = |cell: &str| plain_number(cell, self.delimiter).is_some();
        if self.texts().into_iter().any(is_number) {
            return problem
                .because("numbers")
                .help("begin the table with a line of column names");
        }
        let mut known = DELIMITERS.iter();
        let by = known.find(|(delimiter, _)| *delimiter == self.delimiter);
        let because = match (self.cells.len(), by) {
            (1, _) | (_, None) => "one column".to_owned(),
            (count, Some((_, by))) => format!("{count} columns, separated by {by}"),
        };
        let unit = column.dimension.common_unit();
        problem.because(because).help(format!(
            "name the column of {} with its unit, such as `{name}` or `{} [{unit}]`",
            column.what,
            column.names.first().unwrap_or(&""),
        ))
    }

    /// The units of the columns in the line below, where that is a row of units; `lines` then stands behind it.
    pub(super) fn units_row(
        &self,
        lines: &mut Lines<'_>,
        found: &[Found],
    ) -> Vec<Option<(String, Location)>> {
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
            matches!(
                read,
                Ok(_)
                    | Err(QuantityError {
                        problem: QuantityProblem::WrongDimension { .. },
                        ..
                    })
            )
        };
        let some = || units.iter().flatten().map(|(unit, _)| unit.as_str());
        let is_row = some().any(is_unit) && !some().any(|unit| unit.parse::<f64>().is_ok());
        if !is_row || cells.len() != self.cells.len() {
            return found.iter().map(|_| None).collect();
        }
        *lines = ahead;
        let is_given = |unit: &(String, Location)| !["", "-"].contains(&unit.0.as_str());
        let units = units.into_iter();
        units.map(|unit| unit.filter(is_given)).collect()
    }

    /// What the numbers of a column are multiplied by.
    pub(super) fn factor(
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
