//! What the columns of dynamic tests are called, in the languages of instruments, and what they hold.
//!
//! A name stands alone (`E'`), with its unit (`E' [MPa]`, `G'' (Pa)`, `Frequency / Hz`, `f/Hz`, `Loss modulus, MPa`), or joined to it
//! by `_` (`storage_modulus_mpa`, `omega_rad_s`, `temperature_c`). Case and dots do not matter, but that `T` is a temperature and `t`
//! a time, `f` a frequency and `F` a force.

use std::f64::consts::TAU;

use crate::input::data_file::units::{self, Scale, bare, split_unit, unit_of_suffix};
use crate::material::ModulusKind;
use crate::quantity::Dimension;

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
    /// What it holds, in the plural; a unit that it may have, for messages; its dimension.
    fn facts(self) -> (&'static str, &'static str, Option<Dimension>) {
        use Dimension::{Angle, Stress};
        match self {
            Self::Frequency => ("frequencies", "Hz", Some(Dimension::Frequency)),
            Self::AngularFrequency => {
                let dimension = Some(Dimension::AngularFrequency);
                ("angular frequencies", "rad/s", dimension)
            }
            Self::Storage => ("storage moduli", "MPa", Some(Stress)),
            Self::Loss => ("loss moduli", "MPa", Some(Stress)),
            Self::Complex => ("magnitudes of the complex modulus", "MPa", Some(Stress)),
            Self::TanDelta => ("loss tangents", "", None),
            Self::PhaseAngle => ("phase angles", "deg", Some(Angle)),
            Self::Temperature => ("temperatures", "°C", Some(Dimension::Temperature)),
            Self::Set => ("isotherms", "", None),
            Self::StorageError => ("errors of the storage modulus", "%", Some(Stress)),
            Self::LossError => ("errors of the loss modulus", "%", Some(Stress)),
        }
    }

    /// What it holds, in the plural.
    pub(super) fn what(self) -> &'static str {
        self.facts().0
    }

    pub(super) fn dimension(self) -> Option<Dimension> {
        self.facts().2
    }

    /// Whether a column without a unit can be read: the name of an angular frequency says that it is in rad/s.
    pub(super) fn has_own_unit(self) -> bool {
        matches!(self, Self::AngularFrequency | Self::TanDelta | Self::Set)
    }
}

/// Names without units, blanks for `_` and `-`, without dots, in lower case; commas separate them.
const NAMES: [(Role, &str); 9] = [
    (
        Role::Frequency,
        "f, freq, frequency, test frequency, test freq, oscillation frequency, dynamic frequency, dyn freq, dynamic freq, ref \
         freq, reference frequency, drive frequency, drive freq, excitation frequency, loading frequency, frequency average, \
         frequenz, messfrequenz, prüffrequenz, fréquence, frecuencia, frequenza, frequência, 频率, 頻率, 周波数, 주파수",
    ),
    (
        Role::AngularFrequency,
        "angular frequency, ang frequency, ang freq, angular freq, angfreq, circular frequency, radian frequency, omega, w, \
         ω, kreisfrequenz, winkelfrequenz, pulsation, fréquence angulaire, frecuencia angular, frequenza angolare, frequência \
         angular, 角频率, 角頻率, 角周波数, 각주파수",
    ),
    (
        Role::Storage,
        "e', g', m', e stor, g stor, e storage, g storage, estor, gstor, e prime, g prime, ep, gp, e real, g real, storage \
         modulus, storage mod, modulus storage, speichermodul, module de conservation, module de stockage, module élastique, \
         módulo de almacenamiento, modulo conservativo, módulo de armazenamento, 储能模量, 儲能模數, 貯蔵弾性率, 저장 탄성률, 저장탄성률",
    ),
    (
        Role::Loss,
        "e'', g'', m'', e loss, g loss, eloss, gloss, e double prime, g double prime, epp, gpp, e imag, g imag, loss modulus, \
         loss mod, modulus loss, verlustmodul, module de perte, module visqueux, módulo de pérdida, modulo dissipativo, \
         módulo de perda, 损耗模量, 損耗模數, 損失弾性率, 손실 탄성률, 손실탄성률",
    ),
    (
        Role::Complex,
        "|e*|, |g*|, e*, g*, complex modulus, komplexer modul, module complexe, dynamic modulus, 复数模量",
    ),
    (
        Role::TanDelta,
        "tan delta, tan(delta), tandelta, tan d, tan(d), tan δ, tan(δ), tanδ, loss tangent, loss factor, damping factor, \
         verlustfaktor, dämpfungsfaktor, facteur d'amortissement, facteur de perte, factor de pérdida, factor de \
         amortiguamiento, 损耗因子",
    ),
    (
        Role::PhaseAngle,
        "phase angle, phase, delta, δ, phasenwinkel, phasenverschiebungswinkel, angle de phase, 相位角",
    ),
    (
        Role::Temperature,
        "temperature, temp, t, sample temperature, sample temp, temperature sample, temperatur, probentemperatur, ts, ϑ, θ, \
         température, temperatura, 温度, 溫度, 온도",
    ),
    (
        Role::Set,
        "set, set number, isotherm, isotherm number, set no, sweep number",
    ),
];

/// Words that make the name of a modulus one of its errors.
const ERROR_WORDS: &str = "error, err, std, stderr, sd, sigma, uncertainty, fehler, unc, stddev";

/// Whether a list has a name.
fn lists(names: &str, name: &str) -> bool {
    names.split(", ").any(|known| known == name)
}

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
    let sure = [(trimmed, None), bracketed].into_iter();
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

/// What turns the numbers of a column into SI units, those of a relative error into shares of the modulus.
///
/// # Errors
/// The unit is none of this column, or absent: what to write.
pub(super) fn scale(role: Role, unit: Option<&str>) -> Result<Scale, String> {
    let given = unit.map(bare).filter(|unit| !["", "-", "1"].contains(unit));
    let Some(unit) = given else {
        return match role.has_own_unit() {
            true => Ok(Scale::ONE),
            false => Err(format!("write its unit, such as [{}]", role.facts().1)),
        };
    };
    match role {
        Role::StorageError | Role::LossError if is_relative(unit) => Ok(Scale::times(0.01)),
        Role::Frequency => units::scale(unit, Dimension::AngularFrequency).or_else(|_| {
            let hertz = units::scale(unit, Dimension::Frequency)?;
            Ok(Scale::times(TAU * hertz.factor))
        }),
        Role::AngularFrequency if units::spelt(unit) == "1/s" => Ok(Scale::ONE),
        _ => role
            .dimension()
            .map_or(Ok(Scale::ONE), |dimension| units::scale(unit, dimension)),
    }
}

/// Whether errors in this unit are shares of the modulus.
pub(super) fn is_relative(unit: &str) -> bool {
    bare(unit) == "%"
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
    let is_error = |word: &str| lists(ERROR_WORDS, word);
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
        if lists(names, words) {
            return Some((*role, kinds.filter(|_| is_modulus)));
        }
        (is_modulus && lists(names, &neutral)).then_some((*role, kinds))
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
