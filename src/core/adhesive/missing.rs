//! What is missing to the memory that a cycle would not change, spring by spring.

use nalgebra::{DMatrix, DVector};

use super::body::Body;
use super::springs::Springs;

impl Springs<'_> {
    /// Begins to note when springs come into contact and leave it.
    pub(super) fn begin_cycle(&mut self) {
        self.time_s = 0.0;
        self.changes_s.iter_mut().for_each(Vec::clear);
    }

    /// Turns the change over the cycle since [`Springs::begin_cycle`] into what is missing: spring by spring as if the approach stayed
    /// what it is, and, where the load is what is prescribed, with the shift of the approach that leaves the mean load to the
    /// relaxed body.
    pub(super) fn correct(&self, period_s: f64, keeps_load: bool, change: &mut [f64]) {
        let branches = self.body.branches();
        if branches == 0 {
            return;
        }
        // What a branch changed at the beginning does to the mean of the force over the cycle.
        let branches_of_body = self
            .body
            .moduli_pa
            .iter()
            .zip(&self.body.relaxation_times_s);
        let moduli_pa: Vec<f64> = branches_of_body
            .map(|(modulus, time_s)| modulus * -(-period_s / time_s).exp_m1() * time_s / period_s)
            .collect();
        let (mut relaxing, mut stiffness) = (0.0, 0.0);
        let mut shares = Vec::with_capacity(self.place_m.len());
        for (spring, change) in change.chunks_exact_mut(branches).enumerate() {
            let spells = self.spells(spring, period_s);
            missing(self.body, &spells, period_s, change);
            let touching = spells.iter().filter(|(in_contact, _)| *in_contact);
            let share = touching.map(|(_, time_s)| time_s).sum::<f64>() / period_s;
            let weight = share * self.width_m(spring);
            let branches = moduli_pa.iter().zip(&*change);
            relaxing += weight * branches.map(|(modulus, e)| modulus * e).sum::<f64>();
            stiffness += weight * self.body.equilibrium_modulus_pa;
            shares.push(share);
        }
        if keeps_load && stiffness > 0.0 {
            for (share, change) in shares.iter().zip(change.chunks_exact_mut(branches)) {
                let shift_m = share * relaxing / stiffness;
                change.iter_mut().for_each(|e| *e += shift_m);
            }
        }
    }

    /// The spells of a spring in the cycle, one after the other: whether in contact, and how long (s).
    fn spells(&self, spring: usize, period_s: f64) -> Vec<(bool, f64)> {
        let changes_s = &self.changes_s[spring];
        let mut in_contact = (spring < self.inside) != (changes_s.len() % 2 == 1);
        let mut from_s = 0.0;
        let ends = changes_s.iter().chain([&period_s]);
        let spell = |end_s: &f64| {
            let spell = (in_contact, end_s - from_s);
            (in_contact, from_s) = (!in_contact, *end_s);
            spell
        };
        ends.map(spell).collect()
    }

    /// The width (m) that a spring stands for.
    fn width_m(&self, spring: usize) -> f64 {
        let last = self.place_m.len() - 1;
        0.5 * (self.place_m[(spring + 1).min(last)] - self.place_m[spring.saturating_sub(1)])
    }

    /// Weights of the branches of all springs in least squares: the root of their modulus, and of the width that the spring stands for.
    pub(super) fn importance(&self) -> Vec<f64> {
        let branches = self.body.moduli_pa.iter();
        let whole_m = self.end_m();
        let springs = (0..self.place_m.len()).map(|spring| self.width_m(spring) / whole_m);
        springs
            .flat_map(|width| {
                branches
                    .clone()
                    .map(move |modulus| (width * modulus).sqrt())
            })
            .collect()
    }
}

/// Turns what a cycle of these spells, in contact or not and so long (s), changed in the branches of a spring into what is missing to the
/// memory that it would not change.
fn missing(body: &Body, spells: &[(bool, f64)], period_s: f64, change: &mut [f64]) {
    let count = body.branches();
    if let [(in_contact, _)] = spells {
        let forgotten = |time_s: &f64| -(-period_s / time_s).exp_m1();
        if *in_contact {
            let branches = change.iter_mut().zip(&body.relaxation_times_s);
            branches.for_each(|(e, time_s)| *e /= forgotten(time_s));
            return;
        }
        let mut forces = vec![0.0; count];
        body.forces(change, &mut forces);
        let branches = forces.iter_mut().zip(&body.retardation_times_s);
        branches.for_each(|(force, time_s)| *force /= forgotten(time_s));
        body.displacements_m(&forces, change);
        return;
    }
    let fade = |mut cycle: DMatrix<f64>, times_s: &[f64], time_s: f64| {
        for (mut row, own_s) in cycle.row_iter_mut().zip(times_s) {
            row *= (-time_s / own_s).exp();
        }
        cycle
    };
    let mut cycle = DMatrix::<f64>::identity(count, count);
    for &(in_contact, time_s) in spells {
        cycle = match in_contact {
            true => fade(cycle, &body.relaxation_times_s, time_s),
            false => {
                let forces = &body.forces_of_displacements * cycle;
                &body.displacements_of_forces * fade(forces, &body.retardation_times_s, time_s)
            }
        };
    }
    let left = DMatrix::identity(count, count) - cycle;
    if let Some(solved) = left.lu().solve(&DVector::from_column_slice(change)) {
        change.copy_from_slice(solved.as_slice());
    }
}
