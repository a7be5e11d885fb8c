//! Energy loss per cycle against angular frequency, with error bars, its peaks marked; one curve per value of a second axis.

use super::Figure;
use super::curve::{Curve, evenly, place_cells, place_columns, place_of};
use super::units::Units;
use crate::report::caption::{self, Caption};
use crate::report::chart::{Axis, Chart, Color, Mark, Marker, Series};
use crate::report::number::{largest, range, with_error};
use crate::report::peaks;
use crate::report::table::{Cell, cells, csv_leading};
use crate::sweep::plan::SweepPlan;
use crate::sweep::search::peak::Peak;
use crate::sweep::search::run::Outcome;

/// Curves in one figure; more cannot be told apart.
const CURVES: usize = 8;
/// Points of a curve that each have their symbol; more would cover its line.
const SYMBOLS: usize = 200;
/// Peaks further apart than this need a logarithmic axis to be seen both.
const WIDE: f64 = 20.0;

/// The figure. A case without a result breaks the line: nothing is drawn in its place.
pub fn figure(plan: &SweepPlan, outcome: &Outcome, all: &[Curve<'_>], units: &Units) -> Figure {
    let shown: Vec<&Curve<'_>> = evenly(all.len(), CURVES)
        .into_iter()
        .filter_map(|k| all.get(k))
        .collect();
    let of_curve_j =
        |curve: &&Curve<'_>| largest(curve.records.iter().filter_map(|r| r.energy_loss_j()));
    let peaks = || {
        let of_shown = |peak: &&Peak| shown.iter().any(|curve| peak.is_of(&curve.condition));
        outcome.peaks.iter().filter(of_shown)
    };
    let heights = || {
        let heights = shown.iter().map(of_curve_j);
        let heights = heights.chain(peaks().map(|peak| peak.energy_loss_j));
        heights.filter(|height| *height > 0.0)
    };
    let (lowest, highest) = range(heights());
    let (factor, unit) = units.energy(highest.max(0.0));
    let to_omega = units.frequency().0;
    let log = highest > WIDE * lowest;
    let label = format!("energy loss per cycle / {unit}");
    let series = shown.iter().enumerate().map(|(step, curve)| {
        let series = of_curve(curve, (to_omega, factor), log).color(color(step, shown.len()));
        match &curve.label {
            Some(label) => series.label(label.clone()).marker(Marker::nth(step)),
            None if has_band(curve) => series.label("energy loss, numerical error"),
            None => series,
        }
    });
    let bands = shown.iter().enumerate().filter_map(|(step, curve)| {
        let band = band_of(curve, (to_omega, factor), log)?.color(color(step, shown.len()));
        Some(match curve.label {
            Some(_) => band,
            None => band.label("uncertainty of the material"),
        })
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
        .all_series(bands)
        .all_series(series)
        .all_marks(marks);
    Figure {
        name: "energy-loss",
        picture: chart.into(),
        caption: caption(plan, outcome, &shown, units),
        data: data(plan, outcome, units),
    }
}

fn color(step: usize, of: usize) -> Color {
    match of {
        1 => Color::Palette(0),
        _ => Color::Ramp { step, of },
    }
}

fn has_band(curve: &Curve<'_>) -> bool {
    let mut records = curve.records.iter();
    records.any(|record| record.energy_loss_material_error_j().is_some())
}

/// What the noise of the data behind the material makes of the curve; `None` where it has no replicas.
fn band_of(curve: &Curve<'_>, (to_omega, factor): (f64, f64), log: bool) -> Option<Series> {
    let points: Vec<(f64, f64, f64)> = (curve.records.iter())
        .filter_map(|record| {
            let (loss, error) = (
                record.energy_loss_j()?,
                record.energy_loss_material_error_j()?,
            );
            // No passive material gains energy; and on a logarithmic axis zero has no place.
            let lowest = if log { 1e-3 * loss } else { 0.0 };
            let lower = (loss - error).max(lowest);
            (!log || loss > 0.0).then_some((
                to_omega * record.angular_frequency_rad_per_s,
                factor * lower,
                factor * (loss + error),
            ))
        })
        .collect();
    (points.len() > 1).then(|| Series::band(points))
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
    let series = match curve.records.len() > SYMBOLS {
        true => series.spaced(),
        false => series,
    };
    if curve
        .records
        .iter()
        .all(|r| r.energy_loss_error_j().is_none())
    {
        return series;
    }
    series.error_bars(errors)
}

fn mark(peak: &Peak, (units, factor): (&Units, f64), labelled: bool) -> Mark {
    let omega = peak.angular_frequency_rad_per_s;
    let place = units.frequency().0 * omega;
    let mark = Mark::point(
        place,
        factor * peak.energy_loss_j,
        units.frequency_label(omega),
    );
    // Labels at every peak of several curves would cover the curves.
    Mark {
        label: mark.label.filter(|_| labelled),
        ..mark
    }
}

fn caption(plan: &SweepPlan, outcome: &Outcome, shown: &[&Curve<'_>], units: &Units) -> Caption {
    let over = units.frequency_words();
    let mut caption = Caption::new(format!("Energy loss per cycle over {over}"));
    if let Some(axes) = &plan.axes {
        let varied = axes.varied().words();
        let curves = shown.len();
        caption = caption.say(format!("{curves} curves, one per {varied}."));
    }
    for peak in peaks::shown(plan, outcome, with_error) {
        let what = match peak.is_largest {
            true => "Largest peak",
            false => "Lower peak",
        };
        caption = caption.say(format!("{what}: {}.", peak.sentence()));
    }
    let rings = (!outcome.peaks.is_empty())
        .then(|| "Rings: peaks, located between the samples by further computations.".to_owned());
    let crowded = shown.iter().any(|curve| curve.records.len() > SYMBOLS);
    let symbols = crowded.then(|| "Lines through all cases, symbols at some.".to_owned());
    let parts = [
        symbols,
        rings,
        caption::error_bars(plan, outcome),
        caption::material_band(plan, outcome),
        caption::absent(outcome),
    ];
    caption.say_all(parts.into_iter().flatten())
}

fn data(plan: &SweepPlan, outcome: &Outcome, units: &Units) -> Vec<u8> {
    let axes = plan.axes.as_ref();
    let mut columns = vec!["kind".to_owned()];
    columns.extend(place_columns(axes));
    let numbers = [
        "angular_frequency_rad_per_s",
        "energy_loss_j",
        "energy_loss_error_j",
        "energy_loss_material_error_j",
    ];
    columns.extend(numbers.map(str::to_owned));
    let row = |kind: &str, place: Vec<Cell>, numbers: [Cell; 4]| {
        let kind = Cell::from(kind.to_owned());
        let cells = [kind].into_iter().chain(place).chain(numbers);
        cells.collect::<Vec<Cell>>()
    };
    let cases = outcome.records.iter().map(|record| {
        let numbers = cells![
            record.angular_frequency_rad_per_s,
            record.energy_loss_j(),
            record.energy_loss_error_j(),
            record.energy_loss_material_error_j(),
        ];
        row("case", place_of(axes, record), numbers)
    });
    let peaks = outcome.peaks.iter().map(|peak| {
        let drive = [
            peak.drive_mean.unwrap_or(plan.drive.mean()),
            peak.drive_amplitude.unwrap_or(plan.drive.amplitude()),
        ];
        let numbers = cells![
            peak.angular_frequency_rad_per_s,
            peak.energy_loss_j,
            peak.energy_loss_error_j,
            peak.energy_loss_material_error_j,
        ];
        row("peak", place_cells(axes, peak.varied, drive), numbers)
    });
    csv_leading(units.frequency_unit(), &columns, cases.chain(peaks))
}
