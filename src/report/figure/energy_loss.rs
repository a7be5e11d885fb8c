//! Energy loss per cycle against angular frequency, with error bars, its peaks marked; one curve per drive.

use super::Figure;
use super::curve::{Curve, evenly};
use super::units::Units;
use crate::quantity::Dimension;
use crate::report::ReportError;
use crate::report::caption::{self, Caption};
use crate::report::chart::{Axis, Chart, Color, Mark, Marker, Series};
use crate::report::number::with_error;
use crate::report::table::{Table, number, optional};
use crate::sweep::plan::SweepPlan;
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// Curves in one figure; more cannot be told apart.
const CURVES: usize = 8;
/// Peaks further apart than this need a logarithmic axis to be seen both.
const WIDE: f64 = 20.0;

/// The figure. A case without a result breaks the line: nothing is drawn in its place.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(
    plan: &SweepPlan,
    outcome: &Outcome,
    all: &[Curve<'_>],
    units: &Units,
) -> Result<Figure, ReportError> {
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
    let (factor, unit) = units.energy(heights().fold(0.0, f64::max));
    let to_omega = units.frequency().0;
    let log = heights().fold(0.0, f64::max) > WIDE * heights().fold(f64::INFINITY, f64::min);
    let label = format!("energy loss per cycle / {unit}");
    let series = shown.iter().enumerate().map(|(step, curve)| {
        let of = shown.len();
        let color = match of {
            1 => Color::Palette(0),
            _ => Color::Ramp { step, of },
        };
        let series = of_curve(curve, (to_omega, factor), log).color(color);
        match &curve.label {
            Some(label) => series.label(label.clone()).marker(Marker::nth(step)),
            None => series,
        }
    });
    let marks = peaks()
        .filter(|peak| !log || peak.energy_loss_j > 0.0)
        .map(|peak| mark(peak, (units, factor), shown.len() == 1));
    let y = if log {
        Axis::log(label)
    } else {
        Axis::linear(label)
    };
    let chart = Chart::new(Axis::log(units.frequency_title()), y)
        .all_series(series)
        .all_marks(marks);
    Ok(Figure {
        name: "energy-loss",
        picture: chart.into(),
        caption: caption(plan, outcome, &shown),
        data: data(plan, outcome)?,
    })
}

fn of_curve(curve: &Curve<'_>, (to_omega, factor): (f64, f64), log: bool) -> Series {
    let points = curve.records.iter().map(|record| {
        let loss = factor * record.energy_loss_j()?;
        (!log || loss > 0.0).then_some((to_omega * record.angular_frequency_rad_per_s, loss))
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

fn mark(peak: &Peak, (units, factor): (&Units, f64), labelled: bool) -> Mark {
    let omega = peak.angular_frequency_rad_per_s;
    let place = units.frequency().0 * omega;
    let mark = Mark::point(place, factor * peak.energy_loss_j, units.omega(omega));
    // Labels at every peak of several curves would cover the curves.
    Mark {
        label: mark.label.filter(|_| labelled),
        ..mark
    }
}

fn caption(plan: &SweepPlan, outcome: &Outcome, shown: &[&Curve<'_>]) -> Caption {
    let mut caption = Caption::new("Energy loss per cycle over angular frequency ω");
    if let Some(axis) = &plan.axis {
        let varied = axis.varied.name();
        let curves = shown.len();
        caption = caption.say(format!("{curves} curves, one per {varied} of the drive."));
    }
    let told = match plan.axis {
        // Each curve has its own.
        Some(_) => outcome.peaks.len().min(1),
        None => outcome.peaks.len(),
    };
    for (rank, peak) in outcome.peaks.iter().take(told).enumerate() {
        let what = if rank == 0 {
            "Largest peak"
        } else {
            "Lower peak"
        };
        let under = plan.axis.as_ref().and_then(|axis| {
            let value = peak.drive(axis.varied)?;
            let value = Units::default().drive_value(plan.drive.control(), value);
            Some(format!(", {} {value}", axis.varied.name()))
        });
        caption = caption.say(format!(
            "{what}: {} at ω = {}{}.",
            with_error(
                peak.energy_loss_j,
                peak.energy_loss_error_j,
                Dimension::Energy
            ),
            with_error(
                peak.angular_frequency_rad_per_s,
                Some(peak.angular_frequency_uncertainty_rad_per_s),
                Dimension::AngularFrequency
            ),
            under.unwrap_or_default()
        ));
    }
    let rings = (!outcome.peaks.is_empty())
        .then(|| "Rings: peaks, located between the samples by further computations.".to_owned());
    let parts = [
        rings,
        caption::error_bars(plan, outcome),
        caption::absent(outcome),
    ];
    caption.say_all(parts.into_iter().flatten())
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
