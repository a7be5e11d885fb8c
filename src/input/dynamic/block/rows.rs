//! The rows of a block: what each must hold, and what becomes of one that does not.

use super::{Block, Column, Columns, Measured};
use crate::input::data_file::grid::{Cell, Line, Numbers};
use crate::input::diagnostic::{Location, Problems};
use crate::material::dynamic::DynamicPoint;

/// Why a row gives no point; of several reasons the last of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::input::dynamic) enum Skipped {
    /// A number is missing.
    Missing,
    /// A problem was reported.
    Bad,
    /// An instrument wrote a value that is not positive.
    Noise,
}

/// Reads the cells of rows.
pub(super) struct RowReader<'a, 'b> {
    pub(super) block: &'a Block<'b>,
    pub(super) columns: &'a Columns,
    pub(super) numbers: Numbers<'b>,
    pub(super) problems: Problems,
}

impl RowReader<'_, '_> {
    /// The point of a row.
    pub(super) fn point(&mut self, row: &Line<'_>, place: &Location) -> Result<Measured, Skipped> {
        let (block, columns) = (self.block, self.columns);
        let expected = block.header.len();
        let is_empty = |cell: usize| row.text(cell).is_empty();
        if !block.by_instrument && (row.len() < expected || !(expected..row.len()).all(is_empty)) {
            return Err(self.ragged(row, place, expected));
        }
        let [first, second] = &columns.pair;
        let temperature = columns.temperature.as_ref();
        let needed = [
            self.positive(row, &columns.frequency),
            self.positive(row, first),
            self.positive(row, second),
            temperature.map_or(Ok(0.0), |column| self.number(row, column)),
        ];
        let of_errors = columns.both_errors();
        let errors = of_errors.map(|both| both.map(|column| self.number(row, column)));
        let bad = errors.iter().flatten();
        let bad = bad.filter(|error| **error == Err(Skipped::Bad));
        if let Some(why) = needed.iter().chain(bad).filter_map(|cell| cell.err()).max() {
            return Err(why);
        }
        let [angular_frequency_rad_per_s, a, b, kelvin] = needed.map(Result::unwrap_or_default);
        let (storage_modulus_pa, loss_modulus_pa) = (columns.moduli)(a, b);
        let absolute = |which: usize, modulus: f64| {
            let (column, error) = (of_errors?[which], errors?[which].ok()?);
            Some(if column.scale.is_relative {
                error * modulus
            } else {
                error
            })
        };
        let errors = absolute(0, storage_modulus_pa).zip(absolute(1, loss_modulus_pa));
        let point = DynamicPoint {
            temperature_k: temperature.map_or(block.temperature_k, |_| Some(kelvin)),
            angular_frequency_rad_per_s,
            storage_modulus_pa,
            loss_modulus_pa,
            errors_pa: errors.filter(|(storage, loss)| *storage > 0.0 && *loss > 0.0),
        };
        // Moduli of a very large or very small number may leave what a double holds, and temperatures fall below zero.
        if let Some((what, value)) = point.not_positive() {
            let message = format!("{what} must be positive, and is {value:e} in SI units");
            let problem = self.problems.at(place, message);
            problem.help("leave the row out, or check its units");
            return Err(Skipped::Bad);
        }
        let set = columns.set.as_ref();
        Ok(Measured {
            point,
            place: place.clone(),
            set: set.map(|column| row.text(column.place).to_owned()),
        })
    }

    fn ragged(&self, row: &Line<'_>, place: &Location, expected: usize) -> Skipped {
        let found = row.len();
        let s = if found == 1 { "" } else { "s" };
        let message = format!("a row of {found} cell{s} in a table of {expected} columns");
        self.problems.at(place, message).help(
            "give every row one cell per column; where commas separate cells, numbers have a decimal point",
        );
        Skipped::Bad
    }

    fn positive(&mut self, row: &Line<'_>, column: &Column) -> Result<f64, Skipped> {
        let number = self.number(row, column)?;
        if number > 0.0 {
            return Ok(number);
        }
        // A loss near zero is as often below it as above, in any table.
        if self.block.by_instrument || column.place == self.columns.pair[1].place {
            return Err(Skipped::Noise);
        }
        let (cell, what) = (row.place(column.place), column.role.what());
        let problem = self.problems.at(&cell, format!("{what} must be positive"));
        problem.help("leave the row out: a measured value that is not positive is noise");
        Err(Skipped::Bad)
    }

    /// The number in SI units.
    fn number(&mut self, row: &Line<'_>, column: &Column) -> Result<f64, Skipped> {
        match self.numbers.read(row, column.place) {
            Cell::Number(number) => Ok(column.scale.zero + column.scale.factor * number),
            Cell::Missing => Err(Skipped::Missing),
            Cell::Bad(why) => {
                let name = self.block.header.text(column.place);
                let message = format!("a cell of the column `{name}` must be a number");
                let problem = self.problems.at(&row.place(column.place), message);
                problem
                    .because(why)
                    .help("write it as `1.5e6`, write `---` where it is missing, or leave the whole row out");
                Err(Skipped::Bad)
            }
        }
    }
}
