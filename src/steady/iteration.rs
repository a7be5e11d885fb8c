//! The search: cycle after cycle, each started from a better memory.

use super::anderson::Anderson;
use super::correction::{ContactPattern, Correction};
use crate::contact::{ContactError, Prescribed, Solution};
use crate::cycle;
use crate::history::{March, StepWeights};

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

/// Past updates that the acceleration looks back on.
const DEPTH: usize = 12;

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
    let correction = Correction::new(march.memory().compliance(), cycle.period_s, cycle.steps);
    let mut start = match start {
        Some(start) => start,
        None => {
            march.relax(cycle.mean)?;
            march.memory().variables().to_vec()
        }
    };
    let nodes = march.pressure().len();
    let mut run = Run::new(march, cycle);
    let mut update = vec![0.0; start.len()];
    let mut anderson = Anderson::new(DEPTH);
    let mut best = (f64::INFINITY, start.clone(), update.clone());
    let keep_mean_load = matches!(cycle.mean, Prescribed::LoadN(_));
    let mut steady = Steady {
        converged: false,
        cycles: 0,
        distance: f64::INFINITY,
    };
    while steady.cycles < settings.max_cycles {
        march.recall(&start);
        if !run.cycle(march, cycle, stop)? {
            break;
        }
        steady.cycles += 1;
        let end = march.memory().variables();
        let memory = correction.distance(&start, end, nodes, &mut update) / run.scale;
        let closure = cycle::closure_error(&run.load_n, &run.approach_m);
        steady.distance = match closure {
            Some(closure) if memory.is_finite() => memory.max(closure),
            _ => f64::INFINITY,
        };
        if steady.distance <= settings.tolerance {
            steady.converged = true;
            break;
        }
        correction.apply(&run.contact, keep_mean_load, &mut update);
        if memory > SETBACK * best.0 {
            // The acceleration went astray: back to the best memory, by half its own update.
            anderson.reset();
            start.copy_from_slice(&best.1);
            for (m, dm) in start.iter_mut().zip(&best.2) {
                *m += 0.5 * dm;
            }
            continue;
        }
        if memory < best.0 {
            best.0 = memory;
            best.1.copy_from_slice(&start);
            best.2.copy_from_slice(&update);
        }
        anderson.advance(&mut start, &update, &|i| correction.weight(i / nodes));
    }
    Ok(steady)
}

/// One cycle and what the search wants to know of it.
struct Run {
    weights: StepWeights,
    contact: ContactPattern,
    /// Largest root of the sum of squares of the nodal pressures.
    scale: f64,
    load_n: Vec<f64>,
    approach_m: Vec<f64>,
}

impl Run {
    fn new(march: &March<'_>, cycle: &Cycle<'_>) -> Self {
        Self {
            weights: march.weights(cycle.period_s / cycle.steps as f64),
            contact: ContactPattern::new(march.pressure().len()),
            scale: 0.0,
            load_n: Vec::with_capacity(cycle.steps + 1),
            approach_m: Vec::with_capacity(cycle.steps + 1),
        }
    }

    /// Solves one cycle from the memory the march holds. Its first instant is a jump: the pressure that belongs to the
    /// memory and to the drive's value there. Says whether it came to its end.
    fn cycle(
        &mut self,
        march: &mut March<'_>,
        cycle: &Cycle<'_>,
        stop: &dyn Fn() -> bool,
    ) -> Result<bool, ContactError> {
        self.contact.clear();
        self.scale = 0.0;
        self.load_n.clear();
        self.approach_m.clear();
        let share = 1.0 / cycle.steps as f64;
        let first = march.jump((cycle.drive)(0.0))?;
        self.sample(&first);
        for step in 1..=cycle.steps {
            if stop() {
                return Ok(false);
            }
            let solution = march.step(&self.weights, (cycle.drive)(step as f64 * share))?;
            self.sample(&solution);
            self.contact.push(march.pressure());
            let squares: f64 = march.pressure().iter().map(|p| p * p).sum();
            self.scale = self.scale.max(squares.sqrt());
        }
        Ok(true)
    }

    fn sample(&mut self, solution: &Solution) {
        self.load_n.push(solution.load_n);
        self.approach_m.push(solution.approach_m);
    }
}
