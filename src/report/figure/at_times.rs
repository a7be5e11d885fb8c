//! Figures with a curve for each of several times: which of them are drawn, and what they are called.

use std::collections::BTreeSet;

use super::curve::evenly;
use super::units::{Measure, Units};
use crate::report::number::scientific;

/// Curves in one figure; more cannot be told apart.
pub(super) const CURVES: usize = 6;

/// At most [`CURVES`] of what there is in the order of their times (s), evenly spread, both ends among them.
pub(super) fn chosen<T>(all: &[T], time_s: impl Fn(&T) -> f64) -> Vec<&T> {
    let mut ordered: Vec<&T> = all.iter().collect();
    ordered.sort_by(|a, b| time_s(a).total_cmp(&time_s(b)));
    let places = evenly(ordered.len(), CURVES).into_iter();
    places
        .filter_map(|place| ordered.get(place).copied())
        .collect()
}

/// What the curves of these times (s) are called: `t = 20 s`.
pub(super) fn labels(times_s: &[f64], units: &Units) -> Vec<String> {
    // From a second on, so that times stay in seconds.
    let time = units.shown(Measure::Time, 1.0);
    let digits = telling_digits(times_s);
    let label = |time_s: &f64| {
        let shown = scientific(time.of(*time_s), digits);
        format!("t = {shown} {}", time.unit)
    };
    times_s.iter().map(label).collect()
}

/// As many digits as it takes to tell the times apart, from four on; times at one instant cannot be.
fn telling_digits(times_s: &[f64]) -> usize {
    let told_apart = |digits: &usize| {
        let labels = times_s.iter().map(|time_s| scientific(*time_s, *digits));
        labels.collect::<BTreeSet<_>>().len() == times_s.len()
    };
    (4..=9).find(told_apart).unwrap_or(4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_close_to_one_another_are_told_apart() {
        assert_eq!(telling_digits(&[0.0, 20.0, 60.0]), 4);
        assert_eq!(telling_digits(&[19.999, 20.0]), 5);
        assert_eq!(telling_digits(&[20.0, 20.0]), 4);
    }
}
