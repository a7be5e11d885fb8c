//! Numbers as they are written: few enough digits that neither another processor nor another iteration changes them.

/// Below this, in units in which results are of order 1, a value is rounding and stands as 0.
const NOISE: f64 = 1e-9;

/// Differences below this depend on the tolerance of the half-space solver.
const UNRESOLVED: f64 = 1e-6;

/// A value to this many significant digits, in decimal notation where that is short.
pub fn significant(value: f64, digits: usize) -> String {
    if value.abs() < NOISE {
        return "0".to_owned();
    }
    let decimals = digits.saturating_sub(1);
    let text = format!("{value:.decimals$e}");
    let exponent = text.split_once('e').and_then(|(_, e)| e.parse().ok());
    match exponent {
        Some(exponent @ -4..=4) => {
            let decimals = (decimals as i32 - exponent).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => text,
    }
}

/// A number that was chosen rather than computed, without zeros at its end.
pub fn short(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A difference: two digits with sign, or how small it is at most.
pub fn difference(value: f64) -> String {
    match value.abs() < UNRESOLVED {
        true => format!("< {UNRESOLVED:.0e}"),
        false => format!("{value:+.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_digits_are_written_out_and_noise_is_nothing() {
        for (value, text) in [
            (1.235912, "1.2359"),
            (0.0063201, "0.0063201"),
            (-1973.06, "-1973.1"),
            (99999.6, "1.0000e5"),
            (9.999961, "10.000"),
            (1.26843e-6, "1.2684e-6"),
            (3e-17, "0"),
            (0.0, "0"),
        ] {
            assert_eq!(significant(value, 5), text);
        }
    }

    #[test]
    fn chosen_numbers_have_no_zeros_at_their_end() {
        let texts = [0.1, 1.0, 0.0031].map(short);
        assert_eq!(texts, ["0.1", "1", "0.0031"]);
    }

    #[test]
    fn differences_have_a_sign_or_a_bound() {
        assert_eq!(difference(1.234e-4), "+1.2e-4");
        assert_eq!(difference(-0.0123), "-1.2e-2");
        assert_eq!(difference(2e-7), "< 1e-6");
    }
}
