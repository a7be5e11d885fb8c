//! The force of a contact over a prescribed indentation: T. C. T. Ting's problem (J. Appl. Mech. 33 (1966) 845) on the springs of the
//! axisymmetric engine, with the relaxation modulus in place of the compliance, so that a step solves nothing.
//!
//! A spring at x in contact has the displacement u = delta - G(x), and its force follows; out of contact it has no force, and u follows.
//! Within a step u is linear in time, from where the spring comes into contact on.

use crate::indenter::Axisymmetric;
use crate::material::Relaxation;
use crate::numerics::roots::{ALL_DIGITS, bisect};

/// Springs over the contact at the deepest indentation, each in the middle of its part.
const SPRINGS: usize = 72;

/// The springs of a contact up to some depth.
#[derive(Debug, Clone)]
pub(super) struct Springs {
    gaps_m: Vec<f64>,
    width_m: f64,
    deepest_m: f64,
    /// Whether the indenter ends where the springs do, so that they are as many for any depth.
    has_end: bool,
}

impl Springs {
    pub(super) fn new(profile: &dyn Axisymmetric, deepest_m: f64) -> Self {
        let radius_m = match profile.contact_limit_m() {
            Some(limit_m) if profile.transformed_gap_m(limit_m * (1.0 - 1e-9)) < deepest_m => {
                limit_m
            }
            _ => {
                let is_inside = |x: f64| profile.transformed_gap_m(x) < deepest_m;
                let mut beyond = deepest_m;
                while is_inside(beyond) {
                    beyond *= 2.0;
                }
                bisect(0.0, beyond, ALL_DIGITS, is_inside).1
            }
        };
        let width_m = radius_m / SPRINGS as f64;
        let places = (0..SPRINGS).map(|k| (k as f64 + 0.5) * width_m);
        Self {
            gaps_m: places.map(|x| profile.transformed_gap_m(x)).collect(),
            width_m,
            deepest_m,
            has_end: profile.contact_limit_m() == Some(radius_m),
        }
    }

    /// F of an elastic body of contact modulus one: the force (N) over the modulus E/(1 - nu^2) (Pa).
    pub(super) fn elastic_m2(&self, indentation_m: f64) -> f64 {
        let pressed = self.gaps_m.iter().map(|gap| (indentation_m - gap).max(0.0));
        2.0 * self.width_m * pressed.sum::<f64>()
    }

    /// The force (N) at every point of a contact of this relaxation modulus, whose indentation is linear between them; `None` where it is deeper than
    /// the springs reach.
    pub(super) fn response(
        &self,
        contact: &Relaxation,
        time_s: &[f64],
        indentation_m: &[f64],
    ) -> Option<Vec<f64>> {
        let branches = contact.branches();
        let equilibrium = contact.equilibrium_modulus();
        let springs = self.gaps_m.len();
        let mut displacements = vec![0.0; springs];
        // Of each branch its force in every spring.
        let mut memory = vec![0.0; springs * branches.len()];
        let (mut held, mut changes) = (vec![0.0; springs], vec![0.0; springs]);
        let mut weights = vec![(0.0, 0.0); branches.len()];
        let mut late: Vec<(usize, f64, f64)> = Vec::new();
        let mut force_n = Vec::with_capacity(time_s.len());
        let mut before: Option<(f64, f64)> = None;
        let mut last_step_s = f64::NAN;
        let mut touched = 0;
        for (&t, &depth) in time_s.iter().zip(indentation_m) {
            if depth > self.deepest_m && !self.has_end {
                return None;
            }
            let step_s = t - before.map_or(t, |(before, _)| before);
            if step_s != last_step_s {
                for (weight, branch) in weights.iter_mut().zip(branches) {
                    let ratio = step_s / branch.time_s;
                    *weight = ((-ratio).exp(), branch.modulus_pa * mean_of_decay(ratio));
                }
                last_step_s = step_s;
            }
            let at_once = equilibrium + weights.iter().map(|(_, gained)| gained).sum::<f64>();
            touched = touched.max(self.gaps_m.partition_point(|gap| *gap < depth));
            for (held, u) in held[..touched].iter_mut().zip(&displacements) {
                *held = equilibrium * u;
            }
            for (own, (left, _)) in memory.chunks_exact_mut(springs).zip(&weights) {
                for (h, held) in own[..touched].iter_mut().zip(&mut held) {
                    *h *= left;
                    *held += *h;
                }
            }
            late.clear();
            let mut sum = 0.0;
            for j in 0..touched {
                let change = depth - self.gaps_m[j] - displacements[j];
                let force = held[j] + at_once * change;
                changes[j] = change;
                if force <= 0.0 {
                    changes[j] = -held[j] / at_once;
                    continue;
                }
                let before_m = before.map_or(0.0, |(_, depth)| depth) - self.gaps_m[j];
                let gap_m = displacements[j] - before_m;
                if before.is_some() && change > 0.0 && gap_m > 1e-12 * self.deepest_m {
                    // It was out of contact, and is pressed for a part of the step.
                    late.push((j, change, step_s * change / (change + gap_m)));
                    changes[j] = 0.0;
                } else {
                    sum += force;
                }
            }
            for (own, (_, gained)) in memory.chunks_exact_mut(springs).zip(&weights) {
                for (h, change) in own[..touched].iter_mut().zip(&changes) {
                    *h += gained * change;
                }
            }
            for (u, change) in displacements[..touched].iter_mut().zip(&changes) {
                *u += change;
            }
            for &(j, change, pressed_s) in &late {
                displacements[j] += change;
                sum += held[j] + equilibrium * change;
                for (own, branch) in memory.chunks_exact_mut(springs).zip(branches) {
                    let more = branch.modulus_pa * mean_of_decay(pressed_s / branch.time_s);
                    own[j] += more * change;
                    sum += more * change;
                }
            }
            force_n.push(2.0 * self.width_m * sum);
            before = Some((t, depth));
        }
        Some(force_n)
    }
}

/// (1 - exp(-r))/r, which is 1 for a jump.
fn mean_of_decay(ratio: f64) -> f64 {
    match ratio > 0.0 {
        true => -(-ratio).exp_m1() / ratio,
        false => 1.0,
    }
}
