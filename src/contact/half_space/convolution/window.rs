//! The operators of one rectangular window of a larger grid: the half-space restricted to it, and what nearly inverts it.
//!
//! Pressure in a window moves the window's own cells as the grid of these cells alone would, so the operator is a smaller
//! [`Convolution`]. Its inverse is nearly a product with the reciprocal of its spectrum on the unpadded window (half the wave
//! number, where cells are small), so that conjugate gradients preconditioned with it need few steps, whose number hardly
//! depends on the grid.

use std::ops::Range;

use super::length::fast_column;
use super::periodic_row::PeriodicRow;
use super::spectral::{Row, Shape, SpectralProduct};
use super::{Convolution, ConvolutionError, Influence, Scratch, kernel_spectrum};
use crate::contact::half_space::grid::Grid;

/// A symmetric positive product that nearly inverts the half-space operator on one window.
pub struct Preconditioner {
    product: SpectralProduct<PeriodicRow>,
}

impl Preconditioner {
    /// For windows like this grid.
    ///
    /// # Errors
    /// As [`Convolution::new`].
    pub fn new(grid: &Grid) -> Result<Self, ConvolutionError> {
        let row = PeriodicRow::new(grid.cells_x());
        let column_length = fast_column(grid.cells_y());
        let shape = Shape::with_columns(grid, row.bins(), column_length);
        let mut spectrum = kernel_spectrum::columns(&Influence::new(grid), &row, column_length)?;
        let cells = row.period() as f64 * column_length as f64;
        for value in &mut spectrum {
            // Scaled like the spectrum it inverts.
            *value = (*value * cells * cells).recip();
        }
        Ok(Self {
            product: SpectralProduct::new(shape, row, spectrum),
        })
    }

    /// Applies it to `residual`; writes the rows `wanted` of `direction` alone. `scratch` may be of any shape.
    ///
    /// # Errors
    /// [`ConvolutionError`], for slices of the wrong length alone.
    pub fn apply(
        &self,
        residual: &[f64],
        direction: &mut [f64],
        wanted: Range<usize>,
        scratch: &mut Scratch,
    ) -> Result<(), ConvolutionError> {
        super::check_lengths(&self.product.shape, residual, direction)?;
        self.product.fit(scratch);
        Ok(self.product.apply(residual, direction, wanted, scratch)?)
    }
}

/// What a window needs; from [`Convolution::window`].
pub struct WindowOperators {
    /// The half-space restricted to the window; `None` for the whole grid, whose operator exists already.
    pub(super) convolution: Option<Convolution>,
    pub(super) preconditioner: Preconditioner,
}

impl WindowOperators {
    pub(super) fn new(grid: &Grid, whole: bool) -> Result<Self, ConvolutionError> {
        let convolution = match whole {
            true => None,
            false => Some(Convolution::new(*grid)?),
        };
        Ok(Self {
            convolution,
            preconditioner: Preconditioner::new(grid)?,
        })
    }

    /// The operator of the window, given that of the whole grid.
    pub fn convolution<'a>(&'a self, whole: &'a Convolution) -> &'a Convolution {
        self.convolution.as_ref().unwrap_or(whole)
    }

    /// What nearly inverts it.
    pub fn preconditioner(&self) -> &Preconditioner {
        &self.preconditioner
    }

    /// Bytes of the spectra.
    pub(super) fn bytes(&self) -> usize {
        let own = self.convolution.as_ref().map_or(0, Convolution::bytes);
        own + self.preconditioner.product.bytes()
    }
}
