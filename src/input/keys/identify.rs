//! Keys of an identification: what was measured, and what the result is to be.

use super::material::{BULK_MODULUS, POISSON_RATIO};
use super::{ADHESION, INDENTER, LAYER, SOLVER, TITLE, drive, settings};
use crate::identify::{ApproachZero, MOST_BRANCHES};
use crate::input::document::kind::{Choice, Table, Text};
use crate::input::document::row::{Optional, Others, Required, Row, Rows, rows, table};
use crate::input::material_dynamic::Branches;
use crate::input::segments_block::SEGMENTS;

rows! { IDENTIFY_KEYS:
    /// A table with columns of `sweep.csv`, with error columns if known, or a folder that holds `sweep.csv`. For a history: `time_s` and
    /// `approach_m`, or `load_n` under a prescribed approach.
    DATA: Row<Text, Required> = "data", Text, Required;
    /// Branches of the series: a number, or `auto` (the default): as many as the data require.
    IDENTIFY_BRANCHES: Row<Branches, Optional> = "branches", Branches(1..=MOST_BRANCHES), Optional;
    /// What smallest, largest and mean approaches of cycles are counted from; left out: unknown in a table of `analyse`, from first contact
    /// in any other. Where it is unknown they are not data, and the mean of a prescribed approach is that of `[drive]`.
    APPROACH_ZERO: Row<Choice<ApproachZero>, Optional> =
        "approach_zero", Choice(ApproachZero::NAMES), Optional;
}

static IDENTIFY_TABLE: Rows = table(" What was measured.", IDENTIFY_KEYS);

static MATERIAL_TABLE: Rows = Rows {
    means: " What is known of the material: its Poisson ratio, or a bulk modulus that is constant in time.",
    keys: &[],
    block: &[],
    others: Others::OneList(&[&[&POISSON_RATIO], &[&BULK_MODULUS]]),
};

rows! { _:
    /// What was measured.
    IDENTIFY: Row<Table, Required> = "identify", Table(&IDENTIFY_TABLE), Required;
    /// What is known of the material.
    KNOWN_MATERIAL: Row<Table, Required> = "material", Table(&MATERIAL_TABLE), Required;
    /// The oscillation that the cycles were measured under, or the segments of a history.
    MEASURED_DRIVE: Row<Table, Required> = "drive", Table(&DRIVEN), Required;
    /// How the cycles of the model are resolved.
    MODEL_CYCLE: Row<Table, Optional> = "cycle", Table(&settings::CYCLE), Optional;
}

static DRIVEN: Rows = Rows {
    means: " Of measured cycles an oscillation; rows with `drive_mean` and `drive_amplitude` have their own. Of a measured history \
            its `segments`, as in a scenario.",
    keys: &[&drive::PRESCRIBES],
    block: &[],
    others: Others::OneList(&[
        &[&drive::MEAN, &drive::AMPLITUDE, &drive::PHASE, &drive::HOLD],
        &[&SEGMENTS],
    ]),
};

pub(super) static IDENTIFY_FILE: Rows = table(
    " A material from measured cycles or a measured history, for `contact-dma identify`.",
    &[
        &TITLE,
        &IDENTIFY,
        &KNOWN_MATERIAL,
        &LAYER,
        &INDENTER,
        &ADHESION,
        &MEASURED_DRIVE,
        &MODEL_CYCLE,
        &SOLVER,
    ],
);
