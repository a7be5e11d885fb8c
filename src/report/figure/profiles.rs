//! Pressure and surface displacement along a radius, or along x through the centre, at the times asked for.

use std::collections::BTreeSet;

use super::Figure;
use super::curve::evenly;
use super::plot::Plot;
use super::quantity::{DISPLACEMENT, PRESSURE, Quantity, TIME};
use super::trace::{Point, Trace};
use super::units::{Measure, Units};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::Color;
use crate::report::number::{largest, plain, range, scientific};
use crate::report::profile_lines::{Profile, ProfilePoint};
use crate::report::words::listed;

/// Curves in one figure; more cannot be told apart.
const CURVES: usize = 6;

/// A profile to be drawn: its time (s) and its points.
type Curve = (f64, Vec<ProfilePoint>);

/// The figure, where any profile was asked for, and what is not drawn of them.
pub fn figure(records: &[Profile], units: &Units) -> (Option<Figure>, Option<String>) {
    let Some((line, _)) = records.first().and_then(|r| r.lines.first()) else {
        return (None, None);
    };
    let curves = chosen(records);
    let [along, label] = match line == "r" {
        true => ["the radius r", "radius r"],
        false => ["x through the centre", line],
    };
    let position = Quantity::new("position_m", "", Measure::Length).called(label.to_owned());
    let positions = curves.iter().flat_map(|(_, points)| points);
    let (low, high) = range(positions.map(|point| point.position_m));
    let labels = labels(&curves, units);
    let frame = |y: Quantity, value: &dyn Fn(&ProfilePoint) -> Option<f64>| {
        let traces = curves.iter().zip(&labels).enumerate();
        let traces = traces.map(|(step, ((time_s, points), label))| {
            Trace::line(points.iter().map(|p| Point::new(p.position_m, value(p))))
                .label(label)
                .member(*time_s)
                .color(Color::of_family(step, curves.len()))
        });
        Plot::new(position.clone(), y)
            .family(TIME)
            .traces(traces)
            .x_ends(low, high)
    };
    let frames = [
        frame(PRESSURE, &|point| point.pressure_pa),
        frame(DISPLACEMENT, &|point| Some(point.displacement_m)),
    ];
    let pressures = curves.iter().flat_map(|(_, points)| points);
    let largest = largest(pressures.filter_map(|point| point.pressure_pa));
    let caption = Caption::new(format!(
        "Contact pressure p (above) and surface displacement u (below) over {along}"
    ))
    .say(format!("Curves: {}.", listed(&labels)))
    .say(format!(
        "Largest pressure drawn: {}.",
        plain(largest, Dimension::Stress, 4)
    ));
    let left_out = records.len() - curves.len();
    let told = (left_out > 0).then(|| {
        format!(
            "figure of the profiles: {CURVES} of {} drawn, the tables have all",
            records.len()
        )
    });
    (Some(Figure::of("profiles", &frames, caption, units)), told)
}

/// At most [`CURVES`] profiles in the order of their times, evenly spread, both ends among them.
fn chosen(records: &[Profile]) -> Vec<Curve> {
    let mut ordered: Vec<&Profile> = records.iter().collect();
    ordered.sort_by(|a, b| a.row.time_s.total_cmp(&b.row.time_s));
    let places = evenly(ordered.len(), CURVES).into_iter();
    let curve = |place: usize| {
        let record = ordered.get(place)?;
        let (_, points) = record.lines.first()?;
        Some((record.row.time_s, points.clone()))
    };
    places.filter_map(curve).collect()
}

/// What the curves are called: `t = 20 s`.
fn labels(curves: &[Curve], units: &Units) -> Vec<String> {
    // From a second on, so that times stay in seconds.
    let time = units.shown(Measure::Time, 1.0);
    let digits = telling_digits(curves);
    let label =
        |(time_s, _): &Curve| format!("t = {} {}", scientific(time.of(*time_s), digits), time.unit);
    curves.iter().map(label).collect()
}

/// As many digits as it takes to tell the times apart, from four on; times at one instant cannot be.
fn telling_digits(curves: &[Curve]) -> usize {
    let told_apart = |digits: &usize| {
        let labels = curves
            .iter()
            .map(|(time_s, _)| scientific(*time_s, *digits));
        labels.collect::<BTreeSet<_>>().len() == curves.len()
    };
    (4..=9).find(told_apart).unwrap_or(4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_close_to_one_another_are_told_apart() {
        let curves =
            |times: &[f64]| -> Vec<Curve> { times.iter().map(|t| (*t, Vec::new())).collect() };
        assert_eq!(telling_digits(&curves(&[0.0, 20.0, 60.0])), 4);
        assert_eq!(telling_digits(&curves(&[19.999, 20.0])), 5);
        assert_eq!(telling_digits(&curves(&[20.0, 20.0])), 4);
    }
}
