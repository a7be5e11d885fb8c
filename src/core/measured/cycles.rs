//! The record cut into cycles, each fitted by itself with mean and harmonics at the times of its samples.

use std::ops::Range;

use nalgebra::DVector;
use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::Signal;
use super::corrections::Corrections;
use super::drift::{Drift, DriftModel, Span};
use super::frequency::RecordModel;
use crate::cycle::Harmonics;

/// One cycle as measured, drift taken off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// From 1, in the order of time.
    pub number: usize,
    /// When it begins, from the first sample (s).
    pub start_s: f64,
    pub samples: usize,
    /// As the instrument gives them.
    pub raw: Harmonics,
    /// Without what the instrument adds.
    pub corrected: Harmonics,
    /// Drift of load and approach at its middle.
    pub load_drift_n: f64,
    pub approach_drift_m: f64,
    /// Mean of the column of radii, where there is one.
    pub contact_radius_m: Option<f64>,
}

/// Samples that a cycle must have of those it should have.
const COMPLETE: f64 = 0.7;
/// Largest gap within a cycle, in parts of it.
const GAP: f64 = 0.25;
/// What may be missing of a cycle at the end of a record.
const END: f64 = 0.02;

/// Cuts a record, from its first sample on, into whole cycles: the samples of each.
pub(super) fn cut(signal: &Signal, period_s: f64, interval_s: f64) -> Vec<Range<usize>> {
    let times = &signal.time_s;
    let Span { first_s, last_s } = Span::of(signal);
    let whole = (last_s - first_s + interval_s) / period_s + END;
    let begin = |number: usize| {
        let start = first_s + number as f64 * period_s;
        // A sample on the seam opens the next cycle, whatever the last digit of its time.
        times.partition_point(|time| *time < start - 1e-6 * interval_s)
    };
    let numbers = 0..whole.floor().max(0.0) as usize;
    numbers.map(|k| begin(k)..begin(k + 1)).collect()
}

/// Whether a cycle has about all samples at these times (s) that it should have.
fn is_complete(times_s: &[f64], period_s: f64, interval_s: f64) -> bool {
    let gap = times_s.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    times_s.len() as f64 >= COMPLETE * period_s / interval_s && gap <= GAP * period_s + interval_s
}

/// Every cycle of these samples that is complete, fitted and corrected, and the numbers of the others.
pub(super) fn fitted(
    signal: &Signal,
    ranges: &[Range<usize>],
    interval_s: f64,
    model: &RecordModel,
    drifts: &[Drift; 2],
    corrections: &Corrections,
) -> (Vec<Cycle>, Vec<usize>) {
    let period_s = std::f64::consts::TAU / model.angular;
    let (mut cycles, mut incomplete) = (Vec::new(), Vec::new());
    for (number, range) in (1..).zip(ranges) {
        let is_complete = is_complete(&signal.time_s[range.clone()], period_s, interval_s);
        let whole = is_complete.then(|| fit(signal, range.clone(), model, drifts));
        match whole.flatten() {
            Some(cycle) => cycles.push(Cycle {
                number,
                corrected: corrections.applied(model.angular, &cycle.raw),
                ..cycle
            }),
            None => incomplete.push(number),
        }
    }
    (cycles, incomplete)
}

/// One cycle fitted, still without its number and as the instrument gives it; `None` where its samples do not determine it.
fn fit(
    signal: &Signal,
    range: Range<usize>,
    model: &RecordModel,
    drifts: &[Drift; 2],
) -> Option<Cycle> {
    let times = signal.time_s.get(range.clone())?;
    let fitted = |values: &[f64], drift: &Drift| {
        let own = values.get(range.clone())?.iter().zip(times);
        let flat: Vec<f64> = own.map(|(value, time)| value - drift.at(*time)).collect();
        Some(model.fit(times, &flat, DriftModel::None)?.coefficients)
    };
    let load = fitted(&signal.load_n, &drifts[0])?;
    let approach = fitted(&signal.approach_m, &drifts[1])?;
    let (first, last) = (times.first()?, times.last()?);
    let middle_s = 0.5 * (first + last);
    let radii = signal.contact_radius_m.as_ref();
    let radii = radii.and_then(|radii| radii.get(range.clone())).into_iter();
    let known = radii.flatten().copied().filter(|r| r.is_finite());
    Some(Cycle {
        number: 0,
        start_s: first - model.span.first_s,
        samples: times.len(),
        raw: of_coefficients(&[load, approach]),
        corrected: Harmonics::default(),
        load_drift_n: drifts[0].at(middle_s),
        approach_drift_m: drifts[1].at(middle_s),
        contact_radius_m: super::statistics::mean(&known.collect::<Vec<f64>>()),
    })
}

/// A cycle from the coefficients of load and approach: mean, then sine and cosine of every harmonic |a| sin(n omega t + arg a).
pub(super) fn of_coefficients([load, approach]: &[DVector<f64>; 2]) -> Harmonics {
    let harmonics = |coefficients: &DVector<f64>| {
        let pairs = coefficients.as_slice()[1..].chunks_exact(2);
        pairs.map(|pair| Complex::new(pair[0], pair[1])).collect()
    };
    Harmonics {
        load_mean_n: load[0],
        approach_mean_m: approach[0],
        load_n: harmonics(load),
        approach_m: harmonics(approach),
    }
}

/// The coefficients of load and approach of a cycle.
pub(super) fn coefficients(cycle: &Harmonics) -> [DVector<f64>; 2] {
    let signal = |mean: f64, harmonics: &[Complex<f64>]| {
        let pairs = harmonics.iter().flat_map(|a| [a.re, a.im]);
        DVector::from_vec(std::iter::once(mean).chain(pairs).collect())
    };
    [
        signal(cycle.load_mean_n, &cycle.load_n),
        signal(cycle.approach_mean_m, &cycle.approach_m),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn record(samples: usize, interval_s: f64) -> Signal {
        let time_s: Vec<f64> = (0..samples).map(|i| 5.0 + interval_s * i as f64).collect();
        let wave =
            |t: &f64| 2.0 + (TAU * (t - 5.0) + 0.3).sin() + 0.1 * (2.0 * TAU * (t - 5.0)).cos();
        Signal {
            load_n: time_s.iter().map(wave).collect(),
            approach_m: time_s.iter().map(|t| 3.0 * wave(t)).collect(),
            time_s,
            contact_radius_m: None,
        }
    }

    #[test]
    fn a_record_is_cut_into_whole_cycles_from_its_first_sample() {
        let incomplete = |signal: &Signal| {
            let all = (1..).zip(cut(signal, 1.0, 0.05));
            let is_incomplete =
                |range: &Range<usize>| !is_complete(&signal.time_s[range.clone()], 1.0, 0.05);
            let found = all.filter(|(_, range)| is_incomplete(range));
            found.map(|(number, _)| number).collect::<Vec<usize>>()
        };
        // Exactly three cycles without the sample that would close them; three and a half; one sample short.
        for (samples, cycles) in [(60, 3), (61, 3), (70, 3), (58, 2), (80, 4)] {
            let signal = record(samples, 0.05);
            let cut = cut(&signal, 1.0, 0.05);
            assert_eq!(cut.len(), cycles, "{samples}");
            assert!(cut.iter().all(|range| range.len() == 20));
            assert!(incomplete(&signal).is_empty());
        }
        let mut gappy = record(80, 0.05);
        for column in [&mut gappy.time_s, &mut gappy.load_n, &mut gappy.approach_m] {
            column.drain(25..32);
        }
        assert_eq!(incomplete(&gappy), [2]);
    }

    #[test]
    fn harmonics_of_a_cycle_have_their_phases_from_the_first_sample() {
        let signal = record(60, 0.05);
        let model = RecordModel::with_parabolas(&signal, TAU, 3);
        let none = || Drift::new(DriftModel::None, &[], model.span);
        for range in [0..20, 20..40] {
            let cycle = fit(&signal, range, &model, &[none(), none()]).unwrap();
            let first = cycle.raw.load_n[0];
            // Rounding of times near 5 s.
            assert!((first.norm() - 1.0).abs() < 1e-11 && (first.arg() - 0.3).abs() < 1e-11);
            let second = cycle.raw.approach_m[1];
            assert!((second.norm() - 0.3).abs() < 1e-11);
            assert!((second.arg() - 0.5 * std::f64::consts::PI).abs() < 1e-10);
            assert!((cycle.raw.load_mean_n - 2.0).abs() < 1e-11);
        }
    }
}
