//! The frequency of a record: the highest line of the spectrum, then least squares of one frequency with its harmonics in both
//! signals at once, at the times of the samples as they are.

use contact_dma_transforms::Precision as _;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::drift::{self, DriftModel, Span};
use super::least_squares::{LEAST, Normal, harmonic_columns};
use super::noise::Noise;
use super::signal::Sampling;
use super::{MeasuredError, Signal};

/// The frequency of the oscillation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Frequency {
    pub hz: f64,
    /// `None` where the frequency was given.
    pub standard_error_hz: Option<f64>,
    pub is_given: bool,
}

impl Frequency {
    pub fn angular_rad_per_s(&self) -> f64 {
        std::f64::consts::TAU * self.hz
    }
}

/// By how much the grid of the transform is finer than that of the record's own frequencies.
pub(super) const LINES_A_FREQUENCY: usize = 4;
/// Points of the resampled record, at most.
const LARGEST: usize = 1 << 18;
/// Steps of Gauss and Newton; from the spectrum it takes three or four.
const STEPS: usize = 15;

/// The frequency (Hz) at which both signals oscillate most: the largest product of their spectra.
pub(super) fn of_spectrum(signal: &Signal, sampling: &Sampling) -> Result<f64, MeasuredError> {
    let points = sampling.samples.next_power_of_two().clamp(64, LARGEST);
    let spectrum = |values: &[f64]| power(&uniform(&signal.time_s, values, points));
    let (load, approach) = (spectrum(&signal.load_n), spectrum(&signal.approach_m));
    let line_hz = (points - 1) as f64 / (points * LINES_A_FREQUENCY) as f64 / sampling.duration_s;
    // Below, a drift is what is seen; above, samples say nothing.
    let lowest = (0.8 * LINES_A_FREQUENCY as f64).ceil() as usize;
    let highest = (0.5 / sampling.interval_s / line_hz).ceil() as usize;
    let product = |k: usize| load.get(k).zip(approach.get(k)).map_or(0.0, |(w, d)| w * d);
    let lines = lowest..=highest.min(load.len().saturating_sub(1));
    let best = lines.max_by(|a, b| product(*a).total_cmp(&product(*b)));
    let best = best.filter(|k| product(*k) > 0.0);
    let Some(k) = best else {
        return Err(MeasuredError::NoOscillation {
            signal: "load",
            given_hz: None,
        });
    };
    Ok(refined_by_scan(signal, sampling, k as f64 * line_hz))
}

/// A signal at uniform times, by lines between its samples.
pub(super) fn uniform(times_s: &[f64], values: &[f64], points: usize) -> Vec<f64> {
    let (first, last) = (times_s[0], times_s[times_s.len() - 1]);
    let step = (last - first) / (points - 1) as f64;
    let mut at = 0;
    (0..points)
        .map(|k| {
            let time = first + step * k as f64;
            while at + 2 < times_s.len() && times_s[at + 1] < time {
                at += 1;
            }
            let width = times_s[at + 1] - times_s[at];
            match width > 0.0 {
                true => {
                    let part = ((time - times_s[at]) / width).clamp(0.0, 1.0);
                    values[at] + part * (values[at + 1] - values[at])
                }
                false => values[at],
            }
        })
        .collect()
}

/// The power of a signal without its parabola, through a window (von Hann), over its variance.
pub(super) fn power(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let u = |i: usize| 2.0 * i as f64 / (n - 1) as f64 - 1.0;
    let legendre: [fn(f64) -> f64; 3] = [|_| 1.0, |u| u, |u| 1.5 * u * u - 0.5];
    let mut flat = values.to_vec();
    for polynomial in legendre {
        let (mut own, mut with) = (0.0, 0.0);
        for (i, value) in flat.iter().enumerate() {
            let p = polynomial(u(i));
            own += p * p;
            with += p * value;
        }
        for (i, value) in flat.iter_mut().enumerate() {
            *value -= with / own * polynomial(u(i));
        }
    }
    let variance: f64 = flat.iter().map(|value| value * value).sum::<f64>() / n as f64;
    let scale = if variance > 0.0 {
        variance.sqrt().recip()
    } else {
        0.0
    };
    for (i, value) in flat.iter_mut().enumerate() {
        *value *= scale * (0.5 + 0.5 * (std::f64::consts::PI * u(i)).cos());
    }
    flat.resize(n * LINES_A_FREQUENCY, 0.0);
    let transform = f64::real_forward(flat.len());
    let mut lines = transform.make_output_vec();
    match transform.process(&mut flat, &mut lines) {
        Ok(()) => lines.iter().map(|line| line.norm_sqr()).collect(),
        // The lengths are those the plan was made for.
        Err(_) => Vec::new(),
    }
}

/// The frequency (Hz) near that of a line of the spectrum which explains most, harmonics and a parabola beside it.
fn refined_by_scan(signal: &Signal, sampling: &Sampling, about_hz: f64) -> f64 {
    /// On each side; together a little more than a line of the record.
    const SIDE: i32 = 6;
    const SAMPLES: usize = 1500;
    let points = (1.0 / (about_hz * sampling.interval_s)).max(1.0);
    let thin = (signal.time_s.len() / SAMPLES)
        .min((points / 8.0) as usize)
        .max(1);
    let thinned = |column: &[f64]| column.iter().copied().step_by(thin).collect::<Vec<f64>>();
    let few = Signal {
        time_s: thinned(&signal.time_s),
        load_n: thinned(&signal.load_n),
        approach_m: thinned(&signal.approach_m),
        contact_radius_m: None,
    };
    let step_hz = 0.1 / sampling.duration_s;
    let harmonics = if points / thin as f64 > 6.0 && about_hz * sampling.duration_s > 2.5 {
        2
    } else {
        1
    };
    let unexplained = |hz: f64| {
        let angular = std::f64::consts::TAU * hz;
        let model = RecordModel::with_parabolas(&few, angular, harmonics);
        model.fits(&few).map_or(f64::INFINITY, |fits| {
            fits.iter().map(|fit| fit.unexplained).sum()
        })
    };
    let tried = (-SIDE..=SIDE).map(|k| about_hz + f64::from(k) * step_hz);
    let tried = tried
        .filter(|hz| *hz > 0.3 * about_hz)
        .map(|hz| (unexplained(hz), hz));
    tried
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(about_hz, |best| best.1)
}

/// One frequency with its harmonics and a drift for each signal.
pub(super) struct RecordModel {
    pub(super) angular: f64,
    pub(super) harmonics: usize,
    pub(super) drifts: [DriftModel; 2],
    pub(super) span: Span,
}

/// A model fitted to one signal.
pub(super) struct Fit {
    design: DMatrix<f64>,
    pub(super) normal: Normal,
    /// Mean, sine and cosine of every harmonic, drift.
    pub(super) coefficients: DVector<f64>,
    pub(super) residual: DVector<f64>,
    /// The part of the variance that is left.
    pub(super) unexplained: f64,
}

impl Fit {
    /// Of the first harmonic.
    pub(super) fn amplitude(&self) -> f64 {
        self.coefficients[1].hypot(self.coefficients[2])
    }

    /// The part of the variance that is left with a further function; `None` of one that has next to nothing of its own.
    pub(super) fn unexplained_with(&self, function: &DVector<f64>) -> Option<f64> {
        let (product, own) = self.further(function);
        let left = self.residual.norm_squared();
        let part = self.unexplained / left * (left - product * product / own);
        (own > LEAST * LEAST * function.norm_squared()).then_some(part)
    }

    /// Product of a further function with the residual, and the square of what it has of its own beside those of the model.
    pub(super) fn further(&self, function: &DVector<f64>) -> (f64, f64) {
        let products = &self.design * function;
        let explained = products.dot(&self.normal.solve(&products));
        (
            function.dot(&self.residual),
            function.norm_squared() - explained,
        )
    }
}

impl RecordModel {
    /// With a parabola for each drift.
    pub(super) fn with_parabolas(signal: &Signal, angular: f64, harmonics: usize) -> Self {
        Self {
            angular,
            harmonics,
            drifts: [DriftModel::Polynomial { degree: 2 }; 2],
            span: Span::of(signal),
        }
    }

    /// Chooses the drifts at the frequency of the model, beside this many harmonics.
    pub(super) fn select_drifts(&mut self, signal: &Signal, harmonics: usize) {
        let model = Self { harmonics, ..*self };
        self.drifts = [&signal.load_n, &signal.approach_m]
            .map(|values| drift::select(&model, &signal.time_s, values));
    }

    /// Number of coefficients of mean and harmonics.
    pub(super) fn common(&self) -> usize {
        1 + 2 * self.harmonics
    }

    /// Mean, harmonics and this drift fitted to samples; `None` where these do not determine them.
    pub(super) fn fit(&self, times_s: &[f64], values: &[f64], drift: DriftModel) -> Option<Fit> {
        let mut design = DMatrix::zeros(self.common() + drift.size(), times_s.len());
        for (mut sample, time_s) in design.column_iter_mut().zip(times_s) {
            let (common, own) = sample.as_mut_slice().split_at_mut(self.common());
            harmonic_columns(common, self.angular * (time_s - self.span.first_s));
            drift.fill(own, &self.span, *time_s);
        }
        let normal = Normal::new(&design)?;
        let values = DVector::from_column_slice(values);
        // Without the mean, so that nothing is lost to cancellation.
        let mean = values.mean();
        let centered = values.add_scalar(-mean);
        let mut coefficients = normal.solve(&(&design * &centered));
        let residual = &centered - design.tr_mul(&coefficients);
        let unexplained = residual.norm_squared() / centered.norm_squared();
        coefficients[0] += mean;
        Some(Fit {
            design,
            normal,
            coefficients,
            residual,
            unexplained,
        })
    }

    /// Load and approach fitted; `None` where the samples do not determine the model.
    pub(super) fn fits(&self, signal: &Signal) -> Option<[Fit; 2]> {
        let [load, approach] = self.drifts;
        Some([
            self.fit(&signal.time_s, &signal.load_n, load)?,
            self.fit(&signal.time_s, &signal.approach_m, approach)?,
        ])
    }

    /// The noise of what a fit to samples at these times (s) leaves.
    pub(super) fn noise(&self, fit: &Fit, times_s: &[f64], interval_s: f64) -> Noise {
        let (residual, coefficients) = (fit.residual.as_slice(), fit.coefficients.len());
        Noise::of(residual, times_s, coefficients, interval_s, self.angular)
    }

    /// The frequency by least squares, and its standard error (rad/s); leaves it in the model. `None` where it does not settle.
    pub(super) fn settle(&mut self, signal: &Signal, sampling: &Sampling) -> Option<f64> {
        let start = self.angular;
        let line = std::f64::consts::TAU / sampling.duration_s;
        for _ in 0..STEPS {
            let (mut slope, mut curvature, mut error) = (0.0, 0.0, 0.0);
            for fit in self.fits(signal)? {
                // Variable projection in the form of L. Kaufman (BIT 15, 1975, 49).
                let derivative = self.derivative(&fit, signal);
                let (own_slope, own_curvature) = fit.further(&derivative);
                let noise = self.noise(&fit, &[], sampling.interval_s);
                let size = fit.amplitude();
                // An exact record has no noise to weigh by, but rounding.
                let variance = noise.variance.max(1e-24 * size * size);
                let power = noise.power(self.angular, 1).max(1.0);
                slope += own_slope / variance;
                curvature += own_curvature / variance;
                error += own_curvature / (variance * power);
            }
            if !(curvature > 0.0 && slope.is_finite()) {
                return None;
            }
            let step = (slope / curvature).clamp(-0.25 * line, 0.25 * line);
            self.angular += step;
            if !(self.angular > 0.0 && (self.angular - start).abs() < 2.0 * line) {
                return None;
            }
            let standard_error = error.sqrt().recip();
            if step.abs() < (1e-2 * standard_error).max(1e-13 * self.angular) {
                return Some(standard_error);
            }
        }
        None
    }

    /// The derivative of a fitted signal by the frequency.
    fn derivative(&self, fit: &Fit, signal: &Signal) -> DVector<f64> {
        let samples = fit.design.column_iter().zip(&signal.time_s);
        let derivative = samples.map(|(row, time_s)| {
            let turned = (1..=self.harmonics).map(|n| {
                let (sine, cosine) = (row[2 * n - 1], row[2 * n]);
                let (s, c) = (fit.coefficients[2 * n - 1], fit.coefficients[2 * n]);
                n as f64 * (s * cosine - c * sine)
            });
            (time_s - self.span.first_s) * turned.sum::<f64>()
        });
        DVector::from_iterator(signal.time_s.len(), derivative)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn record(hz: f64, times: impl Iterator<Item = f64>) -> Signal {
        let time_s: Vec<f64> = times.collect();
        let wave = |t: &f64| (TAU * hz * t + 0.4).sin();
        let second = |t: &f64| 0.1 * (2.0 * TAU * hz * t - 1.0).sin();
        Signal {
            load_n: time_s.iter().map(|t| 3.0 + wave(t)).collect(),
            approach_m: time_s
                .iter()
                .map(|t| 1e-6 * (2.0 + 0.05 * t + wave(t) + second(t)))
                .collect(),
            time_s,
            contact_radius_m: None,
        }
    }

    fn found(signal: &Signal) -> f64 {
        let (signal, sampling, _) = signal.prepared().unwrap();
        let about = of_spectrum(&signal, &sampling).unwrap();
        let drifts = [DriftModel::None, DriftModel::Polynomial { degree: 1 }];
        let mut model = RecordModel::with_parabolas(&signal, TAU * about, 3);
        model.drifts = drifts;
        model.settle(&signal, &sampling).unwrap();
        model.angular / TAU
    }

    #[test]
    fn the_frequency_of_an_exact_record_is_found_to_rounding_wherever_it_lies() {
        for (hz, samples, interval) in [
            (1.0, 64, 0.05),
            (1.0, 2000, 5e-3),
            (0.137, 400, 0.11),
            (83.7, 5000, 1e-4),
            (2.3e-4, 300, 97.0),
        ] {
            let signal = record(hz, (0..samples).map(|i| interval * f64::from(i)));
            let error = found(&signal) / hz - 1.0;
            assert!(error.abs() < 1e-9, "{hz} Hz: {error:e}");
        }
    }

    #[test]
    fn times_that_are_not_uniform_are_taken_as_they_are() {
        let jittered = (0..500).map(|i| 0.02 * f64::from(i) + 4e-3 * (5.1 * f64::from(i)).sin());
        let error = found(&record(1.3, jittered)) / 1.3 - 1.0;
        assert!(error.abs() < 1e-9, "{error:e}");
    }
}
