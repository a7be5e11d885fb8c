//! Keys of `[drive]` and `[sweep]`: an oscillation and its axes, or a history of segments.

use super::indenter::{INDENTER, LISTED_INDENTER};
use super::layer::LAYER;
use super::material::MATERIAL;
use super::rows;
use crate::drive::Control;
use crate::input::axis::AxisOf;
use crate::input::document::kind::Boolean;
use crate::input::document::kind::{
    Array, Choice, Dependent, Integer, Scalar, Tables, Text, list, number, quantity,
};
use crate::input::document::limits::Limits;
use crate::input::document::row::{Optional, Or, Others, Required, Row, Rows};
use crate::input::points::{MOST_POINTS, Points, SPACINGS, Spacing};
use crate::quantity::Dimension::{
    self, Angle, AngularFrequency, Force, Frequency, Length, Stress, Time,
};
use crate::sweep::plan::Block;

/// What may be prescribed: a load, also as a mean pressure, or an approach.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Prescribed {
    Load,
    Pressure,
    Approach,
}

const PRESCRIBED: [(&str, Prescribed); 3] = [
    (Control::Load.name(), Prescribed::Load),
    ("pressure", Prescribed::Pressure),
    (Control::Approach.name(), Prescribed::Approach),
];

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
            Self::Load => Force,
            Self::Pressure => Stress,
            Self::Approach => Length,
        }
    }
}

/// A load, a mean pressure where that is prescribed, or an approach.
const fn of_prescribed(limits: Limits) -> Dependent {
    Dependent {
        dimensions: &[Force, Length, Stress],
        limits,
    }
}

rows! { HARMONIC_KEYS:
    /// What is prescribed: the load; the mean pressure on a periodic surface (load over the area of one period); or the approach. The
    /// values below are then forces, stresses or lengths.
    PRESCRIBES: Row<Choice<Prescribed>, Or<Prescribed>> =
        "control", Choice(&PRESCRIBED), Or(Prescribed::Load);
    /// Mean; the sum of mean and amplitude must be above zero.
    MEAN: Row<Dependent, Required> = "mean", of_prescribed(Limits::NONE), Required;
    /// Amplitude; a load is held at zero where the sine would be negative.
    AMPLITUDE: Row<Dependent, Required> = "amplitude", of_prescribed(Limits::ABOVE_ZERO), Required;
    /// Phase at the start of the oscillation.
    PHASE: Row<Scalar, Or<f64>> = "phase", quantity(Angle), Or(0.0);
    /// Hold at the mean before the oscillation.
    HOLD: Row<Scalar, Or<f64>> = "hold", quantity(Time).not_negative(), Or(0.0);
}

pub(super) static HARMONIC: Rows = super::table(
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
    others: Others::OneList(&[&[&ANGULAR_FREQUENCY], &[&FREQUENCY]]),
};

rows! { RANGE_KEYS:
    /// First point.
    FROM: Row<Scalar, Required> = "from", quantity(AngularFrequency).above_zero(), Required;
    /// Last point.
    TO: Row<Scalar, Required> = "to", quantity(AngularFrequency).above_zero(), Required;
    /// Number of points, both ends included.
    POINTS: Row<Integer, Required> = "points", Integer(1..=MOST_POINTS), Required;
    /// Logarithmic (constant ratio) or linear (constant difference).
    SPACING: Row<Choice<Spacing>, Or<Spacing>> = "spacing", Choice(&SPACINGS), Or(Spacing::Logarithmic);
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SegmentKind {
    Step,
    Ramp,
    Polynomial,
    Sine,
    Table,
}

const SEGMENT_KINDS: [(&str, SegmentKind); 5] = [
    ("step", SegmentKind::Step),
    ("ramp", SegmentKind::Ramp),
    ("polynomial", SegmentKind::Polynomial),
    ("sine", SegmentKind::Sine),
    ("table", SegmentKind::Table),
];

/// More segments than this belong into a table.
const MOST_SEGMENTS: usize = 10_000;

rows! { _:
    /// The segments, one after another; jumps between them are resolved exactly.
    SEGMENTS: Row<Tables, Required> =
        "segments",
        Tables {
            rows: &SEGMENT,
            most: MOST_SEGMENTS,
            instead: ", or a table: { kind = \"table\", file = \"drive.csv\" }",
        },
        Required;
}

pub(super) static HISTORY: Rows = super::table(
    " A history of load or approach, starting at first touch.",
    &[&PRESCRIBES, &SEGMENTS],
);

rows! { SEGMENT_KEYS:
    /// The kind of the segment; what it needs is listed below.
    KIND: Row<Choice<SegmentKind>, Required> = "kind", Choice(&SEGMENT_KINDS), Required;
}

static SEGMENT: Rows = Rows {
    means: " A part of the history.",
    keys: SEGMENT_KEYS,
    others: Others::ByWord(
        &KIND,
        &[
            ("step", &STEP),
            ("ramp", &RAMP),
            ("polynomial", &POLYNOMIAL),
            ("sine", &SINE),
            ("table", &TABLE),
        ],
    ),
};

rows! { _:
    /// The value held, or reached at the end.
    TARGET: Row<Dependent, Required> = "to", of_prescribed(Limits::NONE), Required;
    /// Duration of the segment.
    DURATION: Row<Scalar, Required> = "duration", quantity(Time).above_zero(), Required;
    /// Coefficients of 1, t, t^2, ... in SI units, with t from the start of the segment.
    COEFFICIENTS: Row<Array<Scalar>, Required> = "coefficients", list(number("2.0")), Required;
}

static STEP: Rows = super::table(" A jump to a constant value.", &[&TARGET, &DURATION]);
static RAMP: Rows = super::table(
    " A straight line from the end of the previous segment.",
    &[&TARGET, &DURATION],
);
static POLYNOMIAL: Rows = super::table(" A polynomial of time.", &[&COEFFICIENTS, &DURATION]);

rows! { _:
    /// Mean.
    SINE_MEAN: Row<Dependent, Required> = "mean", of_prescribed(Limits::NONE), Required;
    /// Amplitude.
    SINE_AMPLITUDE: Row<Dependent, Required> = "amplitude", of_prescribed(Limits::ABOVE_ZERO), Required;
    /// Number of cycles, not necessarily whole.
    CYCLES: Row<Scalar, Required> = "cycles", number("4.0").above_zero(), Required;
}

rows! { _:
    /// Angular frequency; Hz is accepted too.
    SINE_ANGULAR_FREQUENCY: Row<Scalar, Required> =
        "angular_frequency", quantity(AngularFrequency).above_zero(), Required;
    /// Frequency; rad/s is accepted too.
    SINE_FREQUENCY: Row<Scalar, Required> = "frequency", quantity(Frequency).above_zero(), Required;
}

static SINE: Rows = Rows {
    means: " mean + amplitude sin(omega t + phase): exactly one of `angular_frequency` and `frequency`.",
    keys: &[&SINE_MEAN, &SINE_AMPLITUDE, &PHASE, &CYCLES],
    others: Others::OneList(&[&[&SINE_ANGULAR_FREQUENCY], &[&SINE_FREQUENCY]]),
};

rows! { _:
    /// CSV file with the columns `time_s` and `load_n` or `approach_m`.
    FILE: Row<Text, Required> = "file", Text, Required;
    /// Times, in place of a file; the first is 0 s, two equal ones are a jump.
    TIMES: Row<Array<Scalar>, Required> = "times", list(quantity(Time)), Required;
    /// Their values.
    VALUES: Row<Array<Dependent>, Required> = "values", list(of_prescribed(Limits::NONE)), Required;
}

static TABLE: Rows = Rows {
    means: " Straight lines between points: a `file`, or `times` and `values`.",
    keys: &[],
    others: Others::OneList(&[&[&FILE], &[&TIMES, &VALUES]]),
};
