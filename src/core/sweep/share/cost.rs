//! What a sweep costs: time from cases tried on this machine, memory from what a case keeps, disk from what a record takes.

use std::time::{Duration, Instant};

use crate::engine::EngineKind;
use crate::engine::{EngineBuilder, prescribed};
use crate::history::{March, kept_bytes, rings};
use crate::material::Creep;
use crate::sweep::case::{Setup, SetupError};
use crate::sweep::plan::{Case, Method, SweepPlan};
use crate::sweep::share::trial::{self, Trial};

/// What a sweep costs, predicted from some of its cases. On cells, where fewer of them are tried than asked for, the time is good to a
/// factor of two or so.
#[derive(Debug, Clone)]
pub struct Cost {
    /// Per case, in the order of the sweep.
    pub cases: Vec<CaseCost>,
    /// Time (s) on one thread of locating the peaks.
    pub peaks_s: f64,
    /// Time (s) of tables, figures and page, which is the same on any number of threads.
    pub report_s: f64,
    /// Memory (bytes) of the program and a case under way; every thread more has a case.
    pub memory_bytes: u64,
    /// Memory (bytes) of the results of all cases, which are held until tables and figures are made of them.
    pub results_bytes: u64,
    /// What the folder will take (bytes).
    pub disk_bytes: u64,
    /// Time (s) of one step of the full number of nodes, as measured.
    pub step_s: f64,
}

/// What a case costs on one thread.
#[derive(Debug, Clone)]
pub struct CaseCost {
    pub case: Case,
    /// Cycles of the full number of steps and nodes.
    pub cycles: f64,
    pub time_s: f64,
}

/// Drawing figures and page takes this long (s), and every row of their tables this much more: both measured on one machine.
const FIGURES_S: f64 = 0.3;
const ROW_S: f64 = 1.2e-4;
/// What figures and page take (bytes), a row of tables, and the tables of one cycle per step.
const FIGURES_BYTES: u64 = 6_000_000;
const ROW_BYTES: u64 = 1_700;
const TABLE_BYTES: u64 = 450;
/// What a result takes in memory (bytes), with its row in tables, and a step of a cycle that is held.
const RESULT_BYTES: u64 = 6_300;
const STEP_BYTES: u64 = 100;
/// What making figures and page takes (bytes), fonts and pictures.
const DRAWING_BYTES: u64 = 18_000_000;
/// Cases of a large sweep that have tables of their cycles.
const TABLES_OF_LARGE: usize = 6;
/// Cells of the grid on which steps are taken, at most: larger ones are predicted from it.
const CELLS_MEASURED: usize = 128;
/// Steps are taken for this long, but no fewer than some.
const MEASURED: Duration = Duration::from_millis(200);
const FEWEST_STEPS: u32 = 4;
/// Time (s) below which a shard is not worth its start.
const SHARD_S: f64 = 600.0;

impl Cost {
    /// Measures and predicts; drawing its largest figure takes so many bytes.
    ///
    /// # Errors
    /// [`SetupError`] where no engine can be made. Where no step can be taken, the measured time is that of the attempt.
    pub fn of(setup: &Setup, drawing_bytes: u64) -> Result<Self, SetupError> {
        let at_accuracy = trial::at_accuracy(setup)?;
        let setup = at_accuracy.as_ref().unwrap_or(setup);
        let (step_s, predicted_s) = predicted(setup)?;
        let trial = Trial::of(setup, &predicted_s)?;
        let plan = setup.plan();
        let cases = plan.cases().into_iter().zip(&predicted_s);
        let cases: Vec<CaseCost> = cases
            .map(|(case, predicted_s)| CaseCost {
                cycles: setup.predicted_cycles(&case),
                time_s: predicted_s * trial.factor,
                case,
            })
            .collect();
        let count = cases.len() as f64;
        let mean_s = cases.iter().map(|case| case.time_s).sum::<f64>() / count.max(1.0);
        let tables = match plan.is_small() {
            true => cases.len(),
            false => TABLES_OF_LARGE,
        };
        let steps_told = (tables * plan.cycle.steps) as u64;
        let of_tables = TABLE_BYTES * steps_told;
        let of_records = cases.len() as u64 * (trial.record_bytes + ROW_BYTES);
        Ok(Self {
            peaks_s: trial::losses_of_peaks(setup) * trial.loss * mean_s,
            report_s: FIGURES_S + ROW_S * count,
            memory_bytes: setup.predicted_memory_bytes(),
            results_bytes: RESULT_BYTES * cases.len() as u64
                + STEP_BYTES * steps_told
                + DRAWING_BYTES.max(drawing_bytes),
            disk_bytes: FIGURES_BYTES + of_tables + of_records,
            cases,
            step_s,
        })
    }

    /// Time (s) of the whole on this number of threads.
    pub fn on_threads_s(&self, threads: usize) -> f64 {
        let threads = threads.clamp(1, self.cases.len().max(1)) as f64;
        (self.time_s() + self.peaks_s) / threads + self.report_s
    }

    /// Memory (bytes) of the whole on this number of threads.
    pub fn on_threads_bytes(&self, threads: usize) -> u64 {
        let more = threads.clamp(1, self.cases.len().max(1)) as u64 - 1;
        let case = self.memory_bytes.saturating_sub(PROGRAM_BYTES);
        self.memory_bytes + more * case + self.results_bytes
    }

    /// Time (s) of all cases on one thread.
    pub fn time_s(&self) -> f64 {
        self.cases.iter().map(|case| case.time_s).sum()
    }

    /// A sensible number of shards for processes of one thread each: none of them shorter than about ten minutes.
    pub fn shards(&self) -> usize {
        let wanted = (self.time_s() / SHARD_S).ceil() as usize;
        wanted.clamp(1, self.cases.len().max(1))
    }
}

impl Setup {
    /// Predicted cost of a case, in cycles: marching at a high frequency needs many to forget the start.
    pub fn predicted_cycles(&self, case: &Case) -> f64 {
        let cycle = &self.plan().cycle;
        if let Some(cycle) = cycle.at_cycle {
            return cycle as f64;
        }
        match cycle.method {
            Method::Direct => 6.0,
            Method::March => {
                let cycles_to_forget =
                    self.slowest_s(case) * case.angular_frequency_rad_per_s / std::f64::consts::TAU;
                let to_tolerance = -cycle.tolerance.ln();
                (2.0 + cycles_to_forget * to_tolerance).min(cycle.max_cycles as f64)
            }
        }
    }

    /// The longest retardation time (s) of a case; 0 for a condition of no plan, whose material makes no contact and ends at once.
    fn slowest_s(&self, case: &Case) -> f64 {
        self.solid(&case.condition).map_or(0.0, |solid| {
            let times = solid.compliance.branches().iter().map(|b| b.time_s);
            times.fold(0.0, f64::max)
        })
    }
}

/// Time (s) of a step, and of every case as steps alone predict it.
pub(super) fn predicted(setup: &Setup) -> Result<(f64, Vec<f64>), SetupError> {
    let plan = setup.plan();
    let step_s = step_s(setup)?;
    let time_s = |case: &Case| steps_of_case(plan, setup.predicted_cycles(case)) * step_s;
    Ok((step_s, plan.cases().iter().map(time_s).collect()))
}

/// Steps of the full number of nodes that a case takes: those of its own resolution, and of coarser ones for the error bars, each started
/// from the one before.
fn steps_of_case(plan: &SweepPlan, cycles: f64) -> f64 {
    let steps = |fewer_nodes: usize, fewer_steps: usize, cycles: f64| {
        let relative = relative_step(plan, plan.solver.nodes() / fewer_nodes);
        cycles * (plan.cycle.steps / fewer_steps) as f64 * relative
    };
    let has_bars = plan.cycle.error_bars && plan.base.contact.indenter.own_cells().is_none();
    if !has_bars && plan.cycle.accuracy.is_none() {
        return steps(1, 1, cycles);
    }
    // A search from the memory of coarser steps needs about half as many cycles.
    let again = match plan.cycle.method {
        Method::Direct => 0.5 * cycles,
        Method::March => cycles,
    };
    let on_fewest_steps = match plan.solver.engine {
        EngineKind::Axisymmetric => 1,
        EngineKind::HalfSpace => 2,
    };
    steps(1, 1, again)
        + steps(1, 2, again)
        + steps(on_fewest_steps, 4, cycles)
        + steps(2, 2, again)
        + steps(4, 2, cycles)
}

/// Time of a step on this many nodes, relative to one on the full number.
fn relative_step(plan: &SweepPlan, nodes: usize) -> f64 {
    let ratio = nodes as f64 / plan.solver.nodes() as f64;
    match plan.solver.engine {
        EngineKind::Axisymmetric => ratio,
        EngineKind::HalfSpace => ratio * ratio,
    }
}

/// Time (s) of one step, from steps of the middle frequency after the body was relaxed under the mean.
fn step_s(setup: &Setup) -> Result<f64, SetupError> {
    let plan = setup.plan();
    let nodes = match plan.solver.engine {
        EngineKind::HalfSpace if plan.base.contact.indenter.own_cells().is_none() => {
            plan.solver.nodes().min(CELLS_MEASURED)
        }
        _ => plan.solver.nodes(),
    };
    let condition = plan.conditions().first().unwrap_or(&plan.base);
    let (drive, solid) = (&condition.drive, setup.solid(condition)?);
    let omegas = &plan.angular_frequencies_rad_per_s;
    let omega = omegas.get(omegas.len() / 2).copied().unwrap_or(1.0);
    let mut engine = setup.engines(condition, nodes)?.engine(0)?;
    let compliance = solid.compliance.clone();
    engine.tolerate(setup.instant_tolerance(&compliance, drive, omega, plan.cycle.tolerance));
    let mut march = March::new(engine.as_mut(), compliance, plan.solver.time_rule);
    let steps = plan.cycle.steps as f64;
    let stages = march.stages(std::f64::consts::TAU / omega / steps);
    let value = |value| prescribed(drive.control(), value);
    // A contact that cannot be solved costs what the attempt cost.
    let relaxed = march.relax(value(drive.mean())).is_ok();
    let (clock, mut taken) = (Instant::now(), 0_u32);
    while relaxed && (clock.elapsed() < MEASURED || taken < FEWEST_STEPS) {
        taken += 1;
        let fraction = |end: f64| ((f64::from(taken - 1) + end) / steps).fract();
        let drive = |end| value(drive.value(fraction(end)));
        if march.step_in_stages(&stages, drive).is_err() {
            break;
        }
    }
    let measured = clock.elapsed().as_secs_f64() / f64::from(taken.max(1));
    Ok(measured / relative_step(plan, nodes))
}

/// What the program takes whatever it computes, most of it for pictures (bytes).
const PROGRAM_BYTES: u64 = 25_000_000;

impl Setup {
    /// Memory (bytes) of the program and a case under way.
    pub fn predicted_memory_bytes(&self) -> u64 {
        PROGRAM_BYTES + self.predicted_case_bytes()
    }

    /// Memory (bytes) that a case under way takes: engine and march, what the search for the stabilised cycle looks back on, where
    /// it was in contact at which step, and what is reported of its surface. Within 20 % of what was counted, for a contact that stays
    /// inside its domain.
    pub fn predicted_case_bytes(&self) -> u64 {
        let conditions = self.plan().conditions();
        let of_case = |condition| {
            let compliance = &self.solid(condition).ok()?.compliance;
            let nodes = self.plan().solver.nodes();
            let engines = self.engines(condition, nodes).ok()?;
            Some(self.bytes_of_case(&engines, compliance))
        };
        conditions.iter().filter_map(of_case).max().unwrap_or(0)
    }

    fn bytes_of_case(&self, engines: &EngineBuilder, compliance: &Creep) -> u64 {
        /// Memories of the body that a search holds: start, best and its update, update and weights, iterate and update of the
        /// acceleration, and what that looks back on after five cycles, the usual number.
        const OF_SEARCH: usize = 5 + 2 + 2 * 3;
        /// Those that a march holds beside its own: at the start of a cycle, its change over it, and copies of them.
        const OF_MARCH: usize = 5;
        /// The steps (bytes per node) at which a node came into contact and left it.
        const CONTACT_BYTES: usize = 56;
        /// Fields of energies and work that are added up along a recorded cycle, but for those of branches.
        const RECORDING_FIELDS: usize = 12;
        /// What the record says of a cell of the surface (bytes).
        const RECORD_BYTES: usize = 8;
        let plan = self.plan();
        let (nodes, branches) = (engines.nodes(), compliance.branches().len());
        let (memories, contact) = match plan.cycle.method {
            Method::Direct => (OF_SEARCH, CONTACT_BYTES * nodes),
            Method::March => (OF_MARCH, 0),
        };
        let searched = memories * nodes * branches * size_of::<f64>() + contact;
        let recorded = RECORD_BYTES * engines.surface_cells();
        let guessed = match (engines.surface_cells(), plan.cycle.method) {
            (0, _) | (_, Method::March) => 0,
            _ => kept_bytes(plan.cycle.steps << usize::from(rings(compliance)), nodes),
        };
        // Where guesses are kept, the cycle that may end a search is recorded beside it.
        let recording = match guessed > 0 {
            true => nodes * (2 * branches + RECORDING_FIELDS) * size_of::<f64>(),
            false => 0,
        };
        engines.predicted_memory_bytes(branches)
            + (searched + recorded + guessed + recording) as u64
    }
}
