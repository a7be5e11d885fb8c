//! What the pressure of one cycle adds to the memory of a branch too slow to move within it.
//!
//! The change of such a branch over the cycle is a small difference of large numbers. Its sums here start from zero, so that they keep
//! their digits, and are taken with the weights of the time rule, so that they are what the march itself does to the branch.

use std::ops::Range;

use super::memory::BranchWeights;
use crate::contact::sums::add_scaled;

/// Sums since a cycle began, per node.
#[derive(Debug, Clone)]
pub struct CycleSums {
    /// The branch, in the order of the compliance.
    branch: usize,
    /// Integral of the pressure over time (s times the unit of the pressure).
    integral: Vec<f64>,
    /// The memory of the branch, had it been zero when the cycle began.
    memory: Vec<f64>,
}

impl CycleSums {
    pub(super) fn new(branch: usize, nodes: usize) -> Self {
        Self {
            branch,
            integral: vec![0.0; nodes],
            memory: vec![0.0; nodes],
        }
    }

    /// Integral over the cycle of the pressure of each node (s times the unit of the pressure).
    pub fn integral_s(&self) -> &[f64] {
        &self.integral
    }

    /// The memory of each node after the cycle, of a branch that began the cycle without any.
    pub fn memory(&self) -> &[f64] {
        &self.memory
    }

    /// Takes in the pressure at the start of a step over these nodes, whose integral has the weight `flow_s` (s).
    pub(super) fn predict(
        &mut self,
        nodes: &Range<usize>,
        (branches, flow_s): (&[BranchWeights], f64),
        old_pressure: &[f64],
    ) {
        add_scaled(&mut self.integral[nodes.clone()], flow_s, old_pressure);
        let BranchWeights { decay, old, .. } = branches[self.branch];
        let memory = self.memory[nodes.clone()].iter_mut();
        for (m, p) in memory.zip(old_pressure) {
            *m = decay * *m + old * p;
        }
    }

    /// Takes in that at its end.
    pub(super) fn commit(
        &mut self,
        nodes: &Range<usize>,
        (branches, flow_s): (&[BranchWeights], f64),
        new_pressure: &[f64],
    ) {
        add_scaled(&mut self.integral[nodes.clone()], flow_s, new_pressure);
        let new = branches[self.branch].new;
        add_scaled(&mut self.memory[nodes.clone()], new, new_pressure);
    }
}
