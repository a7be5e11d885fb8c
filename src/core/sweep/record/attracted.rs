//! What a cycle says besides whose surfaces attract one another.

use serde::{Deserialize, Serialize};

use crate::cycle::Extrema;
use crate::sweep::record::error_bars::{ErrorBars, Quantity};

/// How an indenter is attracted. Records are written by position: the first two are those of an optional number, as versions wrote it
/// that knew no other attraction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Attracted {
    Nothing,
    /// By a constant pull on a sphere.
    Constant {
        tabor_parameter: f64,
    },
    /// Within a range, which moves the edge of the contact.
    Edge(Box<AttractedCycle>),
}

/// The numbers of a cycle with an attraction that moves the edge of the contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AttractedCycle {
    /// Tabor's parameter; `None` of an indenter that is no sphere.
    pub tabor_parameter: Option<f64>,
    /// Radius of the disc within which the surfaces attract one another.
    pub zone_radius_m: Extrema,
    /// The largest pull of the cycle (N).
    pub pull_n: f64,
    /// What dissipates under the part of the surface that is in contact all the time (J); the edge and the jumps make the rest.
    pub bulk_loss_j: f64,
    /// Where contact or attraction came about or ended at once.
    pub jumps: Vec<Jump>,
}

/// A jump of the contact, from a stable state to another.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Jump {
    pub before: Instant,
    pub after: Instant,
    /// The energy (J) that neither body nor drive has afterwards.
    pub loss_j: f64,
}

/// An instant at an end of a jump.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Instant {
    pub load_n: f64,
    pub approach_m: f64,
    /// Radius of the disc within which the surfaces attract one another; 0 where they do not.
    pub zone_radius_m: f64,
}

impl Jump {
    /// By how much the radius of the attracted disc grows (m).
    fn growth_m(&self) -> f64 {
        self.after.zone_radius_m - self.before.zone_radius_m
    }
}

impl AttractedCycle {
    /// What all jumps lose (J).
    pub fn jump_loss_j(&self) -> f64 {
        self.jumps.iter().fold(0.0, |sum, jump| sum + jump.loss_j)
    }

    /// The instant before the jump by which the contact grows most.
    pub fn snap_in(&self) -> Option<Instant> {
        self.largest(Jump::growth_m)
    }

    /// The instant before the jump by which it shrinks most.
    pub fn snap_off(&self) -> Option<Instant> {
        self.largest(|jump| -jump.growth_m())
    }

    /// Error bars with what a jump leaves that lies somewhere within its time step: half of what both signals do in it makes the loop,
    /// and it begins up to a step later than where it is told.
    pub(crate) fn widened(&self, bars: ErrorBars) -> ErrorBars {
        let step_m = |jump: &Jump| (jump.after.approach_m - jump.before.approach_m).abs();
        let step_n = |jump: &Jump| (jump.after.load_n - jump.before.load_n).abs();
        let corners_j: f64 = self
            .jumps
            .iter()
            .map(|jump| 0.5 * step_m(jump) * step_n(jump))
            .sum();
        let latest = |step: fn(&Jump) -> f64| self.jumps.iter().map(step).fold(0.0, f64::max);
        let (step_m, step_n) = (latest(step_m), latest(step_n));
        bars.wider(Quantity::EnergyLoss, corners_j)
            .wider(Quantity::EdgeLoss, corners_j)
            .wider(Quantity::SnapInApproach, step_m)
            .wider(Quantity::SnapOffApproach, step_m)
            .wider(Quantity::SnapInLoad, step_n)
            .wider(Quantity::SnapOffLoad, step_n)
    }

    fn largest(&self, size: impl Fn(&Jump) -> f64) -> Option<Instant> {
        let jumps = self.jumps.iter().filter(|jump| size(jump) > 0.0);
        let largest = jumps.max_by(|a, b| size(a).total_cmp(&size(b)))?;
        Some(largest.before)
    }
}
