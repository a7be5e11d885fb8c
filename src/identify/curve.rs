//! Smooth curves of the model between the measured frequencies, for figures.

use std::sync::atomic::AtomicBool;

use crate::drive::HarmonicDrive;
use crate::identify::data::{Datum, MeasuredCycle, Measurements};
use crate::identify::model::Model;
use crate::identify::{Identified, IdentifyError, IdentifyPlan};
use crate::sweep::record::error_bars::Quantity;

/// A number of the computed cycles over the angular frequency (rad/s).
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pub quantity: Quantity,
    pub points: Vec<(f64, f64)>,
}

/// Points of a decade.
const PER_DECADE: f64 = 12.0;

/// Drives that differ by less than this, relative, are one drive as far as a figure shows.
const ONE_DRIVE: f64 = 0.05;

/// The curve of every measured quantity; none where the cycles were measured under several drives.
///
/// # Errors
/// As [`crate::identify::identify`].
pub fn curves(
    plan: &IdentifyPlan,
    found: &Identified,
    interrupt: &AtomicBool,
) -> Result<Vec<Curve>, IdentifyError> {
    let Some(drive) = one_drive(plan.measurements.cycles()) else {
        return Ok(Vec::new());
    };
    let (low, high) = found.window_rad_per_s;
    let count = (PER_DECADE * (high / low).log10()).ceil().max(1.0) as usize;
    let omegas = (0..=count).map(|k| low * (high / low).powf(k as f64 / count as f64));
    let omegas: Vec<f64> = omegas.collect();
    let quantities = plan.measurements.quantities();
    let cycles = omegas
        .iter()
        .enumerate()
        .map(|(place, omega)| MeasuredCycle {
            angular_frequency_rad_per_s: *omega,
            drive,
            row: place + 1,
        });
    let data = (0..omegas.len()).flat_map(|cycle| {
        quantities.iter().map(move |quantity| Datum {
            cycle,
            quantity: *quantity,
            value: 1.0,
            error: None,
        })
    });
    let dense = IdentifyPlan {
        measurements: Measurements::unchecked(cycles.collect(), data.collect()),
        ..plan.clone()
    };
    let numbers = Model::new(&dense, interrupt).numbers(&found.relaxation)?;
    let curve = |(place, quantity): (usize, &Quantity)| Curve {
        quantity: *quantity,
        points: omegas
            .iter()
            .copied()
            .zip(
                numbers
                    .iter()
                    .skip(place)
                    .step_by(quantities.len())
                    .copied(),
            )
            .collect(),
    };
    Ok(quantities.iter().enumerate().map(curve).collect())
}

/// The drive of all cycles, as far as they have one.
fn one_drive(cycles: &[MeasuredCycle]) -> Option<HarmonicDrive> {
    let first = cycles.first()?.drive;
    let near = |a: f64, b: f64| (a - b).abs() <= ONE_DRIVE * b.abs();
    let is_like = |cycle: &MeasuredCycle| {
        near(cycle.drive.mean(), first.mean()) && near(cycle.drive.amplitude(), first.amplitude())
    };
    cycles.iter().all(is_like).then_some(first)
}
