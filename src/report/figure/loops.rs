//! Hysteresis loops at a few frequencies of the sweep: load against approach.

use super::curve::{Curve, omega_label, with_the_largest};
use super::{Figure, prefix};
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, Color, Series};
use crate::report::table::{Table, number};
use crate::sweep::record::{CaseRecord, CaseResult};

/// Loops in one figure; more cannot be told apart.
const LOOPS: usize = 5;

/// The figure: loops evenly spread over the converged cases of a curve, the one with the largest loss among them.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(curve: &Curve<'_>) -> Result<Figure, ReportError> {
    let converged = curve.results();
    let losses: Vec<f64> = converged
        .iter()
        .map(|(_, result)| result.analysis.energy_loss_j)
        .collect();
    let chosen: Vec<_> = with_the_largest(&losses, LOOPS)
        .into_iter()
        .map(|i| converged[i])
        .collect();
    let largest = |signal: fn(&CaseResult) -> &[f64]| {
        let values = chosen.iter().flat_map(|(_, result)| signal(result));
        values.fold(0.0_f64, |a, v| a.max(v.abs()))
    };
    let (to_load, load_unit) = prefix(largest(|r| &r.samples.load_n));
    let (to_approach, approach_unit) = prefix(largest(|r| &r.samples.approach_m));
    let series = chosen.iter().enumerate().map(|(step, (record, result))| {
        let samples = &result.samples;
        let points = samples.approach_m.iter().zip(&samples.load_n);
        Series::line(points.map(|(d, w)| (to_approach * d, to_load * w)))
            .label(omega_label(record.angular_frequency_rad_per_s))
            .color(Color::Ramp {
                step,
                of: chosen.len(),
            })
    });
    let mut chart = Chart::new(
        Axis::linear(format!("approach δ / {approach_unit}m")),
        Axis::linear(format!("load W / {load_unit}N")),
    )
    .all_series(series);
    chart.title.clone_from(&curve.label);
    Ok(Figure {
        name: "loops",
        picture: chart.into(),
        data: data(&chosen)?,
    })
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
