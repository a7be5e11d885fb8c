//! What the columns of dynamic tests are called, in the languages of instruments, and what their units are.
//!
//! A name stands alone (`E'`), with its unit (`E' [MPa]`, `G'' (Pa)`, `Frequency / Hz`, `f/Hz`, `Loss modulus, MPa`), or joined to it
//! by `_` (`storage_modulus_mpa`, `omega_rad_s`, `temperature_c`). Case and dots do not matter, but that `T` is a temperature and `t`
//! a time, `f` a frequency and `F` a force.

use std::f64::consts::TAU;

use crate::input::data_file::{split_unit, unit_of_suffix};
use crate::material::ModulusKind;
use crate::quantity::{self, Dimension, ZERO_CELSIUS_K};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Frequency,
    AngularFrequency,
    Storage,
    Loss,
    /// Magnitude of the complex modulus.
    Complex,
    TanDelta,
    PhaseAngle,
    Temperature,
    /// Number of the isotherm.
    Set,
    StorageError,
    LossError,
}

impl Role {
    /// What it holds, in the plural.
    pub(super) fn what(self) -> &'static str {
        match self {
            Self::Frequency => "frequencies",
            Self::AngularFrequency => "angular frequencies",
            Self::Storage => "storage moduli",
            Self::Loss => "loss moduli",
            Self::Complex => "magnitudes of the complex modulus",
            Self::TanDelta => "loss tangents",
            Self::PhaseAngle => "phase angles",
            Self::Temperature => "temperatures",
            Self::Set => "isotherms",
            Self::StorageError => "errors of the storage modulus",
            Self::LossError => "errors of the loss modulus",
        }
    }

    /// Units that it may have, for messages.
    fn units(self) -> &'static str {
        match self {
            Self::Frequency => "Hz",
            Self::AngularFrequency => "rad/s",
            Self::Temperature => "°C",
            Self::PhaseAngle => "deg",
            Self::StorageError | Self::LossError => "%",
            _ => "MPa",
        }
    }

    fn dimension(self) -> Option<Dimension> {
        match self {
            Self::Frequency => Some(Dimension::Frequency),
            Self::AngularFrequency => Some(Dimension::AngularFrequency),
            Self::Temperature => Some(Dimension::Temperature),
            Self::PhaseAngle => Some(Dimension::Angle),
            Self::TanDelta | Self::Set => None,
            _ => Some(Dimension::Stress),
        }
    }

    /// Whether a column without a unit can be read: the name of an angular frequency says that it is in rad/s.
    fn has_own_unit(self) -> bool {
        matches!(self, Self::AngularFrequency | Self::TanDelta | Self::Set)
    }
}

/// Names without units, blanks for `_` and `-`, without dots, in lower case.
const NAMES: [(Role, &[&str]); 9] = [
    (
        Role::Frequency,
        &[
            "f",
            "freq",
            "frequency",
            "test frequency",
            "test freq",
            "oscillation frequency",
            "dynamic frequency",
            "dyn freq",
            "dynamic freq",
            "ref freq",
            "reference frequency",
            "drive frequency",
            "drive freq",
            "excitation frequency",
            "loading frequency",
            "frequency average",
            "frequenz",
            "messfrequenz",
            "prüffrequenz",
            "fréquence",
            "frecuencia",
            "frequenza",
            "frequência",
            "频率",
            "頻率",
            "周波数",
            "주파수",
        ],
    ),
    (
        Role::AngularFrequency,
        &[
            "angular frequency",
            "ang frequency",
            "ang freq",
            "angular freq",
            "angfreq",
            "circular frequency",
            "radian frequency",
            "omega",
            "w",
            "ω",
            "kreisfrequenz",
            "winkelfrequenz",
            "pulsation",
            "fréquence angulaire",
            "frecuencia angular",
            "frequenza angolare",
            "frequência angular",
            "角频率",
            "角頻率",
            "角周波数",
            "각주파수",
        ],
    ),
    (
        Role::Storage,
        &[
            "e'",
            "g'",
            "m'",
            "e stor",
            "g stor",
            "e storage",
            "g storage",
            "estor",
            "gstor",
            "e prime",
            "g prime",
            "ep",
            "gp",
            "e real",
            "g real",
            "storage modulus",
            "storage mod",
            "modulus storage",
            "speichermodul",
            "module de conservation",
            "module de stockage",
            "module élastique",
            "módulo de almacenamiento",
            "modulo conservativo",
            "módulo de armazenamento",
            "储能模量",
            "儲能模數",
            "貯蔵弾性率",
            "저장 탄성률",
            "저장탄성률",
        ],
    ),
    (
        Role::Loss,
        &[
            "e''",
            "g''",
            "m''",
            "e loss",
            "g loss",
            "eloss",
            "gloss",
            "e double prime",
            "g double prime",
            "epp",
            "gpp",
            "e imag",
            "g imag",
            "loss modulus",
            "loss mod",
            "modulus loss",
            "verlustmodul",
            "module de perte",
            "module visqueux",
            "módulo de pérdida",
            "modulo dissipativo",
            "módulo de perda",
            "损耗模量",
            "損耗模數",
            "損失弾性率",
            "손실 탄성률",
            "손실탄성률",
        ],
    ),
    (
        Role::Complex,
        &[
            "|e*|",
            "|g*|",
            "e*",
            "g*",
            "complex modulus",
            "komplexer modul",
            "module complexe",
            "dynamic modulus",
            "复数模量",
        ],
    ),
    (
        Role::TanDelta,
        &[
            "tan delta",
            "tan(delta)",
            "tandelta",
            "tan d",
            "tan(d)",
            "tan δ",
            "tan(δ)",
            "tanδ",
            "loss tangent",
            "loss factor",
            "damping factor",
            "verlustfaktor",
            "dämpfungsfaktor",
            "facteur d'amortissement",
            "facteur de perte",
            "factor de pérdida",
            "factor de amortiguamiento",
            "损耗因子",
        ],
    ),
    (
        Role::PhaseAngle,
        &[
            "phase angle",
            "phase",
            "delta",
            "δ",
            "phasenwinkel",
            "phasenverschiebungswinkel",
            "angle de phase",
            "相位角",
        ],
    ),
    (
        Role::Temperature,
        &[
            "temperature",
            "temp",
            "t",
            "sample temperature",
            "sample temp",
            "temperature sample",
            "temperatur",
            "probentemperatur",
            "ts",
            "ϑ",
            "θ",
            "température",
            "temperatura",
            "温度",
            "溫度",
            "온도",
        ],
    ),
    (
        Role::Set,
        &[
            "set",
            "set number",
            "isotherm",
            "isotherm number",
            "set no",
            "sweep number",
        ],
    ),
];

/// Words that make the name of a modulus one of its errors.
const ERROR_WORDS: [&str; 10] = [
    "error",
    "err",
    "std",
    "stderr",
    "sd",
    "sigma",
    "uncertainty",
    "fehler",
    "unc",
    "stddev",
];

/// A column that was recognised.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named {
    pub(super) role: Role,
    /// Where its name says which modulus it is.
    pub(super) kind: Option<ModulusKind>,
    /// Where the header gives its unit.
    pub(super) unit: Option<String>,
}

/// What a cell of a header names.
pub(super) fn recognise(cell: &str) -> Option<Named> {
    if cell.is_empty() || cell.len() > 100 || cell.parse::<f64>().is_ok() {
        return None;
    }
    let trimmed = cell.trim();
    let bracketed = split_unit(trimmed);
    let other = |mark: &str| {
        trimmed
            .split_once(mark)
            .map(|(name, unit)| (name, Some(unit.trim())))
    };
    let sure = [Some((trimmed, None)), Some(bracketed)]
        .into_iter()
        .flatten();
    let sure = sure.filter_map(|(name, unit)| named(name.trim(), unit.map(bare)));
    // What stands behind other signs may be anything: `G*/sin(delta)`; what stands in brackets too, but of moduli and frequencies it
    // had better be a unit.
    let others = [other("/"), other(", "), other(" in ")]
        .into_iter()
        .flatten();
    let others = others.filter_map(|(name, unit)| named(name.trim(), unit.map(bare)));
    let fits = |named: &Named| scale(named.role, named.unit.as_deref()).is_ok();
    let matters = |named: &Named| {
        matches!(
            named.role,
            Role::Frequency | Role::AngularFrequency | Role::Storage | Role::Loss
        )
    };
    let sure = sure.filter(|named| named.unit.is_none() || matters(named) || fits(named));
    sure.chain(others.filter(fits)).next()
}

/// A unit without brackets.
pub(super) fn bare(unit: &str) -> &str {
    unit.trim_matches(['[', ']', '(', ')', ' ', '\u{a0}'])
}

fn named(name: &str, unit: Option<&str>) -> Option<Named> {
    if matches!(name.split(['_', ' ']).next(), Some("t" | "F" | "W")) {
        return None;
    }
    let words = plain(name);
    let found = |words: &str, unit: Option<String>| {
        let (role, kind) = role(words)?;
        Some(Named { role, kind, unit })
    };
    let whole = found(&words, unit.map(str::to_owned));
    if whole.is_some() || unit.is_some() {
        return whole;
    }
    // A unit behind the name, of up to four words.
    words.match_indices(' ').rev().take(4).find_map(|(at, _)| {
        let (role, _) = role(&words[..at])?;
        found(&words[..at], Some(suffix(&words[at + 1..], role)?))
    })
}

/// A name as the table of names has it.
fn plain(name: &str) -> String {
    let primes = name.replace(['\u{2033}', '\u{201c}', '\u{201d}', '"'], "''");
    let primes = primes.replace(['\u{2032}', '\u{2019}', '\u{2018}', '`', '\u{b4}'], "'");
    let spaced = primes
        .to_lowercase()
        .replace(['_', '-', '.', '\u{a0}'], " ");
    spaced.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn role(words: &str) -> Option<(Role, Option<ModulusKind>)> {
    let is_error = |word: &str| ERROR_WORDS.contains(&word);
    if words.split(' ').any(is_error) {
        let left: Vec<&str> = words
            .split(' ')
            .filter(|w| !is_error(w) && *w != "standard" && *w != "of")
            .collect();
        return match role(&left.join(" "))? {
            (Role::Storage, kind) => Some((Role::StorageError, kind)),
            (Role::Loss, kind) => Some((Role::LossError, kind)),
            _ => None,
        };
    }
    known(words).or_else(|| {
        // A word and its symbol: `Storage modulus E'`, `T Temperature`.
        let (first, rest) = words.split_once(' ')?;
        let (start, last) = words.rsplit_once(' ')?;
        [(first, rest), (start, last)]
            .into_iter()
            .find_map(|(a, b)| {
                let (a, b) = (known(a)?, known(b)?);
                (a.0 == b.0).then_some((a.0, a.1.or(b.1)))
            })
    })
}

/// What one of the names of the table means.
fn known(words: &str) -> Option<(Role, Option<ModulusKind>)> {
    let (kinds, neutral) = kind_of(words);
    NAMES.iter().find_map(|(role, names)| {
        let is_modulus = matches!(role, Role::Storage | Role::Loss | Role::Complex);
        if names.contains(&words) {
            return Some((*role, kinds.filter(|_| is_modulus)));
        }
        (is_modulus && names.contains(&neutral.as_str())).then_some((*role, kinds))
    })
}

/// Which modulus a name speaks of, and the name without that.
fn kind_of(words: &str) -> (Option<ModulusKind>, String) {
    let of = |word: &str| match word {
        "shear" | "schub" => Some(ModulusKind::Shear),
        "tensile" | "young's" | "youngs" | "longitudinal" | "axial" | "elongational"
        | "bending" => Some(ModulusKind::Longitudinal),
        _ => None,
    };
    let letter = words.trim_start_matches('|');
    let lettered = |letter_of: char| {
        let next = letter.strip_prefix(letter_of)?.chars().next()?;
        let is_short = matches!(next, '\'' | '*' | ' ' | 'p')
            || ["stor", "loss"].iter().any(|w| letter[1..].starts_with(w));
        is_short.then_some(())
    };
    let kind = words.split(' ').find_map(of);
    let kind = kind.or_else(|| lettered('g').map(|()| ModulusKind::Shear));
    let kind = kind.or_else(|| lettered('e').map(|()| ModulusKind::Longitudinal));
    let left: Vec<&str> = words.split(' ').filter(|word| of(word).is_none()).collect();
    (kind, left.join(" "))
}

/// The unit that the words behind a name are.
fn suffix(words: &str, role: Role) -> Option<String> {
    let known = match (role, words) {
        (Role::Temperature, "c" | "°c" | "degc" | "deg c" | "celsius") => Some("°C"),
        (Role::Temperature, "k" | "kelvin") => Some("K"),
        (
            Role::Frequency | Role::AngularFrequency,
            "rad s" | "rads" | "rad per s" | "rad per sec" | "rad/s" | "rad s 1",
        ) => Some("rad/s"),
        (Role::StorageError | Role::LossError, "percent" | "pct" | "%" | "rel percent") => {
            Some("%")
        }
        (Role::PhaseAngle, "deg" | "degree" | "degrees" | "°") => Some("deg"),
        _ => None,
    };
    match known {
        Some(unit) => Some(unit.to_owned()),
        None => unit_of_suffix(&words.replace(' ', "_"), role.dimension()?),
    }
}

/// From the numbers of a column to SI: `zero + factor * number`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    pub(super) factor: f64,
    pub(super) zero: f64,
    /// Whether the numbers are shares of the modulus.
    pub(super) is_relative: bool,
}

impl Scale {
    /// Of numbers that are in SI units.
    pub(super) const ONE: Self = times(1.0);
}

const fn times(factor: f64) -> Scale {
    Scale {
        factor,
        zero: 0.0,
        is_relative: false,
    }
}

/// Whether a text is a unit, of whatever.
pub(super) fn is_unit(text: &str) -> bool {
    let unit = bare(text);
    let known = ["%", "C", "-", "1", "K", "°"].contains(&unit);
    let read = quantity::parse(&format!("1 {}", spelt(unit)), Dimension::Time);
    known
        || matches!(
            read,
            Ok(_) | Err(quantity::QuantityError::WrongDimension { .. })
        )
}

/// A unit as [`quantity`] spells it.
fn spelt(unit: &str) -> String {
    let unit = unit
        .replace("sec", "s")
        .replace(['\u{b7}', '\u{22c5}'], " ");
    match unit.as_str() {
        "rad.s-1" | "rad s-1" | "rad.s^-1" | "rad s⁻¹" | "rad s^-1" | "rad/ s" | "rads-1"
        | "r/s" => "rad/s".to_owned(),
        "Hertz" | "hertz" | "HZ" | "hz" => "Hz".to_owned(),
        "s-1" | "s^-1" | "s⁻¹" | "1/ s" => "1/s".to_owned(),
        "PA" | "pa" | "Pascal" => "Pa".to_owned(),
        "KPa" | "kpa" => "kPa".to_owned(),
        "Mpa" | "MPA" => "MPa".to_owned(),
        "Gpa" | "GPA" => "GPa".to_owned(),
        "N/mm2" => "N/mm^2".to_owned(),
        "N/m2" => "N/m^2".to_owned(),
        _ => unit,
    }
}

/// What turns the numbers of a column into SI units.
///
/// # Errors
/// The unit is none of this column, or absent: what to write.
pub(super) fn scale(role: Role, unit: Option<&str>) -> Result<Scale, String> {
    let given = unit.map(bare).filter(|unit| !["", "-", "1"].contains(unit));
    let Some(unit) = given else {
        return match role.has_own_unit() {
            true => Ok(times(1.0)),
            false => Err(format!("write its unit, such as [{}]", role.units())),
        };
    };
    let parse = |dimension| quantity::parse(&format!("1 {}", spelt(unit)), dimension);
    match role {
        Role::TanDelta | Role::Set => Ok(times(1.0)),
        Role::Temperature => temperature(unit),
        Role::StorageError | Role::LossError if unit == "%" => Ok(Scale {
            is_relative: true,
            ..times(0.01)
        }),
        Role::Frequency => match parse(Dimension::AngularFrequency) {
            Ok(factor) => Ok(times(factor)),
            Err(_) => parse(Dimension::Frequency)
                .map(|hertz| times(TAU * hertz))
                .map_err(|error| error.to_string()),
        },
        Role::AngularFrequency if spelt(unit) == "1/s" => Ok(times(1.0)),
        Role::PhaseAngle if matches!(unit, "°" | "degrees" | "degree" | "Grad") => {
            Ok(times(TAU / 360.0))
        }
        _ if matches!(
            unit,
            "dyn/cm^2" | "dyn/cm²" | "dyne/cm^2" | "dyne/cm²" | "dyn/cm2"
        ) =>
        {
            Ok(times(0.1))
        }
        _ => parse(role.dimension().unwrap_or(Dimension::Stress))
            .map(times)
            .map_err(|error| error.to_string()),
    }
}

fn temperature(unit: &str) -> Result<Scale, String> {
    let celsius = Scale {
        zero: ZERO_CELSIUS_K,
        ..times(1.0)
    };
    let plain = unit.to_lowercase().replace([' ', '\u{ba}', '°'], "");
    match plain.as_str() {
        "c" | "degc" | "\u{2103}" | "celsius" | "degreec" | "\u{fffd}c" | "\u{c2}c" | "grdc"
        | "gradc" | "?c" => Ok(celsius),
        "k" | "kelvin" => Ok(times(1.0)),
        "f" | "degf" | "\u{2109}" | "fahrenheit" => Ok(Scale {
            zero: ZERO_CELSIUS_K - 32.0 / 1.8,
            ..times(1.0 / 1.8)
        }),
        _ => Err(format!("`{unit}` is no unit of temperature: write °C or K")),
    }
}
