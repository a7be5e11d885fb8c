//! Numbers rounded to what a text holds of them.

/// Significant digits where columns do not bound them. With an exponent a number has 20 characters at most, as Abaqus asks.
const DIGITS: usize = 13;

/// The value of digits.
pub(super) fn value(digits: &str) -> f64 {
    digits.parse().unwrap_or(f64::NAN)
}

/// To thirteen digits.
pub(super) fn rounded(number: f64) -> f64 {
    value(&format!("{number:.*e}", DIGITS - 1))
}

/// A positive number without the digits beyond the thirteenth.
pub(super) fn rounded_down(number: f64) -> f64 {
    let all = format!("{number:.16e}");
    let (mantissa, exponent) = all.split_once('e').unwrap_or((&all, "0"));
    // The point is a character as well.
    value(&format!("{mantissa:.*}e{exponent}", DIGITS + 1))
}

/// The digits of a number of thirteen: those of few digits as they are, as people write them, others as `1.973000000000E+09`, with
/// two digits of exponent at least, as every Fortran program reads it.
pub(super) fn digits(number: f64) -> String {
    let short = format!("{number:?}");
    if short.len() <= 9 && !short.contains('e') {
        return short;
    }
    let all = format!("{number:.*e}", DIGITS - 1);
    let (mantissa, exponent) = all.split_once('e').unwrap_or((&all, "0"));
    match exponent.strip_prefix('-') {
        Some(exponent) => format!("{mantissa}E-{exponent:0>2}"),
        None => format!("{mantissa}E+{exponent:0>2}"),
    }
}

/// As many digits of a number as ten columns hold.
pub(super) fn ten_columns(number: f64) -> String {
    let texts = (0..=8).flat_map(|k| [format!("{number:.k$}"), format!("{number:.k$E}")]);
    let fitting = texts.filter(|text| text.len() <= 10 && text.contains(['.', 'E']));
    let error = |text: &String| (value(text) - number).abs();
    let nearest = fitting.min_by(|a, b| error(a).total_cmp(&error(b)));
    nearest.unwrap_or_else(|| format!("{number:.0E}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_thirteen_digits_in_twenty_characters() {
        for number in [
            1.0 / 3.0,
            1.973e9,
            -6.02214076e-23,
            8.93,
            f64::MAX,
            f64::MIN_POSITIVE,
        ] {
            let printed = digits(rounded(number));
            assert!(printed.len() <= 20, "{printed}");
            assert!((value(&printed) / number - 1.0).abs() <= 5e-13, "{printed}");
            assert_eq!(value(&printed), rounded(number));
        }
        assert_eq!(digits(8.93), "8.93");
        assert_eq!(digits(rounded(2.5e9 / 3.0)), "8.333333333333E+08");
    }

    #[test]
    fn ratios_are_rounded_down() {
        for k in 1..500 {
            let number = 1.0 / f64::from(k) / 7.0;
            let down = rounded_down(number);
            assert!(down <= number, "{down:e} of {number:e}");
            // One unit of thirteen digits.
            assert!(down / number >= 1.0 - 1e-12, "{down:e}");
            assert_eq!(down, rounded(down));
        }
    }

    #[test]
    fn ten_columns_hold_five_digits_of_any_number_and_more_of_most() {
        for (number, text) in [
            (254.776e6, "2.54776E8"),
            (8.93, "8.93"),
            (1.0 / 117.96, "0.00847745"),
            (0.0, "0.0"),
        ] {
            let printed = ten_columns(number);
            assert!(printed.len() <= 10);
            assert!(
                (value(&printed) - number).abs() <= 1e-6 * number,
                "{printed} for {text}"
            );
        }
        for exponent in -99..=99 {
            let number = 1.234_567_89 * 10_f64.powi(exponent);
            let printed = ten_columns(number);
            assert!(printed.len() <= 10, "{printed}");
            // Half a unit of the fifth digit.
            assert!((value(&printed) / number - 1.0).abs() < 4e-5, "{printed}");
        }
    }
}
