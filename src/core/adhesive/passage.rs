//! A spring on its way through a step: attracted all the while, or passed by the edge of the contact.

use super::springs::{Edges, Springs};
use super::weights::{StepWeights, Straight};

/// From the front, in ways that it moves in the step: beyond, the force of a spring goes straight in time but for 1e-5 of it.
const FAR: f64 = 32.0;

impl Springs<'_> {
    /// The forces (N/m) of a spring at the beginning and at the end of the step, where it is so far from the front that they go straight.
    fn straight(&self, x_m: f64, zone_m: f64) -> Option<(f64, f64)> {
        let from_m = self.now.zone_m;
        let is_far = from_m.min(zone_m) - x_m > FAR * (zone_m - from_m).abs();
        is_far.then(|| {
            let at = |zone_m| self.attraction.force(x_m, zone_m);
            (at(from_m), at(zone_m))
        })
    }

    /// What the force within the step adds to the displacement (m) of a spring that is attracted all the while, beside the
    /// instantaneous one.
    pub(super) fn along_m(&self, weights: &StepWeights, x_m: f64, zone_m: f64) -> f64 {
        if weights.step_s == 0.0 || self.now.zone_m.max(zone_m) <= x_m {
            return 0.0;
        }
        if let Some((from, to)) = self.straight(x_m, zone_m) {
            let (old_per_pa, new_per_pa) = weights.straight_per_pa;
            return old_per_pa * from + new_per_pa * to;
        }
        let way_m = (self.now.zone_m, zone_m);
        let means = self.attraction.mean_forces(x_m, way_m, &weights.ends);
        let parts = means.zip(&weights.compliance_per_pa);
        parts.map(|(mean, per_pa)| per_pa * mean).sum()
    }

    /// Moves the branches of such a spring on.
    pub(super) fn load_along(
        &self,
        weights: &StepWeights,
        x_m: f64,
        zone_m: f64,
        forces: &mut [f64],
    ) {
        if weights.step_s > 0.0
            && let Some(ends) = self.straight(x_m, zone_m)
        {
            let branches = forces.iter_mut().zip(&weights.loaded);
            return branches.for_each(|(force, weights)| weights.drive(force, ends));
        }
        for (force, left) in forces.iter_mut().zip(&weights.left) {
            *force *= left;
        }
        if weights.step_s == 0.0 || self.now.zone_m.max(zone_m) <= x_m {
            return;
        }
        let way_m = (self.now.zone_m, zone_m);
        let means = self.attraction.mean_forces(x_m, way_m, &weights.ends);
        for (mean, added) in means.zip(&weights.added) {
            for (force, added) in forces.iter_mut().zip(added) {
                *force += added * mean;
            }
        }
    }

    /// The fraction of the step at which the contact's edge passes a place.
    pub(super) fn passed_at(&self, x_m: f64, to: &Edges) -> f64 {
        let from_m = self.now.contact_m;
        ((x_m - from_m) / (to.contact_m - from_m)).clamp(0.0, 1.0)
    }

    /// Loads branches of creep for a share of the step in which the edge of the zone moves like this, in the same parts as a whole
    /// step.
    pub(super) fn attract(
        &self,
        weights: &StepWeights,
        share: f64,
        x_m: f64,
        way_m: (f64, f64),
        forces: &mut [f64],
    ) {
        if share * weights.step_s <= 0.0 {
            return;
        }
        let means = self.attraction.mean_forces(x_m, way_m, &weights.ends);
        for (part, mean) in means.enumerate() {
            let time_s = share * weights.step_s * (weights.ends[part + 1] - weights.ends[part]);
            for (force, retardation_s) in forces.iter_mut().zip(&self.body.retardation_times_s) {
                *force = mean + (-time_s / retardation_s).exp() * (*force - mean);
            }
        }
    }

    /// Displaces branches of relaxation for a part of the step.
    pub(super) fn displace(&self, time_s: f64, ends: (f64, f64), displacements_m: &mut [f64]) {
        let times = self.body.relaxation_times_s.iter();
        for (e, relaxation_s) in displacements_m.iter_mut().zip(times) {
            Straight::over(time_s / relaxation_s).drive(e, ends);
        }
    }

    /// The forces of the branches, after the step, of a spring at `x_m` that leaves the contact in it, from their displacements before.
    pub(super) fn leave(
        &self,
        weights: &StepWeights,
        x_m: f64,
        to: &Edges,
        [forces, displacements_m]: [&mut [f64]; 2],
    ) {
        let (now, share) = (&self.now, self.passed_at(x_m, to));
        let approach_m = now.approach_m + share * (to.approach_m - now.approach_m);
        let ends = (now.approach_m, approach_m);
        self.displace(share * weights.step_s, ends, displacements_m);
        let gap_m = self.profile.transformed_gap_m(x_m);
        displacements_m.iter_mut().for_each(|e| *e -= gap_m);
        self.body.forces(displacements_m, forces);
        let zone_m = now.zone_m + share * (to.zone_m - now.zone_m);
        self.attract(weights, 1.0 - share, x_m, (zone_m, to.zone_m), forces);
    }

    /// The displacements of the branches, after the step, of a spring that comes into contact in it.
    pub(super) fn enter(
        &self,
        weights: &StepWeights,
        spring: usize,
        to: &Edges,
        [displacements_m, own]: [&mut [f64]; 2],
    ) {
        let x_m = self.place_m[spring];
        let (now, share) = (&self.now, self.passed_at(x_m, to));
        own.copy_from_slice(&self.memory[self.branches_of(spring)]);
        let zone_m = now.zone_m + share * (to.zone_m - now.zone_m);
        self.attract(weights, share, x_m, (now.zone_m, zone_m), own);
        let at_once_m =
            self.body.instantaneous_compliance_per_pa * self.attraction.force(x_m, zone_m);
        let touching_m = self.gap_m[spring] + at_once_m + self.body.retarded_m(own);
        self.body.displacements_m(own, displacements_m);
        displacements_m
            .iter_mut()
            .for_each(|e| *e += self.gap_m[spring]);
        let rest_s = (1.0 - share) * weights.step_s;
        self.displace(rest_s, (touching_m, to.approach_m), displacements_m);
    }
}
