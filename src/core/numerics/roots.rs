//! Where a condition changes, and where a function is least.

/// Halvings that exhaust the digits of a double, whatever the interval.
pub const ALL_DIGITS: u32 = 60;

/// The interval of this many halvings around the place where a condition that holds at `low` ceases to hold on the way to `high`: it
/// holds at the first end and not at the second, unless that is where it began.
pub fn bisect(low: f64, high: f64, halvings: u32, holds: impl Fn(f64) -> bool) -> (f64, f64) {
    (0..halvings).fold((low, high), |(low, high), _| {
        let middle = 0.5 * (low + high);
        match holds(middle) {
            true => (middle, high),
            false => (low, middle),
        }
    })
}

/// Where a function of one minimum has it, by the golden section (J. Kiefer, Proc. Amer. Math. Soc. 4 (1953) 502).
pub fn golden_section(mut from: f64, mut to: f64, value: impl Fn(f64) -> f64) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..ALL_DIGITS {
        let (left, right) = (to - share * (to - from), from + share * (to - from));
        if value(left) < value(right) {
            to = right;
        } else {
            from = left;
        }
    }
    0.5 * (from + to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_change_is_enclosed_to_the_last_digit(root in -3.0..5.0f64) {
            let (low, high) = bisect(-3.0, 5.0, ALL_DIGITS, |x| x < root);
            prop_assert!(low < root || low == -3.0);
            prop_assert!(high >= root && high - low <= 2.0 * f64::EPSILON * root.abs().max(1.0));
            // It may fall as well as rise.
            let (above, below) = bisect(5.0, -3.0, 20, |x| x > root);
            prop_assert!(above >= root && below <= root && above - below <= 8.0 / f64::from(1 << 20));
        }

        #[test]
        fn a_minimum_is_found_as_far_as_its_function_tells_it_apart(place in -3.0..5.0f64, power in 1..3) {
            let found = golden_section(-3.0, 5.0, |x| (x - place).abs().powi(power));
            prop_assert!((found - place).abs() < 1e-7, "{found}");
        }
    }
}
