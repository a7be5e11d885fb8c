//! The loss of two results over frequency, and below it by how much they differ.

use super::plot::Plot;
use super::quantity::{ENERGY_LOSS, Quantity};
use super::trace::{Point, Trace};
use super::units::{Measure, Units};
use super::{Drawn, Figure};
use crate::report::caption::Caption;
use crate::report::chart::{LineStyle, Marker};
use crate::report::comparison::{Comparison, CurvePoint};
use crate::report::number::{at_frequency, range, scientific};

const DIFFERENCE: Quantity =
    Quantity::new("relative_difference", "new − baseline", Measure::Percent);

/// The figure; its data are the table of the comparison.
pub fn figure(comparison: &Comparison) -> Drawn {
    let curve = &comparison.curve;
    if curve.iter().all(|p| p.relative_difference().is_none()) {
        return Err("no figure: no case has a loss in both results");
    }
    let units = Units::in_si(comparison.unit);
    let frames = frames(curve, &units);
    Ok(Figure::of("comparison", &frames, caption(comparison), &units).without_data())
}

fn caption(comparison: &Comparison) -> Caption {
    let differences = comparison.curve.iter();
    let differences = differences.filter_map(|p| Some((p.relative_difference()?, p.place)));
    let largest = differences.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let largest = largest.map(|(difference, place)| {
        format!(
            "Largest difference: {} % at {}.",
            scientific(100.0 * difference, 3),
            at_frequency(comparison.unit, place.angular_frequency_rad_per_s, 4)
        )
    });
    let over = Units::in_si(comparison.unit).frequency_words();
    Caption::new(format!(
        "Energy loss per cycle over {over} in two results (above) and their relative difference (below)"
    ))
        .say(format!("{} cases are in both.", comparison.compared))
        .say_all(largest)
}

/// The losses of both results, or how far they are apart, over frequency: broken where the condition changes.
fn trace(curve: &[CurvePoint], value: impl Fn(&CurvePoint) -> Option<f64>) -> Trace {
    let condition = |p: &CurvePoint| (p.place.varied, p.place.drive_mean, p.place.drive_amplitude);
    let point = |p: &CurvePoint| Point::new(p.place.angular_frequency_rad_per_s, value(p));
    let parts = curve.chunk_by(|a, b| condition(a) == condition(b));
    let parts: Vec<Vec<Point>> = parts.map(|part| part.iter().map(point).collect()).collect();
    let x = parts
        .first()
        .and_then(|part| part.first())
        .map_or(0.0, |first| first.x);
    Trace::line(parts.join(&Point::new(x, None)))
}

fn frames(curve: &[CurvePoint], units: &Units) -> [Plot; 2] {
    let (low, high) = range(curve.iter().map(|p| p.place.angular_frequency_rad_per_s));
    let frame = |y: Quantity, traces: Vec<Trace>| {
        Plot::new(Quantity::frequency(units), y)
            .traces(traces)
            .x_ends(low, high)
    };
    let baseline = trace(curve, |p| p.baseline_j).label("baseline");
    let new = trace(curve, |p| p.new_j).label("new");
    let difference = trace(curve, CurvePoint::relative_difference).marker(Marker::Disc);
    [
        frame(
            ENERGY_LOSS,
            vec![baseline, new.style(LineStyle::Dashed).color(1)],
        )
        .height(450),
        frame(DIFFERENCE, vec![difference]).height(300),
    ]
}
