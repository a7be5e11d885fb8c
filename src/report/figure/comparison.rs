//! The loss of two results over frequency, and below it by how much they differ.

use super::units::Units;
use super::{Drawn, Figure, Picture};
use crate::quantity::FrequencyUnit;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, LineStyle, Marker, Series};
use crate::report::comparison::{Comparison, CurvePoint};
use crate::report::number::{at_frequency, largest, range, scientific};

const NAME: &str = "comparison";
const WIDTH_PX: u32 = 800;
const CURVES_PX: u32 = 450;
const DIFFERENCE_PX: u32 = 300;

/// The figure; its data are the table of the comparison.
pub fn figure(comparison: &Comparison) -> Drawn {
    let (curve, unit) = (&comparison.curve, comparison.unit);
    if curve.iter().all(|p| p.relative_difference().is_none()) {
        return Err("no figure: no case has a loss in both results");
    }
    Ok(Figure {
        name: NAME,
        picture: Picture(vec![losses(curve, unit), differences(curve, unit)]),
        caption: caption(comparison),
        data: Vec::new(),
    })
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

/// Points, broken where the condition changes.
fn points(
    (curve, unit): (&[CurvePoint], FrequencyUnit),
    value: impl Fn(&CurvePoint) -> Option<f64>,
) -> Vec<Option<(f64, f64)>> {
    let condition = |p: &CurvePoint| (p.place.varied, p.place.drive_mean, p.place.drive_amplitude);
    let point = |p: &CurvePoint| Some((unit.of(p.place.angular_frequency_rad_per_s), value(p)?));
    let parts = curve.chunk_by(|a, b| condition(a) == condition(b));
    let parts: Vec<Vec<_>> = parts.map(|part| part.iter().map(point).collect()).collect();
    parts.join(&None)
}

/// The axis of both panels, with the same ends, where there is more than one frequency.
fn frequencies(curve: &[CurvePoint], unit: FrequencyUnit, label: &str) -> Axis {
    let omegas = curve.iter().map(|p| p.place.angular_frequency_rad_per_s);
    match range(omegas.map(|omega| unit.of(omega))) {
        (low, high) if low < high => Axis::log(label).range(low, high),
        _ => Axis::log(label),
    }
}

fn losses(curve: &[CurvePoint], unit: FrequencyUnit) -> Chart {
    let all = curve.iter().flat_map(|p| [p.baseline_j, p.new_j]).flatten();
    let (factor, energy) = Units::in_si(unit).energy(largest(all));
    let scaled = |loss: Option<f64>| loss.map(|j| factor * j);
    Chart::new(
        frequencies(curve, unit, ""),
        Axis::linear(format!("energy loss per cycle / {energy}")),
    )
    .series(Series::line(points((curve, unit), |p| scaled(p.baseline_j))).label("baseline"))
    .series(
        Series::line(points((curve, unit), |p| scaled(p.new_j)))
            .label("new")
            .style(LineStyle::Dashed)
            .color(1),
    )
    .size(WIDTH_PX, CURVES_PX)
}

fn differences(curve: &[CurvePoint], unit: FrequencyUnit) -> Chart {
    let percent = |p: &CurvePoint| p.relative_difference().map(|d| 100.0 * d);
    Chart::new(
        frequencies(curve, unit, &Units::in_si(unit).frequency_title()),
        Axis::linear("new − baseline / %"),
    )
    .series(Series::line(points((curve, unit), percent)).marker(Marker::Disc))
    .size(WIDTH_PX, DIFFERENCE_PX)
}
