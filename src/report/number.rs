//! Numbers with their errors and units, to be read.

pub(super) use crate::quantity::superscript;
use crate::quantity::{Dimension, FrequencyUnit, ZERO_CELSIUS_K, format_human};
use crate::sweep::plan::{AxisValue, Varied};

/// The power of ten and its prefix in which values up to `largest` read well: (factor to multiply by, prefix).
pub fn prefix(largest: f64) -> (f64, &'static str) {
    const PREFIXES: [(f64, &str); 11] = [
        (1e-15, "f"),
        (1e-12, "p"),
        (1e-9, "n"),
        (1e-6, "µ"),
        (1e-3, "m"),
        (1.0, ""),
        (1e3, "k"),
        (1e6, "M"),
        (1e9, "G"),
        (1e12, "T"),
        (1e15, "P"),
    ];
    if largest == 0.0 {
        return (1.0, "");
    }
    let fits = PREFIXES.iter().rev().find(|(unit, _)| largest >= *unit);
    let (unit, name) = fits.unwrap_or(&PREFIXES[0]);
    (unit.recip(), name)
}

/// The largest of values that are not negative; 0 where there are none.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

/// The smallest and the largest of some values: infinite, the wrong way round, where there are none.
pub fn range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let wider = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
    values.into_iter().fold(none, wider)
}

/// A number as mantissa of so many digits and power of ten.
fn mantissa_and_exponent(value: f64, significant: usize) -> (String, i32) {
    let text = format!("{value:.*e}", significant.saturating_sub(1));
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    (mantissa.to_owned(), exponent.parse().unwrap_or(0))
}

/// A number with a power of ten in superscript where it is not of everyday size: `8.44 × 10⁻³`, `0.278`, `10⁻⁴`.
pub fn scientific(value: f64, significant: usize) -> String {
    let (mantissa, exponent) = mantissa_and_exponent(value, significant);
    if !value.is_finite() {
        return mantissa;
    }
    if (-1..=3).contains(&exponent) {
        let decimals = (significant as i32 - 1 - exponent).max(0) as usize;
        return trimmed(&format!("{value:.decimals$}")).to_owned();
    }
    let power = superscript(exponent);
    match trimmed(&mantissa) {
        "1" => format!("10{power}"),
        mantissa => format!("{mantissa} × 10{power}"),
    }
}

/// Without zeros at the end of the decimals.
fn trimmed(number: &str) -> &str {
    match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.'),
        false => number,
    }
}

/// A number in the unit, with the prefix, in which it reads well, and that unit.
fn in_unit(value: f64, dimension: Dimension, significant: usize) -> (f64, String) {
    let human = format_human(value, dimension, significant);
    let (number, unit) = human.split_once(' ').unwrap_or((&human, ""));
    (number.parse().unwrap_or(value), unit.to_owned())
}

/// A value with its error, in one unit and of one power of ten: the error has one digit and is never less than it is, the value has
/// as many decimals.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Measured {
    pub value: String,
    pub error: String,
    /// By what power of ten both are to be multiplied, where that is not 0.
    pub power: i32,
    pub unit: String,
}

/// Digits of a value beyond which an error is not followed.
const MOST_DECIMALS: i32 = 6;

impl Measured {
    /// `None` where there is no error, or no value but zero to take the unit from.
    pub fn new(value: f64, error: Option<f64>, dimension: Dimension) -> Option<Self> {
        let error = error.filter(|e| *e > 0.0 && e.is_finite())?;
        if value == 0.0 || !value.is_finite() {
            return None;
        }
        // The unit and the power that the value alone would be written with.
        let (number, unit) = in_unit(value, dimension, 17);
        let power = match number.abs().log10().floor() as i32 {
            -2..5 => 0,
            exponent => exponent,
        };
        let scale = 10_f64.powi(power);
        let least = 10_f64.powi(-MOST_DECIMALS);
        let error = one_digit((number / value * error / scale).max(least));
        let decimals = (-power_of_ten(error)).max(0) as usize;
        Some(Self {
            value: format!("{:.decimals$}", number / scale),
            error: format!("{error:.decimals$}"),
            power,
            unit,
        })
    }

    /// The power of ten as in a table: `e-3`, or nothing.
    pub fn tens(&self) -> String {
        match self.power {
            0 => String::new(),
            power => format!("e{power}"),
        }
    }
}

/// One digit, never less than the number itself.
fn one_digit(error: f64) -> f64 {
    let unit = 10_f64.powf(error.log10().floor());
    (error / unit * (1.0 - 1e-9)).ceil() * unit
}

/// The power of ten of a number's first digit, of one too that lies a rounding below its power of ten.
fn power_of_ten(number: f64) -> i32 {
    (number.abs() * (1.0 + 1e-9)).log10().floor() as i32
}

/// Value and error to be read: `3.5090 ± 0.0003 µJ`, `(8.440 ± 0.003) × 10⁻³ rad/s`.
pub(super) fn with_error(number: f64, of: Option<f64>, dimension: Dimension) -> String {
    let Some(measured) = Measured::new(number, of, dimension) else {
        return format_human(number, dimension, 5);
    };
    let (value, error, unit) = (measured.value, measured.error, measured.unit);
    match measured.power {
        0 => format!("{value} ± {error} {unit}"),
        power => format!("({value} ± {error}) × 10{} {unit}", superscript(power)),
    }
}

/// An angular frequency (rad/s) in the unit asked for: `ω = 10⁻⁴ rad/s`, `f = 0.5 Hz`.
pub fn at_frequency(
    unit: FrequencyUnit,
    angular_frequency_rad_per_s: f64,
    digits: usize,
) -> String {
    let value = unit.of(angular_frequency_rad_per_s);
    let value = plain(value, unit.dimension(), digits);
    format!("{} = {value}", unit.symbol())
}

/// Four digits, with an exponent where the number is small or large.
pub fn four_digits(value: f64) -> String {
    significant(value, 4, 0.01..1e4)
}

/// Six digits without zeros at the end of the decimals, with an exponent where the number is not of everyday size.
pub fn six_digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let text = significant(value, 6, 1e-3..1e7);
    match text.contains('e') {
        true => text,
        false => trimmed(&text).to_owned(),
    }
}

/// So many digits, with an exponent where the magnitude is out of this range.
fn significant(value: f64, digits: usize, fixed: std::ops::Range<f64>) -> String {
    let last = digits.saturating_sub(1);
    if fixed.contains(&value.abs()) {
        let decimals = last as i32 - value.abs().log10().floor() as i32;
        format!("{value:.*}", decimals.max(0) as usize)
    } else {
        format!("{value:.last$e}")
    }
}

/// A number as a person would write it: `10 N`, `10⁻⁴ rad/s`. At most `significant` digits.
pub(super) fn plain(value: f64, dimension: Dimension, significant: usize) -> String {
    let (number, unit) = in_unit(value, dimension, significant);
    format!("{} {unit}", scientific(number, significant))
}

/// A value (SI units) of what a second axis varies, to be read: `5 N`, `25 °C`; of a block its name.
pub fn varied(varied: &Varied, value: AxisValue) -> String {
    match value {
        AxisValue::Block(_) => varied.block_name(value).unwrap_or_default().to_owned(),
        AxisValue::Number(number) => varied_number(varied, number),
    }
}

/// The same of an axis that varies a number.
pub fn varied_number(varied: &Varied, value: f64) -> String {
    match varied.dimension {
        // Kelvin to degrees leaves rounding.
        Some(Dimension::Temperature) => {
            format!("{} °C", (1e6 * (value - ZERO_CELSIUS_K)).round() / 1e6)
        }
        Some(Dimension::Angle) => format!("{}°", scientific(value.to_degrees(), 4)),
        Some(dimension) => plain(value, dimension, 4),
        None => scientific(value, 4),
    }
}

/// At most five significant digits without a unit: a dash for what is absent.
pub(super) fn cell(value: Option<f64>) -> String {
    match value {
        Some(value) => scientific(value, 5),
        None => "–".to_owned(),
    }
}

/// So many significant digits without a unit, zeros at the end too, for a column of like numbers; a dash for what is absent.
pub(super) fn digits(value: Option<f64>, significant: usize) -> String {
    let Some(value) = value else {
        return "–".to_owned();
    };
    let (mantissa, exponent) = mantissa_and_exponent(value, significant);
    let text = match exponent {
        -2..5 => {
            let decimals = (significant.saturating_sub(1) as i32 - exponent).max(0) as usize;
            format!("{value:.decimals$}")
        }
        exponent => format!("{mantissa} × {}", scientific(10_f64.powi(exponent), 1)),
    };
    text.replace('-', "−")
}

/// Two significant digits of a positive number, without an exponent.
pub fn two_digits(value: f64) -> String {
    let decimals = (1.0 - value.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

/// Bytes in the unit that people would use for them.
pub fn megabytes(bytes: u64) -> String {
    match bytes as f64 / 1e6 {
        mega if mega < 1e3 => format!("{} MB", two_digits(mega)),
        mega => format!("{} GB", two_digits(mega / 1e3)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_has_one_digit_rounded_up_and_its_value_as_many_decimals() {
        let joule = |value, error| with_error(value, error, Dimension::Energy);
        assert_eq!(joule(3.50901e-6, Some(2.8e-10)), "3.5090 ± 0.0003 µJ");
        assert_eq!(joule(3.50901e-6, Some(2.1e-9)), "3.509 ± 0.003 µJ");
        // 0.096 is 0.1.
        assert_eq!(joule(91.47e-9, Some(9.6e-11)), "91.5 ± 0.1 nJ");
        assert_eq!(joule(91.47e-9, Some(0.0)), "91.470 nJ");
        assert_eq!(joule(3.6e-6, Some(5e-6)), "4 ± 5 µJ");
        assert_eq!(joule(3.6e-6, Some(1e-6)), "4 ± 1 µJ");
        // Further than nine decimals no error is followed.
        assert_eq!(joule(3.50901e-6, Some(2.8e-19)), "3.509010 ± 0.000001 µJ");
        let omega = |value, error| with_error(value, Some(error), Dimension::AngularFrequency);
        assert_eq!(omega(8.4401e-3, 2.1e-6), "(8.440 ± 0.003) × 10⁻³ rad/s");
        assert_eq!(omega(8.4e-7, 2.1e-9), "(8.40 ± 0.03) × 10⁻⁷ rad/s");
        assert_eq!(omega(0.075691, 2.1e-6), "0.075691 ± 0.000003 rad/s");
        assert_eq!(with_error(2.0, None, Dimension::Force), "2.0000 N");
        assert_eq!(with_error(0.0, Some(1.0), Dimension::Force), "0 N");
    }

    #[test]
    fn a_column_keeps_the_zeros_at_the_end() {
        let texts = [3.5, -365.0, 0.01, 1e5, 9.99999, 0.0].map(|v| digits(Some(v), 5));
        assert_eq!(
            texts,
            [
                "3.5000",
                "−365.00",
                "0.010000",
                "1.0000 × 10⁵",
                "10.000",
                "0.0000"
            ]
        );
        assert_eq!(digits(None, 5), "–");
    }

    #[test]
    fn a_plain_number_has_no_more_digits_than_it_needs() {
        assert_eq!(plain(10.0, Dimension::Force, 4), "10 N");
        assert_eq!(plain(0.01, Dimension::Length, 6), "10 mm");
        assert_eq!(plain(1e-4, Dimension::AngularFrequency, 3), "10⁻⁴ rad/s");
        assert_eq!(plain(0.0, Dimension::Angle, 4), "0 rad");
    }

    #[test]
    fn numbers_read_as_in_print() {
        assert_eq!(scientific(8.44e-3, 3), "8.44 × 10⁻³");
        assert_eq!(scientific(1e-4, 3), "10⁻⁴");
        assert_eq!(scientific(0.278, 3), "0.278");
        assert_eq!(scientific(1.0, 3), "1");
        assert_eq!(scientific(12.0, 3), "12");
        assert_eq!(scientific(2.5e12, 3), "2.5 × 10¹²");
    }

    #[test]
    fn a_prefix_keeps_the_largest_value_between_one_and_a_thousand() {
        for (largest, name) in [(3.5e-6, "µ"), (15.0, ""), (1e3, "k"), (2e-20, "f")] {
            assert_eq!(prefix(largest).1, name);
        }
        let (factor, _) = prefix(999e-9);
        assert!((999e-9 * factor - 999.0).abs() < 1e-9);
    }
}
