//! Figures 8 to 12: the Zener half-space under W = (W0/2) (1 + sin(2 pi f t/tau + 3 pi/2)), computed once for all of them.

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use super::by_engine::{ByEngine, at_frequency, run};
use super::stabilised::{Stabilised, by_sweep, stabilised};
use super::{Figure, Plans, ReproductionError, Result, Scale, figure_08_09, figure_10_12};
use crate::contact::surface::Surface;
use crate::cycle::{self, Extrema, Loop};
use crate::engine::EngineKind;
use crate::reference::steady::HarmonicContact;
use crate::simulation::scenario::ScenarioPlan;
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::CaseResult;

/// Time steps per cycle on cells.
pub(super) const STEPS_ON_CELLS: usize = 64;
/// How much finer the refined cycles are in time.
const FINER: usize = 4;
/// Half the distance, in ln f, of the frequencies through which the maximum of the loss is drawn.
const PEAK_REACH: f64 = 0.2;

/// One load frequency f = omega tau / 2 pi. Exact is what is refined.
pub(super) struct Case {
    pub(super) f: f64,
    pub(super) numbers: ByEngine<Numbers>,
    pub(super) samples: ByEngine<Loop>,
    /// At the quarters of the cycle, on springs and on cells.
    pub(super) surfaces: [Vec<Surface>; 2],
    /// Side of a cell in Hertz radii.
    pub(super) cell: f64,
    pub(super) closed: ClosedForms,
}

/// What a cycle comes to, normalised: its energy loss, and the largest contact radius, approach and pressure in it. `None` where
/// a pressure is not bounded.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbers {
    pub(super) loss: f64,
    pub(super) radius: Option<f64>,
    pub(super) approach: Option<f64>,
    pub(super) pressure: Option<f64>,
}

/// What is known exactly of a stabilised cycle, normalised; its largest values only where the body is solid.
#[derive(Debug, Clone, Copy)]
pub(super) struct ClosedForms {
    pub(super) radius: Option<f64>,
    pub(super) approach: Option<f64>,
    /// By how much the maximum of the approach comes after that of the load (tau).
    pub(super) lag: f64,
}

/// Everything that the five figures show.
pub(super) struct Cycles<'a> {
    plan: &'a SweepPlan,
    pub(super) scale: Scale,
    tau_s: f64,
    pub(super) cases: Vec<Case>,
    /// Distance of each cycle from rest to the stabilised one, by frequency.
    pub(super) from_rest: Vec<(f64, ByEngine<Vec<f64>>)>,
    pub(super) cells: usize,
    /// Cells per side for the cycles from rest.
    pub(super) cells_from_rest: usize,
    /// Over frequency, by the axisymmetric engine.
    pub(super) curve: Vec<(f64, Numbers)>,
    /// f of figures 10, 11 and 12.
    pub(super) shown: [Vec<f64>; 3],
}

/// The figures.
pub(super) fn figures(plans: &Plans, interrupt: &AtomicBool) -> Result<Vec<Figure>> {
    let cycles = compute(plans, interrupt)?;
    let mut figures = figure_08_09::figures(plans, &cycles, interrupt)?;
    figures.extend(figure_10_12::figures(&cycles)?);
    Ok(figures)
}

fn compute<'a>(plans: &'a Plans, interrupt: &AtomicBool) -> Result<Cycles<'a>> {
    let plan = plans.sweep("figure-12")?;
    let scale = Scale::new(
        &plan.base.contact.material,
        plan.base.contact.indenter.as_ref(),
        plan.base.drive.maximum(),
    )?;
    let branch = scale.contact_compliance.branches().first();
    let unfit = || ReproductionError::Unfit("a Zener body has a retardation time".to_owned());
    let tau_s = branch.ok_or_else(unfit)?.time_s;
    // In units of 1/tau.
    let frequencies = |name| -> Result<Vec<f64>> {
        let omegas = &plans.sweep(name)?.angular_frequencies_rad_per_s;
        Ok(omegas.iter().map(|omega| omega * tau_s / TAU).collect())
    };
    let shown = [
        frequencies("figure-10")?,
        frequencies("figure-11")?,
        frequencies("figure-12")?,
    ];
    let about_the_peak = [-PEAK_REACH, 0.0, PEAK_REACH].map(|shift: f64| shift.exp() / TAU);
    let wanted = in_order([&shown[2][..], &shown[1], &about_the_peak].concat());
    let over = in_order([frequencies("figure-12-peak")?, shown[0].clone()].concat());
    let mut cycles = Cycles {
        plan,
        cells: plan.solver.cells,
        // Coarse: how fast the start is forgotten hardly depends on the grid.
        cells_from_rest: plan.solver.cells / 4,
        scale,
        tau_s,
        cases: Vec::new(),
        from_rest: Vec::new(),
        curve: Vec::new(),
        shown,
    };
    let cases = wanted.par_iter().with_max_len(1);
    let cases = cases.map(|&f| cycles.compute(f, interrupt));
    let scenario = plans.scenario("figure-08-a")?;
    let from_rest = cycles.shown[2].par_iter();
    let from_rest =
        from_rest.map(|&f| Ok((f, cycles.distances_from_rest(scenario, f, interrupt)?)));
    let curve = over.par_iter().map(|&f| {
        let result = by_sweep(plan, cycles.omega(f), 1, interrupt)?;
        Ok((f, cycles.numbers(&result)))
    });
    let cases: Result<Vec<Case>> = cases.collect();
    let from_rest: Result<_> = from_rest.collect();
    let curve: Result<_> = curve.collect();
    (cycles.cases, cycles.from_rest, cycles.curve) = (cases?, from_rest?, curve?);
    Ok(cycles)
}

/// Sorted, each once.
fn in_order(mut frequencies: Vec<f64>) -> Vec<f64> {
    frequencies.sort_by(f64::total_cmp);
    frequencies.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    frequencies
}

/// The first cycle, counted from 1, that is within this distance.
pub(super) fn cycles_to(distances: &[f64], part: f64) -> Option<f64> {
    let near = distances.iter().position(|distance| *distance <= part);
    near.map(|place| (place + 1) as f64)
}

impl Cycles<'_> {
    fn omega(&self, f: f64) -> f64 {
        TAU * f / self.tau_s
    }

    fn compute(&self, f: f64, interrupt: &AtomicBool) -> Result<Case> {
        let (plan, omega) = (self.plan, self.omega(f));
        let on = |engine, steps| stabilised(plan, omega, engine, steps, interrupt);
        let refined = by_sweep(plan, omega, FINER, interrupt)?;
        let springs = by_sweep(plan, omega, 1, interrupt)?;
        let on_springs = on(EngineKind::Axisymmetric, plan.cycle.steps)?;
        let on_cells = on(EngineKind::HalfSpace, STEPS_ON_CELLS)?;
        let computed = [self.numbers(&springs), self.numbers_on_cells(&on_cells)?];
        Ok(Case {
            f,
            numbers: ByEngine::of(self.numbers(&refined), computed),
            samples: ByEngine::of(
                refined.cycle.samples,
                [springs.cycle.samples, on_cells.samples],
            ),
            surfaces: [on_springs.surfaces, on_cells.surfaces],
            cell: on_cells.spacing_m / self.scale.contact_radius_m,
            closed: self.closed_forms(f),
        })
    }

    pub(super) fn closed_forms(&self, f: f64) -> ClosedForms {
        let (scale, omega) = (&self.scale, self.omega(f));
        let contact = HarmonicContact {
            mean_n: self.plan.base.drive.mean(),
            amplitude_n: self.plan.base.drive.amplitude(),
            angular_frequency_rad_per_s: omega,
            contact_compliance: &scale.contact_compliance,
        };
        let maxima = contact.sphere_maxima(scale.sphere_radius_m);
        let compliance = scale.contact_compliance.complex_compliance(omega);
        ClosedForms {
            radius: maxima.map(|(radius_m, _)| radius_m / scale.contact_radius_m),
            approach: maxima.map(|(_, approach_m)| approach_m / scale.approach_m),
            lag: -compliance.arg() / omega / self.tau_s,
        }
    }

    fn numbers(&self, result: &CaseResult) -> Numbers {
        let scale = &self.scale;
        Numbers {
            loss: result.analysis.energy_loss_j / scale.energy_j(),
            radius: Some(result.contact_radius_m.maximum / scale.contact_radius_m),
            approach: Some(result.approach_m.maximum / scale.approach_m),
            pressure: result
                .peak_pressure_pa
                .map(|pressure| pressure.maximum / scale.pressure_pa),
        }
    }

    fn numbers_on_cells(&self, cycle: &Stabilised) -> Result<Numbers> {
        let (samples, scale) = (&cycle.samples, &self.scale);
        let largest = |signal: &[f64]| Extrema::of(signal).map(|e| e.maximum);
        let pressures: Option<Vec<f64>> = samples.peak_pressure_pa.iter().copied().collect();
        let analysis = cycle::analyse(&samples.load_n, &samples.approach_m)?;
        // A radius that is counted in cells has no parabola through its maximum.
        let radius_m = samples.contact_radius_m.iter().copied().reduce(f64::max);
        let over = |value: Option<f64>, unit: f64| value.map(|value| value / unit);
        Ok(Numbers {
            loss: analysis.energy_loss_j / scale.energy_j(),
            radius: over(radius_m, scale.contact_radius_m),
            approach: over(largest(&samples.approach_m), scale.approach_m),
            pressure: over(pressures.and_then(|p| largest(&p)), scale.pressure_pa),
        })
    }

    /// Cycles from rest until what is left of the start is a ten thousandth: by how much the approach of each differs from that
    /// of the last at most, as a part of the largest.
    fn distances_from_rest(
        &self,
        scenario: &ScenarioPlan,
        f: f64,
        interrupt: &AtomicBool,
    ) -> Result<ByEngine<Vec<f64>>> {
        let cycles = (10.0 * f).ceil().max(4.0) as usize;
        let omega = self.omega(f);
        let distances = |engine, nodes: usize, steps: usize| {
            let mut plan = at_frequency(scenario, omega, Some(cycles))?;
            plan.step_s = Some(TAU / omega / steps as f64);
            plan.solver.engine = engine;
            plan.solver = plan.solver.with_nodes(nodes);
            let rows = run(plan, interrupt)?.rows;
            let approaches_m: Vec<f64> = rows.iter().filter_map(|row| row.approach_m).collect();
            let largest_m = approaches_m.iter().copied().fold(0.0, f64::max);
            let last = &approaches_m[approaches_m.len().saturating_sub(steps + 1)..];
            let distance = |k: usize| {
                let cycle = approaches_m.iter().skip(k * steps).zip(last);
                cycle.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest_m
            };
            Ok::<_, ReproductionError>((0..cycles).map(distance).collect::<Vec<_>>())
        };
        let (springs, steps) = (self.plan.solver.springs, self.plan.cycle.steps);
        Ok(ByEngine {
            exact: distances(EngineKind::Axisymmetric, 2 * springs, FINER * steps)?,
            axisymmetric: distances(EngineKind::Axisymmetric, springs, steps)?,
            half_space: distances(EngineKind::HalfSpace, self.cells_from_rest, STEPS_ON_CELLS)?,
        })
    }

    /// The case of a frequency.
    pub(super) fn case(&self, f: f64) -> Result<&Case> {
        let near = |case: &&Case| (case.f / f - 1.0).abs() < 1e-9;
        let found = self.cases.iter().find(near);
        found.ok_or_else(|| ReproductionError::Unfit(format!("f = {f} was not computed")))
    }

    /// The cases of one of the figures 10, 11 and 12.
    pub(super) fn cases_of(&self, figure: usize) -> Result<Vec<&Case>> {
        self.shown[figure].iter().map(|&f| self.case(f)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_near_cycle_is_counted_from_one() {
        let distances = [0.5, 0.05, 0.009, 0.0005, 0.0];
        assert_eq!(cycles_to(&distances, 0.01), Some(3.0));
        assert_eq!(cycles_to(&distances, 0.001), Some(4.0));
        assert_eq!(cycles_to(&[], 0.1), None);
    }
}
