//! The operator of one period of a half-space that repeats itself.

use std::convert::Infallible;
use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, Weak};

use super::even_column::EvenColumn;
use super::periodic_row::PeriodicRow;
use super::spectral::SpectralProduct;
use super::{ConvolutionError, Scratch, in_use};
use crate::contact::half_space::grid::Grid;

/// Displacement of every cell per unit of compliance, its mean taken off, by the pressure on one period: 2/|q| at the wave number q.
pub struct PeriodicOperator {
    grid: Grid,
    product: SpectralProduct,
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
        let wave_number =
            |k: usize, cells: usize, spacing_m: f64| TAU * k as f64 / (cells as f64 * spacing_m);
        let mut spectrum = Vec::with_capacity((nx / 2 + 1) * (ny / 2 + 1));
        for kx in 0..=nx / 2 {
            for ky in 0..=ny / 2 {
                let along_y = wave_number(ky, ny, grid.spacing_y_m());
                let q = wave_number(kx, nx, grid.spacing_x_m()).hypot(along_y);
                // Transforms there and back multiply by the number of cells; the mean is left out.
                spectrum.push(match q > 0.0 {
                    true => 2.0 / (q * grid.cells() as f64),
                    false => 0.0,
                });
            }
        }
        let (row, column) = (PeriodicRow::of_period(nx), EvenColumn::new(ny));
        let product = SpectralProduct::new(&grid, row, column, spectrum);
        Self { grid, product }
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
}
