//! Keys of `[material]`: the forms that a material is given in, and what resolved files do not have: models of few elements, measured
//! data, materials of the library.

use super::fractional;
use crate::input::dynamic::DynamicFormat;
use crate::material::dynamic::Choices;
pub(crate) use crate::material::keys::*;
use crate::material::{ModulusKind, tabulated};
use crate::quantity::Dimension::{Stress, Time};
use crate::quantity::block::Block as _;
use crate::quantity::key::{self, Entries, Key, Kind, quantity};
use crate::quantity::rows::{List, Others, Rows, table};
use contact_dma_core::{block, keys};

/// What to write where an element of a model with few of them has no strength or no time.
const ELASTIC: &str =
    "for a body without this element write a [material.relaxation] block with the branches it has";

const ELEMENT: Kind = Kind::Number(quantity(Stress).above_zero().or_else(ELASTIC));

keys! {
    /// A material that comes with the program; `contact-dma material list` lists them.
    LIBRARY = "library", Kind::Text;
    /// Poisson ratio in place of that of the library.
    LIBRARY_POISSON_RATIO = "poisson_ratio", Kind::Number(key::POISSON_RATIO), optional;
    /// Generalised Maxwell model (Prony series of the relaxation modulus).
    INDENTER_RELAXATION = "relaxation", Kind::Table(&INDENTER_RELAXATION_TABLE);
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
    /// Series of the relaxation modulus at one temperature or at several.
    INDENTER_ISOTHERMS = "isotherm", Kind::Tables(&INDENTER_ISOTHERM, MOST_ISOTHERMS, "");
    /// Measured creep compliance or relaxation modulus.
    MEASURED_TABLE = "table", Kind::Table(&tabulated::keys::TABLE);
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

        impl Form {
            /// Whether a key may stand beside the one that the form is given by.
            pub(crate) fn goes_with(self, key: &Key) -> bool {
                let (keys, pressure) = LISTS[self as usize];
                let mut beside = keys.iter().copied().flatten().chain(pressure);
                beside.any(|beside| beside.name == key.name)
            }
        }

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
    means: " Material of the half-space",
    keys: &[&[NAME]],
    others: Others::OneListAnd(LISTS),
};

/// What an indenter may be made of.
pub(in crate::input) static INDENTER_MATERIAL: Rows = Rows {
    means: " What the indenter is made of, where it is not rigid",
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

static INDENTER_RELAXATION_TABLE: Rows = table(
    " E(t) = equilibrium + sum of modulus exp(-t / time).",
    &[&[MODULUS, EQUILIBRIUM, RELAXATION_BRANCHES]],
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
    DYNAMIC_MODULUS = "modulus", Kind::Word(ModulusKind::WORDS);
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
