//! What the integration tests share: engines for an indenter on a domain, materials, and the order of convergence.

#![allow(dead_code)] // Each test file uses its own part.

pub mod solids;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use contact_dma::contact::axisymmetric::{Axisymmetric, Edge};
use contact_dma::contact::half_space::convolution::Convolution;
use contact_dma::contact::half_space::grid::Grid;
use contact_dma::contact::half_space::{HalfSpace, SolverSettings};
use contact_dma::contact::{ContactError, Engine, Instant, Prescribed, Solution};
use contact_dma::drive::HarmonicDrive;
use contact_dma::engine::{EngineKind, SolverPlan};
use contact_dma::indenter::{Indenter, Sphere};
use contact_dma::material::{Creep, Material, ModulusKind, classical, library};
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::plan::{Case, CyclePlan, SweepPlan};
use contact_dma::sweep::record::CaseRecord;

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
    half_space_with(indenter, half_width_m, cells, SolverSettings::default())
}

/// The half-space engine with other than default settings.
pub fn half_space_with(
    indenter: &dyn Indenter,
    half_width_m: f64,
    cells: usize,
    settings: SolverSettings,
) -> HalfSpace {
    let grid = grid(half_width_m, cells);
    let gap_m = gap_field(indenter, &grid);
    let operator = Arc::new(Convolution::new(grid).unwrap());
    let bounded = indenter
        .axisymmetric()
        .is_none_or(|body| body.has_bounded_pressure());
    HalfSpace::new(operator, gap_m, bounded, settings)
}

/// The grid on which [`half_space`] works.
pub fn grid(half_width_m: f64, cells: usize) -> Grid {
    Grid::square(cells, 2.0 * half_width_m / cells as f64).unwrap()
}

fn gap_field(indenter: &dyn Indenter, grid: &Grid) -> Vec<f64> {
    (0..grid.cells())
        .map(|cell| {
            let (x_m, y_m) = grid.center(cell);
            indenter.gap_m(x_m, y_m)
        })
        .collect()
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

/// PMMA, from the library.
pub fn pmma_material() -> Material {
    library::find("pmma").unwrap().material().unwrap()
}

/// A Zener body with two equal springs and a retardation time of 1 s.
pub fn zener_material() -> Material {
    let creep = classical::zener(1e9, 1e9, 1.0).unwrap();
    Material::from_creep(creep, ModulusKind::Shear, 0.5).unwrap()
}

/// Contact compliance of PMMA.
pub fn pmma() -> Creep {
    pmma_material().contact_compliance().unwrap()
}

/// Contact compliance of the Zener body.
pub fn zener() -> Creep {
    zener_material().contact_compliance().unwrap()
}

/// Contact compliance of a Maxwell body of relaxation time 1 s.
pub fn maxwell() -> Creep {
    let body = classical::maxwell(1e9, 1.0).unwrap();
    let material = Material::from_relaxation(body, ModulusKind::Shear, 0.5).unwrap();
    material.contact_compliance().unwrap()
}

/// A sweep of this contact without a hold, with everything else at its default.
pub fn sweep_plan(
    material: Material,
    indenter: Arc<dyn Indenter>,
    mean_n: f64,
    amplitude_n: f64,
) -> SweepPlan {
    let drive = HarmonicDrive::load(mean_n, amplitude_n).unwrap();
    let mut plan = SweepPlan::new(material, indenter, drive);
    plan.title = "integration test".into();
    plan.solver = SolverPlan::default();
    plan.angular_frequencies_rad_per_s = vec![1.0];
    // Tests that look at error bars ask for them.
    plan.cycle.error_bars = false;
    plan
}

/// One case of a sweep.
pub fn run_case(plan: &SweepPlan, angular_frequency_rad_per_s: f64) -> CaseRecord {
    let setup = Setup::new(plan.clone()).unwrap();
    let interrupt = AtomicBool::new(false);
    let case = Case {
        index: 0,
        angular_frequency_rad_per_s,
        condition: plan.base.clone(),
    };
    setup.run(&case, &interrupt).unwrap()
}

/// Order p of errors that fall like n^-p: the slope of a straight line through (ln n, ln error).
pub fn observed_order(points: &[usize], errors: &[f64]) -> f64 {
    let logarithms = points.iter().zip(errors);
    let logarithms: Vec<_> = logarithms
        .map(|(&n, e)| ((n as f64).ln(), e.abs().ln()))
        .collect();
    let count = logarithms.len() as f64;
    let mean_x = logarithms.iter().map(|l| l.0).sum::<f64>() / count;
    let mean_y = logarithms.iter().map(|l| l.1).sum::<f64>() / count;
    let covariance: f64 = logarithms
        .iter()
        .map(|l| (l.0 - mean_x) * (l.1 - mean_y))
        .sum();
    let variance: f64 = logarithms.iter().map(|l| (l.0 - mean_x).powi(2)).sum();
    -covariance / variance
}

/// Relative difference from an expected value.
pub fn relative(value: f64, expected: f64) -> f64 {
    value / expected - 1.0
}

/// Root mean square.
pub fn root_mean_square(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        count += 1.0;
    }
    (sum / count).sqrt()
}

/// The same sweep on so many cells and in so many steps, without error bars.
pub fn on_cells(mut plan: SweepPlan, cells: usize, steps: usize) -> SweepPlan {
    plan.cycle = CyclePlan {
        steps,
        error_bars: false,
        ..CyclePlan::default()
    };
    plan.solver = SolverPlan {
        engine: EngineKind::HalfSpace,
        cells,
        ..SolverPlan::default()
    };
    plan
}

/// A whole number that whoever runs the tests asks for, or another.
pub fn from_environment(name: &str, otherwise: u64) -> u64 {
    let asked = std::env::var(name).ok();
    asked.map_or(otherwise, |text| text.parse().expect("a whole number"))
}

/// Uniform between 0 and 1, of D. E. Knuth's linear congruential generator (MMIX).
pub fn uniform(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// A sphere of 10 mm.
pub fn sphere_of_10_mm() -> Arc<dyn Indenter> {
    Arc::new(Sphere::new(0.01).unwrap())
}
