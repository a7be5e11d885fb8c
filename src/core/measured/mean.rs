//! The mean over the cycles of a record that count: its numbers with their errors, and what is drawn of it.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use super::bias;
use super::cycles::{coefficients, of_coefficients};
use super::frequency::{Fit, RecordModel};
use super::noise::Noise;
use super::quality::Finding;
use super::quantities::{HARMONICS_OF_APPROACH, Quantity, Values};
use super::statistics::{Estimate, StandardError};
use super::{MeasuredLoop, Options, Signal};
use crate::cycle::Harmonics;

/// Parts of a cycle over which samples are averaged to be drawn.
const PARTS: usize = 100;
/// An instrument that takes more than this many times the load of the contact is worth saying.
const DOMINATES: f64 = 1.0;

/// The radius of the circle that holds a complex number with normal errors 95 times in 100, over the half-width of one of its parts.
const CIRCLE: f64 = 1.248_87;
/// Of what is uncertain, the part from which on the steps of a converter are worth saying.
const COARSE: f64 = 0.1;

/// The mean over the cycles that count.
pub(super) struct Mean<'a> {
    pub(super) model: &'a RecordModel,
    pub(super) signal: &'a Signal,
    pub(super) options: &'a Options,
    /// Places among the cycles that were fitted.
    pub(super) used: &'a [usize],
    /// Samples of each of them.
    pub(super) ranges: Vec<Range<usize>>,
    /// As the instrument gives it.
    pub(super) raw: Harmonics,
    /// Mean of the column of radii, where there is one.
    pub(super) column_m: Option<f64>,
}

/// What the noise of the samples leaves uncertain of every quantity.
type Errors = [Option<StandardError>; Quantity::ALL.len()];

impl Mean<'_> {
    /// Fills in what a record has of it: means and errors, the mean cycle, points to be drawn, findings.
    pub(super) fn fill(&self, measured: &mut MeasuredLoop) {
        let corrected = self.corrected(&self.raw);
        self.remarks(&corrected, &mut measured.findings);
        let center = self.values(&self.raw);
        let errors = self.errors(&center, measured).unwrap_or_default();
        for (place, (quantity, ..)) in Quantity::ALL.iter().enumerate() {
            let values = self.used.iter().map(|used| measured.values[*used][place]);
            let Some(mut values) = values.collect::<Option<Vec<f64>>>() else {
                continue;
            };
            if let (true, Some(center)) = (quantity.is_angle(), center[place]) {
                values
                    .iter_mut()
                    .for_each(|v| *v = center + wrapped(*v - center));
            }
            measured.means[place] = Estimate::of(&values, errors[place]);
        }
        for (ratio, phase) in HARMONICS_OF_APPROACH {
            let places = [ratio.place(), phase.place()];
            let [ratio, phase] = self.harmonic(&measured.values, places, &errors);
            measured.means[places[0]] = ratio;
            measured.means[places[1]] = phase;
        }
        measured.points = self.points(measured, &corrected);
        self.take_out_bias(measured, &corrected);
        measured.mean_cycle = corrected;
    }

    fn corrected(&self, raw: &Harmonics) -> Harmonics {
        self.options.corrections.applied(self.model.angular, raw)
    }

    /// Everything that is read from a cycle as the instrument gives it.
    fn values(&self, raw: &Harmonics) -> Values {
        let corrected = self.corrected(raw);
        (self.options).values(&corrected, self.column_m, self.model.angular)
    }

    /// A harmonic of the approach over the first, and its phase. Its cycles are averaged as complex numbers: the magnitudes of what
    /// is no larger than its noise would average to the noise.
    fn harmonic(
        &self,
        values: &[Values],
        [ratio, phase]: [usize; 2],
        errors: &Errors,
    ) -> [Option<Estimate>; 2] {
        let of_cycle = |used: &usize| {
            Some(Complex::from_polar(
                values[*used][ratio]?,
                values[*used][phase]?,
            ))
        };
        let Some(cycles) = self.used.iter().map(of_cycle).collect::<Option<Vec<_>>>() else {
            return [None; 2];
        };
        let mean = cycles.iter().sum::<Complex<f64>>() / cycles.len().max(1) as f64;
        let turn = Complex::cis(-mean.arg());
        let along: Vec<f64> = cycles.iter().map(|z| (z * turn).re).collect();
        let across: Vec<f64> = cycles.iter().map(|z| (z * turn).im / mean.norm()).collect();
        let (of_ratio, of_phase) = (errors[ratio], errors[phase]);
        let mut ratio = Estimate::of(&along, of_ratio);
        let mut phase = Estimate::of(&across, of_phase).map(|of| Estimate {
            value: mean.arg(),
            ..of
        });
        // Near zero the deviation from the truth may point anywhere, and adds to the magnitude more often than not: what holds the
        // truth is a circle, of which the phase sees an angle.
        if let Some((size, error)) = ratio
            .as_mut()
            .and_then(|of| Some((of.value, of.error.as_mut()?)))
            && *error > 0.5 * size
        {
            *error *= CIRCLE;
            if let Some(phase) = phase.as_mut() {
                let seen = *error / size;
                phase.error = Some(match seen < 1.0 {
                    true => seen.asin(),
                    false => std::f64::consts::PI,
                });
            }
        }
        [ratio, phase]
    }

    fn take_out_bias(&self, measured: &mut MeasuredLoop, cycle: &Harmonics) {
        let contact = self.options.contact.as_ref();
        let storage = measured.mean(Quantity::StorageModulus);
        let moduli = storage.zip(measured.mean(Quantity::LossModulus));
        // Without a radius there is nothing that could be biased, and that has been said.
        let (Some(contact), Some(moduli)) = (contact.filter(|contact| contact.bias), moduli) else {
            return;
        };
        match bias::unbiased(contact, cycle, self.model.angular, moduli) {
            Ok(unbiased) => measured.unbiased = Some(unbiased),
            Err(reason) => measured.findings.push(Finding::NoBias {
                reason: reason.to_string(),
            }),
        }
    }

    fn remarks(&self, corrected: &Harmonics, findings: &mut Vec<Finding>) {
        let corrections = &self.options.corrections;
        let share = corrections.share(self.model.angular, &self.raw, corrected);
        if let Some(ratio) = share.filter(|ratio| *ratio > DOMINATES) {
            findings.push(Finding::CorrectionDominates { ratio });
        }
        if corrected.energy_loss_j() < 0.0 {
            findings.push(Finding::Leads);
        }
        let Some(contact) = &self.options.contact else {
            return;
        };
        if corrected.load_mean_n < corrected.load_n.first().map_or(0.0, |a| a.norm()) {
            findings.push(Finding::Pull);
        }
        if let Err(reason) = contact.radius_m(corrected, self.column_m) {
            findings.push(Finding::NoRadius { reason });
        }
    }

    /// Standard errors from the noise of the samples, carried through every formula: of the mean cycle fitted at once to all
    /// samples that count, drift included, so that what a drift leaves uncertain counts too.
    fn errors(&self, center: &Values, measured: &mut MeasuredLoop) -> Option<Errors> {
        let signal = self.used_samples();
        let sampling = measured.sampling;
        let steps = [
            ("load", sampling.load_step_n),
            ("approach", sampling.approach_step_m),
        ];
        let mut variances = DVector::zeros(Quantity::ALL.len());
        let mut freedom = f64::INFINITY;
        let fits = self.model.fits(&signal)?;
        for (which, (fit, (name, step))) in fits.iter().zip(steps).enumerate() {
            let noise = self.model.noise(fit, &signal.time_s, sampling.interval_s);
            freedom = freedom.min(noise.freedom);
            let mut rounding = 0.0;
            if let Some(step) = step {
                rounding = self.rounding(&signal.time_s, step, fit, &noise);
                if rounding > COARSE * noise.variance * noise.power(self.model.angular, 1) {
                    let signal = name.to_owned();
                    measured.findings.push(Finding::Quantised { signal, step });
                }
            }
            let covariance = self.covariance(fit, &noise, rounding);
            let slopes = self.slopes(which, center, &covariance.diagonal());
            variances += (&slopes * covariance * slopes.transpose()).diagonal();
        }
        Some(std::array::from_fn(|place| {
            center[place].map(|_| StandardError {
                value: variances[place].max(0.0).sqrt(),
                freedom,
            })
        }))
    }

    /// The samples of the cycles that count.
    fn used_samples(&self) -> Signal {
        let ranges = || self.ranges.iter().cloned();
        let taken = |column: &[f64]| ranges().flat_map(|own| &column[own]).copied().collect();
        Signal {
            time_s: taken(&self.signal.time_s),
            load_n: taken(&self.signal.load_n),
            approach_m: taken(&self.signal.approach_m),
            contact_radius_m: None,
        }
    }

    /// The variance of a sample that stands for what the steps of a converter leave in a mean over cycles. Where the noise does not
    /// reach from step to step, the same phase of every cycle is rounded the same way, so that as many errors are independent as
    /// there are phases that are rounded differently; white noise of this variance in all samples does as much. B. Widrow's theorem
    /// says what noise leaves of it (B. Widrow, I. Kollar, M.-C. Liu, IEEE Trans. Instrum. Meas. 45, 1996, 353).
    fn rounding(&self, times_s: &[f64], step: f64, fit: &Fit, noise: &Noise) -> f64 {
        use std::f64::consts::{PI, TAU};
        /// More bins than these are not told apart.
        const BINS: f64 = 1e6;
        let rounding = step * step / 12.0;
        let noise_squared = (noise.variance - rounding).max(0.0) / (step * step);
        let repeated = rounding * (-4.0 * PI * PI * noise_squared).exp();
        // Phases within which the signal moves by a step at its steepest.
        let bins = (TAU * fit.amplitude() / step).clamp(1.0, BINS);
        let mut is_seen = vec![false; bins.ceil() as usize];
        for time_s in times_s {
            let turns = (time_s - self.model.span.first_s) * self.model.angular / TAU;
            // A sample on a seam of bins stays on one side of it, whatever the last digit of its time.
            let bin = (turns - turns.floor()) * bins + 1e-3;
            let place = bin as usize % is_seen.len();
            is_seen[place] = true;
        }
        let phases = is_seen.iter().filter(|seen| **seen).count().max(1);
        repeated * (times_s.len() as f64 / phases as f64 - 1.0).max(0.0)
    }

    /// Covariance of mean and harmonics of one signal, with a further variance of every sample.
    fn covariance(&self, fit: &Fit, noise: &Noise, rounding: f64) -> DMatrix<f64> {
        let inverse = fit.normal.inverse();
        let scale = |column: usize| {
            let power = noise.power(self.model.angular, column.div_ceil(2));
            (noise.variance * power + rounding).sqrt()
        };
        let p = self.model.common();
        DMatrix::from_fn(p, p, |i, j| inverse[(i, j)] * scale(i) * scale(j))
    }

    /// Derivatives of every quantity (rows) by mean and harmonics of one signal (columns), by central differences over a part of the
    /// standard errors:
    /// the size of a harmonic that is smaller than its error has a slope only close by.
    fn slopes(&self, which: usize, center: &Values, variances: &DVector<f64>) -> DMatrix<f64> {
        let moved = |column: usize, by: f64| {
            let mut moved = coefficients(&self.raw);
            moved[which][column] += by;
            self.values(&of_coefficients(&moved))
        };
        let mut slopes = DMatrix::zeros(Quantity::ALL.len(), self.model.common());
        for (column, mut slopes) in slopes.column_iter_mut().enumerate() {
            let step = 0.05 * variances[column].sqrt();
            if !(step.is_finite() && step > 0.0) {
                continue;
            }
            let (up, down) = (moved(column, step), moved(column, -step));
            for (place, (quantity, ..)) in Quantity::ALL.iter().enumerate() {
                if let (Some(up), Some(down), Some(_)) = (up[place], down[place], center[place]) {
                    let change = match quantity.is_angle() {
                        true => wrapped(up - down),
                        false => up - down,
                    };
                    slopes[place] = change / (2.0 * step);
                }
            }
        }
        slopes
    }

    /// Averages over parts of the cycle: the corrected mean cycle, and what the samples have beside the harmonics.
    fn points(&self, measured: &MeasuredLoop, corrected: &Harmonics) -> Vec<(f64, f64)> {
        let parts = PARTS.min(measured.points_per_cycle as usize).max(1);
        let (load, approach) = self.raw.sampled(parts);
        let (true_load, true_approach) = corrected.sampled(parts);
        let mut sums = vec![(0.0, 0.0, 0_usize); parts];
        let first_s = self.signal.time_s.first().copied().unwrap_or(0.0);
        for i in self.ranges.iter().cloned().flatten() {
            let time_s = self.signal.time_s[i];
            let turns = (time_s - first_s) * self.model.angular / std::f64::consts::TAU;
            let part = parts as f64 * (turns - turns.floor());
            let (low, weight) = (part as usize % parts, part - part.floor());
            let between =
                |samples: &[f64]| samples[low] + weight * (samples[low + 1] - samples[low]);
            let sum = &mut sums[(part.round() as usize) % parts];
            sum.0 += self.signal.load_n[i] - measured.drifts[0].at(time_s) - between(&load);
            sum.1 += self.signal.approach_m[i] - measured.drifts[1].at(time_s) - between(&approach);
            sum.2 += 1;
        }
        let known = sums.iter().enumerate().filter(|(_, sum)| sum.2 > 0);
        known
            .map(|(k, (w, d, count))| {
                let count = *count as f64;
                (true_load[k] + w / count, true_approach[k] + d / count)
            })
            .collect()
    }
}

/// The mean of cycles as the instrument gives them: their harmonics share one origin of time.
pub(super) fn mean_cycle<'a>(cycles: impl ExactSizeIterator<Item = &'a Harmonics>) -> Harmonics {
    let count = cycles.len().max(1) as f64;
    let sum = cycles
        .map(coefficients)
        .reduce(|[a, b], [c, d]| [a + c, b + d]);
    sum.map_or_else(Harmonics::default, |sum| {
        of_coefficients(&sum.map(|of| of / count))
    })
}

/// An angle between -pi and pi.
fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle + PI).rem_euclid(TAU) - PI
}
