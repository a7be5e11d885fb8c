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
use super::signal::Sampling;
use super::statistics::{Estimate, StandardError};
use super::{MeasuredLoop, Options, Signal};
use crate::cycle::Harmonics;
use crate::numerics::order::upper_median;

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
}

/// What the noise of the samples leaves uncertain.
struct Errors {
    of: [Option<StandardError>; Quantity::ALL.len()],
    /// Signals whose steps count.
    coarse: Vec<Finding>,
}

impl Mean<'_> {
    /// Fills in what a record has of it: means and errors, the mean cycle, points to be drawn, findings.
    pub(super) fn fill(&self, measured: &mut MeasuredLoop) {
        let cycles = || self.used.iter().map(|place| &measured.cycles[*place]);
        let mean = mean_cycle(cycles().map(|cycle| &cycle.raw));
        let corrected = (self.options.corrections).applied(self.model.angular, &mean);
        let radii = cycles().filter_map(|cycle| cycle.contact_radius_m);
        let column_m = super::statistics::mean(&radii.collect::<Vec<f64>>());
        self.remarks(&mean, &corrected, column_m, &mut measured.findings);
        let center = (self.options).values(&corrected, column_m, self.model.angular);
        let errors = self.errors((&mean, column_m), &center, &measured.sampling);
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
            let errors = errors.as_ref().and_then(|errors| errors.of[place]);
            measured.means[place] = Estimate::of(&values, errors);
        }
        for (ratio, phase) in HARMONICS_OF_APPROACH {
            let places = [ratio.place(), phase.place()];
            let known = places.map(|place| errors.as_ref().and_then(|errors| errors.of[place]));
            let found = self.harmonic(&measured.values, places, known);
            places
                .iter()
                .zip(found)
                .for_each(|(place, mean)| measured.means[*place] = mean);
        }
        if let Some(errors) = errors {
            measured.findings.extend(errors.coarse);
        }
        measured.points = self.points(measured, &mean, &corrected);
        self.take_out_bias(measured, &corrected);
        measured.mean_cycle = corrected;
    }

    /// A harmonic of the approach over the first, and its phase. Its cycles are averaged as complex numbers: the magnitudes of what
    /// is no larger than its noise would average to the noise.
    fn harmonic(
        &self,
        values: &[Values],
        [ratio, phase]: [usize; 2],
        [of_ratio, of_phase]: [Option<StandardError>; 2],
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

    fn remarks(
        &self,
        raw: &Harmonics,
        corrected: &Harmonics,
        column_m: Option<f64>,
        findings: &mut Vec<Finding>,
    ) {
        let corrections = &self.options.corrections;
        let share = corrections.share(self.model.angular, raw, corrected);
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
        if let Err(reason) = contact.radius_m(corrected, column_m) {
            findings.push(Finding::NoRadius { reason });
        }
    }

    /// Standard errors from the noise of the samples, carried through every formula: of the mean cycle fitted at once to all
    /// samples that count, drift included, so that what a drift leaves uncertain counts too.
    fn errors(
        &self,
        (mean, column_m): (&Harmonics, Option<f64>),
        center: &Values,
        sampling: &Sampling,
    ) -> Option<Errors> {
        let signal = self.used_samples();
        let fits = self.model.fits(&signal)?;
        let intervals = self.signal.time_s.windows(2).map(|w| w[1] - w[0]);
        let interval_s = upper_median(intervals)?;
        let mut squares = DVector::zeros(Quantity::ALL.len());
        let mut freedom = f64::INFINITY;
        let mut coarse = Vec::new();
        for (which, fit) in fits.iter().enumerate() {
            let noise = self.model.noise(fit, &signal.time_s, interval_s);
            freedom = freedom.min(noise.freedom);
            let steps = self.steps(&signal.time_s, (which, sampling), fit, &noise);
            if steps > COARSE * noise.variance * noise.power(self.model.angular, 1) {
                let (name, step) = step_of(which, sampling);
                coarse.extend(step.map(|step| Finding::Quantised {
                    signal: name.to_owned(),
                    step,
                }));
            }
            let covariance = self.covariance(fit, &noise, steps);
            let slopes = self.slopes(which, mean, column_m, (center, &covariance));
            squares += (&slopes * covariance * slopes.transpose()).diagonal();
        }
        Some(Errors {
            of: std::array::from_fn(|place| {
                center[place].map(|_| StandardError {
                    value: squares[place].max(0.0).sqrt(),
                    freedom,
                })
            }),
            coarse,
        })
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
    fn steps(
        &self,
        times_s: &[f64],
        (which, sampling): (usize, &Sampling),
        fit: &Fit,
        noise: &Noise,
    ) -> f64 {
        use std::f64::consts::{PI, TAU};
        /// More bins than these are not told apart.
        const BINS: f64 = 1e6;
        let Some(step) = step_of(which, sampling).1 else {
            return 0.0;
        };
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
    fn covariance(&self, fit: &Fit, noise: &Noise, steps: f64) -> DMatrix<f64> {
        let inverse = fit.normal.inverse();
        let scale = |column: usize| {
            let power = noise.power(self.model.angular, column.div_ceil(2));
            (noise.variance * power + steps).sqrt()
        };
        let p = self.model.common();
        DMatrix::from_fn(p, p, |i, j| inverse[(i, j)] * scale(i) * scale(j))
    }

    /// Derivatives of every quantity (rows) by mean and harmonics of one signal (columns), by central differences over a part of the
    /// standard errors:
    /// the size of a harmonic that is smaller than its error has a slope only close by.
    fn slopes(
        &self,
        which: usize,
        mean: &Harmonics,
        column_m: Option<f64>,
        (center, covariance): (&Values, &DMatrix<f64>),
    ) -> DMatrix<f64> {
        let moved = |column: usize, by: f64| {
            let mut moved = coefficients(mean);
            moved[which][column] += by;
            let moved = of_coefficients(&moved);
            let corrected = (self.options.corrections).applied(self.model.angular, &moved);
            (self.options).values(&corrected, column_m, self.model.angular)
        };
        let mut slopes = DMatrix::zeros(Quantity::ALL.len(), self.model.common());
        for (column, mut slopes) in slopes.column_iter_mut().enumerate() {
            let step = 0.05 * covariance[(column, column)].sqrt();
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
    fn points(
        &self,
        measured: &MeasuredLoop,
        raw: &Harmonics,
        corrected: &Harmonics,
    ) -> Vec<(f64, f64)> {
        let parts = PARTS.min(measured.points_per_cycle as usize).max(1);
        let (load, approach) = raw.sampled(parts);
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

/// A signal by name, and the step of its values.
fn step_of(which: usize, sampling: &Sampling) -> (&'static str, Option<f64>) {
    match which {
        0 => ("load", sampling.load_step_n),
        _ => ("approach", sampling.approach_step_m),
    }
}

/// The mean of cycles as the instrument gives them: their harmonics share one origin of time.
fn mean_cycle<'a>(cycles: impl ExactSizeIterator<Item = &'a Harmonics>) -> Harmonics {
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
