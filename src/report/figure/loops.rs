//! Hysteresis loops at a few frequencies of the sweep: load against approach.

use super::Figure;
use super::curve::{Curve, chosen};
use super::units::Units;
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, Series};
use crate::report::number::{largest, with_error};
use crate::report::table::{cells, csv_leading};
use crate::report::words::listed;
use crate::sweep::record::{CaseRecord, CaseResult, Status};

/// Loops in one figure; more cannot be told apart.
pub const LOOPS: usize = 5;

/// The figure: of the converged cases of a curve those nearest to the frequencies asked for (rad/s), or some evenly spread, the
/// one with the largest loss among them.
pub fn figure(curve: &Curve<'_>, asked_rad_per_s: &[f64], units: &Units) -> Figure {
    let chosen = chosen(&curve.results(), asked_rad_per_s, LOOPS);
    let of = chosen.len();
    let reach = |signal: fn(&CaseResult) -> &[f64]| {
        let values = chosen.iter().flat_map(|(_, result)| signal(result));
        largest(values.map(|value| value.abs()))
    };
    let (to_load, load_unit) = units.load(reach(|r| &r.cycle.samples.load_n));
    let (to_approach, approach_unit) = units.approach(reach(|r| &r.cycle.samples.approach_m));
    let series = chosen.iter().enumerate().map(|(step, (record, result))| {
        let samples = &result.cycle.samples;
        let points = samples.approach_m.iter().zip(&samples.load_n);
        Series::line(points.map(|(d, w)| (to_approach * d, to_load * w)))
            .label(units.frequency_label(record.angular_frequency_rad_per_s))
            .color(Color::Ramp { step, of })
    });
    let chart = Chart::new(
        Axis::linear(format!("approach δ / {approach_unit}")),
        Axis::linear(format!("load W / {load_unit}")),
    )
    .maybe_title(curve.label.clone())
    .all_series(series);
    Figure {
        name: "loops",
        picture: chart.into(),
        caption: caption(curve, &chosen, units),
        data: data(&chosen, units),
    }
}

fn caption(curve: &Curve<'_>, chosen: &[(&CaseRecord, &CaseResult)], units: &Units) -> Caption {
    let loops: Vec<String> = chosen
        .iter()
        .map(|(record, result)| {
            let loss_j = result.analysis.energy_loss_j;
            let loss = with_error(loss_j, record.energy_loss_error_j(), Dimension::Energy);
            format!("{loss} at {}", units.at(record.angular_frequency_rad_per_s))
        })
        .collect();
    let mut records = chosen.iter().map(|(record, _)| record.status);
    let (of, areas) = match records.any(|status| status == Status::Transient) {
        true => (
            "a cycle on the way to the stabilised one",
            "The areas that they have once a straight line has closed them",
        ),
        false => ("the stabilised cycle", "Their areas"),
    };
    Caption::new(format!("Hysteresis loops: load W over approach δ in {of}"))
        .say_all(curve.sentence.clone())
        .say(format!(
            "{areas} are the energy losses per cycle: {}.",
            listed(&loops)
        ))
}

fn data(chosen: &[(&CaseRecord, &CaseResult)], units: &Units) -> Vec<u8> {
    let columns = ["angular_frequency_rad_per_s", "approach_m", "load_n"];
    let rows = chosen.iter().flat_map(|(record, result)| {
        let (omega, samples) = (record.angular_frequency_rad_per_s, &result.cycle.samples);
        let points = samples.approach_m.iter().zip(&samples.load_n);
        points.map(move |(approach, load)| cells![omega, *approach, *load])
    });
    csv_leading(units.frequency_unit(), &columns, rows)
}
