//! Units as they are written beside the names of columns, and what turns numbers in them into SI units.

use std::f64::consts::TAU;

use crate::quantity::{self, Dimension, QuantityError, QuantityProblem, ZERO_CELSIUS_K};

/// From the numbers of a column to SI: `zero + factor * number`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    pub(crate) factor: f64,
    pub(crate) zero: f64,
}

impl Scale {
    /// Of numbers that are in SI units.
    pub(crate) const ONE: Self = Self::times(1.0);

    pub(crate) const fn times(factor: f64) -> Self {
        Self { factor, zero: 0.0 }
    }

    pub(super) fn of(self, number: f64) -> f64 {
        self.zero + self.factor * number
    }
}

/// A unit without brackets.
pub(crate) fn bare(unit: &str) -> &str {
    unit.trim_matches(['[', ']', '(', ')', ' ', '\u{a0}'])
}

/// A unit that is one, and no sign that there is none.
pub(crate) fn given(unit: &str) -> Option<&str> {
    Some(bare(unit)).filter(|unit| !["", "-", "1"].contains(unit))
}

/// Whether a text is a unit, of whatever.
pub(crate) fn is_unit(text: &str) -> bool {
    let unit = bare(text);
    let read = quantity::parse(&format!("1 {}", spelt(unit)), Dimension::Time);
    let is_of_another =
        |error: &QuantityError| matches!(error.problem, QuantityProblem::WrongDimension { .. });
    ["%", "C", "K", "°"].contains(&unit)
        || read.map_or_else(|error| is_of_another(&error), |_| true)
}

/// What turns numbers in this unit into SI units.
///
/// # Errors
/// It is no unit of this dimension: why.
pub(crate) fn scale(unit: &str, dimension: Dimension) -> Result<Scale, String> {
    let unit = bare(unit);
    match (dimension, spelt(unit).as_str()) {
        (Dimension::Temperature, _) => temperature(unit),
        (Dimension::Angle, "°" | "degrees" | "degree" | "Grad") => Ok(Scale::times(TAU / 360.0)),
        (Dimension::Stress, "dyn/cm^2" | "dyn/cm²" | "dyne/cm^2" | "dyne/cm²" | "dyn/cm2") => {
            Ok(Scale::times(0.1))
        }
        (_, spelt) => quantity::parse(&format!("1 {spelt}"), dimension)
            .map(Scale::times)
            .map_err(|error| error.to_string()),
    }
}

/// A unit as [`quantity`] spells it.
pub(crate) fn spelt(unit: &str) -> String {
    let unit = unit
        .replace("sec", "s")
        .replace(['\u{b7}', '\u{22c5}'], " ");
    let usual = match unit.as_str() {
        "rad.s-1" | "rad s-1" | "rad.s^-1" | "rad s⁻¹" | "rad s^-1" | "rad/ s" | "rads-1"
        | "r/s" => "rad/s",
        "Hertz" | "hertz" | "HZ" | "hz" => "Hz",
        "s-1" | "s^-1" | "s⁻¹" | "1/ s" => "1/s",
        "PA" | "pa" | "Pascal" => "Pa",
        "KPa" | "kpa" => "kPa",
        "Mpa" | "MPA" => "MPa",
        "Gpa" | "GPA" => "GPa",
        "N/mm2" => "N/mm^2",
        "N/m2" => "N/m^2",
        _ => return unit,
    };
    usual.to_owned()
}

fn temperature(unit: &str) -> Result<Scale, String> {
    let plain = unit.to_lowercase().replace([' ', '\u{ba}', '°'], "");
    let (factor, zero) = match plain.as_str() {
        "c" | "degc" | "\u{2103}" | "celsius" | "degreec" | "\u{fffd}c" | "\u{c2}c" | "grdc"
        | "gradc" | "?c" => (1.0, ZERO_CELSIUS_K),
        "k" | "kelvin" => (1.0, 0.0),
        "f" | "degf" | "\u{2109}" | "fahrenheit" => (1.0 / 1.8, ZERO_CELSIUS_K - 32.0 / 1.8),
        _ => return Err(format!("`{unit}` is no unit of temperature: write °C or K")),
    };
    Ok(Scale { factor, zero })
}

/// The absolute temperature (K) of a number in °C, whose decimals a comma may separate.
pub(crate) fn kelvin(celsius: &str) -> Option<f64> {
    let kelvin = celsius.replace(',', ".").parse::<f64>().ok()? + ZERO_CELSIUS_K;
    (kelvin.is_finite() && kelvin > 0.0).then_some(kelvin)
}

/// The units that words joined to a name may be: `per_mpa`, `ms`, `rad_per_s`, `c`.
pub(super) fn joined(suffix: &str) -> [String; 3] {
    let lower = suffix.to_lowercase();
    // A stroke parts a name from its unit.
    if suffix.starts_with('/') {
        return Default::default();
    }
    let spelt = |word: &str| {
        let usual = ["Pa", "kPa", "MPa", "GPa", "N", "kN", "Hz", "J", "V", "mV"];
        let known = usual.iter().find(|usual| usual.eq_ignore_ascii_case(word));
        known.copied().unwrap_or(word).to_owned()
    };
    let unit = |words: &str| {
        let words = words.split('_').map(spelt).collect::<Vec<_>>().join(" ");
        let unit = words.replace("per ", "/").replace(" /", "/");
        match unit.starts_with('/') {
            true => format!("1{unit}"),
            false => unit,
        }
    };
    let spoken = match lower.as_str() {
        "c" | "°c" | "degc" | "deg_c" | "celsius" => "°C",
        "k" | "kelvin" => "K",
        "rad_s" | "rads" | "rad_per_sec" | "rad_s_1" => "rad/s",
        "percent" | "pct" | "rel_percent" => "%",
        _ => "",
    };
    [spoken.to_owned(), unit(suffix), unit(&lower)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_as_instruments_write_them() {
        for (unit, dimension, factor) in [
            ("[MPa]", Dimension::Stress, 1e6),
            ("dyn/cm²", Dimension::Stress, 0.1),
            ("N/mm2", Dimension::Stress, 1e6),
            ("mPa", Dimension::Stress, 1e-3),
            ("rad s-1", Dimension::AngularFrequency, 1.0),
            ("Grad", Dimension::Angle, TAU / 360.0),
            ("msec", Dimension::Time, 1e-3),
        ] {
            let found = scale(unit, dimension).unwrap();
            assert!((found.factor / factor - 1.0).abs() < 1e-15, "{unit}");
        }
        let celsius = scale("(°C)", Dimension::Temperature).unwrap();
        assert!((celsius.of(20.0) - 293.15).abs() < 1e-12);
        let fahrenheit = scale("F", Dimension::Temperature).unwrap();
        assert!((fahrenheit.of(68.0) - 293.15).abs() < 1e-12);
        assert!(scale("s", Dimension::Stress).is_err());
        assert!(is_unit("[MPa]") && is_unit("°C") && is_unit("%"));
        assert!(!is_unit("1.5") && !is_unit("") && !is_unit("-") && !is_unit("sample"));
    }
}
