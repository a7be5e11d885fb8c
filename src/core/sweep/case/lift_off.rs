//! Cycles whose indenter leaves the surface: where their signals have kinks, and what error bars hold of that.
//!
//! A contact that opens or closes within a step leaves an error of that step in all that is made of samples, which differences between
//! numbers of steps do not tell: the touch lies elsewhere in the steps of each.

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

/// Error bars of a cycle in this number of steps, with what lift-off adds to them.
pub(super) fn widened(
    mut bars: ErrorBars,
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
    // The loop is the worse of the two by far: its corners lie between samples.
    let loss_j = result.analysis.energy_loss_j.abs();
    let imbalance_j = result.energy_imbalance().unwrap_or(0.0).abs() * loss_j;
    bars = bars.at_least(Quantity::EnergyLoss, imbalance_j);
    // What its place among the steps makes of a contact of n of them: up to 5/n^2 of the loss, tried on random solids.
    let of_place_j = 6.0 * loss_j / (in_contact * in_contact);
    bars = bars.wider(Quantity::EnergyLoss, of_place_j);
    let samples = &result.cycle.samples;
    let peaks: Option<Vec<f64>> = samples.peak_pressure_pa.iter().copied().collect();
    let [of_approach, of_contact] = smoothness(drive, samples, is_closed);
    use Quantity::{
        ApproachMax, ApproachMin, ContactRadiusMax, ContactRadiusMin, PeakPressureMax,
        PeakPressureMin,
    };
    for (smooth, signal, minimum, maximum) in [
        (
            of_approach,
            Some(&samples.approach_m),
            ApproachMin,
            ApproachMax,
        ),
        (
            of_contact,
            Some(&samples.contact_radius_m),
            ContactRadiusMin,
            ContactRadiusMax,
        ),
        (of_contact, peaks.as_ref(), PeakPressureMin, PeakPressureMax),
    ] {
        if let Some((_, rest)) = signal.and_then(|signal| smooth.extrema(signal)) {
            bars = bars
                .wider(minimum, rest.minimum)
                .wider(maximum, rest.maximum);
        }
    }
    Some(bars)
}
