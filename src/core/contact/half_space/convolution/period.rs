//! The operator of one period of a half-space that repeats itself.

use std::convert::Infallible;
use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::{Arc, Mutex, Weak};

use contact_dma_transforms::Precision;

use super::even_column::EvenColumn;
use super::periodic_row::PeriodicRow;
use super::spectral::SpectralProduct;
use super::{ConvolutionError, Scratch, in_use};
use crate::contact::half_space::grid::Grid;

/// Displacement of every cell per unit of compliance, its mean taken off, by the pressure on one period: 2/|q| at the wave number q.
pub struct PeriodicOperator {
    grid: Grid,
    product: SpectralProduct,
    /// The same in single precision.
    nearly: SpectralProduct<f32>,
    /// |q|/2, and for the mean as for the longest wave.
    inverse: SpectralProduct<f32>,
}

/// Those in use.
static IN_USE: Mutex<Vec<Weak<PeriodicOperator>>> = Mutex::new(Vec::new());

impl PeriodicOperator {
    /// That of a grid, which all share who use it at the same time.
    pub fn shared(grid: Grid) -> Arc<Self> {
        let new = || Ok::<_, Infallible>(Self::new(grid));
        let Ok(operator) = in_use(&IN_USE, |operator: &Self| operator.grid == grid, new);
        operator
    }

    /// Of a grid that is one period.
    pub fn new(grid: Grid) -> Self {
        let (nx, ny) = (grid.cells_x(), grid.cells_y());
        let along =
            |k: usize, cells: usize, spacing_m: f64| TAU * k as f64 / (cells as f64 * spacing_m);
        let wave_number = |kx: usize, ky: usize| {
            let along_y = along(ky, ny, grid.spacing_y_m());
            along(kx, nx, grid.spacing_x_m()).hypot(along_y)
        };
        let longest_per_m = wave_number(1, 0).min(wave_number(0, 1));
        // Transforms there and back multiply by the number of cells.
        let cells = grid.cells() as f64;
        let spectrum = |at: &dyn Fn(f64) -> f64| -> Vec<f64> {
            let waves = (0..=nx / 2).flat_map(|kx| (0..=ny / 2).map(move |ky| (kx, ky)));
            waves
                .map(|(kx, ky)| at(wave_number(kx, ky)) / cells)
                .collect()
        };
        // The mean is left out.
        let yields = spectrum(&|q| if q > 0.0 { 2.0 / q } else { 0.0 });
        Self {
            grid,
            nearly: product(&grid, yields.clone()),
            product: product(&grid, yields),
            inverse: product(&grid, spectrum(&|q| 0.5 * q.max(longest_per_m))),
        }
    }

    pub(in super::super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The displacement (m per 1/Pa) of every cell by these pressures (Pa).
    pub(in super::super) fn apply(
        &self,
        pressure: &[f64],
        displacement: &mut [f64],
        scratch: &mut Scratch,
    ) -> Result<(), ConvolutionError> {
        let rows = 0..self.grid.cells_y();
        self.product.apply(pressure, displacement, rows, scratch)
    }

    /// The same in single precision, to [`SINGLE`](super::SINGLE).
    pub(in super::super) fn apply_nearly(
        &self,
        pressure: &[f32],
        displacement: &mut [f32],
        scratch: &mut Scratch<f32>,
    ) -> Result<(), ConvolutionError> {
        let rows = 0..self.grid.cells_y();
        self.nearly.apply(pressure, displacement, rows, scratch)
    }

    /// The pressures (Pa) that lift the surface like this (m per 1/Pa) in these rows, if their mean counts for as much as the longest
    /// wave.
    pub(in super::super) fn apply_inverse(
        &self,
        displacement: &[f32],
        pressure: &mut [f32],
        rows: Range<usize>,
        scratch: &mut Scratch<f32>,
    ) -> Result<(), ConvolutionError> {
        self.inverse.apply(displacement, pressure, rows, scratch)
    }
}

/// The product with this spectrum on the grid of a period.
fn product<T: Precision>(grid: &Grid, spectrum: Vec<f64>) -> SpectralProduct<T> {
    let row = PeriodicRow::of_period(grid.cells_x());
    SpectralProduct::new(grid, row, EvenColumn::new(grid.cells_y()), spectrum)
}
