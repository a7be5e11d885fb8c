//! The force of a contact over a prescribed indentation: T. C. T. Ting's problem (J. Appl. Mech. 33 (1966) 845) on the springs of the
//! axisymmetric engine, with the relaxation modulus in place of the compliance, so that a step solves nothing.
//!
//! A spring at x in contact has the displacement u = delta - G(x), and its force follows; out of contact it has no force, and u follows.
//! Within a step u is linear in time, from where the spring comes into contact on.
//!
//! A layer that relaxes in proportion to its base has springs too: the contact is a sum of flat punches of growing radius, of which each
//! adds its pressure and none changes the displacement within a smaller one. A punch of radius a touches at the approach of the elastic
//! contact of that radius, and the springs between two radii are as stiff as their punches differ ([`LayerContact`]).

use std::f64::consts::PI;

use crate::contact::axisymmetric::layer::LayerContact;
use crate::contact::half_space::layer::Layer;
use crate::indenter::Axisymmetric;
use crate::material::Relaxation;
use crate::numerics::polynomial::lagrange;
use crate::numerics::roots::{ALL_DIGITS, bisect};

/// Springs over the contact at the deepest indentation, each in the middle of its part.
const SPRINGS: usize = 72;

/// The springs of a contact up to some depth.
#[derive(Debug, Clone)]
pub(super) struct Springs {
    /// Of each the indentation at which it touches.
    gaps_m: Vec<f64>,
    /// Of each its force over displacement and contact modulus E/(1 - nu^2).
    stiffness_m: Vec<f64>,
    deepest_m: f64,
    /// Whether the indenter ends where the springs do, so that they are as many for any depth.
    has_end: bool,
}

/// Radii at which the equation of a layer is solved, and nodes for its smallest contact and for one as wide as it is thick.
const RADII: usize = 16;
const NODES: (usize, f64) = (16, 6.0);

/// What touches a layer at a radius: its indentation over that on a half-space, and by how much stiffer a punch is.
struct OnLayer {
    radii_m: Vec<f64>,
    gaps: Vec<f64>,
    stiffness: Vec<f64>,
}

impl OnLayer {
    /// For radii up to one.
    fn up_to(profile: &dyn Axisymmetric, layer: Layer, radius_m: f64) -> Option<Self> {
        let angle = |k: usize| PI * (k as f64 + 0.5) / RADII as f64;
        let radii_m: Vec<f64> = (0..RADII)
            .map(|k| 0.5 * radius_m * (1.0 - angle(k).cos()))
            .collect();
        let (mut gaps, mut stiffness) = (Vec::new(), Vec::new());
        for radius_m in &radii_m {
            let nodes = NODES.0 + (NODES.1 * radius_m / layer.thickness_m).ceil() as usize;
            let contact = LayerContact::new(layer, *radius_m, nodes);
            let found = contact.under(|x| profile.transformed_gap_m(x), 1.0)?;
            let free_m = profile.transformed_gap_m(*radius_m);
            gaps.push(if free_m == 0.0 {
                1.0
            } else {
                found.approach_m / free_m
            });
            stiffness.push(contact.punch_stiffness()?);
        }
        Some(Self {
            radii_m,
            gaps,
            stiffness,
        })
    }

    fn gap(&self, radius_m: f64) -> f64 {
        lagrange(&self.radii_m, &self.gaps, radius_m)
    }

    fn stiffness(&self, radius_m: f64) -> f64 {
        lagrange(&self.radii_m, &self.stiffness, radius_m)
    }
}

impl Springs {
    /// Up to a depth, on a half-space or a layer; `None` where the equation of the layer has no solution.
    pub(super) fn new(
        profile: &dyn Axisymmetric,
        layer: Option<Layer>,
        deepest_m: f64,
    ) -> Option<Self> {
        let limit_m = profile.contact_limit_m();
        let mut radius_m = radius_m(profile, deepest_m);
        let mut on_layer = None;
        if let Some(layer) = layer {
            // A layer is touched at a larger radius for the same depth.
            let end_m = limit_m.unwrap_or(f64::INFINITY);
            loop {
                let found = OnLayer::up_to(profile, layer, radius_m)?;
                let gap_m = |x: f64| found.gap(x) * profile.transformed_gap_m(x);
                if radius_m >= end_m || gap_m(radius_m) >= deepest_m {
                    let is_inside = |x: f64| gap_m(x) < deepest_m;
                    radius_m = match is_inside(radius_m) {
                        true => radius_m,
                        false => bisect(0.0, radius_m, ALL_DIGITS, is_inside).1,
                    };
                    on_layer = Some(found);
                    break;
                }
                radius_m = (1.3 * radius_m).min(end_m);
            }
        }
        let width_m = radius_m / SPRINGS as f64;
        let stiffer = |x: f64| on_layer.as_ref().map_or(1.0, |found| found.stiffness(x));
        let gap_m = |k: usize| {
            let x = (k as f64 + 0.5) * width_m;
            on_layer.as_ref().map_or(1.0, |found| found.gap(x)) * profile.transformed_gap_m(x)
        };
        let punch_m = |k: usize| 2.0 * k as f64 * width_m * stiffer(k as f64 * width_m);
        Some(Self {
            gaps_m: (0..SPRINGS).map(gap_m).collect(),
            stiffness_m: (0..SPRINGS).map(|k| punch_m(k + 1) - punch_m(k)).collect(),
            deepest_m,
            has_end: limit_m == Some(radius_m),
        })
    }

    /// F of an elastic body of contact modulus one: the force (N) over the modulus E/(1 - nu^2) (Pa).
    pub(super) fn elastic_m2(&self, indentation_m: f64) -> f64 {
        let springs = self.gaps_m.iter().zip(&self.stiffness_m);
        springs
            .map(|(gap_m, stiffness_m)| stiffness_m * (indentation_m - gap_m).max(0.0))
            .sum()
    }

    /// The force (N) at every point of a contact of this relaxation modulus, whose indentation is linear between them; `None` where it is
    /// deeper than the springs reach.
    pub(super) fn response(
        &self,
        contact: &Relaxation,
        (time_s, indentation_m): (&[f64], &[f64]),
    ) -> Option<Vec<f64>> {
        let mut march = March::new(self, contact);
        let mut force_n = Vec::with_capacity(time_s.len());
        for (&t, &depth_m) in time_s.iter().zip(indentation_m) {
            if depth_m > self.deepest_m && !self.has_end {
                return None;
            }
            force_n.push(march.step(t, depth_m));
        }
        Some(force_n)
    }
}

/// What the springs remember while an indentation goes on.
struct March<'a> {
    springs: &'a Springs,
    contact: &'a Relaxation,
    /// Of every spring.
    displacements_m: Vec<f64>,
    /// Of each branch its force in every spring.
    memory: Vec<f64>,
    /// Of every spring in a step: the force if it did not move, and by how much it moves.
    held: Vec<f64>,
    changes: Vec<f64>,
    /// Of every branch in a step: what is left of its force, and what a change adds to it.
    weights: Vec<(f64, f64)>,
    /// Springs that come into contact within a step: which, by how much each moves, and for how long (s) it is pressed.
    late: Vec<(usize, f64, f64)>,
    /// Time (s) and indentation (m).
    before: Option<(f64, f64)>,
    last_step_s: f64,
    /// Springs that have been touched.
    touched: usize,
}

impl<'a> March<'a> {
    fn new(springs: &'a Springs, contact: &'a Relaxation) -> Self {
        let (count, branches) = (springs.gaps_m.len(), contact.branches().len());
        Self {
            springs,
            contact,
            displacements_m: vec![0.0; count],
            memory: vec![0.0; count * branches],
            held: vec![0.0; count],
            changes: vec![0.0; count],
            weights: vec![(0.0, 0.0); branches],
            late: Vec::with_capacity(count),
            before: None,
            last_step_s: f64::NAN,
            touched: 0,
        }
    }

    /// Goes on to a time (s) and an indentation (m); the force (N) of all springs.
    fn step(&mut self, t: f64, depth_m: f64) -> f64 {
        let step_s = t - self.before.map_or(t, |(before, _)| before);
        self.weigh(step_s);
        let gaps_m = &self.springs.gaps_m;
        self.touched = self
            .touched
            .max(gaps_m.partition_point(|gap| *gap < depth_m));
        self.hold();
        let sum = self.press(depth_m, step_s) + self.press_late();
        self.before = Some((t, depth_m));
        sum
    }

    fn weigh(&mut self, step_s: f64) {
        if step_s == self.last_step_s {
            return;
        }
        for (weight, branch) in self.weights.iter_mut().zip(self.contact.branches()) {
            let ratio = step_s / branch.time_s;
            *weight = ((-ratio).exp(), branch.modulus_pa * mean_of_decay(ratio));
        }
        self.last_step_s = step_s;
    }

    /// What is left of all forces where nothing moves.
    fn hold(&mut self) {
        let (touched, count) = (self.touched, self.held.len());
        let equilibrium = self.contact.equilibrium_modulus();
        for (held, u) in self.held[..touched].iter_mut().zip(&self.displacements_m) {
            *held = equilibrium * u;
        }
        for (own, (left, _)) in self.memory.chunks_exact_mut(count).zip(&self.weights) {
            for (h, held) in own[..touched].iter_mut().zip(&mut self.held) {
                *h *= left;
                *held += *h;
            }
        }
    }

    /// Moves every spring with the indenter, or as it does without force; those that come into contact within the step are left for later.
    fn press(&mut self, depth_m: f64, step_s: f64) -> f64 {
        let (touched, count) = (self.touched, self.held.len());
        let gained = self.weights.iter().map(|(_, gained)| gained);
        let at_once = self.contact.equilibrium_modulus() + gained.sum::<f64>();
        self.late.clear();
        let mut sum = 0.0;
        for j in 0..touched {
            let (gap_m, u) = (self.springs.gaps_m[j], self.displacements_m[j]);
            let change = depth_m - gap_m - u;
            let force = self.held[j] + at_once * change;
            if force <= 0.0 {
                self.changes[j] = -self.held[j] / at_once;
                continue;
            }
            let open_m = self
                .before
                .map_or(0.0, |(_, before_m)| u + gap_m - before_m);
            if change > 0.0 && open_m > 1e-12 * self.springs.deepest_m {
                let pressed_s = step_s * change / (change + open_m);
                self.late.push((j, change, pressed_s));
                self.changes[j] = 0.0;
            } else {
                self.changes[j] = change;
                sum += self.springs.stiffness_m[j] * force;
            }
        }
        for (own, (_, gained)) in self.memory.chunks_exact_mut(count).zip(&self.weights) {
            for (h, change) in own[..touched].iter_mut().zip(&self.changes) {
                *h += gained * change;
            }
        }
        for (u, change) in self.displacements_m[..touched]
            .iter_mut()
            .zip(&self.changes)
        {
            *u += change;
        }
        sum
    }

    fn press_late(&mut self) -> f64 {
        let count = self.held.len();
        let mut sum = 0.0;
        for &(j, change, pressed_s) in &self.late {
            self.displacements_m[j] += change;
            let mut force = self.held[j] + self.contact.equilibrium_modulus() * change;
            let branches = self.contact.branches();
            for (own, branch) in self.memory.chunks_exact_mut(count).zip(branches) {
                let more = branch.modulus_pa * mean_of_decay(pressed_s / branch.time_s) * change;
                own[j] += more;
                force += more;
            }
            sum += self.springs.stiffness_m[j] * force;
        }
        sum
    }
}

/// (1 - exp(-r))/r, which is 1 for a jump.
fn mean_of_decay(ratio: f64) -> f64 {
    match ratio > 0.0 {
        true => -(-ratio).exp_m1() / ratio,
        false => 1.0,
    }
}

/// The radius (m) at which a half-space is touched at a depth, or that at which the indenter ends.
pub(super) fn radius_m(profile: &dyn Axisymmetric, depth_m: f64) -> f64 {
    if let Some(limit_m) = profile.contact_limit_m()
        && profile.transformed_gap_m(limit_m * (1.0 - 1e-9)) < depth_m
    {
        return limit_m;
    }
    let is_inside = |x: f64| profile.transformed_gap_m(x) < depth_m;
    let mut beyond = depth_m;
    while is_inside(beyond) {
        beyond *= 2.0;
    }
    bisect(0.0, beyond, ALL_DIGITS, is_inside).1
}
