//! Lines in what is left of a signal: hum of the mains, vibrations, harmonics that the sampling has folded back.

use super::frequency::{Fit, LINES_A_FREQUENCY, RecordModel, power, uniform};
use super::quality::Finding;
use super::signal::Sampling;
use crate::numerics::order::upper_median;

/// By how much a line stands above the median of its neighbours: of noise alone less than one in ten thousand records has such.
const ABOVE: f64 = 45.0;
/// Neighbours on each side, in frequencies of the record.
const NEIGHBOURS: usize = 48;
/// A smaller line, over the amplitude of the oscillation, matters to nobody.
const NOTICEABLE: f64 = 3e-3;
/// Frequencies of the record on each side of a harmonic that belong to it: a cycle that changes broadens its line.
const BROAD: f64 = 6.0;
/// Points of the transform, at most.
const LARGEST: usize = 1 << 17;
/// Harmonics that are looked for in a folded line.
const FOLDED: usize = 60;

/// The highest line in what a fit leaves of a signal, where there is one.
pub(super) fn highest(
    signal: &'static str,
    model: &RecordModel,
    fit: &Fit,
    times_s: &[f64],
    sampling: &Sampling,
) -> Option<Finding> {
    let residual = fit.residual.as_slice();
    let own_hz = model.angular / std::f64::consts::TAU;
    let points = residual.len().next_power_of_two().clamp(64, LARGEST);
    let resampled = uniform(times_s, residual, points);
    let deviation = (resampled.iter().map(|r| r * r).sum::<f64>() / points as f64).sqrt();
    let lines = power(&resampled);
    let record_hz = 1.0 / sampling.duration_s;
    let line_hz = (points - 1) as f64 / points as f64 * record_hz / LINES_A_FREQUENCY as f64;
    let highest = ((0.5 / sampling.interval_s) / line_hz) as usize;
    let is_own = |hz: f64| {
        let nearest = (hz / own_hz).round();
        let apart = (hz - nearest * own_hz).abs() / record_hz;
        let is_fitted = nearest <= model.harmonics as f64;
        apart < if is_fitted { BROAD } else { 2.0 }
    };
    // A sine of amplitude A makes A points/4 through the window.
    let amplitude = |power: f64| 4.0 * power.sqrt() / points as f64 * deviation;
    let candidates = (1..highest.min(lines.len())).filter(|k| !is_own(line_hz * *k as f64));
    let best = candidates.max_by(|a, b| lines[*a].total_cmp(&lines[*b]))?;
    let size = amplitude(lines[best]);
    if size < NOTICEABLE * fit.amplitude() || lines[best] < ABOVE * around(&lines, best) {
        return None;
    }
    let hz = line_hz * best as f64;
    let sampled_hz = 1.0 / sampling.interval_s;
    let is_folded = |n: &usize| {
        let harmonic_hz = *n as f64 * own_hz;
        let turns = (harmonic_hz / sampled_hz).round();
        turns >= 1.0 && ((harmonic_hz - turns * sampled_hz).abs() - hz).abs() < record_hz
    };
    Some(Finding::Line {
        signal: signal.to_owned(),
        hz,
        amplitude: size,
        folded_harmonic: (model.harmonics + 1..=FOLDED).find(is_folded),
    })
}

/// Median of the lines about one, without those that its window has broadened.
fn around(lines: &[f64], place: usize) -> f64 {
    let (inner, outer) = (3 * LINES_A_FREQUENCY, NEIGHBOURS * LINES_A_FREQUENCY);
    let range = place.saturating_sub(outer).max(1)..(place + outer).min(lines.len());
    let near = range
        .filter(|k| k.abs_diff(place) > inner)
        .filter_map(|k| lines.get(k).copied());
    upper_median(near).unwrap_or(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::{Options, Signal, analyse};
    use std::f64::consts::TAU;

    /// Twenty cycles of 1 Hz with noise and one more line in the approach.
    fn lines(points: f64, hz: f64, amplitude: f64) -> Vec<Finding> {
        let noise = |i: usize, k: f64| 2e-3 * (12.9 * (i as f64 + k).powf(1.7)).sin();
        let time_s: Vec<f64> = (0..(20.3 * points) as usize)
            .map(|i| i as f64 / points)
            .collect();
        let wave = |k: f64, lag: f64, line: f64| -> Vec<f64> {
            let times = time_s.iter().enumerate();
            times
                .map(|(i, t)| {
                    3.0 + (TAU * t - lag).sin() + line * (TAU * hz * t + 0.3).sin() + noise(i, k)
                })
                .collect()
        };
        let signal = Signal {
            load_n: wave(1.0, 0.0, 0.0),
            approach_m: wave(9e4, 0.1, amplitude),
            time_s,
            contact_radius_m: None,
        };
        let findings = analyse(&signal, &Options::default()).unwrap().findings;
        let is_line = |finding: &Finding| matches!(finding, Finding::Line { .. });
        findings.into_iter().filter(is_line).collect()
    }

    #[test]
    fn hum_is_found_where_it_is_and_noise_is_none() {
        assert!(lines(40.0, 7.3, 0.0).is_empty());
        let found = lines(40.0, 7.3, 0.02);
        let [
            Finding::Line {
                hz,
                amplitude,
                folded_harmonic,
                ..
            },
        ] = &found[..]
        else {
            panic!("{found:?}")
        };
        // The grid has four lines to a frequency of the record, of which there are twenty to a hertz.
        assert!((hz - 7.3).abs() < 0.01, "{hz}");
        assert!((amplitude / 0.02 - 1.0).abs() < 0.2, "{amplitude}");
        assert_eq!(*folded_harmonic, None);
    }

    #[test]
    fn a_harmonic_that_the_sampling_folds_back_is_told_as_aliasing() {
        // Twelve harmonics at 17.4 samples a cycle: the twelfth is seen at 5.4 Hz.
        let found = lines(17.4, 12.0, 0.03);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].code(), "aliasing");
        let Finding::Line {
            hz,
            folded_harmonic,
            ..
        } = &found[0]
        else {
            panic!("{found:?}")
        };
        assert!((hz - 5.4).abs() < 0.02, "{hz}");
        assert_eq!(*folded_harmonic, Some(12));
    }
}
