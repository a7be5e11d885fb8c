//! Keys of `[material.fractional]`: a model with derivatives of fractional order.

use std::ops::Bound;

use super::material::EQUILIBRIUM;
use crate::material::{ModulusKind, fractional};
use crate::quantity::Dimension::{AngularFrequency, Stress, Time};
use crate::quantity::block::Block as _;
use crate::quantity::key::{Entries, Kind, Limits, number, quantity};
use crate::quantity::rows::Rows;
use contact_dma_core::{block, choice, keys};

const BAND_PAIR: &str = "write the lowest and the highest frequency that you compute at, above zero: \
                         band = [\"1e-3 rad/s\", \"1e5 rad/s\"]";
const BETWEEN: &str =
    "1 is the classical model, 0 a spring: write an exponent above 0 and at most 1";
const ACCURACY: Limits = Limits::between(fractional::ACCURACY.0, fractional::ACCURACY.1);
const EXPONENT: Limits = Limits::new(Bound::Excluded(0.0), Bound::Included(1.0));

choice! {
    /// `springpot`: E* = stiffness (i omega time)^exponent. `zener`: E* = equilibrium + stiffness (i omega time)^exponent /
    /// (1 + (i omega time)^exponent). `maxwell`: E* = stiffness (i omega time)^exponent / (1 + (i omega time)^(exponent -
    /// second_exponent)), two springpots in series. Springpot and Maxwell are fluids, for single histories only.
    FRACTIONAL_MODEL = "model", FractionalModel, BY_MODEL:
    /// A springpot alone.
    Springpot = "springpot": &[];
    /// A spring in parallel with a spring and a springpot in series.
    Zener = "zener": &[&[EQUILIBRIUM]];
    /// Two springpots in series.
    Maxwell = "maxwell": &[&[SECOND_EXPONENT]];
}

block! {
    /// A model with derivatives of fractional order.
    pub(crate) struct FractionalKeys in "fractional" {
        /// Whether the stiffnesses are Young's or shear moduli.
        kind: ModulusKind => "modulus", Kind::Word(ModulusKind::WORDS);
        /// Modulus of the fractional element.
        stiffness_pa: f64 => "stiffness", Kind::Number(quantity(Stress).above_zero());
        /// Time of the fractional element.
        time_s: f64 => "time", Kind::Number(quantity(Time).above_zero());
        /// Exponent alpha of the fractional element, above 0 and at most 1 (springpot: below 1).
        exponent: f64 => "exponent", Kind::Number(number("0.5").within(EXPONENT).or_else(BETWEEN));
        /// Lowest and highest angular frequency between which a series represents the model; outside, results are extrapolations.
        band_rad_per_s: Vec<f64> => "band",
            Kind::Numbers(quantity(AngularFrequency).above_zero().or_else(BAND_PAIR), Entries::two(BAND_PAIR));
        /// Largest relative difference between series and model over the band: of E*, and of the loss modulus and the loss compliance on their
        /// own.
        accuracy: f64 = 1e-3 => "accuracy", Kind::Number(number("1e-3").within(ACCURACY));
    }
}

keys! {
    /// Exponent beta of the second springpot, below `exponent`; zero is a spring.
    SECOND_EXPONENT = "second_exponent", Kind::Number(number("0.2").within(Limits::of(0.0..1.0))), or 0.0;
}

pub(super) static TABLE: Rows = Rows {
    means: FractionalKeys::MEANS,
    keys: &[&[FRACTIONAL_MODEL], FractionalKeys::KEYS],
    others: BY_MODEL,
};
