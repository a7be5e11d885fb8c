//! From values to px: the range an axis shows and the mapping along it.

use super::{Axis, ChartError, Scale};

/// An axis laid out: the value `low` is at `from_px`, `high` at `to_px`.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisMap {
    pub(super) scale: Scale,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) from_px: f64,
    pub(super) to_px: f64,
}

/// Lengths of the axis beyond which a value is simply far away.
const FAR: f64 = 1e6;

impl AxisMap {
    /// The map of these values to a length between these two ends.
    pub(super) fn new(scale: Scale, (low, high): (f64, f64), (from_px, to_px): (f64, f64)) -> Self {
        Self {
            scale,
            low,
            high,
            from_px,
            to_px,
        }
    }

    pub(super) fn px(&self, value: f64) -> f64 {
        let part = match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Log => (value / self.low).log10() / (self.high / self.low).log10(),
        };
        // Far outside, how far no longer matters; an infinite length would.
        self.from_px + part.clamp(-FAR, FAR) * (self.to_px - self.from_px)
    }

    /// As [`AxisMap::px`] for the lower end of an error bar, which on a log axis may have no place at all: then it
    /// lies far below the frame.
    pub(super) fn lowest_px(&self, value: f64) -> f64 {
        if self.scale == Scale::Log && value <= 0.0 {
            return self.from_px - FAR * (self.to_px - self.from_px);
        }
        self.px(value)
    }
}

/// How much room an automatic range leaves about the data.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Fraction of the data's span added at the low end.
    pub(super) below: f64,
    /// The same at the high end.
    pub(super) above: f64,
    /// The axis starts at zero where the data come at least this close to it, as a fraction of their largest value.
    pub(super) reach_zero: f64,
}

/// The values at the two ends of `axis`, whose data run from `least` to `greatest`.
pub(super) fn range(
    axis: &Axis,
    name: &str,
    (least, greatest): (f64, f64),
    room: Room,
) -> Result<(f64, f64), ChartError> {
    let (low, high) = match (axis.range, axis.scale) {
        (Some(range), _) => range,
        (None, Scale::Linear) => linear_range(least, greatest, room),
        (None, Scale::Log) => log_range(least, greatest, room),
    };
    let is_log = axis.scale == Scale::Log;
    let refusals = [
        (
            !(low.is_finite() && high.is_finite()),
            "the ends must be finite numbers",
        ),
        (low >= high, "the first end must be below the second"),
        (is_log && low <= 0.0, "a logarithmic axis starts above zero"),
        (
            is_log && !(high / low).is_finite(),
            "the ends are too far apart for numbers of double precision",
        ),
        (
            !is_log && !(high - low).is_finite(),
            "the ends are too far apart for numbers of double precision; scale the data first",
        ),
        (
            high - low < SMALLEST || (is_log && low < SMALLEST),
            "the values are too small for labels; scale the data first",
        ),
        (
            high - low <= NARROWEST * low.abs().max(high.abs()),
            "the ends are too close together to tell the labels apart; subtract an offset first",
        ),
    ];
    match refusals.into_iter().find(|(refused, _)| *refused) {
        None => Ok((low, high)),
        Some((_, reason)) => Err(ChartError::item(
            format!("the {name} axis from {low} to {high}"),
            reason,
        )),
    }
}

/// Relative width below which tick labels would run out of the 15 figures of a double.
const NARROWEST: f64 = 1e-11;
/// Well above the least double, so that a thousandth of the axis is still a number of full precision.
const SMALLEST: f64 = 1e-290;

fn linear_range(least: f64, greatest: f64, room: Room) -> (f64, f64) {
    let size = least.abs().max(greatest.abs());
    let span = greatest - least;
    if span <= 1e3 * NARROWEST * size {
        // One value, or as good as one: it goes to the middle.
        let half = if size > 0.0 { 0.1 * size } else { 1.0 };
        return (least - half, greatest + half);
    }
    let low = if least >= 0.0 && least <= room.reach_zero * greatest {
        0.0
    } else {
        least - room.below * span
    };
    let high = if greatest <= 0.0 && greatest >= room.reach_zero * least {
        0.0
    } else {
        greatest + room.above * span
    };
    // Padding alone must not lead an axis across zero: a mass or a time has no use for the far side.
    let low = if least >= 0.0 { low.max(0.0) } else { low };
    let high = if greatest <= 0.0 { high.min(0.0) } else { high };
    (low, high)
}

fn log_range(least: f64, greatest: f64, room: Room) -> (f64, f64) {
    let ratio = greatest / least;
    if ratio <= 1.0 + 1e-9 {
        // One value goes to the middle of a decade.
        return (least / 10f64.sqrt(), greatest * 10f64.sqrt());
    }
    (
        least / ratio.powf(room.below),
        greatest * ratio.powf(room.above),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: Room = Room {
        below: 0.05,
        above: 0.05,
        reach_zero: 0.3,
    };

    fn auto(axis: Axis, least: f64, greatest: f64) -> (f64, f64) {
        range(&axis, "y", (least, greatest), ROOM).unwrap()
    }

    #[test]
    fn data_near_zero_start_at_zero() {
        let (low, high) = auto(Axis::linear(""), 0.2, 3.4);
        assert_eq!(low, 0.0);
        assert!(high > 3.4 && high < 3.7); // 5 % of the span above the data
        assert_eq!(auto(Axis::linear(""), -3.4, -0.2).1, 0.0);
    }

    #[test]
    fn data_far_from_zero_do_not() {
        let (low, high) = auto(Axis::linear(""), 1900.0, 2500.0);
        assert_eq!((low, high), (1870.0, 2530.0)); // 5 % of 600 on each side
    }

    #[test]
    fn a_log_axis_is_padded_by_the_same_factor_on_both_sides() {
        let (low, high) = auto(Axis::log(""), 1e-4, 1.0);
        let factor = 10f64.powf(0.2); // 5 % of four decades
        assert!((1e-4 / low / factor - 1.0).abs() < 1e-14); // a few roundings
        assert!((high / factor - 1.0).abs() < 1e-14);
    }

    #[test]
    fn one_value_goes_to_the_middle() {
        assert_eq!(auto(Axis::linear(""), 0.0, 0.0), (-1.0, 1.0));
        assert_eq!(auto(Axis::linear(""), 50.0, 50.0), (45.0, 55.0));
        let (low, high) = auto(Axis::log(""), 7.0, 7.0);
        assert!((low * high - 49.0).abs() < 1e-12); // rounding of two divisions
    }

    #[test]
    fn equal_factors_are_equal_lengths_on_a_log_axis() {
        let map = AxisMap {
            scale: Scale::Log,
            low: 1e-3,
            high: 1e3,
            from_px: 100.0,
            to_px: 700.0,
        };
        for power in -3..=3 {
            let px = map.px(10f64.powi(power));
            assert!((px - (400.0 + 100.0 * f64::from(power))).abs() < 1e-9); // rounding, far below 1/16 px
        }
    }

    #[test]
    fn impossible_ranges_are_refused() {
        for (low, high) in [
            (1.0, 1.0),
            (2.0, 1.0),
            (f64::NAN, 1.0),
            (0.0, f64::INFINITY),
            (-1e308, 1e308),
            (1.0, 1.0 + 1e-13),
            (0.0, 1e-320),
        ] {
            let result = range(&Axis::linear("").range(low, high), "x", (0.0, 1.0), ROOM);
            let error = result.unwrap_err().to_string();
            assert!(error.contains("the x axis from"), "{error}");
        }
        for (low, high) in [(0.0, 1.0), (-1.0, 1.0), (1e-200, 1e200), (1e-320, 1.0)] {
            let result = range(&Axis::log("").range(low, high), "x", (0.5, 1.0), ROOM);
            assert!(
                matches!(result, Err(ChartError::Item { .. })),
                "{low} {high}"
            );
        }
    }
}
