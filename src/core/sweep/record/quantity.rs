//! The numbers of a case that have error bars: one row for each, with its column and unit, how it is read from a result, and what is
//! believed of its error.

use serde::{Deserialize, Serialize};

use crate::cycle::Extrema;
use crate::quantity::Dimension::{self, Angle, Energy, Force, Length, Stress};
use crate::sweep::record::CaseResult;

/// Everything that tables, comparisons and error bars know of a quantity.
#[derive(Debug)]
pub(crate) struct QuantityRow {
    /// Its column in `sweep.csv`, with the SI unit as the last part.
    pub(crate) column: &'static str,
    /// `None` of a ratio.
    pub(crate) dimension: Option<Dimension>,
    /// Its value in a result, where it has one.
    pub(crate) value: fn(&CaseResult) -> Option<f64>,
    pub(crate) in_nodes: Convergence,
    pub(crate) in_steps: InSteps,
    pub(crate) relative_to: RelativeTo,
    pub(crate) edge: EdgeRule,
}

/// How a quantity converges as springs or cells become smaller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Convergence {
    /// Smoothly: the whole contact makes it.
    Smooth,
    /// What is read off at the edge of the contact, or at its middle, jumps about with the place of the edge between two nodes, and
    /// seems to converge faster than it does; a pressure at an apex may converge very slowly.
    Local,
}

/// How a quantity converges as time steps become shorter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum InSteps {
    /// With the order of the time rule: the whole cycle makes it.
    OfCycle,
    /// To the second order at most, as extremes that are read between samples.
    Extreme,
}

/// What a distance to the stabilised cycle is relative to.
#[derive(Debug, Clone, Copy)]
pub(crate) enum RelativeTo {
    Itself,
    /// It is relative already.
    One,
    /// The largest of its kind in the cycle.
    Largest(fn(&CaseResult) -> f64),
}

/// What the place of the edge of the contact between two cells leaves in a quantity.
#[derive(Debug, Clone, Copy)]
pub(crate) enum EdgeRule {
    /// What it leaves in the stiffness, averaged over the places that a moving edge takes in a cycle.
    Loss,
    /// The same, of a number that is relative; nothing at a rim.
    Harmonic,
    /// What it leaves in the radius (m); nothing at a rim, to which the cells are fitted.
    Radius(fn(&Extrema) -> f64),
    /// What it leaves in the stiffness at a rim, and nothing elsewhere.
    AtRim,
    Nothing,
}

macro_rules! quantities {
    ($($quantity:ident { $($row:tt)* })*) => {
        /// The numbers of a case that have error bars.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Quantity {
            $($quantity,)*
        }

        impl Quantity {
            /// All of them, in the order of the table.
            pub const ALL: [Self; ROWS.len()] = [$(Self::$quantity),*];
        }

        static ROWS: [QuantityRow; [$(stringify!($quantity)),*].len()] = [$(QuantityRow { $($row)* }),*];
    };
}

use Convergence::{Local, Smooth};
use EdgeRule::{AtRim, Harmonic, Loss, Nothing, Radius};
use InSteps::{Extreme, OfCycle};
use RelativeTo::{Itself, Largest, One};

#[rustfmt::skip]
quantities! {
    EnergyLoss {
        column: "energy_loss_j", dimension: Some(Energy), value: |r| Some(r.analysis.energy_loss_j),
        in_nodes: Smooth, in_steps: OfCycle, relative_to: Itself, edge: Loss,
    }
    PhaseLag {
        column: "phase_lag_rad", dimension: Some(Angle), value: |r| Some(r.analysis.phase_lag_rad),
        in_nodes: Smooth, in_steps: OfCycle, relative_to: Itself, edge: Nothing,
    }
    StorageModulus {
        column: "storage_modulus_pa", dimension: Some(Stress), value: |r| r.storage_modulus_pa,
        in_nodes: Local, in_steps: Extreme, relative_to: Itself, edge: AtRim,
    }
    LossModulus {
        column: "loss_modulus_pa", dimension: Some(Stress), value: |r| r.loss_modulus_pa,
        in_nodes: Local, in_steps: OfCycle, relative_to: Itself, edge: AtRim,
    }
    ApproachMin {
        column: "approach_min_m", dimension: Some(Length), value: |r| Some(r.approach_m.minimum),
        in_nodes: Smooth, in_steps: Extreme, relative_to: LARGEST_APPROACH, edge: AtRim,
    }
    ApproachMax {
        column: "approach_max_m", dimension: Some(Length), value: |r| Some(r.approach_m.maximum),
        in_nodes: Smooth, in_steps: Extreme, relative_to: LARGEST_APPROACH, edge: AtRim,
    }
    ContactRadiusMin {
        column: "contact_radius_min_m", dimension: Some(Length), value: |r| Some(r.contact_radius_m.minimum),
        in_nodes: Local, in_steps: Extreme, relative_to: LARGEST_RADIUS, edge: Radius(|radius| radius.minimum),
    }
    ContactRadiusMax {
        column: "contact_radius_max_m", dimension: Some(Length), value: |r| Some(r.contact_radius_m.maximum),
        in_nodes: Local, in_steps: Extreme, relative_to: LARGEST_RADIUS, edge: Radius(|radius| radius.maximum),
    }
    PeakPressureMin {
        column: "peak_pressure_min_pa", dimension: Some(Stress), value: |r| r.peak_pressure_pa.map(|p| p.minimum),
        in_nodes: Local, in_steps: Extreme, relative_to: LARGEST_PRESSURE, edge: Nothing,
    }
    PeakPressureMax {
        column: "peak_pressure_max_pa", dimension: Some(Stress), value: |r| r.peak_pressure_pa.map(|p| p.maximum),
        in_nodes: Local, in_steps: Extreme, relative_to: LARGEST_PRESSURE, edge: Nothing,
    }
    Harmonic2 {
        column: "harmonic_2", dimension: None, value: |r| r.analysis.approach_harmonic(2),
        in_nodes: Smooth, in_steps: Extreme, relative_to: One, edge: Harmonic,
    }
    Harmonic3 {
        column: "harmonic_3", dimension: None, value: |r| r.analysis.approach_harmonic(3),
        in_nodes: Smooth, in_steps: Extreme, relative_to: One, edge: Harmonic,
    }
    BulkLoss {
        column: "bulk_loss_j", dimension: Some(Energy), value: |r| Some(r.attracted()?.bulk_loss_j),
        in_nodes: Local, in_steps: OfCycle, relative_to: LOSS, edge: Nothing,
    }
    EdgeLoss {
        column: "edge_loss_j", dimension: Some(Energy), value: |r| r.edge_loss_j(),
        in_nodes: Local, in_steps: OfCycle, relative_to: LOSS, edge: Nothing,
    }
    JumpLoss {
        column: "jump_loss_j", dimension: Some(Energy), value: |r| Some(r.attracted()?.jump_loss_j()),
        in_nodes: Local, in_steps: OfCycle, relative_to: LOSS, edge: Nothing,
    }
    ZoneRadiusMin {
        column: "zone_radius_min_m", dimension: Some(Length), value: |r| Some(r.attracted()?.zone_radius_m.minimum),
        in_nodes: Local, in_steps: Extreme, relative_to: LARGEST_RADIUS, edge: Nothing,
    }
    ZoneRadiusMax {
        column: "zone_radius_max_m", dimension: Some(Length), value: |r| Some(r.attracted()?.zone_radius_m.maximum),
        in_nodes: Local, in_steps: Extreme, relative_to: LARGEST_RADIUS, edge: Nothing,
    }
    LargestPull {
        column: "pull_max_n", dimension: Some(Force), value: |r| Some(r.attracted()?.pull_n),
        in_nodes: Local, in_steps: Extreme, relative_to: Itself, edge: Nothing,
    }
    SnapInApproach {
        column: "snap_in_approach_m", dimension: Some(Length), value: |r| Some(r.attracted()?.snap_in()?.approach_m),
        in_nodes: Local, in_steps: OfCycle, relative_to: LARGEST_APPROACH, edge: Nothing,
    }
    SnapInLoad {
        column: "snap_in_load_n", dimension: Some(Force), value: |r| Some(r.attracted()?.snap_in()?.load_n),
        in_nodes: Local, in_steps: OfCycle, relative_to: Itself, edge: Nothing,
    }
    SnapOffApproach {
        column: "snap_off_approach_m", dimension: Some(Length), value: |r| Some(r.attracted()?.snap_off()?.approach_m),
        in_nodes: Local, in_steps: OfCycle, relative_to: LARGEST_APPROACH, edge: Nothing,
    }
    SnapOffLoad {
        column: "snap_off_load_n", dimension: Some(Force), value: |r| Some(r.attracted()?.snap_off()?.load_n),
        in_nodes: Local, in_steps: OfCycle, relative_to: Itself, edge: Nothing,
    }
}

/// What is missing of a memory adds to the whole approach, not to its range alone.
const LARGEST_APPROACH: RelativeTo = Largest(|r| r.approach_m.maximum.abs());
const LARGEST_RADIUS: RelativeTo = Largest(|r| r.contact_radius_m.maximum);
/// What is missing of a cycle is missing of the whole loss.
const LOSS: RelativeTo = Largest(|r| r.analysis.energy_loss_j.abs());
const LARGEST_PRESSURE: RelativeTo =
    Largest(|r| r.peak_pressure_pa.map_or(0.0, |pressure| pressure.maximum));

impl Quantity {
    pub(crate) const fn row(self) -> &'static QuantityRow {
        &ROWS[self as usize]
    }

    /// Its column in `sweep.csv`, with the SI unit as the last part.
    pub const fn column(self) -> &'static str {
        self.row().column
    }

    /// `None` of a ratio.
    pub const fn dimension(self) -> Option<Dimension> {
        self.row().dimension
    }

    /// Its value in a result, where it has one.
    pub fn of(self, result: &CaseResult) -> Option<f64> {
        (self.row().value)(result)
    }

    /// What a distance to the stabilised cycle is relative to.
    pub(super) fn scale(self, result: &CaseResult) -> Option<f64> {
        let value = self.of(result)?;
        Some(match self.row().relative_to {
            Itself => value.abs(),
            One => 1.0,
            Largest(of) => of(result),
        })
    }
}
