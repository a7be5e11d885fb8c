//! A history: load, approach and contact radius against time, one above another; and load against approach, whose area is the work
//! of the indenter.

use super::plot::Plot;
use super::quantity::{APPROACH, CONTACT_RADIUS, LOAD, Quantity, TIME};
use super::trace::{Point, Trace};
use super::units::Units;
use super::{Drawn, Figure};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::number::{largest, plain};
use crate::report::words;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::work::HistoryWork;
use crate::simulation::{HistoryRow, SimulationOutcome};

/// Points of a curve beyond which only the extremes of each stretch are drawn.
const MOST_POINTS: usize = 4000;

/// Signals against time; their data are history.csv.
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
    Ok(Figure::of("history", &frames(rows, end_s), caption, units).without_data())
}

type Signal = fn(&HistoryRow) -> Option<f64>;

fn frames(rows: &[HistoryRow], end_s: f64) -> Vec<Plot> {
    let signals: [(Quantity, Signal); 3] = [
        (LOAD, |row| Some(row.load_n)),
        (APPROACH, |row| row.approach_m),
        (CONTACT_RADIUS, |row| Some(row.contact_radius_m)),
    ];
    // A signal that is nowhere defined has no frame.
    let is_defined =
        |(_, signal): &(Quantity, Signal)| rows.iter().any(|row| signal(row).is_some());
    let shown = signals.into_iter().filter(is_defined).enumerate();
    let frame = |(place, (quantity, signal)): (usize, (Quantity, Signal))| {
        let points = rows.iter().map(|row| Point::new(row.time_s, signal(row)));
        Plot::new(TIME, quantity)
            .traces([Trace::line(thinned(points.collect())).color(place)])
            .x_ends(0.0, end_s)
    };
    shown.map(frame).collect()
}

/// Load against approach, which tells the work; its data are history.csv too.
pub fn load_approach(plan: &ScenarioPlan, outcome: &SimulationOutcome, units: &Units) -> Drawn {
    let points = outcome.rows.iter().map(|row| match row.approach_m {
        Some(approach_m) => Point::new(approach_m, row.load_n),
        None => Point::new(0.0, None),
    });
    let points: Vec<Point> = points.collect();
    let mut places = points.iter().filter(|point| point.y.is_some());
    let first = places.next().map(|point| point.x);
    if places.all(|point| Some(point.x) == first) {
        return Err("no figure of load against approach: the approach does not change");
    }
    let plot = Plot::new(APPROACH, LOAD).traces([Trace::line(thinned(points))]);
    let work = HistoryWork::of(plan, outcome);
    let caption = Caption::new("Load W over approach δ").say_all(work.map(|work| {
        format!(
            "The work of the indenter, the integral of W over δ along the path, is {}.",
            words::work(&work)
        )
    }));
    Ok(Figure::of("load-approach", &[plot], caption, units).without_data())
}

/// A path of very many points by the first, least, largest and last of each stretch of it, which looks the same.
fn thinned(points: Vec<Point>) -> Vec<Point> {
    if points.len() <= MOST_POINTS {
        return points;
    }
    let stretch = points.len().div_ceil(MOST_POINTS / 4);
    let mut kept = Vec::with_capacity(MOST_POINTS + 4);
    for part in points.chunks(stretch) {
        if part.iter().any(|point| point.y.is_none()) {
            kept.extend_from_slice(part);
            continue;
        }
        let height = |i: &usize| part[*i].y.unwrap_or(0.0);
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
        let point = |i: usize| Point::new(i as f64, (i != 50_000).then(|| value(i)));
        let points: Vec<Point> = (0..100_000).map(point).collect();
        let kept = thinned(points.clone());
        assert!(kept.len() < 5000);
        assert!(kept.contains(&point(50_000)));
        assert!(kept.contains(&point(77_777)));
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[99_999]));
        assert!(kept.is_sorted_by(|a, b| a.x <= b.x));
    }

    #[test]
    fn an_approach_that_is_nowhere_defined_has_no_panel() {
        let row = |time_s| HistoryRow {
            time_s,
            load_n: 0.0,
            approach_m: None,
            contact_radius_m: 0.0,
            peak_pressure_pa: Some(0.0),
            work_j: Some(0.0),
        };
        let frames = frames(&[row(0.0), row(1.0)], 1.0);
        let quantities: Vec<&Quantity> = frames.iter().map(|frame| &frame.y).collect();
        assert_eq!(quantities, [&LOAD, &CONTACT_RADIUS]);
    }
}
