//! Smooth curves of the model between the measured frequencies, for figures.

use std::sync::atomic::AtomicBool;

use crate::drive::{HarmonicDrive, SegmentedDrive};
use crate::identify::data::{Datum, Measurements, Number};
use crate::identify::model::Model;
use crate::identify::{Driven, Identified, IdentifyError, IdentifyPlan, history};
use crate::numerics::grid::logarithmic;

/// A number of the computed cycles over the angular frequency (rad/s), or of the computed history over time (s).
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pub number: Number,
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
    let mut plan = plan.clone();
    plan.contact.adhesion = found.adhesion.or(plan.contact.adhesion);
    let plan = &plan;
    if let Driven::History(drive) = &plan.drive {
        return Ok(vec![of_history(plan, drive, found, interrupt)?]);
    }
    let Some(drive) = one_drive(plan.measurements.data()) else {
        return Ok(Vec::new());
    };
    let (low, high) = found.window_rad_per_s;
    let omegas = logarithmic(low, high, PER_DECADE, usize::MAX);
    let measured = plan.measurements.numbers();
    let data = (1..).zip(&omegas).flat_map(|(row, &place)| {
        measured.iter().map(move |&number| Datum {
            place,
            drive: Some(drive),
            row,
            number,
            value: 1.0,
            error: None,
        })
    });
    let dense = IdentifyPlan {
        measurements: Measurements::unchecked(data.collect()),
        ..plan.clone()
    };
    let numbers = Model::new(&dense, interrupt).numbers(&found.relaxation)?;
    let curve = |(place, number): (usize, &Number)| {
        let own = numbers.iter().copied().skip(place).step_by(measured.len());
        Curve {
            number: *number,
            points: omegas.iter().copied().zip(own).collect(),
        }
    };
    Ok(measured.iter().enumerate().map(curve).collect())
}

/// The computed history between the first and the last instant measured.
fn of_history(
    plan: &IdentifyPlan,
    drive: &SegmentedDrive,
    found: &Identified,
    interrupt: &AtomicBool,
) -> Result<Curve, IdentifyError> {
    let outcome = history::followed(plan, drive, &found.relaxation, interrupt)?;
    let (number, value) = history::response(drive.control());
    let (lowest, highest) = found.window_rad_per_s;
    let measured = 1.0 / highest..=1.0 / lowest;
    let rows = outcome
        .rows
        .iter()
        .filter(|row| measured.contains(&row.time_s));
    Ok(Curve {
        number,
        points: rows
            .filter_map(|row| Some((row.time_s, value(row)?)))
            .collect(),
    })
}

/// The drive of all cycles, as far as they have one.
fn one_drive(data: &[Datum]) -> Option<HarmonicDrive> {
    let first = data.first()?.drive?;
    let near = |a: f64, b: f64| (a - b).abs() <= ONE_DRIVE * b.abs();
    let is_like = |drive: HarmonicDrive| {
        near(drive.mean(), first.mean()) && near(drive.amplitude(), first.amplitude())
    };
    let mut drives = data.iter().filter_map(|datum| datum.drive);
    drives.all(is_like).then_some(first)
}
