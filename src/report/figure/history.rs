//! Load, approach and contact radius against time, one above another.

use super::units::{Unit, Units};
use super::{Drawn, Figure, Picture};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Series};
use crate::report::number::{largest, plain};
use crate::simulation::{HistoryRow, SimulationOutcome};

/// Points of a curve beyond which only the extremes of each stretch are drawn.
const MOST_POINTS: usize = 4000;
const WIDTH_PX: u32 = 800;
/// Of a panel without and with the label of the time axis.
const PANEL_PX: u32 = 250;
const LAST_PANEL_PX: u32 = 285;

/// The figure; its data are history.csv.
pub fn figure(outcome: &SimulationOutcome, units: &Units) -> Drawn {
    let rows = &outcome.rows;
    let end_s = rows.last().map_or(0.0, |row| row.time_s);
    if rows.first().is_none_or(|row| row.time_s >= end_s) {
        return Err("no figure of the history: it has no two times");
    }
    let load = largest(rows.iter().map(|row| row.load_n));
    let radius = largest(rows.iter().map(|row| row.contact_radius_m));
    let caption =
        Caption::new("Load W, approach δ and contact radius a against time t").say(format!(
            "The history ends at {}; its largest load is {}, its largest contact radius {}.",
            plain(end_s, Dimension::Time, 4),
            plain(load, Dimension::Force, 4),
            plain(radius, Dimension::Length, 4)
        ));
    Ok(Figure {
        name: "history",
        picture: Picture(panels(rows, units)),
        caption,
        data: Vec::new(),
    })
}

type Signal = fn(&HistoryRow) -> Option<f64>;
type UnitOf = fn(&Units, f64) -> Unit;

fn panels(rows: &[HistoryRow], units: &Units) -> Vec<Chart> {
    let end_s = rows.last().map_or(0.0, |row| row.time_s);
    let (to_time, time_unit) = units.time(end_s);
    let signals: [(&str, UnitOf, Signal); 3] = [
        ("load W", Units::load, |row| Some(row.load_n)),
        ("approach δ", Units::approach, |row| row.approach_m),
        ("contact radius a", Units::length, |row| {
            Some(row.contact_radius_m)
        }),
    ];
    // A signal that is nowhere defined has no panel.
    let shown: Vec<_> = signals
        .into_iter()
        .filter(|(_, _, signal)| rows.iter().any(|row| signal(row).is_some()))
        .collect();
    let last = shown.len().saturating_sub(1);
    let panel = |(place, (name, unit, signal)): (usize, (&str, UnitOf, Signal))| {
        let values = rows.iter().filter_map(signal).map(f64::abs);
        let (factor, unit) = unit(units, largest(values));
        let points: Vec<_> = rows
            .iter()
            .map(|row| Some((to_time * row.time_s, factor * signal(row)?)))
            .collect();
        let (label, height_px) = if place == last {
            (format!("time t / {time_unit}"), LAST_PANEL_PX)
        } else {
            (String::new(), PANEL_PX)
        };
        Chart::new(
            Axis::linear(label).range(0.0, to_time * end_s),
            Axis::linear(format!("{name} / {unit}")),
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
        let labels: Vec<String> = panels(&[row(0.0), row(1.0)], &Units::default())
            .into_iter()
            .map(|chart| chart.y.label)
            .collect();
        assert_eq!(labels.len(), 2);
        assert!(labels[0].starts_with("load") && labels[1].starts_with("contact radius"));
    }
}
