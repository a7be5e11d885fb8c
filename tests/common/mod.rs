//! What the integration tests share: materials, indenters, engines, plans of sweeps and what their cases come to.

#![allow(dead_code)] // Each test file uses its own part.

pub mod bars;
pub mod engines;
pub mod random;
pub mod solids;

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use contact_dma::contact::half_space::layer::Base;
use contact_dma::drive::{HarmonicDrive, Segment};
use contact_dma::engine::EngineKind;
use contact_dma::indenter::{Asperity, Cone, FlatPunch, Indenter, Sphere};
use contact_dma::material::{
    Compressibility, Creep, CreepBranch, Material, ModulusKind, Relaxation, RelaxationBranch,
    classical, library,
};
use contact_dma::reference::steady::HarmonicContact;
use contact_dma::simulation::{Simulation, SimulationEnd, SimulationOutcome, scenario};
use contact_dma::sweep::Sweep;
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::plan::layer::LayerPlan;
use contact_dma::sweep::plan::{Case, SweepPlan};
use contact_dma::sweep::record::error_bars::Quantity;
use contact_dma::sweep::record::{CaseRecord, CaseResult, Status};

// Materials.

/// A series of relaxation: the modulus at rest, and modulus (Pa) and time (s) of each branch.
pub fn series(equilibrium_pa: f64, branches: &[(f64, f64)]) -> Relaxation {
    let branch = |&(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s };
    Relaxation::new(equilibrium_pa, branches.iter().map(branch).collect()).unwrap()
}

/// A solid of these Young's moduli.
pub fn solid(
    equilibrium_pa: f64,
    branches: &[(f64, f64)],
    known: impl Into<Compressibility>,
) -> Material {
    material_of(series(equilibrium_pa, branches), known)
}

/// The same of a series.
pub fn material_of(series: Relaxation, known: impl Into<Compressibility>) -> Material {
    Material::from_relaxation(series, ModulusKind::Longitudinal, known).unwrap()
}

/// A series of creep: the compliance at once, compliance (1/Pa) and time (s) of each branch, the viscosity (Pa s) of a fluid.
pub fn creep(at_once_per_pa: f64, branches: &[(f64, f64)], viscosity_pa_s: Option<f64>) -> Creep {
    let branch = |&(compliance_per_pa, time_s)| CreepBranch {
        compliance_per_pa,
        time_s,
    };
    let branches = branches.iter().map(branch).collect();
    Creep::new(at_once_per_pa, branches, viscosity_pa_s).unwrap()
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

/// A table of dynamic data: the moduli of a solid at temperatures (°C) and frequencies (Hz), shifted by log10 a_T, each as `measured`.
pub fn dynamic_csv(
    solid: &Relaxation,
    (temperatures_c, frequencies_hz): (&[f64], &[f64]),
    log10_a_t: impl Fn(f64) -> f64,
    mut measured: impl FnMut(f64) -> f64,
) -> String {
    let mut table = "temperature_c,frequency_hz,storage_modulus_pa,loss_modulus_pa\n".to_owned();
    for &celsius in temperatures_c {
        for &hertz in frequencies_hz {
            let reduced = TAU * hertz * 10_f64.powf(log10_a_t(celsius));
            let modulus = solid.complex_modulus(reduced);
            let [storage, loss] = [modulus.re, modulus.im].map(&mut measured);
            table += &format!("{celsius},{hertz:e},{storage:e},{loss:e}\n");
        }
    }
    table
}

// Indenters.

pub fn sphere(radius_m: f64) -> Arc<dyn Indenter> {
    Arc::new(ball(radius_m))
}

/// The same as a type of its own.
pub fn ball(radius_m: f64) -> Sphere {
    Sphere::new(radius_m).unwrap()
}

/// One summit of several: where it stands, its radius and its height (m).
pub fn asperity((center_x_m, center_y_m): (f64, f64), radius_m: f64, height_m: f64) -> Asperity {
    Asperity {
        center_x_m,
        center_y_m,
        radius_m,
        height_m,
    }
}

/// The contact radius of a sphere by Hertz: a^3 = (3/4) W R C.
pub fn hertz_radius_m(radius_m: f64, load_n: f64, compliance_per_pa: f64) -> f64 {
    (0.75 * load_n * radius_m * compliance_per_pa).cbrt()
}

/// A layer that is bonded to a rigid base.
pub fn bonded(thickness_m: f64) -> LayerPlan {
    LayerPlan {
        thickness_m,
        base: Base::Bonded,
        base_modulus_ratio: None,
        base_poisson_ratio: None,
    }
}

pub fn cone(half_angle_rad: f64) -> Arc<dyn Indenter> {
    Arc::new(Cone::new(half_angle_rad).unwrap())
}

pub fn punch(radius_m: f64) -> Arc<dyn Indenter> {
    Arc::new(FlatPunch::new(radius_m).unwrap())
}

// Sweeps and their cases.

/// A sweep of this contact without a hold, with everything else at its default. Tests that look at error bars ask for them.
pub fn sweep_plan(
    material: Material,
    indenter: Arc<dyn Indenter>,
    mean_n: f64,
    amplitude_n: f64,
) -> SweepPlan {
    let drive = HarmonicDrive::load(mean_n, amplitude_n).unwrap();
    let mut plan = SweepPlan::new(material, indenter, drive);
    (plan.title, plan.angular_frequencies_rad_per_s) = ("integration test".into(), vec![1.0]);
    plan.cycle.error_bars = false;
    plan
}

/// PMMA under 10 N and this amplitude.
pub fn pmma_plan(indenter: Arc<dyn Indenter>, amplitude_n: f64) -> SweepPlan {
    sweep_plan(pmma_material(), indenter, 10.0, amplitude_n)
}

/// The same sweep on so many cells and in so many steps, without error bars.
pub fn on_cells(plan: SweepPlan, cells: usize, steps: usize) -> SweepPlan {
    with(plan, |plan| {
        plan.cycle = contact_dma::sweep::plan::CyclePlan::default();
        (plan.cycle.steps, plan.cycle.error_bars) = (steps, false);
        plan.solver = contact_dma::engine::SolverPlan::default();
        (plan.solver.engine, plan.solver.cells) = (EngineKind::HalfSpace, cells);
    })
}

pub fn with_bars(plan: SweepPlan) -> SweepPlan {
    with(plan, |plan| plan.cycle.error_bars = true)
}

/// A plan with a change.
pub fn with<P>(mut plan: P, change: impl FnOnce(&mut P)) -> P {
    change(&mut plan);
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

/// The result of a case that has one.
#[track_caller]
pub fn result(plan: &SweepPlan, angular_frequency_rad_per_s: f64) -> CaseResult {
    result_of(run_case(plan, angular_frequency_rad_per_s))
}

/// The same of a sweep from values, whose case must converge.
#[track_caller]
pub fn solved(sweep: Sweep, angular_frequency_rad_per_s: f64) -> CaseResult {
    let hz = angular_frequency_rad_per_s / std::f64::consts::TAU;
    let record = sweep.case_at_hz(hz).unwrap();
    assert_eq!(record.status, Status::Converged, "{:?}", record.message);
    record.result.unwrap()
}

#[track_caller]
pub fn result_of(record: CaseRecord) -> CaseResult {
    match record.result {
        Some(result) => result,
        None => panic!("{:?}: {:?}", record.status, record.message),
    }
}

/// The energy loss (J) of a case.
#[track_caller]
pub fn loss_j(plan: &SweepPlan, angular_frequency_rad_per_s: f64) -> f64 {
    result(plan, angular_frequency_rad_per_s).loss_j()
}

/// What tests ask of a result most often.
pub trait Asked {
    /// The energy loss (J), and its error bar.
    fn loss_j(&self) -> f64;

    fn bar_j(&self) -> f64 {
        self.bar(Quantity::EnergyLoss)
    }

    /// The error bar of a quantity that has one.
    fn bar(&self, quantity: Quantity) -> f64;
}

impl Asked for CaseResult {
    fn loss_j(&self) -> f64 {
        self.analysis.energy_loss_j
    }

    fn bar(&self, quantity: Quantity) -> f64 {
        self.errors.as_ref().unwrap().of(quantity).unwrap()
    }
}

/// A contact under a sinusoidal load of these (N), at an angular frequency.
pub fn harmonic(
    (mean_n, amplitude_n): (f64, f64),
    angular_frequency_rad_per_s: f64,
    contact_compliance: &Creep,
) -> HarmonicContact<'_> {
    HarmonicContact {
        mean_n,
        amplitude_n,
        angular_frequency_rad_per_s,
        contact_compliance,
    }
}

/// Segments of a drive.
pub fn step(to: f64, duration_s: f64) -> Segment {
    Segment::Step { to, duration_s }
}

pub fn ramp(to: f64, duration_s: f64) -> Segment {
    Segment::Ramp { to, duration_s }
}

// Histories.

/// A history to its end.
#[track_caller]
pub fn simulated(plan: scenario::ScenarioPlan) -> SimulationOutcome {
    followed(&Simulation::new(plan).unwrap())
}

#[track_caller]
pub fn followed(simulation: &Simulation) -> SimulationOutcome {
    let outcome = simulation.run(&AtomicBool::new(false), &|_, _| {});
    assert_eq!(outcome.ended, SimulationEnd::Done);
    outcome
}

// Numbers.

/// Order p of errors that fall like n^-p: the slope of a straight line through (ln n, ln error).
pub fn observed_order(points: &[usize], errors: &[f64]) -> f64 {
    let logarithms = points.iter().zip(errors);
    let logarithms: Vec<_> = logarithms
        .map(|(&n, e)| ((n as f64).ln(), e.abs().ln()))
        .collect();
    let count = logarithms.len() as f64;
    let mean_x = logarithms.iter().map(|l| l.0).sum::<f64>() / count;
    let mean_y = logarithms.iter().map(|l| l.1).sum::<f64>() / count;
    let products = logarithms.iter().map(|l| (l.0 - mean_x) * (l.1 - mean_y));
    let squares = logarithms.iter().map(|l| (l.0 - mean_x).powi(2));
    -products.sum::<f64>() / squares.sum::<f64>()
}

/// Relative difference from an expected value.
pub fn relative(value: f64, expected: f64) -> f64 {
    value / expected - 1.0
}

/// The largest of some numbers, and zero.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

/// The largest difference of numbers and others.
pub fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    largest(one.iter().zip(other).map(|(a, b)| (a - b).abs()))
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

/// So many numbers from one to another, as far apart in their logarithms.
pub fn log_spaced(from: f64, to: f64, count: usize) -> Vec<f64> {
    let part = |k: usize| k as f64 / (count - 1) as f64;
    (0..count)
        .map(|k| from * (to / from).powf(part(k)))
        .collect()
}

/// A whole number that whoever runs the tests asks for, or another.
pub fn from_environment(name: &str, otherwise: u64) -> u64 {
    let asked = std::env::var(name).ok();
    asked.map_or(otherwise, |text| text.parse().expect("a whole number"))
}
