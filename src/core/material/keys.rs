//! The keys of `[material]` that a resolved file has: a series, and what is known of it.

use super::dynamic::{MOST_BRANCHES, MOST_REPLICAS};
use super::{CreepBranch, ModulusKind, RelaxationBranch};
use crate::quantity::Dimension::{Compliance, Stress, Temperature, Time, Viscosity};
use crate::quantity::block::Block as _;
use crate::quantity::key::{self, Entries, Kind, Number, number, quantity};
use crate::quantity::rows::{Rows, table};
use crate::{block, keys};

/// What to write in place of numbers that make no series or no range.
const NO_BRANCH: &str = "write a positive number, or leave the branch out";
const WINDOW: &str =
    "write the first and the last time of the test, above zero: measured = [\"0.1 s\", \"1000 s\"]";
const COLDEST_FIRST: &str =
    "write the lowest temperature first: measured_temperatures = [\"-10 °C\", \"80 °C\"]";

/// Twice as many as a fit gives.
const MOST_ALTERNATIVES: usize = 64;
/// More curves than this are no sweep over temperature.
pub const MOST_ISOTHERMS: usize = 1000;

const MODULUS_OR_ZERO: Kind = Kind::Number(quantity(Stress).not_negative());
const TEMPERATURES: Number = quantity(Temperature).above_zero();
const KINDS: Kind = Kind::Word(ModulusKind::WORDS);

const fn pair(number: Number, instead: &'static str) -> Kind {
    Kind::Numbers(number.or_else(instead), Entries::two(instead))
}

keys! {
    /// Name of the material in tables and figures.
    NAME = "name", Kind::Text, optional;
    /// Poisson ratio, constant in time.
    POISSON_RATIO = "poisson_ratio", Kind::Number(key::POISSON_RATIO);
    /// Bulk modulus in place of the Poisson ratio, which then increases as the body relaxes: constant in time, or a table
    /// with the series of a relaxing one.
    BULK_MODULUS = "bulk_modulus", Kind::Either(
        &Kind::Number(quantity(Stress).above_zero()), &Kind::Table(&BULK_SERIES), " with a series");
    /// First and last time of the test that the series was fitted to, if known.
    MEASURED = "measured", pair(quantity(Time).above_zero(), WINDOW), optional;
    /// Generalised Maxwell model (Prony series of the relaxation modulus).
    RELAXATION = "relaxation", Kind::Table(&RELAXATION_TABLE);
    /// Generalised Kelvin model (series of the creep compliance).
    CREEP = "creep", Kind::Table(&CREEP_TABLE);
    /// Series of the relaxation modulus at one or several temperatures, as from a fit to dynamic data.
    ISOTHERMS = "isotherm", Kind::Tables(&ISOTHERM, MOST_ISOTHERMS, "");
    /// Temperature of the body, for a material that is known at several temperatures. Left out: the reference temperature of the
    /// dynamic data, or the temperature of the only isotherm or of the library's data.
    TEMPERATURE = "temperature", Kind::Number(TEMPERATURES), optional;
    /// Other series that fit the same data: a relaxation series beside `relaxation`, a creep series beside `creep`, without their
    /// `modulus` or `compliance`. What they change is reported as an uncertainty.
    RELAXATION_ALTERNATIVE = "alternative", Kind::Tables(&RELAXATION_SERIES, MOST_ALTERNATIVES, ""), optional;
    /// Other series that fit the same data: a relaxation series beside `relaxation`, a creep series beside `creep`, without their
    /// `modulus` or `compliance`. What they change is reported as an uncertainty.
    CREEP_ALTERNATIVE = "alternative", Kind::Tables(&CREEP_SERIES, MOST_ALTERNATIVES, ""), optional;
}

keys! {
    /// Whether the moduli are Young's or shear moduli.
    MODULUS = "modulus", KINDS;
    /// Equilibrium modulus; zero for a fluid.
    EQUILIBRIUM = "equilibrium", MODULUS_OR_ZERO;
    /// Equilibrium bulk modulus.
    BULK_EQUILIBRIUM = "equilibrium", Kind::Number(quantity(Stress).above_zero());
    /// The branches of the series.
    RELAXATION_BRANCHES = "branches", Kind::Tables(&RELAXATION_BRANCH, MOST_BRANCHES, "");
    /// Series fitted to random realisations of the noise in the data. The spread of the losses computed with them is the uncertainty of
    /// the loss due to the material.
    REPLICAS = "replicas", Kind::Tables(&REPLICA, MOST_REPLICAS, ""), optional;
    /// Whether the compliances are uniaxial or in shear.
    COMPLIANCE = "compliance", KINDS;
    /// Instantaneous compliance.
    INSTANTANEOUS = "instantaneous", Kind::Number(quantity(Compliance).not_negative());
    /// Viscosity of a fluid, which adds t / viscosity to the compliance.
    VISCOSITY = "viscosity", Kind::Number(quantity(Viscosity).above_zero().or_else("leave the key out for a solid")), optional;
    /// The branches of the series.
    CREEP_BRANCHES = "branches", Kind::Tables(&CREEP_BRANCH, MOST_BRANCHES, "");
}

static RELAXATION_BRANCH: Rows = RelaxationBranch::ROWS;
static CREEP_BRANCH: Rows = CreepBranch::ROWS;
static BULK_SERIES: Rows = table(
    " K(t) = equilibrium + sum of modulus exp(-t / time).",
    &[&[BULK_EQUILIBRIUM, RELAXATION_BRANCHES]],
);
static RELAXATION_TABLE: Rows = table(
    " E(t) = equilibrium + sum of modulus exp(-t / time).",
    &[&[MODULUS, EQUILIBRIUM, RELAXATION_BRANCHES, REPLICAS]],
);
static RELAXATION_SERIES: Rows = table(
    " Another series that fits the same data.",
    &[&[EQUILIBRIUM, RELAXATION_BRANCHES]],
);
static CREEP_TABLE: Rows = table(
    " D(t) = instantaneous + sum of compliance (1 - exp(-t / time)) + t / viscosity.",
    &[&[COMPLIANCE, INSTANTANEOUS, VISCOSITY, CREEP_BRANCHES]],
);
static CREEP_SERIES: Rows = table(
    " Another series that fits the same data.",
    &[&[INSTANTANEOUS, VISCOSITY, CREEP_BRANCHES]],
);

block! {
    /// A series, its branches as two lists.
    pub struct Replica in "replicas" {
        /// Equilibrium modulus.
        equilibrium_pa: f64 => "equilibrium", MODULUS_OR_ZERO;
        /// Moduli of the branches.
        moduli_pa: Vec<f64> => "moduli", Kind::Numbers(quantity(Stress).above_zero().or_else(NO_BRANCH), Entries::ANY);
        /// Relaxation times of the branches.
        times_s: Vec<f64> => "times", Kind::Numbers(quantity(Time).above_zero().or_else(NO_BRANCH), Entries::ANY);
    }
}

static REPLICA: Rows = Replica::ROWS;

block! {
    /// The series at one temperature.
    pub struct AtTemperature in "isotherm" {
        /// Temperature at which the series holds.
        temperature_k: f64 => "temperature", Kind::Number(TEMPERATURES);
        /// Shift of the times of the series with temperature: c1 and c2 (K) of the law of Williams, Landel and Ferry about its own
        /// temperature, log10 a_T = -c1 (T - T0)/(c2 + T - T0).
        wlf: Option<Vec<f64>> = None => "wlf", Kind::Numbers(number("8.86").above_zero(), Entries::two(""));
        /// The same by the law of Arrhenius, with this activation energy in J/mol.
        activation_energy: Option<f64> = None => "activation_energy", Kind::Number(number("120e3").above_zero());
    }
}

keys! {
    /// Lowest and highest temperature of the isotherms that the series and its shift come from, if known; a sweep or history at a
    /// temperature outside is warned of.
    MEASURED_TEMPERATURES = "measured_temperatures", pair(TEMPERATURES, COLDEST_FIRST), optional;
}

static ISOTHERM: Rows = table(
    AtTemperature::MEANS,
    &[
        AtTemperature::KEYS,
        &[MEASURED, MEASURED_TEMPERATURES],
        &[MODULUS, EQUILIBRIUM, RELAXATION_BRANCHES, REPLICAS],
    ],
);
