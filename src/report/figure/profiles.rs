//! Pressure and surface displacement along a radius, or along x through the centre, at the times asked for.

use std::collections::BTreeSet;

use super::units::Units;
use super::{Figure, Picture};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, Series};
use crate::report::number::{largest, plain, range, scientific};
use crate::report::profile_lines::{Profile, ProfilePoint};
use crate::report::table::{cells, csv};
use crate::report::words::listed;

const NAME: &str = "profiles";
/// Curves in one figure; more cannot be told apart.
const CURVES: usize = 6;
const WIDTH_PX: u32 = 800;
const UPPER_PX: u32 = 380;
const LOWER_PX: u32 = 380;

/// A profile to be drawn: its time (s) and its points.
type Curve = (f64, Vec<ProfilePoint>);

/// The figure, where any profile was asked for, and what is not drawn of them.
pub fn figure(records: &[Profile], units: &Units) -> (Option<Figure>, Option<String>) {
    let Some((line, _)) = records.first().and_then(|r| r.lines.first()) else {
        return (None, None);
    };
    let curves = chosen(records);
    let figure = Figure {
        name: NAME,
        picture: Picture(panels(line, &curves, units).into()),
        caption: caption(line, &curves),
        data: data(&curves),
    };
    let left_out = records.len() - curves.len();
    let told = (left_out > 0).then(|| {
        format!(
            "figure of the profiles: {CURVES} of {} drawn, all are in profiles/",
            records.len()
        )
    });
    (Some(figure), told)
}

fn caption(line: &str, curves: &[Curve]) -> Caption {
    let digits = telling_digits(curves);
    let times = curves
        .iter()
        .map(|(time_s, _)| format!("{} s", scientific(*time_s, digits)));
    let pressures = curves.iter().flat_map(|(_, points)| points);
    let pressures = pressures.filter_map(|point| point.pressure_pa);
    let largest = plain(largest(pressures), Dimension::Stress, 4);
    let along = if line == "r" {
        "the radius r"
    } else {
        "x through the centre"
    };
    Caption::new(format!(
        "Contact pressure p (above) and surface displacement u (below) over {along}"
    ))
    .say(format!(
        "Curves: t = {}.",
        listed(&times.collect::<Vec<_>>())
    ))
    .say(format!("Largest pressure drawn: {largest}."))
}

/// At most [`CURVES`] profiles in the order of their times, evenly spread, both ends among them.
fn chosen(records: &[Profile]) -> Vec<Curve> {
    let mut ordered: Vec<&Profile> = records.iter().collect();
    ordered.sort_by(|a, b| a.row.time_s.total_cmp(&b.row.time_s));
    let count = ordered.len();
    let shown = count.min(CURVES);
    (0..shown)
        .filter_map(|k| {
            let place = (k * (count - 1)).checked_div(shown - 1).unwrap_or(0);
            let record = ordered.get(place)?;
            let (_, points) = record.lines.first()?;
            Some((record.row.time_s, points.clone()))
        })
        .collect()
}

fn panels(line: &str, curves: &[Curve], units: &Units) -> [Chart; 2] {
    let all = || curves.iter().flat_map(|(_, points)| points);
    let (to_length, length) = units.length(largest(all().map(|p| p.position_m)));
    let pressures = all().filter_map(|p| p.pressure_pa);
    let (to_pressure, pressure) = units.pressure(largest(pressures));
    let displacements = all().map(|p| p.displacement_m);
    let (to_displacement, displacement) = units.approach(largest(displacements));
    let digits = telling_digits(curves);
    // From a second on, so that times stay in seconds.
    let (to_time, time_unit) = units.time(1.0);
    let family = |value: &dyn Fn(&ProfilePoint) -> Option<f64>| {
        let of = curves.len();
        let curve = |(step, (_, points)): (usize, &Curve)| {
            let points = points.iter();
            let points = points.map(|p| Some((to_length * p.position_m, value(p)?)));
            Series::line(points).color(Color::Ramp { step, of })
        };
        curves.iter().enumerate().map(curve).collect::<Vec<_>>()
    };
    let pressures = family(&|p| Some(to_pressure * p.pressure_pa?));
    let labelled = pressures
        .into_iter()
        .zip(curves)
        .map(|(series, (time_s, _))| {
            let time = scientific(to_time * time_s, digits);
            series.label(format!("t = {time} {time_unit}"))
        });
    let position = if line == "r" { "radius r" } else { line };
    let ends = range(all().map(|p| to_length * p.position_m));
    let axis = |label: String| Axis {
        range: Some(ends).filter(|(low, high)| low < high),
        ..Axis::linear(label)
    };
    let upper = Chart::new(
        axis(String::new()),
        Axis::linear(format!("pressure p / {pressure}")),
    )
    .all_series(labelled)
    .size(WIDTH_PX, UPPER_PX);
    let lower = Chart::new(
        axis(format!("{position} / {length}")),
        Axis::linear(format!("displacement u / {displacement}")),
    )
    .all_series(family(&|p| Some(to_displacement * p.displacement_m)))
    .size(WIDTH_PX, LOWER_PX);
    [upper, lower]
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

fn data(curves: &[Curve]) -> Vec<u8> {
    let columns = ["time_s", "position_m", "pressure_pa", "displacement_m"];
    let rows = curves.iter().flat_map(|(time_s, points)| {
        points.iter().map(move |point| {
            cells![
                *time_s,
                point.position_m,
                point.pressure_pa,
                point.displacement_m,
            ]
        })
    });
    csv(&columns, rows)
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
