//! Energy loss per cycle against angular frequency, with error bars, its peaks marked; one curve per drive.

use super::curve::{Curve, curves, evenly};
use super::{Figure, prefix, scientific};
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, Color, Mark, Marker, Series};
use crate::report::table::{Table, number, optional};
use crate::sweep::peak::Peak;
use crate::sweep::plan::SweepPlan;
use crate::sweep::run::Outcome;

/// Curves in one figure; more cannot be told apart.
const CURVES: usize = 8;
/// Peaks further apart than this need a logarithmic axis to be seen both.
const WIDE: f64 = 20.0;

/// The figure. A case without a result breaks the line: nothing is drawn in its place.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(plan: &SweepPlan, outcome: &Outcome) -> Result<Figure, ReportError> {
    let all = curves(plan, outcome);
    let shown: Vec<&Curve<'_>> = evenly(all.len(), CURVES)
        .into_iter()
        .filter_map(|k| all.get(k))
        .collect();
    let largest = |curve: &&Curve<'_>| {
        let losses = curve.records.iter().filter_map(|r| r.energy_loss_j());
        losses.fold(0.0, f64::max)
    };
    let peaks = || {
        let of_shown = |peak: &&Peak| shown.iter().any(|curve| is_of(peak, curve));
        outcome.peaks.iter().filter(of_shown)
    };
    let heights = || {
        let heights = shown.iter().map(largest);
        let heights = heights.chain(peaks().map(|peak| peak.energy_loss_j));
        heights.filter(|height| *height > 0.0)
    };
    let (factor, unit) = prefix(heights().fold(0.0, f64::max));
    let log = heights().fold(0.0, f64::max) > WIDE * heights().fold(f64::INFINITY, f64::min);
    let label = format!("energy loss per cycle / {unit}J");
    let series = shown.iter().enumerate().map(|(step, curve)| {
        let of = shown.len();
        let color = match of {
            1 => Color::Palette(0),
            _ => Color::Ramp { step, of },
        };
        let series = of_curve(curve, factor, log).color(color);
        match &curve.label {
            Some(label) => series.label(label.clone()).marker(Marker::nth(step)),
            None => series,
        }
    });
    let marks = peaks()
        .filter(|peak| !log || peak.energy_loss_j > 0.0)
        .map(|peak| mark(peak, factor, shown.len() == 1));
    let y = if log {
        Axis::log(label)
    } else {
        Axis::linear(label)
    };
    let chart = Chart::new(Axis::log("angular frequency ω / rad·s⁻¹"), y)
        .all_series(series)
        .all_marks(marks);
    Ok(Figure {
        name: "energy-loss",
        picture: chart.into(),
        data: data(plan, outcome)?,
    })
}

fn of_curve(curve: &Curve<'_>, factor: f64, log: bool) -> Series {
    let points = curve.records.iter().map(|record| {
        let loss = factor * record.energy_loss_j()?;
        (!log || loss > 0.0).then_some((record.angular_frequency_rad_per_s, loss))
    });
    let errors = curve
        .records
        .iter()
        .map(|record| Some(factor * record.energy_loss_error_j()?));
    let series = Series::line(points).marker(Marker::Disc);
    if curve
        .records
        .iter()
        .all(|r| r.energy_loss_error_j().is_none())
    {
        return series;
    }
    series.error_bars(errors)
}

/// Whether a peak is one of this curve: those of the only curve do not say which it is.
fn is_of(peak: &Peak, curve: &Curve<'_>) -> bool {
    peak.drive_mean
        .is_none_or(|mean| mean == curve.drive.mean())
        && peak
            .drive_amplitude
            .is_none_or(|amplitude| amplitude == curve.drive.amplitude())
}

fn mark(peak: &Peak, factor: f64, labelled: bool) -> Mark {
    let omega = peak.angular_frequency_rad_per_s;
    let label = format!("ω = {} rad/s", scientific(omega, 3));
    let mark = Mark::point(omega, factor * peak.energy_loss_j, label);
    // Labels at every peak of several curves would cover the curves.
    Mark {
        label: mark.label.filter(|_| labelled),
        ..mark
    }
}

fn data(plan: &SweepPlan, outcome: &Outcome) -> Result<Vec<u8>, ReportError> {
    let columns = [
        "kind",
        "drive_mean",
        "drive_amplitude",
        "angular_frequency_rad_per_s",
        "energy_loss_j",
        "energy_loss_error_j",
    ];
    let mut table = Table::new("energy-loss.csv", &columns)?;
    for record in &outcome.records {
        table.row(&[
            "case".to_owned(),
            number(record.drive_mean),
            number(record.drive_amplitude),
            number(record.angular_frequency_rad_per_s),
            optional(record.energy_loss_j()),
            optional(record.energy_loss_error_j()),
        ])?;
    }
    for peak in &outcome.peaks {
        let drive = &plan.drive;
        table.row(&[
            "peak".to_owned(),
            number(peak.drive_mean.unwrap_or(drive.mean())),
            number(peak.drive_amplitude.unwrap_or(drive.amplitude())),
            number(peak.angular_frequency_rad_per_s),
            number(peak.energy_loss_j),
            optional(peak.energy_loss_error_j),
        ])?;
    }
    table.finish()
}
