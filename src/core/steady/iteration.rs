//! The search: cycle after cycle, each started from a better memory.

use super::anderson::Anderson;
use super::correction::{ContactHistory, Correction};
use super::remaining::Remaining;
use crate::contact::{ContactError, Prescribed, Solution};
use crate::cycle;
use crate::history::{March, Stage};

/// One cycle of the drive.
pub struct Cycle<'a> {
    /// What the drive prescribes at a fraction of the cycle.
    pub drive: &'a dyn Fn(f64) -> Prescribed,
    /// What it prescribes on average: the search starts from the body relaxed under it.
    pub mean: Prescribed,
    /// Period (s).
    pub period_s: f64,
    /// Time steps per cycle.
    pub steps: usize,
}

/// When the search ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadySettings {
    /// Largest distance to the stabilised cycle: of the memory, root of the sum of squares over the nodes relative to that of
    /// the pressure at its largest, and of the loop to a closed one relative to its area.
    pub tolerance: f64,
    /// Cycles after which the search has failed.
    pub max_cycles: usize,
}

/// How the search ended. The march stands at the end of the last cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steady {
    /// Whether the distance came below the tolerance.
    pub converged: bool,
    /// Cycles solved.
    pub cycles: usize,
    /// Estimated distance of the last of them; infinite where no pressure arose.
    pub distance: f64,
}

/// Cycles that may pass without a better memory before the acceleration starts anew from the best: at the edge of a strongly
/// relaxing contact cells come and go between cycles, and what was learned of them leads in circles.
const PATIENCE: usize = 10;

/// By what factor a distance may exceed the best so far before the acceleration starts anew from the best.
const SETBACK: f64 = 30.0;

/// Searches the memory that one cycle of the drive leaves as it found it, from `start` (branch-major, as
/// [`crate::history::Memory::variables`]; of the same cycle in other steps, say) or from the body relaxed under the mean.
/// `stop` is asked before every time step.
///
/// # Errors
/// [`ContactError`] of the instant that could not be solved.
pub fn find(
    march: &mut March<'_>,
    cycle: &Cycle<'_>,
    start: Option<Vec<f64>>,
    settings: SteadySettings,
    stop: &dyn Fn() -> bool,
) -> Result<Steady, ContactError> {
    let compliance = march.memory().compliance();
    let remaining = Remaining::new(compliance, cycle.period_s, march.pressure().len());
    let loads = march.loads_per_nodal_pressure();
    let correction = Correction::new(compliance, (cycle.period_s, cycle.steps), &remaining, loads);
    let mut search = Search::begin(march, cycle, start)?;
    let mut converged = false;
    let nodes = march.pressure().len();
    let mut run = Run::new(march, cycle);
    let mut update = vec![0.0; search.start.len()];
    let weights = correction.weights(nodes);
    let keep_mean_load = matches!(cycle.mean, Prescribed::LoadN(_));
    while search.cycles < settings.max_cycles {
        march.recall(&search.start);
        if !run.cycle(march, cycle, &remaining, stop)? {
            break;
        }
        search.cycles += 1;
        remaining.change(&search.start, march.memory(), &mut update);
        let memory = remaining.distance(&update) / run.scale;
        search.distance = run.distance(memory);
        converged = search.distance <= settings.tolerance;
        if converged {
            break;
        }
        correction.apply(&run.contact, keep_mean_load, &mut update);
        search.advance(memory, &update, &weights);
    }
    Ok(Steady {
        converged,
        cycles: search.cycles,
        distance: search.distance,
    })
}

/// Where the search stands between two cycles.
struct Search {
    /// Memory from which the next cycle starts.
    start: Vec<f64>,
    /// The best memory so far: its distance, itself, its update.
    best: (f64, Vec<f64>, Vec<f64>),
    anderson: Anderson,
    /// Cycles since the best, and how often the search went back to it.
    since_best: (usize, usize),
    cycles: usize,
    distance: f64,
}

impl Search {
    fn begin(
        march: &mut March<'_>,
        cycle: &Cycle<'_>,
        start: Option<Vec<f64>>,
    ) -> Result<Self, ContactError> {
        let start = match start {
            Some(memory) => memory,
            None => {
                march.relax(cycle.mean)?;
                march.memory().variables().to_vec()
            }
        };
        Ok(Self {
            best: (f64::INFINITY, start.clone(), vec![0.0; start.len()]),
            start,
            anderson: Anderson::default(),
            since_best: (0, 0),
            cycles: 0,
            distance: f64::INFINITY,
        })
    }

    /// The memory to start the next cycle from, after one at distance `memory` that suggests `update`.
    fn advance(&mut self, memory: f64, update: &[f64], weights: &[f64]) {
        let (since_best, setbacks) = self.since_best;
        if memory < self.best.0 {
            self.since_best = (0, 0);
            self.best.0 = memory;
            self.best.1.copy_from_slice(&self.start);
            self.best.2.copy_from_slice(update);
        } else if memory > SETBACK * self.best.0 || since_best >= PATIENCE {
            // The acceleration went astray: back to the best memory, by half its own update, the next time by a quarter.
            self.since_best = (0, setbacks + 1);
            self.anderson.reset();
            self.start.copy_from_slice(&self.best.1);
            let part = 0.5 / (1_u64 << setbacks.min(30)) as f64;
            for (m, dm) in self.start.iter_mut().zip(&self.best.2) {
                *m += part * dm;
            }
            return;
        } else {
            self.since_best.0 += 1;
        }
        self.anderson.advance(&mut self.start, update, weights);
    }
}

/// One cycle and what the search wants to know of it.
pub(super) struct Run {
    stages: Vec<Stage>,
    pub(super) contact: ContactHistory,
    /// Largest size of the nodal pressures.
    pub(super) scale: f64,
    load_n: Vec<f64>,
    approach_m: Vec<f64>,
}

impl Run {
    pub(super) fn new(march: &March<'_>, cycle: &Cycle<'_>) -> Self {
        Self {
            stages: march.stages(cycle.period_s / cycle.steps as f64),
            contact: ContactHistory::new(march.pressure().len()),
            scale: 0.0,
            load_n: Vec::with_capacity(cycle.steps + 1),
            approach_m: Vec::with_capacity(cycle.steps + 1),
        }
    }

    /// Solves one cycle from the memory the march holds. Its first instant is a jump: the pressure that belongs to the
    /// memory and to the drive's value there. Says whether it came to its end.
    pub(super) fn cycle(
        &mut self,
        march: &mut March<'_>,
        cycle: &Cycle<'_>,
        remaining: &Remaining,
        stop: &dyn Fn() -> bool,
    ) -> Result<bool, ContactError> {
        self.contact.clear();
        self.scale = 0.0;
        self.load_n.clear();
        self.approach_m.clear();
        let share = 1.0 / cycle.steps as f64;
        let first = march.jump((cycle.drive)(0.0))?;
        self.sample(&first);
        march.begin_cycle(remaining.first_held());
        for step in 1..=cycle.steps {
            if stop() {
                return Ok(false);
            }
            let begun = (step - 1) as f64;
            march.step_in_stages(&self.stages, |end| (cycle.drive)((begun + end) * share))?;
            if let Some(solution) = march.solution() {
                self.sample(&solution);
            }
            self.contact.push(march.pressure());
            self.scale = self.scale.max(remaining.size(march.pressure()));
        }
        Ok(true)
    }

    /// The distance to the stabilised cycle: of the memory, given relative to the pressure, or of the loop to a closed one; infinite
    /// where no pressure arose.
    pub(super) fn distance(&self, memory: f64) -> f64 {
        match cycle::closure_error(&self.load_n, &self.approach_m) {
            Some(closure) if memory.is_finite() => memory.max(closure),
            _ => f64::INFINITY,
        }
    }

    fn sample(&mut self, solution: &Solution) {
        self.load_n.push(solution.load_n);
        self.approach_m.push(solution.approach_m);
    }
}
