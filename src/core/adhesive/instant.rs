//! The edges of an instant: those that a load or an approach asks for, on the branch where the contact is.
//!
//! For a radius of the contact that of the zone is the root of its gap, and load and approach follow. Where no contact is, a
//! disc may be attracted, whose radius takes the place. Along this curve the instant is the first place, from where the contact was
//! in the direction in which it moves, that has what is prescribed: where the curve turns back before, the contact jumps.

use std::f64::consts::PI;

use super::springs::{Edges, Springs};
use super::weights::StepWeights;
use crate::contact::{ContactError, Prescribed};

/// What the last instants say of the next.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Start {
    /// How far the edge of the contact moved (m), in the last step.
    moved_m: f64,
    /// Width of the zone (m), and by how much the excess of its gap grows with it.
    width_m: f64,
    widening: f64,
    /// By how much what is prescribed grows with the radius of the contact.
    growing: f64,
    /// The energy (J) that the last step lost in jumps.
    pub released_j: f64,
}

/// Relative to the range, or to what is prescribed.
const TOLERANCE: f64 = 1e-10;
const MOST: usize = 200;

/// What a jump loses at least, of the work of adhesion of the whole disc: less is rounding of the curve.
const SMALLEST_JUMP: f64 = 1e-6;

/// Two places on either side of a root, by the rule of false position (Illinois: M. Dowell and P. Jarratt, BIT 11 (1971) 168).
struct Bracket {
    old: (f64, f64),
    new: (f64, f64),
}

impl Bracket {
    fn next(&self) -> f64 {
        let ((p, at_p), (q, at_q)) = (self.old, self.new);
        let next = q - at_q * (q - p) / (at_q - at_p);
        match next > p.min(q) && next < p.max(q) {
            true => next,
            false => 0.5 * (p + q),
        }
    }

    fn replace(&mut self, place: f64, value: f64) {
        if (value > 0.0) == (self.new.1 > 0.0) {
            self.old.1 *= 0.5;
        } else {
            self.old = self.new;
        }
        self.new = (place, value);
    }

    fn is_closed(&self, scale: f64) -> bool {
        (self.old.0 - self.new.0).abs() <= 1e-15 * scale
    }
}

fn not_converged(residual: f64) -> ContactError {
    ContactError::NotConverged {
        iterations: MOST,
        residual,
        tolerance: TOLERANCE,
    }
}

impl Springs<'_> {
    /// Moves on by one step to the instant at which this is prescribed; a load may be a pull.
    ///
    /// # Errors
    /// [`ContactError::ReachedEdge`] where the row is too short, [`ContactError::PulledOff`] where no contact bears the load, and
    /// [`ContactError::NotConverged`]. The springs are then where they were before.
    pub fn step(
        &mut self,
        weights: &StepWeights,
        prescribed: Prescribed,
    ) -> Result<Edges, ContactError> {
        self.begin(weights);
        let to = self.find(weights, prescribed)?;
        let zone_m = to.zone_m.max(self.now.zone_m);
        let whole_j = PI * self.attraction.stress_pa * self.attraction.range_m * zone_m * zone_m;
        if self.search.released_j < SMALLEST_JUMP * whole_j {
            self.search.released_j = 0.0;
        }
        self.search.moved_m = to.contact_m - self.now.contact_m;
        self.search.width_m = to.zone_m - to.contact_m;
        self.end(weights, to);
        Ok(to)
    }

    /// The energy (J) that the last step lost in a jump, where the contact jumped in it, in or out.
    pub fn jumped_j(&self) -> Option<f64> {
        (self.search.released_j > 0.0).then_some(self.search.released_j)
    }

    fn find(
        &mut self,
        weights: &StepWeights,
        prescribed: Prescribed,
    ) -> Result<Edges, ContactError> {
        let mut curve = Curve {
            scale_m: self.end_m(),
            touching: None,
            tolerance: match prescribed {
                Prescribed::LoadN(load_n) => {
                    let pull_n = self.attraction.stress_pa * self.now.zone_m * self.now.zone_m;
                    TOLERANCE * load_n.abs().max(pull_n)
                }
                Prescribed::ApproachM(approach_m) => {
                    TOLERANCE * approach_m.abs().max(self.attraction.range_m)
                }
            },
            weights,
            prescribed,
        };
        self.search.released_j = 0.0;
        match curve.beside_last(self)? {
            Some(found) => Ok(found),
            None => curve.scan(self),
        }
    }

    /// The instant of this radius of the contact, with the approach given or the one that goes with it.
    fn with_zone(
        &mut self,
        weights: &StepWeights,
        contact_m: f64,
        approach_m: Option<f64>,
    ) -> Result<Edges, ContactError> {
        let (end_m, range_m) = (self.end_m(), self.attraction.range_m);
        let reached = ContactError::ReachedEdge {
            half_width_m: end_m,
        };
        let width_m = self.search.width_m.max(1e-9 * end_m);
        let mut zone_m = (contact_m + width_m).min(end_m);
        let (mut low, mut high) = ((contact_m, -range_m), None::<(f64, f64)>);
        let mut last: Option<(f64, f64)> = None;
        let (mut halved, mut before_m) = (false, f64::INFINITY);
        for _ in 0..MOST {
            let (excess_m, approach_m) = self.excess_m(weights, (contact_m, zone_m), approach_m);
            if excess_m.abs() <= TOLERANCE * range_m
                || high.is_some_and(|h| h.0 - low.0 <= 1e-15 * end_m)
            {
                self.search.width_m = zone_m - contact_m;
                let mut edges = Edges {
                    contact_m,
                    zone_m,
                    approach_m,
                    load_n: 0.0,
                };
                edges.load_n = self.load_n(weights, &edges);
                return Ok(edges);
            }
            let mut longest_m = f64::INFINITY;
            if let Some((at_m, last_m)) = last {
                // Where the edge was, the gap has a root in it: its slope there is none a little farther on.
                longest_m = 8.0 * (zone_m - at_m).abs();
                let widening = (excess_m - last_m) / (zone_m - at_m);
                if widening > 0.0 {
                    self.search.widening = widening;
                }
            }
            last = Some((zone_m, excess_m));
            match excess_m > 0.0 {
                true => high = Some((zone_m, excess_m)),
                false if zone_m >= end_m => return Err(reached),
                false => low = (zone_m, excess_m),
            }
            let next_m = zone_m - (excess_m / self.search.widening).clamp(-longest_m, longest_m);
            let is_within = next_m > low.0 && next_m < high.map_or(end_m, |high| high.0);
            // After a step that hardly helped, halving.
            let helps = halved || excess_m.abs() < 0.5 * before_m;
            (halved, before_m) = (!helps, excess_m.abs());
            zone_m = match (is_within && helps, high) {
                (true, _) => next_m,
                (_, Some(high)) => 0.5 * (low.0 + high.0),
                (_, None) => (low.0 + 2.0 * (low.0 - contact_m).max(width_m)).min(end_m),
            };
        }
        Err(not_converged(last.map_or(f64::NAN, |l| l.1 / range_m)))
    }
}

/// The curve of the instants that a step may end in: from a radius of the contact on, and below zero, from the disc that is attracted
/// when the surfaces touch to none.
struct Curve<'w> {
    weights: &'w StepWeights,
    prescribed: Prescribed,
    tolerance: f64,
    scale_m: f64,
    touching: Option<Edges>,
}

impl Curve<'_> {
    /// By how much an instant has more than is prescribed.
    fn surplus(&self, edges: &Edges) -> f64 {
        match self.prescribed {
            Prescribed::LoadN(load_n) => edges.load_n - load_n,
            Prescribed::ApproachM(approach_m) => edges.approach_m - approach_m,
        }
    }

    /// The energy (J) that a jump past two places of the curve loses between them, which lie so much beside it: what is prescribed does
    /// more work than the contact takes up along the curve.
    fn lost_j(&self, (from, before): (&Edges, f64), (to, after): (&Edges, f64)) -> f64 {
        let surplus = 0.5 * (before + after);
        match self.prescribed {
            Prescribed::LoadN(_) => -surplus * (to.approach_m - from.approach_m),
            Prescribed::ApproachM(_) => surplus * (to.load_n - from.load_n),
        }
    }

    fn at(
        &mut self,
        springs: &mut Springs<'_>,
        place_m: f64,
    ) -> Result<(Edges, f64), ContactError> {
        let edges = if place_m > 0.0 {
            springs.with_zone(self.weights, place_m, None)?
        } else {
            let touching = match self.touching {
                Some(touching) => touching,
                None => springs.with_zone(self.weights, 0.0, None)?,
            };
            self.touching = Some(touching);
            match place_m == 0.0 {
                true => touching,
                false => {
                    let zone_m = (touching.zone_m * (1.0 + place_m / self.scale_m))
                        .max(1e-12 * self.scale_m);
                    let (excess_m, _) = springs.excess_m(self.weights, (0.0, zone_m), Some(0.0));
                    Edges {
                        contact_m: 0.0,
                        zone_m,
                        approach_m: excess_m,
                        load_n: -PI * springs.attraction.stress_pa * zone_m * zone_m,
                    }
                }
            }
        };
        Ok((edges, self.surplus(&edges)))
    }

    /// The instant near where the last step says that it is; `None` where it is not there.
    fn beside_last(&mut self, springs: &mut Springs<'_>) -> Result<Option<Edges>, ContactError> {
        const TRIES: usize = 8;
        let (from_m, moved_m) = (springs.now.contact_m, springs.search.moved_m);
        let growing = springs.search.growing;
        if from_m <= 0.0 || moved_m == 0.0 || growing <= 0.0 {
            return Ok(None);
        }
        let is_near = |place_m: f64| {
            let part = (place_m - from_m) / moved_m;
            part > 0.0 && part < 4.0 && place_m > 0.0
        };
        let mut place_m = from_m + moved_m;
        let mut last: Option<(f64, f64)> = None;
        for _ in 0..TRIES {
            if !is_near(place_m) {
                return Ok(None);
            }
            let (edges, surplus) = match self.at(springs, place_m) {
                Ok(found) => found,
                Err(ContactError::ReachedEdge { .. }) => return Ok(None),
                Err(error) => return Err(error),
            };
            if let Some((at_m, before)) = last {
                let slope = (surplus - before) / (place_m - at_m);
                if slope.is_nan() || slope <= 0.0 {
                    return Ok(None);
                }
                springs.search.growing = slope;
            }
            if surplus.abs() <= self.tolerance {
                return Ok(Some(edges));
            }
            last = Some((place_m, surplus));
            place_m -= surplus / springs.search.growing;
        }
        Ok(None)
    }

    /// The first instant from where the contact was, in the direction in which it moves.
    fn scan(&mut self, springs: &mut Springs<'_>) -> Result<Edges, ContactError> {
        let scale_m = self.scale_m;
        let now = springs.now;
        let mut from_m = now.contact_m;
        if from_m <= 0.0 {
            let (touching, _) = self.at(springs, 0.0)?;
            from_m = (scale_m * (now.zone_m / touching.zone_m - 1.0)).min(0.0);
        }
        let (edges, mut surplus) = self.at(springs, from_m)?;
        if surplus.abs() <= self.tolerance {
            return Ok(edges);
        }
        if surplus > 0.0 && from_m > 0.0 {
            // The edge that recedes, of which a spring is still in contact.
            let inner_m = from_m * (1.0 - 1e-13);
            let (receding, lower) = self.at(springs, inner_m)?;
            if lower.abs() <= self.tolerance {
                return Ok(receding);
            }
            if lower < 0.0 {
                let old = (receding.approach_m, lower);
                return self.pinned(
                    springs,
                    from_m,
                    Bracket {
                        old,
                        new: (edges.approach_m, surplus),
                    },
                );
            }
            surplus = lower;
        }
        self.go_on(springs, (from_m, (edges, surplus)))
    }

    /// The first instant from a place on the curve, whose surplus tells the direction.
    fn go_on(
        &mut self,
        springs: &mut Springs<'_>,
        (mut from_m, (mut from, mut surplus)): (f64, (Edges, f64)),
    ) -> Result<Edges, ContactError> {
        let scale_m = self.scale_m;
        let grows = surplus < 0.0;
        // Short enough that the curve does not turn twice on the way.
        let longest_m = 0.02 * scale_m;
        let moved_m = springs.search.moved_m.abs();
        let mut stride_m = (0.25 * moved_m).clamp(1e-7 * scale_m, longest_m);
        let direction = if grows { 1.0 } else { -1.0 };
        let mut turning = surplus;
        loop {
            let mut next_m = (from_m + direction * stride_m).clamp(-scale_m, scale_m);
            if (from_m < 0.0 && next_m > 0.0) || (from_m > 0.0 && next_m < 0.0) {
                next_m = 0.0;
            }
            let (edges, next) = self.at(springs, next_m)?;
            // What is prescribed goes on from where the curve turns, and the contact with it from where the curve comes back to that.
            let short = |surplus: f64| match grows {
                true => (surplus - turning).min(0.0),
                false => (surplus - turning).max(0.0),
            };
            let lost_j = self.lost_j((&from, short(surplus)), (&edges, short(next)));
            springs.search.released_j += lost_j;
            turning = if grows {
                turning.max(next)
            } else {
                turning.min(next)
            };
            if next.abs() <= self.tolerance {
                return Ok(edges);
            }
            if (next > 0.0) == grows {
                let bracket = Bracket {
                    old: (from_m, surplus),
                    new: (next_m, next),
                };
                return self.close(springs, bracket);
            }
            if grows && next_m >= scale_m {
                return Err(ContactError::ReachedEdge {
                    half_width_m: scale_m,
                });
            }
            if !grows && next_m <= -scale_m {
                return match self.prescribed {
                    Prescribed::LoadN(load_n) => Err(ContactError::PulledOff { load_n }),
                    Prescribed::ApproachM(approach_m) => Ok(Edges {
                        approach_m,
                        ..Edges::default()
                    }),
                };
            }
            (from_m, from, surplus) = (next_m, edges, next);
            stride_m = (1.6 * stride_m).min(longest_m);
        }
    }

    fn close(
        &mut self,
        springs: &mut Springs<'_>,
        mut bracket: Bracket,
    ) -> Result<Edges, ContactError> {
        let slope = |b: &Bracket| (b.new.1 - b.old.1) / (b.new.0 - b.old.0);
        for _ in 0..MOST {
            let place_m = bracket.next();
            let (edges, surplus) = self.at(springs, place_m)?;
            if surplus.abs() <= self.tolerance || bracket.is_closed(self.scale_m) {
                return Ok(edges);
            }
            springs.search.growing = slope(&bracket);
            bracket.replace(place_m, surplus);
        }
        Err(not_converged(bracket.new.1))
    }

    /// The edge stays where it is: what is prescribed lies between what it has when it is about to advance and about to recede.
    fn pinned(
        &mut self,
        springs: &mut Springs<'_>,
        contact_m: f64,
        mut bracket: Bracket,
    ) -> Result<Edges, ContactError> {
        for _ in 0..MOST {
            let approach_m = bracket.next();
            let edges = springs.with_zone(self.weights, contact_m, Some(approach_m))?;
            let surplus = self.surplus(&edges);
            if surplus.abs() <= self.tolerance || bracket.is_closed(approach_m.abs()) {
                return Ok(edges);
            }
            bracket.replace(approach_m, surplus);
        }
        Err(not_converged(bracket.new.1))
    }
}
