//! The keys of `[material.table]`.

use crate::material::{MaterialFunction, ModulusKind};
use crate::quantity::Dimension::{Compliance, Stress, Time};
use crate::quantity::key::{Entries, Kind, quantity};
use crate::quantity::rows::{Others, Rows};
use crate::{keys, words};

words! {
    /// How the samples of a table enter.
    pub enum Evaluation {
        Fit = "fit",
        Direct = "direct",
    }
}

keys! {
    /// What the data are of.
    QUANTITY = "quantity", Kind::Word(MaterialFunction::WORDS);
    /// Whether they are uniaxial or in shear.
    TABLE_MODULUS = "modulus", Kind::Word(ModulusKind::WORDS);
    /// `fit`: a series is fitted and its misfit reported with the results; `direct` (single histories only): the samples are used directly.
    EVALUATION = "evaluation", Kind::Word(Evaluation::WORDS), or Evaluation::Fit;
    /// Whether to fit a fluid; left out: as the data indicate, a solid if they do not decide.
    FLOW = "flow", Kind::Flag, optional;
    /// CSV file with the columns `time_s` and `creep_compliance_per_pa` or `relaxation_modulus_pa`, or in other units.
    FILE = "file", Kind::Text;
    /// Times of the samples, in place of a file.
    TIMES = "times", Kind::Numbers(quantity(Time), Entries::ANY);
    /// Their values.
    VALUES = "values", Kind::Numbers(quantity(Compliance).or_of(&[Stress]), Entries::ANY);
}

/// The `[material.table]` block.
pub static TABLE: Rows = Rows {
    means: " Measured data: a `file`, or `times` and `values`.",
    keys: &[&[QUANTITY, TABLE_MODULUS, EVALUATION, FLOW]],
    others: Others::OneList(&[&[&[FILE]], &[&[TIMES, VALUES]]]),
};
