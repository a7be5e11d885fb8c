//! What is left of a signal once the model is taken out, and what it does to a harmonic: correlated noise is larger at low
//! frequencies than its samples say.

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
    /// Of the residual of a model with so many coefficients, at these times (s).
    pub(super) fn of(
        residual: &[f64],
        times_s: &[f64],
        coefficients: usize,
        interval_s: f64,
        angular: f64,
    ) -> Self {
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
            let (mut re, mut im) = (0.0, 0.0);
            for (r, t) in residual.iter().zip(times_s) {
                let (sine, cosine) = (frequency * (t - first)).sin_cos();
                re += r * cosine;
                im += r * sine;
            }
            re * re + im * im
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
}
