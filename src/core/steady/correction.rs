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
//!
//! A series has a branch or two per decade, over many more decades than lie between a time step and the period. Unknowns of a node
//! are the branches between the two alone. A faster one follows the pressure within the step: in contact it adds to C_0, and
//! at the end of the cycle it is the pressure there. The slower ones, which do not move within the period ([`Remaining`]), all have
//! to meet the same mean pressure, and the pressure feels their sum alone: together they are one unknown.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector, RowDVector};

use super::remaining::Remaining;
use crate::material::Creep;

/// At which steps of a cycle each node came into contact, and left it.
pub(super) struct ContactHistory {
    steps: usize,
    /// Per node the steps at which it changed, from out of contact before the first: in contact after an odd number of them.
    changes: Vec<Vec<usize>>,
}

impl ContactHistory {
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            steps: 0,
            changes: vec![Vec::new(); nodes],
        }
    }

    pub(super) fn clear(&mut self) {
        self.steps = 0;
        self.changes.iter_mut().for_each(Vec::clear);
    }

    /// Takes in the pressures at the end of a step.
    pub(super) fn push(&mut self, pressure: &[f64]) {
        for (changes, p) in self.changes.iter_mut().zip(pressure) {
            if (*p > 0.0) != (changes.len() % 2 == 1) {
                changes.push(self.steps);
            }
        }
        self.steps += 1;
    }

    /// Lengths of the runs between these changes, out of contact and in contact in turn, beginning out of contact.
    fn runs(&self, changes: &[usize]) -> Vec<usize> {
        let starts = [&0].into_iter().chain(changes);
        let ends = changes.iter().chain([&self.steps]);
        ends.zip(starts).map(|(end, start)| end - start).collect()
    }
}

/// What a cycle does to a small change of the unknowns of one node.
struct NodeMonodromy {
    /// (1 - J)^-1.
    inverse: DMatrix<f64>,
    /// (1 - J)^-1 v.
    by_approach: DVector<f64>,
    /// Change of the mean load per change of the unknowns, and per unit of D with the unknowns following.
    load_by_memory: DVector<f64>,
    load_by_approach: f64,
    /// The same of the pressure at the end of the cycle.
    pressure_by_memory: DVector<f64>,
    pressure_by_approach: f64,
}

/// Retardation time over step, below which a branch follows the pressure: what it lags behind is this part of one step.
const FAST: f64 = 0.1;

/// A branch that moves within the period, or all that do not.
#[derive(Clone, Copy)]
struct Unknown {
    /// Beside the compliance of all that follows the pressure at once.
    compliance: f64,
    /// Step over retardation time; 0 where it does not move.
    rate: f64,
}

/// What a branch is to the unknowns of a node.
#[derive(Clone, Copy)]
enum Role {
    Fast,
    Moving(usize),
    /// Has this part in the one for all that do not move.
    Held(usize, f64),
}

/// Constants of one compliance, period and number of steps.
pub(super) struct Correction {
    /// Root of the compliance per branch: its weight in the least squares.
    weights: Vec<f64>,
    roles: Vec<Role>,
    unknowns: Vec<Unknown>,
    /// What the nodal pressure of each node is multiplied by to give its part of the load.
    loads: Vec<f64>,
    steps: usize,
    /// The answers to 1, 2, 4, 8, ... steps in contact, of which that to any number of them is a product. State: unknowns, load, D.
    touching: Vec<DMatrix<f64>>,
}

impl Correction {
    pub(super) fn new(
        compliance: &Creep,
        (period_s, steps): (f64, usize),
        remaining: &Remaining,
        loads: Vec<f64>,
    ) -> Self {
        let branches = compliance.branches().iter();
        let (roles, unknowns) = unknowns(compliance, period_s / steps as f64, remaining);
        Self {
            weights: branches.map(|b| b.compliance_per_pa.sqrt()).collect(),
            roles,
            loads,
            steps,
            touching: squares(step_in_contact(&unknowns), steps),
            unknowns,
        }
    }

    /// Weights in the least squares of the branches of this many nodes.
    pub(super) fn weights(&self, nodes: usize) -> Vec<f64> {
        let of_branches = self.weights.iter();
        let of_nodes = of_branches.flat_map(|weight| std::iter::repeat_n(*weight, nodes));
        of_nodes.collect()
    }

    /// Turns a change over a cycle, as [`Remaining::change`], into dm.
    pub(super) fn apply(&self, contact: &ContactHistory, keep_mean_load: bool, update: &mut [f64]) {
        let nodes = contact.changes.len();
        let mut known: HashMap<&[usize], usize> = HashMap::new();
        let mut monodromies: Vec<Option<NodeMonodromy>> = Vec::new();
        let mut of_nodes = Vec::with_capacity(nodes);
        let (mut load, mut stiffness) = (0.0, 0.0);
        let mut change = DVector::zeros(self.unknowns.len());
        let mut moved = change.clone();
        for (node, changes) in contact.changes.iter().enumerate() {
            let of_node = *known.entry(changes).or_insert_with(|| {
                monodromies.push(self.monodromy(&contact.runs(changes)));
                monodromies.len() - 1
            });
            of_nodes.push(of_node);
            let Some(monodromy) = &monodromies[of_node] else {
                continue;
            };
            self.gather(update, (node, nodes), &mut change);
            moved.gemv(1.0, &monodromy.inverse, &change, 0.0);
            load += self.loads[node] * monodromy.load_by_memory.dot(&moved);
            stiffness += self.loads[node] * monodromy.load_by_approach;
            let pressure = monodromy.pressure_by_memory.dot(&moved);
            moved -= &change;
            self.scatter((&moved, pressure, 1.0), (node, nodes), update);
        }
        if !keep_mean_load || stiffness <= 0.0 {
            return;
        }
        let approach = -load / stiffness;
        for (node, of_node) in of_nodes.into_iter().enumerate() {
            if let Some(monodromy) = &monodromies[of_node] {
                let by = (&monodromy.by_approach, monodromy.pressure_by_approach);
                self.scatter((by.0, by.1, approach), (node, nodes), update);
            }
        }
    }

    /// The unknowns of a node, of a change of all branches.
    fn gather(&self, update: &[f64], (node, nodes): (usize, usize), unknowns: &mut DVector<f64>) {
        unknowns.fill(0.0);
        for (branch, role) in self.roles.iter().enumerate() {
            let value = update[branch * nodes + node];
            match *role {
                Role::Fast => {}
                Role::Moving(unknown) => unknowns[unknown] = value,
                Role::Held(unknown, part) => unknowns[unknown] += part * value,
            }
        }
    }

    /// Adds to a change of all branches at a node one of its unknowns and of its pressure at the end of the cycle, times a factor.
    fn scatter(
        &self,
        (unknowns, pressure, factor): (&DVector<f64>, f64, f64),
        (node, nodes): (usize, usize),
        update: &mut [f64],
    ) {
        for (branch, role) in self.roles.iter().enumerate() {
            update[branch * nodes + node] += factor
                * match *role {
                    Role::Fast => pressure,
                    Role::Moving(unknown) | Role::Held(unknown, _) => unknowns[unknown],
                };
        }
    }

    /// The monodromy of a node with these runs; `None` where it cannot be had, and the change itself must do.
    fn monodromy(&self, runs: &[usize]) -> Option<NodeMonodromy> {
        let count = self.unknowns.len();
        let (load, approach) = (count, count + 1);
        let mut cycle = DMatrix::identity(count + 2, count + 2);
        for (run, &length) in runs.iter().enumerate() {
            if run % 2 == 1 {
                for (bit, steps) in self.touching.iter().enumerate() {
                    if length >> bit & 1 == 1 {
                        cycle = steps * cycle;
                    }
                }
                continue;
            }
            for (mut row, unknown) in cycle.row_iter_mut().zip(&self.unknowns) {
                row *= (-unknown.rate * length as f64).exp();
            }
        }
        let mut pressure = RowDVector::zeros(count + 2);
        if runs.len().is_multiple_of(2) {
            pressure[approach] = 1.0;
            for (row, unknown) in cycle.row_iter().zip(&self.unknowns) {
                pressure -= unknown.compliance * row;
            }
        }
        // Of branches that are held it is the mean pressure that has to meet the memory.
        let share = 1.0 / self.steps as f64;
        let end = |row: usize, column: usize| match self.unknowns[row].rate == 0.0 {
            true => share * cycle[(load, column)],
            false => cycle[(row, column)],
        };
        let memory = DMatrix::from_fn(count, count, end);
        let inverse = (DMatrix::identity(count, count) - memory).try_inverse()?;
        let by_approach = &inverse * DVector::from_fn(count, |row, _| end(row, approach));
        let load_by_memory = cycle.view((load, 0), (1, count)).row(0).transpose();
        let pressure_by_memory = pressure.columns(0, count).transpose();
        Some(NodeMonodromy {
            load_by_approach: cycle[(load, approach)] + load_by_memory.dot(&by_approach),
            pressure_by_approach: pressure[approach] + pressure_by_memory.dot(&by_approach),
            inverse,
            by_approach,
            load_by_memory,
            pressure_by_memory,
        })
    }
}

/// What each branch is to the unknowns of a node, and these.
fn unknowns(compliance: &Creep, step_s: f64, remaining: &Remaining) -> (Vec<Role>, Vec<Unknown>) {
    let branches = compliance.branches();
    let is_fast = |time_s: f64| time_s < FAST * step_s;
    let fast = branches.iter().filter(|b| is_fast(b.time_s));
    let fast_per_pa: f64 = fast.map(|b| b.compliance_per_pa).sum();
    let at_once_per_pa = compliance.instantaneous_compliance() + fast_per_pa;
    let held = (0..branches.len()).filter(|&branch| remaining.is_held(branch));
    let held_per_pa: f64 = held.map(|branch| branches[branch].compliance_per_pa).sum();
    let (mut roles, mut unknowns) = (Vec::with_capacity(branches.len()), Vec::new());
    // Branches are sorted by time: the held ones come last.
    for (index, branch) in branches.iter().enumerate() {
        if is_fast(branch.time_s) {
            roles.push(Role::Fast);
            continue;
        }
        let is_held = remaining.is_held(index);
        if !is_held || !matches!(roles.last(), Some(Role::Held(..))) {
            let per_pa = if is_held {
                held_per_pa
            } else {
                branch.compliance_per_pa
            };
            unknowns.push(Unknown {
                compliance: per_pa / at_once_per_pa,
                rate: if is_held { 0.0 } else { step_s / branch.time_s },
            });
        }
        let last = unknowns.len() - 1;
        roles.push(match is_held {
            true => Role::Held(last, branch.compliance_per_pa / held_per_pa),
            false => Role::Moving(last),
        });
    }
    (roles, unknowns)
}

/// The answer to one step in contact. D is counted in units of the compliance of all that follows the pressure at once.
fn step_in_contact(unknowns: &[Unknown]) -> DMatrix<f64> {
    let count = unknowns.len();
    let (load, approach) = (count, count + 1);
    let mut rates = DMatrix::zeros(count + 2, count + 2);
    rates[(load, approach)] = 1.0;
    for (i, unknown) in unknowns.iter().enumerate() {
        rates[(load, i)] = -unknown.compliance;
        for (j, other) in unknowns.iter().enumerate() {
            rates[(i, j)] = -other.compliance * unknown.rate;
        }
        rates[(i, i)] -= unknown.rate;
        rates[(i, approach)] = unknown.rate;
    }
    rates.exp()
}

/// A matrix, its square, the square of that and so on, up to the power `last`.
fn squares(matrix: DMatrix<f64>, last: usize) -> Vec<DMatrix<f64>> {
    let next = |square: &DMatrix<f64>| Some(square * square);
    let count = last.max(1).ilog2() as usize + 1;
    std::iter::successors(Some(matrix), next)
        .take(count)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::CreepBranch;

    const STEPS: usize = 20;

    /// Instantaneous compliance, and compliance and retardation time of each branch, over a period of 1 s.
    fn correction(instantaneous: f64, branches: &[(f64, f64)]) -> Correction {
        let branch = |&(compliance_per_pa, time_s): &(f64, f64)| CreepBranch {
            compliance_per_pa,
            time_s,
        };
        let branches = branches.iter().map(branch).collect();
        let creep = Creep::new(instantaneous, branches, None).unwrap();
        let remaining = Remaining::new(&creep, 1.0, 3);
        Correction::new(&creep, (1.0, STEPS), &remaining, vec![2.0, 3.0, 1.0])
    }

    /// A node always in contact, one that comes into it, and one that leaves it for a while.
    fn contact() -> ContactHistory {
        let mut contact = ContactHistory::new(3);
        for step in 0..STEPS {
            let touches = [true, step >= 7, !(5..12).contains(&step)];
            contact.push(&touches.map(|touches| f64::from(u8::from(touches))));
        }
        contact
    }

    #[test]
    fn runs_alternate_and_begin_out_of_contact() {
        let contact = contact();
        let runs = |node: usize| contact.runs(&contact.changes[node]);
        assert_eq!(runs(0), [0, 20]);
        assert_eq!(runs(1), [7, 13]);
        assert_eq!(runs(2), [0, 5, 7, 8]);
    }

    #[test]
    fn a_run_of_steps_in_contact_is_that_many_single_steps_and_takes_few_matrices() {
        let correction = correction(1.0, &[(2.0, 0.7), (1.0, 0.2)]);
        let one = correction.touching[0].clone();
        assert!(correction.touching.len() <= 5, "20 steps");
        let mut expected = DMatrix::identity(4, 4);
        for length in 1..=STEPS {
            expected = &one * expected;
            // The whole cycle in contact, cut into runs that touch one another.
            let bits = (0..5).filter(|bit| length >> bit & 1 == 1);
            let found = bits.fold(DMatrix::identity(4, 4), |product, bit| {
                &correction.touching[bit] * product
            });
            assert!(
                (found - &expected).norm() < 1e-13 * expected.norm(),
                "{length}"
            );
        }
    }

    #[test]
    fn branches_far_faster_than_a_step_or_slower_than_the_period_count_by_their_sums() {
        let (fast, slow) = ([1e-6, 3e-5], [3e5, 4e7]);
        let many = correction(
            0.5,
            &[
                (0.2, fast[0]),
                (0.3, fast[1]),
                (2.0, 0.7),
                (1.0, slow[0]),
                (3.0, slow[1]),
            ],
        );
        let few = correction(1.0, &[(2.0, 0.7), (4.0, slow[1])]);
        assert_eq!((many.unknowns.len(), few.unknowns.len()), (2, 2));
        let contact = contact();
        // Branch-major: what a cycle changed, of the slow ones by their compliances the same in the mean.
        let (moving, mean) = ([1.0, -0.5, 0.3], [0.4, 0.2, -0.7]);
        let apart = [0.3, -0.2, 0.5];
        let held = [0, 1, 2].map(|i| [mean[i] - 3.0 * apart[i], mean[i] + apart[i]]);
        let mut of_many = [0.1; 15];
        let mut of_few = [0.0; 6];
        for i in 0..3 {
            (of_many[6 + i], of_few[i]) = (moving[i], moving[i]);
            (of_many[9 + i], of_many[12 + i]) = (held[i][0], held[i][1]);
            of_few[3 + i] = mean[i];
        }
        many.apply(&contact, true, &mut of_many);
        few.apply(&contact, true, &mut of_few);
        // A few roundings.
        let is_near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        for i in 0..3 {
            assert!(is_near(of_many[6 + i], of_few[i]), "{i}");
            let shift = of_few[3 + i] - mean[i];
            assert!(is_near(of_many[9 + i], held[i][0] + shift), "{i}");
            assert!(is_near(of_many[12 + i], held[i][1] + shift), "{i}");
            // At the end all fast ones are the pressure.
            assert!(is_near(of_many[i], of_many[3 + i]));
        }
    }
}
