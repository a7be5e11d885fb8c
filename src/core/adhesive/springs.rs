//! The row of springs under an attracted body of revolution: what each remembers, and what a step asks of it.

use super::attraction::{Attraction, root};
use super::body::Body;
use super::cycle::State;
use super::opening::gap_integral;
use super::weights::StepWeights;
use crate::contact::{ContactError, Prescribed};
use crate::indenter::Axisymmetric;

/// Where the edges are at an instant, and what they go with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Edges {
    /// Radius of the contact (m).
    pub contact_m: f64,
    /// Radius of the attracted zone (m).
    pub zone_m: f64,
    /// Approach (m).
    pub approach_m: f64,
    /// Load (N); negative is a pull.
    pub load_n: f64,
}

/// The row of springs of one indenter on one body, at an instant.
pub struct Springs<'a> {
    pub(super) body: &'a Body,
    pub(super) profile: &'a dyn Axisymmetric,
    pub(super) attraction: Attraction,
    /// Places of springs (m), from the axis on; the transformed gap (m) there, and its integral from the axis (m^2).
    pub(super) place_m: Vec<f64>,
    pub(super) gap_m: Vec<f64>,
    pub(super) gap_sum: Vec<f64>,
    /// Of every spring its branches: of one in contact the displacements (m) less what the gap is, so that springs that were
    /// always in contact all have the same; of another the forces (N/m).
    pub(super) memory: Vec<f64>,
    /// Springs in contact.
    pub(super) inside: usize,
    pub(super) now: Edges,
    /// The memory of the springs at the edges: at that of the contact in both forms, at that of the zone in forces.
    at_contact: [Vec<f64>; 2],
    at_zone: Vec<f64>,
    /// Of the step begun: what the past adds to the displacement (m) of a spring that is attracted, and takes from the force
    /// (N/m) of one in contact; of springs, of those at the edges, and summed up from the axis on.
    pub(super) retarded_m: Vec<f64>,
    held: Vec<f64>,
    held_sum: Vec<f64>,
    at_edges: [f64; 3],
    pub(super) scratch: [Vec<f64>; 2],
    /// Room for what springs at the zone's edge and at the contact's come to in a step.
    next_edges: [Vec<f64>; 3],
    /// When, in seconds of its march, each spring came into contact or left it: in turn, beginning out of contact.
    pub(super) changes_s: Vec<Vec<f64>>,
    pub(super) time_s: f64,
    /// What the search of an instant starts from: how far the contact's edge moved in the last step (m), how wide the zone was
    /// (m), and the slopes of what is sought there.
    pub(super) search: super::instant::Start,
}

/// A place in the row from which memory is taken.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Spring(usize),
    Contact,
    Zone,
}

impl<'a> Springs<'a> {
    /// Springs at these places (m), the first of which is the axis, under an undisturbed body out of reach.
    pub fn new(
        body: &'a Body,
        profile: &'a dyn Axisymmetric,
        attraction: Attraction,
        place_m: Vec<f64>,
    ) -> Self {
        let (springs, branches) = (place_m.len(), body.branches());
        let gap_m: Vec<f64> = place_m
            .iter()
            .map(|x| profile.transformed_gap_m(*x))
            .collect();
        let mut gap_sum = vec![0.0; springs];
        for spring in 1..springs {
            let ends = (place_m[spring - 1], place_m[spring]);
            gap_sum[spring] = gap_sum[spring - 1] + gap_integral(profile, ends);
        }
        let empty = || vec![0.0; branches];
        Self {
            body,
            profile,
            attraction,
            gap_m,
            gap_sum,
            memory: vec![0.0; springs * branches],
            inside: 0,
            now: Edges {
                approach_m: -attraction.range_m,
                ..Edges::default()
            },
            at_contact: [empty(), empty()],
            at_zone: empty(),
            retarded_m: vec![0.0; springs],
            held: vec![0.0; springs],
            held_sum: vec![0.0; springs],
            at_edges: [0.0; 3],
            scratch: [empty(), empty()],
            next_edges: [empty(), empty(), empty()],
            changes_s: vec![Vec::new(); springs],
            time_s: 0.0,
            search: super::instant::Start::default(),
            place_m,
        }
    }

    /// The instant last solved.
    pub fn edges(&self) -> Edges {
        self.now
    }

    /// The end of the row (m).
    pub(super) fn end_m(&self) -> f64 {
        self.place_m.last().copied().unwrap_or(0.0)
    }

    pub(super) fn branches_of(&self, spring: usize) -> std::ops::Range<usize> {
        let branches = self.body.branches();
        spring * branches..(spring + 1) * branches
    }

    /// Goes to where the contact is after this was prescribed for ever, from first touch on.
    ///
    /// # Errors
    /// As [`Springs::step`].
    pub fn rest(&mut self, prescribed: Prescribed) -> Result<Edges, ContactError> {
        let relaxed = self.body.relaxed();
        let mut elastic = Springs::new(
            &relaxed,
            self.profile,
            self.attraction,
            self.place_m.clone(),
        );
        let edges = elastic.step(&StepWeights::new(&relaxed, 0.0), prescribed)?;
        let force = |x_m: f64| self.attraction.force(x_m, edges.zone_m);
        for (spring, x_m) in self.place_m.iter().enumerate() {
            let value = match spring < elastic.inside {
                true => edges.approach_m,
                false => force(*x_m),
            };
            let range = self.branches_of(spring);
            self.memory[range].fill(value);
        }
        self.at_contact[0].fill(edges.approach_m);
        self.at_contact[1].fill(force(edges.contact_m));
        self.at_zone.fill(0.0);
        self.inside = elastic.inside;
        self.now = edges;
        self.search = super::instant::Start::default();
        Ok(edges)
    }

    /// Places of the springs (m).
    pub(super) fn places_m(&self) -> &[f64] {
        &self.place_m
    }

    /// What the springs remember now.
    pub(super) fn state(&self) -> State {
        let branches = self.body.branches();
        let mut displacements_m = Vec::with_capacity(self.memory.len() + 2 * branches);
        let of = |forces: &[f64], gap_m: f64| {
            let mut own = vec![0.0; branches];
            self.body.displacements_m(forces, &mut own);
            own.iter_mut().for_each(|e| *e += gap_m);
            own
        };
        for spring in 0..self.place_m.len() {
            let memory = &self.memory[self.branches_of(spring)];
            match spring < self.inside {
                true => displacements_m.extend_from_slice(memory),
                false => displacements_m.extend(of(memory, self.gap_m[spring])),
            }
        }
        displacements_m.extend_from_slice(&self.at_contact[0]);
        let gap_m = self.profile.transformed_gap_m(self.now.zone_m);
        displacements_m.extend(of(&self.at_zone, gap_m));
        State::new(self.place_m.clone(), displacements_m, self.now)
    }

    /// Goes to what springs at the same places remembered.
    pub(super) fn recall(&mut self, state: &State) {
        let (displacements_m, edges) = state.parts();
        let branches = self.body.branches();
        self.now = edges;
        self.inside = self.springs_within(edges.contact_m);
        let body = self.body;
        let forces = |displacements_m: &[f64], gap_m: f64, forces: &mut [f64]| {
            let free_m: Vec<f64> = displacements_m.iter().map(|e| e - gap_m).collect();
            body.forces(&free_m, forces);
        };
        for spring in 0..self.place_m.len() {
            let range = self.branches_of(spring);
            let (from, to) = (&displacements_m[range.clone()], &mut self.memory[range]);
            match spring < self.inside {
                true => to.copy_from_slice(from),
                false => forces(from, self.gap_m[spring], to),
            }
        }
        let at_edges = &displacements_m[self.memory.len()..];
        let gap_at_m = |x_m| self.profile.transformed_gap_m(x_m);
        let [at_contact_m, at_contact] = &mut self.at_contact;
        at_contact_m.copy_from_slice(&at_edges[..branches]);
        forces(at_contact_m, gap_at_m(edges.contact_m), at_contact);
        forces(
            &at_edges[branches..],
            gap_at_m(edges.zone_m),
            &mut self.at_zone,
        );
        self.search = super::instant::Start::default();
    }

    /// First part of a step: all that does not depend on where the edges will be.
    pub(super) fn begin(&mut self, weights: &StepWeights) {
        let (body, approach_m) = (self.body, self.now.approach_m);
        let retarded_m = |forces: &[f64]| -> f64 {
            let branches = forces
                .iter()
                .zip(&weights.left)
                .zip(&body.compliances_per_pa);
            branches
                .map(|((force, left), per_pa)| force * left * per_pa)
                .sum()
        };
        let held = |displacements_m: &[f64]| -> f64 {
            let branches = displacements_m
                .iter()
                .zip(&weights.displaced)
                .zip(&body.moduli_pa);
            let held =
                branches.map(|((e, w), modulus)| modulus * (w.decay * e + w.old * approach_m));
            held.sum()
        };
        for spring in 0..self.place_m.len() {
            let memory = &self.memory[self.branches_of(spring)];
            match spring < self.inside {
                true => self.held[spring] = held(memory),
                false => self.retarded_m[spring] = retarded_m(memory),
            }
        }
        let [displacements_m, forces] = &self.at_contact;
        self.at_edges = [
            held(displacements_m),
            retarded_m(forces),
            retarded_m(&self.at_zone),
        ];
        for spring in 1..self.inside {
            let width_m = self.place_m[spring] - self.place_m[spring - 1];
            let mean = 0.5 * (self.held[spring] + self.held[spring - 1]);
            self.held_sum[spring] = self.held_sum[spring - 1] + mean * width_m;
        }
    }

    /// How many springs a contact of this radius (m) has.
    fn springs_within(&self, contact_m: f64) -> usize {
        match contact_m > 0.0 {
            true => self.place_m.partition_point(|x_m| *x_m <= contact_m),
            false => 0,
        }
    }

    /// The last spring at or before a place.
    pub(super) fn before(&self, x_m: f64) -> usize {
        self.place_m
            .partition_point(|place_m| *place_m <= x_m)
            .saturating_sub(1)
    }

    /// Between which places out of contact `x_m` lies, and the share of the second: straight in the root to which the force of an
    /// attracted spring is proportional, and beyond the zone straight in x.
    fn between_outside(&self, x_m: f64) -> (Place, Place, f64) {
        let Edges {
            contact_m, zone_m, ..
        } = self.now;
        let spring = self.before(x_m).min(self.place_m.len() - 2);
        let (mut left, mut right) = (
            (Place::Spring(spring), self.place_m[spring]),
            (Place::Spring(spring + 1), self.place_m[spring + 1]),
        );
        if spring < self.inside {
            left = (Place::Contact, contact_m);
        }
        if x_m >= zone_m && left.1 < zone_m {
            left = (Place::Zone, zone_m);
        }
        if x_m < zone_m && right.1 > zone_m {
            right = (Place::Zone, zone_m);
        }
        let share = match x_m < zone_m {
            true => {
                let [from, at, to] = [left.1, x_m, right.1].map(|x_m| root(zone_m, x_m));
                share(from, at, to)
            }
            false => share(left.1, x_m, right.1),
        };
        (left.0, right.0, share)
    }

    /// The same in contact.
    fn between_inside(&self, x_m: f64) -> (usize, Place, f64) {
        let spring = self.before(x_m).min(self.inside - 1);
        let (next, next_m) = match spring + 1 < self.inside {
            true => (Place::Spring(spring + 1), self.place_m[spring + 1]),
            false => (Place::Contact, self.now.contact_m),
        };
        let share = share(self.place_m[spring], x_m, next_m);
        (spring, next, share.min(1.0))
    }

    /// What the past adds (m) to the displacement of a spring out of contact at `x_m`, in the step begun.
    pub(super) fn retarded_at_m(&self, x_m: f64) -> f64 {
        let of = |place| match place {
            Place::Spring(spring) => self.retarded_m[spring],
            Place::Contact => self.at_edges[1],
            Place::Zone => self.at_edges[2],
        };
        let (left, right, share) = self.between_outside(x_m);
        let left = of(left);
        left + share * (of(right) - left)
    }

    /// What the past takes from the force (N/m) of a spring in contact at `x_m`, and its integral (N) from the axis.
    pub(super) fn held_at(&self, x_m: f64) -> (f64, f64) {
        let (spring, next, share) = self.between_inside(x_m);
        let next = match next {
            Place::Spring(next) => self.held[next],
            _ => self.at_edges[0],
        };
        let left = self.held[spring];
        let held = left + share * (next - left);
        let sum = 0.5 * (held + left) * (x_m - self.place_m[spring]);
        (held, self.held_sum[spring] + sum)
    }

    /// The forces of the branches of a spring out of contact at `x_m`, before the step.
    fn forces_at(&self, x_m: f64, forces: &mut [f64]) {
        let of = |place| match place {
            Place::Spring(spring) => &self.memory[self.branches_of(spring)],
            Place::Contact => &self.at_contact[1],
            Place::Zone => &self.at_zone[..],
        };
        let (left, right, share) = self.between_outside(x_m);
        interpolate(of(left), of(right), share, forces);
    }

    /// The displacements of the branches of a spring in contact at `x_m`, before the step.
    fn displacements_at(&self, x_m: f64, displacements_m: &mut [f64]) {
        let (spring, next, share) = self.between_inside(x_m);
        let next = match next {
            Place::Spring(next) => &self.memory[self.branches_of(next)],
            _ => &self.at_contact[0][..],
        };
        let left = &self.memory[self.branches_of(spring)];
        interpolate(left, next, share, displacements_m);
    }

    /// The integral (m^2) of the transformed gap from the axis to a place.
    pub(super) fn gap_sum_at(&self, x_m: f64) -> f64 {
        let spring = self.before(x_m);
        self.gap_sum[spring] + gap_integral(self.profile, (self.place_m[spring], x_m))
    }

    /// Last part of a step: the springs go through it.
    pub(super) fn end(&mut self, weights: &StepWeights, to: Edges) {
        let now = self.now;
        let gap_m = self.profile.transformed_gap_m(to.contact_m);
        let [mut new, mut own] = std::mem::take(&mut self.scratch);
        let [mut at_zone, mut at_contact_m, mut at_contact] = std::mem::take(&mut self.next_edges);
        at_zone.fill(0.0);
        match to.zone_m < now.contact_m {
            true => {
                self.displacements_at(to.zone_m, &mut own);
                self.leave(weights, to.zone_m, &to, [&mut at_zone, &mut own]);
            }
            false => {
                self.forces_at(to.zone_m, &mut at_zone);
                self.load_along(weights, to.zone_m, to.zone_m, &mut at_zone);
            }
        }
        at_contact_m.fill(0.0);
        at_contact.fill(0.0);
        let (displacements_m, forces) = (&mut at_contact_m, &mut at_contact);
        if to.contact_m > 0.0 && to.contact_m < now.contact_m {
            self.displacements_at(to.contact_m, displacements_m);
            for (e, w) in displacements_m.iter_mut().zip(&weights.displaced) {
                w.drive(e, (now.approach_m, to.approach_m));
            }
            own.clear();
            own.extend(displacements_m.iter().map(|e| e - gap_m));
            self.body.forces(&own, forces);
        } else if to.contact_m >= now.contact_m {
            self.forces_at(to.contact_m, forces);
            self.load_along(weights, to.contact_m, to.zone_m, forces);
            self.body.displacements_m(forces, displacements_m);
            displacements_m.iter_mut().for_each(|e| *e += gap_m);
        }
        let inside = self.springs_within(to.contact_m);
        for spring in 0..self.place_m.len() {
            let range = self.branches_of(spring);
            match (spring < self.inside, spring < inside) {
                (true, true) => {
                    let memory = self.memory[range].iter_mut().zip(&weights.displaced);
                    memory.for_each(|(e, w)| w.drive(e, (now.approach_m, to.approach_m)));
                    continue;
                }
                (true, false) => {
                    own.copy_from_slice(&self.memory[range.clone()]);
                    self.leave(weights, self.place_m[spring], &to, [&mut new, &mut own]);
                }
                (false, true) => self.enter(weights, spring, &to, [&mut new, &mut own]),
                (false, false) => {
                    new.copy_from_slice(&self.memory[range.clone()]);
                    self.load_along(weights, self.place_m[spring], to.zone_m, &mut new);
                }
            }
            if (spring < self.inside) != (spring < inside) {
                let at_s = self.time_s + self.passed_at(self.place_m[spring], &to) * weights.step_s;
                self.changes_s[spring].push(at_s);
            }
            self.memory[range].copy_from_slice(&new);
        }
        self.scratch = [new, own];
        let [before_m, before] =
            std::mem::replace(&mut self.at_contact, [at_contact_m, at_contact]);
        let zone_before = std::mem::replace(&mut self.at_zone, at_zone);
        self.next_edges = [zone_before, before_m, before];
        self.inside = inside;
        self.time_s += weights.step_s;
        self.now = to;
    }
}

/// How far `at` is on the way between two places; 0 where they are one.
fn share(from: f64, at: f64, to: f64) -> f64 {
    let share = (at - from) / (to - from);
    if share.is_finite() { share } else { 0.0 }
}

fn interpolate(left: &[f64], right: &[f64], share: f64, between: &mut [f64]) {
    for ((between, left), right) in between.iter_mut().zip(left).zip(right) {
        *between = left + share * (right - left);
    }
}
