//! What the units of columns are, as instruments write them, and what turns their numbers into SI units.

use std::f64::consts::TAU;

use super::columns::Role;
use crate::input::data_file::unit_of_suffix;
use crate::quantity::{self, Dimension, ZERO_CELSIUS_K};

/// A unit without brackets.
pub(super) fn bare(unit: &str) -> &str {
    unit.trim_matches(['[', ']', '(', ')', ' ', '\u{a0}'])
}

/// The unit that the words behind a name are.
pub(super) fn suffix(words: &str, role: Role) -> Option<String> {
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
            Ok(_)
                | Err(quantity::QuantityError {
                    problem: quantity::QuantityProblem::WrongDimension { .. },
                    ..
                })
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
            false => Err(format!("write its unit, such as [{}]", role.example_unit())),
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

/// The absolute temperature (K) of a number in °C, whose decimals a comma may separate.
pub(super) fn kelvin(celsius: &str) -> Option<f64> {
    let kelvin = celsius.replace(',', ".").parse::<f64>().ok()? + ZERO_CELSIUS_K;
    (kelvin.is_finite() && kelvin > 0.0).then_some(kelvin)
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
