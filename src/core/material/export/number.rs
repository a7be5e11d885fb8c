//! Numbers as they are printed, with the value that the printed digits have.

use std::fmt;

/// A number as text.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Printed {
    text: String,
    /// The value of the text.
    pub(super) value: f64,
}

/// Significant digits where columns do not bound them. A number has 20 characters at most, as Abaqus asks.
const DIGITS: usize = 13;

/// Rounding of a quotient of sums of a few numbers, relative.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Printed {
    fn of(text: String, otherwise: f64) -> Self {
        let value = text.parse().unwrap_or(otherwise);
        Self { text, value }
    }

    /// To thirteen digits.
    pub(super) fn free(value: f64) -> Self {
        Self::of(scientific(value, DIGITS - 1), value)
    }

    /// The same of a positive number, rounded down.
    pub(super) fn free_downwards(value: f64) -> Self {
        let nearest = Self::free(value);
        if nearest.value <= value {
            return nearest;
        }
        // One unit of the last digit less.
        let unit = 10_f64.powi(value.log10().floor() as i32 + 1 - DIGITS as i32);
        Self::free(nearest.value - unit)
    }

    /// The same, where what lies above the number by no more than the rounding of the number itself is the number: `0.2912` of
    /// 0.29119999999999996.
    pub(super) fn free_downwards_but_for_rounding(value: f64) -> Self {
        let nearest = Self::free(value);
        match nearest.value <= value * (1.0 + ROUNDING) {
            true => nearest,
            false => Self::free_downwards(value),
        }
    }

    /// To as many digits as ten columns hold.
    pub(super) fn ten_columns(value: f64) -> Self {
        let candidates = (0..=8).flat_map(|digits| {
            let scientific = format!("{value:.digits$e}").replace('e', "E");
            [format!("{value:.digits$}"), scientific]
        });
        let fitting = candidates.filter(|text| text.len() <= 10 && text.contains(['.', 'E']));
        let nearest = fitting
            .map(|text| Self::of(text, value))
            .min_by(|a, b| (a.value - value).abs().total_cmp(&(b.value - value).abs()));
        nearest.unwrap_or_else(|| Self::of(format!("{value:.0e}").replace('e', "E"), value))
    }
}

impl fmt::Display for Printed {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(&self.text)
    }
}

/// `1.973000E+09`: two digits of exponent at least, as every Fortran program reads it. Whole numbers of a few digits, which
/// people write, stay as short as they are, also where rounding has changed their last bits.
fn scientific(value: f64, decimals: usize) -> String {
    let rounded: f64 = format!("{value:.decimals$e}").parse().unwrap_or(value);
    let is_rounding = (rounded - value).abs() <= ROUNDING * value.abs();
    let short = format!("{:?}", if is_rounding { rounded } else { value });
    if short.len() <= 9 && !short.contains('e') {
        return short;
    }
    let text = format!("{value:.decimals$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, exponent) = match exponent.strip_prefix('-') {
        Some(exponent) => ('-', exponent),
        None => ('+', exponent),
    };
    format!("{mantissa}E{sign}{exponent:0>2}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_thirteen_digits_in_twenty_characters() {
        for value in [
            1.0 / 3.0,
            1.973e9,
            -6.02214076e-23,
            8.93,
            f64::MAX,
            f64::MIN_POSITIVE,
        ] {
            let printed = Printed::free(value);
            assert!(printed.to_string().len() <= 20, "{printed}");
            assert!((printed.value / value - 1.0).abs() <= 5e-13, "{printed}");
        }
        assert_eq!(Printed::free(8.93).to_string(), "8.93");
        assert_eq!(Printed::free(2.5e9 / 3.0).to_string(), "8.333333333333E+08");
    }

    #[test]
    fn ratios_are_rounded_down() {
        for k in 1..500 {
            let value = 1.0 / f64::from(k) / 7.0;
            let printed = Printed::free_downwards(value);
            assert!(printed.value <= value, "{printed} of {value:e}");
            // One unit of thirteen digits.
            assert!(printed.value / value >= 1.0 - 1e-12, "{printed}");
        }
        // A ratio that a person wrote, as dividing its modulus gives it.
        for (value, text) in [
            (0.07877699999999999, "0.078777"),
            (0.29119999999999996, "0.2912"),
        ] {
            assert_eq!(
                Printed::free_downwards_but_for_rounding(value).to_string(),
                text
            );
        }
    }

    #[test]
    fn ten_columns_hold_five_digits_of_any_number_and_more_of_most() {
        for (value, text) in [
            (254.776e6, "2.54776E8"),
            (8.93, "8.93"),
            (1.0 / 117.96, "0.00847745"),
            (0.0, "0.0"),
        ] {
            let printed = Printed::ten_columns(value);
            assert!(printed.to_string().len() <= 10);
            assert!(
                (printed.value - value).abs() <= 1e-6 * value,
                "{printed} for {text}"
            );
        }
        for exponent in -99..=99 {
            let value = 1.234_567_89 * 10_f64.powi(exponent);
            let printed = Printed::ten_columns(value);
            assert!(printed.to_string().len() <= 10, "{printed}");
            // Half a unit of the fifth digit.
            assert!((printed.value / value - 1.0).abs() < 4e-5, "{printed}");
        }
    }
}
