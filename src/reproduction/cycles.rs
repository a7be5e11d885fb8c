//! Figures 8 to 12: the Zener half-space under W = (W0/2) (1 + sin(2 pi f t/tau + 3 pi/2)), computed once for all of them.

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use super::stabilised::{Stabilised, by_sweep, distances_from_rest, stabilised};
use super::{Figure, Plans, ReproductionError, Scale, figure_08_09, figure_10_12};
use crate::reference::steady::HarmonicContact;
use crate::sweep::plan::{EngineKind, SolverPlan, SweepPlan};
use crate::sweep::record::CaseResult;

/// Time steps per cycle on cells.
pub(super) const STEPS_ON_CELLS: usize = 64;
/// How much finer the refined cycles are in time.
const FINER: usize = 4;
/// Half the distance, in ln f, of the frequencies through which the maximum of the loss is drawn.
const PEAK_REACH: f64 = 0.2;

/// One load frequency f = omega tau / 2 pi.
pub(super) struct Case {
    pub(super) f: f64,
    pub(super) springs: CaseResult,
    pub(super) refined: CaseResult,
    /// Of the axisymmetric engine, with its surfaces.
    pub(super) on_springs: Stabilised,
    pub(super) on_cells: Stabilised,
    pub(super) closed: ClosedForms,
}

/// What is known exactly of a stabilised cycle, normalised; its largest values only where the body is solid.
#[derive(Debug, Clone, Copy)]
pub(super) struct ClosedForms {
    pub(super) largest_radius: Option<f64>,
    pub(super) largest_approach: Option<f64>,
    /// By how much the maximum of the approach comes after that of the load (tau).
    pub(super) lag: f64,
}

/// Distance of each cycle from rest to the stabilised one.
pub(super) struct FromRest {
    pub(super) f: f64,
    pub(super) springs: Vec<f64>,
    pub(super) refined: Vec<f64>,
    pub(super) cells: Vec<f64>,
}

/// What a cycle at one frequency comes to, normalised.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvePoint {
    pub(super) f: f64,
    pub(super) loss: f64,
    pub(super) largest_radius: f64,
    pub(super) largest_pressure: Option<f64>,
}

/// Everything that the five figures show.
pub(super) struct Cycles {
    pub(super) scale: Scale,
    pub(super) cases: Vec<Case>,
    pub(super) from_rest: Vec<FromRest>,
    pub(super) cells: usize,
    /// Cells per side for the cycles from rest.
    pub(super) cells_from_rest: usize,
    /// Over frequency, by the axisymmetric engine.
    pub(super) curve: Vec<CurvePoint>,
    /// f of figures 10, 11 and 12.
    pub(super) shown: [Vec<f64>; 3],
}

/// The figures.
pub(super) fn figures(
    plans: &Plans,
    interrupt: &AtomicBool,
) -> Result<Vec<Figure>, ReproductionError> {
    let cycles = compute(plans, interrupt)?;
    let mut figures = figure_08_09::figures(plans, &cycles, interrupt)?;
    figures.extend(figure_10_12::figures(&cycles)?);
    Ok(figures)
}

/// Frequencies of a sweep in units of 1/tau.
fn frequencies(plan: &SweepPlan, tau_s: f64) -> Vec<f64> {
    let omegas = plan.angular_frequencies_rad_per_s.iter();
    omegas.map(|omega| omega * tau_s / TAU).collect()
}

fn compute(plans: &Plans, interrupt: &AtomicBool) -> Result<Cycles, ReproductionError> {
    let plan = plans.sweep("figure-12")?;
    let scale = Scale::new(&plan.material, plan.indenter.as_ref(), plan.drive.maximum())?;
    let tau_s = scale
        .contact_compliance
        .branches()
        .first()
        .map(|branch| branch.time_s)
        .ok_or_else(|| {
            ReproductionError::Unfit("a Zener body has a retardation time".to_owned())
        })?;
    let shown = [
        frequencies(plans.sweep("figure-10")?, tau_s),
        frequencies(plans.sweep("figure-11")?, tau_s),
        frequencies(plan, tau_s),
    ];
    let mut wanted: Vec<f64> = shown[2].iter().chain(&shown[1]).copied().collect();
    wanted.extend([-PEAK_REACH, 0.0, PEAK_REACH].map(|shift: f64| shift.exp() / TAU));
    wanted.sort_by(f64::total_cmp);
    wanted.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let cases = wanted
        .par_iter()
        .with_max_len(1)
        .map(|&f| case(plan, &scale, f, tau_s, interrupt))
        .collect::<Result<Vec<Case>, ReproductionError>>()?;
    // Coarse: how fast the start is forgotten hardly depends on the grid.
    let cells_from_rest = plan.solver.cells / 4;
    let from_rest = shown[2]
        .par_iter()
        .map(|&f| from_rest(plan, cells_from_rest, f, TAU * f / tau_s, interrupt))
        .collect::<Result<Vec<FromRest>, ReproductionError>>()?;
    let mut over: Vec<f64> = frequencies(plans.sweep("figure-12-peak")?, tau_s);
    over.extend(&shown[0]);
    over.sort_by(f64::total_cmp);
    over.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let curve = over
        .par_iter()
        .map(|&f| {
            let result = by_sweep(plan, TAU * f / tau_s, 1, interrupt)?;
            Ok(CurvePoint {
                f,
                loss: loss(&result, &scale),
                largest_radius: radius(&result, &scale),
                largest_pressure: pressure(&result, &scale),
            })
        })
        .collect::<Result<Vec<_>, ReproductionError>>()?;
    Ok(Cycles {
        cells: plan.solver.cells,
        scale,
        cases,
        from_rest,
        cells_from_rest,
        curve,
        shown,
    })
}

/// Energy loss of a cycle / (W0 delta_H).
pub(super) fn loss(result: &CaseResult, scale: &Scale) -> f64 {
    result.analysis.energy_loss_j / scale.energy_j()
}

/// Largest contact radius of a cycle / a_H.
pub(super) fn radius(result: &CaseResult, scale: &Scale) -> f64 {
    result.contact_radius_m.maximum / scale.contact_radius_m
}

/// Largest pressure of a cycle / p_H, where the pressure is bounded.
pub(super) fn pressure(result: &CaseResult, scale: &Scale) -> Option<f64> {
    Some(result.peak_pressure_pa?.maximum / scale.pressure_pa)
}

fn case(
    plan: &SweepPlan,
    scale: &Scale,
    f: f64,
    tau_s: f64,
    interrupt: &AtomicBool,
) -> Result<Case, ReproductionError> {
    let omega = TAU * f / tau_s;
    let compliance = scale.contact_compliance.complex_compliance(omega);
    let contact = HarmonicContact {
        mean_n: plan.drive.mean(),
        amplitude_n: plan.drive.amplitude(),
        angular_frequency_rad_per_s: omega,
        contact_compliance: &scale.contact_compliance,
    };
    let maxima = contact.sphere_maxima(scale.sphere_radius_m);
    let steps = plan.cycle.steps;
    Ok(Case {
        f,
        springs: by_sweep(plan, omega, 1, interrupt)?,
        refined: by_sweep(plan, omega, FINER, interrupt)?,
        on_springs: stabilised(plan, omega, EngineKind::Axisymmetric, steps, interrupt)?,
        on_cells: stabilised(
            plan,
            omega,
            EngineKind::HalfSpace,
            STEPS_ON_CELLS,
            interrupt,
        )?,
        closed: ClosedForms {
            largest_radius: maxima.map(|(radius_m, _)| radius_m / scale.contact_radius_m),
            largest_approach: maxima.map(|(_, approach_m)| approach_m / scale.approach_m),
            lag: -compliance.arg() / omega / tau_s,
        },
    })
}

/// Cycles from rest until what is left of the start is a ten thousandth, on both engines.
fn from_rest(
    plan: &SweepPlan,
    cells: usize,
    f: f64,
    omega: f64,
    interrupt: &AtomicBool,
) -> Result<FromRest, ReproductionError> {
    let cycles = (10.0 * f).ceil().max(4.0) as usize;
    let springs = SolverPlan {
        engine: EngineKind::Axisymmetric,
        ..plan.solver
    };
    let refined = SolverPlan {
        springs: 2 * springs.springs,
        ..springs
    };
    let on_cells = SolverPlan {
        engine: EngineKind::HalfSpace,
        cells,
        ..plan.solver
    };
    let distances =
        |solver, steps| distances_from_rest(plan, solver, omega, steps, cycles, interrupt);
    Ok(FromRest {
        f,
        springs: distances(springs, plan.cycle.steps)?,
        refined: distances(refined, FINER * plan.cycle.steps)?,
        cells: distances(on_cells, STEPS_ON_CELLS)?,
    })
}

impl FromRest {
    /// The first cycle, counted from 1, that is within this distance.
    pub(super) fn cycles_to(distances: &[f64], part: f64) -> Option<f64> {
        let near = distances.iter().position(|distance| *distance <= part);
        near.map(|place| (place + 1) as f64)
    }
}

impl Cycles {
    /// The case of a frequency.
    pub(super) fn case(&self, f: f64) -> Result<&Case, ReproductionError> {
        let near = |case: &&Case| (case.f / f - 1.0).abs() < 1e-9;
        let found = self.cases.iter().find(near);
        found.ok_or_else(|| ReproductionError::Unfit(format!("f = {f} was not computed")))
    }

    /// The three cases about the maximum of the loss.
    pub(super) fn about_the_peak(&self) -> Result<[&Case; 3], ReproductionError> {
        let [low, middle, high] =
            [-PEAK_REACH, 0.0, PEAK_REACH].map(|shift: f64| self.case(shift.exp() / TAU));
        Ok([low?, middle?, high?])
    }
}

/// Maximum of the parabola through three points with equally spaced ln x: (x, y).
pub(super) fn peak(points: [(f64, f64); 3]) -> (f64, f64) {
    let [(low, before), (middle, here), (high, after)] = points;
    let width = 0.5 * (high / low).ln();
    let curvature = before - 2.0 * here + after;
    let slope = 0.5 * (after - before);
    let x = middle * (-width * slope / curvature).exp();
    (x, here - 0.5 * slope * slope / curvature)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_in_the_logarithm_has_its_maximum_found() {
        let y = |x: f64| 3.0 - 2.0 * (x / 0.7).ln().powi(2);
        let found = peak([0.5, 0.6, 0.72].map(|x: f64| (x, y(x))));
        assert!((found.0 - 0.7).abs() < 1e-12 && (found.1 - 3.0).abs() < 1e-12);
    }

    #[test]
    fn the_first_near_cycle_is_counted_from_one() {
        let distances = [0.5, 0.05, 0.009, 0.0005, 0.0];
        assert_eq!(FromRest::cycles_to(&distances, 0.01), Some(3.0));
        assert_eq!(FromRest::cycles_to(&distances, 0.001), Some(4.0));
        assert_eq!(FromRest::cycles_to(&[], 0.1), None);
    }
}
