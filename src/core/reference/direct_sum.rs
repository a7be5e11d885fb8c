//! The half-space operator by summation over all pairs of cells: slow, obvious, and as accurate as its coefficients.
//!
//! The displacement of a cell is the sum over all cells of influence coefficient times pressure. `N` cells take `N^2`
//! additions (tens of milliseconds for 64 x 64 cells), which is why production code convolves; this is what it is checked against.

use crate::contact::half_space::convolution::ConvolutionError;
use crate::contact::half_space::grid::Grid;
use crate::contact::half_space::influence::Influence;

/// Displacement of every cell's centre, in m per 1/Pa of contact compliance, by `pressure` (Pa), both row by row over
/// `grid`. The sums are compensated (Neumaier, *ZAMM* 54 (1974) 39), so that their rounding does not grow with `N`.
///
/// # Errors
/// [`ConvolutionError::PressureLength`] if `pressure` does not have one value per cell.
pub fn direct_sum(grid: &Grid, pressure: &[f64]) -> Result<Vec<f64>, ConvolutionError> {
    let (expected, found) = (grid.cells(), pressure.len());
    if found != expected {
        return Err(ConvolutionError::PressureLength { found, expected });
    }
    let cells_x = grid.cells_x();
    let influence = Influence::new(grid);
    let coefficients: Vec<f64> = (0..grid.cells())
        .map(|offset| influence.coefficient_m(offset % cells_x, offset / cells_x))
        .collect();

    let displacement_at = |index: usize| {
        let (x, y) = (index % cells_x, index / cells_x);
        let mut sum = CompensatedSum::default();
        for (loaded_y, row) in pressure.chunks_exact(cells_x).enumerate() {
            let line = &coefficients[y.abs_diff(loaded_y) * cells_x..][..cells_x];
            for (loaded_x, value) in row.iter().enumerate() {
                sum.add(line[x.abs_diff(loaded_x)] * value);
            }
        }
        sum.value()
    };
    Ok((0..grid.cells()).map(displacement_at).collect())
}

/// A sum that keeps what rounding drops.
#[derive(Default)]
struct CompensatedSum {
    sum: f64,
    dropped: f64,
}

impl CompensatedSum {
    fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        self.dropped += if self.sum.abs() >= term.abs() {
            (self.sum - sum) + term
        } else {
            (term - sum) + self.sum
        };
        self.sum = sum;
    }

    fn value(&self) -> f64 {
        self.sum + self.dropped
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

    use super::*;
    use crate::contact::half_space::convolution::Convolution;
    use crate::contact::half_space::love::rectangle_displacement_m;

    /// Rounding of two forward and two inverse transforms of up to 2^14 points: some units in the last place of the
    /// largest displacement. 1e-13 is what is promised; this is what holds, with room for other processors.
    const TRANSFORM_ROUNDING: f64 = 1e-14;

    fn relative_difference(grid: Grid, pressure: &[f64]) -> f64 {
        let direct = direct_sum(&grid, pressure).unwrap();
        let convolution = Convolution::new(grid).unwrap();
        let mut fast = vec![f64::NAN; grid.cells()];
        convolution
            .apply(pressure, &mut fast, &mut convolution.scratch())
            .unwrap();
        let largest = direct.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let difference = direct.iter().zip(&fast).map(|(a, b)| (a - b).abs());
        difference.fold(0.0, f64::max) / largest
    }

    /// Values in [-1, 1) that look random and are the same in every run.
    fn scattered(count: usize) -> Vec<f64> {
        let golden = 0.618_033_988_749_894_9;
        (0..count)
            .map(|i| 2.0 * ((i * i) as f64 * golden).fract() - 1.0)
            .collect()
    }

    #[test]
    fn the_convolution_gives_the_direct_sum() {
        let shapes = [
            (1, 1, 1.0, 1.0),
            (1, 2, 1.0, 1.0),
            (2, 1, 1.0, 1.0),
            (2, 3, 1.0, 1.0),
            (3, 2, 1.0, 2.0),
            (7, 7, 1.0, 1.0),
            (8, 8, 1.0e-6, 1.0e-6),
            (1, 40, 1.0, 1.0),
            (40, 1, 1.0, 0.1),
            (13, 32, 1.0, 1.7),
            (31, 17, 3.0e-3, 1.0e-3),
            (37, 41, 1.0, 1.0),
            (64, 48, 2.0e-5, 1.0e-5),
            (61, 67, 1.0, 0.9),
        ];
        for (cells_x, cells_y, spacing_x, spacing_y) in shapes {
            let grid = Grid::new(cells_x, cells_y, spacing_x, spacing_y).unwrap();
            let signed = scattered(grid.cells());
            let positive: Vec<f64> = signed.iter().map(|p| p + 1.5).collect();
            for pressure in [signed, positive] {
                let difference = relative_difference(grid, &pressure);
                assert!(
                    difference < TRANSFORM_ROUNDING,
                    "{cells_x} x {cells_y}: {difference:e}"
                );
            }
        }
    }

    #[test]
    fn the_convolution_gives_the_direct_sum_whichever_rows_carry_load() {
        let grid = Grid::new(19, 22, 1.0, 1.0).unwrap();
        let full = scattered(grid.cells());
        for rows in [0..1, 21..22, 3..4, 4..8, 5..11, 0..22, 1..21] {
            let mut pressure = full.clone();
            pressure[..rows.start * 19].fill(0.0);
            pressure[rows.end * 19..].fill(0.0);
            let difference = relative_difference(grid, &pressure);
            assert!(difference < TRANSFORM_ROUNDING, "{rows:?}: {difference:e}");
        }
        // Rows and columns without load between loaded ones.
        let mut pressure = full;
        for (index, value) in pressure.iter_mut().enumerate() {
            if matches!(index / 19, 4..9 | 17) || matches!(index % 19, 0 | 6..10) {
                *value = 0.0;
            }
        }
        assert!(relative_difference(grid, &pressure) < TRANSFORM_ROUNDING);
    }

    #[test]
    fn the_convolution_gives_the_direct_sum_for_any_grid_and_load() {
        let strategy = (1_usize..24, 1_usize..24, 0.05_f64..20.0, -6_i32..3).prop_flat_map(
            |(cells_x, cells_y, ratio, decade)| {
                let pressure = prop::collection::vec(-1.0_f64..1.0, cells_x * cells_y);
                (
                    Just((cells_x, cells_y, ratio, 10.0_f64.powi(decade))),
                    pressure,
                )
            },
        );
        let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
        let config = Config {
            failure_persistence: None,
            ..Config::with_cases(100)
        };
        TestRunner::new_with_rng(config, rng)
            .run(
                &strategy,
                |((cells_x, cells_y, ratio, spacing), pressure)| {
                    let grid = Grid::new(cells_x, cells_y, spacing, ratio * spacing).unwrap();
                    let difference = relative_difference(grid, &pressure);
                    prop_assert!(difference < TRANSFORM_ROUNDING, "{difference:e}");
                    Ok(())
                },
            )
            .unwrap();
    }

    #[test]
    fn a_uniform_pressure_sums_to_one_rectangle() {
        let grid = Grid::new(21, 13, 1.0e-4, 2.0e-4).unwrap();
        let found = direct_sum(&grid, &vec![1.0e6; grid.cells()]).unwrap();
        for (index, u) in found.iter().enumerate() {
            let (x, y) = grid.center(index);
            let expected = 1.0e6 * rectangle_displacement_m(x, y, 21.0 * 0.5e-4, 13.0 * 1.0e-4);
            // Rounding of the coefficients, a few units in the last place each, and of the closed form.
            assert!(
                (u - expected).abs() < 4e-15 * expected,
                "{index}: {u:e} {expected:e}"
            );
        }
    }

    #[test]
    fn a_pressure_of_another_length_is_refused() {
        let grid = Grid::square(3, 1.0).unwrap();
        assert!(matches!(
            direct_sum(&grid, &[1.0; 8]),
            Err(ConvolutionError::PressureLength {
                found: 8,
                expected: 9
            })
        ));
    }
}
