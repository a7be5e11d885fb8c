//! Where the energy goes in: the work that the indenter does on the surface per cycle and area, along a radius or, under an
//! indenter that is not of revolution, along x through the centre of the work.

use super::curve::{Curve, chosen};
use super::units::Units;
use super::{Drawn, Figure};
use crate::indenter::Indenter;
use crate::quantity::Dimension;
use crate::report::ReportError;
use crate::report::caption::{Caption, listed};
use crate::report::chart::{Axis, Chart, Color, Series};
use crate::report::number::plain;
use crate::report::table::{Table, number, optional};
use crate::report::work_line::{WorkAlong, WorkLine};
use crate::sweep::record::CaseRecord;

/// Profiles in one figure; more cannot be told apart.
const PROFILES: usize = 5;

/// A case with its line.
type Profile<'a> = (&'a CaseRecord, WorkLine);

/// The figure, of one curve: profiles nearest to the frequencies asked for (rad/s), or evenly spread over its cases, that of the
/// largest loss among them.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(
    curve: &Curve<'_>,
    indenter: &dyn Indenter,
    asked_rad_per_s: &[f64],
    units: &Units,
) -> Result<Drawn, ReportError> {
    let results = curve.results();
    let profiles: Vec<Profile<'_>> = chosen(&results, asked_rad_per_s, PROFILES)
        .into_iter()
        .map(|(record, result)| (record, WorkLine::of(&result.surface_loss, indenter)))
        .filter(|(_, line)| line.points.iter().any(|(_, density)| density.is_some()))
        .collect();
    if results.is_empty() {
        return Ok(Drawn::left_out(
            "no dissipation profile: no case has a result",
        ));
    }
    let Some(along) = profiles.first().map(|(_, line)| line.along) else {
        return Ok(Drawn::left_out(
            "no dissipation profile: nothing is dissipated",
        ));
    };
    let points = || profiles.iter().flat_map(|(_, line)| &line.points);
    let (to_length, length) = units.length(points().fold(0.0, |a, (x, _)| a.max(x.abs())));
    let densities = points().filter_map(|(_, density)| *density);
    let (to_density, unit) = units.density(densities.fold(0.0, |a, d| a.max(d.abs())));
    let series = profiles.iter().enumerate().map(|(step, (record, line))| {
        let scaled =
            |(x, density): &(f64, Option<f64>)| Some((to_length * x, to_density * (*density)?));
        let of = profiles.len();
        Series::line(line.points.iter().map(scaled))
            .label(units.omega(record.angular_frequency_rad_per_s))
            .color(Color::Ramp { step, of })
    });
    let mut chart = Chart::new(
        Axis::linear(format!("{} / {length}", along.label())),
        Axis::linear(format!("work per cycle and area w / {unit}")),
    )
    .all_series(series);
    chart.title.clone_from(&curve.label);
    Ok(Drawn::Figure(Figure {
        name: "dissipation-profile",
        picture: chart.into(),
        caption: caption(curve, &profiles, along),
        data: data(&profiles, along.column())?,
    }))
}

fn caption(curve: &Curve<'_>, profiles: &[Profile<'_>], along: WorkAlong) -> Caption {
    let omegas: Vec<String> = profiles
        .iter()
        .map(|(record, _)| {
            plain(
                record.angular_frequency_rad_per_s,
                Dimension::AngularFrequency,
                4,
            )
        })
        .collect();
    let largest = profiles.iter().flat_map(|(_, line)| &line.points);
    let largest = largest
        .filter_map(|(_, density)| *density)
        .fold(0.0, f64::max);
    let (factor, unit) = Units::default().density(largest);
    Caption::new(format!(
        "Work that the indenter does on the surface per cycle and area, {}",
        along.words()
    ))
    .say_all(curve.sentence())
    .say(format!("Curves: ω = {}.", listed(&omegas)))
    .say(format!(
        "Largest: {} {unit}. The integral over the surface is the energy loss per cycle.",
        super::scientific(factor * largest, 4)
    ))
}

fn data(profiles: &[Profile<'_>], place: &str) -> Result<Vec<u8>, ReportError> {
    let columns = ["angular_frequency_rad_per_s", place, "work_j_per_m2"];
    let mut table = Table::new("dissipation-profile.csv", &columns)?;
    for (record, line) in profiles {
        for (x_m, density) in &line.points {
            table.row(&[
                number(record.angular_frequency_rad_per_s),
                number(*x_m),
                optional(*density),
            ])?;
        }
    }
    table.finish()
}
