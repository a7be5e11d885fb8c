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

    /// The same contact on a third of the springs.
    pub(super) fn coarser(&self) -> Self {
        let middle = self.gaps_m.chunks_exact(3).map(|gaps_m| gaps_m[1]);
        let sums = self.stiffness_m.chunks_exact(3).map(|own| own.iter().sum());
        Self {
            gaps_m: middle.collect(),
            stiffness_m: sums.collect(),
            ..*self
        }
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

/// Springs that are computed side by side.
const LANES: usize = 8;

/// What the springs remember while an indentation goes on.
struct March<'a> {
    springs: &'a Springs,
    contact: &'a Relaxation,
    /// Of every spring.
    displacements_m: Vec<[f64; LANES]>,
    /// Of every group of springs the force of each branch, up to the last step and without what that added.
    memory: Vec<[f64; LANES]>,
    /// Of every spring in a step: the force if it did not move, and by how much it moves.
    held: Vec<[f64; LANES]>,
    changes: Vec<[f64; LANES]>,
    weights: Vec<Weight>,
    /// Springs that come into contact within a step: which, by how much each moves, and for how long (s) it is pressed.
    late: Vec<(usize, f64, f64)>,
    /// Time (s) and indentation (m).
    before: Option<(f64, f64)>,
    last_step_s: f64,
    /// Springs that have been touched.
    touched: usize,
}

/// Of a branch in a step.
#[derive(Debug, Clone, Copy, Default)]
struct Weight {
    /// What is left of its force.
    left: f64,
    /// What a change adds to it, and what one added in the step before.
    gained: f64,
    gained_before: f64,
}

impl<'a> March<'a> {
    fn new(springs: &'a Springs, contact: &'a Relaxation) -> Self {
        let (count, branches) = (springs.gaps_m.len(), contact.branches().len());
        let groups = count.div_ceil(LANES);
        let of_springs = vec![[0.0; LANES]; groups];
        Self {
            springs,
            contact,
            displacements_m: of_springs.clone(),
            memory: vec![[0.0; LANES]; groups * branches],
            held: of_springs.clone(),
            changes: of_springs,
            weights: vec![Weight::default(); branches],
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
        for (weight, branch) in self.weights.iter_mut().zip(self.contact.branches()) {
            weight.gained_before = weight.gained;
            if step_s != self.last_step_s {
                let ratio = step_s / branch.time_s;
                let (left, mean) = decay(ratio);
                weight.left = left;
                weight.gained = branch.modulus_pa * mean;
            }
        }
        self.last_step_s = step_s;
    }

    /// What is left of all forces where nothing moves.
    fn hold(&mut self) {
        let (branches, groups) = (self.weights.len(), self.touched.div_ceil(LANES));
        let equilibrium = self.contact.equilibrium_modulus();
        for group in 0..groups {
            let mut sum = self.displacements_m[group].map(|u| equilibrium * u);
            let change = self.changes[group];
            let memory = &mut self.memory[group * branches..][..branches];
            for (force, weight) in memory.iter_mut().zip(&self.weights) {
                let (mut own, weight) = (*force, *weight);
                for lane in 0..LANES {
                    own[lane] = weight.left * (own[lane] + weight.gained_before * change[lane]);
                    sum[lane] += own[lane];
                }
                *force = own;
            }
            self.held[group] = sum;
        }
    }

    /// Moves every spring with the indenter, or as it does without force; those that come into contact within the step are left for later.
    fn press(&mut self, depth_m: f64, step_s: f64) -> f64 {
        let gained = self.weights.iter().map(|weight| weight.gained);
        let at_once = self.contact.equilibrium_modulus() + gained.sum::<f64>();
        self.late.clear();
        let mut sum = 0.0;
        let held = self.held.as_flattened();
        let displacements_m = self.displacements_m.as_flattened_mut();
        let changes = self.changes.as_flattened_mut();
        for j in 0..self.touched {
            let (gap_m, u) = (self.springs.gaps_m[j], displacements_m[j]);
            let change = depth_m - gap_m - u;
            let force = held[j] + at_once * change;
            if force <= 0.0 {
                changes[j] = -held[j] / at_once;
                continue;
            }
            let open_m = self
                .before
                .map_or(0.0, |(_, before_m)| u + gap_m - before_m);
            if change > 0.0 && open_m > 1e-12 * self.springs.deepest_m {
                let pressed_s = step_s * change / (change + open_m);
                self.late.push((j, change, pressed_s));
                changes[j] = 0.0;
            } else {
                changes[j] = change;
                sum += self.springs.stiffness_m[j] * force;
            }
        }
        for (u, change) in displacements_m.iter_mut().zip(changes) {
            *u += *change;
        }
        sum
    }

    fn press_late(&mut self) -> f64 {
        let branches = self.contact.branches();
        let mut sum = 0.0;
        for &(j, change, pressed_s) in &self.late {
            self.displacements_m[j / LANES][j % LANES] += change;
            let mut force =
                self.held[j / LANES][j % LANES] + self.contact.equilibrium_modulus() * change;
            let memory = &mut self.memory[j / LANES * branches.len()..];
            for (own, branch) in memory.iter_mut().zip(branches) {
                let more = branch.modulus_pa * decay(pressed_s / branch.time_s).1 * change;
                own[j % LANES] += more;
                force += more;
            }
            sum += self.springs.stiffness_m[j] * force;
        }
        sum
    }
}

/// Below it a decay is linear to twelve digits.
const SHORT: f64 = 1e-4;

/// exp(-r) and its mean up to there, (1 - exp(-r))/r.
fn decay(ratio: f64) -> (f64, f64) {
    if ratio < SHORT {
        let mean = 1.0 - ratio * (1.0 / 2.0 - ratio / 6.0);
        return (1.0 - ratio * mean, mean);
    }
    let left = (-ratio).exp();
    (left, (1.0 - left) / ratio)
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
