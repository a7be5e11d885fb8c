//! The update of the memory that one cycle suggests: Newton's method on the map over a cycle (T. J. Aprille and T. N. Trick,
//! Proc. IEEE 60 (1972) 108), with the monodromy J of every node alone, coupled by the approach.
//!
//! A small change dm of a node's memory at the start of the cycle changes its memory at the end by J dm, where J follows from
//! the times at which the node is in contact: out of contact every branch forgets by itself, d(dm_j)/dt = -dm_j / lambda_j;
//! in contact the pressure answers, C_0 dp + sum C_j dm_j = D, with D a change of the approach, constant over the cycle. The
//! fixed point then lies, to first order, at
//!
//! ```text
//! dm = (1 - J)^-1 (m' - m + v D),      D such that the mean load of the cycle does not change
//! ```
//!
//! with v the answer of the memory at the end to a unit of D. Exact are, so, the nodes; the change of the contact's edge and
//! the elastic coupling of cells through anything but D are left to the acceleration.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use super::remaining::Remaining;
use crate::material::Creep;

/// Whether each node is in contact, step by step of a cycle.
pub(super) struct ContactHistory {
    nodes: usize,
    steps: Vec<bool>,
}

impl ContactHistory {
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            nodes,
            steps: Vec::new(),
        }
    }

    pub(super) fn clear(&mut self) {
        self.steps.clear();
    }

    /// Takes in the pressures at the end of a step.
    pub(super) fn push(&mut self, pressure: &[f64]) {
        self.steps.extend(pressure.iter().map(|p| *p > 0.0));
    }

    /// Lengths of the runs of a node, out of contact and in contact in turn, beginning out of contact.
    fn runs(&self, node: usize) -> Vec<usize> {
        let mut runs = vec![0];
        let mut in_contact = false;
        for touches in self.steps.iter().skip(node).step_by(self.nodes) {
            if *touches != in_contact {
                in_contact = *touches;
                runs.push(0);
            }
            if let Some(last) = runs.last_mut() {
                *last += 1;
            }
        }
        runs
    }
}

/// What a cycle does to a small change of one node's memory.
struct NodeMonodromy {
    /// (1 - J)^-1.
    inverse: DMatrix<f64>,
    /// (1 - J)^-1 v.
    by_approach: DVector<f64>,
    /// Change of the mean load per change of the memory, and per unit of D with the memory following.
    load_by_memory: DVector<f64>,
    load_by_approach: f64,
}

/// Steps over retardation time, at most: what is faster follows the pressure within the step all the same. Of spectra that reach
/// far below the step (a master curve has twenty decades) the exponential of the rates would be lost in rounding of the largest.
const FASTEST: f64 = 1e3;

/// Constants of one compliance, period and number of steps.
pub(super) struct Correction {
    /// Root of the compliance per branch: its weight in the least squares.
    weights: Vec<f64>,
    remaining: Remaining,
    /// What the nodal pressure of each node is multiplied by to give its part of the load.
    loads: Vec<f64>,
    steps: usize,
    /// Powers 0, 1, 2, ... of the answer to one step, out of contact and in contact. State: memory, load, D.
    free: Vec<DMatrix<f64>>,
    touching: Vec<DMatrix<f64>>,
}

impl Correction {
    pub(super) fn new(
        compliance: &Creep,
        (period_s, steps): (f64, usize),
        remaining: Remaining,
        loads: Vec<f64>,
    ) -> Self {
        let branches = compliance.branches();
        let count = branches.len();
        let (load, approach) = (count, count + 1);
        let step_s = period_s / steps as f64;
        let instantaneous = compliance.instantaneous_compliance();
        let mut rates = DMatrix::zeros(count + 2, count + 2);
        let mut free = DMatrix::identity(count + 2, count + 2);
        for (i, branch) in branches.iter().enumerate() {
            rates[(load, i)] = -branch.compliance_per_pa / (instantaneous * step_s);
            if remaining.is_held(i) {
                continue;
            }
            let time_s = branch.time_s.max(step_s / FASTEST);
            free[(i, i)] = (-step_s / time_s).exp();
            for (j, other) in branches.iter().enumerate() {
                rates[(i, j)] = -other.compliance_per_pa / (instantaneous * time_s);
            }
            rates[(i, i)] -= time_s.recip();
            // D is counted in units of C_0, which keeps the matrix free of units but for time.
            rates[(i, approach)] = time_s.recip();
        }
        rates[(load, approach)] = step_s.recip();
        let touching = (rates * step_s).exp();
        Self {
            weights: branches
                .iter()
                .map(|b| b.compliance_per_pa.sqrt())
                .collect(),
            remaining,
            loads,
            steps,
            free: powers(&free, steps),
            touching: powers(&touching, steps),
        }
    }

    /// Weight of a branch in the least squares.
    pub(super) fn weight(&self, branch: usize) -> f64 {
        self.weights.get(branch).copied().unwrap_or(0.0)
    }

    /// Turns a change over a cycle, as [`Remaining::change`], into dm.
    pub(super) fn apply(&self, contact: &ContactHistory, keep_mean_load: bool, update: &mut [f64]) {
        let (nodes, branches) = (contact.nodes, self.weights.len());
        let mut monodromies: HashMap<Vec<usize>, Option<NodeMonodromy>> = HashMap::new();
        let keys: Vec<Vec<usize>> = (0..nodes).map(|node| contact.runs(node)).collect();
        let (mut load, mut stiffness) = (0.0, 0.0);
        for (node, key) in keys.iter().enumerate() {
            let monodromy = monodromies
                .entry(key.clone())
                .or_insert_with(|| self.monodromy(key));
            let Some(monodromy) = monodromy else { continue };
            let change =
                DVector::from_iterator(branches, (0..branches).map(|j| update[j * nodes + node]));
            let moved = &monodromy.inverse * change;
            load += self.loads[node] * monodromy.load_by_memory.dot(&moved);
            stiffness += self.loads[node] * monodromy.load_by_approach;
            for (j, value) in moved.iter().enumerate() {
                update[j * nodes + node] = *value;
            }
        }
        if !keep_mean_load || stiffness <= 0.0 {
            return;
        }
        let approach = -load / stiffness;
        for (node, key) in keys.iter().enumerate() {
            if let Some(Some(monodromy)) = monodromies.get(key) {
                for (j, value) in monodromy.by_approach.iter().enumerate() {
                    update[j * nodes + node] += approach * value;
                }
            }
        }
    }

    /// The monodromy of a node with these runs; `None` where it cannot be had, and the change itself must do.
    fn monodromy(&self, runs: &[usize]) -> Option<NodeMonodromy> {
        let count = self.weights.len();
        let mut cycle = DMatrix::identity(count + 2, count + 2);
        for (run, &length) in runs.iter().enumerate() {
            let powers = if run % 2 == 0 {
                &self.free
            } else {
                &self.touching
            };
            cycle = powers.get(length)? * cycle;
        }
        // Of a branch that is held it is the mean pressure that has to meet the memory.
        let share = 1.0 / self.steps as f64;
        let end = |row: usize, column: usize| match self.remaining.is_held(row) {
            true => share * cycle[(count, column)],
            false => cycle[(row, column)],
        };
        let memory = DMatrix::from_fn(count, count, end);
        let by_approach = DVector::from_fn(count, |row, _| end(row, count + 1));
        let load_by_memory = cycle.view((count, 0), (1, count)).row(0).transpose();
        let inverse = (DMatrix::identity(count, count) - memory).try_inverse()?;
        let by_approach = &inverse * by_approach;
        Some(NodeMonodromy {
            load_by_approach: cycle[(count, count + 1)] + load_by_memory.dot(&by_approach),
            inverse,
            by_approach,
            load_by_memory,
        })
    }
}

/// Powers 0 to `last` of a matrix.
fn powers(matrix: &DMatrix<f64>, last: usize) -> Vec<DMatrix<f64>> {
    let mut powers = vec![DMatrix::identity(matrix.nrows(), matrix.ncols())];
    for _ in 0..last {
        let next = powers.last().map(|power| matrix * power);
        powers.extend(next);
    }
    powers
}
