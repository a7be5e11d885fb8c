//! A record from its samples to its numbers.

use serde::{Deserialize, Serialize};

use super::bias::Unbiased;
use super::cycles::{self, Cycle};
use super::drift::{Drift, DriftModel, Span};
use super::frequency::{self, Frequency, RecordModel};
use super::lines;
use super::mean::{Mean, mean_cycle};
use super::moduli::Contact;
use super::quality::Finding;
use super::quantities::{Quantity, Values};
use super::signal::Sampling;
use super::stabilisation;
use super::statistics::{self, Estimate};
use super::{Corrections, HARMONICS, MeasuredError, Signal};
use crate::cycle::Harmonics;
use crate::numerics::order::upper_median;

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

/// A frequency that was given is another one beyond this many standard errors, and this part of it.
const OTHER: (f64, f64) = (6.0, 1e-4);
/// A sample is a spike beyond this many standard deviations, and this part of the amplitude.
const SPIKE: (f64, f64) = (8.0, 0.05);
/// More spikes than this part of the samples are no spikes.
const SPIKES: f64 = 0.01;

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
    let drifts = drifts(&model, &signal, &sampling, options, &mut findings)?;
    let (samples, cycles) = (sampling.samples, sampling.duration_s / period_s);
    if cycles > samples as f64 {
        let hz = frequency.hz;
        return Err(MeasuredError::FewerThanCycles {
            samples,
            cycles,
            hz,
        });
    }
    let cut = cycles::cut(&signal, period_s, sampling.interval_s);
    if cut.is_empty() {
        return Err(MeasuredError::NoWholeCycle {
            hz: frequency.hz,
            cycles: sampling.duration_s / period_s,
        });
    }
    let (cycles, incomplete) = cycles::fitted(
        &signal,
        &cut,
        sampling.interval_s,
        &model,
        &drifts,
        &options.corrections,
    );
    if !incomplete.is_empty() {
        findings.push(Finding::Incomplete { cycles: incomplete });
    }
    let values: Vec<Values> = cycles
        .iter()
        .map(|cycle| options.values(&cycle.corrected, cycle.contact_radius_m, model.angular))
        .collect();
    let numbers: Vec<usize> = cycles.iter().map(|cycle| cycle.number).collect();
    let judged = stabilisation::judge(&values, &numbers);
    findings.extend(judged.findings);
    let used: Vec<usize> = judged.used.iter().map(|place| numbers[*place]).collect();
    let ranges = used.iter().map(|number| cut[number - 1].clone());
    let counted = || judged.used.iter().map(|place| &cycles[*place]);
    let radii = counted().filter_map(|cycle| cycle.contact_radius_m);
    let mean = Mean {
        model: &model,
        signal: &signal,
        ranges: ranges.collect(),
        options,
        used: &judged.used,
        raw: mean_cycle(counted().map(|cycle| &cycle.raw)),
        column_m: statistics::mean(&radii.collect::<Vec<f64>>()),
    };
    let mut measured = MeasuredLoop {
        points_per_cycle: period_s / sampling.interval_s,
        sampling,
        frequency,
        drifts,
        first_stabilised: judged.first.and_then(|place| numbers.get(place).copied()),
        used,
        cycles,
        values,
        means: vec![None; Quantity::ALL.len()],
        unbiased: None,
        mean_cycle: Harmonics::default(),
        points: Vec::new(),
        findings,
    };
    if !judged.used.is_empty() {
        mean.fill(&mut measured);
    }
    Ok(measured)
}

impl Options {
    /// Everything that is read from a corrected cycle, of which the record's column of radii has this mean.
    pub(super) fn values(&self, cycle: &Harmonics, column_m: Option<f64>, angular: f64) -> Values {
        let contact = self.contact.as_ref().and_then(|contact| {
            let radius_m = contact.radius_m(cycle, column_m).ok()?;
            Some((radius_m, contact.modulus_pa(cycle, radius_m, angular)?))
        });
        cycle.values(contact)
    }
}

/// Frequency and drifts; spikes are left out of the signal.
fn oscillation(
    signal: &mut Signal,
    sampling: &Sampling,
    options: &Options,
    findings: &mut Vec<Finding>,
) -> Result<(RecordModel, Frequency), MeasuredError> {
    let hz = match options.frequency_hz {
        Some(hz) if !(hz.is_finite() && hz > 0.0) => return Err(MeasuredError::Frequency { hz }),
        Some(hz) => hz,
        None => frequency::of_spectrum(signal, sampling)?,
    };
    let points = 1.0 / (hz * sampling.interval_s);
    if points < 3.0 {
        return Err(MeasuredError::Aliased { hz, points });
    }
    let cycles = (sampling.duration_s + sampling.interval_s) * hz;
    if cycles < 0.95 {
        return Err(MeasuredError::NoWholeCycle { hz, cycles });
    }
    // As many samples again as resolve a harmonic, for the noise to show.
    let harmonics = ((points / 3.0) as usize).clamp(1, HARMONICS);
    if harmonics < HARMONICS {
        findings.push(Finding::FewPoints { points, harmonics });
    }
    // Harmonics of one cycle and a half are hardly told from a drift.
    let first = harmonics.min(if cycles < 2.5 { 2 } else { HARMONICS });
    let angular = std::f64::consts::TAU * hz;
    let mut model = RecordModel::with_parabolas(signal, angular, first);
    let _ = model.settle(signal, sampling);
    model.harmonics = harmonics;
    model.select_drifts(signal, first);
    let mut error = model.settle(signal, sampling);
    if leave_out_spikes(&model, signal, findings) {
        model.select_drifts(signal, first);
        error = model.settle(signal, sampling);
    }
    let found = Frequency {
        hz: model.angular / std::f64::consts::TAU,
        standard_error_hz: error.map(|error| error / std::f64::consts::TAU),
        is_given: false,
    };
    let Some(given_hz) = options.frequency_hz else {
        return Ok((model, found));
    };
    let (found_hz, apart) = (found.hz, (found.hz - given_hz).abs());
    let is_other = |error_hz: f64| apart > OTHER.0 * error_hz && apart > OTHER.1 * given_hz;
    if found.standard_error_hz.is_some_and(is_other) {
        findings.push(Finding::OtherFrequency { given_hz, found_hz });
    }
    model.angular = angular;
    model.select_drifts(signal, first);
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
        let deviation = 1.4826 * upper_median(fit.residual.iter().map(|r| r.abs())).unwrap_or(0.0);
        let limit = (SPIKE.0 * deviation).max(SPIKE.1 * fit.amplitude());
        let beyond = (0..samples).filter(|i| fit.residual[*i].abs() > limit);
        let found: Vec<usize> = beyond.collect();
        let most = (SPIKES * samples as f64).max(1.0);
        let Some(first) = found.first().filter(|_| found.len() as f64 <= most) else {
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
        let mut is_spike = is_spike.iter();
        column.retain(|_| is_spike.next() != Some(&true));
    }
    true
}

/// The drifts of both signals at the frequency of the model, and lines beside the oscillation; refuses signals without an oscillation.
fn drifts(
    model: &RecordModel,
    signal: &Signal,
    sampling: &Sampling,
    options: &Options,
    findings: &mut Vec<Finding>,
) -> Result<[Drift; 2], MeasuredError> {
    let span = Span::of(signal);
    let Some(fits) = model.fits(signal) else {
        return Ok([0, 1].map(|_| Drift::new(DriftModel::None, &[], span)));
    };
    for (fit, name) in fits.iter().zip(["load", "approach"]) {
        let samples = fit.residual.len() as f64;
        let variance = fit.residual.norm_squared() / samples;
        // By chance once in 1e4, and more often where noise is correlated: then no loop can be read either.
        if fit.amplitude() < 4.5 * (2.0 * variance / samples).sqrt() {
            return Err(MeasuredError::NoOscillation {
                signal: name,
                given_hz: options.frequency_hz,
            });
        }
        let times_s = &signal.time_s;
        findings.extend(lines::highest(name, model, fit, times_s, sampling));
    }
    Ok([0, 1].map(|which| {
        let coefficients = &fits[which].coefficients.as_slice()[model.common()..];
        Drift::new(model.drifts[which], coefficients, span)
    }))
}
