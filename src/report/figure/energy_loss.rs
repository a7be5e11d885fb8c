//! Energy loss per cycle against frequency, or another axis of the sweep, with error bars, its peaks marked; one curve per value of
//! the other axes.

use super::Figure;
use super::curve::{Curve, SweepCurves};
use super::quantity::ENERGY_LOSS;
use super::trace::{Point, Trace};
use crate::report::caption::{self, Caption};
use crate::report::chart::{Mark, Marker};
use crate::report::peaks;
use crate::sweep::record::CaseRecord;

/// Curves in one figure; more cannot be told apart.
pub(super) const CURVES: usize = 8;

/// The figure. A case without a result breaks the line: nothing is drawn in its place.
pub fn figure(sweep: &SweepCurves<'_>) -> Figure {
    let shown = sweep.shown(CURVES);
    let traces = shown.iter().enumerate().map(|(step, curve)| {
        let peaks = sweep.peaks_of(curve);
        let located = peaks.map(|peak| (peak.angular_frequency_rad_per_s, peak.energy_loss_j));
        let records = curve.records.iter();
        let trace = Trace::line(records.map(|record| point(sweep.place(record), record)))
            .marker(Marker::Disc)
            .of_family(step, shown.len())
            .member(curve.member)
            .smooth(located);
        match has_band(curve) {
            _ if shown.len() > 1 => trace.maybe_label(curve.label.clone()),
            true => Trace {
                band_label: Some("uncertainty of the material".to_owned()),
                ..trace.label("energy loss, numerical error")
            },
            false => trace,
        }
    });
    let peaks = shown.iter().flat_map(|curve| sweep.peaks_of(curve));
    let marks = peaks.map(|peak| {
        let omega = peak.angular_frequency_rad_per_s;
        // Labels at every peak of several curves would cover the curves.
        let label = match shown.len() {
            1 => sweep.units.frequency_label(omega),
            _ => String::new(),
        };
        Mark::point(omega, peak.energy_loss_j, label)
    });
    let marks: Vec<Mark> = marks.collect();
    let caption = caption(sweep, shown.len(), !marks.is_empty());
    let which = match shown[..] {
        [curve] => curve.label.clone(),
        _ => None,
    };
    let plot = sweep
        .plot(ENERGY_LOSS)
        .title(which)
        .traces(traces)
        .marks(marks);
    Figure::of("energy-loss", &[plot], caption, &sweep.units)
}

fn point(x: f64, record: &CaseRecord) -> Point {
    let band = |loss_j: f64| {
        let half_j = record.energy_loss_material_band_j()?;
        // No passive material gains energy.
        Some(((loss_j - half_j).max(0.0), loss_j + half_j))
    };
    Point::new(x, record.energy_loss_j())
        .error(record.energy_loss_error_j())
        .band(record.energy_loss_j().and_then(band))
}

fn has_band(curve: &Curve<'_>) -> bool {
    let mut records = curve.records.iter();
    records.any(|record| record.energy_loss_material_error_j().is_some())
}

fn caption(sweep: &SweepCurves<'_>, shown: usize, has_rings: bool) -> Caption {
    let (plan, outcome) = (sweep.plan, sweep.outcome);
    let peaks = has_rings.then(|| peaks::shown(plan, outcome));
    let peaks = peaks.iter().flatten().map(|peak| {
        let what = match peak.is_largest {
            true => "Largest peak",
            false => "Lower peak",
        };
        format!("{what}: {}.", peak.sentence())
    });
    let rings = has_rings
        .then(|| "Rings: peaks, located between the samples by further computations.".to_owned());
    let parts = [
        rings,
        caption::error_bars(plan, outcome),
        caption::material_band(plan, outcome),
        caption::absent(outcome),
    ];
    Caption::new(format!("Energy loss per cycle {}", sweep.over_words(shown)))
        .say_all(peaks)
        .say_all(parts.into_iter().flatten())
}
