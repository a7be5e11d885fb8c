//! Keys of `[drive]` and `[sweep]`: an oscillation and its axes, or a history of segments.

use super::material::MATERIAL;
use super::settings::LAYER;
use crate::drive::Control;
use crate::input::axis::AxisOf;
use crate::input::document::kind::Boolean;
use crate::input::document::kind::{Choice, Dependent, Integer, Number, quantity};
use crate::input::document::row::{Optional, Or, Others, Required, Row, Rows, rows, table};
use crate::input::indenter_block::{INDENTER, LISTED_INDENTER};
use crate::input::points::{MOST_POINTS, Points, Spacing};
use crate::quantity::Dimension::{
    self, Angle, AngularFrequency, Force, Frequency, Length, Stress, Time,
};
use crate::quantity::key::Limits;
use crate::sweep::plan::Block;
use contact_dma_core::words;

words! {
    /// What may be prescribed: a load, also as a mean pressure, or an approach.
    pub(crate) enum Prescribed {
        Load = "load",
        Pressure = "pressure",
        Approach = "approach",
    }
}

impl Prescribed {
    /// What is controlled, a pressure by its load.
    pub(crate) fn control(self) -> Control {
        match self {
            Self::Load | Self::Pressure => Control::Load,
            Self::Approach => Control::Approach,
        }
    }

    /// What kind of quantity the values are.
    pub(crate) fn dimension(self) -> Dimension {
        match self {
            Self::Pressure => Stress,
            Self::Load | Self::Approach => self.control().dimension(),
        }
    }
}

/// A load, a mean pressure where that is prescribed, or an approach.
pub(crate) const fn of_prescribed(limits: Limits) -> Dependent {
    Dependent {
        dimensions: &[Force, Length, Stress],
        limits,
    }
}

rows! { HARMONIC_KEYS:
    /// What is prescribed: the load; the mean pressure on a periodic surface (load over the area of one period); or the approach. The
    /// values below are then forces, stresses or lengths.
    PRESCRIBES: Row<Choice<Prescribed>, Or<Prescribed>> =
        "control", Choice(Prescribed::NAMES), Or(Prescribed::Load);
    /// Mean; the sum of mean and amplitude must be above zero.
    MEAN: Row<Dependent, Required> = "mean", of_prescribed(Limits::NONE), Required;
    /// Amplitude; a load is held at zero where the sine would be negative.
    AMPLITUDE: Row<Dependent, Required> = "amplitude", of_prescribed(Limits::ABOVE_ZERO), Required;
    /// Phase at the start of the oscillation.
    PHASE: Row<Number, Or<f64>> = "phase", quantity(Angle), Or(0.0);
    /// Hold at the mean before the oscillation.
    HOLD: Row<Number, Or<f64>> = "hold", quantity(Time).not_negative(), Or(0.0);
}

pub(super) static HARMONIC: Rows = table(
    " mean + amplitude sin(omega t + phase), after a hold at the mean.",
    HARMONIC_KEYS,
);

rows! { _:
    /// Angular frequencies: a list or a range. Hz is accepted too.
    ANGULAR_FREQUENCY: Row<Points, Required> =
        "angular_frequency", Points(quantity(AngularFrequency).above_zero()), Required;
    /// Frequencies: a list or a range. rad/s is accepted too.
    FREQUENCY: Row<Points, Required> = "frequency", Points(quantity(Frequency).above_zero()), Required;
}

/// Blocks of which a sweep may have a list.
pub(in crate::input) const LISTED: [&str; 2] = [Block::Material.name(), Block::Indenter.name()];

rows! { SWEEP_KEYS:
    /// A further axis over a key of `[drive]`, with all frequencies at each value: `drive.amplitude = ["1 N", "2 N"]`. Up to four axes may
    /// be given; the cases are all combinations of their values.
    DRIVE_AXIS: Row<AxisOf, Optional> = "drive", AxisOf::new(Block::Drive, &HARMONIC), Optional;
    /// The same over a number of the indenter or of its material: `indenter.radius = ["1 mm", "2 mm"]`. Or several indenters in
    /// place of `[indenter]`: one `[[sweep.indenter]]` each, with its `name`.
    INDENTER_AXIS: Row<AxisOf, Optional> =
        "indenter", AxisOf::new(Block::Indenter, &INDENTER).or_blocks(&LISTED_INDENTER), Optional;
    /// The same over a number of the material: `material.temperature = ["0 °C", "25 °C"]`, or, with a quoted path, in a table or list
    /// within its block: `"material.relaxation.branches[0].time" = ["1 s", "10 s"]`, items counted from 0. Or several materials in
    /// place of `[material]`: one `[[sweep.material]]` each, with a `name` or from the library.
    MATERIAL_AXIS: Row<AxisOf, Optional> =
        "material", AxisOf::new(Block::Material, &MATERIAL).or_blocks(&MATERIAL), Optional;
    /// The same over a number of the layer: `layer.thickness = ["10 um", "1 mm"]`.
    LAYER_AXIS: Row<AxisOf, Optional> = "layer", AxisOf::new(Block::Layer, &LAYER), Optional;
    /// Whether the values of several axes of equal length are paired one by one, instead of combined.
    PAIRS: Row<Boolean, Or<bool>> = "pairs", Boolean, Or(false);
    /// Whether frequencies are added where the given ones do not resolve the loss curve.
    REFINE: Row<Boolean, Or<bool>> = "refine", Boolean, Or(false);
}

pub(super) static SWEEP: Rows = Rows {
    means: " The cases: exactly one of `angular_frequency` and `frequency`, and optional further axes.",
    keys: SWEEP_KEYS,
    block: &[],
    others: Others::OneList(&[&[&ANGULAR_FREQUENCY], &[&FREQUENCY]]),
};

rows! { RANGE_KEYS:
    /// First point.
    FROM: Row<Number, Required> = "from", quantity(AngularFrequency).above_zero(), Required;
    /// Last point.
    TO: Row<Number, Required> = "to", quantity(AngularFrequency).above_zero(), Required;
    /// Number of points, both ends included.
    POINTS: Row<Integer, Required> = "points", Integer(1..=MOST_POINTS), Required;
    /// Logarithmic (constant ratio) or linear (constant difference).
    SPACING: Row<Choice<Spacing>, Or<Spacing>> = "spacing", Choice(Spacing::NAMES), Or(Spacing::Logarithmic);
}
