//! The fast way to solve an instant on cells: preconditioned conjugate gradients on the contact, between changes of it, a
//! primal-dual active set strategy (M. Hintermueller, K. Ito and K. Kunisch, SIAM J. Optim. 13 (2002) 865).
//!
//! Inside the contact the gap must vanish, which is a linear problem for its pressure; conjugate gradients solve it in a few
//! steps when preconditioned with what nearly inverts the operator ([`preconditioning`]). Cells whose pressure turns
//! negative leave the contact at once, at the price of a convolution; or, where a contact has many patches, once the gaps inside have
//! shrunk, as long as that leads down ([`Waiting`]). Cells that penetrate outside join it, without a convolution, once that is what
//! matters more than the gaps inside. Under load control the pressures' sum stays what it is:
//! directions are projected as the preconditioner's own metric asks for.
//!
//! Changes of the contact are not proved to end, so the number of steps without progress is bounded; what is then left to do
//! is done by [`polonsky_keer`](super::polonsky_keer), which descends.

mod preconditioning;
mod problem;
mod spans;

use super::instant::STANDING_OFF;
use crate::contact::ContactError;
use crate::contact::sums::{add_scaled, dot, least, least_of, sum, sums};
use preconditioning::Continued;
use problem::Waiting;
pub(super) use problem::{Elastic, InstantOfCells, IterateState, Scratches, Work};
pub(super) use spans::over_blocks;
use spans::{Run, Spans};

/// Steps after which the residual must have halved.
const PATIENCE: usize = 40;
/// Steps on one contact at most.
const STEPS_PER_CONTACT: usize = 50;
/// Gaps inside must shrink to this share before penetration outside changes the contact.
const SHARE_BEFORE_JOINING: f64 = 0.2;
/// Cells join that penetrate by this share of what the tolerance allows.
const JOINING: f64 = 0.3;

/// Fields of one value per cell.
#[derive(Debug, Default)]
pub(super) struct ActiveSet {
    pub(super) pressure: Vec<f64>,
    /// Gap before the approach is taken off: g + B (A p + H) (m).
    pub(super) gap_m: Vec<f64>,
    /// What an operator that shows the way or changes the gap is applied to, and what comes of it, in its precision.
    field: Vec<f32>,
    image: Vec<f32>,
    contact: Spans,
    /// How far the gap inside the contact was from none when last seen (m).
    misfit_m: f64,
    /// On the contact alone, without gaps: the residual, preconditioned, that of the step before, direction, and the
    /// preconditioned constant.
    residual: Vec<f64>,
    preconditioned: Vec<f64>,
    last: Vec<f64>,
    direction: Vec<f64>,
    constant: Vec<f64>,
    /// What preconditions in a contact of many patches.
    continued: Continued,
}

impl ActiveSet {
    /// Makes the fields fit this many cells. Allocates only what was never needed before.
    pub(super) fn fit(&mut self, cells: usize) {
        for field in [&mut self.pressure, &mut self.gap_m] {
            field.resize(cells, 0.0);
        }
        for field in [&mut self.field, &mut self.image] {
            field.resize(cells, 0.0);
        }
    }

    /// Solves from the pressure and gap given, until the residual is below the tolerance. `None` where too little progress is made, or
    /// [`InstantOfCells::fast_steps`] were taken: this is not the way.
    ///
    /// # Errors
    /// [`ContactError::NotConverged`] after `steps`.
    pub(super) fn solve(
        &mut self,
        problem: &InstantOfCells<'_>,
        steps: usize,
        scratch: &mut Scratches,
        work: &mut Work,
    ) -> Result<Option<IterateState>, ContactError> {
        let (mut best, mut best_at) = (f64::INFINITY, work.steps);
        let mut waiting = Waiting::new(problem.has_patches);
        self.misfit_m = 0.0;
        let steps = steps.min(problem.fast_steps);
        loop {
            let state = self.assess(problem);
            if state.residual <= problem.tolerance {
                return Ok(Some(state));
            }
            if work.steps >= problem.fast_steps {
                return Ok(None);
            }
            if work.steps >= steps {
                return Err(ContactError::NotConverged {
                    iterations: work.steps,
                    residual: state.residual,
                    tolerance: problem.tolerance,
                });
            }
            if state.residual < 0.5 * best {
                (best, best_at) = (state.residual, work.steps);
            }
            if work.steps > best_at + PATIENCE || self.contact.cells() == 0 {
                return Ok(None);
            }
            let waits = waiting.after(state.residual);
            if !self.solve_on_contact(problem, (&state, waits), steps, scratch, work)? {
                return Ok(None);
            }
        }
    }

    /// Gaps, penetration and contact: the cells with pressure, and those that penetrate.
    fn assess(&mut self, problem: &InstantOfCells<'_>) -> IterateState {
        let (pressure_sum, own_m) =
            problem
                .elastic
                .load(&self.pressure, &self.gap_m, problem.compliance_per_pa);
        let cells_x = problem.elastic.grid().cells_x();
        let (pressure, gap_m) = (&self.pressure, &self.gap_m);
        let lifted = over_blocks(pressure.len(), cells_x, |cells| {
            let rows = pressure[cells.clone()].chunks_exact(cells_x);
            let lifted = rows
                .zip(gap_m[cells].chunks_exact(cells_x))
                .map(|(p, gap)| {
                    // Where there is no indenter the gap is infinite and the pressure zero.
                    sums(p, gap, |p, gap| [if p > 0.0 { p * gap } else { 0.0 }])[0]
                });
            [lifted.sum()]
        });
        let lifted = lifted.total(0);
        let mean = |sum: f64| match pressure_sum > 0.0 {
            true => sum / pressure_sum,
            false => 0.0,
        };
        let mut state = IterateState {
            pressure_sum,
            approach_m: problem.approach_m.unwrap_or(mean(lifted)),
            reference_m: own_m + problem.noise_m / problem.tolerance,
            ..IterateState::default()
        };
        let mut joining_m = JOINING * problem.tolerance * state.reference_m;
        if problem.has_patches {
            // What penetrates less than the gaps inside are uncertain may not do so in the end.
            joining_m = joining_m.max(self.misfit_m);
        }
        let (misfit, highest_m, lowest_m) = self.find_contact(problem, &state, -joining_m);
        let inside_m = mean(misfit);
        let worst_m = inside_m.max(highest_m / STANDING_OFF).max(-lowest_m);
        state.residual = if worst_m > 0.0 {
            worst_m / state.reference_m
        } else {
            0.0
        };
        state
    }

    /// Finds the contact: the cells with pressure, and those that penetrate by more than `joining_m` allows. Returns the sum of
    /// p |gap|, the highest gap under pressure, at least 0, and the lowest gap outside, at most 0 (m).
    fn find_contact(
        &mut self,
        problem: &InstantOfCells<'_>,
        state: &IterateState,
        joining_m: f64,
    ) -> (f64, f64, f64) {
        let (cells_x, approach_m) = (problem.elastic.grid().cells_x(), state.approach_m);
        let (pressure, gap_m) = (&self.pressure, &self.gap_m);
        let found = self
            .contact
            .find(pressure.len(), cells_x, |cells, contact| {
                let (mut misfit, mut lowest_m, mut highest_m) = (0.0, 0.0_f64, 0.0_f64);
                let starts = cells.clone().step_by(cells_x);
                let rows = pressure[cells.clone()].chunks_exact(cells_x);
                let rows = rows.zip(gap_m[cells].chunks_exact(cells_x));
                for (start, (pressure, gaps_m)) in starts.zip(rows) {
                    let least_m = least(gaps_m) - approach_m;
                    if least_m >= joining_m && sum(pressure) == 0.0 {
                        lowest_m = lowest_m.min(least_m);
                        continue;
                    }
                    for (cell, (&p, &gap)) in (start..).zip(pressure.iter().zip(gaps_m)) {
                        let gap_m = gap - approach_m;
                        if p > 0.0 {
                            misfit += p * gap_m.abs();
                            highest_m = highest_m.max(gap_m);
                        } else {
                            lowest_m = lowest_m.min(gap_m);
                            if gap_m >= joining_m {
                                continue;
                            }
                        }
                        contact.push(cell);
                    }
                }
                [misfit, -highest_m, lowest_m]
            });
        (found.total(0), -found.least(1), found.least(2))
    }

    /// Conjugate gradients on the contact as it is; whether cells of negative pressure wait. False where there is no way down.
    fn solve_on_contact(
        &mut self,
        problem: &InstantOfCells<'_>,
        (state, waits): (&IterateState, bool),
        steps: usize,
        scratch: &mut Scratches,
        work: &mut Work,
    ) -> Result<bool, ContactError> {
        let cells = self.contact.cells();
        for values in [
            &mut self.residual,
            &mut self.preconditioned,
            &mut self.last,
            &mut self.direction,
            &mut self.constant,
        ] {
            values.resize(cells, 0.0);
        }
        let (window, contact) = ([&mut self.field[..]], [&mut self.direction[..]]);
        self.contact
            .each(window, contact, |_, [field], [direction]| {
                field.fill(0.0);
                direction.fill(0.0);
                []
            });
        let constant_sum = self.precondition_constant(problem, scratch)?;
        let (mut previous, mut first_misfit, mut least_outside_m) = (0.0, 0.0, f64::INFINITY);
        let mut has_negative = false;
        for inner in 0..STEPS_PER_CONTACT {
            work.go_on()?;
            let approach_m;
            (self.misfit_m, approach_m) = self.update_residual(problem);
            let misfit = self.misfit_m / state.reference_m;
            if inner == 0 {
                first_misfit = misfit;
            } else {
                let penetration = (approach_m - least_outside_m) / state.reference_m;
                let has_shrunk = misfit < SHARE_BEFORE_JOINING * first_misfit;
                let is_done = misfit < 0.7 * problem.tolerance || work.steps >= steps;
                if has_negative && (has_shrunk || is_done) {
                    self.empty_negative(problem, scratch, work)?;
                    return Ok(true);
                }
                if is_done || has_shrunk && penetration > misfit {
                    return Ok(true);
                }
            }
            let product = self.precondition(problem, constant_sum, scratch)?;
            let beta = if inner == 0 {
                0.0
            } else {
                (product.1 / previous).max(0.0)
            };
            previous = product.0;
            let Some(step) = self.step_length(problem, beta, scratch)? else {
                return Ok(false);
            };
            work.steps += 1;
            let largest_m;
            (has_negative, least_outside_m, largest_m) =
                self.advance(step * problem.lift_m(), step);
            work.count_change(largest_m);
            let waits = waits && inner + 1 < STEPS_PER_CONTACT;
            if has_negative && !waits {
                self.empty_negative(problem, scratch, work)?;
                return Ok(true);
            }
        }
        Ok(true)
    }

    /// The residual: the approach, or under load control the mean over the contact of the gap before it, less that gap.
    /// Returns how far the gap is from none (m), on average by pressure or, if that says more, where it is highest; and the
    /// approach of which it is the gap.
    fn update_residual(&mut self, problem: &InstantOfCells<'_>) -> (f64, f64) {
        let (pressure, gap_m) = (&self.pressure, &self.gap_m);
        let found = self.contact.over(|block| {
            let (pressure, gap_m) = (
                &pressure[block.window.clone()],
                &gap_m[block.window.clone()],
            );
            let mut all = [0.0; 3];
            for Run { window: run, .. } in block.runs() {
                let terms = |p: f64, gap: f64| [gap, p, p * gap];
                let own = sums(&pressure[run.clone()], &gap_m[run], terms);
                (0..3).for_each(|n| all[n] += own[n]);
            }
            all
        });
        let [gaps, pressures, lifted] = [0, 1, 2].map(|which| found.total(which));
        let level_m = problem
            .approach_m
            .unwrap_or(gaps / self.contact.cells().max(1) as f64);
        let loaded = pressures > 0.0;
        let approach_m = match problem.approach_m {
            Some(approach_m) => approach_m,
            None if loaded => lifted / pressures,
            None => level_m,
        };
        let (window, contact) = ([&mut self.field[..]], [&mut self.residual[..]]);
        let found = self
            .contact
            .each(window, contact, |block, [field], [residual]| {
                let (pressure, gap_m) = (
                    &pressure[block.window.clone()],
                    &gap_m[block.window.clone()],
                );
                let (mut misfit, mut least_negated_m) = (0.0, f64::INFINITY);
                for Run { window, contact } in block.runs() {
                    let (pressure, gap_m) = (&pressure[window.clone()], &gap_m[window.clone()]);
                    misfit += sums(pressure, gap_m, |p, gap| [p * (gap - approach_m).abs()])[0];
                    least_negated_m = least_negated_m.min(least_of(gap_m, |gap| -gap));
                    let both = field[window].iter_mut().zip(&mut residual[contact]);
                    for ((f, r), gap) in both.zip(gap_m) {
                        *r = level_m - gap;
                        *f = *r as f32;
                    }
                }
                [misfit, least_negated_m]
            });
        let (misfit, highest_m) = (found.total(0), -found.least(1) - approach_m);
        let misfit_m = if loaded {
            (misfit / pressures).max(highest_m / STANDING_OFF)
        } else {
            f64::INFINITY
        };
        (misfit_m, approach_m)
    }

    /// Turns the direction, and finds how far to go along it; its displacement is then in `image`. `None` where it leads
    /// nowhere.
    fn step_length(
        &mut self,
        problem: &InstantOfCells<'_>,
        beta: f64,
        scratch: &mut Scratches,
    ) -> Result<Option<f64>, ContactError> {
        let (residual, preconditioned) = (&self.residual, &self.preconditioned);
        let (window, contact) = ([&mut self.field[..]], [&mut self.direction[..]]);
        let found = self
            .contact
            .each(window, contact, |block, [field], [direction]| {
                let at = || block.contact.clone();
                for (t, z) in direction.iter_mut().zip(&preconditioned[at()]) {
                    *t = z + beta * *t;
                }
                for Run { window, contact } in block.runs() {
                    let both = field[window].iter_mut().zip(&direction[contact]);
                    both.for_each(|(to, from)| *to = *from as f32);
                }
                [dot(&residual[at()], direction)]
            });
        let slope = found.total(0);
        (problem.elastic).displace(&self.field, &mut self.image, scratch)?;
        let (direction, image) = (&self.direction, &self.image);
        let found = self.contact.over(|block| {
            let direction = &direction[block.contact.clone()];
            let image = &image[block.window.clone()];
            let of_run = |run: Run| dot(&direction[run.contact], &image[run.window]);
            [block.runs().map(of_run).sum()]
        });
        let curvature = problem.lift_m() * found.total(0);
        let step = slope / curvature;
        Ok((curvature > 0.0 && step.is_finite()).then_some(step))
    }

    /// Moves the pressure by `step` times the direction, and the gap by `lift` (m) times its displacement. Returns whether a pressure has
    /// turned negative, the least gap (m) outside the contact, before the approach is taken off, and the largest change of a gap (m).
    fn advance(&mut self, lift: f64, step: f64) -> (bool, f64, f64) {
        let (direction, image) = (&self.direction, &self.image);
        let window = [&mut self.gap_m[..], &mut self.pressure[..]];
        let found = self
            .contact
            .each(window, [], |block, [gap_m, pressure], []| {
                let direction = &direction[block.contact.clone()];
                let image = &image[block.window.clone()];
                add_scaled(gap_m, lift, image);
                let largest = -least_of(image, |image| -image.abs());
                let mut lowest = f64::INFINITY;
                for Run { window, contact } in block.runs() {
                    let pressure = &mut pressure[window];
                    for (p, t) in pressure.iter_mut().zip(&direction[contact]) {
                        *p += step * t;
                    }
                    lowest = lowest.min(least(pressure));
                }
                let outside = block.others().map(|cells| least(&gap_m[cells]));
                [lowest, outside.fold(f64::INFINITY, f64::min), -largest]
            });
        let largest_m = lift.abs() * -found.least(2);
        (found.least(0) < 0.0, found.least(1), largest_m)
    }

    /// Takes cells of negative pressure out of the contact, keeping the load, and follows with the gap.
    fn empty_negative(
        &mut self,
        problem: &InstantOfCells<'_>,
        scratch: &mut Scratches,
        work: &mut Work,
    ) -> Result<(), ContactError> {
        let scale = match problem.target_sum {
            None => 1.0,
            Some(target) => {
                let pressure = &self.pressure;
                let kept = self.contact.over(|block| {
                    let pressure = &pressure[block.window.clone()];
                    let of_run = |run: Run| {
                        let own = &pressure[run.window];
                        sums(own, own, |p, _| [p.max(0.0)])[0]
                    };
                    [block.runs().map(of_run).sum()]
                });
                target / kept.total(0)
            }
        };
        let kept = |p: f64| scale * p.max(0.0);
        let pressure = &self.pressure;
        self.contact
            .each([&mut self.field[..]], [], |block, [field], []| {
                let pressure = &pressure[block.window.clone()];
                for Run { window, .. } in block.runs() {
                    let changes = field[window.clone()].iter_mut();
                    for (change, p) in changes.zip(&pressure[window]) {
                        *change = (kept(*p) - p) as f32;
                    }
                }
                []
            });
        self.contact
            .each([&mut self.pressure[..]], [], |block, [pressure], []| {
                let pressures = block.runs().map(|run| run.window);
                pressures.for_each(|run| pressure[run].iter_mut().for_each(|p| *p = kept(*p)));
                []
            });
        (problem.elastic).displace(&self.field, &mut self.image, scratch)?;
        let (image, lift) = (&self.image, problem.lift_m());
        let found = self
            .contact
            .each([&mut self.gap_m], [], |block, [gap_m], []| {
                let image = &image[block.window.clone()];
                add_scaled(gap_m, lift, image);
                [least_of(image, |image| -image.abs())]
            });
        work.count_change(lift * -found.least(0));
        Ok(())
    }
}
