//! Keys of `[drive]` and `[sweep]`: an oscillation and its axes, or a history of segments.

use super::material::MATERIAL;
use crate::drive::harmonic::HARMONIC;
use crate::input::indenter_block::{INDENTER, LISTED_INDENTER};
use crate::input::points::{MOST_POINTS, Spacing};
use crate::quantity::Dimension::{AngularFrequency, Frequency};
use crate::quantity::block::Block as _;
use crate::quantity::key::{AxesOf, Key, Kind, Number, quantity};
use crate::quantity::rows::{Others, Rows, table};
use crate::sweep::plan::axes::PAIRS;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::{Block, REFINE};
use contact_dma_core::keys;

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
