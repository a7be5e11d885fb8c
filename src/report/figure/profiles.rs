//! Pressure and surface displacement along a radius, or along x through the centre, at the times asked for.

use super::Figure;
use super::at_times::{self, CURVES};
use super::plot::Plot;
use super::quantity::{DISPLACEMENT, PRESSURE, Quantity, TIME};
use super::trace::{Point, Trace};
use super::units::{Measure, Units};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::Color;
use crate::report::number::{largest, plain, range};
use crate::report::profile_lines::{Profile, ProfilePoint};
use crate::report::words::listed;

/// A profile to be drawn: its time (s) and its points.
type Curve = (f64, Vec<ProfilePoint>);

/// The figure, where any profile was asked for, and what is not drawn of them.
pub fn figure(records: &[Profile], units: &Units) -> (Option<Figure>, Option<String>) {
    let Some((line, _)) = records.first().and_then(|r| r.lines.first()) else {
        return (None, None);
    };
    let curves = curves(records);
    let [along, label] = match line == "r" {
        true => ["the radius r", "radius r"],
        false => ["x through the centre", line],
    };
    let position = Quantity::new("position_m", "", Measure::Length).called(label.to_owned());
    let positions = curves.iter().flat_map(|(_, points)| points);
    let (low, high) = range(positions.map(|point| point.position_m));
    let times_s: Vec<f64> = curves.iter().map(|(time_s, _)| *time_s).collect();
    let labels = at_times::labels(&times_s, units);
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

/// Profiles of which curves are drawn, with their times.
fn curves(records: &[Profile]) -> Vec<Curve> {
    let chosen = at_times::chosen(records, |record| record.row.time_s).into_iter();
    let curve = |record: &Profile| {
        let (_, points) = record.lines.first()?;
        Some((record.row.time_s, points.clone()))
    };
    chosen.filter_map(curve).collect()
}
