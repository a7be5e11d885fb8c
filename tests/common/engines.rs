//! Engines of both kinds for an indenter, and single instants on them.

use std::sync::Arc;

use contact_dma::contact::axisymmetric::{Axisymmetric, Edge};
use contact_dma::contact::half_space::convolution::Convolution;
use contact_dma::contact::half_space::grid::Grid;
use contact_dma::contact::half_space::layer::LayerInfluence;
use contact_dma::contact::half_space::{HalfSpace, SolverSettings};
use contact_dma::contact::{ContactError, Engine, Instant, Prescribed, Solution};
use contact_dma::indenter::Indenter;

/// The axisymmetric engine for this indenter: so many springs over the half width.
pub fn springs(indenter: &dyn Indenter, half_width_m: f64, springs: usize) -> Axisymmetric {
    let body = indenter.axisymmetric().unwrap();
    let width_m = half_width_m / springs as f64;
    let gaps = (0..springs)
        .map(|i| body.transformed_gap_m((i as f64 + 0.5) * width_m))
        .collect();
    let edge = match body.contact_limit_m() {
        Some(_) => Edge::Rim,
        None => Edge::Open,
    };
    Axisymmetric::new(width_m, gaps, edge, body.has_bounded_pressure())
}

/// The half-space engine for this indenter on a square of so many cells per side.
pub fn half_space(indenter: &dyn Indenter, half_width_m: f64, cells: usize) -> HalfSpace {
    cells_on(indenter, grid(half_width_m, cells))
}

/// The grid on which [`half_space`] works.
pub fn grid(half_width_m: f64, cells: usize) -> Grid {
    Grid::square(cells, 2.0 * half_width_m / cells as f64).unwrap()
}

/// The half-space engine on a grid.
pub fn cells_on(indenter: &dyn Indenter, grid: Grid) -> HalfSpace {
    cells_with(indenter, grid, SolverSettings::default())
}

/// The same to a tolerance.
pub fn cells_to(indenter: &dyn Indenter, grid: Grid, tolerance: f64) -> HalfSpace {
    cells_with(indenter, grid, to_tolerance(tolerance))
}

pub fn to_tolerance(tolerance: f64) -> SolverSettings {
    SolverSettings {
        tolerance,
        ..SolverSettings::default()
    }
}

pub fn cells_with(indenter: &dyn Indenter, grid: Grid, settings: SolverSettings) -> HalfSpace {
    cells_of(indenter, Convolution::new(grid).unwrap(), settings)
}

/// The half-space engine on a layer.
pub fn cells_on_layer(
    indenter: &dyn Indenter,
    influence: Arc<LayerInfluence>,
    grid: Grid,
) -> HalfSpace {
    let operator = Convolution::on(grid, Some(influence)).unwrap();
    cells_of(indenter, operator, SolverSettings::default())
}

fn cells_of(indenter: &dyn Indenter, operator: Convolution, settings: SolverSettings) -> HalfSpace {
    let gap_m = center_gaps_m(indenter, operator.grid());
    let bounded = indenter.pressure_is_bounded();
    let engine = HalfSpace::new(Arc::new(operator), gap_m, bounded, settings);
    match indenter.ends_in_data() {
        true => engine.ending_in_data(),
        false => engine,
    }
}

/// The gap (m) at the centre of every cell.
pub fn center_gaps_m(indenter: &dyn Indenter, grid: &Grid) -> Vec<f64> {
    let gap_m = |cell| {
        let (x_m, y_m) = grid.center(cell);
        indenter.gap_m(x_m, y_m)
    };
    (0..grid.cells()).map(gap_m).collect()
}

/// Distance of a cell's centre from the axis (m).
pub fn distance_m(grid: &Grid, cell: usize) -> f64 {
    let (x_m, y_m) = grid.center(cell);
    x_m.hypot(y_m)
}

/// One instant on an undisturbed body, without a guess: the solution and the nodal pressure.
pub fn first_touch(
    engine: &mut dyn Engine,
    compliance_per_pa: f64,
    prescribed: Prescribed,
) -> Result<(Solution, Vec<f64>), ContactError> {
    let mut pressure = vec![0.0; engine.nodes()];
    let solution = solve_from(engine, compliance_per_pa, prescribed, &mut pressure)?;
    Ok((solution, pressure))
}

/// One instant on an undisturbed body, from the guess in `pressure`.
pub fn solve_from(
    engine: &mut dyn Engine,
    compliance_per_pa: f64,
    prescribed: Prescribed,
    pressure: &mut [f64],
) -> Result<Solution, ContactError> {
    let history = vec![0.0; engine.nodes()];
    let instant = Instant {
        history: &history,
        compliance_per_pa,
        prescribed,
    };
    engine.solve(&instant, pressure)
}
