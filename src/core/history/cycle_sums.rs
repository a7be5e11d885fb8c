//! What the pressure of one cycle adds to the memory of a branch too slow to move within it.
//!
//! The change of such a branch over the cycle is a small difference of large numbers. Its sums here start from zero, so that they keep
//! their digits, and are taken with the weights of the time rule, so that they are what the march itself does to the branch.

use super::rule::{Recursion, StepWeights};

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

    /// The sums as memory variables, with their weights in a step.
    pub(super) fn fields<'s>(
        &'s mut self,
        step: &'s StepWeights,
    ) -> impl Iterator<Item = (&'s mut [f64], &'s Recursion)> {
        let weights = step.weights.last().into_iter();
        let fields = [&mut self.integral[..], &mut self.memory[..]].into_iter();
        fields.zip(weights.chain(step.weights.get(self.branch)))
    }
}
