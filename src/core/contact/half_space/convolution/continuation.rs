//! What a field that is known on a contact alone is taken to be between its patches: its mean, weighted by area over the square of the
//! distance (D. Shepard, Proc. 23rd ACM National Conference (1968) 517).
//!
//! It need not be exact, and is smooth between the patches: squares of cells have one value.

use std::ops::Range;

use super::even_column::{self, EvenColumn};
use super::periodic_row::PeriodicRow;
use super::spectral::SpectralProduct;
use super::{ConvolutionError, Scratch};
use crate::contact::half_space::grid::Grid;

/// Cells of a square, along x and y.
pub(in super::super) const SQUARE: usize = 4;
/// What a square weighs for itself, in units of the weight of the next one.
const OWN_WEIGHT: f64 = 4.0;

/// Weighted sums over the squares of a grid, which is taken for a period.
pub(in super::super) struct Continuation {
    grid: Grid,
    product: SpectralProduct<f32>,
    squares: (usize, usize),
}

impl Continuation {
    /// Of the fields on this grid.
    ///
    /// # Errors
    /// As [`Convolution::new`](super::Convolution::new).
    pub(in super::super) fn on(grid: &Grid) -> Result<Self, ConvolutionError> {
        let (x, y) = (
            grid.cells_x().div_ceil(SQUARE),
            grid.cells_y().div_ceil(SQUARE),
        );
        let ratio = grid.spacing_y_m() / grid.spacing_x_m();
        let area_of_cell = ratio / (SQUARE * SQUARE) as f64;
        let weight = |x: usize, y: usize| match (x, y) {
            (0, 0) => OWN_WEIGHT * area_of_cell / ratio.min(1.0).powi(2),
            (x, y) => area_of_cell / (x as f64).hypot(y as f64 * ratio).powi(2),
        };
        let row = PeriodicRow::of_period(x);
        let spectrum = even_column::spectrum(weight, &row, y, |_, value| value)?;
        Ok(Self {
            grid: *grid,
            product: SpectralProduct::new(&grid.part(x, y), row, EvenColumn::new(y), spectrum),
            squares: (x, y),
        })
    }

    pub(in super::super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Squares along x and y.
    pub(in super::super) fn squares(&self) -> (usize, usize) {
        self.squares
    }

    /// The sum, at every square, of what the cells of all squares have, weighted.
    pub(in super::super) fn sum(
        &self,
        values: &[f32],
        sums: &mut [f32],
        scratch: &mut Scratch<f32>,
    ) -> Result<(), ConvolutionError> {
        self.product.apply(values, sums, 0..self.squares.1, scratch)
    }
}

/// Goes through ranges of cells, in ascending order, on rows of `cells_x` cells: `leaf` is given every part that lies in one square, and
/// the number of the square, counted from that of the first row.
pub(in super::super) fn each_square(
    ranges: impl Iterator<Item = Range<usize>>,
    cells_x: usize,
    mut leaf: impl FnMut(usize, Range<usize>),
) {
    let per_row = cells_x.div_ceil(SQUARE);
    let (mut row, mut first) = (0, 0);
    for range in ranges {
        let mut at = range.start;
        while at < range.end {
            while at >= first + cells_x {
                (row, first) = (row + 1, first + cells_x);
            }
            let square = (at - first) / SQUARE;
            let next = first + cells_x.min(SQUARE * (square + 1));
            let end = next.min(range.end);
            leaf(row / SQUARE * per_row + square, at..end);
            at = end;
        }
    }
}
