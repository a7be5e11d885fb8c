//! How far a cycle is from the stabilised one.
//!
//! The change from one cycle to the next is not that distance: with retardation time lambda and period T what remains shrinks
//! by exp(-T/lambda) per cycle, so that at T << lambda a cycle that hardly moves may still be far away. The memory variables
//! tell: if one cycle changes a branch's memory by dm, the sum of all changes to come is dm / (1 - exp(-T/lambda)) for as long as
//! the pressure stays what it is.
//!
//! Where T/lambda is small beside the tolerance, rounding in the memory makes that quotient say nothing. Such a branch hardly moves
//! within a period, and its memory in the stabilised cycle is known from the pressure of the cycle: m* = n/(1 - exp(-T/lambda)), with n
//! what the cycle makes of no memory at all ([`CycleSums`]), which is the mean of the pressure but for terms
//! of order T/lambda. What is missing is the difference from that. Both ways are the same but for rounding, since the sums have
//! the weights of the time rule.

use crate::contact::sums;
use crate::history::{CycleSums, Memory};
use crate::material::Creep;

/// A branch is held in periods shorter than this part of its retardation time: terms of second order are then 1e-10, and
/// rounding of the memory over a longer period leaves 1e-10 of it too.
const HELD: f64 = 1e-5;

/// A branch over a period.
#[derive(Debug, Clone, Copy)]
struct Branch {
    /// 1 - exp(-T/lambda), without cancellation.
    forgotten: f64,
    /// T/lambda.
    part: f64,
}

impl Branch {
    fn is_held(self) -> bool {
        self.part < HELD
    }
}

/// What a period does to each branch of a compliance.
#[derive(Debug, Clone)]
pub struct Remaining {
    period_s: f64,
    /// Sorted by time, as those of the compliance: the held ones come last.
    branches: Vec<Branch>,
    nodes: usize,
}

impl Remaining {
    /// Over a period of `period_s` seconds, of this contact compliance on this number of nodes.
    pub fn new(compliance: &Creep, period_s: f64, nodes: usize) -> Self {
        let branch = |time_s: f64| Branch {
            forgotten: -(-period_s / time_s).exp_m1(),
            part: period_s / time_s,
        };
        let branches = compliance.branches().iter();
        Self {
            period_s,
            branches: branches.map(|b| branch(b.time_s)).collect(),
            nodes,
        }
    }

    /// Whether a branch does not move within the period.
    pub fn is_held(&self, branch: usize) -> bool {
        self.branches.get(branch).is_some_and(|b| b.is_held())
    }

    /// The fastest of the branches that do not, whose sums over the cycle are needed.
    pub fn first_held(&self) -> Option<usize> {
        self.branches.iter().position(|branch| branch.is_held())
    }

    /// Into `change`: m' - m over the cycle per node, branch-major like the memory variables `start` and those at the end; where
    /// the branch is held, m* - m.
    pub fn change(&self, start: &[f64], end: &Memory, change: &mut [f64]) {
        let ends = end.variables().iter().zip(start);
        for (change, (after, before)) in change.iter_mut().zip(ends) {
            *change = after - before;
        }
        if let (Some(first), Some(sums)) = (self.first_held(), end.cycle_sums()) {
            self.change_held(first, start, sums, change);
        }
    }

    /// Of the first held branch m* follows from its own sums; of the slower ones it is linear in T/lambda between that and the mean
    /// of the pressure.
    fn change_held(&self, first: usize, start: &[f64], sums: &CycleSums, change: &mut [f64]) {
        let nodes = self.nodes;
        let Branch { forgotten, part } = self.branches[first];
        let held = self.branches.iter().zip(change.chunks_exact_mut(nodes));
        let held = held.zip(start.chunks_exact(nodes)).skip(first);
        for ((branch, change), start) in held {
            let share = branch.part / part;
            let of_nodes = sums.integral_s().iter().zip(sums.memory()).zip(start);
            for (change, ((integral_s, memory), start)) in change.iter_mut().zip(of_nodes) {
                let of_first = memory / forgotten;
                let mean = integral_s / self.period_s;
                *change = share * of_first + (1.0 - share) * mean - start;
            }
        }
    }

    /// The estimated distance of a change over a cycle: the largest over the branches of the size of what is missing, in the unit of
    /// [`Remaining::size`].
    ///
    /// Not the largest over the nodes: one at the edge of the contact may come and go with the discretisation for ever, without
    /// any weight in the loss.
    pub fn distance(&self, change: &[f64]) -> f64 {
        let fields = change.chunks_exact(self.nodes).zip(&self.branches);
        fields
            .map(|(change, branch)| match branch.is_held() {
                true => self.size(change),
                false => self.size(change) / branch.forgotten,
            })
            .fold(0.0, f64::max)
    }

    /// The size of a field over the nodes: the root of the sum of its squares.
    pub fn size(&self, field: &[f64]) -> f64 {
        sums::dot(field, field).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::{Hereditary, TimeRule};
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
            let remaining = Remaining::new(&one_branch(3.0), 3.0 * period_over_lambda, 1);
            let change = memory(8.0) - memory(7.0);
            // The change is a difference of numbers near 1: 1e-16 over it.
            assert!((remaining.distance(&[change]) - (1.0 - memory(7.0))).abs() < 1e-11);
        }
    }

    /// m* - m over one cycle of a pressure that opens and closes the contact, of one node whose memory began at zero.
    fn missing(creep: &Creep, steps: usize) -> Vec<f64> {
        const PERIOD_S: f64 = 1.0;
        let remaining = Remaining::new(creep, PERIOD_S, 1);
        let mut memory = Memory::new(creep.clone(), 1);
        if let Some(first) = remaining.first_held() {
            memory.begin_cycle(first);
        }
        let stages = memory.stages(PERIOD_S / steps as f64, TimeRule::Linear);
        let mut pressure = [0.0];
        for step in 0..steps {
            for stage in &stages {
                let at = (step as f64 + stage.pressure_at) / steps as f64;
                memory.predict(&stage.weights, &pressure, &mut [0.0]);
                pressure = [(0.3 - (at - 0.4).abs()).max(0.0)];
                memory.commit(&stage.weights, &pressure);
            }
        }
        let branches = creep.branches().len();
        let mut change = vec![0.0; branches];
        remaining.change(&vec![0.0; branches], &memory, &mut change);
        let whole = change.iter().zip(&remaining.branches);
        whole
            .map(|(change, branch)| {
                if branch.is_held() {
                    *change
                } else {
                    change / branch.forgotten
                }
            })
            .collect()
    }

    #[test]
    fn nothing_jumps_where_a_branch_becomes_held() {
        // Solids whose steps are in one stage and in two, on either side of the limit and far beyond it.
        for compliance_per_pa in [0.1, 1e4] {
            let of = |times_s: &[f64]| {
                let branch = |&time_s| CreepBranch {
                    compliance_per_pa,
                    time_s,
                };
                let branches = times_s.iter().map(branch).collect();
                missing(&Creep::new(1.0, branches, None).unwrap(), 17)
            };
            let limit_s = HELD.recip();
            let (moving, held) = (
                of(&[limit_s * (1.0 - 1e-9)])[0],
                of(&[limit_s * (1.0 + 1e-9)])[0],
            );
            // A memory of 1e-5 grown in sums of a few tens of numbers.
            assert!((moving / held - 1.0).abs() < 1e-12, "{moving} {held}");
            // Of two held branches the slower is linear in T/lambda, the rest is of second order.
            let alone = of(&[3.0 * limit_s])[0];
            let second = of(&[1.1 * limit_s, 3.0 * limit_s])[1];
            assert!((second / alone - 1.0).abs() < 1e-10, "{second} {alone}");
        }
    }
}
