//! Keys of an identification: what was measured, and what the result is to be.

use super::material::{BULK_MODULUS, POISSON_RATIO};
use super::{ADHESION, INDENTER, LAYER, SOLVER, TITLE, drive};
use crate::identify::{ApproachZero, MOST_BRANCHES};
use crate::input::document::declare::keys;
use crate::input::segments_block::SEGMENTS;
use crate::quantity::block::Block as _;
use crate::quantity::key::{Key, Kind};
use crate::quantity::rows::{Others, Rows, table};
use crate::sweep::plan::CyclePlan;

keys! {
    /// A table with columns of `sweep.csv`, with error columns if known, or a folder that holds `sweep.csv`. For a history: `time_s` and
    /// `approach_m`, or `load_n` under a prescribed approach.
    DATA = "data", Kind::Text;
    /// Branches of the series: a number, or `auto` (the default): as many as the data require.
    IDENTIFY_BRANCHES = "branches", Kind::Either(&Kind::AUTO, &Kind::Integer(1..=MOST_BRANCHES), ""), optional;
    /// What smallest, largest and mean approaches of cycles are counted from; left out: unknown in a table of `analyse`, from first contact
    /// in any other. Where it is unknown they are not data, and the mean of a prescribed approach is that of `[drive]`.
    APPROACH_ZERO = "approach_zero", Kind::Word(ApproachZero::WORDS), optional;
}

static IDENTIFY_TABLE: Rows = table(
    " What was measured.",
    &[&[DATA, IDENTIFY_BRANCHES, APPROACH_ZERO]],
);

static MATERIAL_TABLE: Rows = Rows {
    means: " What is known of the material: its Poisson ratio, or a bulk modulus that is constant in time.",
    keys: &[],
    others: Others::OneList(&[&[&[POISSON_RATIO]], &[&[BULK_MODULUS]]]),
};

static DRIVEN: Rows = Rows {
    means: " Of measured cycles an oscillation; rows with `drive_mean` and `drive_amplitude` have their own. Of a measured history \
            its `segments`, as in a scenario.",
    keys: &[&[drive::PRESCRIBES]],
    others: Others::OneList(&[
        &[&[drive::MEAN, drive::AMPLITUDE, drive::PHASE, drive::HOLD]],
        &[&[SEGMENTS]],
    ]),
};

keys! {
    /// What was measured.
    IDENTIFY = "identify", Kind::Table(&IDENTIFY_TABLE);
    /// What is known of the material.
    KNOWN_MATERIAL = "material", Kind::Table(&MATERIAL_TABLE);
    /// The oscillation that the cycles were measured under, or the segments of a history.
    MEASURED_DRIVE = "drive", Kind::Table(&DRIVEN);
    /// How the cycles of the model are resolved.
    MODEL_CYCLE = "cycle", Kind::Table(&CyclePlan::ROWS), optional;
}

const KEYS: &[Key] = &[
    TITLE,
    IDENTIFY,
    KNOWN_MATERIAL,
    LAYER,
    INDENTER,
    ADHESION,
    MEASURED_DRIVE,
    MODEL_CYCLE,
    SOLVER,
];

pub(super) static IDENTIFY_FILE: Rows = table(
    " A material from measured cycles or a measured history, for `contact-dma identify`.",
    &[KEYS],
);
