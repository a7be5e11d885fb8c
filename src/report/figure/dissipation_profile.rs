//! Where the energy goes in: the work that the indenter does on the surface per cycle and area, along a radius or, under an
//! indenter that is not of revolution, along x through the centre of the work.

use super::curve::{Curve, chosen};
use super::loops::LOOPS;
use super::units::Units;
use super::{Drawn, Figure};
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, Series};
use crate::report::number::{largest, scientific};
use crate::report::table::{cells, csv_leading};
use crate::report::words::listed;
use crate::report::work_line::{WorkAlong, WorkLine};
use crate::sweep::record::CaseRecord;

/// A case with its line.
type Profile<'a> = (&'a CaseRecord, WorkLine);

/// The figure, of one curve: profiles nearest to the frequencies asked for (rad/s), or evenly spread over its cases, that of the
/// largest loss among them.
pub fn figure(curve: &Curve<'_>, asked_rad_per_s: &[f64], units: &Units) -> Drawn {
    let results = curve.results();
    let profiles: Vec<Profile<'_>> = chosen(&results, asked_rad_per_s, LOOPS)
        .into_iter()
        .map(|(record, result)| {
            let indenter = curve.condition.contact.indenter.as_ref();
            (record, WorkLine::of(&result.cycle.surface_loss, indenter))
        })
        .filter(|(_, line)| line.points.iter().any(|(_, density)| density.is_some()))
        .collect();
    if results.is_empty() {
        return Err("no dissipation profile: no case has a result");
    }
    let Some(along) = profiles.first().map(|(_, line)| line.along) else {
        return Err("no dissipation profile: nothing is dissipated");
    };
    let points = || profiles.iter().flat_map(|(_, line)| &line.points);
    let (to_length, length) = units.length(largest(points().map(|(x, _)| x.abs())));
    let densities = points().filter_map(|(_, density)| *density);
    let (to_density, unit) = units.density(largest(densities.map(f64::abs)));
    let series = profiles.iter().enumerate().map(|(step, (record, line))| {
        let scaled =
            |(x, density): &(f64, Option<f64>)| Some((to_length * x, to_density * (*density)?));
        let of = profiles.len();
        Series::line(line.points.iter().map(scaled))
            .label(units.frequency_label(record.angular_frequency_rad_per_s))
            .color(Color::Ramp { step, of })
    });
    let chart = Chart::new(
        Axis::linear(format!("{} / {length}", along.label())),
        Axis::linear(format!("work per cycle and area w / {unit}")),
    )
    .maybe_title(curve.label.clone())
    .all_series(series);
    Ok(Figure {
        name: "dissipation-profile",
        picture: chart.into(),
        caption: caption(curve, &profiles, along, units),
        data: data(&profiles, along.column(), units),
    })
}

fn caption(
    curve: &Curve<'_>,
    profiles: &[Profile<'_>],
    along: WorkAlong,
    units: &Units,
) -> Caption {
    let frequencies: Vec<String> = profiles
        .iter()
        .map(|(record, _)| units.value_of(record.angular_frequency_rad_per_s))
        .collect();
    let densities = profiles.iter().flat_map(|(_, line)| &line.points);
    let largest = largest(densities.filter_map(|(_, density)| *density));
    let (factor, unit) = Units::default().density(largest);
    Caption::new(format!(
        "Work that the indenter does on the surface per cycle and area, {}",
        along.words()
    ))
    .say_all(curve.sentence.clone())
    .say(format!(
        "Curves: {} = {}.",
        units.frequency_unit().symbol(),
        listed(&frequencies)
    ))
    .say(format!(
        "Largest: {} {unit}. The integral over the surface is the energy loss per cycle.",
        scientific(factor * largest, 4)
    ))
}

fn data(profiles: &[Profile<'_>], place: &str, units: &Units) -> Vec<u8> {
    let columns = ["angular_frequency_rad_per_s", place, "work_j_per_m2"];
    let rows = profiles.iter().flat_map(|(record, line)| {
        let omega = record.angular_frequency_rad_per_s;
        let points = line.points.iter();
        points.map(move |(x_m, density)| cells![omega, *x_m, *density])
    });
    csv_leading(units.frequency_unit(), &columns, rows)
}
