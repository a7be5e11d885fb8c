//! Hysteresis loops at a few frequencies of the sweep: load against approach.

use super::Figure;
use super::curve::{Curve, chosen};
use super::units::Units;
use crate::quantity::Dimension;
use crate::report::ReportError;
use crate::report::caption::{Caption, listed};
use crate::report::chart::{Axis, Chart, Color, Series};
use crate::report::number::{plain, with_error};
use crate::report::table::{Table, number};
use crate::sweep::record::{CaseRecord, CaseResult};

/// Loops in one figure; more cannot be told apart.
const LOOPS: usize = 5;

/// The figure: of the converged cases of a curve those nearest to the frequencies asked for (rad/s), or some evenly spread, the
/// one with the largest loss among them.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(
    curve: &Curve<'_>,
    asked_rad_per_s: &[f64],
    units: &Units,
) -> Result<Figure, ReportError> {
    let chosen = chosen(&curve.results(), asked_rad_per_s, LOOPS);
    let largest = |signal: fn(&CaseResult) -> &[f64]| {
        let values = chosen.iter().flat_map(|(_, result)| signal(result));
        values.fold(0.0_f64, |a, v| a.max(v.abs()))
    };
    let (to_load, load_unit) = units.load(largest(|r| &r.samples.load_n));
    let (to_approach, approach_unit) = units.approach(largest(|r| &r.samples.approach_m));
    let series = chosen.iter().enumerate().map(|(step, (record, result))| {
        let samples = &result.samples;
        let points = samples.approach_m.iter().zip(&samples.load_n);
        Series::line(points.map(|(d, w)| (to_approach * d, to_load * w)))
            .label(units.omega(record.angular_frequency_rad_per_s))
            .color(Color::Ramp {
                step,
                of: chosen.len(),
            })
    });
    let mut chart = Chart::new(
        Axis::linear(format!("approach δ / {approach_unit}")),
        Axis::linear(format!("load W / {load_unit}")),
    )
    .all_series(series);
    chart.title.clone_from(&curve.label);
    Ok(Figure {
        name: "loops",
        picture: chart.into(),
        caption: caption(curve, &chosen),
        data: data(&chosen)?,
    })
}

fn caption(curve: &Curve<'_>, chosen: &[(&CaseRecord, &CaseResult)]) -> Caption {
    let loops: Vec<String> = chosen
        .iter()
        .map(|(record, result)| {
            let loss_j = result.analysis.energy_loss_j;
            let loss = with_error(loss_j, record.energy_loss_error_j(), Dimension::Energy);
            let omega = record.angular_frequency_rad_per_s;
            format!(
                "{loss} at ω = {}",
                plain(omega, Dimension::AngularFrequency, 4)
            )
        })
        .collect();
    Caption::new("Hysteresis loops: load W over approach δ in the stabilised cycle")
        .say_all(curve.sentence())
        .say(format!(
            "Their areas are the energy losses per cycle: {}.",
            listed(&loops)
        ))
}

fn data(chosen: &[(&CaseRecord, &CaseResult)]) -> Result<Vec<u8>, ReportError> {
    let columns = ["angular_frequency_rad_per_s", "approach_m", "load_n"];
    let mut table = Table::new("loops.csv", &columns)?;
    for (record, result) in chosen {
        let samples = &result.samples;
        for (approach, load) in samples.approach_m.iter().zip(&samples.load_n) {
            table.row(&[
                number(record.angular_frequency_rad_per_s),
                number(*approach),
                number(*load),
            ])?;
        }
    }
    table.finish()
}
