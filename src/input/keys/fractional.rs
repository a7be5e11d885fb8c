//! Keys of `[material.fractional]`: a model with derivatives of fractional order.

use std::ops::Bound;

use super::material::EQUILIBRIUM;
use crate::input::document::kind::{Array, Choice, Number, number, pair, quantity};
use crate::input::document::row::{Or, Others, Required, Row, Rows, rows, table};
use crate::material::{ModulusKind, fractional};
use crate::quantity::Dimension::{AngularFrequency, Stress, Time};
use crate::quantity::key::Limits;
use contact_dma_core::words;

words! {
    /// A fractional model.
    pub(crate) enum FractionalModel {
        Springpot = "springpot",
        Zener = "zener",
        Maxwell = "maxwell",
    }
}

const BAND_PAIR: &str = "write the lowest and the highest frequency that you compute at, above zero: \
                         band = [\"1e-3 rad/s\", \"1e5 rad/s\"]";
const BETWEEN: &str =
    "1 is the classical model, 0 a spring: write an exponent above 0 and at most 1";
const FRACTIONAL_ACCURACY: Limits = Limits::between(fractional::ACCURACY.0, fractional::ACCURACY.1);

rows! { FRACTIONAL_KEYS:
    /// `springpot`: E* = stiffness (i omega time)^exponent. `zener`: E* = equilibrium + stiffness (i omega time)^exponent /
    /// (1 + (i omega time)^exponent). `maxwell`: E* = stiffness (i omega time)^exponent / (1 + (i omega time)^(exponent -
    /// second_exponent)), two springpots in series. Springpot and Maxwell are fluids, for single histories only.
    FRACTIONAL_MODEL: Row<Choice<FractionalModel>, Required> = "model", Choice(FractionalModel::NAMES), Required;
    /// Whether the stiffnesses are Young's or shear moduli.
    FRACTIONAL_KIND: Row<Choice<ModulusKind>, Required> = "modulus", Choice(ModulusKind::NAMES), Required;
    /// Modulus of the fractional element.
    STIFFNESS: Row<Number, Required> = "stiffness", quantity(Stress).above_zero(), Required;
    /// Time of the fractional element.
    FRACTIONAL_TIME: Row<Number, Required> = "time", quantity(Time).above_zero(), Required;
    /// Exponent alpha of the fractional element, above 0 and at most 1 (springpot: below 1).
    FRACTIONAL_EXPONENT: Row<Number, Required> =
        "exponent",
        number("0.5").within(Limits::new(Bound::Excluded(0.0), Bound::Included(1.0))).or_else(BETWEEN),
        Required;
    /// Lowest and highest angular frequency between which a series represents the model; outside, results are extrapolations.
    BAND: Row<Array<Number>, Required> =
        "band", pair(quantity(AngularFrequency).above_zero().or_else(BAND_PAIR), BAND_PAIR), Required;
    /// Largest relative difference between series and model over the band: of E*, and of the loss modulus and the loss compliance on their
    /// own.
    FRACTIONAL_ACCURACY_KEY: Row<Number, Or<f64>> =
        "accuracy", number("1e-3").within(FRACTIONAL_ACCURACY), Or(1e-3);
}

rows! { _:
    /// Exponent beta of the second springpot, below `exponent`; zero is a spring.
    SECOND_EXPONENT: Row<Number, Or<f64>> =
        "second_exponent",
        number("0.2").within(Limits::of(0.0..1.0)),
        Or(0.0);
}

pub(super) static TABLE: Rows = Rows {
    means: " A model with derivatives of fractional order.",
    keys: FRACTIONAL_KEYS,
    block: &[],
    others: Others::ByWord(
        &FRACTIONAL_MODEL,
        &[
            ("springpot", &FRACTIONAL_SPRINGPOT),
            ("zener", &FRACTIONAL_ZENER),
            ("maxwell", &FRACTIONAL_MAXWELL),
        ],
    ),
};

static FRACTIONAL_SPRINGPOT: Rows = table(" A springpot alone.", &[]);
static FRACTIONAL_ZENER: Rows = table(
    " A spring in parallel with a spring and a springpot in series.",
    &[&EQUILIBRIUM],
);
static FRACTIONAL_MAXWELL: Rows = table(" Two springpots in series.", &[&SECOND_EXPONENT]);
