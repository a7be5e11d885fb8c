//! Cycles whose indenter leaves the surface: where their signals have kinks, and what error bars hold of that.
//!
//! A contact that opens or closes within a step leaves an error of that step in all that is made of samples, which differences between
//! numbers of steps do not tell: the touch lies elsewhere in the steps of each.

use std::f64::consts::PI;

use crate::cycle::{ContactDuty, Loop, Smoothness};
use crate::drive::{Control, HarmonicDrive};
use crate::sweep::record::CaseResult;
use crate::sweep::record::error_bars::{ErrorBars, Quantity};

/// How long the indenter touches.
pub(super) fn contact_duty(drive: &HarmonicDrive, load_n: &[f64]) -> ContactDuty {
    let known = drive.loaded_part();
    let known = known.map(|part| ContactDuty { part, error: 0.0 });
    known
        .or_else(|| ContactDuty::of(load_n))
        .unwrap_or(ContactDuty::WHOLE)
}

/// Where the approach is smooth, and where all that the contact makes of it is.
pub(super) fn smoothness<'a>(
    drive: &HarmonicDrive,
    samples: &'a Loop,
    is_closed: bool,
) -> [Smoothness<'a>; 2] {
    let lifts_off = contact_duty(drive, &samples.load_n) != ContactDuty::WHOLE;
    let of_contact = Smoothness {
        is_closed,
        kinks_of_load_n: lifts_off.then_some(&samples.load_n),
    };
    let of_approach = match drive.control() {
        Control::Load => of_contact,
        // As prescribed.
        Control::Approach => Smoothness {
            kinks_of_load_n: None,
            ..of_contact
        },
    };
    [of_approach, of_contact]
}

/// Steps in contact below which it is chance what the samples see of a cycle, and no bar holds.
pub(super) const FEWEST_STEPS: f64 = 2.0;

/// What its place among the steps makes of a contact of n of them: up to 5/n^2, relative, tried on random solids.
const OF_PLACE: f64 = 6.0;

/// Error bars of a cycle in this number of steps, with what lift-off adds to them. `None` where no bar holds.
pub(super) fn widened(
    bars: ErrorBars,
    (result, steps): (&CaseResult, usize),
    drive: &HarmonicDrive,
    is_closed: bool,
) -> Option<ErrorBars> {
    let duty = result.contact_duty;
    if duty == ContactDuty::WHOLE {
        return Some(bars);
    }
    let in_contact = duty.steps(steps);
    if in_contact < FEWEST_STEPS {
        return None;
    }
    let smooth = smoothness(drive, &result.cycle.samples, is_closed);
    let bars = by_imbalance(bars, result);
    let bars = by_place(bars, result, OF_PLACE / (in_contact * in_contact));
    let bars = by_kinks(bars, result, drive.control(), smooth);
    Some(by_rest(bars, result, smooth))
}

/// The loop is mostly the worse of loop and dissipation, since its corners lie between samples, and the dissipation has an error of
/// its own. What is wrong with the area of the loop is wrong with the lag of its first harmonics, too.
fn by_imbalance(bars: ErrorBars, result: &CaseResult) -> ErrorBars {
    let analysis = &result.analysis;
    let imbalance_j = result.energy_imbalance().unwrap_or(0.0) * analysis.energy_loss_j;
    let first = analysis.harmonics.first();
    let circle_j = first.map_or(0.0, |h| PI * h.load_amplitude_n * h.approach_amplitude_m);
    let lag_rad = (imbalance_j.abs() / circle_j).min(PI);
    bars.wider(Quantity::EnergyLoss, imbalance_j.abs())
        .at_least(Quantity::PhaseLag, lag_rad)
}

/// Where the contact begins and ends within the steps, of which the loss, the lag and the largest pressure are wrong by this part.
fn by_place(bars: ErrorBars, result: &CaseResult, part: f64) -> ErrorBars {
    let loss_j = result.analysis.energy_loss_j.abs();
    let lag_rad = result.analysis.phase_lag_rad.sin().abs();
    let peak_pa = result.peak_pressure_pa.map_or(0.0, |peak| peak.maximum);
    bars.wider(Quantity::EnergyLoss, part * loss_j)
        .wider(Quantity::PhaseLag, part * lag_rad)
        .wider(Quantity::PeakPressureMax, part * peak_pa)
}

/// What samples miss of harmonics where the signals have kinks between them. An approach that is prescribed has none, and the energy
/// balance tells the lag.
fn by_kinks(
    bars: ErrorBars,
    result: &CaseResult,
    control: Control,
    [of_approach, of_contact]: [Smoothness<'_>; 2],
) -> ErrorBars {
    let (samples, analysis) = (&result.cycle.samples, &result.analysis);
    let (Some(first), Control::Load) = (analysis.harmonics.first(), control) else {
        return bars;
    };
    let approach = of_approach.harmonic_error(&samples.approach_m) / first.approach_amplitude_m;
    let load = of_contact.harmonic_error(&samples.load_n) / first.load_amplitude_n;
    // Both kinks of a contact lie half of it before and after its middle, and turn the phase by what is left across that.
    let (half_rad, lag_rad) = (PI * result.contact_duty.part, analysis.phase_lag_rad);
    let across = (half_rad.sin().abs() + lag_rad.sin().abs()).min(1.0);
    let of_harmonic = |n| approach * (1.0 + analysis.approach_harmonic(n).unwrap_or(0.0));
    bars.wider(Quantity::PhaseLag, (approach + load) * across)
        .wider(Quantity::Harmonic2, of_harmonic(2))
        .wider(Quantity::Harmonic3, of_harmonic(3))
}

/// How far the extremes may lie beyond the samples that stand for them.
fn by_rest(
    mut bars: ErrorBars,
    result: &CaseResult,
    [of_approach, of_contact]: [Smoothness<'_>; 2],
) -> ErrorBars {
    use Quantity::{
        ApproachMax, ApproachMin, ContactRadiusMax, ContactRadiusMin, PeakPressureMax,
        PeakPressureMin,
    };
    let samples = &result.cycle.samples;
    let (approach, radius) = (&samples.approach_m, &samples.contact_radius_m);
    let peaks: Option<Vec<f64>> = samples.peak_pressure_pa.iter().copied().collect();
    for (smooth, signal, minimum, maximum) in [
        (of_approach, Some(approach), ApproachMin, ApproachMax),
        (of_contact, Some(radius), ContactRadiusMin, ContactRadiusMax),
        (of_contact, peaks.as_ref(), PeakPressureMin, PeakPressureMax),
    ] {
        if let Some((_, rest)) = signal.and_then(|signal| smooth.extrema(signal)) {
            bars = bars
                .wider(minimum, rest.minimum)
                .wider(maximum, rest.maximum);
        }
    }
    bars
}
