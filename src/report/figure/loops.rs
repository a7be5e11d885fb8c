//! Hysteresis loops at a few frequencies of the sweep: load against approach.

use super::{Figure, prefix, scientific};
use crate::report::ReportError;
use crate::report::chart::{Axis, Chart, Color, Series};
use crate::report::table::{Table, number};
use crate::sweep::record::{CaseRecord, CaseResult};

/// Loops in one figure; more cannot be told apart.
const LOOPS: usize = 5;

/// The figure: loops evenly spread over the converged cases, the one with the largest loss among them.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(records: &[CaseRecord]) -> Result<Figure, ReportError> {
    let converged: Vec<(&CaseRecord, &CaseResult)> = records
        .iter()
        .filter_map(|r| Some((r, r.result.as_ref()?)))
        .collect();
    let losses: Vec<f64> = converged
        .iter()
        .map(|(_, result)| result.analysis.energy_loss_j)
        .collect();
    let chosen: Vec<_> = choose(&losses).into_iter().map(|i| converged[i]).collect();
    let largest = |signal: fn(&CaseResult) -> &[f64]| {
        let values = chosen.iter().flat_map(|(_, result)| signal(result));
        values.fold(0.0_f64, |a, v| a.max(v.abs()))
    };
    let (to_load, load_unit) = prefix(largest(|r| &r.samples.load_n));
    let (to_approach, approach_unit) = prefix(largest(|r| &r.samples.approach_m));
    let series = chosen.iter().enumerate().map(|(step, (record, result))| {
        let samples = &result.samples;
        let points = samples.approach_m.iter().zip(&samples.load_n);
        let omega = record.angular_frequency_rad_per_s;
        Series::line(points.map(|(d, w)| (to_approach * d, to_load * w)))
            .label(format!("ω = {} rad/s", scientific(omega, 3)))
            .color(Color::Ramp {
                step,
                of: chosen.len(),
            })
    });
    let chart = Chart::new(
        Axis::linear(format!("approach δ / {approach_unit}m")),
        Axis::linear(format!("load W / {load_unit}N")),
    )
    .all_series(series);
    Ok(Figure {
        name: "loops",
        chart,
        data: data(&chosen)?,
    })
}

/// Indices of at most [`LOOPS`] loops, evenly spread with both ends, the largest loss in place of its nearest neighbour.
fn choose(losses: &[f64]) -> Vec<usize> {
    let count = losses.len();
    if count <= LOOPS {
        return (0..count).collect();
    }
    let mut chosen: Vec<usize> = (0..LOOPS).map(|k| k * (count - 1) / (LOOPS - 1)).collect();
    let largest = (0..count).max_by(|&a, &b| losses[a].total_cmp(&losses[b]));
    if let Some(largest) = largest
        && !chosen.contains(&largest)
        // The ends stay: they show the range.
        && let Some(nearest) = (1..LOOPS - 1).min_by_key(|&k| chosen[k].abs_diff(largest))
    {
        chosen[nearest] = largest;
    }
    chosen
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chosen_loops_span_the_sweep_and_hold_the_largest_loss() {
        let losses: Vec<f64> = (0..41).map(|i| -f64::from(i - 19).powi(2)).collect();
        assert_eq!(choose(&losses), [0, 10, 19, 30, 40]);
        assert_eq!(choose(&losses[..3]), [0, 1, 2]);
        assert_eq!(choose(&[]), Vec::<usize>::new());
    }
}
