//! The search: cycle after cycle, each started from a better memory.

use super::anderson::Anderson;
use super::correction::{ContactHistory, Correction};
use super::instants::Instants;
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
    /// Whether the first cycles may be less exact, which is the faster way and seldom one that leads astray.
    pub is_quick: bool,
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

/// Takes in a cycle while it is solved.
pub(crate) trait Record {
    /// A cycle begins at the instant where the march stands; what was taken in of one before is of no use.
    ///
    /// # Errors
    /// As [`March::step`].
    fn begin(&mut self, march: &mut March<'_>) -> Result<(), ContactError>;

    /// Takes the step of this number, counted from 1, in its stages; `drive` tells what is prescribed at a fraction of it.
    ///
    /// # Errors
    /// As [`March::step`].
    fn step(
        &mut self,
        march: &mut March<'_>,
        step: usize,
        in_stages: (&[Stage], &dyn Fn(f64) -> Prescribed),
    ) -> Result<(), ContactError>;
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
    let (found, _) = find_recorded(march, (cycle, stop), start, settings, None)?;
    Ok(found)
}

/// As [`find`]; whether `record` took in the cycle with which the search ends. It is given each cycle that is likely to be that one.
///
/// # Errors
/// As [`find`].
pub(crate) fn find_recorded(
    march: &mut March<'_>,
    (cycle, stop): (&Cycle<'_>, &dyn Fn() -> bool),
    start: Option<Vec<f64>>,
    settings: SteadySettings,
    record: Option<&mut dyn Record>,
) -> Result<(Steady, bool), ContactError> {
    march.keeping_tolerance(|march| find_by(march, (cycle, stop), start, settings, record))
}

fn find_by(
    march: &mut March<'_>,
    (cycle, stop): (&Cycle<'_>, &dyn Fn() -> bool),
    start: Option<Vec<f64>>,
    settings: SteadySettings,
    mut record: Option<&mut dyn Record>,
) -> Result<(Steady, bool), ContactError> {
    let mut instants = Instants::new(march, start.is_some(), settings);
    let map = CycleMap::new(march, cycle, stop);
    let mut search = Search::begin(march, cycle, start)?;
    let (mut converged, mut is_recorded) = (false, false);
    let mut run = Run::new(march, cycle);
    let mut update = vec![0.0; search.start.len()];
    while search.cycles < settings.max_cycles {
        let is_near = instants.begin_cycle(march, cycle.steps * run.stages.len());
        let of_this: Option<&mut dyn Record> = match &mut record {
            Some(record) if is_near => Some(&mut **record),
            _ => None,
        };
        is_recorded = of_this.is_some();
        let reached = map.cycle(march, &search.start, (&mut run, of_this), &mut update)?;
        let Some(reached) = reached else {
            break;
        };
        search.cycles += 1;
        search.distance = reached.distance;
        converged = search.distance <= settings.tolerance && instants.are_tight();
        if converged {
            break;
        }
        instants.after(search.distance);
        map.correct(&run.contact, &mut update);
        search.advance(reached.missing / run.scale, &update, &map.weights);
    }
    let found = Steady {
        converged,
        cycles: search.cycles,
        distance: search.distance,
    };
    Ok((found, converged && is_recorded))
}

/// How far a cycle is from the stabilised one.
#[derive(Clone, Copy)]
pub(super) struct Reached {
    /// Of its memory, in the unit of the nodal pressure: a measure that does not itself change with the memory, unlike one relative
    /// to the pressure of the cycle.
    pub(super) missing: f64,
    /// As [`SteadySettings::tolerance`] bounds it: of the memory, relative to the pressure, or of the loop to a closed one; infinite
    /// where no pressure arose.
    pub(super) distance: f64,
}

/// The map from the memory at the start of a cycle to that at its end, and what is known of it in advance.
pub(super) struct CycleMap<'a> {
    cycle: &'a Cycle<'a>,
    stop: &'a dyn Fn() -> bool,
    remaining: Remaining,
    correction: Correction,
    /// Weights of the memory variables in least squares.
    pub(super) weights: Vec<f64>,
}

impl<'a> CycleMap<'a> {
    pub(super) fn new(march: &March<'_>, cycle: &'a Cycle<'a>, stop: &'a dyn Fn() -> bool) -> Self {
        let (compliance, nodes) = (march.memory().compliance(), march.pressure().len());
        let remaining = Remaining::new(compliance, cycle.period_s, nodes);
        let (loads, period) = (
            march.loads_per_nodal_pressure(),
            (cycle.period_s, cycle.steps),
        );
        let correction = Correction::new(compliance, period, &remaining, loads);
        Self {
            cycle,
            stop,
            weights: correction.weights(nodes),
            remaining,
            correction,
        }
    }

    /// Solves the cycle from this memory and puts into `change` what it does to the memory. Its first instant is a jump: the pressure
    /// that belongs to the memory and to the drive's value there. It is recorded where asked to. `None` where it was stopped.
    pub(super) fn cycle(
        &self,
        march: &mut March<'_>,
        start: &[f64],
        (run, mut record): (&mut Run, Option<&mut dyn Record>),
        change: &mut [f64],
    ) -> Result<Option<Reached>, ContactError> {
        let (remaining, drive) = (&self.remaining, self.cycle.drive);
        march.recall(start);
        run.contact.clear();
        run.scale = 0.0;
        run.load_n.clear();
        run.approach_m.clear();
        let share = 1.0 / self.cycle.steps as f64;
        let first = march.jump(drive(0.0))?;
        run.sample(&first);
        if let Some(record) = record.as_deref_mut() {
            record.begin(march)?;
        }
        march.begin_cycle(remaining.first_held());
        for step in 1..=self.cycle.steps {
            if (self.stop)() {
                return Ok(None);
            }
            let begun = (step - 1) as f64;
            let drive = |end| drive((begun + end) * share);
            match record.as_deref_mut() {
                Some(record) => record.step(march, step, (&run.stages, &drive))?,
                None => march.step_in_stages(&run.stages, drive)?,
            }
            if let Some(solution) = march.solution() {
                run.sample(&solution);
            }
            run.contact.push(march.pressure());
            run.scale = run.scale.max(remaining.size(march.pressure()));
        }
        remaining.change(start, march.memory(), change);
        let missing = remaining.distance(change);
        let memory = missing / run.scale;
        let closure = cycle::closure_error(&run.load_n, &run.approach_m);
        let closure = closure.filter(|_| memory.is_finite());
        Ok(Some(Reached {
            missing,
            distance: closure.map_or(f64::INFINITY, |closure| memory.max(closure)),
        }))
    }

    /// Turns a change over a cycle of this contact into what the nodes alone suggest for the memory at its start.
    pub(super) fn correct(&self, contact: &ContactHistory, change: &mut [f64]) {
        let keep_mean_load = matches!(self.cycle.mean, Prescribed::LoadN(_));
        self.correction.apply(contact, keep_mean_load, change);
    }
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

    fn sample(&mut self, solution: &Solution) {
        self.load_n.push(solution.load_n);
        self.approach_m.push(solution.approach_m);
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::sync::Arc;

    use super::*;
    use crate::contact::Engine;
    use crate::contact::axisymmetric::{Axisymmetric, Edge};
    use crate::contact::half_space::convolution::Convolution;
    use crate::contact::half_space::grid::Grid;
    use crate::contact::half_space::{HalfSpace, SolverSettings};
    use crate::history::TimeRule;
    use crate::material::classical::zener;

    /// The loads (N) of every cycle that was given to it.
    #[derive(Default)]
    struct Loads(Vec<Vec<f64>>);

    impl Record for Loads {
        fn begin(&mut self, march: &mut March<'_>) -> Result<(), ContactError> {
            self.0.push(vec![march.solution().unwrap().load_n]);
            Ok(())
        }

        fn step(
            &mut self,
            march: &mut March<'_>,
            step: usize,
            (stages, drive): (&[Stage], &dyn Fn(f64) -> Prescribed),
        ) -> Result<(), ContactError> {
            march.step_in_stages(stages, drive)?;
            let loads = self.0.last_mut().unwrap();
            assert_eq!(loads.len(), step);
            loads.push(march.solution().unwrap().load_n);
            Ok(())
        }
    }

    /// What a search of a pressed sphere finds on this engine, with the loads it recorded and the march at its end.
    fn searched<T>(
        engine: &mut dyn Engine,
        (steps, tolerance, is_quick): (usize, f64, bool),
        ask: impl FnOnce((Steady, bool), Loads, &mut March<'_>) -> T,
    ) -> T {
        let mut march = March::new(engine, zener(1e9, 1e9, 1.0).unwrap(), TimeRule::Linear);
        let cycle = Cycle {
            drive: &|fraction| Prescribed::ApproachM(2e-7 * (1.5 + (TAU * fraction).sin())),
            mean: Prescribed::ApproachM(3e-7),
            period_s: 3.0,
            steps,
        };
        let settings = SteadySettings {
            tolerance,
            max_cycles: 100,
            is_quick,
        };
        let mut loads = Loads::default();
        let stop = || false;
        let found = find_recorded(
            &mut march,
            (&cycle, &stop),
            None,
            settings,
            Some(&mut loads),
        );
        ask(found.unwrap(), loads, &mut march)
    }

    #[test]
    fn the_cycle_that_ends_a_search_is_recorded_where_it_was_expected_to() {
        let grid = Grid::square(16, 2e-5).unwrap();
        let places = (0..grid.cells()).map(|cell| grid.center(cell));
        let gap_m: Vec<f64> = places.map(|(x, y)| (x * x + y * y) / 0.02).collect();
        let operator = Arc::new(Convolution::new(grid).unwrap());
        let settings = SolverSettings::default();
        let mut on_cells = HalfSpace::new(operator, gap_m.clone(), true, settings);
        let mut kept = 0;
        for steps in [9, 40, 200] {
            for tolerance in [1e-2, 1e-4, 1e-6] {
                let given = (steps, tolerance, true);
                searched(
                    &mut on_cells,
                    given,
                    |(found, is_recorded), loads, march| {
                        assert!(found.converged && found.distance <= tolerance);
                        assert!(loads.0.len() <= found.cycles);
                        let Some(last) = loads.0.last().filter(|_| is_recorded) else {
                            return;
                        };
                        kept += 1;
                        let end_n = march.solution().unwrap().load_n;
                        assert!(last.len() == steps + 1 && last.last() == Some(&end_n));
                        assert!((last[0] / end_n - 1.0).abs() < 10.0 * tolerance);
                    },
                );
            }
        }
        assert!(kept >= 6, "{kept}");
        // Neither where no cycle may be less exact than the last, nor of springs, whose further cycle is nearer still and costs little.
        searched(
            &mut on_cells,
            (40, 1e-4, false),
            |(found, is_recorded), loads, _| {
                assert!(found.converged && !is_recorded && loads.0.is_empty());
            },
        );
        let width_m = 3e-6;
        let gaps_m = (0..100).map(|i| ((f64::from(i) + 0.5) * width_m).powi(2) / 0.01);
        let mut springs = Axisymmetric::new(width_m, gaps_m.collect(), Edge::Open, true);
        searched(
            &mut springs,
            (40, 1e-4, true),
            |(found, is_recorded), loads, _| {
                assert!(found.converged && !is_recorded && loads.0.is_empty());
            },
        );
    }
}
