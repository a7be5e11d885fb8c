//! Keys of `[drive]` and `[sweep]`: an oscillation and its axes, or a history of segments.

use super::material::MATERIAL;
use crate::drive::Control;
use crate::input::document::declare::keys;
use crate::input::indenter_block::{INDENTER, LISTED_INDENTER};
use crate::input::points::{MOST_POINTS, Spacing};
use crate::quantity::Dimension::{
    self, Angle, AngularFrequency, Force, Frequency, Length, Stress, Time,
};
use crate::quantity::block::Block as _;
use crate::quantity::key::{AxesOf, Key, Kind, Number, quantity};
use crate::quantity::rows::{Others, Rows, table};
use crate::sweep::plan::Block;
use crate::sweep::plan::layer::LayerPlan;
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
pub(crate) const PRESCRIBED: Number = quantity(Force).or_of(&[Length, Stress]);

keys! {
    /// What is prescribed: the load; the mean pressure on a periodic surface (load over the area of one period); or the approach. The
    /// values below are then forces, stresses or lengths.
    PRESCRIBES = "control", Kind::Word(Prescribed::WORDS), or Prescribed::Load;
    /// Mean; the sum of mean and amplitude must be above zero.
    MEAN = "mean", Kind::Number(PRESCRIBED);
    /// Amplitude; a load is held at zero where the sine would be negative.
    AMPLITUDE = "amplitude", Kind::Number(PRESCRIBED.above_zero());
    /// Phase at the start of the oscillation.
    PHASE = "phase", Kind::Number(quantity(Angle)), or 0.0;
    /// Hold at the mean before the oscillation.
    HOLD = "hold", Kind::Number(quantity(Time).not_negative()), or 0.0;
}

pub(super) static HARMONIC: Rows = table(
    " mean + amplitude sin(omega t + phase), after a hold at the mean.",
    &[&[PRESCRIBES, MEAN, AMPLITUDE, PHASE, HOLD]],
);

/// Blocks of which a sweep may have a list.
pub(in crate::input) const LISTED: [&str; 2] = [Block::Material.name(), Block::Indenter.name()];

const fn axes(block: Block, rows: &'static Rows, listed: Option<&'static Rows>) -> Kind {
    Kind::Axes(AxesOf {
        block: block.name(),
        rows,
        listed,
    })
}

const fn points(number: Number) -> Kind {
    Kind::Points(number.above_zero(), &RANGE)
}

keys! {
    /// Angular frequencies: a list or a range. Hz is accepted too.
    ANGULAR_FREQUENCY = "angular_frequency", points(quantity(AngularFrequency));
    /// Frequencies: a list or a range. rad/s is accepted too.
    FREQUENCY = "frequency", points(quantity(Frequency));
    /// A further axis over a key of `[drive]`, with all frequencies at each value: `drive.amplitude = ["1 N", "2 N"]`. Up to four axes may
    /// be given; the cases are all combinations of their values.
    DRIVE_AXIS = "drive", axes(Block::Drive, &HARMONIC, None), optional;
    /// The same over a number of the indenter or of its material: `indenter.radius = ["1 mm", "2 mm"]`. Or several indenters in
    /// place of `[indenter]`: one `[[sweep.indenter]]` each, with its `name`.
    INDENTER_AXIS = "indenter", axes(Block::Indenter, &INDENTER, Some(&LISTED_INDENTER)), optional;
    /// The same over a number of the material: `material.temperature = ["0 °C", "25 °C"]`, or, with a quoted path, in a table or list
    /// within its block: `"material.relaxation.branches[0].time" = ["1 s", "10 s"]`, items counted from 0. Or several materials in
    /// place of `[material]`: one `[[sweep.material]]` each, with a `name` or from the library.
    MATERIAL_AXIS = "material", axes(Block::Material, &MATERIAL, Some(&MATERIAL)), optional;
    /// The same over a number of the layer: `layer.thickness = ["10 um", "1 mm"]`.
    LAYER_AXIS = "layer", axes(Block::Layer, &LayerPlan::ROWS, None), optional;
    /// Whether the values of several axes of equal length are paired one by one, instead of combined.
    PAIRS = "pairs", Kind::Flag, or false;
    /// Whether frequencies are added where the given ones do not resolve the loss curve.
    REFINE = "refine", Kind::Flag, or false;
}

const SWEEP_KEYS: &[Key] = &[
    DRIVE_AXIS,
    INDENTER_AXIS,
    MATERIAL_AXIS,
    LAYER_AXIS,
    PAIRS,
    REFINE,
];

pub(super) static SWEEP: Rows = Rows {
    means: " The cases: exactly one of `angular_frequency` and `frequency`, and optional further axes.",
    keys: &[SWEEP_KEYS],
    others: Others::OneList(&[&[&[ANGULAR_FREQUENCY]], &[&[FREQUENCY]]]),
};

keys! {
    /// First point.
    FROM = "from", Kind::Number(quantity(AngularFrequency).above_zero());
    /// Last point.
    TO = "to", Kind::Number(quantity(AngularFrequency).above_zero());
    /// Number of points, both ends included.
    POINTS = "points", Kind::Integer(1..=MOST_POINTS);
    /// Logarithmic (constant ratio) or linear (constant difference).
    SPACING = "spacing", Kind::Word(Spacing::WORDS), or Spacing::Logarithmic;
}

pub(in crate::input) static RANGE: Rows = table(
    " A range in place of a list; `from` and `to` are what an entry of the list would be.",
    &[&[FROM, TO, POINTS, SPACING]],
);
