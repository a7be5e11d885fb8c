//! Energy loss per cycle against angular frequency, its peaks marked.

use super::{Figure, prefix, scientific};
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, Mark, Marker, Series};
use crate::report::table::{Table, number, optional};
use crate::sweep::run::Outcome;

/// The figure. A case without a result breaks the line: nothing is drawn in its place.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(outcome: &Outcome) -> Result<Figure, ReportError> {
    let losses = || outcome.records.iter().filter_map(|r| r.energy_loss_j());
    let (factor, unit) = prefix(losses().fold(0.0, f64::max));
    let points = outcome
        .records
        .iter()
        .map(|r| Some((r.angular_frequency_rad_per_s, factor * r.energy_loss_j()?)));
    let marks = outcome.peaks.iter().map(|peak| {
        let omega = peak.angular_frequency_rad_per_s;
        Mark::point(
            omega,
            factor * peak.energy_loss_j,
            format!("ω = {} rad/s", scientific(omega, 3)),
        )
    });
    let chart = Chart::new(
        Axis::log("angular frequency ω / rad·s⁻¹"),
        Axis::linear(format!("energy loss per cycle / {unit}J")),
    )
    .series(Series::line(points).marker(Marker::Disc))
    .all_marks(marks);
    Ok(Figure {
        name: "energy-loss",
        chart,
        data: data(outcome)?,
    })
}

fn data(outcome: &Outcome) -> Result<Vec<u8>, ReportError> {
    let columns = ["kind", "angular_frequency_rad_per_s", "energy_loss_j"];
    let mut table = Table::new("energy-loss.csv", &columns)?;
    for record in &outcome.records {
        table.row(&[
            "case".to_owned(),
            number(record.angular_frequency_rad_per_s),
            optional(record.energy_loss_j()),
        ])?;
    }
    for peak in &outcome.peaks {
        table.row(&[
            "peak".to_owned(),
            number(peak.angular_frequency_rad_per_s),
            number(peak.energy_loss_j),
        ])?;
    }
    table.finish()
}
