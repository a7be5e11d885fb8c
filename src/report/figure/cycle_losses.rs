//! The energy loss of every cycle of the sine segments of a history: how it comes to the stabilised one.

use super::Figure;
use super::plot::Plot;
use super::quantity::{CYCLE, ENERGY_LOSS};
use super::trace::{Point, Trace};
use super::units::Units;
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::Marker;
use crate::report::number::with_error;
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
    segments.first()?;
    let traces = segments.iter().enumerate().map(|(step, cycles)| {
        let points = cycles.iter().map(|cycle| {
            Point::new(cycle.number as f64, loss_j(cycle)).error(cycle.errors.energy_loss_j)
        });
        let label = (segments.len() > 1).then(|| label(cycles, units));
        Trace::line(points)
            .marker(Marker::Disc)
            .of_family(step, segments.len())
            .maybe_label(label)
    });
    let plot = Plot::new(CYCLE, ENERGY_LOSS).traces(traces);
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
    let caption = Caption::new("Energy loss of every cycle")
        .say("The area of each loop once a straight line through its ends has closed it.")
        .say(format!("Last: {}.", listed(&last)));
    Some(Figure::of("cycle-losses", &[plot], caption, units).without_data())
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
