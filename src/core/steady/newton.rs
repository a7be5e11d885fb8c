//! The stabilised cycle of a contact whose cells come and go between one cycle and the next, by Newton's method on the whole map.
//!
//! On fixed contacts of all steps the map over a cycle is linear. It consists of linear pieces, and a body that relaxes strongly and is
//! touched for a few steps only meets very many of them. The acceleration of [`find`] puts together changes between cycles of
//! different pieces, which belong to none, and may lead in circles for ever. Here every system is of one piece, that of the memory
//! reached: its matrix is known from cycles beside that memory, so near that hardly a cell changes, and Anderson acceleration, on a
//! linear map a method of least residuals (H. F. Walker and P. Ni, SIAM J. Numer. Anal. 49 (2011) 1715), solves it, preconditioned
//! with the monodromy of the nodes alone ([`Correction`](super::correction::Correction)). The step is halved until the distance falls, as it does, on a piece, for an
//! exact one. There is one answer alone: of the energy by which two memories differ every cycle takes away a part, whichever of load
//! or approach is prescribed.
//!
//! [`find`]: super::find

use super::anderson::Anderson;
use super::iteration::{Cycle, CycleMap, Reached, Run, Steady, SteadySettings};
use crate::contact::ContactError;
use crate::history::March;

/// How far beside a memory the map is looked at, as a part of its size: far enough for the tolerance of an instant.
const BESIDE: f64 = 1e-5;

/// Part of the suggested change that a direction may leave, and the cycles that finding it may take: most take three, some ten.
const LEFT: f64 = 0.03;
const CYCLES_OF_DIRECTION: usize = 40;

/// How often a step may be halved, and which part of what an exact one would gain it has to gain.
const HALVINGS: usize = 12;
const GAIN: f64 = 0.1;

/// Searches on from the memory that the march holds, as [`find`](super::find). `stop` is asked before every time step.
///
/// # Errors
/// [`ContactError`] of the instant that could not be solved.
pub(crate) fn find_by_newton(
    march: &mut March<'_>,
    cycle: &Cycle<'_>,
    settings: SteadySettings,
    stop: &dyn Fn() -> bool,
) -> Result<Steady, ContactError> {
    let mut newton = Newton::new(march, cycle, stop);
    let mut at = newton.start.clone();
    let mut ended = newton.cycle(march, &at)?;
    while let Some(reached) = ended
        && newton.accept(&at, reached) > settings.tolerance
        && newton.cycles < settings.max_cycles
        && newton.find_direction(march, &mut at)?
    {
        ended = newton.step(march, &mut at)?;
    }
    let distance = newton.reached.distance;
    Ok(Steady {
        converged: distance <= settings.tolerance,
        cycles: newton.cycles,
        distance,
    })
}

struct Newton<'a> {
    map: CycleMap<'a>,
    /// The memory reached, and how its cycle changes it.
    start: Vec<f64>,
    change: Vec<f64>,
    run: Run,
    reached: Reached,
    /// The change of another memory, by its cycle.
    tried_change: Vec<f64>,
    tried: Run,
    direction: Vec<f64>,
    cycles: usize,
}

impl<'a> Newton<'a> {
    fn new(march: &March<'_>, cycle: &'a Cycle<'a>, stop: &'a dyn Fn() -> bool) -> Self {
        let start = march.memory().variables().to_vec();
        Self {
            map: CycleMap::new(march, cycle, stop),
            change: vec![0.0; start.len()],
            run: Run::new(march, cycle),
            reached: Reached {
                missing: f64::INFINITY,
                distance: f64::INFINITY,
            },
            tried_change: vec![0.0; start.len()],
            tried: Run::new(march, cycle),
            direction: Vec::new(),
            cycles: 0,
            start,
        }
    }

    /// Solves the cycle from this memory. `None` where it was stopped.
    fn cycle(
        &mut self,
        march: &mut March<'_>,
        start: &[f64],
    ) -> Result<Option<Reached>, ContactError> {
        let (run, change) = (&mut self.tried, &mut self.tried_change);
        let reached = self.map.cycle(march, start, (run, None), change)?;
        self.cycles += usize::from(reached.is_some());
        Ok(reached)
    }

    /// Makes the memory whose cycle was the last the one reached; returns its distance.
    fn accept(&mut self, at: &[f64], reached: Reached) -> f64 {
        self.start.copy_from_slice(at);
        std::mem::swap(&mut self.change, &mut self.tried_change);
        std::mem::swap(&mut self.run, &mut self.tried);
        self.reached = reached;
        reached.distance
    }

    fn size(&self, field: &[f64]) -> f64 {
        let entries = field.iter().zip(&self.map.weights);
        entries.map(|(x, w)| (w * x).powi(2)).sum::<f64>().sqrt()
    }

    /// What the nodes alone suggest for a change over a cycle that is in `tried_change`, in its place. Returns its size.
    fn suggest(&mut self) -> f64 {
        (self.map).correct(&self.run.contact, &mut self.tried_change);
        self.size(&self.tried_change)
    }

    /// Puts into `at` the memory reached, moved by a part of the direction.
    fn move_by(&self, part: f64, at: &mut [f64]) {
        for ((at, m), d) in at.iter_mut().zip(&self.start).zip(&self.direction) {
            *at = m + part * d;
        }
    }

    /// The direction in which, on the piece of the memory reached, the stabilised cycle lies. False where there is none, or where it
    /// was stopped.
    fn find_direction(
        &mut self,
        march: &mut March<'_>,
        at: &mut [f64],
    ) -> Result<bool, ContactError> {
        self.tried_change.copy_from_slice(&self.change);
        let suggested = self.suggest();
        self.direction.clone_from(&self.tried_change);
        let mut anderson = Anderson::default();
        for _ in 0..CYCLES_OF_DIRECTION {
            let part = BESIDE * self.size(&self.start) / self.size(&self.direction);
            if !(part.is_finite() && part > 0.0) {
                return Ok(false);
            }
            self.move_by(part, at);
            if self.cycle(march, at)?.is_none() {
                return Ok(false);
            }
            for (beside, change) in self.tried_change.iter_mut().zip(&self.change) {
                *beside = change + (*beside - change) / part;
            }
            if self.suggest() < LEFT * suggested {
                break;
            }
            anderson.advance(&mut self.direction, &self.tried_change, &self.map.weights);
        }
        Ok(true)
    }

    /// The longest step in the direction that is as much nearer as it should be; `None` where none is, or where it was stopped.
    fn step(
        &mut self,
        march: &mut March<'_>,
        at: &mut [f64],
    ) -> Result<Option<Reached>, ContactError> {
        let mut part = 1.0;
        for _ in 0..=HALVINGS {
            self.move_by(part, at);
            match self.cycle(march, at)? {
                Some(reached) if reached.missing < (1.0 - GAIN * part) * self.reached.missing => {
                    return Ok(Some(reached));
                }
                Some(_) => part *= 0.5,
                None => break,
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Prescribed;
    use crate::contact::axisymmetric::{Axisymmetric, Edge};
    use crate::history::TimeRule;
    use crate::material::{Creep, CreepBranch};
    use crate::steady::find;

    /// A sphere on springs, in and out of contact, whose slower branch hardly relaxes within the period.
    fn with_march<T>(ask: impl FnOnce(&mut March<'_>, &Cycle<'_>) -> T) -> T {
        let width_m = 3e-6;
        let gaps_m = (0..100).map(|i| ((f64::from(i) + 0.5) * width_m).powi(2) / 0.01);
        let mut engine = Axisymmetric::new(width_m, gaps_m.collect(), Edge::Open, true);
        let branch = |compliance_per_pa, time_s| CreepBranch {
            compliance_per_pa,
            time_s,
        };
        let branches = vec![branch(1e-8, 0.3), branch(1e-7, 100.0)];
        let creep = Creep::new(1e-9, branches, None).unwrap();
        let mut march = March::new(&mut engine, creep, TimeRule::Linear);
        let drive = |fraction: f64| (std::f64::consts::TAU * fraction).sin();
        let cycle = Cycle {
            drive: &|fraction| Prescribed::ApproachM(2e-6 * (0.1 + drive(fraction))),
            mean: Prescribed::ApproachM(0.2e-6),
            period_s: 1.0,
            steps: 40,
        };
        ask(&mut march, &cycle)
    }

    const SETTINGS: SteadySettings = SteadySettings {
        tolerance: 1e-8,
        max_cycles: 200,
        is_quick: true,
    };

    #[test]
    fn it_ends_where_the_accelerated_search_does_wherever_it_begins() {
        with_march(|march, cycle| {
            let found = find(march, cycle, None, SETTINGS, &|| false).unwrap();
            assert!(found.converged);
            let expected = march.memory().variables().to_vec();
            let largest = expected.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            for part in [0.0, 0.5, 3.0] {
                march.relax(cycle.mean).unwrap();
                let relaxed = march.memory().variables().iter();
                let start = relaxed.zip(&expected).map(|(m, e)| e + part * (m - e));
                march.recall(&start.collect::<Vec<f64>>());
                let found = find_by_newton(march, cycle, SETTINGS, &|| false).unwrap();
                assert!(found.converged, "{part}: {found:?}");
                let pairs = march.memory().variables().iter().zip(&expected);
                let off = pairs.fold(0.0_f64, |worst, (m, e)| worst.max((m - e).abs()));
                assert!(off < 1e-6 * largest, "{part}: {off:e} of {largest:e}");
            }
        });
    }

    #[test]
    fn it_ends_where_it_is_stopped_and_after_the_cycles_it_may_take() {
        with_march(|march, cycle| {
            march.relax(cycle.mean).unwrap();
            let stopped = find_by_newton(march, cycle, SETTINGS, &|| true).unwrap();
            assert!(!stopped.converged && stopped.cycles == 0, "{stopped:?}");
            let few = SteadySettings {
                max_cycles: 1,
                ..SETTINGS
            };
            let given_up = find_by_newton(march, cycle, few, &|| false).unwrap();
            assert!(!given_up.converged && given_up.cycles == 1, "{given_up:?}");
            assert!(given_up.distance > SETTINGS.tolerance);
        });
    }
}
