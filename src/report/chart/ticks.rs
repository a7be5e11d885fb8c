//! Which values an axis names: 1-2-5 steps on a linear axis, decades on a logarithmic one.
//!
//! A tick is a whole number times a power of ten until the last moment, so that its label is exact and its value is the
//! double nearest to what the label says.

use super::Scale;
use super::look::{MAJOR_TICK, MINOR_TICK};
use crate::report::number::superscript;

/// The ticks of one axis, each list ascending.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Ticks {
    pub(super) major: Vec<Tick>,
    pub(super) minor: Vec<f64>,
}

impl Ticks {
    /// Leaves the labels of every second, third ... tick alone, so that no more than these have one.
    fn keep_at_most(&mut self, most: usize) {
        let stride = (self.major.len() - 1).div_ceil(most - 1).max(1);
        let all = std::mem::take(&mut self.major).into_iter().enumerate();
        let (kept, left): (Vec<_>, Vec<_>) = all.partition(|(place, _)| place % stride == 0);
        self.major = kept.into_iter().map(|(_, tick)| tick).collect();
        self.minor
            .extend(left.into_iter().map(|(_, tick)| tick.value));
        self.minor.sort_by(f64::total_cmp);
    }

    /// Those at whole numbers.
    pub(super) fn at_whole_numbers(mut self) -> Self {
        self.major.retain(|tick| tick.value.fract() == 0.0);
        for tick in &mut self.major {
            let whole = tick.label.split_once('.');
            let whole = whole.filter(|(_, decimals)| decimals.bytes().all(|digit| digit == b'0'));
            tick.label = whole.map_or_else(|| tick.label.clone(), |(whole, _)| whole.to_owned());
        }
        self.minor.retain(|value| value.fract() == 0.0);
        self
    }

    /// The value and the length (px) of every tick.
    pub(super) fn lengths(&self) -> impl Iterator<Item = (f64, f64)> {
        let minor = self.minor.iter().map(|&value| (value, MINOR_TICK));
        minor.chain(self.major.iter().map(|tick| (tick.value, MAJOR_TICK)))
    }
}

/// A tick with its label.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) label: String,
}

/// `digits` times ten to the `power`.
#[derive(Clone, Copy, Debug)]
struct Decimal {
    digits: i64,
    power: i32,
}

impl Decimal {
    fn value(self) -> f64 {
        // Parsing rounds correctly, where multiplying by a power of ten does not. An f64 always parses back.
        format!("{}e{}", self.digits, self.power)
            .parse()
            .unwrap_or(0.0)
    }
}

/// Relative slack within which a tick counts as lying on the end of the axis.
const SLACK: f64 = 1e-9;
/// No axis has more labels than this: decades are read as one row, numbers one by one.
const MOST_DECADES: usize = 11;
const MOST_NUMBERS: usize = 8;

/// The ticks for `low..high`. `fits` says whether labels at these values have room beside one another; the densest
/// choice that has room is taken, and where none has, two labels, those at the ends of a denser choice if need be.
pub(super) fn choose(scale: Scale, low: f64, high: f64, fits: impl Fn(&[Tick]) -> bool) -> Ticks {
    let with_at_most = |most: usize| match scale {
        Scale::Linear => linear(low, high, most.min(MOST_NUMBERS)),
        Scale::Log => log(low, high, most),
    };
    // One label alone says nothing of the scale.
    let choices = || {
        let all = (2..=MOST_DECADES).rev().map(with_at_most);
        all.filter(|ticks| ticks.major.len() > 1)
    };
    let has_room = |ticks: &Ticks| fits(&ticks.major);
    let ends = |mut ticks: Ticks| {
        ticks.keep_at_most(2);
        ticks
    };
    (choices().find(has_room))
        .or_else(|| choices().map(ends).rev().find(has_room))
        .or_else(|| choices().next_back())
        .unwrap_or_else(|| with_at_most(2))
}

/// Fewer contour lines than these say little of the shape of a map.
const LEAST_CONTOURS: usize = 3;

/// The values between the least and the largest at which contour lines are drawn: those named at the colour bar from `low` to `high`,
/// or, where too few, steps of 1, 2 or 5 between them.
pub(super) fn of_contours(
    scale: Scale,
    (low, high): (f64, f64),
    (least, largest): (f64, f64),
    named: &[Tick],
) -> Vec<Tick> {
    let reached = |ticks: &[Tick]| -> Vec<Tick> {
        let is_between = |tick: &&Tick| least < tick.value && tick.value < largest;
        ticks.iter().filter(is_between).cloned().collect()
    };
    let at_bar = reached(named);
    if at_bar.len() >= LEAST_CONTOURS || least >= largest {
        return at_bar;
    }
    if scale == Scale::Log {
        let (first, last) = (decade_from(low) - 1, decade_to(high) + 1);
        let finer = reached(&one_two_five(low, high, first, last).major);
        if finer.len() >= LEAST_CONTOURS {
            return finer;
        }
    }
    let finer =
        (LEAST_CONTOURS..=MOST_NUMBERS).map(|most| reached(&linear(least, largest, most).major));
    finer
        .into_iter()
        .find(|ticks| ticks.len() >= LEAST_CONTOURS)
        .unwrap_or(at_bar)
}

/// Steps of 1, 2 or 5 times a power of ten; the finest for which there are at most `most` labels.
fn linear(low: f64, high: f64, most: usize) -> Ticks {
    let (step, numbers) = finest_step(low, high, most.max(2));
    let power = step.power;
    let digits: Vec<i64> = numbers.map(|k| k * step.digits).collect();
    let labels = decimal_labels(&digits, power);
    let tick = |(&digits, label)| Tick {
        value: Decimal { digits, power }.value(),
        label,
    };
    let major = digits.iter().zip(labels).map(tick).collect();
    // A step of 2 is quartered (0.5), the others are cut in five (0.2, 1).
    let parts = if step.digits == 2 { 4 } else { 5 };
    let fine = Decimal {
        digits: step.digits * 10 / parts,
        power: power - 1,
    };
    let of_fine = |k: i64| Decimal {
        digits: k * fine.digits,
        ..fine
    };
    let minor = multiples(low, high, fine).filter(|k| k % parts != 0);
    Ticks {
        major,
        minor: minor.map(|k| of_fine(k).value()).collect(),
    }
}

fn finest_step(low: f64, high: f64, most: usize) -> (Decimal, std::ops::RangeInclusive<i64>) {
    let mut power = ((high - low) / most as f64).log10().floor() as i32;
    loop {
        for digits in [1, 2, 5] {
            let step = Decimal { digits, power };
            let numbers = multiples(low, high, step);
            let count = numbers.end() - numbers.start() + 1;
            if count <= most as i64 {
                return (step, numbers);
            }
        }
        power += 1;
    }
}

/// The whole numbers k for which k times `step` lies on the axis.
fn multiples(low: f64, high: f64, step: Decimal) -> std::ops::RangeInclusive<i64> {
    let size = step.value();
    let slack = SLACK * (high - low) / size;
    (low / size - slack).ceil() as i64..=(high / size + slack).floor() as i64
}

/// Whole decades, every second, third, fifth ... where there are many; 1-2-5 where the axis holds fewer than two of
/// them, and linear ticks where that gives fewer than three labels.
fn log(low: f64, high: f64, most: usize) -> Ticks {
    let (first, last) = (decade_from(low), decade_to(high));
    if last > first {
        return decades(low, high, first, last, most);
    }
    let mut fine = one_two_five(low, high, first - 1, last + 1);
    if fine.major.len() >= 3 {
        fine.keep_at_most(most.max(2));
        fine
    } else {
        linear(low, high, most.min(MOST_NUMBERS))
    }
}

/// The first power of ten on an axis that starts at `low`.
fn decade_from(low: f64) -> i32 {
    (low.log10() - SLACK).ceil() as i32
}

/// The last power of ten on an axis that ends at `high`.
fn decade_to(high: f64) -> i32 {
    (high.log10() + SLACK).floor() as i32
}

fn decades(low: f64, high: f64, first: i32, last: i32, most: usize) -> Ticks {
    let most = most.max(2) as i32;
    let strides = [1, 2, 3, 5, 10, 20, 50, 100, 200, 500];
    let count = |stride: i32| last.div_euclid(stride) - (first - 1).div_euclid(stride);
    let stride = strides
        .into_iter()
        .find(|&stride| count(stride) <= most)
        .unwrap_or(1000);
    let mut ticks = Ticks::default();
    for power in first - 1..=last {
        let value = Decimal { digits: 1, power }.value();
        let label = power_of_ten(power);
        match power.rem_euclid(stride) {
            _ if power < first => {}
            0 => ticks.major.push(Tick { value, label }),
            _ => ticks.minor.push(value),
        }
        if stride == 1 {
            let between = (2..=9).map(|digits| Decimal { digits, power });
            ticks
                .minor
                .extend(within(low, high, between).map(Decimal::value));
        }
    }
    ticks
}

fn one_two_five(low: f64, high: f64, first: i32, last: i32) -> Ticks {
    let all = |digits: &'static [i64]| {
        let every = (first..=last)
            .flat_map(move |power| digits.iter().map(move |&digits| Decimal { digits, power }));
        within(low, high, every)
    };
    let named: Vec<Decimal> = all(&[1, 2, 5]).collect();
    let plain = named.iter().all(|tick| (1e-3..1e4).contains(&tick.value()));
    let label = |tick: &Decimal| match (plain, tick.digits) {
        (true, _) => plain_decimal(tick.digits, tick.power),
        (false, 1) => power_of_ten(tick.power),
        (false, digits) => format!("{digits} × {}", power_of_ten(tick.power)),
    };
    let tick = |tick: &Decimal| Tick {
        value: tick.value(),
        label: label(tick),
    };
    Ticks {
        major: named.iter().map(tick).collect(),
        minor: all(&[3, 4, 6, 7, 8, 9]).map(Decimal::value).collect(),
    }
}

fn within(
    low: f64,
    high: f64,
    ticks: impl Iterator<Item = Decimal>,
) -> impl Iterator<Item = Decimal> {
    ticks.filter(move |tick| (low * (1.0 - SLACK)..=high * (1.0 + SLACK)).contains(&tick.value()))
}

/// Labels of `digits[i]` times ten to the `power`: decimals with the same number of places, or with a factor of ten
/// where that is needed to keep them short. Zero is always "0".
fn decimal_labels(digits: &[i64], power: i32) -> Vec<String> {
    let largest = digits.iter().map(|n| n.unsigned_abs()).max().unwrap_or(0);
    let size = largest.to_string().len() as i32 + power;
    // Seven figures before the point or five after it are still read at a glance.
    let readable = size <= 7 && power >= -5;
    let labels = |label: fn(i64, i32) -> String| -> Vec<String> {
        digits.iter().map(|&n| label(n, power)).collect()
    };
    let longest = |labels: &[String]| labels.iter().map(|label| label.chars().count()).max();
    let (plain, scientific) = (labels(plain_decimal), labels(scientific));
    if readable || longest(&plain) < longest(&scientific) {
        plain
    } else {
        scientific
    }
}

/// "−0.25", "1500", "25 000"; groups of three are parted by a narrow space from five figures on.
fn plain_decimal(digits: i64, power: i32) -> String {
    if digits == 0 {
        return "0".to_owned();
    }
    let mut figures = digits.unsigned_abs().to_string();
    let places = (-power).max(0) as usize;
    figures.extend(std::iter::repeat_n('0', power.max(0) as usize));
    if figures.len() <= places {
        figures.insert_str(0, &"0".repeat(places + 1 - figures.len()));
    }
    let (whole, part) = figures.split_at(figures.len() - places);
    let sign = if digits < 0 { "−" } else { "" };
    let point = if part.is_empty() { "" } else { "." };
    format!("{sign}{}{point}{part}", grouped(whole))
}

fn grouped(whole: &str) -> String {
    if whole.len() < 5 {
        return whole.to_owned();
    }
    let mut text = String::new();
    for (place, figure) in whole.chars().enumerate() {
        if place > 0 && (whole.len() - place).is_multiple_of(3) {
            text.push('\u{202F}');
        }
        text.push(figure);
    }
    text
}

/// "−2.5 × 10⁹".
fn scientific(digits: i64, power: i32) -> String {
    if digits == 0 {
        return "0".to_owned();
    }
    let figures = digits.unsigned_abs().to_string();
    let exponent = power + figures.len() as i32 - 1;
    let (lead, rest) = figures.split_at(1);
    let rest = rest.trim_end_matches('0');
    let sign = if digits < 0 { "−" } else { "" };
    let point = if rest.is_empty() { "" } else { "." };
    format!("{sign}{lead}{point}{rest} × {}", power_of_ten(exponent))
}

/// "10⁻³".
fn power_of_ten(power: i32) -> String {
    format!("10{}", superscript(power))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn contours_are_at_the_values_of_the_bar_or_at_finer_ones_where_those_are_few() {
        let of = |scale, bar: (f64, f64), data| {
            let named = choose(scale, bar.0, bar.1, |_| true).major;
            let contours = of_contours(scale, bar, data, &named).into_iter();
            contours.map(|tick| tick.label).collect::<Vec<_>>()
        };
        assert_eq!(
            of(Scale::Linear, (0.0, 5.0), (0.5, 4.5)),
            ["1", "2", "3", "4"]
        );
        assert_eq!(
            of(Scale::Linear, (0.0, 5.0), (2.1, 2.9)),
            ["2.2", "2.4", "2.6", "2.8"]
        );
        assert_eq!(
            of(Scale::Log, (1.0, 50.0), (1.0, 50.0)),
            ["2", "5", "10", "20"]
        );
        assert_eq!(of(Scale::Linear, (0.0, 5.0), (2.0, 2.0)), [""; 0]);
    }

    #[test]
    fn what_is_counted_has_ticks_at_whole_numbers() {
        let of = |low: f64, high: f64| labels(&linear(low, high, 8).at_whole_numbers()).join(" ");
        assert_eq!(of(1.0, 2.0), "1 2");
        assert_eq!(of(0.9, 4.1), "1 2 3 4");
        assert_eq!(of(1.0, 40.0), "5 10 15 20 25 30 35 40");
        assert!(linear(1.0, 3.0, 8).at_whole_numbers().minor.is_empty());
    }

    #[test]
    fn less_than_a_decade_without_room_for_all_labels_has_every_second() {
        let all = log(0.004, 0.025, 9);
        assert_eq!(labels(&all), ["0.005", "0.01", "0.02"]);
        let few = log(0.0045, 0.0095, 2);
        assert_eq!(labels(&few).len(), 2);
        let two = choose(Scale::Log, 0.11, 0.95, |ticks| ticks.len() < 3);
        assert_eq!(two.major.len(), 2, "{two:?}");
        // About zero, where the next step names zero alone.
        let about = choose(Scale::Linear, -320.0, 320.0, |ticks| ticks.len() < 3);
        assert_eq!(labels(&about), ["−200", "200"]);
        // All ticks are there still.
        let mut all = one_two_five(0.11, 0.95, -2, 0);
        let values = all.major.iter().map(|tick| tick.value);
        let values: Vec<f64> = values.collect();
        all.keep_at_most(2);
        assert!(
            all.minor.is_sorted()
                && values.iter().all(|v| {
                    all.minor.contains(v) || all.major.iter().any(|tick| tick.value == *v)
                })
        );
    }

    #[test]
    fn linear_steps_are_one_two_or_five() {
        assert_eq!(
            labels(&linear(0.0, 1.0, 6)),
            ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(
            labels(&linear(0.0, 3.6, 8)),
            ["0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0", "3.5"]
        );
        assert_eq!(
            labels(&linear(1900.0, 2500.0, 7)),
            ["1900", "2000", "2100", "2200", "2300", "2400", "2500"]
        );
    }

    #[test]
    fn a_tick_is_the_double_its_label_says() {
        for (low, high) in [
            (0.0, 1.0),
            (-0.7, 0.7),
            (1e-9, 7e-9),
            (0.1, 0.30000000004),
            (-3e7, 5e7),
        ] {
            for tick in linear(low, high, 11).major {
                let written = tick.label.replace('−', "-").replace('\u{202F}', "");
                let written = match written.split_once(" × 10") {
                    None => written,
                    Some((lead, raised)) => {
                        let plain = |c| {
                            "⁰¹²³⁴⁵⁶⁷⁸⁹"
                                .chars()
                                .position(|s| s == c)
                                .map_or('-', |d| (b'0' + d as u8) as char)
                        };
                        format!("{lead}e{}", raised.chars().map(plain).collect::<String>())
                    }
                };
                assert_eq!(
                    written.parse::<f64>().unwrap(),
                    tick.value,
                    "{}",
                    tick.label
                );
            }
        }
    }

    #[test]
    fn negative_ranges_have_a_true_minus_and_a_plain_zero() {
        assert_eq!(
            labels(&linear(-0.5, 0.5, 5)),
            ["−0.4", "−0.2", "0", "0.2", "0.4"]
        );
        assert_eq!(
            labels(&linear(-30.0, -10.0, 5)),
            ["−30", "−25", "−20", "−15", "−10"]
        );
    }

    #[test]
    fn the_ends_of_the_range_are_ticks_despite_rounding() {
        let ticks = linear(0.1, 0.1 + 0.2, 6);
        assert_eq!(labels(&ticks).first(), Some(&"0.10"));
        assert_eq!(labels(&ticks).last(), Some(&"0.30"));
    }

    #[test]
    fn tiny_and_huge_ranges_keep_short_labels() {
        assert_eq!(
            labels(&linear(0.0, 4e-9, 5)),
            ["0", "1 × 10⁻⁹", "2 × 10⁻⁹", "3 × 10⁻⁹", "4 × 10⁻⁹"]
        );
        assert_eq!(
            labels(&linear(0.0, 1e300, 3)),
            ["0", "5 × 10²⁹⁹", "1 × 10³⁰⁰"]
        );
        assert_eq!(labels(&linear(0.0, 5e-280, 6)).len(), 6);
        assert_eq!(
            labels(&linear(0.0, 40_000.0, 3)),
            ["0", "20\u{202F}000", "40\u{202F}000"]
        );
        // A small span far from zero: a power of ten would make these longer, not shorter.
        assert_eq!(
            labels(&linear(1e9, 1e9 + 2.0, 3))[1],
            "1\u{202F}000\u{202F}000\u{202F}001"
        );
    }

    #[test]
    fn no_choice_has_more_labels_than_asked_for() {
        for most in 2..=11 {
            for exponent in -12..12 {
                let high = 3.7 * 10f64.powi(exponent);
                let linear = linear(-0.3 * high, high, most).major.len();
                assert!((1..=most).contains(&linear), "{linear} of {most} at {high}");
                let log = log(high * 1e-9, high * 1e9, most).major.len();
                assert!((1..=most).contains(&log), "{log} of {most} at {high}");
            }
        }
    }

    #[test]
    fn minor_ticks_of_a_linear_axis_lie_between_the_major_ones() {
        let ticks = linear(0.0, 1.0, 6);
        assert_eq!(ticks.minor.len(), 5 * 3); // 0.2 is cut in four
        assert!(
            ticks
                .minor
                .iter()
                .all(|value| ticks.major.iter().all(|tick| tick.value != *value))
        );
    }

    #[test]
    fn log_decades_reach_both_ends_with_eight_minor_ticks_each() {
        let ticks = log(1e-3, 1e2, 11);
        assert_eq!(
            labels(&ticks),
            ["10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹", "10²"]
        );
        assert_eq!(ticks.minor.len(), 5 * 8);
        assert!(
            ticks
                .major
                .iter()
                .all(|tick| tick.value == format!("{:e}", tick.value).parse::<f64>().unwrap())
        );
    }

    #[test]
    fn many_decades_are_labelled_in_strides() {
        let ticks = log(1e-12, 1e12, 9);
        assert_eq!(
            labels(&ticks),
            [
                "10⁻¹²",
                "10⁻⁹",
                "10⁻⁶",
                "10⁻³",
                "10⁰",
                "10³",
                "10⁶",
                "10⁹",
                "10¹²"
            ]
        );
        assert_eq!(ticks.minor.len(), 16); // the decades without a label
    }

    #[test]
    fn less_than_a_decade_is_labelled_at_one_two_five() {
        assert_eq!(labels(&log(0.15, 1.2, 11)), ["0.2", "0.5", "1"]);
        assert_eq!(
            labels(&log(1.5e-6, 1.2e-5, 11)),
            ["2 × 10⁻⁶", "5 × 10⁻⁶", "10⁻⁵"]
        );
    }

    #[test]
    fn a_fraction_of_a_decade_is_labelled_linearly() {
        assert_eq!(
            labels(&log(1900.0, 2500.0, 7)),
            ["1900", "2000", "2100", "2200", "2300", "2400", "2500"]
        );
    }

    #[test]
    fn labels_without_room_are_thinned() {
        let wide = |ticks: &[Tick]| ticks.len() <= 4;
        assert!((2..=4).contains(&choose(Scale::Linear, 0.0, 1.0, wide).major.len()));
        assert!((2..=4).contains(&choose(Scale::Log, 1e-9, 1.0, wide).major.len()));
    }
}
