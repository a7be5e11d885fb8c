//! Keys of what may be left out: `[cycle]`, `[solver]`, `[time]`, `[output]` and `[figures]`.

use std::ops::RangeInclusive;

use crate::engine::SolverPlan;
use crate::figures::paper::COLUMNS;
use crate::input::document::block::rows_of;
use crate::input::document::kind::{
    Array, Boolean, Choice, Integer, Number, list, number, quantity,
};
use crate::input::document::row::{Optional, Others, Row, Rows, rows, table};
use crate::quantity::Dimension::{AngularFrequency, Length, Time};
use crate::quantity::FrequencyUnit;
use crate::quantity::key::Limits;
use crate::simulation::scenario::OutputPlan;
use crate::sweep::plan::CyclePlan;
use crate::sweep::plan::adhesion::AdhesionPlan;
use crate::sweep::plan::figures::{AxisUnits, Format};
use crate::sweep::plan::layer::LayerPlan;

pub(super) static CYCLE: Rows = rows_of::<CyclePlan>();
pub(super) static SOLVER: Rows = rows_of::<SolverPlan>();
pub(super) static LAYER: Rows = rows_of::<LayerPlan>();
pub(super) static ADHESION: Rows = rows_of::<AdhesionPlan>();
pub(super) static OUTPUT: Rows = rows_of::<OutputPlan>();

rows! { TIME_KEYS:
    /// Time step; left out: chosen from drive and material.
    TIME_STEP: Row<Number, Optional> =
        "step",
        quantity(Time).above_zero().or_else("leave it out, and steps are chosen from drive and material"),
        Optional;
}

pub(super) static TIME: Rows = table(" Time steps of a history.", TIME_KEYS);

/// Sides, text and resolutions beyond these are a slip of the pen rather than a wish.
const SIDE: Number = quantity(Length)
    .such_as("\"85 mm\"")
    .within(Limits::between(0.02, 1.0).or_else("a figure one column wide has \"85 mm\""));
const FONT_SIZE: Limits = Limits::between(4.0, 36.0)
    .or_else("write a number of points without a unit, such as `font_size = 8`");
const DPI: RangeInclusive<usize> = 30..=2400;
/// More loops than this cannot be told apart.
const MOST_LOOPS: usize = 8;

rows! { FIGURES_KEYS:
    /// Width and text for one (85 mm) or two (180 mm) columns of a journal, in place of `width`.
    COLUMN: Row<Choice<f64>, Optional> = "column", Choice(&COLUMNS), Optional;
    /// Width on paper.
    WIDTH: Row<Number, Optional> = "width", SIDE, Optional;
    /// Height on paper; left out: chosen from the contents.
    HEIGHT: Row<Number, Optional> = "height", SIDE, Optional;
    /// Size (pt) of ticks and legends; titles of axes are an eighth larger.
    FONT_SIZE_PT: Row<Number, Optional> = "font_size", number("8").within(FONT_SIZE), Optional;
    /// File formats; left out: SVG and PNG. PDFs contain text as text, for LaTeX.
    FORMATS: Row<Array<Choice<Format>>, Optional> =
        "formats",
        Array {
            entries: 1..=Format::NAMES.len(),
            repeats: false,
            instead: "write at least one of \"svg\", \"png\" and \"pdf\", or leave it out",
            ..list(Choice(Format::NAMES))
        },
        Optional;
    /// Pixels of a PNG per inch on paper; left out: 300 if a size is given, otherwise one and two pixels per px of the drawing.
    RESOLUTION: Row<Integer, Optional> = "dpi", Integer(DPI), Optional;
    /// SI units, or units of the elastic contact.
    AXES: Row<Choice<AxisUnits>, Optional> = "axes", Choice(AxisUnits::NAMES), Optional;
    /// Whether figures have titles above the frame; left out: yes.
    TITLES: Row<Boolean, Optional> = "titles", Boolean, Optional;
}

pub(super) static FIGURES: Rows = Rows {
    means: " Appearance of figures; does not affect results, and all of it is optional.",
    keys: FIGURES_KEYS,
    block: &[],
    others: Others::AtMostOne(&["width", "column"]),
};

rows! { _:
    /// Frequencies whose loops are drawn (the nearest cases); left out: chosen automatically. Hz is accepted too.
    LOOPS: Row<Array<Number>, Optional> =
        "loops",
        Array {
            entries: 1..=MOST_LOOPS,
            instead: "a figure shows 1 to 8 loops; leave it out and some are chosen",
            ..list(quantity(AngularFrequency))
        },
        Optional;
    /// Unit of frequencies in figures, tables and text; left out: that used in `[sweep]`.
    FREQUENCY_UNIT: Row<Choice<FrequencyUnit>, Optional> =
        "frequency_unit", Choice(FrequencyUnit::NAMES), Optional;
}

pub(super) static SWEEP_FIGURES: Rows = Rows {
    means: " Appearance of figures; does not affect results, and all of it is optional.",
    keys: &[
        &LOOPS,
        &FREQUENCY_UNIT,
        &COLUMN,
        &WIDTH,
        &HEIGHT,
        &FONT_SIZE_PT,
        &FORMATS,
        &RESOLUTION,
        &AXES,
        &TITLES,
    ],
    block: &[],
    others: Others::AtMostOne(&["width", "column"]),
};
