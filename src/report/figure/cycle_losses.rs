//! The energy loss of every cycle of the sine segments of a history: how it comes to the stabilised one.

use super::Figure;
use super::units::Units;
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, Marker, Series};
use crate::report::number::{largest, with_error};
use crate::report::words::listed;
use crate::simulation::SimulationOutcome;
use crate::simulation::cycles::HistoryCycle;

/// Cycles that make a curve.
const FEWEST: usize = 2;

/// The figure; its data are cycles.csv. Nothing where no segment has two cycles.
pub fn figure(outcome: &SimulationOutcome, units: &Units) -> Option<Figure> {
    let segments: Vec<&[HistoryCycle]> = outcome
        .cycles
        .chunk_by(|a, b| a.segment == b.segment)
        .filter(|cycles| cycles.iter().filter_map(loss_j).count() >= FEWEST)
        .collect();
    let all = segments.iter().flat_map(|cycles| cycles.iter());
    let (factor, unit) = units.energy(largest(all.filter_map(loss_j).map(f64::abs)));
    if segments.is_empty() {
        return None;
    }
    let series = segments.iter().enumerate().map(|(step, cycles)| {
        let points = cycles
            .iter()
            .map(|cycle| Some((cycle.number as f64, factor * loss_j(cycle)?)));
        let errors = cycles
            .iter()
            .map(|cycle| Some(factor * cycle.errors.energy_loss_j?));
        let series = Series::line(points)
            .marker(Marker::nth(step))
            .color(Color::of_family(step, segments.len()));
        let series = match cycles.iter().any(|c| c.errors.energy_loss_j.is_some()) {
            true => series.error_bars(errors),
            false => series,
        };
        match segments.len() {
            1 => series,
            _ => series.label(label(cycles, units)),
        }
    });
    let chart = Chart::new(
        Axis::linear("number of the cycle"),
        Axis::linear(format!("energy loss per cycle / {unit}")),
    )
    .all_series(series);
    let last = segments.iter().filter_map(|cycles| {
        let (cycle, loss) = cycles.iter().rev().find_map(|c| Some((c, loss_j(c)?)))?;
        let loss = with_error(loss, cycle.errors.energy_loss_j, Dimension::Energy);
        Some(format!(
            "{loss} in cycle {} of {}",
            cycle.number,
            label(cycles, units)
        ))
    });
    let last: Vec<String> = last.collect();
    Some(Figure {
        name: "cycle-losses",
        picture: chart.into(),
        caption: Caption::new("Energy loss of every cycle")
            .say("The area of each loop once a straight line through its ends has closed it.")
            .say(format!("Last: {}.", listed(&last))),
        data: Vec::new(),
    })
}

fn loss_j(cycle: &HistoryCycle) -> Option<f64> {
    Some(cycle.numbers.as_ref()?.analysis.energy_loss_j)
}

fn label(cycles: &[HistoryCycle], units: &Units) -> String {
    let first = cycles.first();
    let segment = first.map_or(0, |cycle| cycle.segment);
    let omega = first.map_or(0.0, |cycle| cycle.angular_frequency_rad_per_s);
    format!("segment {segment}, {}", units.value_of(omega))
}
