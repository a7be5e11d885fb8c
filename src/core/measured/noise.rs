//! What is left of a signal once the model is taken out, and what it does to a harmonic: correlated noise is larger at low
//! frequencies than its samples say. What a model of a few harmonics leaves of a cycle, the kinks of one that lifts off say, repeats
//! itself and is no noise.

use num_complex::Complex;

/// The noise of one signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Noise {
    /// Variance of a sample.
    pub(super) variance: f64,
    /// Correlation of neighbours.
    phi: f64,
    /// Interval of the samples (s).
    interval_s: f64,
    /// Its power about the fundamental over that of white noise, where there are enough cycles to see it.
    about_fundamental: Option<f64>,
    /// Degrees of freedom of the variance.
    pub(super) freedom: f64,
}

/// Cycles from which on the power between the harmonics is looked at.
const CYCLES: f64 = 8.0;
/// Frequencies on each side of the fundamental.
const SIDE: i32 = 3;

/// Harmonics looked at for what repeats itself.
const HARMONICS: usize = 30;
/// Cycles from which on it is distinguished from what does not.
const REPEATED: f64 = 4.0;
/// Power of a harmonic over that of white noise from which on it is none: by chance one in 20,000 is.
const STANDS_OUT: f64 = 10.0;

/// A residual at these times (s) without the harmonics that stand out of it, and the number of coefficients that it has lost so.
fn without_harmonics(
    residual: &[f64],
    times_s: &[f64],
    interval_s: f64,
    angular: f64,
) -> (Vec<f64>, usize) {
    let mut rest = residual.to_vec();
    let first_s = times_s.first().copied().unwrap_or(0.0);
    let duration_s = times_s.last().map_or(0.0, |last| last - first_s);
    // Of two samples a cycle nothing is left.
    let seen = (0.9 * std::f64::consts::PI / (angular * interval_s)) as usize;
    let harmonics = seen.min(HARMONICS);
    if duration_s * angular / std::f64::consts::TAU < REPEATED || harmonics == 0 {
        return (rest, 0);
    }
    let samples = residual.len() as f64;
    let mut squares: f64 = residual.iter().map(|r| r * r).sum();
    let harmonics = (1..=harmonics).map(|n| n as f64 * angular);
    let mut lines: Vec<(f64, Complex<f64>)> = harmonics
        .map(|frequency| (frequency, line(residual, times_s, frequency)))
        .collect();
    lines.sort_by(|a, b| b.1.norm_sqr().total_cmp(&a.1.norm_sqr()));
    // The strongest first: what it adds hides the others.
    let mut lost = 0;
    for (frequency, line) in lines {
        if line.norm_sqr() <= STANDS_OUT * squares {
            break;
        }
        squares -= 2.0 * line.norm_sqr() / samples;
        lost += 2;
        for (r, t) in rest.iter_mut().zip(times_s) {
            *r -= 2.0 / samples * (line.conj() * Complex::cis(frequency * (t - first_s))).re;
        }
    }
    (rest, lost)
}

/// The sum of a residual times exp(i omega t), from the first of its times (s) on.
fn line(residual: &[f64], times_s: &[f64], angular: f64) -> Complex<f64> {
    let turn = |t: &f64| Complex::cis(angular * (t - times_s[0]));
    let samples = residual.iter().zip(times_s);
    samples.map(|(r, t)| turn(t) * r).sum()
}

/// Correlation of neighbours, not below zero: what alternates does no harm, and may be by chance.
pub(super) fn correlation(residual: &[f64]) -> f64 {
    let squares: f64 = residual.iter().map(|r| r * r).sum();
    let products: f64 = residual.windows(2).map(|pair| pair[0] * pair[1]).sum();
    match squares > 0.0 {
        true => (products / squares).clamp(0.0, 0.999),
        false => 0.0,
    }
}

impl Noise {
    /// Of the residual of a model with this many coefficients, at these times (s).
    pub(super) fn of(
        residual: &[f64],
        times_s: &[f64],
        coefficients: usize,
        interval_s: f64,
        angular: f64,
    ) -> Self {
        let (residual, lost) = without_harmonics(residual, times_s, interval_s, angular);
        let (residual, coefficients) = (residual.as_slice(), coefficients + lost);
        let samples = residual.len() as f64;
        let freedom = (samples - coefficients as f64).max(1.0);
        let squares: f64 = residual.iter().map(|r| r * r).sum();
        // Coefficients that were fitted take correlation out of the residual.
        let phi = (correlation(residual) + coefficients as f64 / (2.0 * samples)).min(0.999);
        let phi = if correlation(residual) > 2.0 / samples.sqrt() {
            phi
        } else {
            0.0
        };
        let mut noise = Self {
            variance: squares / freedom,
            phi,
            interval_s,
            about_fundamental: None,
            freedom: (freedom * (1.0 - phi) / (1.0 + phi)).max(1.0),
        };
        noise.about_fundamental = noise.between_harmonics(residual, times_s, angular);
        noise
    }

    /// Mean power of the residual at a few frequencies about the fundamental, over its variance.
    fn between_harmonics(&self, residual: &[f64], times_s: &[f64], angular: f64) -> Option<f64> {
        let (first, last) = (times_s.first()?, times_s.last()?);
        let cycles = (last - first) * angular / std::f64::consts::TAU;
        if cycles < CYCLES || self.variance <= 0.0 {
            return None;
        }
        let power = |step: i32| {
            // Between the harmonics and between the lines of the record: half a line off.
            let side = f64::from(step) + 0.5 * f64::from(step.signum());
            let frequency = angular * (1.0 + side / cycles);
            line(residual, times_s, frequency).norm_sqr()
        };
        let steps = (-SIDE..=SIDE).filter(|step| *step != 0);
        let sum: f64 = steps.map(power).sum();
        let white = self.variance * residual.len() as f64 * f64::from(2 * SIDE);
        Some(sum / white)
    }

    /// Its power at a multiple of the fundamental over that of white noise of the same variance: by a first-order autoregression, and
    /// by what is seen about the fundamental, the larger.
    pub(super) fn power(&self, angular: f64, harmonic: usize) -> f64 {
        let angle = angular * harmonic as f64 * self.interval_s;
        let phi = self.phi;
        let autoregression = (1.0 - phi * phi) / (1.0 - 2.0 * phi * angle.cos() + phi * phi);
        match (harmonic, self.about_fundamental) {
            // Twelve squares: what is seen is itself uncertain by a good third, and white noise must not look like less.
            (1, Some(seen)) if seen > 2.0 => autoregression.max(seen),
            _ => autoregression.max(if harmonic == 0 { 1.0 } else { 0.0 }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::least_squares::harmonic_columns;
    use std::f64::consts::TAU;

    /// Uniform numbers of a congruential generator (D. E. Knuth's), less their mean, with a correlation of neighbours.
    fn autoregression(samples: usize, phi: f64) -> Vec<f64> {
        let mut state = 7_u64;
        let mut value = 0.0;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..samples)
            .map(|_| {
                value = phi * value + next();
                value
            })
            .collect()
    }

    #[test]
    fn white_noise_is_white_and_correlated_noise_is_larger_at_low_frequencies() {
        let times: Vec<f64> = (0..20_000).map(f64::from).collect();
        let of = |phi| {
            Noise::of(
                &autoregression(times.len(), phi),
                &times,
                13,
                1.0,
                TAU / 400.0,
            )
        };
        let white = of(0.0);
        assert!((white.variance * 12.0 - 1.0).abs() < 0.03);
        assert!((white.power(TAU / 400.0, 1) - 1.0).abs() < 0.1);
        let red = of(0.9);
        // (1 + phi)/(1 - phi) at the lowest frequencies; the window about the fundamental is seen to a good third.
        let power = red.power(TAU / 400.0, 1);
        assert!((12.0..40.0).contains(&power), "{power}");
        assert!(red.power(TAU / 400.0, 5) < 19.5);
    }

    #[test]
    fn what_repeats_itself_in_every_cycle_is_no_noise() {
        // Eight cycles of 60 samples of a signal that is cut off at its bottom, less its first six harmonics.
        let times: Vec<f64> = (0..480).map(f64::from).collect();
        let angular = TAU / 60.0;
        let cut: Vec<f64> = (times.iter())
            .map(|t| (0.5 + (angular * t).sin()).max(0.0))
            .collect();
        let mut row = [0.0; 13];
        let mut sums = [0.0; 13];
        for (value, t) in cut.iter().zip(&times) {
            harmonic_columns(&mut row, angular * t);
            sums.iter_mut()
                .zip(row)
                .for_each(|(sum, column)| *sum += value * column / 240.0);
        }
        let white = autoregression(times.len(), 0.0);
        let size = 0.02;
        let of = |part: f64| {
            let residual = (cut.iter().zip(&times).zip(&white)).map(|((value, t), noise)| {
                let mut row = [0.0; 13];
                harmonic_columns(&mut row, angular * t);
                let fitted: f64 = row
                    .iter()
                    .zip(sums)
                    .skip(1)
                    .map(|(column, sum)| column * sum)
                    .sum();
                part * (value - fitted - 0.5 * sums[0]) + size * noise
            });
            Noise::of(&residual.collect::<Vec<f64>>(), &times, 13, 1.0, angular)
        };
        let (alone, beside) = (of(0.0), of(1.0));
        let ratio = beside.variance / alone.variance;
        assert!((0.9..1.2).contains(&ratio), "{ratio}");
        assert!(beside.freedom > 400.0, "{}", beside.freedom);
        assert!(beside.power(angular, 1) < 1.5);
    }
}
