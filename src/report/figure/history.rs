//! Load, approach and contact radius against time, one above another.

use super::{WriteFile, prefix, write_picture};
use crate::report::ReportError;
use crate::report::chart::{self, Axis, Chart, Series};
use crate::sweep::simulate::{HistoryRow, SimulationOutcome};

const NAME: &str = "history";
/// Points of a curve beyond which only the extremes of each stretch are drawn.
const MOST_POINTS: usize = 4000;
const WIDTH_PX: u32 = 800;
/// Of a panel without and with the label of the time axis.
const PANEL_PX: u32 = 250;
const LAST_PANEL_PX: u32 = 285;

/// Writes the figure; its data are history.csv. Returns why where it cannot be drawn.
///
/// # Errors
/// [`ReportError`] naming the figure.
pub fn write(
    outcome: &SimulationOutcome,
    write: &WriteFile<'_>,
) -> Result<Option<String>, ReportError> {
    let Some(svg) = svg(outcome)? else {
        return Ok(Some(
            "no figure of the history: it has no two times".to_owned(),
        ));
    };
    write_picture(NAME, NAME, &svg, write)?;
    Ok(None)
}

/// The picture, where the history has two times.
///
/// # Errors
/// [`ReportError`] naming the figure.
pub fn svg(outcome: &SimulationOutcome) -> Result<Option<String>, ReportError> {
    let rows = &outcome.rows;
    let has_span = matches!((rows.first(), rows.last()), (Some(a), Some(b)) if b.time_s > a.time_s);
    if !has_span {
        return Ok(None);
    }
    let svg = chart::stack_to_svg(&panels(rows))
        .map_err(|source| ReportError::Chart { name: NAME, source })?;
    Ok(Some(svg))
}

type Signal = fn(&HistoryRow) -> Option<f64>;

fn panels(rows: &[HistoryRow]) -> Vec<Chart> {
    let end_s = rows.last().map_or(0.0, |row| row.time_s);
    // Long times stay in seconds.
    let (to_time, time_unit) = match prefix(end_s) {
        (factor, unit) if end_s < 1.0 => (factor, unit),
        _ => (1.0, ""),
    };
    let signals: [(&str, &str, Signal); 3] = [
        ("load W", "N", |row| Some(row.load_n)),
        ("approach δ", "m", |row| row.approach_m),
        ("contact radius a", "m", |row| Some(row.contact_radius_m)),
    ];
    // A signal that is nowhere defined has no panel.
    let shown: Vec<_> = signals
        .into_iter()
        .filter(|(_, _, signal)| rows.iter().any(|row| signal(row).is_some()))
        .collect();
    let last = shown.len().saturating_sub(1);
    let panel = |(place, (name, unit, signal)): (usize, (&str, &str, Signal))| {
        let largest = rows.iter().filter_map(signal).map(f64::abs);
        let (factor, scale) = prefix(largest.fold(0.0, f64::max));
        let points: Vec<_> = rows
            .iter()
            .map(|row| Some((to_time * row.time_s, factor * signal(row)?)))
            .collect();
        let (label, height_px) = if place == last {
            (format!("time t / {time_unit}s"), LAST_PANEL_PX)
        } else {
            (String::new(), PANEL_PX)
        };
        Chart::new(
            Axis::linear(label).range(0.0, to_time * end_s),
            Axis::linear(format!("{name} / {scale}{unit}")),
        )
        .series(Series::line(thinned(points)).color(place))
        .size(WIDTH_PX, height_px)
    };
    shown.into_iter().enumerate().map(panel).collect()
}

type Points = Vec<Option<(f64, f64)>>;

/// A curve of very many points by the first, least, largest and last of each stretch of it, which looks the same.
fn thinned(points: Points) -> Points {
    if points.len() <= MOST_POINTS {
        return points;
    }
    let stretch = points.len().div_ceil(MOST_POINTS / 4);
    let mut kept = Vec::with_capacity(MOST_POINTS + 4);
    for part in points.chunks(stretch) {
        if part.contains(&None) {
            kept.extend_from_slice(part);
            continue;
        }
        let height = |i: &usize| part[*i].map_or(0.0, |p| p.1);
        let by_height = |a: &usize, b: &usize| height(a).total_cmp(&height(b));
        let lowest = (0..part.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..part.len()).max_by(by_height).unwrap_or(0);
        let mut places = [0, lowest, highest, part.len() - 1];
        places.sort_unstable();
        kept.extend(places.iter().map(|&place| part[place]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_keeps_its_extremes_and_its_gaps() {
        let value = |i: usize| (i as f64 * 0.01).sin() + if i == 77_777 { 5.0 } else { 0.0 };
        let points: Points = (0..100_000)
            .map(|i| (i != 50_000).then(|| (i as f64, value(i))))
            .collect();
        let kept = thinned(points.clone());
        assert!(kept.len() < 5000);
        assert!(kept.contains(&None));
        assert!(kept.contains(&Some((77_777.0, value(77_777)))));
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[99_999]));
        let times: Vec<f64> = kept.iter().flatten().map(|p| p.0).collect();
        assert!(times.is_sorted());
    }

    #[test]
    fn an_approach_that_is_nowhere_defined_has_no_panel() {
        let row = |time_s| HistoryRow {
            time_s,
            load_n: 0.0,
            approach_m: None,
            contact_radius_m: 0.0,
            peak_pressure_pa: Some(0.0),
        };
        let labels: Vec<String> = panels(&[row(0.0), row(1.0)])
            .into_iter()
            .map(|chart| chart.y.label)
            .collect();
        assert_eq!(labels.len(), 2);
        assert!(labels[0].starts_with("load") && labels[1].starts_with("contact radius"));
    }
}
