//! Keys of `[material]`: a series, a model of few elements, measured data or a material of the library.

use super::fractional;
use crate::input::dynamic::DynamicFormat;
use crate::material::dynamic::{Choices, MOST_BRANCHES, MOST_REPLICAS};
use crate::material::{CreepBranch, ModulusKind, RelaxationBranch, tabulated};
use crate::quantity::Dimension::{Compliance, Stress, Temperature, Time, Viscosity};
use crate::quantity::block::Block as _;
use crate::quantity::key::{self, Entries, Key, Kind, Number, number, quantity};
use crate::quantity::rows::{List, Others, Rows, table};
use contact_dma_core::{block, keys};

/// What to write where an element of a model with few of them has no strength or no time.
const ELASTIC: &str =
    "for a body without this element write a [material.relaxation] block with the branches it has";
const NO_BRANCH: &str = "write a positive number, or leave the branch out";
const WINDOW: &str =
    "write the first and the last time of the test, above zero: measured = [\"0.1 s\", \"1000 s\"]";
const COLDEST_FIRST: &str =
    "write the lowest temperature first: measured_temperatures = [\"-10 °C\", \"80 °C\"]";

/// Twice as many as a fit gives.
const MOST_ALTERNATIVES: usize = 64;
/// More curves than this are no sweep over temperature.
const MOST_ISOTHERMS: usize = 1000;

const MODULUS_OR_ZERO: Kind = Kind::Number(quantity(Stress).not_negative());
const TEMPERATURES: Number = quantity(Temperature).above_zero();
const ELEMENT: Kind = Kind::Number(quantity(Stress).above_zero().or_else(ELASTIC));
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
    /// A material that comes with the program; `contact-dma material list` lists them.
    LIBRARY = "library", Kind::Text;
    /// Poisson ratio in place of that of the library.
    LIBRARY_POISSON_RATIO = "poisson_ratio", Kind::Number(key::POISSON_RATIO), optional;
    /// Generalised Maxwell model (Prony series of the relaxation modulus).
    RELAXATION = "relaxation", Kind::Table(&RELAXATION_TABLE);
    /// Generalised Maxwell model (Prony series of the relaxation modulus).
    INDENTER_RELAXATION = "relaxation", Kind::Table(&INDENTER_RELAXATION_TABLE);
    /// Generalised Kelvin model (series of the creep compliance).
    CREEP = "creep", Kind::Table(&CREEP_TABLE);
    /// Spring and dashpot in series: a fluid, for single histories only.
    MAXWELL = "maxwell", Kind::Table(&Maxwell::ROWS);
    /// Spring in series with a Kelvin unit: the standard linear solid.
    ZENER = "zener", Kind::Table(&Zener::ROWS);
    /// Spring and dashpot in parallel; without instantaneous compliance it cannot make contact, so only `material show` accepts it.
    KELVIN_VOIGT = "kelvin_voigt", Kind::Table(&KelvinVoigt::ROWS);
    /// An elastic body, without losses.
    ELASTIC_BODY = "elastic", Kind::Table(&Elastic::ROWS);
    /// Springpot, fractional Zener or fractional Maxwell model, represented by a Prony series over a band.
    FRACTIONAL = "fractional", Kind::Table(&fractional::TABLE);
    /// Storage and loss modulus over frequency, measured at one or several temperatures, from which a master curve is made and a
    /// series fitted.
    DYNAMIC = "dynamic", Kind::Table(&DYNAMIC_TABLE);
    /// Series of the relaxation modulus at one or several temperatures, as from a fit to dynamic data.
    ISOTHERMS = "isotherm", Kind::Tables(&ISOTHERM, MOST_ISOTHERMS, "");
    /// Series of the relaxation modulus at one temperature or at several.
    INDENTER_ISOTHERMS = "isotherm", Kind::Tables(&INDENTER_ISOTHERM, MOST_ISOTHERMS, "");
    /// Temperature of the body, for a material that is known at several temperatures. Left out: the reference temperature of the
    /// dynamic data, or the temperature of the only isotherm or of the library's data.
    TEMPERATURE = "temperature", Kind::Number(TEMPERATURES), optional;
    /// Measured creep compliance or relaxation modulus.
    MEASURED_TABLE = "table", Kind::Table(&tabulated::keys::TABLE);
    /// Other series that fit the same data: a relaxation series beside `relaxation`, a creep series beside `creep`, without their
    /// `modulus` or `compliance`. What they change is reported as an uncertainty.
    RELAXATION_ALTERNATIVE = "alternative", Kind::Tables(&RELAXATION_SERIES, MOST_ALTERNATIVES, ""), optional;
    /// Other series that fit the same data: a relaxation series beside `relaxation`, a creep series beside `creep`, without their
    /// `modulus` or `compliance`. What they change is reported as an uncertainty.
    CREEP_ALTERNATIVE = "alternative", Kind::Tables(&CREEP_SERIES, MOST_ALTERNATIVES, ""), optional;
}

/// How much a form of material gives in to pressure: it says so itself, or a key beside it does.
const SAYS_ITSELF: &[Key] = &[];
const WITH_POISSON_RATIO: &[Key] = &[POISSON_RATIO];
const EITHER: &[Key] = &[POISSON_RATIO, BULK_MODULUS];

/// The ways to give a material, exactly one of them: the key that each is given by, those that go with it, and how much it gives in to
/// pressure.
macro_rules! forms {
    ($($Form:ident = $key:ident $(, $more:ident)*; $pressure:ident;)+) => {
        /// A way to give a material.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub(crate) enum Form { $($Form),+ }

        /// Each by its key.
        pub(crate) static FORMS: [(Key, Form); [$(Form::$Form),+].len()] = [$(($key, Form::$Form)),+];
        const LISTS: &[(List, &[Key])] = &[$((&[&[$key $(, $more)*]], $pressure)),+];
    };
}

forms! {
    Library = LIBRARY, LIBRARY_POISSON_RATIO, TEMPERATURE; SAYS_ITSELF;
    Elastic = ELASTIC_BODY; SAYS_ITSELF;
    Relaxation = RELAXATION, MEASURED, RELAXATION_ALTERNATIVE; EITHER;
    Creep = CREEP, MEASURED, CREEP_ALTERNATIVE; EITHER;
    Maxwell = MAXWELL, MEASURED; EITHER;
    Zener = ZENER, MEASURED; EITHER;
    KelvinVoigt = KELVIN_VOIGT, MEASURED; WITH_POISSON_RATIO;
    Fractional = FRACTIONAL; EITHER;
    Isotherms = ISOTHERMS, TEMPERATURE; WITH_POISSON_RATIO;
    Dynamic = DYNAMIC, TEMPERATURE; WITH_POISSON_RATIO;
    Measured = MEASURED_TABLE; EITHER;
}

pub(super) static MATERIAL: Rows = Rows {
    means: " Material of the half-space: exactly one of `library`, `elastic`, `relaxation`, `creep`, `maxwell`, `zener`, `kelvin_voigt`, \
            `fractional`, `isotherm`, `dynamic` and `table`.",
    keys: &[&[NAME]],
    others: Others::OneListAnd(LISTS),
};

/// What an indenter may be made of.
pub(in crate::input) static INDENTER_MATERIAL: Rows = Rows {
    means: " What the indenter is made of, where it is not rigid: exactly one of `library`, `elastic`, `relaxation`, `creep`, `zener` and `isotherm`.",
    keys: &[&[NAME]],
    others: Others::OneListAnd(&[
        (
            &[&[LIBRARY, LIBRARY_POISSON_RATIO, TEMPERATURE]],
            SAYS_ITSELF,
        ),
        (&[&[ELASTIC_BODY]], SAYS_ITSELF),
        (&[&[INDENTER_RELAXATION, MEASURED]], EITHER),
        (&[&[CREEP, MEASURED]], EITHER),
        (&[&[ZENER, MEASURED]], EITHER),
        (&[&[INDENTER_ISOTHERMS, TEMPERATURE]], WITH_POISSON_RATIO),
    ]),
};

block! {
    /// An elastic body.
    pub(crate) struct Elastic in "elastic" {
        /// Young's modulus.
        modulus_pa: f64 => "modulus", Kind::Number(quantity(Stress).above_zero());
        /// Poisson ratio.
        poisson_ratio: f64 => "poisson_ratio", Kind::Number(key::POISSON_RATIO);
    }
}

const ELEMENT_TIME: Kind = Kind::Number(quantity(Time).above_zero().or_else(ELASTIC));

block! {
    /// Spring and dashpot in series.
    pub(crate) struct Maxwell in "maxwell" {
        /// Shear modulus of the spring.
        modulus_pa: f64 => "modulus", ELEMENT;
        /// Viscosity over modulus: relaxation time of a Maxwell body, retardation time of a Kelvin unit.
        time_s: f64 => "time", ELEMENT_TIME;
    }
}

block! {
    /// Spring in series with a Kelvin unit.
    pub(crate) struct Zener in "zener" {
        /// Shear modulus of the spring.
        spring_pa: f64 => "spring", ELEMENT;
        /// Shear modulus of the spring in the Kelvin unit.
        kelvin_spring_pa: f64 => "kelvin_spring", ELEMENT;
        /// Viscosity over modulus: relaxation time of a Maxwell body, retardation time of a Kelvin unit.
        time_s: f64 => "time", ELEMENT_TIME;
    }
}

block! {
    /// Spring and dashpot in parallel.
    pub(crate) struct KelvinVoigt in "kelvin_voigt" {
        /// Shear modulus of the spring.
        spring_pa: f64 => "spring", ELEMENT;
        /// Viscosity over modulus: relaxation time of a Maxwell body, retardation time of a Kelvin unit.
        time_s: f64 => "time", ELEMENT_TIME;
    }
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
static INDENTER_RELAXATION_TABLE: Rows = table(
    " E(t) = equilibrium + sum of modulus exp(-t / time).",
    &[&[MODULUS, EQUILIBRIUM, RELAXATION_BRANCHES]],
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
    pub(crate) struct Replica in "replicas" {
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
    pub(crate) struct AtTemperature in "isotherm" {
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
static INDENTER_ISOTHERM: Rows = table(
    AtTemperature::MEANS,
    &[
        AtTemperature::KEYS,
        &[MEASURED, MEASURED_TEMPERATURES],
        &[MODULUS, EQUILIBRIUM, RELAXATION_BRANCHES],
    ],
);

keys! {
    /// Format of the files; left out: detected from their content.
    FORMAT = "format", Kind::Word(DynamicFormat::WORDS), optional;
    /// Whether the moduli are Young's or shear moduli.
    DYNAMIC_MODULUS = "modulus", KINDS;
    /// File of an instrument, or a table.
    DYNAMIC_FILE = "file", Kind::Text;
    /// Several of one specimen.
    DYNAMIC_FILES = "files", Kind::Texts(Entries::ANY);
}

static DYNAMIC_TABLE: Rows = Rows {
    means: " Measured storage and loss modulus: a `file`, or `files`.",
    keys: &[&[FORMAT, DYNAMIC_MODULUS], Choices::KEYS],
    others: Others::OneList(&[&[&[DYNAMIC_FILE]], &[&[DYNAMIC_FILES]]]),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_of_the_block_names_every_form() {
        let named = |rows: &Rows, key: &Key| rows.means.contains(&format!("`{}`", key.name));
        for (key, form) in &FORMS {
            assert!(named(&MATERIAL, key), "{form:?}");
        }
        let branches = INDENTER_MATERIAL.branches();
        for (first, _) in branches.iter().flat_map(|branch| &branch.decided_by) {
            let is_named = INDENTER_MATERIAL.means.contains(&format!("`{first}`"));
            assert!(is_named, "{first}");
        }
    }
}
