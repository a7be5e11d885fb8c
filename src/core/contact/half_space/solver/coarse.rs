//! A first guess of the pressure from the same instant on a grid of cells twice as long.

use std::sync::Arc;

use super::super::instant::{Imposed, SolverSettings};
use super::HalfSpace;
use super::active_set::Work;
use crate::contact::{ContactError, Instant};

/// Cells per side below which a guess is not worth its while.
const FEWEST_CELLS: usize = 32;

/// The guess differs from the answer by the coarse cells' own error, far more than this.
const TOLERANCE: f64 = 1e-3;

impl HalfSpace {
    /// Fills `pressure`, zero so far, with a guess from a coarser grid where that saves work. Leaves it as it is
    /// where a coarser grid has no answer.
    pub(super) fn guess_from_coarse(
        &self,
        instant: &Instant<'_>,
        imposed: Imposed,
        pressure: &mut [f64],
        work: &mut Work,
    ) -> Result<(), ContactError> {
        let grid = *self.operator.grid();
        if grid.cells_x().min(grid.cells_y()) < FEWEST_CELLS {
            return Ok(());
        }
        let operator = self.operator.coarse()?;
        let (row, coarse_row) = (grid.cells_x(), operator.grid().cells_x());
        let gap_m = means(&self.gap_m, row, f64::INFINITY);
        let history = means(instant.history, row, 0.0);
        let settings = SolverSettings {
            tolerance: TOLERANCE,
            ..self.settings
        };
        let mut engine = Self::new(Arc::clone(&operator), gap_m, true, settings);
        let mut guess = vec![0.0; operator.grid().cells()];
        let coarse = Instant {
            history: &history,
            ..*instant
        };
        // A fourth of the cells, of four times the area.
        let imposed = match imposed {
            Imposed::PressureSum(sum) => Imposed::PressureSum(0.25 * sum),
            approach => approach,
        };
        let mut coarse_work = Work {
            interrupt: work.interrupt.clone(),
            ..Work::default()
        };
        let solved = engine.solve_in_windows(&coarse, imposed, &mut guess, &mut coarse_work);
        work.convolutions += coarse_work.convolutions;
        if matches!(solved, Ok(Some(_))) {
            spread(&guess, coarse_row, row, pressure);
        }
        Ok(())
    }
}

/// Means of two by two values, of those that are finite; `absent` where none is.
fn means(field: &[f64], row: usize, absent: f64) -> Vec<f64> {
    let coarse_row = row.div_ceil(2);
    let mut means = Vec::with_capacity(coarse_row * field.len().div_ceil(2 * row));
    for rows in field.chunks(2 * row) {
        let (first, second) = rows.split_at(row);
        for at in (0..row).step_by(2) {
            let (mut sum, mut count) = (0.0, 0.0);
            for values in [first, second] {
                let values = values.iter().skip(at).take(2);
                for value in values.filter(|value| value.is_finite()) {
                    sum += value;
                    count += 1.0;
                }
            }
            means.push(if count > 0.0 { sum / count } else { absent });
        }
    }
    means
}

/// Every value of the coarse field in the two by two cells it stands for.
fn spread(coarse: &[f64], coarse_row: usize, row: usize, field: &mut [f64]) {
    for (iy, values) in field.chunks_exact_mut(row).enumerate() {
        let from = &coarse[iy / 2 * coarse_row..];
        for (pair, &value) in values.chunks_mut(2).zip(from) {
            pair.fill(value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_of_an_odd_field_spread_again_keep_what_is_even() {
        // 3 x 3 values, one of them absent.
        let field = [1.0, 3.0, 5.0, 5.0, 7.0, f64::INFINITY, 2.0, 4.0, 9.0];
        let coarse = means(&field, 3, -1.0);
        assert_eq!(coarse, [4.0, 5.0, 3.0, 9.0]);
        let mut back = [0.0; 9];
        spread(&coarse, 2, 3, &mut back);
        assert_eq!(back, [4.0, 4.0, 5.0, 4.0, 4.0, 5.0, 3.0, 3.0, 9.0]);
    }
}
