//! Numbers with their errors and units, to be read.

use crate::quantity::{Dimension, format_human};
use crate::report::figure::scientific;

/// Value and error, both in one unit: `3.50901 ± 0.00027 µJ`, `(8.4401 ± 0.0021) × 10⁻³ rad/s`. The error has two digits, the
/// value as many decimals.
pub(in crate::report) fn with_error(
    value: f64,
    error: Option<f64>,
    dimension: Dimension,
) -> String {
    let error = error.filter(|e| *e > 0.0 && e.is_finite() && *e < value.abs());
    let (Some(error), true) = (error, value.is_finite()) else {
        return format_human(value, dimension, 5);
    };
    // The unit and the power that the value alone would be written with.
    let human = format_human(value, dimension, 17);
    let (number, unit) = human.split_once(' ').unwrap_or((&human, ""));
    let number: f64 = number.parse().unwrap_or(value);
    let shown = number / value * error;
    let exponent = |x: f64| x.abs().log10().floor() as i32;
    if (-1..5).contains(&exponent(number)) {
        let decimals = (1 - exponent(shown)).max(0) as usize;
        return format!("{number:.decimals$} ± {shown:.decimals$} {unit}");
    }
    let power = 10_f64.powi(exponent(number));
    let decimals = (1 - exponent(shown / power)).max(0) as usize;
    let tens = scientific(power, 1);
    format!(
        "({:.decimals$} ± {:.decimals$}) × {tens} {unit}",
        number / power,
        shown / power
    )
}

/// A number as a person would write it: `10 N`, `10⁻⁴ rad/s`. At most `significant` digits.
pub(in crate::report) fn plain(value: f64, dimension: Dimension, significant: usize) -> String {
    let human = format_human(value, dimension, significant);
    let (number, unit) = human.split_once(' ').unwrap_or((&human, ""));
    let number: f64 = number.parse().unwrap_or(value);
    format!("{} {unit}", scientific(number, significant))
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
    let decimals = significant.saturating_sub(1);
    let written = format!("{value:.decimals$e}");
    let (mantissa, exponent) = written.split_once('e').unwrap_or((&written, "0"));
    match exponent.parse::<i32>().unwrap_or(0) {
        exponent @ -2..5 => {
            let decimals = (decimals as i32 - exponent).max(0) as usize;
            format!("{value:.decimals$}").replace('-', "−")
        }
        exponent => {
            let tens = scientific(10_f64.powi(exponent), 1);
            format!("{} × {tens}", mantissa.replace('-', "−"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_has_two_digits_and_its_value_as_many_decimals() {
        let text = |value, error, dimension| with_error(value, error, dimension);
        assert_eq!(
            text(3.509e-6, Some(2.7e-10), Dimension::Energy),
            "3.50900 ± 0.00027 µJ"
        );
        assert_eq!(
            text(8.4401e-3, Some(2.1e-6), Dimension::AngularFrequency),
            "(8.4401 ± 0.0021) × 10⁻³ rad/s"
        );
        assert_eq!(
            text(8.4e-7, Some(2.1e-9), Dimension::AngularFrequency),
            "(8.400 ± 0.021) × 10⁻⁷ rad/s"
        );
        assert_eq!(text(2.0, None, Dimension::Force), "2.0000 N");
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
}
