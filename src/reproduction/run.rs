//! What figures are computed from: histories and stabilised cycles by either engine, each once, whatever figures show it.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use super::table::{Quantity, Row, instant, pressure, row, surface};
use super::{ReproductionError, Result};
use crate::contact::surface::Surface;
use crate::drive::{Segment, SegmentedDrive};
use crate::engine::{EngineKind, SolverPlan};
use crate::simulation::scenario::{self, ScenarioPlan};
use crate::simulation::{HistoryRow, Simulation, SimulationEnd, SimulationOutcome};
use crate::sweep::case::Setup;
use crate::sweep::plan::{Case, SweepPlan, resolved};
use crate::sweep::record::{CaseRecord, CaseResult};

/// Time steps per cycle on cells.
const STEPS_ON_CELLS: usize = 64;
/// Distance to the stabilised cycle on cells: far below what their size does.
const TOLERANCE_ON_CELLS: f64 = 3e-5;

/// How a file is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum By {
    /// Twice as many springs as the file gives; histories in time steps half as long as on springs, cycles in a quarter.
    Refined,
    /// Springs; histories in time steps a tenth of those in the file.
    Springs,
    /// Cells; histories in the time steps of the file.
    Cells,
}

/// One thing exactly (in closed form, or refined), by the axisymmetric engine and by the half-space engine: in the order of `By`.
pub type ByEngine<T> = [T; 3];

impl By {
    pub const ALL: [Self; 3] = [Self::Refined, Self::Springs, Self::Cells];
}

/// One computation.
#[derive(Debug, Clone)]
pub(super) enum Run {
    History(Box<ScenarioPlan>),
    /// At the one frequency of the plan.
    Cycle(Box<SweepPlan>),
}

/// Its result, in SI units.
#[derive(Debug)]
pub(super) struct Outcome {
    pub instants: Vec<Row>,
    /// At the times of the profiles of a history, at the quarters of a cycle.
    pub surfaces: Vec<Vec<Row>>,
    /// The energy, and of a cycle the largest values.
    pub numbers: Row,
    /// At all nodes of the surfaces of a history.
    pub pressures_pa: Vec<Vec<f64>>,
    /// Half the side of the square of cells.
    pub half_width_m: f64,
}

impl Run {
    /// Without error bars: the other engine and a refined run say more.
    pub fn history(scenario: &ScenarioPlan, by: By) -> Self {
        let mut plan = Box::new(scenario.clone());
        let (engine, springs, steps) = match by {
            By::Refined => (EngineKind::Axisymmetric, 2, 20.0),
            By::Springs => (EngineKind::Axisymmetric, 1, 10.0),
            By::Cells => (EngineKind::HalfSpace, 1, 1.0),
        };
        plan.solver.engine = engine;
        plan.solver.springs *= springs;
        plan.step_s = plan.step_s.map(|step_s| step_s / steps);
        plan.output.error_bars = false;
        Self::History(plan)
    }

    /// The stabilised cycle at this angular frequency (rad/s).
    pub fn cycle(sweep: &SweepPlan, by: By, omega: f64) -> Self {
        let mut plan = Box::new(sweep.clone());
        plan.title.clear();
        plan.angular_frequencies_rad_per_s = vec![omega];
        plan.cycle.error_bars = false;
        plan.solver.engine = EngineKind::Axisymmetric;
        match by {
            By::Refined => {
                plan.solver.springs *= 2;
                plan.cycle.steps *= 4;
                plan.cycle.tolerance *= 0.1;
            }
            By::Springs => {}
            By::Cells => {
                plan.solver.engine = EngineKind::HalfSpace;
                plan.cycle.steps = STEPS_ON_CELLS;
                plan.cycle.tolerance = TOLERANCE_ON_CELLS;
            }
        }
        Self::Cycle(plan)
    }

    pub fn solver(&self) -> &SolverPlan {
        match self {
            Self::History(plan) => &plan.solver,
            Self::Cycle(plan) => &plan.solver,
        }
    }

    /// The same for runs with the same result; on cells first, which take longest, so that threads end together.
    fn key(&self) -> (bool, String) {
        let text = match self {
            Self::History(plan) => scenario::resolved_text(plan),
            Self::Cycle(plan) => resolved::resolved_text(plan),
        };
        (self.solver().engine != EngineKind::HalfSpace, text)
    }

    /// # Errors
    /// [`ReproductionError`] where it cannot be set up, fails or is interrupted.
    pub fn compute(&self, interrupt: &AtomicBool) -> Result<Outcome> {
        match self {
            Self::History(plan) => {
                let outcome = Simulation::new((**plan).clone())?.run(interrupt, &|_, _| {});
                match outcome.ended {
                    SimulationEnd::Done => Ok(Outcome::of_history(&outcome)),
                    SimulationEnd::Interrupted => Err(ReproductionError::Interrupted),
                    SimulationEnd::Failed(why) => Err(unfit(format!("{}: {why}", plan.title))),
                }
            }
            Self::Cycle(plan) => {
                let omega = plan.angular_frequencies_rad_per_s[0];
                let case = Case {
                    index: 0,
                    angular_frequency_rad_per_s: omega,
                    condition: plan.base.clone(),
                };
                let record = Setup::new((**plan).clone())?.run(&case, interrupt);
                let record = record.ok_or(ReproductionError::Interrupted)?;
                let is_on_cells = plan.solver.engine == EngineKind::HalfSpace;
                match &record.result {
                    Some(cycle) => Ok(Outcome::of_cycle(&record, cycle, is_on_cells)),
                    None => Err(unfit(format!("{omega} rad/s: {:?}", record.message))),
                }
            }
        }
    }
}

impl Outcome {
    fn of_history(outcome: &SimulationOutcome) -> Self {
        let first_n = outcome.rows.first().map_or(1.0, |row| row.load_n);
        let relative = |row: &HistoryRow| (Quantity::RelaxationModulus, row.load_n / first_n);
        let instant = |row| instant(row).into_iter().chain([relative(row)]).collect();
        let instants = outcome.rows.iter().map(instant).collect();
        let energy_j = outcome.rows.last().and_then(|row| row.work_j);
        let surfaces = outcome.profiles.iter().map(|profile| &profile.surface);
        Self {
            surfaces: surfaces.clone().map(surface).collect(),
            pressures_pa: surfaces.map(nodal_pressures_pa).collect(),
            numbers: row([(Quantity::Energy, energy_j)]),
            instants,
            half_width_m: outcome.domain_half_width_m,
        }
    }

    fn of_cycle(record: &CaseRecord, cycle: &CaseResult, is_on_cells: bool) -> Self {
        let samples = &cycle.cycle.samples;
        let steps = samples.time_s.len() - 1;
        let sample = |k: usize| {
            instant(&HistoryRow {
                time_s: k as f64 / steps as f64,
                load_n: samples.load_n[k],
                approach_m: Some(samples.approach_m[k]),
                contact_radius_m: samples.contact_radius_m[k],
                peak_pressure_pa: samples.peak_pressure_pa[k],
                work_j: None,
            })
        };
        // A radius that is counted in cells has no parabola through its maximum.
        let radius_m = match is_on_cells {
            true => samples.contact_radius_m.iter().copied().fold(0.0, f64::max),
            false => cycle.contact_radius_m.maximum,
        };
        let energy_j = Some(cycle.analysis.energy_loss_j);
        let peak_pressure_pa = cycle.peak_pressure_pa.map(|p| p.maximum);
        let profiles = cycle.cycle.pressures.iter();
        let lines = profiles.filter_map(|profile| profile.lines.first());
        Self {
            instants: (0..=steps).map(sample).collect(),
            surfaces: lines.map(pressure).collect(),
            numbers: row([
                (Quantity::Energy, energy_j),
                (Quantity::Loss, energy_j),
                (Quantity::ContactRadius, Some(radius_m)),
                (Quantity::Approach, Some(cycle.approach_m.maximum)),
                (Quantity::PeakPressure, peak_pressure_pa),
            ]),
            pressures_pa: Vec::new(),
            half_width_m: record.domain_half_width_m,
        }
    }
}

/// The pressure at every node of a surface, 0 where it is not bounded.
pub(super) fn nodal_pressures_pa(surface: &Surface) -> Vec<f64> {
    match surface {
        Surface::Radial(radial) => {
            let pressures_pa = radial.pressure_pa.iter();
            pressures_pa.map(|pa| pa.unwrap_or(0.0)).collect()
        }
        Surface::Cells(cells) => cells.pressure_pa.clone(),
    }
}

pub(super) fn unfit(why: impl Into<String>) -> ReproductionError {
    ReproductionError::Unfit(why.into())
}

/// The outcomes of these runs of figures, in their order, each run computed once and all in parallel. `finished` is called with every
/// figure of which all are.
///
/// # Errors
/// The first of a run.
pub(super) fn outcomes(
    runs: &[(u8, &Run)],
    interrupt: &AtomicBool,
    finished: &(dyn Fn(u8) + Sync),
) -> Result<Vec<Arc<Outcome>>> {
    let keys: Vec<_> = runs.iter().map(|(_, run)| run.key()).collect();
    let mut wanted: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    let mut open: BTreeMap<u8, AtomicUsize> = BTreeMap::new();
    for (place, (figure, _)) in runs.iter().enumerate() {
        wanted.entry(&keys[place]).or_default().push(place);
        *open.entry(*figure).or_default().get_mut() += 1;
    }
    let wanted: Vec<_> = wanted.into_iter().collect();
    let computed = wanted.par_iter().with_max_len(1).map(|(key, places)| {
        let outcome = Arc::new(runs[places[0]].1.compute(interrupt)?);
        for (figure, _) in places.iter().map(|place| &runs[*place]) {
            if open[figure].fetch_sub(1, Ordering::Relaxed) == 1 {
                finished(*figure);
            }
        }
        Ok((*key, outcome))
    });
    let computed: BTreeMap<_, _> = computed.collect::<Result<_>>()?;
    Ok(keys.iter().map(|key| Arc::clone(&computed[key])).collect())
}

/// The scenario with another angular frequency (rad/s) in its sine; on this many cells per side also for as many cycles as it takes
/// until a ten thousandth is left of the start.
///
/// # Errors
/// [`ReproductionError::Drive`] where that is no history.
pub(super) fn at_frequency(
    scenario: &ScenarioPlan,
    omega: f64,
    from_rest_on_cells: Option<usize>,
) -> Result<ScenarioPlan> {
    let mut plan = scenario.clone();
    let mut segments = scenario.drive.segments().to_vec();
    for segment in &mut segments {
        if let Segment::Sine {
            angular_frequency_rad_per_s,
            cycles,
            ..
        } = segment
        {
            *angular_frequency_rad_per_s = omega;
            if let Some(side) = from_rest_on_cells {
                *cycles = (10.0 * omega / TAU).ceil().max(4.0);
                plan.step_s = Some(TAU / omega / STEPS_ON_CELLS as f64);
                plan.solver.cells = side;
            }
        }
    }
    plan.drive = SegmentedDrive::new(scenario.drive.control(), segments)?;
    Ok(plan)
}
