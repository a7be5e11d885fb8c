//! Keys of an identification: what was measured, and what the result is to be.

use super::material::{BULK_MODULUS, POISSON_RATIO};
use super::{ADHESION, INDENTER, LAYER, SOLVER, TITLE};
use crate::drive::segments::SEGMENTS;
use crate::drive::{PRESCRIBES, harmonic};
use crate::force_curve::resolved::{CURVE, Probe};
use crate::identify::resolved::{APPROACH_ZERO, ATTRACTION, DATA, IDENTIFY_BRANCHES, LAW, SAMPLES};
use crate::quantity::block::Block as _;
use crate::quantity::key::{Key, Kind};
use crate::quantity::rows::{Others, Rows, table};
use crate::sweep::plan::CyclePlan;

static MATERIAL_TABLE: Rows = Rows {
    means: " What is known of the material: its Poisson ratio, or a bulk modulus that is constant in time.",
    keys: &[],
    others: Others::OneList(&[&[&[POISSON_RATIO]], &[&[BULK_MODULUS]]]),
};
use contact_dma_core::keys;

static IDENTIFY_TABLE: Rows = Rows {
    means: " What was measured: cycles or a history under a drive that is known, or force curves, which have their own.",
    keys: &[&[IDENTIFY_BRANCHES, LAW, SAMPLES, ATTRACTION]],
    others: Others::OneList(&[&[&[DATA, APPROACH_ZERO]], &[&[CURVE]]]),
};

static DRIVEN: Rows = Rows {
    means: " Of measured cycles an oscillation; rows with `drive_mean` and `drive_amplitude` have their own. Of a measured history \
            its `segments`, as in a scenario.",
    keys: &[&[PRESCRIBES]],
    others: Others::OneList(&[&[harmonic::KEYS], &[&[SEGMENTS]]]),
};

keys! {
    /// What was measured.
    IDENTIFY = "identify", Kind::Table(&IDENTIFY_TABLE);
    /// What is known of the material.
    KNOWN_MATERIAL = "material", Kind::Table(&MATERIAL_TABLE);
    /// The oscillation that the cycles were measured under, or the segments of a history; force curves have none.
    MEASURED_DRIVE = "drive", Kind::Table(&DRIVEN), optional;
    /// The instrument of force curves.
    PROBE = "instrument", Kind::Table(&Probe::ROWS), optional;
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
    PROBE,
    MODEL_CYCLE,
    SOLVER,
];

pub(super) static IDENTIFY_FILE: Rows = table(
    " A material from measured cycles or a measured history, for `contact-dma identify`.",
    &[KEYS],
);
