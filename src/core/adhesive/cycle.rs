//! The stabilised cycle of an attracted contact: the memory that one cycle leaves as it found it.
//!
//! For edges that move as they do, what a cycle does to the branches of a spring is a matrix that follows from when the spring came
//! into contact and left it, since in contact its displacement is given and out of contact its force. Newton's method with these
//! matrices is exact for every spring; how the edges and the approach change with the memory is left to Anderson's
//! acceleration.

use super::attraction::Attraction;
use super::body::Body;
use super::springs::{Edges, Springs};
use super::weights::StepWeights;
use crate::contact::{ContactError, Prescribed};
use crate::cycle::{closure_error, work_along};
use crate::indenter::Axisymmetric;
use crate::numerics::grid::in_steps;
use crate::numerics::roots::{ALL_DIGITS, bisect};
use crate::steady::Anderson;

/// A cycle of an attracted contact.
#[derive(Clone, Copy)]
pub struct Cycle<'a> {
    pub body: &'a Body,
    pub profile: &'a dyn Axisymmetric,
    pub attraction: Attraction,
    /// What is prescribed at a fraction of the cycle; a load may be a pull.
    pub drive: &'a (dyn Fn(f64) -> Prescribed + Sync),
    /// What is prescribed on average, and at most.
    pub mean: Prescribed,
    pub maximum: Prescribed,
    pub period_s: f64,
}

/// When a search ends.
#[derive(Clone, Copy)]
pub struct Ending<'a> {
    /// Largest distance between two cycles: see `distance`.
    pub tolerance: f64,
    pub most_cycles: usize,
    /// Asked before every step.
    pub stop: &'a dyn Fn() -> bool,
}

/// Where a search begins, and whether it is one.
#[derive(Clone, Copy)]
pub enum Start<'a> {
    /// From where a body at rest under the mean is.
    Rest,
    /// From what springs remember.
    From(&'a State),
    /// Cycles as they come, from the first touch on, after this time (s) under this value.
    March { hold_s: f64, held: Prescribed },
}

/// A step in which the contact jumped, and the energy (J) that this lost.
pub type Jumped = (usize, f64);

/// The cycle of a search that is nearest to the stabilised one, or the last of a march.
#[derive(Debug, Clone)]
pub struct Found {
    /// The edges at the beginning and at the end of every step.
    pub edges: Vec<Edges>,
    /// Steps, counted from 1, in which the contact jumped, and the energy (J) that each jump lost.
    pub jumps: Vec<Jumped>,
    /// How far it is from the stabilised one.
    pub distance: f64,
    pub cycles: usize,
    /// From where the next begins.
    pub state: State,
}

/// What springs at some places remember.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    place_m: Vec<f64>,
    /// Displacements (m) less the gap, spring by spring, then those at the edges of contact and zone.
    displacements_m: Vec<f64>,
    edges: Edges,
}

/// Where the edges go in a cycle, for which springs are laid out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    /// Contact radius at its least and largest (m).
    pub contact_m: (f64, f64),
    /// The radius of the zone at its least and largest (m), and its width at its least.
    pub zone_m: (f64, f64),
    pub zone_width_m: f64,
}

/// Of the springs, those evenly where the edges go, those about each edge where it turns, and those beyond.
const EVENLY: f64 = 0.4;
const ABOUT: f64 = 0.2;
const BEYOND: f64 = 0.2;

impl Layout {
    /// Where the edges of a cycle were.
    pub fn of(edges: &[Edges]) -> Self {
        let all = |of: fn(&Edges) -> f64| edges.iter().map(of);
        let least = |of: fn(&Edges) -> f64| all(of).fold(f64::INFINITY, f64::min);
        let largest = |of: fn(&Edges) -> f64| all(of).fold(0.0, f64::max);
        let touching = edges.iter().filter(|e| e.contact_m > 0.0);
        let width_m = touching
            .map(|e| e.zone_m - e.contact_m)
            .fold(f64::INFINITY, f64::min);
        let zone_m = (least(|e| e.zone_m), largest(|e| e.zone_m));
        Self {
            contact_m: (least(|e| e.contact_m), largest(|e| e.contact_m)),
            zone_width_m: width_m.min(zone_m.1),
            zone_m,
        }
    }

    /// Distance (m) of so many springs where the edges go.
    pub fn spacing_m(&self, springs: usize) -> f64 {
        (self.contact_m.1 - self.contact_m.0) / (EVENLY * springs as f64)
    }

    /// Places for about this many springs: evenly where the edges go, more densely where they turn when they hardly move, and beyond,
    /// where a zone is wide that is not always so, in steps that grow.
    fn places_m(&self, springs: usize, room: f64) -> Vec<f64> {
        let (least_m, largest_m) = self.contact_m;
        let beside_m = 0.1 * (largest_m - least_m) + 0.5 * self.zone_width_m;
        let from_m = (least_m - beside_m).max(0.0);
        let to_m = largest_m + 1.5 * self.zone_width_m;
        let end_m = room * self.zone_m.1.max(to_m);
        let count = |part: f64| (springs as f64 * part) as usize;
        let (beyond, about) = (count(BEYOND), count(ABOUT));
        let evenly = springs - beyond - 2 * about;
        let row = |from_m: f64, to_m: f64, count: usize| {
            let width_m = (to_m - from_m) / count as f64;
            (0..=count).map(move |k| from_m + width_m * k as f64)
        };
        let mut places_m: Vec<f64> = [0.0].into_iter().chain(row(from_m, to_m, evenly)).collect();
        for (least_m, largest_m) in [self.contact_m, self.zone_m] {
            let beside_m = 0.3 * (largest_m - least_m);
            let from_m = (least_m - beside_m).max(0.0);
            places_m.extend(row(from_m, largest_m + beside_m, about));
        }
        // The ratio of a row of steps that begins with the width of those before and reaches the end.
        let width_m = (to_m - from_m) / evenly as f64;
        let left = (end_m - to_m) / width_m;
        let length = |ratio: f64| (0..beyond).map(|k| ratio.powi(k as i32)).sum::<f64>();
        let (ratio, _) = bisect(1e-3, 1e3, ALL_DIGITS, |ratio| length(ratio) < left);
        let scale = left / length(ratio);
        let mut place_m = to_m;
        for k in 0..beyond {
            place_m += width_m * scale * ratio.powi(k as i32);
            places_m.push(place_m);
        }
        places_m.sort_by(f64::total_cmp);
        places_m.dedup_by(|next, last| *next - *last <= 1e-12 * end_m);
        places_m
    }
}

impl<'a> Cycle<'a> {
    /// Where the edges go, as far as elastic contacts of the relaxed and of the instantaneous body tell.
    ///
    /// # Errors
    /// [`ContactError`] where there is no contact under the largest value of the drive.
    pub fn expected(&self) -> Result<Layout, ContactError> {
        let relaxed = self.body.relaxed();
        let edges = |value: Prescribed| -> Result<Edges, ContactError> {
            let mut row_m = self.attraction.range_m.max(1e-12);
            // A row twice as long, as long as the contact reaches its end.
            for _ in 0..80 {
                let places_m = (0..=64).map(|k| row_m * f64::from(k) / 64.0).collect();
                let mut springs = Springs::new(&relaxed, self.profile, self.attraction, places_m);
                match springs.rest(value) {
                    Err(ContactError::ReachedEdge { .. }) => row_m *= 2.0,
                    ended => return ended,
                }
            }
            Err(ContactError::ReachedEdge {
                half_width_m: row_m,
            })
        };
        let largest = edges(self.maximum)?;
        if let (Prescribed::ApproachM(approach_m), true) = (self.maximum, largest.zone_m == 0.0) {
            return Err(ContactError::NeverAttracted {
                approach_m,
                range_m: self.attraction.range_m,
            });
        }
        let samples = (0..16).map(|k| edges((self.drive)(f64::from(k) / 16.0)));
        let least_m = samples
            .map(|e| e.map_or(0.0, |e| e.contact_m))
            .fold(f64::INFINITY, f64::min);
        let width_m = largest.zone_m - largest.contact_m;
        // A stiffer body has a wider zone: in proportion to the modulus, as long as that is narrow beside the contact, where the
        // surfaces are not beyond their range on their own.
        let stiffer =
            1.0 / (self.body.instantaneous_compliance_per_pa * self.body.equilibrium_modulus_pa);
        let free_m = largest.zone_m + 0.5 * largest.contact_m;
        Ok(Layout {
            contact_m: (least_m, largest.contact_m),
            zone_width_m: width_m,
            zone_m: (
                least_m,
                (largest.contact_m + stiffer * width_m).min(2.0 * free_m),
            ),
        })
    }

    /// Where the edges go, after two coarse cycles from rest under the mean.
    ///
    /// # Errors
    /// As [`Cycle::expected`] and [`Cycle::stabilised`].
    pub fn layout(&self, stop: &dyn Fn() -> bool) -> Result<Layout, ContactError> {
        let ending = Ending {
            tolerance: 0.0,
            most_cycles: 2,
            stop,
        };
        let found = self.stabilised(&self.expected()?, (64, 200), Start::Rest, ending)?;
        Ok(Layout::of(&found.edges))
    }

    /// The stabilised cycle in this many steps, on this many springs for edges that go like this, searched or marched from a start.
    ///
    /// # Errors
    /// [`ContactError`] of the instant that could not be solved.
    pub fn stabilised(
        &self,
        layout: &Layout,
        (steps, springs): (usize, usize),
        start: Start<'_>,
        ending: Ending<'_>,
    ) -> Result<Found, ContactError> {
        let mut room = 1.05;
        loop {
            match self.on_row(layout.places_m(springs, room), steps, start, ending) {
                Err(ContactError::ReachedEdge { .. }) if room < 50.0 => room *= 1.3,
                ended => return ended,
            }
        }
    }

    fn on_row(
        &self,
        places_m: Vec<f64>,
        steps: usize,
        start: Start<'_>,
        ending: Ending<'_>,
    ) -> Result<Found, ContactError> {
        let step_s = self.period_s / steps as f64;
        let (jump, weights) = (
            StepWeights::new(self.body, 0.0),
            StepWeights::new(self.body, step_s),
        );
        let mut springs = Springs::new(self.body, self.profile, self.attraction, places_m);
        self.begin(&mut springs, (&jump, steps), start)?;
        let mut state = springs.state();
        let mut anderson = Anderson::default();
        let least_squares = springs.importance();
        let mut last: Option<Vec<Edges>> = None;
        let keeps_load = matches!(self.mean, Prescribed::LoadN(_));
        let mut cycles = 0;
        let mut best = None;
        let mut tried = state.clone();
        let is_march = matches!(start, Start::March { .. });
        loop {
            springs.recall(&state);
            let (edges, jumps, begun) =
                match self.once(&mut springs, (&jump, &weights), steps, ending.stop) {
                    // What a search tries may be no memory that loads leave: half as far from the last that had a cycle.
                    Err(ContactError::PulledOff { .. }) if !is_march && best.is_some() => {
                        cycles += 1;
                        if cycles >= ending.most_cycles
                            && let Some(best) = best
                        {
                            return Ok(Found { cycles, ..best });
                        }
                        anderson = Anderson::default();
                        state = state.between(&tried);
                        continue;
                    }
                    ended => ended?,
                };
            tried = begun.clone();
            cycles += 1;
            let end = springs.state();
            let distance = last.as_ref().map_or(f64::INFINITY, |last| {
                distance(last, &edges, self.body.branches() == 0)
            });
            let found = Found {
                edges: edges.clone(),
                jumps,
                distance,
                cycles,
                state: end.clone(),
            };
            if is_march
                || best
                    .as_ref()
                    .is_none_or(|best: &Found| distance <= best.distance)
            {
                best = Some(found);
            }
            if (distance <= ending.tolerance || cycles >= ending.most_cycles)
                && let Some(best) = best
            {
                return Ok(Found { cycles, ..best });
            }
            last = Some(edges);
            let of_springs = springs.places_m().len() * self.body.branches();
            let ends = end.displacements_m[..of_springs]
                .iter()
                .zip(&begun.displacements_m);
            let mut update: Vec<f64> = ends.map(|(end, begun)| end - begun).collect();
            if is_march {
                state = end;
                continue;
            }
            springs.correct(self.period_s, keeps_load, &mut update);
            let mut next = begun.displacements_m[..of_springs].to_vec();
            anderson.advance(&mut next, &update, &least_squares);
            state = end.moved_to(&next, self.body.branches());
        }
    }

    /// Goes to where a search or a march starts.
    fn begin(
        &self,
        springs: &mut Springs<'_>,
        (jump, steps): (&StepWeights, usize),
        start: Start<'_>,
    ) -> Result<(), ContactError> {
        match start {
            Start::From(state) => springs.recall(&state.at(springs)),
            Start::Rest => {
                if springs.rest(self.mean).is_err() {
                    springs.rest(self.maximum)?;
                }
            }
            Start::March { hold_s, held } => {
                springs.step(jump, held)?;
                self.hold(springs, (hold_s, held), steps)?;
            }
        }
        Ok(())
    }

    /// One cycle from where the springs are: its edges, its jumps, and the memory at its beginning.
    fn once(
        &self,
        springs: &mut Springs<'_>,
        (jump, weights): (&StepWeights, &StepWeights),
        steps: usize,
        stop: &dyn Fn() -> bool,
    ) -> Result<(Vec<Edges>, Vec<Jumped>, State), ContactError> {
        let mut edges = vec![springs.step(jump, (self.drive)(0.0))?];
        springs.begin_cycle();
        let begun = springs.state();
        let mut jumps = Vec::new();
        for step in 1..=steps {
            if stop() {
                return Err(ContactError::Interrupted);
            }
            edges.push(springs.step(weights, (self.drive)(step as f64 / steps as f64))?);
            jumps.extend(springs.jumped_j().map(|lost_j| (step, lost_j)));
        }
        Ok((edges, jumps, begun))
    }

    /// Holds a value in steps that grow, from a thousandth of the shortest time of the body on or of the time itself.
    fn hold(
        &self,
        springs: &mut Springs<'_>,
        (hold_s, held): (f64, Prescribed),
        steps: usize,
    ) -> Result<(), ContactError> {
        let Some(shortest_s) = self.body.relaxation_times_s.first() else {
            return Ok(());
        };
        if hold_s == 0.0 {
            return Ok(());
        }
        let first_s = 1e-3 * shortest_s.min(hold_s);
        let decades = (hold_s / first_s).log10();
        let count = (0.1 * steps as f64 * decades).ceil() as usize;
        let mut before_s = 0.0;
        for at_s in in_steps(first_s, hold_s, count) {
            springs.step(&StepWeights::new(self.body, at_s - before_s), held)?;
            before_s = at_s;
        }
        Ok(())
    }
}

/// By how much two cycles differ in load and approach, relative to the largest, and in their loss, or by how much the second is no closed
/// loop, relative to its area. Of an elastic body, which loses nothing, load and approach alone tell.
fn distance(before: &[Edges], now: &[Edges], is_elastic: bool) -> f64 {
    let values =
        |edges: &[Edges], of: fn(&Edges) -> f64| edges.iter().map(of).collect::<Vec<f64>>();
    let change = |of: fn(&Edges) -> f64| {
        let (before, now) = (values(before, of), values(now, of));
        let largest = now.iter().map(|n| n.abs()).fold(0.0, f64::max);
        let off = before.iter().zip(&now).map(|(b, n)| (b - n).abs());
        let off = off.fold(0.0, f64::max);
        if off > 0.0 { off / largest } else { 0.0 }
    };
    let signals = change(|e| e.load_n).max(change(|e| e.approach_m));
    if is_elastic {
        return signals;
    }
    let signals_of =
        |edges: &[Edges]| (values(edges, |e| e.load_n), values(edges, |e| e.approach_m));
    let [(last_n, last_m), (load_n, approach_m)] = [before, now].map(signals_of);
    let (last_j, loss_j) = (
        work_along(&last_n, &last_m),
        work_along(&load_n, &approach_m),
    );
    let closure = closure_error(&load_n, &approach_m).unwrap_or(0.0);
    signals.max(closure).max(((loss_j - last_j) / loss_j).abs())
}

impl State {
    /// The spring before a place, or the first or last but one, and the share of the next.
    fn beside(&self, x_m: f64) -> (usize, f64) {
        let next = self.place_m.partition_point(|place_m| *place_m <= x_m);
        let next = next.clamp(1, self.place_m.len() - 1);
        let (from_m, to_m) = (self.place_m[next - 1], self.place_m[next]);
        let share = (x_m - from_m) / (to_m - from_m);
        (next - 1, share.clamp(0.0, 1.0))
    }

    /// The same at the places of other springs.
    fn at(&self, springs: &Springs<'_>) -> Self {
        let branches = springs.body.branches();
        let place_m = springs.places_m().to_vec();
        let own = self.place_m.len() * branches;
        let mut displacements_m = Vec::with_capacity((place_m.len() + 2) * branches);
        for x_m in &place_m {
            let (spring, share) = self.beside(*x_m);
            for at in spring * branches..(spring + 1) * branches {
                let (left, right) = (
                    self.displacements_m[at],
                    self.displacements_m[at + branches],
                );
                displacements_m.push(left + share * (right - left));
            }
        }
        displacements_m.extend_from_slice(&self.displacements_m[own..]);
        Self {
            place_m,
            displacements_m,
            edges: self.edges,
        }
    }

    /// Half way to another of the same springs.
    fn between(&self, other: &Self) -> Self {
        let both = self.displacements_m.iter().zip(&other.displacements_m);
        Self {
            displacements_m: both.map(|(own, other)| 0.5 * (own + other)).collect(),
            ..other.clone()
        }
    }

    /// The same with these displacements of the springs: those at the edges move with their neighbours.
    fn moved_to(&self, displacements_m: &[f64], branches: usize) -> Self {
        let mut moved = self.clone();
        let own = displacements_m.len();
        let by = |at: usize| displacements_m[at] - self.displacements_m[at];
        let edges_m = [self.edges.contact_m, self.edges.zone_m];
        for (edge, x_m) in edges_m.into_iter().enumerate() {
            let (spring, share) = self.beside(x_m);
            for branch in 0..branches {
                let at = spring * branches + branch;
                let moved_m = by(at) + share * (by(at + branches) - by(at));
                moved.displacements_m[own + edge * branches + branch] += moved_m;
            }
        }
        moved.displacements_m[..own].copy_from_slice(displacements_m);
        moved
    }

    /// Of springs at these places.
    pub(super) fn new(place_m: Vec<f64>, displacements_m: Vec<f64>, edges: Edges) -> Self {
        Self {
            place_m,
            displacements_m,
            edges,
        }
    }

    /// Displacements (m) less the gap, spring by spring, then those at the edges, and these.
    pub(super) fn parts(&self) -> (&[f64], Edges) {
        (&self.displacements_m, self.edges)
    }
}
