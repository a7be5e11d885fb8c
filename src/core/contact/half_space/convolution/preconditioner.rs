//! What nearly inverts the half-space operator on one rectangular window of a grid.
//!
//! Pressure in a window moves the window's own cells as the grid of these cells alone would, so the operator is a smaller
//! [`Convolution`](super::Convolution). Its inverse is nearly a product with the reciprocal of its spectrum on the unpadded window,
//! |q|/2 at the wave number q where cells are small: a pressure that is a wave bends the half-space into the same wave of amplitude
//! 2/|q| (H. M. Stanley and T. Kato, J. Tribology 119 (1997) 481). Conjugate gradients preconditioned with it need few steps, whose
//! number hardly depends on the grid. A layer bends into a wave smaller by a factor known in closed form.

use std::f64::consts::TAU;
use std::ops::Range;

use super::even_column::EvenColumn;
use super::length::fast_column;
use super::periodic_row::PeriodicRow;
use super::spectral::{Column, Row, SpectralProduct};
use super::{ConvolutionError, Influence, Scratch, even_column};
use crate::contact::half_space::grid::Grid;
use crate::contact::half_space::layer::Layer;

/// A symmetric positive product that nearly inverts the half-space operator on one window, but for a factor: conjugate gradients take
/// the same steps whatever that is.
pub struct Preconditioner {
    product: SpectralProduct<f32>,
}

impl Preconditioner {
    /// For windows like this grid, on a layer where there is one.
    ///
    /// # Errors
    /// As [`Convolution::new`](super::Convolution::new).
    pub fn on(grid: &Grid, layer: Option<&Layer>) -> Result<Self, ConvolutionError> {
        // The coefficients of a layer cut off at half the window may have no positive spectrum.
        let influence = Influence::new(grid);
        if grid.is_mirrored() {
            let cells = (grid.cells_x(), grid.cells_y());
            let periods = [cells.0, cells.1].map(|cells| 4 * super::length::fast_row_half(cells));
            let softening = Softening::new(grid, periods, layer);
            let inverse = |at, value: f64| (value * softening.factor(at)).recip();
            let product = super::mirrored(grid, &influence, cells, inverse)?;
            return Ok(Self { product });
        }
        let row = PeriodicRow::new(grid.cells_x());
        let column = EvenColumn::new(fast_column(grid.cells_y()));
        let softening = Softening::new(grid, [row.period(), column.length()], layer);
        let cells = row.period() as f64 * column.length() as f64;
        // Scaled like the spectrum it inverts.
        let inverse = |at, value: f64| (value * softening.factor(at) * cells * cells).recip();
        let spectrum = even_column::spectrum(
            |x, y| influence.coefficient_m(x, y),
            &row,
            column.length(),
            inverse,
        )?;
        let product = SpectralProduct::new(grid, row, column, spectrum);
        Ok(Self { product })
    }

    /// Applies it to `residual`; writes the rows `wanted` of `direction` alone. `scratch` may be of any shape.
    ///
    /// # Errors
    /// [`ConvolutionError`], for slices of the wrong length alone.
    pub fn apply(
        &self,
        residual: &[f32],
        direction: &mut [f32],
        wanted: Range<usize>,
        scratch: &mut Scratch<f32>,
    ) -> Result<(), ConvolutionError> {
        self.product.apply(residual, direction, wanted, scratch)
    }
}

/// By how much less than a half-space a layer yields to the waves of a periodic window.
struct Softening<'a> {
    layer: Option<&'a Layer>,
    /// Wave numbers (1/m) of the first frequency along x and y.
    first_per_m: [f64; 2],
}

impl<'a> Softening<'a> {
    /// For a window that repeats after these many cells along x and y.
    fn new(grid: &Grid, [x, y]: [usize; 2], layer: Option<&'a Layer>) -> Self {
        let first = |period: usize, spacing_m: f64| TAU / (period as f64 * spacing_m);
        Self {
            layer,
            first_per_m: [first(x, grid.spacing_x_m()), first(y, grid.spacing_y_m())],
        }
    }

    /// Above zero; 1 on a half-space. The mean over the window counts as half of the longest wave.
    fn factor(&self, (along_x, along_y): (usize, usize)) -> f64 {
        let Some(layer) = self.layer else { return 1.0 };
        let [x, y] = self.first_per_m;
        let wave_per_m = (along_x as f64 * x).hypot(along_y as f64 * y);
        layer.softening(wave_per_m.max(0.5 * x.min(y)) * layer.thickness_m)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Convolution;
    use super::*;

    /// Windows from one cell to long strips, with square and oblong cells.
    const SHAPES: [(usize, usize, f64, f64); 9] = [
        (1, 1, 1.0, 1.0),
        (2, 7, 1.0, 1.0),
        (16, 16, 1.0e-6, 1.0e-6),
        (45, 31, 1.0, 1.7),
        (64, 48, 3.0, 1.0),
        (16, 512, 1.0, 1.0),
        (300, 16, 1.0, 1.0),
        (32, 32, 1.0, 1000.0),
        (40, 40, 1000.0, 1.0),
    ];

    #[test]
    fn the_preconditioner_is_positive_whatever_the_window() {
        for (cells_x, cells_y, spacing_x, spacing_y) in SHAPES {
            let grid = Grid::new(cells_x, cells_y, spacing_x, spacing_y).unwrap();
            let preconditioner = Preconditioner::on(&grid, None).unwrap();
            let spectrum = preconditioner.product.spectrum();
            assert!(
                spectrum.iter().all(|v| *v > 0.0 && v.is_finite()),
                "{grid:?}"
            );
        }
    }

    #[test]
    fn it_nearly_inverts_the_operator_inside_a_window() {
        // A smooth load in the middle of the window: what comes back is the load, but for what the window cuts off.
        let grid = Grid::square(96, 1.0).unwrap();
        let load = |cell| {
            let (x, y) = grid.center(cell);
            (-(x * x + y * y) / 72.0).exp()
        };
        let pressure: Vec<f64> = (0..grid.cells()).map(load).collect();
        let convolution = Convolution::new(grid).unwrap();
        let mut displacement = vec![0.0; grid.cells()];
        let mut scratch = convolution.scratch();
        convolution
            .apply(&pressure, &mut displacement, &mut scratch)
            .unwrap();
        let preconditioner = Preconditioner::on(&grid, None).unwrap();
        let given: Vec<f32> = displacement.iter().map(|u| *u as f32).collect();
        let mut back = vec![0.0; grid.cells()];
        preconditioner
            .apply(&given, &mut back, 0..96, &mut Scratch::default())
            .unwrap();
        for iy in 40..56 {
            let cell = iy * 96 + 48;
            // The periodic images, a hundred cells away, change the displacement by a tenth.
            assert!(
                (f64::from(back[cell]) - pressure[cell]).abs() < 0.1,
                "{} {}",
                back[cell],
                pressure[cell]
            );
        }
    }

    #[test]
    fn only_the_rows_wanted_are_written() {
        let grid = Grid::new(20, 30, 1.0, 1.0).unwrap();
        let preconditioner = Preconditioner::on(&grid, None).unwrap();
        let residual: Vec<f32> = (0..grid.cells()).map(|i| (i % 7) as f32).collect();
        let mut scratch = Scratch::default();
        let mut whole = vec![0.0; grid.cells()];
        preconditioner
            .apply(&residual, &mut whole, 0..30, &mut scratch)
            .unwrap();
        let mut part = vec![-1.0; grid.cells()];
        preconditioner
            .apply(&residual, &mut part, 9..14, &mut scratch)
            .unwrap();
        for (cell, value) in part.iter().enumerate() {
            let wanted = (9..14).contains(&(cell / 20));
            assert_eq!(*value, if wanted { whole[cell] } else { -1.0 });
        }
    }
}
