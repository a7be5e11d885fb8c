//! Energy loss over frequency and drive: the map of a sweep of two axes, its peaks as rings.

use super::curve::Curve;
use super::drive_map::{self, Mapped};
use super::{Drawn, Figure, prefix};
use crate::report::ReportError;
use crate::sweep::plan::{DriveAxis, SweepPlan, Varied};
use crate::sweep::record::CaseRecord;
use crate::sweep::run::Outcome;

/// The figure.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(
    plan: &SweepPlan,
    outcome: &Outcome,
    axis: &DriveAxis,
    curves: &[Curve<'_>],
) -> Result<Drawn, ReportError> {
    let losses = outcome.records.iter().filter_map(|r| r.energy_loss_j());
    let (factor, unit) = prefix(losses.fold(0.0, f64::max));
    let rings = outcome.peaks.iter().filter_map(|peak| {
        let value = match axis.varied {
            Varied::Amplitude => peak.drive_amplitude?,
            Varied::Mean => peak.drive_mean?,
        };
        Some((peak.angular_frequency_rad_per_s, value))
    });
    let mapped = Mapped {
        value: &|record| Some(factor * record.energy_loss_j()?),
        label: format!("energy loss per cycle / {unit}J"),
        rings: rings.collect(),
    };
    let Some(map) = drive_map::map(plan, axis, curves, mapped) else {
        return Ok(Drawn::left_out(
            "no loss map: it takes two frequencies and two drives with results",
        ));
    };
    let data = drive_map::data(
        "loss-map.csv",
        curves,
        &[
            ("energy_loss_j", &CaseRecord::energy_loss_j),
            ("energy_loss_error_j", &CaseRecord::energy_loss_error_j),
        ],
    )?;
    Ok(Drawn::Figure(Figure {
        name: "loss-map",
        picture: map.into(),
        data,
    }))
}
