//! Energy loss per cycle against angular frequency, with error bars, its peaks marked; one curve per value of a second axis.

use super::Figure;
use super::curve::{Curve, SweepCurves, evenly};
use crate::report::caption::{self, Caption};
use crate::report::chart::{Axis, Chart, Color, Mark, Marker, Series};
use crate::report::number::{largest, range};
use crate::report::peaks;
use crate::report::table::{Cell, cells};
use crate::sweep::record::CaseRecord;
use crate::sweep::search::peak::Peak;

/// Curves in one figure; more cannot be told apart.
const CURVES: usize = 8;
/// Points of a curve that each have their symbol; more would cover its line.
const SYMBOLS: usize = 200;
/// Peaks further apart than this need a logarithmic axis to be seen both.
const WIDE: f64 = 20.0;

/// The figure. A case without a result breaks the line: nothing is drawn in its place.
pub fn figure(sweep: &SweepCurves<'_>) -> Figure {
    let (all, units) = (&sweep.curves, &sweep.units);
    let shown: Vec<&Curve<'_>> = evenly(all.len(), CURVES)
        .into_iter()
        .filter_map(|k| all.get(k))
        .collect();
    let peaks = || {
        let of_shown = |peak: &&Peak| shown.iter().any(|curve| peak.is_of(&curve.condition));
        sweep.outcome.peaks.iter().filter(of_shown)
    };
    let heights = shown.iter().map(|curve| {
        let losses = curve.records.iter().filter_map(|r| r.energy_loss_j());
        largest(losses)
    });
    let heights = heights.chain(peaks().map(|peak| peak.energy_loss_j));
    let (lowest, highest) = range(heights.filter(|height| *height > 0.0));
    let (factor, unit) = units.energy(highest.max(0.0));
    let to_omega = units.frequency().0;
    let log = highest > WIDE * lowest;
    let label = format!("energy loss per cycle / {unit}");
    let series = shown.iter().enumerate().map(|(step, curve)| {
        let color = Color::of_family(step, shown.len());
        let series = of_curve(curve, (to_omega, factor), log).color(color);
        match &curve.label {
            Some(label) => series.label(label.clone()).marker(Marker::nth(step)),
            None if has_band(curve) => series.label("energy loss, numerical error"),
            None => series,
        }
    });
    let bands = shown.iter().enumerate().filter_map(|(step, curve)| {
        let color = Color::of_family(step, shown.len());
        let band = band_of(curve, (to_omega, factor), log)?.color(color);
        Some(match curve.label {
            Some(_) => band,
            None => band.label("uncertainty of the material"),
        })
    });
    let marks = peaks()
        .filter(|peak| !log || peak.energy_loss_j > 0.0)
        .map(|peak| {
            let omega = peak.angular_frequency_rad_per_s;
            // Labels at every peak of several curves would cover the curves.
            let label = match shown.len() {
                1 => units.frequency_label(omega),
                _ => String::new(),
            };
            Mark::point(to_omega * omega, factor * peak.energy_loss_j, label)
        });
    let y = match log {
        true => Axis::log(label),
        false => Axis::linear(label),
    };
    let chart = Chart::new(Axis::log(units.frequency_title()), y)
        .all_series(bands)
        .all_series(series)
        .all_marks(marks);
    Figure {
        name: "energy-loss",
        picture: chart.into(),
        caption: caption(sweep, &shown),
        data: data(sweep),
    }
}

fn has_band(curve: &Curve<'_>) -> bool {
    let mut records = curve.records.iter();
    records.any(|record| record.energy_loss_material_error_j().is_some())
}

/// What the noise of the data behind the material makes of the curve; `None` where it has no replicas.
fn band_of(curve: &Curve<'_>, (to_omega, factor): (f64, f64), log: bool) -> Option<Series> {
    let point = |record: &&CaseRecord| {
        let loss = record.energy_loss_j().filter(|loss| !log || *loss > 0.0)?;
        let error = record.energy_loss_material_band_j()?;
        // No passive material gains energy; and on a logarithmic axis zero has no place.
        let lowest = if log { 1e-3 * loss } else { 0.0 };
        let lower = (loss - error).max(lowest);
        let omega = to_omega * record.angular_frequency_rad_per_s;
        Some((omega, factor * lower, factor * (loss + error)))
    };
    let points: Vec<(f64, f64, f64)> = curve.records.iter().filter_map(point).collect();
    (points.len() > 1).then(|| Series::band(points))
}

fn of_curve(curve: &Curve<'_>, (to_omega, factor): (f64, f64), log: bool) -> Series {
    let records = || curve.records.iter();
    let points = records().map(|record| {
        let loss = factor * record.energy_loss_j()?;
        (!log || loss > 0.0).then_some((to_omega * record.angular_frequency_rad_per_s, loss))
    });
    let errors = || records().map(|record| Some(factor * record.energy_loss_error_j()?));
    let mut series = Series::line(points).marker(Marker::Disc);
    series.spaced = curve.records.len() > SYMBOLS;
    match errors().any(|error| error.is_some()) {
        true => series.error_bars(errors()),
        false => series,
    }
}

fn caption(sweep: &SweepCurves<'_>, shown: &[&Curve<'_>]) -> Caption {
    let (plan, outcome) = (sweep.plan, sweep.outcome);
    let over = sweep.units.frequency_words();
    let curves = plan.axes.as_ref().map(|axes| {
        let varied = axes.varied().words();
        format!("{} curves, one per {varied}.", shown.len())
    });
    let peaks = peaks::shown(plan, outcome);
    let peaks = peaks.iter().map(|peak| {
        let what = match peak.is_largest {
            true => "Largest peak",
            false => "Lower peak",
        };
        format!("{what}: {}.", peak.sentence())
    });
    let rings = (!outcome.peaks.is_empty())
        .then(|| "Rings: peaks, located between the samples by further computations.".to_owned());
    let crowded = shown.iter().any(|curve| curve.records.len() > SYMBOLS);
    let parts = [
        crowded.then(|| "Lines through all cases, symbols at some.".to_owned()),
        rings,
        caption::error_bars(plan, outcome),
        caption::material_band(plan, outcome),
        caption::absent(outcome),
    ];
    Caption::new(format!("Energy loss per cycle over {over}"))
        .say_all(curves)
        .say_all(peaks)
        .say_all(parts.into_iter().flatten())
}

fn data(sweep: &SweepCurves<'_>) -> Vec<u8> {
    let cases = sweep.outcome.records.iter().map(|record| {
        let numbers = cells![
            record.angular_frequency_rad_per_s,
            record.energy_loss_j(),
            record.energy_loss_error_j(),
            record.energy_loss_material_error_j(),
            record.energy_loss_material_band_j(),
        ];
        ("case", sweep.place_of(record), numbers)
    });
    let peaks = sweep.outcome.peaks.iter().map(|peak| {
        let numbers = cells![
            peak.angular_frequency_rad_per_s,
            peak.energy_loss_j,
            peak.energy_loss_error_j,
            peak.energy_loss_material_error_j,
            None::<f64>,
        ];
        ("peak", sweep.place_of_peak(peak), numbers)
    });
    let rows = cases.chain(peaks).map(|(kind, place, numbers)| {
        let place = [Cell::from(kind)].into_iter().chain(place);
        (place.collect(), numbers)
    });
    let numbers = [
        "angular_frequency_rad_per_s",
        "energy_loss_j",
        "energy_loss_error_j",
        "energy_loss_material_error_j",
        "energy_loss_material_band_j",
    ];
    sweep.table(&["kind"], &numbers, rows)
}
