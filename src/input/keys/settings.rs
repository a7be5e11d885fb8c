//! Keys of what may be left out: `[cycle]`, `[solver]`, `[time]`, `[output]` and `[figures]`.

use std::ops::RangeInclusive;

use super::rows;
use crate::engine::{EngineKind, SolverPlan};
use crate::figures::paper::COLUMNS;
use crate::history::TimeRule;
use crate::input::document::kind::{
    Array, Boolean, Choice, Integer, Scalar, list, number, quantity,
};
use crate::input::document::limits::Limits;
use crate::input::document::row::{Optional, Or, Others, Row, Rows};
use crate::quantity::Dimension::{AngularFrequency, Length, Time};
use crate::quantity::FrequencyUnit;
use crate::simulation::scenario::OutputPlan;
use crate::sweep::plan::figures::{AxisUnits, Format};
use crate::sweep::plan::{CyclePlan, Method};

/// Rounding leaves less than the first.
const TOLERANCE: Limits = Limits::of(CyclePlan::TOLERANCE);
/// The finest resolution could reach the first.
const ACCURACY: Limits = Limits::of(CyclePlan::ACCURACY);

const METHODS: [(&str, Method); 2] = [
    (Method::Direct.name(), Method::Direct),
    (Method::March.name(), Method::March),
];

rows! { CYCLE_KEYS:
    /// Time steps per cycle; with `accuracy`, the minimum.
    CYCLE_STEPS: Row<Integer, Or<usize>> = "steps", Integer(CyclePlan::STEPS), Or(CyclePlan::DEFAULT.steps);
    /// `direct`: the stabilised cycle is solved for; `march`: cycles are computed one after another, after the hold, until it is reached.
    METHOD: Row<Choice<Method>, Or<Method>> = "method", Choice(&METHODS), Or(CyclePlan::DEFAULT.method);
    /// Largest distance to the stabilised cycle, for the memory and for the closure of the loop.
    CYCLE_TOLERANCE: Row<Scalar, Or<f64>> =
        "tolerance", number("1e-4").within(TOLERANCE), Or(CyclePlan::DEFAULT.tolerance);
    /// Number of marched cycles after which a frequency counts as not converged.
    MAX_CYCLES: Row<Integer, Or<usize>> = "max_cycles", Integer(CyclePlan::MAX_CYCLES), Or(CyclePlan::DEFAULT.max_cycles);
    /// With `method = "march"`: records this cycle after the hold, counted from 1, whether it is stabilised or not.
    AT_CYCLE: Row<Integer, Optional> = "at_cycle", Integer(CyclePlan::MAX_CYCLES), Optional;
    /// Whether every case is also solved with coarser steps and nodes to estimate its errors.
    CYCLE_ERROR_BARS: Row<Boolean, Or<bool>> = "error_bars", Boolean, Or(CyclePlan::DEFAULT.error_bars);
    /// Largest relative error of every loss: steps, and springs or cells, are chosen to reach it. Same as `--accuracy`.
    CYCLE_ACCURACY: Row<Scalar, Optional> =
        "accuracy",
        number("1e-3").within(ACCURACY).or_else("for example accuracy = 1e-3, a thousandth of the loss"),
        Optional;
}

pub(super) static CYCLE: Rows = super::table(
    " Resolution of a cycle, and when it counts as stabilised.",
    CYCLE_KEYS,
);

const ENGINES: [(&str, EngineKind); 2] = [
    (EngineKind::Axisymmetric.name(), EngineKind::Axisymmetric),
    (EngineKind::HalfSpace.name(), EngineKind::HalfSpace),
];

const TIME_RULES: [(&str, TimeRule); 2] = [
    (TimeRule::Linear.name(), TimeRule::Linear),
    (TimeRule::Constant.name(), TimeRule::Constant),
];

rows! { SOLVER_KEYS:
    /// The contact engine; left out: the axisymmetric one if the indenter is a convex body of revolution.
    ENGINE: Row<Choice<EngineKind>, Optional> = "engine", Choice(&ENGINES), Optional;
    /// Axisymmetric engine: springs over the domain.
    SOLVER_SPRINGS: Row<Integer, Or<usize>> = "springs", Integer(SolverPlan::SPRINGS), Or(SolverPlan::DEFAULT.springs);
    /// Half-space engine: cells along the longer side of the domain; a height map has its own.
    SOLVER_CELLS: Row<Integer, Or<usize>> = "cells", Integer(SolverPlan::CELLS), Or(SolverPlan::DEFAULT.cells);
    /// Half-space engine: tolerance at one instant; left out: chosen so that its effect on the loss is a tenth of `cycle.tolerance`.
    SOLVER_TOLERANCE: Row<Scalar, Optional> = "tolerance", number("1e-10").within(TOLERANCE), Optional;
    /// `linear`: second order, in two stages where one would oscillate; `constant`: the first-order rule of the base paper.
    TIME_RULE: Row<Choice<TimeRule>, Or<TimeRule>> =
        "time_rule", Choice(&TIME_RULES), Or(SolverPlan::DEFAULT.time_rule);
}

pub(super) static SOLVER: Rows = super::table(" Contact engine and its resolution.", SOLVER_KEYS);

rows! { TIME_KEYS:
    /// Time step; left out: chosen from drive and material.
    TIME_STEP: Row<Scalar, Optional> =
        "step",
        quantity(Time).above_zero().or_else("leave it out, and steps are chosen from drive and material"),
        Optional;
}

pub(super) static TIME: Rows = super::table(" Time steps of a history.", TIME_KEYS);

/// More surfaces than this fill memory and disk before they are looked at.
const MOST_SURFACES: usize = 10_000;
const OUTPUT_DEFAULT: &OutputPlan = &OutputPlan::DEFAULT;
const TIMES: Array<Scalar> = Array {
    entries: 0..=MOST_SURFACES,
    ..list(quantity(Time))
};

rows! { OUTPUT_KEYS:
    /// Times at which profiles along a radius, or along the axes of the grid, are written.
    PROFILES_AT: Row<Array<Scalar>, Optional> = "profiles_at", TIMES, Optional;
    /// Times at which whole fields are written, as `.npy` and as `.vti` for ParaView.
    FIELDS_AT: Row<Array<Scalar>, Optional> = "fields_at", TIMES, Optional;
    /// Axisymmetric engine: cells per side of these fields, which are revolved.
    FIELD_CELLS: Row<Integer, Or<usize>> = "field_cells", Integer(SolverPlan::CELLS), Or(OUTPUT_DEFAULT.field_cells);
    /// Whether the history is repeated with fewer steps and nodes to estimate the error of every row.
    OUTPUT_ERROR_BARS: Row<Boolean, Or<bool>> = "error_bars", Boolean, Or(OUTPUT_DEFAULT.error_bars);
}

pub(super) static OUTPUT: Rows =
    super::table(" What is written in addition to the history.", OUTPUT_KEYS);

/// Sides, text and resolutions beyond these are a slip of the pen rather than a wish.
const SIDE: Scalar = quantity(Length)
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
    WIDTH: Row<Scalar, Optional> = "width", SIDE, Optional;
    /// Height on paper; left out: chosen from the contents.
    HEIGHT: Row<Scalar, Optional> = "height", SIDE, Optional;
    /// Size (pt) of ticks and legends; titles of axes are an eighth larger.
    FONT_SIZE_PT: Row<Scalar, Optional> = "font_size", number("8").within(FONT_SIZE), Optional;
    /// File formats; left out: SVG and PNG. PDFs contain text as text, for LaTeX.
    FORMATS: Row<Array<Choice<Format>>, Optional> =
        "formats",
        Array {
            entries: 1..=Format::NAMES.len(),
            repeats: false,
            instead: "write at least one of \"svg\", \"png\" and \"pdf\", or leave it out",
            ..list(Choice(&Format::NAMES))
        },
        Optional;
    /// Pixels of a PNG per inch on paper; left out: 300 if a size is given, otherwise one and two pixels per px of the drawing.
    RESOLUTION: Row<Integer, Optional> = "dpi", Integer(DPI), Optional;
    /// SI units, or units of the elastic contact.
    AXES: Row<Choice<AxisUnits>, Optional> = "axes", Choice(&AxisUnits::NAMES), Optional;
    /// Whether figures have titles above the frame; left out: yes.
    TITLES: Row<Boolean, Optional> = "titles", Boolean, Optional;
}

pub(super) static FIGURES: Rows = Rows {
    means: " Appearance of figures; does not affect results, and all of it is optional.",
    keys: FIGURES_KEYS,
    others: Others::AtMostOne(&[&WIDTH, &COLUMN]),
};

rows! { _:
    /// Frequencies whose loops are drawn (the nearest cases); left out: chosen automatically. Hz is accepted too.
    LOOPS: Row<Array<Scalar>, Optional> =
        "loops",
        Array {
            entries: 1..=MOST_LOOPS,
            instead: "a figure shows 1 to 8 loops; leave it out and some are chosen",
            ..list(quantity(AngularFrequency))
        },
        Optional;
    /// Unit of frequencies in figures, tables and text; left out: that used in `[sweep]`.
    FREQUENCY_UNIT: Row<Choice<FrequencyUnit>, Optional> =
        "frequency_unit", Choice(&FrequencyUnit::NAMES), Optional;
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
    others: Others::AtMostOne(&[&WIDTH, &COLUMN]),
};
