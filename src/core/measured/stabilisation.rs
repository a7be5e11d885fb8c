//! From which cycle on nothing changes any more, and which cycles stand apart.

use super::quality::{Finding, Outlier};
use super::quantities::{Quantity, Values};
use super::statistics::{mean, student_of_trend};
use crate::numerics::order::median;

/// What is judged.
const JUDGED: [Quantity; 4] = [
    Quantity::EnergyLoss,
    Quantity::PhaseLag,
    Quantity::ApproachAmplitude,
    Quantity::LoadAmplitude,
];
/// A change over the cycles judged that is smaller than this part of the value (of a radian) matters to nobody.
const NOTICEABLE: f64 = 1e-3;
/// Fewer cycles than this show no trend.
const FEWEST: usize = 4;
/// Standard deviations, by the median of the deviations, beyond which a cycle stands apart.
const APART: f64 = 6.0;

/// Which cycles make the mean.
pub(super) struct Judged {
    /// Place of the first from which on nothing changes; `None` where something changes to the end.
    pub(super) first: Option<usize>,
    /// Places of the cycles that count from there on.
    pub(super) used: Vec<usize>,
    pub(super) findings: Vec<Finding>,
}

/// Judges the cycles that are whole: `numbers` are theirs, counted from 1.
pub(super) fn judge(values: &[Values], numbers: &[usize]) -> Judged {
    let count = values.len();
    let mut findings = Vec::new();
    let last_start = count.saturating_sub(FEWEST.max(count.div_ceil(3)));
    let first = match count < FEWEST {
        true => {
            findings.push(Finding::FewCycles { cycles: count });
            Some(0)
        }
        false => starts(last_start).find(|start| trend(&values[*start..]).is_none()),
    };
    let Some(start) = first else {
        let change = trend(&values[last_start..]);
        findings.extend(change.map(|(quantity, change)| Finding::NotStabilised {
            quantity: name(quantity).to_owned(),
            change,
        }));
        return Judged {
            first,
            used: Vec::new(),
            findings,
        };
    };
    let outliers = outliers(&values[start..], &numbers[start..]);
    let is_apart = |place: &usize| {
        let found = outliers.binary_search_by_key(&numbers[*place], |o| o.cycle);
        found.is_ok()
    };
    let used = (start..count).filter(|place| !is_apart(place)).collect();
    if !outliers.is_empty() {
        findings.push(Finding::Outliers { cycles: outliers });
    }
    Judged {
        first,
        used,
        findings,
    }
}

/// Cycles that are tried as the first stabilised one: each of the first, then in steps of a thirtieth of what has passed. Every one
/// of them looks at all cycles behind it, so that all of a long record would cost the square of its length.
fn starts(last: usize) -> impl Iterator<Item = usize> {
    let steps = std::iter::successors(Some(0), |start| Some(start + 1 + start / 32));
    steps.take_while(move |start| *start < last).chain([last])
}

fn name(quantity: Quantity) -> &'static str {
    Quantity::ALL[quantity.place()].2
}

fn column(values: &[Values], quantity: Quantity) -> Option<Vec<f64>> {
    values.iter().map(|cycle| cycle[quantity.place()]).collect()
}

/// What deviations of a quantity are relative to: a phase is in radians already.
fn scale(quantity: Quantity, center: f64) -> f64 {
    match quantity {
        Quantity::PhaseLag => 1.0,
        _ => center.abs(),
    }
}

/// The quantity that changes most over these cycles, and its relative change.
fn trend(values: &[Values]) -> Option<(Quantity, f64)> {
    let of = |quantity| Some((quantity, trend_of(values, quantity)?));
    let found = JUDGED.into_iter().filter_map(of);
    found.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The relative change of a quantity over these cycles, where it is beyond chance and more than matters.
fn trend_of(values: &[Values], quantity: Quantity) -> Option<f64> {
    let column = column(values, quantity)?;
    let scale = scale(quantity, mean(&column)?);
    // What goes on, what settles, what is over after a cycle or two.
    let shapes: [fn(f64) -> f64; 3] = [|k| k, |k| 1.0 / (1.0 + k), |k| (-k).exp2()];
    let changes = shapes.iter().filter_map(|shape| change(&column, shape));
    let largest = changes.fold(0.0, f64::max) / scale;
    (largest > NOTICEABLE).then_some(largest)
}

/// By how much a regression on this shape changes from its largest to its smallest value, where that is not by chance.
fn change(column: &[f64], shape: &dyn Fn(f64) -> f64) -> Option<f64> {
    let shapes: Vec<f64> = (0..column.len()).map(|k| shape(k as f64)).collect();
    let (x0, y0) = (mean(&shapes)?, mean(column)?);
    let pairs = || shapes.iter().zip(column).map(|(x, y)| (x - x0, y - y0));
    let xx: f64 = pairs().map(|(x, _)| x * x).sum();
    let xy: f64 = pairs().map(|(x, y)| x * y).sum();
    let slope = xy / xx;
    let left: f64 = pairs().map(|(x, y)| (y - slope * x).powi(2)).sum();
    let freedom = column.len() as f64 - 2.0;
    let error = (left / freedom / xx).sqrt();
    // The shapes rise or fall throughout.
    let range = (shapes[shapes.len() - 1] - shapes[0]).abs();
    (slope.abs() > student_of_trend(freedom) * error).then(|| slope.abs() * range)
}

/// The cycles that stand apart from the median of all, with the quantity that shows it most.
fn outliers(values: &[Values], numbers: &[usize]) -> Vec<Outlier> {
    if values.len() <= FEWEST {
        return Vec::new();
    }
    let mut apart: Vec<Option<(f64, Outlier)>> = vec![None; values.len()];
    for quantity in JUDGED {
        let Some(column) = column(values, quantity) else {
            continue;
        };
        let center = median(&column);
        let deviations: Vec<f64> = column.iter().map(|value| (value - center).abs()).collect();
        let scale = scale(quantity, center);
        // Of a normal distribution; what rounding leaves of equal cycles is no scatter.
        let deviation = (1.4826 * median(&deviations)).max(1e-4 * NOTICEABLE * scale);
        // The median of few deviations is itself uncertain.
        let limit = APART * (1.0 + 4.0 / values.len() as f64);
        for (place, value) in column.iter().enumerate() {
            let times = (value - center).abs() / deviation;
            let known = apart[place].as_ref().map_or(limit, |(times, _)| *times);
            if times > known {
                let outlier = Outlier {
                    cycle: numbers[place],
                    quantity: name(quantity).to_owned(),
                    relative: (value - center) / scale,
                };
                apart[place] = Some((times, outlier));
            }
        }
    }
    let noticeable = |outlier: &Outlier| outlier.relative.abs() > NOTICEABLE;
    let found = apart.into_iter().flatten().map(|(_, outlier)| outlier);
    found.filter(noticeable).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycles(losses: impl IntoIterator<Item = f64>) -> Vec<Values> {
        let one = |loss: f64| {
            let mut values = [None; Quantity::ALL.len()];
            values[Quantity::EnergyLoss.place()] = Some(loss);
            for quantity in &JUDGED[1..] {
                values[quantity.place()] = Some(1.0);
            }
            values
        };
        losses.into_iter().map(one).collect()
    }

    fn noise(k: usize) -> f64 {
        2e-3 * (12.9 * (k as f64 + 1.3).powf(1.7)).sin()
    }

    fn judged(losses: impl IntoIterator<Item = f64>) -> Judged {
        let values = cycles(losses);
        let numbers: Vec<usize> = (1..=values.len()).collect();
        judge(&values, &numbers)
    }

    #[test]
    fn cycles_that_scatter_are_stabilised_from_the_first_on() {
        let judged = judged((0..30).map(|k| 1.0 + noise(k)));
        assert_eq!((judged.first, judged.used.len()), (Some(0), 30));
        assert!(judged.findings.is_empty());
    }

    #[test]
    fn the_first_cycles_are_left_out_where_they_differ() {
        let judged = judged((0..30).map(|k| 1.0 + noise(k) + 0.2 * (-(k as f64) / 1.5).exp()));
        // What is left is 0.2 exp(-k/1.5): a noise of 0.0014 hides it from the seventh cycle on.
        let first = judged.first.unwrap();
        assert!((3..=9).contains(&first), "{first}");
    }

    #[test]
    fn what_changes_to_the_end_has_no_mean() {
        let judged = judged((0..30).map(|k| 1.0 + noise(k) + 0.01 * k as f64));
        assert_eq!(judged.first, None);
        assert!(matches!(
            judged.findings[..],
            [Finding::NotStabilised { .. }]
        ));
    }

    #[test]
    fn a_long_record_that_drifts_takes_no_longer_than_it_is_long() {
        // Every start tried, each over all behind it: three minutes.
        let since = std::time::Instant::now();
        let judged = judged((0..60_000).map(|k| 1.0 + noise(k) + 1e-5 * k as f64));
        assert_eq!(judged.first, None);
        let took = since.elapsed();
        assert!(took.as_secs() < 30, "{took:?}");
        let tried: Vec<usize> = starts(10_000).collect();
        assert!(
            tried[..=32]
                .iter()
                .enumerate()
                .all(|(k, start)| k == *start)
        );
        assert_eq!(tried.last(), Some(&10_000));
        assert!(tried.len() < 300, "{}", tried.len());
    }

    #[test]
    fn a_cycle_that_stands_apart_is_named() {
        let judged = judged((0..20).map(|k| 1.0 + noise(k) + if k == 11 { 0.1 } else { 0.0 }));
        let [Finding::Outliers { cycles }] = &judged.findings[..] else {
            panic!("{:?}", judged.findings)
        };
        assert_eq!((cycles.len(), cycles[0].cycle), (1, 12));
        assert_eq!(judged.used.len(), 19);
    }

    #[test]
    fn three_cycles_say_nothing_of_trends() {
        let judged = judged([1.0, 1.1, 1.2]);
        assert_eq!(judged.used, [0, 1, 2]);
        assert!(matches!(
            judged.findings[..],
            [Finding::FewCycles { cycles: 3 }]
        ));
    }
}
