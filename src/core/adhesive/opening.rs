//! What edges would go with: the gap where the zone ends, the approach, and the load.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use super::attraction::root;
use super::springs::{Edges, Springs};
use super::weights::StepWeights;
use crate::indenter::Axisymmetric;

impl Springs<'_> {
    /// By how much (m) the gap at the edge of the zone exceeds the range, were the edges there after the step, and the approach (m) that
    /// goes with them: that at which the force is continuous at the edge of the contact, unless one is given.
    pub(super) fn excess_m(
        &mut self,
        weights: &StepWeights,
        (contact_m, zone_m): (f64, f64),
        approach_m: Option<f64>,
    ) -> (f64, f64) {
        let per_pa = self.body.instantaneous_compliance_per_pa;
        let force = self.attraction.force(contact_m, zone_m);
        let gap_m = self.profile.transformed_gap_m(contact_m);
        let approach_m = approach_m.unwrap_or_else(|| match contact_m >= self.now.contact_m {
            true => {
                let retarded_m = self.retarded_at_m(contact_m);
                gap_m + per_pa * force + retarded_m + self.along_m(weights, contact_m, zone_m)
            }
            false => {
                let held = self.held_at(contact_m).0;
                (force + self.body.equilibrium_modulus_pa * gap_m + held) / weights.modulus_pa
            }
        });
        let range_m = self.attraction.range_m;
        if zone_m <= contact_m {
            return (-range_m, approach_m);
        }
        let to = Edges {
            contact_m,
            zone_m,
            approach_m,
            load_n: 0.0,
        };
        let from = Sector::at(contact_m, zone_m, approach_m - gap_m - per_pa * force);
        // What the gap would be without the past: exactly, in the angle in which the root is none.
        let angle = from.sine.atan2(from.cosine);
        let sector = FRAC_PI_2 - angle;
        let free = GAUSS.iter().map(|(at, weight)| {
            let x_m = zone_m * (angle + sector * at).sin();
            weight * (self.profile.transformed_gap_m(x_m) - approach_m)
        });
        let mut sum_m = sector * free.sum::<f64>();
        sum_m -= 2.0 * per_pa * self.attraction.stress_pa * (zone_m - contact_m);
        let first = self
            .place_m
            .partition_point(|place_m| *place_m <= contact_m);
        let end = self.place_m.partition_point(|place_m| *place_m < zone_m);
        let [mut forces, mut own] = std::mem::take(&mut self.scratch);
        let mut last = from;
        for spring in first..=end {
            let at = match spring == end {
                true => zone_m,
                false => self.place_m[spring],
            };
            let retarded_m = if spring == end {
                self.retarded_at_m(at) + self.along_m(weights, at, zone_m)
            } else if spring < self.inside {
                own.copy_from_slice(&self.memory[self.branches_of(spring)]);
                self.leave(weights, at, &to, [&mut forces, &mut own]);
                self.body.retarded_m(&forces)
            } else {
                self.retarded_m[spring] + self.along_m(weights, at, zone_m)
            };
            let next = Sector::at(at, zone_m, retarded_m);
            sum_m += last.integral_to(&next);
            last = next;
        }
        self.scratch = [forces, own];
        (FRAC_2_PI * sum_m - range_m, approach_m)
    }

    /// The load (N) of these edges after the step.
    pub(super) fn load_n(&mut self, weights: &StepWeights, to: &Edges) -> f64 {
        let (equilibrium_pa, from_m) = (self.body.equilibrium_modulus_pa, self.now.contact_m);
        let kept_m = to.contact_m.min(from_m);
        let mut sum = 0.0;
        let mut at_edge = None;
        if self.inside > 0 {
            let (held, held_sum) = self.held_at(kept_m);
            sum += weights.modulus_pa * to.approach_m * kept_m - held_sum;
            at_edge = Some(weights.modulus_pa * to.approach_m - held);
        }
        sum -= equilibrium_pa * self.gap_sum_at(to.contact_m);
        if to.contact_m > from_m {
            // The force and what the gap takes from it: straight between the springs that have come into contact.
            let [mut displacements_m, mut own] = std::mem::take(&mut self.scratch);
            let mut last = (from_m, at_edge);
            let entered = self
                .place_m
                .partition_point(|place_m| *place_m <= to.contact_m);
            for spring in self.inside..=entered.max(self.inside) {
                let (x_m, force) = if spring >= entered {
                    let gap_m = self.profile.transformed_gap_m(to.contact_m);
                    let force = self.attraction.force(to.contact_m, to.zone_m);
                    (to.contact_m, force + equilibrium_pa * gap_m)
                } else {
                    self.enter(weights, spring, to, [&mut displacements_m, &mut own]);
                    let force = self.body.force(to.approach_m, &displacements_m);
                    (self.place_m[spring], force)
                };
                sum += 0.5 * (last.1.unwrap_or(force) + force) * (x_m - last.0);
                last = (x_m, Some(force));
            }
            self.scratch = [displacements_m, own];
        }
        2.0 * sum + self.attraction.pull_n(to.contact_m, to.zone_m)
    }
}

/// A place within the zone, x = c sin(angle), and a displacement (m) there.
#[derive(Clone, Copy)]
struct Sector {
    sine: f64,
    cosine: f64,
    displacement_m: f64,
}

impl Sector {
    fn at(x_m: f64, zone_m: f64, displacement_m: f64) -> Self {
        let (sine, cosine) = (x_m / zone_m, root(zone_m, x_m) / zone_m);
        Self {
            sine,
            cosine,
            displacement_m,
        }
    }

    /// The angle between two places, from its sine; mostly so small that the first terms of the series are all of it.
    fn angle_to(&self, end: &Self) -> f64 {
        let sine = end.sine * self.cosine - end.cosine * self.sine;
        let square = sine * sine;
        match square < 1e-3 {
            true => {
                sine * (1.0
                    + square * (1.0 / 6.0 + square * (3.0 / 40.0 + square * (15.0 / 336.0))))
            }
            false => sine.atan2(end.cosine * self.cosine + end.sine * self.sine),
        }
    }

    /// The integral over the angle of a displacement that is straight in the cosine.
    fn integral_to(&self, end: &Self) -> f64 {
        let (angle, cosine) = (self.angle_to(end), end.cosine - self.cosine);
        if cosine.abs() < 1e-9 {
            return 0.5 * angle * (self.displacement_m + end.displacement_m);
        }
        let slope = (end.displacement_m - self.displacement_m) / cosine;
        (self.displacement_m - slope * self.cosine) * angle + slope * (end.sine - self.sine)
    }
}

/// Gauss' rule of ten points on the interval from 0 to 1: places and weights.
const GAUSS: [(f64, f64); 10] = [
    (0.013_046_735_741_414_128, 0.033_335_672_154_344_07),
    (0.067_468_316_655_507_73, 0.074_725_674_575_290_31),
    (0.160_295_215_850_487_78, 0.109_543_181_257_991_03),
    (0.283_302_302_935_376_4, 0.134_633_359_654_998_17),
    (0.425_562_830_509_184_4, 0.147_762_112_357_376_44),
    (0.574_437_169_490_815_6, 0.147_762_112_357_376_44),
    (0.716_697_697_064_623_6, 0.134_633_359_654_998_17),
    (0.839_704_784_149_512_2, 0.109_543_181_257_991_03),
    (0.932_531_683_344_492_3, 0.074_725_674_575_290_31),
    (0.986_953_264_258_585_9, 0.033_335_672_154_344_07),
];

/// The integral (m^2) of the transformed gap between two places (m).
pub(super) fn gap_integral(profile: &dyn Axisymmetric, (from_m, to_m): (f64, f64)) -> f64 {
    let width_m = to_m - from_m;
    let gaps = GAUSS
        .iter()
        .map(|(at, weight)| weight * profile.transformed_gap_m(from_m + width_m * at));
    match width_m == 0.0 {
        true => 0.0,
        false => width_m * gaps.sum::<f64>(),
    }
}
