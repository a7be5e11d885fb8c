//! A record from its samples to its numbers.

use serde::{Deserialize, Serialize};

use super::bias::{self, Unbiased};
use super::corrections::Harmonics;
use super::cycles::{self, Cycle, complex};
use super::drift::{self, Drift, DriftModel, Span};
use super::frequency::{self, Fit, Frequency, RecordModel};
use super::lines::{self, Rest};
use super::moduli::Contact;
use super::noise::Noise;
use super::quality::Finding;
use super::quantities::{Quantity, Values};
use super::signal::Sampling;
use super::stabilisation;
use super::statistics::{Estimate, StandardError};
use super::{Corrections, HARMONICS, MeasuredError, Signal};

/// What is known beside the record.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The frequency (Hz); found where it is not given.
    pub frequency_hz: Option<f64>,
    pub corrections: Corrections,
    pub contact: Option<Contact>,
}

/// What a record came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredLoop {
    pub sampling: Sampling,
    pub frequency: Frequency,
    /// Samples in a cycle.
    pub points_per_cycle: f64,
    /// Of the load and of the approach.
    pub drifts: [Drift; 2],
    pub cycles: Vec<Cycle>,
    /// Of every cycle.
    pub values: Vec<Values>,
    /// Number of the cycle from which on nothing changes, counted from 1.
    pub first_stabilised: Option<usize>,
    /// Numbers of the cycles that count in the means.
    pub used: Vec<usize>,
    /// Means over these, in the order of [`Quantity::ALL`].
    pub means: Vec<Option<Estimate>>,
    /// Moduli without the bias of the formula, where the setup gives the shape.
    pub unbiased: Option<Unbiased>,
    /// The mean cycle, corrected; empty where there is none.
    pub mean_cycle: Harmonics,
    /// Load (N) and approach (m) as measured, corrected, averaged over equal parts of the cycle.
    pub points: Vec<(f64, f64)>,
    pub findings: Vec<Finding>,
}

impl MeasuredLoop {
    /// The mean of a quantity.
    pub fn mean(&self, quantity: Quantity) -> Option<Estimate> {
        self.means.get(quantity.place()).copied().flatten()
    }

    /// Energy loss per cycle (J).
    pub fn energy_loss_j(&self) -> Option<Estimate> {
        self.mean(Quantity::EnergyLoss)
    }

    /// Lag of the approach (rad).
    pub fn phase_lag_rad(&self) -> Option<Estimate> {
        self.mean(Quantity::PhaseLag)
    }
}

/// Parts of a cycle over which samples are averaged to be drawn.
const PARTS: usize = 100;
/// A frequency that was given is another one beyond this many standard errors, and this part of it.
const OTHER: (f64, f64) = (6.0, 1e-4);
/// A sample is a spike beyond this many standard deviations, and this part of the amplitude.
const SPIKE: (f64, f64) = (8.0, 0.05);
/// More spikes than this part of the samples are no spikes.
const SPIKES: f64 = 0.01;
/// An instrument that takes more than this many times the load of the contact is worth saying.
const DOMINATES: f64 = 1.0;

/// Analyses a record.
///
/// # Errors
/// [`MeasuredError`]: a record that holds no cycle to be analysed. What is wrong with one that does is among its findings.
pub fn analyse(signal: &Signal, options: &Options) -> Result<MeasuredLoop, MeasuredError> {
    let (mut signal, sampling, mut findings) = signal.prepared()?;
    options.corrections.before(&mut signal);
    let (model, frequency) = oscillation(&mut signal, &sampling, options, &mut findings)?;
    let period_s = frequency.hz.recip();
    signal.clipped(period_s, &mut findings);
    let drifts = drifts(&model, &signal, &sampling, &mut findings)?;
    let cut = cycles::cut(&signal, period_s, sampling.interval_s);
    if cut.ranges.is_empty() {
        return Err(MeasuredError::NoWholeCycle {
            hz: frequency.hz,
            cycles: sampling.duration_s / period_s,
        });
    }
    let of_model = (model.angular, model.harmonics);
    let mut all = Vec::new();
    let mut incomplete = cut.incomplete.clone();
    for (place, range) in cut.ranges.iter().enumerate() {
        let fitted = cycles::fit(&signal, range.clone(), of_model, &drifts);
        match fitted.filter(|_| !cut.incomplete.contains(&(place + 1))) {
            Some(mut cycle) => {
                cycle.number = place + 1;
                cycle.corrected = options.corrections.applied(model.angular, &cycle.raw);
                all.push(cycle);
            }
            None => incomplete.push(place + 1),
        }
    }
    incomplete.sort_unstable();
    incomplete.dedup();
    if !incomplete.is_empty() {
        findings.push(Finding::Incomplete { cycles: incomplete });
    }
    let contact = |cycle: &Harmonics, column_m: Option<f64>| {
        let contact = options.contact.as_ref()?;
        let radius_m = contact.radius_m(cycle, column_m).ok()?;
        Some((radius_m, contact.poisson_ratio))
    };
    let values: Vec<Values> = all
        .iter()
        .map(|cycle| {
            cycle
                .corrected
                .values(contact(&cycle.corrected, cycle.contact_radius_m))
        })
        .collect();
    let numbers: Vec<usize> = all.iter().map(|cycle| cycle.number).collect();
    let judged = stabilisation::judge(&values, &numbers);
    findings.extend(judged.findings);
    let mut measured = MeasuredLoop {
        points_per_cycle: period_s / sampling.interval_s,
        sampling,
        frequency,
        drifts,
        first_stabilised: judged.first.and_then(|place| numbers.get(place).copied()),
        used: judged.used.iter().map(|place| numbers[*place]).collect(),
        cycles: all,
        values,
        means: vec![None; Quantity::ALL.len()],
        unbiased: None,
        mean_cycle: Harmonics::default(),
        points: Vec::new(),
        findings,
    };
    if !judged.used.is_empty() {
        let mean = Mean {
            model: &model,
            signal: &signal,
            cut: &cut,
            options,
            used: &judged.used,
        };
        mean.fill(&mut measured)?;
    }
    Ok(measured)
}

/// How many harmonics so many samples in a cycle resolve, with as many samples again for the noise to show.
fn resolved(points: f64) -> usize {
    ((points / 3.0) as usize).clamp(1, HARMONICS)
}

/// Frequency and drifts; spikes are left out of the signal.
fn oscillation(
    signal: &mut Signal,
    sampling: &Sampling,
    options: &Options,
    findings: &mut Vec<Finding>,
) -> Result<(RecordModel, Frequency), MeasuredError> {
    let about_hz = match options.frequency_hz {
        Some(hz) if !(hz.is_finite() && hz > 0.0) => return Err(MeasuredError::Frequency { hz }),
        Some(hz) => hz,
        None => frequency::of_spectrum(signal, sampling)?,
    };
    let points = 1.0 / (about_hz * sampling.interval_s);
    if points < 3.0 {
        return Err(MeasuredError::Aliased {
            hz: about_hz,
            points,
        });
    }
    let cycles = (sampling.duration_s + sampling.interval_s) * about_hz;
    if cycles < 0.95 {
        return Err(MeasuredError::NoWholeCycle {
            hz: about_hz,
            cycles,
        });
    }
    let harmonics = resolved(points);
    if harmonics < HARMONICS {
        findings.push(Finding::FewPoints { points, harmonics });
    }
    // Harmonics of one cycle and a half are hardly told from a drift.
    let first = if cycles < 2.5 {
        harmonics.min(2)
    } else {
        harmonics
    };
    let angular = std::f64::consts::TAU * about_hz;
    let parabola = DriftModel::Polynomial { degree: 2 };
    let mut model = RecordModel::new(signal, angular, first, [parabola; 2]);
    let _ = model.settle(signal, sampling);
    model.harmonics = harmonics;
    model.drifts = drift::select(signal, &model.span, model.angular, first);
    let mut error = model.settle(signal, sampling);
    if leave_out_spikes(&model, signal, findings) {
        model.drifts = drift::select(signal, &model.span, model.angular, first);
        error = model.settle(signal, sampling);
    }
    let found_hz = model.angular / std::f64::consts::TAU;
    let error_hz = error.map(|error| error / std::f64::consts::TAU);
    let Some(given_hz) = options.frequency_hz else {
        let frequency = Frequency {
            hz: found_hz,
            standard_error_hz: error_hz,
            is_given: false,
        };
        return Ok((model, frequency));
    };
    let apart = (found_hz - given_hz).abs();
    let is_other = |error_hz: f64| apart > OTHER.0 * error_hz && apart > OTHER.1 * given_hz;
    if error_hz.is_some_and(is_other) {
        findings.push(Finding::OtherFrequency { given_hz, found_hz });
    }
    model.angular = angular;
    model.drifts = drift::select(signal, &model.span, angular, first);
    let frequency = Frequency {
        hz: given_hz,
        standard_error_hz: None,
        is_given: true,
    };
    Ok((model, frequency))
}

/// Leaves out single samples far from the model; says whether there were any.
fn leave_out_spikes(model: &RecordModel, signal: &mut Signal, findings: &mut Vec<Finding>) -> bool {
    let Some(fits) = model.fits(signal) else {
        return false;
    };
    let samples = signal.time_s.len();
    let mut is_spike = vec![false; samples];
    for (fit, name) in fits.iter().zip(["load", "approach"]) {
        let mut sizes: Vec<f64> = fit.residual.iter().map(|r| r.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let deviation = 1.4826 * sizes[samples / 2];
        let limit = (SPIKE.0 * deviation).max(SPIKE.1 * frequency::amplitude(&fit.coefficients, 1));
        let found: Vec<usize> = (0..samples)
            .filter(|i| fit.residual[*i].abs() > limit)
            .collect();
        let (Some(first), true) = (
            found.first(),
            found.len() as f64 <= (SPIKES * samples as f64).max(1.0),
        ) else {
            continue;
        };
        findings.push(Finding::Spikes {
            signal: name.to_owned(),
            samples: found.len(),
            first_s: signal.time_s[*first],
        });
        found.into_iter().for_each(|i| is_spike[i] = true);
    }
    if !is_spike.contains(&true) {
        return false;
    }
    let columns = [
        Some(&mut signal.time_s),
        Some(&mut signal.load_n),
        Some(&mut signal.approach_m),
        signal.contact_radius_m.as_mut(),
    ];
    for column in columns.into_iter().flatten() {
        let mut place = 0..;
        column.retain(|_| {
            place
                .next()
                .is_none_or(|i: usize| !is_spike.get(i).copied().unwrap_or(false))
        });
    }
    true
}

/// The drifts of both signals at the frequency of the model, and lines beside the oscillation; refuses signals without an oscillation.
fn drifts(
    model: &RecordModel,
    signal: &Signal,
    sampling: &Sampling,
    findings: &mut Vec<Finding>,
) -> Result<[Drift; 2], MeasuredError> {
    let fits = model.fits(signal);
    let span = Span::of(signal);
    let none = || Drift::new(DriftModel::None, &[], span);
    let Some(fits) = fits else {
        return Ok([none(), none()]);
    };
    for (fit, name) in fits.iter().zip(["load", "approach"]) {
        let samples = fit.residual.len() as f64;
        let variance = fit.residual.iter().map(|r| r * r).sum::<f64>() / samples;
        // By chance once in 1e4, and more often where noise is correlated: then no loop can be read either.
        if frequency::amplitude(&fit.coefficients, 1) < 4.5 * (2.0 * variance / samples).sqrt() {
            return Err(MeasuredError::NoOscillation { signal: name });
        }
        let rest = Rest {
            name,
            times_s: &signal.time_s,
            residual: &fit.residual,
            amplitude: frequency::amplitude(&fit.coefficients, 1),
            hz: model.angular / std::f64::consts::TAU,
            harmonics: model.harmonics,
        };
        findings.extend(lines::highest(&rest, sampling));
    }
    let drift = |which: usize| {
        let coefficients = &fits[which].coefficients[model.drift_columns(which)];
        Drift::new(model.drifts[which], coefficients, span)
    };
    Ok([drift(0), drift(1)])
}

/// The mean over the cycles that count.
struct Mean<'a> {
    model: &'a RecordModel,
    signal: &'a Signal,
    cut: &'a cycles::Cut,
    options: &'a Options,
    /// Places among the cycles that were fitted.
    used: &'a [usize],
}

impl Mean<'_> {
    fn fill(&self, measured: &mut MeasuredLoop) -> Result<(), MeasuredError> {
        let mean = mean_cycle(
            self.used
                .iter()
                .filter_map(|place| measured.cycles.get(*place)),
        );
        let corrections = &self.options.corrections;
        let corrected = corrections.applied(self.model.angular, &mean);
        let radii = self
            .used
            .iter()
            .filter_map(|place| measured.cycles[*place].contact_radius_m);
        let column_m = super::statistics::mean(&radii.collect::<Vec<f64>>());
        self.remarks(&mean, &corrected, column_m, &mut measured.findings);
        let center = self.values(&mean, column_m);
        let errors = self.errors(&mean, column_m, &center);
        for (place, (quantity, ..)) in Quantity::ALL.iter().enumerate() {
            let values = self.used.iter().map(|used| measured.values[*used][place]);
            let Some(mut values) = values.collect::<Option<Vec<f64>>>() else {
                continue;
            };
            if let (true, Some(center)) = (is_angle(*quantity), center[place]) {
                values
                    .iter_mut()
                    .for_each(|v| *v = center + wrapped(*v - center));
            }
            let errors = errors.as_ref().and_then(|errors| errors[place]);
            measured.means[place] = Estimate::of(&values, errors);
        }
        measured.points = self.points(measured, &mean, &corrected);
        self.take_out_bias(measured, &corrected);
        measured.mean_cycle = corrected;
        Ok(())
    }

    fn take_out_bias(&self, measured: &mut MeasuredLoop, cycle: &Harmonics) {
        let contact = self.options.contact.as_ref();
        let Some(contact) = contact.filter(|contact| contact.bias) else {
            return;
        };
        let moduli = measured
            .mean(Quantity::StorageModulus)
            .zip(measured.mean(Quantity::LossModulus));
        // Without a radius there is nothing that could be biased, and that has been said.
        let Some(moduli) = moduli else {
            return;
        };
        match bias::unbiased(contact, cycle, self.model.angular, moduli) {
            Ok(unbiased) => measured.unbiased = Some(unbiased),
            Err(reason) => measured.findings.push(Finding::NoBias { reason }),
        }
    }

    fn remarks(
        &self,
        raw: &Harmonics,
        corrected: &Harmonics,
        column_m: Option<f64>,
        findings: &mut Vec<Finding>,
    ) {
        let share = self
            .options
            .corrections
            .share(self.model.angular, raw, corrected);
        if let Some(ratio) = share.filter(|ratio| *ratio > DOMINATES) {
            findings.push(Finding::CorrectionDominates { ratio });
        }
        if corrected.energy_loss_j() < 0.0 {
            findings.push(Finding::Leads);
        }
        let amplitude = corrected.load_n.first().map_or(0.0, |a| a.norm());
        if self.options.contact.is_some() && corrected.load_mean_n < amplitude {
            findings.push(Finding::Pull);
        }
        let radius = self
            .options
            .contact
            .as_ref()
            .map(|c| c.radius_m(corrected, column_m));
        if let Some(Err(reason)) = radius {
            findings.push(Finding::NoRadius { reason });
        }
    }

    fn values(&self, raw: &Harmonics, column_m: Option<f64>) -> Values {
        let corrected = self.options.corrections.applied(self.model.angular, raw);
        let contact = self.options.contact.as_ref().and_then(|contact| {
            let radius_m = contact.radius_m(&corrected, column_m).ok()?;
            Some((radius_m, contact.poisson_ratio))
        });
        corrected.values(contact)
    }

    /// Standard errors from the noise of the samples, carried through every formula: of the mean cycle fitted at once to all
    /// samples that count, drift included, so that what a drift leaves uncertain counts too.
    fn errors(
        &self,
        mean: &Harmonics,
        column_m: Option<f64>,
        center: &Values,
    ) -> Option<[Option<StandardError>; Quantity::ALL.len()]> {
        let signal = self.used_samples()?;
        let fits = self.model.fits(&signal)?;
        let mut squares = [0.0; Quantity::ALL.len()];
        let mut freedom = f64::INFINITY;
        for (which, fit) in fits.iter().enumerate() {
            let noise = Noise::of(
                &fit.residual,
                &signal.time_s,
                fit.columns,
                self.interval_s(),
                self.model.angular,
            );
            freedom = freedom.min(noise.freedom);
            let covariance = self.covariance(fit, &noise);
            let slopes = self.slopes(which, mean, column_m, (center, &covariance));
            for (place, square) in squares.iter_mut().enumerate() {
                let row = |i: usize| slopes[i][place];
                let p = slopes.len();
                *square += (0..p)
                    .flat_map(|i| (0..p).map(move |j| (i, j)))
                    .map(|(i, j)| row(i) * covariance[(i, j)] * row(j))
                    .sum::<f64>();
            }
        }
        Some(std::array::from_fn(|place| {
            center[place].map(|_| StandardError {
                value: squares[place].max(0.0).sqrt(),
                freedom,
            })
        }))
    }

    fn interval_s(&self) -> f64 {
        let times = &self.signal.time_s;
        let mut intervals: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
        let middle = intervals.len() / 2;
        *intervals.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// The samples of the cycles that count.
    fn used_samples(&self) -> Option<Signal> {
        let numbers: Vec<usize> = self.places();
        let mut taken = Signal::default();
        for place in numbers {
            let range = self.cut.ranges.get(place)?.clone();
            taken
                .time_s
                .extend_from_slice(self.signal.time_s.get(range.clone())?);
            taken
                .load_n
                .extend_from_slice(self.signal.load_n.get(range.clone())?);
            taken
                .approach_m
                .extend_from_slice(self.signal.approach_m.get(range)?);
        }
        Some(taken)
    }

    /// Places among the ranges of the cut.
    fn places(&self) -> Vec<usize> {
        let whole = (0..self.cut.ranges.len()).filter(|k| !self.cut.incomplete.contains(&(k + 1)));
        let whole: Vec<usize> = whole.collect();
        self.used
            .iter()
            .filter_map(|place| whole.get(*place).copied())
            .collect()
    }

    /// Covariance of mean and harmonics of one signal.
    fn covariance(&self, fit: &Fit, noise: &Noise) -> nalgebra::DMatrix<f64> {
        let inverse = fit.normal.inverse();
        let harmonic = |column: usize| column.div_ceil(2);
        let scale = |column: usize| {
            (noise.variance * noise.power(self.model.angular, harmonic(column))).sqrt()
        };
        let p = self.model.common();
        nalgebra::DMatrix::from_fn(p, p, |i, j| inverse[(i, j)] * scale(i) * scale(j))
    }

    /// Derivatives of every quantity by mean and harmonics of one signal, by central differences over the standard errors.
    fn slopes(
        &self,
        which: usize,
        mean: &Harmonics,
        column_m: Option<f64>,
        (center, covariance): (&Values, &nalgebra::DMatrix<f64>),
    ) -> Vec<[f64; Quantity::ALL.len()]> {
        let moved = |column: usize, by: f64| {
            let mut moved = mean.clone();
            let (level, harmonics) = match which {
                0 => (&mut moved.load_mean_n, &mut moved.load_n),
                _ => (&mut moved.approach_mean_m, &mut moved.approach_m),
            };
            match column.checked_sub(1) {
                None => *level += by,
                Some(k) => match harmonics.get_mut(k / 2) {
                    Some(harmonic) if k % 2 == 0 => harmonic.re += by,
                    Some(harmonic) => harmonic.im += by,
                    None => {}
                },
            }
            self.values(&moved, column_m)
        };
        let slope = |column: usize| {
            let step = covariance[(column, column)].sqrt();
            if !(step.is_finite() && step > 0.0) {
                return [0.0; Quantity::ALL.len()];
            }
            let (up, down) = (moved(column, step), moved(column, -step));
            std::array::from_fn(|place| match (up[place], down[place], center[place]) {
                (Some(up), Some(down), Some(_)) if is_angle(Quantity::ALL[place].0) => {
                    wrapped(up - down) / (2.0 * step)
                }
                (Some(up), Some(down), Some(_)) => (up - down) / (2.0 * step),
                _ => 0.0,
            })
        };
        (0..self.model.common()).map(slope).collect()
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
        for range in self
            .places()
            .iter()
            .filter_map(|place| self.cut.ranges.get(*place))
        {
            for i in range.clone() {
                let time_s = self.signal.time_s[i];
                let turns = (time_s - first_s) * self.model.angular / std::f64::consts::TAU;
                let part = parts as f64 * (turns - turns.floor());
                let (low, weight) = (part as usize % parts, part - part.floor());
                let between =
                    |samples: &[f64]| samples[low] + weight * (samples[low + 1] - samples[low]);
                let nearest = (part.round() as usize) % parts;
                let sum = &mut sums[nearest];
                sum.0 += self.signal.load_n[i] - measured.drifts[0].at(time_s) - between(&load);
                sum.1 +=
                    self.signal.approach_m[i] - measured.drifts[1].at(time_s) - between(&approach);
                sum.2 += 1;
            }
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
fn mean_cycle<'a>(cycles: impl Iterator<Item = &'a Cycle> + Clone) -> Harmonics {
    let count = cycles.clone().count().max(1) as f64;
    let harmonics = cycles
        .clone()
        .map(|c| c.raw.load_n.len())
        .min()
        .unwrap_or(0);
    let mean = |value: &dyn Fn(&Harmonics) -> f64| {
        cycles.clone().map(|c| value(&c.raw)).sum::<f64>() / count
    };
    let mut mean_cycle = Harmonics {
        load_mean_n: mean(&|h| h.load_mean_n),
        approach_mean_m: mean(&|h| h.approach_mean_m),
        ..Harmonics::default()
    };
    for n in 0..harmonics {
        let pair = |part: &dyn Fn(&Harmonics) -> num_complex::Complex<f64>| {
            [mean(&|h| part(h).re), mean(&|h| part(h).im)]
        };
        mean_cycle.load_n.extend(complex(&pair(&|h| h.load_n[n])));
        mean_cycle
            .approach_m
            .extend(complex(&pair(&|h| h.approach_m[n])));
    }
    mean_cycle
}

fn is_angle(quantity: Quantity) -> bool {
    use Quantity::{HarmonicPhase2, HarmonicPhase3, HarmonicPhase4, HarmonicPhase5, PhaseLag};
    [
        PhaseLag,
        HarmonicPhase2,
        HarmonicPhase3,
        HarmonicPhase4,
        HarmonicPhase5,
    ]
    .contains(&quantity)
}

/// An angle between -pi and pi.
fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle + PI).rem_euclid(TAU) - PI
}
