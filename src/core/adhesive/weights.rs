//! What a time step does to the memory of a spring, displaced straight or loaded along the path of an edge.

use super::body::Body;
use crate::history::linear_weight;
use crate::numerics::roots::bisect;

/// Parts of a step over which the force of an attracted spring is averaged exactly. Towards the end of the step, of which a body
/// with shorter times remembers most, they are shorter: each by a ratio, the larger the longer the step is beside these times.
/// A step that is short beside all of them needs few.
const PARTS: [(f64, i32); 3] = [(0.3, 3), (3.0, 6), (f64::INFINITY, 12)];
const RATIOS: (f64, f64) = (1.2, 2.0);

/// A branch driven straight from one value to another: m <- decay m + old from + new to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Straight {
    pub decay: f64,
    pub old: f64,
    pub new: f64,
}

impl Straight {
    /// Over a time of which a branch has so many of its own.
    pub fn over(times: f64) -> Self {
        let new = linear_weight(times);
        Self {
            decay: (-times).exp(),
            old: -(-times).exp_m1() - new,
            new,
        }
    }

    pub fn drive(self, memory: &mut f64, (from, to): (f64, f64)) {
        *memory = self.decay * *memory + self.old * from + self.new * to;
    }
}

/// Of one length of step, to be used for as many as there are.
#[derive(Debug, Clone)]
pub struct StepWeights {
    pub(super) step_s: f64,
    /// Of every branch of relaxation of a spring in contact.
    pub(super) displaced: Vec<Straight>,
    /// Force per displacement at the end of the step (Pa).
    pub(super) modulus_pa: f64,
    /// Of every branch of creep: what is left of it, and what the mean force over each part adds.
    pub(super) left: Vec<f64>,
    pub(super) added: Vec<Vec<f64>>,
    /// What the mean force over each part adds to the displacement (1/Pa).
    pub(super) compliance_per_pa: Vec<f64>,
    /// Of every branch of creep under a force that goes straight, and what such a force at the beginning and at the end of the step adds
    /// to the displacement (1/Pa).
    pub(super) loaded: Vec<Straight>,
    pub(super) straight_per_pa: (f64, f64),
    /// Where the parts end, as fractions of the step.
    pub(super) ends: Vec<f64>,
}

impl StepWeights {
    /// Length of the step (s).
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// A step of `step_s` seconds; zero is a jump.
    pub fn new(body: &Body, step_s: f64) -> Self {
        let shortest_s = body.retardation_times_s.first().copied().unwrap_or(0.0);
        let enough = |(times, _): &&(f64, i32)| step_s <= times * shortest_s;
        let parts = PARTS.iter().find(enough).map_or(1, |(_, parts)| *parts);
        let last = |ratio: f64| step_s * (ratio - 1.0) / (ratio.powi(parts) - 1.0);
        let (least, largest) = RATIOS;
        let (ratio, _) = bisect(least, largest, 30, |ratio| last(ratio) > shortest_s);
        let left = |part: i32| ratio.powi(parts - part) - 1.0;
        let ends: Vec<f64> = (0..=parts).map(|part| 1.0 - left(part) / left(0)).collect();
        let times = body.relaxation_times_s.iter();
        let displaced: Vec<_> = times
            .map(|time_s| Straight::over(step_s / time_s))
            .collect();
        let stiff = body.moduli_pa.iter().zip(&displaced);
        let stiff = stiff.map(|(modulus, weights)| modulus * (1.0 - weights.new));
        let times = || {
            body.retardation_times_s
                .iter()
                .map(|time_s| step_s / time_s)
        };
        let added = ends.windows(2).map(|ends| {
            let (after, length) = (1.0 - ends[1], ends[1] - ends[0]);
            let adds = |times: f64| (-after * times).exp() * -(-length * times).exp_m1();
            times().map(adds).collect::<Vec<f64>>()
        });
        let added: Vec<Vec<f64>> = added.collect();
        let loaded: Vec<Straight> = times().map(Straight::over).collect();
        let adds = |of: fn(&Straight) -> f64| -> f64 {
            let branches = body.compliances_per_pa.iter().zip(&loaded);
            branches.map(|(per_pa, weights)| per_pa * of(weights)).sum()
        };
        Self {
            straight_per_pa: (adds(|w| w.old), adds(|w| w.new)),
            step_s,
            modulus_pa: body.equilibrium_modulus_pa + stiff.sum::<f64>(),
            displaced,
            left: times().map(|times| (-times).exp()).collect(),
            compliance_per_pa: added.iter().map(|added| body.retarded_m(added)).collect(),
            added,
            loaded,
            ends,
        }
    }
}
