//! Quantities with units: reading `"10 mm"`, writing `"3.509 µJ"`. Inside, everything is SI `f64`.
//!
//! Reading is exact: the digits and the power of ten of the prefix are turned into a double
//! together, so `"0.1 mm"` is the double nearest to 1e-4 and not the double nearest to 0.1 times
//! 1e-3. (Minutes, hours, days and degrees are no powers of ten and cost one more rounding.)
//!
//! ```
//! # extern crate contact_dma_core as contact_dma;
//! use contact_dma::quantity::{Dimension, format_human, parse};
//!
//! let radius_m = parse("10 mm", Dimension::Length)?;
//! assert_eq!(radius_m, 0.01);
//! assert_eq!(format_human(radius_m, Dimension::Length, 4), "10.00 mm");
//! assert!(parse("10 N", Dimension::Length).is_err());
//! # Ok::<(), contact_dma::quantity::QuantityError>(())
//! ```

pub mod block;
mod declare;
mod error;
mod frequency;
pub mod key;
pub mod rows;
pub mod setting;
mod units;

use std::fmt;

pub use error::{QuantityError, QuantityProblem};
pub use frequency::FrequencyUnit;
use units::{Exponents, Unit, UnitProblem};

/// The dimensions, each with its name with article, its SI unit, an example, and the powers of ten whose prefixes look natural before
/// the SI unit.
macro_rules! dimensions {
    ($($(#[$doc:meta])* $name:ident: $words:literal, $si:literal, $example:literal, $prefixes:expr;)*) => {
        /// What kind of quantity a number is.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Dimension {
            $($(#[$doc])* $name,)*
        }

        impl Dimension {
            /// Every dimension.
            pub const ALL: [Self; [$($words),*].len()] = [$(Self::$name),*];

            fn profile(self) -> (&'static str, &'static str, &'static str, (i32, i32)) {
                match self {
                    $(Self::$name => ($words, $si, $example, $prefixes),)*
                }
            }
        }
    };
}

dimensions! {
    /// m.
    Length: "a length", "m", "10 mm", (-15, 3);
    /// m^2.
    Area: "an area", "m^2", "2 mm^2", (0, 0);
    /// N.
    Force: "a force", "N", "10 N", (-15, 12);
    /// Pa; moduli and pressures too.
    Stress: "a stress or modulus", "Pa", "1973 MPa", (-15, 12);
    /// 1/Pa.
    Compliance: "a compliance", "1/Pa", "1e-4 1/MPa", (0, 0);
    /// Pa s.
    Viscosity: "a viscosity", "Pa s", "2 GPa s", (-15, 12);
    /// s. Long times stay in seconds: nobody reads kiloseconds.
    Time: "a time", "s", "8.93 s", (-15, 0);
    /// rad.
    Angle: "an angle", "rad", "90 deg", (0, 0);
    /// rad/s. Without prefixes, as those of a sweep are read beside one another.
    AngularFrequency: "an angular frequency", "rad/s", "0.5 rad/s", (0, 0);
    /// Hz. As angular frequencies.
    Frequency: "a frequency", "Hz", "10 Hz", (0, 12);
    /// J.
    Energy: "an energy", "J", "3.5 µJ", (-15, 12);
    /// K.
    Temperature: "a temperature", "K", "25 °C", (0, 0);
    /// kg.
    Mass: "a mass", "kg", "200 mg", (0, 0);
    /// N/m.
    Stiffness: "a stiffness", "N/m", "150 N/m", (0, 0);
    /// J/m^2.
    EnergyPerArea: "an energy per area", "J/m^2", "0.05 J/m^2", (0, 0);
    /// m/N.
    FrameCompliance: "a frame compliance", "m/N", "0.5 um/N", (0, 0);
    /// N s/m.
    Damping: "a damping", "N s/m", "0.02 N s/m", (0, 0);
    /// V.
    Voltage: "a voltage", "V", "0.2 V", (-15, 0);
    /// m/V.
    Sensitivity: "a deflection sensitivity", "m/V", "50 nm/V", (0, 0);
    /// m/s.
    Speed: "a speed", "m/s", "0.05 nm/s", (0, 0);
}

impl Dimension {
    /// The SI unit in which [`parse`] answers, as [`format_si`] writes it.
    pub fn si_unit(self) -> &'static str {
        self.profile().1
    }

    /// A quantity of this dimension as one would write it, for example `10 mm`.
    pub fn example(self) -> &'static str {
        self.profile().2
    }

    /// The unit of the example.
    pub fn common_unit(self) -> &'static str {
        let unit = self.example().split_once(' ');
        unit.map_or(self.si_unit(), |(_, unit)| unit)
    }

    fn exponents(self) -> Exponents {
        // Every SI unit can be read.
        Unit::read(self.si_unit()).map_or(Exponents::NONE, |unit| unit.exponents)
    }
}

impl fmt::Display for Dimension {
    /// The name with its article: `a length`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.profile().0)
    }
}

/// Reads a number with a unit, such as `10 mm`, `1973 MPa`, `1e-4 1/MPa`, `2 GPa s` or `90 deg`,
/// and gives it in the SI unit of the dimension.
///
/// A unit is a product or quotient of m, g, s, rad, N, Pa, J, Hz, K, V (with any SI prefix from f to T),
/// Å, min, h, d, deg (or °) and °C (or degC), with exponents: `N/mm^2` is as good as `MPa`. The blank before the
/// unit may be missing; both micro signs, `u`, superscripts and the Unicode minus are understood.
///
/// # Errors
/// See [`QuantityError`]: each says what was found and what to write instead.
pub fn parse(text: &str, expected: Dimension) -> Result<f64, QuantityError> {
    let text = text.trim();
    read(text, expected).map_err(|problem| QuantityError {
        text: text.to_owned(),
        expected,
        problem,
    })
}

fn read(text: &str, expected: Dimension) -> Result<f64, QuantityProblem> {
    let (number, rest) = Number::read(text).ok_or_else(|| no_number(text))?;
    if rest.trim_start().starts_with(',') {
        return Err(QuantityProblem::Comma);
    }
    if rest.trim().is_empty() {
        return Err(QuantityProblem::MissingUnit);
    }
    let unit = Unit::read(rest).map_err(|problem| match problem {
        UnitProblem::Ambiguous => QuantityProblem::AmbiguousUnit,
        UnitProblem::Unknown(unit) => QuantityProblem::UnknownUnit {
            suggestions: units::suggestions(&unit, expected.exponents()),
            unit,
        },
    })?;
    if unit.exponents != expected.exponents() {
        let found = describe(unit.exponents);
        return Err(QuantityProblem::WrongDimension { found });
    }
    let value = number.times(&unit);
    if !value.is_finite() {
        return Err(QuantityProblem::TooLarge);
    }
    if value == 0.0 && !number.is_zero() && unit.zero_k == 0.0 {
        return Err(QuantityProblem::TooSmall);
    }
    Ok(value)
}

/// A regular expression (of ECMA-262) that every text matches which [`parse`] reads as this dimension. What matches may still be
/// refused: units that are products or quotients are not looked into, nor is the size of the number.
pub fn pattern(dimension: Dimension, allow_negative: bool) -> String {
    let sign = match allow_negative {
        true => "[-+\u{2212}]?",
        false => "\\+?",
    };
    let alone = units::alone(dimension.exponents()).join("|");
    // Behind the exponent of the number, so that `e-3 N` counts as no product.
    let product = "(?![eE][-+\u{2212}]?[0-9])[^\\s0-9.].*[/^*·⋅×⁻¹²³⁴⁵⁶⁷⁸⁹0-9 ].*|/.*|1\\s*/.*";
    format!(
        "^\\s*{sign}\\s*[0-9.]*[0-9][0-9.]*([eE][-+\u{2212}]?[0-9]+)?\\s*({alone}|{product})\\s*$"
    )
}

/// The shortest number that reads back as `value`, with the SI unit: `0.01 m`, `1e-9 1/Pa`.
///
/// [`parse`] returns every finite value bit for bit.
pub fn format_si(value: f64, dimension: Dimension) -> String {
    let magnitude = value.abs();
    let unit = dimension.si_unit();
    if magnitude == 0.0 || (1e-4..1e16).contains(&magnitude) || !value.is_finite() {
        format!("{value} {unit}")
    } else {
        format!("{value:e} {unit}")
    }
}

/// A number to be read by people: rounded to `significant_digits` (1 to 17), with an SI prefix
/// where that is customary: `3.509 µJ`, `365.4 µm`, `53.63 MPa`, `8.44e-3 rad/s`.
pub fn format_human(value: f64, dimension: Dimension, significant_digits: usize) -> String {
    let (_, si_unit, _, (lowest, highest)) = dimension.profile();
    if value == 0.0 || !value.is_finite() {
        return format!("{value} {}", si_unit);
    }
    let digits = significant_digits.clamp(1, 17);
    let scientific = format!("{value:.*e}", digits - 1);
    // Rust writes every finite number as mantissa, e, exponent; the fallback is never needed.
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let power = (exponent.div_euclid(3) * 3).clamp(lowest, highest);
    let shift = exponent - power;
    // Fixed notation from 0.01 to below a million, as in print.
    if (-2..6).contains(&shift) {
        let prefix = units::prefix_symbol(power);
        format!("{} {prefix}{}", shifted(mantissa, shift), si_unit)
    } else {
        format!("{scientific} {}", si_unit)
    }
}

/// The same within a sentence: `8.44 × 10⁻³ rad/s`.
pub fn format_prose(value: f64, dimension: Dimension, significant_digits: usize) -> String {
    let human = format_human(value, dimension, significant_digits);
    let power = |(number, unit): (&str, &str)| {
        let (mantissa, exponent) = number.split_once('e')?;
        let exponent = superscript(exponent.parse().ok()?);
        Some(format!("{mantissa} × 10{exponent} {unit}"))
    };
    human.split_once(' ').and_then(power).unwrap_or(human)
}

/// A whole number raised: `⁻³`.
pub fn superscript(exponent: i32) -> String {
    let digit = |c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(c.to_digit(10)? as usize);
    let digits = exponent.to_string();
    digits.chars().map(|c| digit(c).unwrap_or('⁻')).collect()
}

/// Absolute temperature of zero degrees Celsius (K).
pub const ZERO_CELSIUS_K: f64 = 273.15;

/// A temperature (K) as people read it, to a tenth of a degree: `25 °C`, `-49.9 °C`.
pub fn celsius(temperature_k: f64) -> String {
    // Adding zero takes the sign off a zero.
    let tenths = (10.0 * (temperature_k - ZERO_CELSIUS_K)).round() + 0.0;
    format!("{} °C", tenths / 10.0)
}

/// `mantissa` (one digit before the point) times ten to the power `shift`, in fixed notation.
fn shifted(mantissa: &str, shift: i32) -> String {
    let (sign, magnitude) = mantissa.split_at(usize::from(mantissa.starts_with('-')));
    let digits = magnitude.replace('.', "");
    let Ok(places) = usize::try_from(shift) else {
        let zeros = "0".repeat(shift.unsigned_abs() as usize - 1);
        return format!("{sign}0.{zeros}{digits}");
    };
    let digits = format!("{digits:0<width$}", width = places + 1);
    match digits.split_at(places + 1) {
        (whole, "") => format!("{sign}{whole}"),
        (whole, fraction) => format!("{sign}{whole}.{fraction}"),
    }
}

/// A decimal number in two texts, so that a power of ten can be added before it is rounded.
struct Number {
    /// Sign, digits and point, in ASCII.
    mantissa: String,
    exponent: i64,
}

impl Number {
    /// The number at the beginning of a text, and what follows it.
    fn read(text: &str) -> Option<(Number, &str)> {
        let (sign, unsigned) = sign_of(text);
        let is_part = |character: char| character.is_ascii_digit() || character == '.';
        let (digits, rest) = units::leading(unsigned.trim_start(), is_part);
        let points = digits.matches('.').count();
        if points > 1 || digits.len() == points {
            return None;
        }
        let (exponent, rest) = read_exponent(rest);
        let mantissa = format!("{sign}{digits}");
        Some((Number { mantissa, exponent }, rest))
    }

    fn is_zero(&self) -> bool {
        !self
            .mantissa
            .contains(|character| matches!(character, '1'..='9'))
    }

    /// The value in SI units, infinite if too large.
    fn times(&self, unit: &Unit) -> f64 {
        let exponent = self
            .exponent
            .saturating_add(i64::from(unit.decimal_exponent));
        // The text is digits with at most one point, and an integer exponent: always a number.
        let decimal: f64 = format!("{}e{exponent}", self.mantissa)
            .parse()
            .unwrap_or(f64::INFINITY);
        unit.without_powers_of_ten(decimal)
    }
}

/// The sign at the beginning of a text, in ASCII and without a plus, and what follows it.
fn sign_of(text: &str) -> (&'static str, &str) {
    match text.strip_prefix(['-', '\u{2212}']) {
        Some(rest) => ("-", rest),
        None => ("", text.strip_prefix('+').unwrap_or(text)),
    }
}

/// An exponent such as `e-4` at the beginning of a text, zero if there is none.
fn read_exponent(text: &str) -> (i64, &str) {
    let (sign, unsigned) = sign_of(text.strip_prefix(['e', 'E']).unwrap_or_default());
    match units::leading(unsigned, |character| character.is_ascii_digit()) {
        ("", _) => (0, text),
        (digits, rest) => {
            // Beyond eighteen digits any number is infinite or zero, whatever its mantissa.
            let magnitude = digits.parse().unwrap_or(i64::MAX / 2);
            (
                if sign.is_empty() {
                    magnitude
                } else {
                    -magnitude
                },
                rest,
            )
        }
    }
}

/// What is wrong with a text that begins with no number.
fn no_number(text: &str) -> QuantityProblem {
    let sign = ['+', '-', '\u{2212}'];
    let word = text.trim_start_matches(sign).to_lowercase();
    match word.starts_with("inf") || word.starts_with("nan") {
        true => QuantityProblem::NotFinite,
        false => QuantityProblem::NotANumber,
    }
}

/// What a quantity with these exponents is, with its article.
fn describe(exponents: Exponents) -> String {
    const INVERSE_TIME: Exponents = Exponents([0, 0, -1, 0, 0, 0, 0]);
    let mut all = Dimension::ALL.into_iter();
    match all.find(|dimension| dimension.exponents() == exponents) {
        Some(known) => known.to_string(),
        None if exponents == INVERSE_TIME => {
            "an inverse time, which may mean rad/s or Hz".to_owned()
        }
        None => "no quantity that is used here".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::num::f64 as bits;
    use proptest::prelude::*;
    use proptest::test_runner::{Config, TestRunner};

    fn message(text: &str, expected: Dimension) -> String {
        parse(text, expected).unwrap_err().to_string()
    }

    /// A few thousand cases, the same at every run.
    fn deterministic(cases: u32) -> TestRunner {
        let config = Config {
            cases,
            failure_persistence: None,
            ..Config::default()
        };
        let algorithm = config.rng_algorithm;
        TestRunner::new_with_rng(
            config,
            proptest::test_runner::TestRng::deterministic_rng(algorithm),
        )
    }

    #[test]
    fn quantities_read_exactly_what_is_written() {
        use Dimension::*;
        for (text, dimension, expected) in [
            ("10 mm", Length, 0.01),
            ("10mm", Length, 0.01),
            ("0.1 mm", Length, 1e-4),
            (" 5 µm ", Length, 5e-6),
            ("5 \u{03BC}m", Length, 5e-6),
            ("5 um", Length, 5e-6),
            ("5e3 nm", Length, 5e-6),
            ("3 Å", Length, 3e-10),
            ("2.5 cm", Length, 0.025),
            (".5 m", Length, 0.5),
            ("5. m", Length, 5.0),
            ("\u{2212}5 N", Force, -5.0),
            ("-5N", Force, -5.0),
            ("+1e\u{2212}3 kN", Force, 1.0),
            ("7 kg m/s^2", Force, 7.0),
            ("1973 MPa", Stress, 1973e6),
            ("254.776 MPa", Stress, 254.776e6),
            ("263.6628 N/mm^2", Stress, 263.6628e6),
            ("3 mPa", Stress, 3e-3),
            ("1e-4 1/MPa", Compliance, 1e-10),
            ("1e-4/MPa", Compliance, 1e-10),
            ("1e-4 MPa^-1", Compliance, 1e-10),
            ("1e-4 MPa⁻¹", Compliance, 1e-10),
            ("0.3 m²/MN", Compliance, 3e-7),
            ("2 GPa s", Viscosity, 2e9),
            ("2 GPa·s", Viscosity, 2e9),
            ("2 GPa*s", Viscosity, 2e9),
            ("8.93 s", Time, 8.93),
            ("12 min", Time, 720.0),
            ("3 h", Time, 10800.0),
            ("2 d", Time, 172800.0),
            ("117.96 ms", Time, 0.11796),
            ("90 deg", Angle, std::f64::consts::FRAC_PI_2),
            ("180°", Angle, std::f64::consts::PI),
            ("1.5 rad", Angle, 1.5),
            ("0.5 rad/s", AngularFrequency, 0.5),
            ("30 rad/min", AngularFrequency, 0.5),
            ("180 deg/s", AngularFrequency, std::f64::consts::PI),
            ("10 Hz", Frequency, 10.0),
            ("1 kHz", Frequency, 1e3),
            ("3.509 µJ", Energy, 3.509e-6),
            ("2 N m", Energy, 2.0),
            ("4 mm^2", Area, 4e-6),
            ("4 mm2", Area, 4e-6),
            ("0 m", Length, 0.0),
        ] {
            assert_eq!(parse(text, dimension), Ok(expected), "{text}");
        }
    }

    #[test]
    fn every_prefix_is_the_nearest_double() {
        for (prefix, power) in [
            ("f", -15),
            ("p", -12),
            ("n", -9),
            ("µ", -6),
            ("u", -6),
            ("m", -3),
            ("c", -2),
            ("d", -1),
            ("", 0),
            ("da", 1),
            ("h", 2),
            ("k", 3),
            ("M", 6),
            ("G", 9),
            ("T", 12),
        ] {
            for number in ["1", "0.1", "254.776", "8.93", "123456789.123"] {
                let nearest: f64 = format!("{number}e{power}").parse().unwrap();
                for (unit, dimension) in [("m", Dimension::Length), ("Pa", Dimension::Stress)] {
                    assert_eq!(
                        parse(&format!("{number} {prefix}{unit}"), dimension),
                        Ok(nearest)
                    );
                }
            }
        }
    }

    #[test]
    fn a_number_without_a_unit_is_told_both_ways_to_write_it() {
        assert_eq!(
            message("10", Dimension::Length),
            "'10' has no unit: write \"10 mm\", or the bare number 10 without quotes for SI (m)"
        );
        assert!(message("0.5", Dimension::AngularFrequency).contains("\"0.5 rad/s\""));
    }

    #[test]
    fn another_dimension_is_named() {
        assert_eq!(
            message("10 N", Dimension::Length),
            "'10 N' is a force, a length is expected, for example \"10 mm\""
        );
        assert!(
            message("10 Hz", Dimension::AngularFrequency).starts_with("'10 Hz' is a frequency, an")
        );
        assert!(message("10 1/s", Dimension::Frequency).contains("rad/s or Hz"));
        assert!(message("10 rad/s", Dimension::Frequency).contains("an angular frequency"));
        assert!(message("10 kg", Dimension::Force).contains("a mass"));
        assert!(message("10 m s", Dimension::Length).contains("no quantity"));
        assert!(message("5 1", Dimension::Length).contains("no quantity"));
    }

    #[test]
    fn an_unknown_unit_gets_the_likeliest_ones() {
        let suggestions = |text: &str, expected| match parse(text, expected) {
            Err(QuantityError {
                problem: QuantityProblem::UnknownUnit { suggestions, .. },
                ..
            }) => suggestions,
            other => panic!("{text}: {other:?}"),
        };
        assert_eq!(suggestions("5 mpa", Dimension::Stress), ["MPa", "mPa"]);
        assert_eq!(suggestions("5 KN", Dimension::Force), ["kN"]);
        assert_eq!(suggestions("5 hz", Dimension::Frequency), ["Hz"]);
        assert_eq!(suggestions("5 Nm", Dimension::Energy)[0], "N m");
        assert_eq!(suggestions("5 GPas", Dimension::Viscosity)[0], "GPa s");
        assert_eq!(suggestions("5 seconds", Dimension::Time), ["s"]);
        assert_eq!(suggestions("5 dge", Dimension::Angle)[0], "deg");
        // The letters of a force, but a length is expected.
        assert_eq!(suggestions("10 mn", Dimension::Length), ["m", "mm", "nm"]);
        assert!(suggestions("5 furlong", Dimension::Length).is_empty());
        assert_eq!(
            message("5 mpa", Dimension::Stress),
            "'5 mpa' has the unknown unit 'mpa' (did you mean \"MPa\" or \"mPa\"?); a stress or modulus is written for example \"1973 MPa\""
        );
        assert!(message("5 furlong", Dimension::Length).contains("'furlong'; a length"));
        // What is near in letters may be far in meaning: a force is no mass.
        assert_eq!(
            message("1 kgf", Dimension::Force),
            "'1 kgf' has the unknown unit 'kgf' (1 kgf is 9.80665 N); a force is written for example \"10 N\""
        );
        assert!(
            message("10 %", Dimension::Force)
                .contains("(1 % is a hundredth of another quantity: write what it comes to)")
        );
        // Words before numbers do not confuse the parts of a compound unit.
        assert!(
            message("5 rad/S", Dimension::AngularFrequency).contains("'S' (did you mean \"s\"?)")
        );
    }

    #[test]
    fn what_is_no_finite_number_is_refused() {
        assert!(message("1e400 mm", Dimension::Length).contains("too large"));
        assert!(message("1e999999999999999999999 mm", Dimension::Length).contains("too large"));
        assert!(message("1.8e308 min", Dimension::Time).contains("too large"));
        assert!(message("1e-400 m", Dimension::Length).contains("too small"));
        assert!(message("inf m", Dimension::Length).contains("finite"));
        assert!(message("-NaN m", Dimension::Length).contains("finite"));
        assert_eq!(parse("0e999 m", Dimension::Length), Ok(0.0));
    }

    #[test]
    fn broken_texts_are_refused_with_a_reason() {
        for text in ["", "  ", "m", "mm 10", "1.2.3 m", ".", "- m"] {
            assert!(
                message(text, Dimension::Length).contains("number"),
                "{text}"
            );
        }
        assert!(message("1,5 mm", Dimension::Length).contains("decimal point"));
        assert!(message("5 1/Pa s", Dimension::Viscosity).contains("two ways"));
        for text in [
            "5 m^", "5 m^x", "5 m/", "5 m//s", "5 (m)", "5 m^99", "5 12 m", "5 m^0",
        ] {
            assert!(
                message(text, Dimension::Length).contains("unknown unit"),
                "{text}"
            );
        }
        // An e without digits is not an exponent but the beginning of a unit.
        assert!(message("1em", Dimension::Length).contains("unknown unit 'em'"));
    }

    #[test]
    fn examples_read_and_si_units_are_what_they_say() {
        for dimension in Dimension::ALL {
            assert!(parse(dimension.example(), dimension).is_ok(), "{dimension}");
            assert_eq!(
                parse(&format!("1 {}", dimension.si_unit()), dimension),
                Ok(1.0)
            );
        }
    }

    #[test]
    fn temperatures_are_read_in_celsius_and_kelvin_and_their_differences_have_no_zero() {
        let kelvin = |text| parse(text, Dimension::Temperature).unwrap();
        assert_eq!(kelvin("25 °C"), 298.15);
        assert_eq!(kelvin("-10 degC"), 263.15);
        assert_eq!(kelvin("300 K"), 300.0);
        assert_eq!(kelvin("-273.15 °C"), 0.0);
        assert_eq!(Unit::read("m/°C").unwrap().zero_k, 0.0);
        assert_eq!(Unit::read("1/°C").unwrap().zero_k, 0.0);
        assert_eq!(celsius(298.15), "25 °C");
        assert_eq!(celsius(223.24), "-49.9 °C");
        assert_eq!(celsius(273.14999), "0 °C");
    }

    #[test]
    fn si_texts_return_every_double_bit_for_bit() {
        let any = bits::POSITIVE | bits::NEGATIVE | bits::NORMAL | bits::SUBNORMAL | bits::ZERO;
        let dimension = proptest::sample::select(Dimension::ALL.to_vec());
        deterministic(20_000)
            .run(&(any, dimension), |(value, dimension)| {
                let text = format_si(value, dimension);
                prop_assert_eq!(
                    parse(&text, dimension).map(f64::to_bits),
                    Ok(value.to_bits())
                );
                Ok(())
            })
            .unwrap();
        for value in [0.0, -0.0, f64::MAX, f64::MIN_POSITIVE, 5e-324, 1e16, 1e-4] {
            let read = parse(
                &format_si(value, Dimension::Compliance),
                Dimension::Compliance,
            );
            assert_eq!(read.map(f64::to_bits), Ok(value.to_bits()));
        }
        assert_eq!(format_si(0.01, Dimension::Length), "0.01 m");
        assert_eq!(format_si(5e-10, Dimension::Compliance), "5e-10 1/Pa");
    }

    #[test]
    fn no_text_makes_the_reader_panic() {
        deterministic(5_000)
            .run(
                &("[-+−0-9.eEmMPas/^*· µ°²⁻1]{0,12}|\\PC{0,8}", 0..11usize),
                |(text, index)| {
                    if let Ok(value) = parse(&text, Dimension::ALL[index]) {
                        prop_assert!(value.is_finite());
                    }
                    Ok(())
                },
            )
            .unwrap();
    }

    #[test]
    fn people_read_prefixes() {
        use Dimension::*;
        for (value, dimension, digits, expected) in [
            (3.5090e-6, Energy, 4, "3.509 µJ"),
            (3.65397e-4, Length, 4, "365.4 µm"),
            (5.36324e7, Stress, 4, "53.63 MPa"),
            (0.00844, AngularFrequency, 3, "8.44e-3 rad/s"),
            (0.0363, AngularFrequency, 3, "0.0363 rad/s"),
            (900.0, AngularFrequency, 3, "900 rad/s"),
            (1.25, Angle, 5, "1.2500 rad"),
            (133.8704874, Time, 4, "133.9 s"),
            (86400.0, Time, 3, "86400 s"),
            (2.5e-3, Time, 2, "2.5 ms"),
            (10.0, Force, 3, "10.0 N"),
            (-5e-3, Force, 2, "-5.0 mN"),
            (999.96e-6, Length, 4, "1.000 mm"),
            (2e9, Viscosity, 1, "2 GPa s"),
            (5.07e-10, Compliance, 3, "5.07e-10 1/Pa"),
            (1e20, Stress, 3, "1.00e20 Pa"),
            (1e-20, Length, 3, "1.00e-20 m"),
            (365.4e-6, Length, 2, "370 µm"),
            (0.0, Energy, 4, "0 J"),
        ] {
            assert_eq!(format_human(value, dimension, digits), expected);
        }
    }

    #[test]
    fn what_people_read_reads_back_to_the_digits_shown() {
        let dimension = proptest::sample::select(Dimension::ALL.to_vec());
        let magnitude = (-30.0..30.0f64).prop_map(|exponent| 10f64.powf(exponent));
        deterministic(5_000)
            .run(
                &(magnitude, dimension, 1..=17usize),
                |(value, dimension, digits)| {
                    let text = format_human(-value, dimension, digits);
                    let read = parse(&text, dimension)
                        .map_err(|error| TestCaseError::fail(error.to_string()))?;
                    // Half a unit of the last digit shown, and the rounding of the number read.
                    let half_unit = 0.5 * 10f64.powi(1 - digits as i32) + 4e-16;
                    prop_assert!(
                        (read / -value - 1.0).abs() <= half_unit,
                        "{} for {}",
                        text,
                        value
                    );
                    Ok(())
                },
            )
            .unwrap();
        assert_relative_eq!(
            parse(
                &format_human(1.0 / 3.0, Dimension::Length, 17),
                Dimension::Length
            )
            .unwrap(),
            1.0 / 3.0
        );
    }
}
