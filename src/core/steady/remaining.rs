//! How far a cycle is from the stabilised one.
//!
//! The change from one cycle to the next is not that distance: with retardation time lambda and period T what remains shrinks
//! by exp(-T/lambda) per cycle, so that at T << lambda a cycle that hardly moves may still be far away. The memory variables
//! tell: if one cycle changes a branch's memory by dm, the sum of all changes to come is dm / (1 - exp(-T/lambda)) for as long as
//! the pressure stays what it is.
//!
//! Where T/lambda is small beside the tolerance, rounding in the memory makes that quotient say nothing. Such a branch hardly moves
//! within a period: in the stabilised cycle its memory is a mean of the pressure, m = mean of p exp(-(T-s)/lambda) (T/lambda)/(1 -
//! exp(-T/lambda)), which is the plain mean and T/lambda times the first moment of p about the middle of the cycle, but for terms of
//! order (T/lambda)^2; what is missing is the difference from that.

use crate::contact::sums;
use crate::material::Creep;

/// A branch is held in periods shorter than this part of its retardation time: terms of second order are then 1e-10, and
/// rounding of the memory over a longer period leaves 1e-10 of it too.
const HELD: f64 = 1e-5;

/// A branch over a period.
#[derive(Debug, Clone, Copy)]
struct Branch {
    /// 1 - exp(-T/lambda), without cancellation; 1 where the branch is held, whose difference is whole at once.
    forgotten: f64,
    /// T/lambda, where the branch is held.
    held: Option<f64>,
}

/// What a period does to each branch of a compliance.
#[derive(Debug, Clone)]
pub struct Remaining(Vec<Branch>);

impl Remaining {
    /// Over a period of `period_s` seconds, of this contact compliance.
    pub fn new(compliance: &Creep, period_s: f64) -> Self {
        let branch = |time_s: f64| {
            let part = period_s / time_s;
            let held = (part < HELD).then_some(part);
            Branch {
                forgotten: held.map_or_else(|| -(-part).exp_m1(), |_| 1.0),
                held,
            }
        };
        Self(
            compliance
                .branches()
                .iter()
                .map(|b| branch(b.time_s))
                .collect(),
        )
    }

    /// Whether a branch does not move within the period.
    pub fn is_held(&self, branch: usize) -> bool {
        self.0
            .get(branch)
            .is_some_and(|branch| branch.held.is_some())
    }

    /// Whether any does: the mean pressure of the cycle is then needed.
    fn holds_any(&self) -> bool {
        self.0.iter().any(|branch| branch.held.is_some())
    }

    /// Into `change`: m' - m over the cycle per node, branch-major like the memory variables `start` and `end`; where the branch is
    /// held, the mean of the pressure less m.
    pub fn change(&self, start: &[f64], end: &[f64], pressure: &MeanPressure, change: &mut [f64]) {
        let nodes = pressure.nodes;
        let ends = start.chunks_exact(nodes).zip(end.chunks_exact(nodes));
        let fields = change.chunks_exact_mut(nodes).zip(ends);
        for (branch, (change, (start, end))) in self.0.iter().zip(fields) {
            match branch.held {
                None => {
                    for ((change, after), before) in change.iter_mut().zip(end).zip(start) {
                        *change = after - before;
                    }
                }
                Some(part) => {
                    let means = pressure.mean.iter().zip(&pressure.moment);
                    for ((change, (mean, moment)), memory) in
                        change.iter_mut().zip(means).zip(start)
                    {
                        *change = mean + part * moment - memory;
                    }
                }
            }
        }
    }

    /// The estimated distance of a change over a cycle: the largest over the branches of the root of the sum over the nodes of its
    /// squares, over what a period forgets.
    ///
    /// Not the largest over the nodes: one at the edge of the contact may come and go with the discretisation for ever, without
    /// any weight in the loss.
    pub fn distance(&self, change: &[f64], nodes: usize) -> f64 {
        let norms = change.chunks_exact(nodes).zip(&self.0);
        norms
            .map(|(change, branch)| sums::dot(change, change).sqrt() / branch.forgotten)
            .fold(0.0, f64::max)
    }
}

/// The mean over a cycle of the pressure per node, and its first moment about the middle of the cycle in parts of the period, by
/// the trapezium rule over equal steps. Nothing is added up where no branch is held.
#[derive(Debug, Clone)]
pub struct MeanPressure {
    nodes: usize,
    mean: Vec<f64>,
    moment: Vec<f64>,
    steps: usize,
}

impl MeanPressure {
    /// Over this many nodes and steps, as far as these branches need it.
    pub fn new(remaining: &Remaining, nodes: usize, steps: usize) -> Self {
        let sums = if remaining.holds_any() { nodes } else { 0 };
        Self {
            nodes,
            mean: vec![0.0; sums],
            moment: vec![0.0; sums],
            steps,
        }
    }

    /// Takes in the pressure at the end of a step, that at the start of the cycle as the end of step 0.
    pub fn add(&mut self, step: usize, pressure: &[f64]) {
        if step == 0 {
            self.mean.fill(0.0);
            self.moment.fill(0.0);
        }
        let steps = self.steps as f64;
        let is_end = step == 0 || step == self.steps;
        let weight = if is_end { 0.5 } else { 1.0 } / steps;
        let moment_weight = weight * (step as f64 / steps - 0.5);
        let sums = self.mean.iter_mut().zip(&mut self.moment);
        for ((mean, moment), p) in sums.zip(pressure) {
            *mean += weight * p;
            *moment += moment_weight * p;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::CreepBranch;

    fn one_branch(time_s: f64) -> Creep {
        let branch = CreepBranch {
            compliance_per_pa: 1.0,
            time_s,
        };
        Creep::new(1.0, vec![branch], None).unwrap()
    }

    #[test]
    fn the_distance_of_a_relaxing_memory_is_what_is_left_of_it() {
        // m(n) = m* (1 - exp(-n T/lambda)): the change of any cycle tells the distance at its beginning.
        for period_over_lambda in [1e-4, 0.01, 1.0, 50.0] {
            let memory = |cycle: f64| -(-cycle * period_over_lambda).exp_m1();
            let remaining = Remaining::new(&one_branch(3.0), 3.0 * period_over_lambda);
            let mut change = [0.0];
            let pressure = MeanPressure::new(&remaining, 1, 8);
            remaining.change(&[memory(7.0)], &[memory(8.0)], &pressure, &mut change);
            // The change is a difference of numbers near 1: 1e-16 over it.
            assert!((remaining.distance(&change, 1) - (1.0 - memory(7.0))).abs() < 1e-11);
        }
    }

    #[test]
    fn a_branch_that_hardly_moves_within_a_period_misses_a_mean_of_the_pressure() {
        // The periodic memory under p = 2 + sin(2 pi s/T) + s/T, at the start of the cycle.
        for part in [1e-6_f64, 1e-12] {
            let remaining = Remaining::new(&one_branch(part.recip()), 1.0);
            assert!(remaining.is_held(0));
            let steps = 400;
            let mut pressure = MeanPressure::new(&remaining, 1, steps);
            for step in 0..=steps {
                let s = step as f64 / steps as f64;
                pressure.add(step, &[2.0 + (std::f64::consts::TAU * s).sin() + s]);
            }
            // First moments about 1/2: of the sine -1/(2 pi), of s 1/12.
            let exact = 2.5 + part * (1.0 / 12.0 - 1.0 / std::f64::consts::TAU);
            let mut change = [0.0];
            remaining.change(&[exact], &[exact], &pressure, &mut change);
            // The trapezium rule, times T/lambda.
            assert!(change[0].abs() < 1e-5 * part + 1e-14, "{}", change[0]);
            assert_eq!(remaining.distance(&[-0.5], 1), 0.5);
        }
    }
}
