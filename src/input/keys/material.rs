//! Keys of `[material]`: a series, a model of few elements, measured data or a material of the library.

use super::fractional;
use crate::input::bulk_modulus::BulkModulus;
use crate::input::document::kind::{
    Array, Boolean, Choice, Dependent, Integer, Number, Table, Tables, Text, list, number, pair,
    quantity,
};
use crate::input::document::row::{List, Optional, Or, Others, Required, Row, Rows, rows, table};
use crate::input::dynamic::{DynamicFormat, FORMATS};
use crate::input::material_dynamic::{Branches, Shift};
use crate::material::{MaterialFunction, ModulusKind};
use crate::quantity::Dimension::{Compliance, Stress, Temperature, Time, Viscosity};
use crate::quantity::key::{self, Limits};
use contact_dma_core::words;

words! {
    /// How the samples of a table enter.
    pub(crate) enum Evaluation {
        Fit = "fit",
        Direct = "direct",
    }
}

/// What to write where an element of a model with few of them has no strength or no time.
const ELASTIC: &str =
    "for a body without this element write a [material.relaxation] block with the branches it has";
const NO_BRANCH: &str = "write a positive number, or leave the branch out";
const WINDOW: &str =
    "write the first and the last time of the test, above zero: measured = [\"0.1 s\", \"1000 s\"]";

/// More branches than any fit resolves are a mistake in the file.
pub(crate) const MOST_BRANCHES: usize = 1000;
/// Twice as many as a fit gives.
const MOST_ALTERNATIVES: usize = 64;
/// More tell no more of a spread.
pub(crate) const MOST_REPLICAS: usize = 1000;
/// More curves than this are no sweep over temperature.
const MOST_ISOTHERMS: usize = 1000;

rows! { MATERIAL_KEYS:
    /// Name of the material in tables and figures.
    NAME: Row<Text, Optional> = "name", Text, Optional;
}

rows! { _:
    /// Poisson ratio, constant in time.
    POISSON_RATIO: Row<Number, Required> = "poisson_ratio", key::POISSON_RATIO, Required;
    /// Bulk modulus in place of the Poisson ratio, which then increases as the body relaxes: constant in time, or a table
    /// with the series of a relaxing one.
    BULK_MODULUS: Row<BulkModulus, Required> = "bulk_modulus", BulkModulus, Required;
    /// First and last time of the test that the series was fitted to, if known.
    MEASURED: Row<Array<Number>, Optional> =
        "measured", pair(quantity(Time).above_zero().or_else(WINDOW), WINDOW), Optional;
}

rows! { BULK_KEYS:
    /// Equilibrium bulk modulus.
    BULK_EQUILIBRIUM: Row<Number, Required> = "equilibrium", quantity(Stress).above_zero(), Required;
    /// The branches of the series.
    BULK_BRANCHES: Row<Tables, Required> = "branches", branches(&RELAXATION_BRANCH), Required;
}

rows! { _:
    /// A material that comes with the program; `contact-dma material list` lists them.
    LIBRARY: Row<Text, Required> = "library", Text, Required;
    /// Poisson ratio in place of that of the library.
    LIBRARY_POISSON_RATIO: Row<Number, Optional> = "poisson_ratio", key::POISSON_RATIO, Optional;
}

rows! { _:
    /// Generalised Maxwell model (Prony series of the relaxation modulus).
    RELAXATION: Row<Table, Required> = "relaxation", Table(&RELAXATION_TABLE), Required;
    /// Generalised Kelvin model (series of the creep compliance).
    CREEP: Row<Table, Required> = "creep", Table(&CREEP_TABLE), Required;
    /// Spring and dashpot in series: a fluid, for single histories only.
    MAXWELL: Row<Table, Required> = "maxwell", Table(&MAXWELL_TABLE), Required;
    /// Spring in series with a Kelvin unit: the standard linear solid.
    ZENER: Row<Table, Required> = "zener", Table(&ZENER_TABLE), Required;
    /// Spring and dashpot in parallel; without instantaneous compliance it cannot make contact, so only `material show` accepts it.
    KELVIN_VOIGT: Row<Table, Required> = "kelvin_voigt", Table(&KELVIN_VOIGT_TABLE), Required;
    /// An elastic body, without losses.
    ELASTIC_BODY: Row<Table, Required> = "elastic", Table(&ELASTIC_TABLE), Required;
    /// Springpot, fractional Zener or fractional Maxwell model, represented by a Prony series over a band.
    FRACTIONAL: Row<Table, Required> = "fractional", Table(&fractional::TABLE), Required;
    /// Storage and loss modulus over frequency, measured at one or several temperatures, from which a master curve is made and a
    /// series fitted.
    DYNAMIC: Row<Table, Required> = "dynamic", Table(&DYNAMIC_TABLE), Required;
    /// Series of the relaxation modulus at one or several temperatures, as from a fit to dynamic data.
    ISOTHERMS: Row<Tables, Required> =
        "isotherm", Tables { rows: &ISOTHERM, most: MOST_ISOTHERMS, instead: "" }, Required;
    /// Temperature of the body, for a material that is known at several temperatures. Left out: the reference temperature of the
    /// dynamic data, or the temperature of the only isotherm or of the library's data.
    TEMPERATURE: Row<Number, Optional> = "temperature", quantity(Temperature).above_zero(), Optional;
    /// Measured creep compliance or relaxation modulus.
    MEASURED_TABLE: Row<Table, Required> = "table", Table(&TABLE), Required;
}

rows! { _:
    /// Other series that fit the same data: a relaxation series beside `relaxation`, a creep series beside `creep`, without their
    /// `modulus` or `compliance`. What they change is reported as an uncertainty.
    RELAXATION_ALTERNATIVE: Row<Tables, Optional> =
        "alternative", alternatives(&RELAXATION_SERIES), Optional;
    /// Other series that fit the same data: a relaxation series beside `relaxation`, a creep series beside `creep`, without their
    /// `modulus` or `compliance`. What they change is reported as an uncertainty.
    CREEP_ALTERNATIVE: Row<Tables, Optional> = "alternative", alternatives(&CREEP_SERIES), Optional;
}

const fn alternatives(rows: &'static Rows) -> Tables {
    Tables {
        rows,
        most: MOST_ALTERNATIVES,
        instead: "",
    }
}

rows! { ELASTIC_KEYS:
    /// Young's modulus.
    YOUNG: Row<Number, Required> = "modulus", quantity(Stress).above_zero(), Required;
    /// Poisson ratio.
    ELASTIC_POISSON_RATIO: Row<Number, Required> = "poisson_ratio", key::POISSON_RATIO, Required;
}

rows! { _:
    /// Generalised Maxwell model (Prony series of the relaxation modulus).
    INDENTER_RELAXATION: Row<Table, Required> = "relaxation", Table(&INDENTER_RELAXATION_TABLE), Required;
}

rows! { _:
    /// Series of the relaxation modulus at one temperature or at several.
    INDENTER_ISOTHERMS: Row<Tables, Required> =
        "isotherm", Tables { rows: &INDENTER_ISOTHERM, most: MOST_ISOTHERMS, instead: "" }, Required;
}

static INDENTER_ISOTHERM: Rows = table(
    " The series at one temperature.",
    &[
        &ISOTHERM_TEMPERATURE,
        &ISOTHERM_WLF,
        &ISOTHERM_ACTIVATION_ENERGY,
        &MEASURED,
        &MEASURED_TEMPERATURES,
        &MODULUS,
        &EQUILIBRIUM,
        &RELAXATION_BRANCHES,
    ],
);

static INDENTER_RELAXATION_TABLE: Rows = table(
    " E(t) = equilibrium + sum of modulus exp(-t / time).",
    &[&MODULUS, &EQUILIBRIUM, &RELAXATION_BRANCHES],
);

static ELASTIC_TABLE: Rows = table(" An elastic body.", ELASTIC_KEYS);

/// How much a form of material gives in to pressure: it says so itself, or a key beside it does.
const SAYS_ITSELF: List = &[];
const WITH_POISSON_RATIO: List = &[&POISSON_RATIO];
const EITHER: List = &[&POISSON_RATIO, &BULK_MODULUS];

/// What an indenter may be made of.
pub(in crate::input) static INDENTER_MATERIAL: Rows = Rows {
    means: " What the indenter is made of, where it is not rigid: exactly one of `library`, `elastic`, `relaxation`, `creep`, `zener` and `isotherm`.",
    keys: MATERIAL_KEYS,
    block: &[],
    others: Others::OneListAnd(&[
        (
            &[&LIBRARY, &LIBRARY_POISSON_RATIO, &TEMPERATURE],
            SAYS_ITSELF,
        ),
        (&[&ELASTIC_BODY], SAYS_ITSELF),
        (&[&INDENTER_RELAXATION, &MEASURED], EITHER),
        (&[&CREEP, &MEASURED], EITHER),
        (&[&ZENER, &MEASURED], EITHER),
        (&[&INDENTER_ISOTHERMS, &TEMPERATURE], WITH_POISSON_RATIO),
    ]),
};

pub(super) static MATERIAL: Rows = Rows {
    means: " Material of the half-space: exactly one of `library`, `elastic`, `relaxation`, `creep`, `maxwell`, `zener`, `kelvin_voigt`, \
            `fractional`, `isotherm`, `dynamic` and `table`.",
    keys: MATERIAL_KEYS,
    block: &[],
    others: Others::OneListAnd(&[
        (
            &[&LIBRARY, &LIBRARY_POISSON_RATIO, &TEMPERATURE],
            SAYS_ITSELF,
        ),
        (&[&ELASTIC_BODY], SAYS_ITSELF),
        (&[&RELAXATION, &MEASURED, &RELAXATION_ALTERNATIVE], EITHER),
        (&[&CREEP, &MEASURED, &CREEP_ALTERNATIVE], EITHER),
        (&[&MAXWELL, &MEASURED], EITHER),
        (&[&ZENER, &MEASURED], EITHER),
        (&[&KELVIN_VOIGT, &MEASURED], WITH_POISSON_RATIO),
        (&[&FRACTIONAL], EITHER),
        (&[&ISOTHERMS, &TEMPERATURE], WITH_POISSON_RATIO),
        (&[&DYNAMIC, &TEMPERATURE], WITH_POISSON_RATIO),
        (&[&MEASURED_TABLE], EITHER),
    ]),
};

const fn branches(rows: &'static Rows) -> Tables {
    Tables {
        rows,
        most: MOST_BRANCHES,
        instead: "",
    }
}

rows! { RELAXATION_KEYS:
    /// Whether the moduli are Young's or shear moduli.
    MODULUS: Row<Choice<ModulusKind>, Required> = "modulus", Choice(ModulusKind::NAMES), Required;
    /// Equilibrium modulus; zero for a fluid.
    EQUILIBRIUM: Row<Number, Required> = "equilibrium", quantity(Stress).not_negative(), Required;
    /// The branches of the series.
    RELAXATION_BRANCHES: Row<Tables, Required> = "branches", branches(&RELAXATION_BRANCH), Required;
    /// Series fitted to random realisations of the noise in the data. The spread of the losses computed with them is the uncertainty of
    /// the loss due to the material.
    REPLICAS: Row<Tables, Optional> = "replicas", replicas(), Optional;
}

const fn replicas() -> Tables {
    Tables {
        rows: &REPLICA,
        most: MOST_REPLICAS,
        instead: "",
    }
}

rows! { REPLICA_KEYS:
    /// Equilibrium modulus.
    REPLICA_EQUILIBRIUM: Row<Number, Required> = "equilibrium", quantity(Stress).not_negative(), Required;
    /// Moduli of the branches.
    REPLICA_MODULI: Row<Array<Number>, Required> =
        "moduli", list(quantity(Stress).above_zero().or_else(NO_BRANCH)), Required;
    /// Relaxation times of the branches.
    REPLICA_TIMES: Row<Array<Number>, Required> =
        "times", list(quantity(Time).above_zero().or_else(NO_BRANCH)), Required;
}

static REPLICA: Rows = table(" A series, its branches as two lists.", REPLICA_KEYS);

rows! { _:
    /// Temperature at which the series holds.
    ISOTHERM_TEMPERATURE: Row<Number, Required> =
        "temperature", quantity(Temperature).above_zero(), Required;
    /// Shift of the times of the series with temperature: c1 and c2 (K) of the law of Williams, Landel and Ferry about its own
    /// temperature, log10 a_T = -c1 (T - T0)/(c2 + T - T0).
    ISOTHERM_WLF: Row<Array<Number>, Optional> =
        "wlf", Array { entries: 2..=2, ..list(number("8.86").above_zero()) }, Optional;
    /// The same by the law of Arrhenius, with this activation energy in J/mol.
    ISOTHERM_ACTIVATION_ENERGY: Row<Number, Optional> = "activation_energy", number("120e3").above_zero(), Optional;
}

const COLDEST_FIRST: &str =
    "write the lowest temperature first: measured_temperatures = [\"-10 °C\", \"80 °C\"]";

rows! { _:
    /// Lowest and highest temperature of the isotherms that the series and its shift come from, if known; a sweep or history at a
    /// temperature outside is warned of.
    MEASURED_TEMPERATURES: Row<Array<Number>, Optional> =
        "measured_temperatures", pair(quantity(Temperature).above_zero().or_else(COLDEST_FIRST), COLDEST_FIRST), Optional;
}

static ISOTHERM: Rows = table(
    " The series at one temperature.",
    &[
        &ISOTHERM_TEMPERATURE,
        &ISOTHERM_WLF,
        &ISOTHERM_ACTIVATION_ENERGY,
        &MEASURED,
        &MEASURED_TEMPERATURES,
        &MODULUS,
        &EQUILIBRIUM,
        &RELAXATION_BRANCHES,
        &REPLICAS,
    ],
);

static RELAXATION_TABLE: Rows = table(
    " E(t) = equilibrium + sum of modulus exp(-t / time).",
    RELAXATION_KEYS,
);
static RELAXATION_SERIES: Rows = table(
    " Another series that fits the same data.",
    &[&EQUILIBRIUM, &RELAXATION_BRANCHES],
);

rows! { _:
    /// Modulus of the branch.
    BRANCH_MODULUS: Row<Number, Required> =
        "modulus", quantity(Stress).above_zero().or_else(NO_BRANCH), Required;
    /// Creep compliance of the branch.
    BRANCH_COMPLIANCE: Row<Number, Required> =
        "compliance", quantity(Compliance).above_zero().or_else(NO_BRANCH), Required;
    /// Relaxation time, or retardation time of a creep series.
    BRANCH_TIME: Row<Number, Required> =
        "time", quantity(Time).above_zero().or_else(NO_BRANCH), Required;
}

static RELAXATION_BRANCH: Rows = table(" A branch.", &[&BRANCH_MODULUS, &BRANCH_TIME]);
static CREEP_BRANCH: Rows = table(" A branch.", &[&BRANCH_COMPLIANCE, &BRANCH_TIME]);

rows! { CREEP_KEYS:
    /// Whether the compliances are uniaxial or in shear.
    COMPLIANCE: Row<Choice<ModulusKind>, Required> = "compliance", Choice(ModulusKind::NAMES), Required;
    /// Instantaneous compliance.
    INSTANTANEOUS: Row<Number, Required> =
        "instantaneous", quantity(Compliance).not_negative(), Required;
    /// Viscosity of a fluid, which adds t / viscosity to the compliance.
    VISCOSITY: Row<Number, Optional> =
        "viscosity", quantity(Viscosity).above_zero().or_else("leave the key out for a solid"), Optional;
    /// The branches of the series.
    CREEP_BRANCHES: Row<Tables, Required> = "branches", branches(&CREEP_BRANCH), Required;
}

static CREEP_TABLE: Rows = table(
    " D(t) = instantaneous + sum of compliance (1 - exp(-t / time)) + t / viscosity.",
    CREEP_KEYS,
);
static CREEP_SERIES: Rows = table(
    " Another series that fits the same data.",
    &[&INSTANTANEOUS, &VISCOSITY, &CREEP_BRANCHES],
);

const ELEMENT: Number = quantity(Stress).above_zero().or_else(ELASTIC);

rows! { _:
    /// Shear modulus of the spring.
    MAXWELL_MODULUS: Row<Number, Required> = "modulus", ELEMENT, Required;
    /// Shear modulus of the spring.
    SPRING: Row<Number, Required> = "spring", ELEMENT, Required;
    /// Shear modulus of the spring in the Kelvin unit.
    KELVIN_SPRING: Row<Number, Required> = "kelvin_spring", ELEMENT, Required;
    /// Viscosity over modulus: relaxation time of a Maxwell body, retardation time of a Kelvin unit.
    ELEMENT_TIME: Row<Number, Required> =
        "time", quantity(Time).above_zero().or_else(ELASTIC), Required;
}

static MAXWELL_TABLE: Rows = table(
    " Spring and dashpot in series.",
    &[&MAXWELL_MODULUS, &ELEMENT_TIME],
);
static ZENER_TABLE: Rows = table(
    " Spring in series with a Kelvin unit.",
    &[&SPRING, &KELVIN_SPRING, &ELEMENT_TIME],
);
static KELVIN_VOIGT_TABLE: Rows = table(
    " Spring and dashpot in parallel.",
    &[&SPRING, &ELEMENT_TIME],
);

rows! { TABLE_KEYS:
    /// What the data are of.
    QUANTITY: Row<Choice<MaterialFunction>, Required> = "quantity", Choice(MaterialFunction::NAMES), Required;
    /// Whether they are uniaxial or in shear.
    TABLE_MODULUS: Row<Choice<ModulusKind>, Required> = "modulus", Choice(ModulusKind::NAMES), Required;
    /// `fit`: a series is fitted and its misfit reported with the results; `direct` (single histories only): the samples are used directly.
    EVALUATION: Row<Choice<Evaluation>, Or<Evaluation>> =
        "evaluation", Choice(Evaluation::NAMES), Or(Evaluation::Fit);
    /// Whether to fit a fluid; left out: as the data indicate, a solid if they do not decide.
    FLOW: Row<Boolean, Optional> = "flow", Boolean, Optional;
}

rows! { _:
    /// CSV file with the columns `time_s` and `creep_compliance_per_pa` or `relaxation_modulus_pa`, or in other units.
    FILE: Row<Text, Required> = "file", Text, Required;
    /// Times of the samples, in place of a file.
    TIMES: Row<Array<Number>, Required> = "times", list(quantity(Time)), Required;
    /// Their values.
    VALUES: Row<Array<Dependent>, Required> =
        "values", list(Dependent { dimensions: &[Compliance, Stress], limits: Limits::NONE }), Required;
}

static TABLE: Rows = Rows {
    means: " Measured data: a `file`, or `times` and `values`.",
    keys: TABLE_KEYS,
    block: &[],
    others: Others::OneList(&[&[&FILE], &[&TIMES, &VALUES]]),
};

rows! { DYNAMIC_KEYS:
    /// Format of the files; left out: detected from their content.
    FORMAT: Row<Choice<DynamicFormat>, Optional> = "format", Choice(&FORMATS), Optional;
    /// Whether the moduli are Young's or shear moduli.
    DYNAMIC_MODULUS: Row<Choice<ModulusKind>, Required> = "modulus", Choice(ModulusKind::NAMES), Required;
    /// Temperature of the master curve; left out: that of the middle isotherm.
    REFERENCE_TEMPERATURE: Row<Number, Optional> =
        "reference_temperature", quantity(Temperature).above_zero(), Optional;
    /// How isotherms are shifted onto one curve: each individually (`free`, the default), by a law fitted to the data, not at all, or by
    /// factors from a file.
    SHIFT: Row<Shift, Optional> = "shift", Shift, Optional;
    /// Whether they are also shifted vertically, along the moduli.
    VERTICAL_SHIFT: Row<Boolean, Or<bool>> = "vertical_shift", Boolean, Or(false);
    /// Branches of the series: a number, or `auto` (the default): as many as the data resolve.
    DYNAMIC_BRANCHES: Row<Branches, Optional> = "branches", Branches(1..=MOST_BRANCHES), Optional;
    /// Number of replicas of the material for the uncertainty of the results due to the noise of the data; 50 determine it to about
    /// 10 %.
    DYNAMIC_REPLICAS: Row<Integer, Or<usize>> = "replicas", Integer(0..=MOST_REPLICAS), Or(0);
    /// Seed of the random numbers for the replicas.
    SEED: Row<Integer, Or<usize>> = "seed", Integer(0..=MOST_SEED), Or(1);
}

/// The largest integer of TOML.
const MOST_SEED: usize = i64::MAX as usize;

rows! { _:
    /// File of an instrument, or a table.
    DYNAMIC_FILE: Row<Text, Required> = "file", Text, Required;
    /// Several of one specimen.
    DYNAMIC_FILES: Row<Array<Text>, Required> = "files", list(Text), Required;
}

static DYNAMIC_TABLE: Rows = Rows {
    means: " Measured storage and loss modulus: a `file`, or `files`.",
    keys: DYNAMIC_KEYS,
    block: &[],
    others: Others::OneList(&[&[&DYNAMIC_FILE], &[&DYNAMIC_FILES]]),
};

rows! { SHIFT_KEYS:
    /// CSV file with the columns `temperature_c` and `log10_a_t`.
    SHIFT_FILE: Row<Text, Required> = "file", Text, Required;
}
