//! Where the energy goes in: the work that the indenter does on the surface per cycle and area, along a radius or, over cells,
//! along x through the centre of the work.

use super::curve::{Curve, chosen};
use super::units::Units;
use super::{Drawn, Figure};
use crate::quantity::Dimension;
use crate::report::ReportError;
use crate::report::caption::{Caption, listed};
use crate::report::chart::{Axis, Chart, Color, Series};
use crate::report::page::number::plain;
use crate::report::table::{Table, number, optional};
use crate::sweep::record::{CaseRecord, CaseResult, SurfaceLoss};

/// Profiles in one figure; more cannot be told apart.
const PROFILES: usize = 5;

/// Place (m) and density (J/m2); `None` where it is unbounded.
type ProfilePoint = (f64, Option<f64>);

/// The figure, of one curve: profiles nearest to the frequencies asked for (rad/s), or evenly spread over its cases, that of the
/// largest loss among them.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(
    curve: &Curve<'_>,
    asked_rad_per_s: &[f64],
    units: &Units,
) -> Result<Drawn, ReportError> {
    let results = curve.results();
    let profiles: Vec<(&CaseRecord, Vec<ProfilePoint>)> =
        chosen(&results, asked_rad_per_s, PROFILES)
            .into_iter()
            .map(|(record, result)| (record, profile(&result.surface_loss)))
            .filter(|(_, profile)| profile.iter().any(|(_, density)| density.is_some()))
            .collect();
    let Some(along) = results.first().map(|(_, result)| along(result)) else {
        return Ok(Drawn::left_out(
            "no dissipation profile: no case has a result",
        ));
    };
    let points = || profiles.iter().flat_map(|(_, profile)| profile);
    if points().next().is_none() {
        return Ok(Drawn::left_out(
            "no dissipation profile: nothing is dissipated",
        ));
    }
    let (to_length, length) = units.length(points().fold(0.0, |a, (x, _)| a.max(x.abs())));
    let densities = points().filter_map(|(_, density)| *density);
    let (to_density, unit) = units.density(densities.fold(0.0, |a, d| a.max(d.abs())));
    let series = profiles
        .iter()
        .enumerate()
        .map(|(step, (record, profile))| {
            let scaled =
                |(x, density): &ProfilePoint| Some((to_length * x, to_density * (*density)?));
            let of = profiles.len();
            Series::line(profile.iter().map(scaled))
                .label(units.omega(record.angular_frequency_rad_per_s))
                .color(Color::Ramp { step, of })
        });
    let mut chart = Chart::new(
        Axis::linear(format!("{} / {length}", along.label)),
        Axis::linear(format!("work per cycle and area w / {unit}")),
    )
    .all_series(series);
    chart.title.clone_from(&curve.label);
    Ok(Drawn::Figure(Figure {
        name: "dissipation-profile",
        picture: chart.into(),
        caption: caption(curve, &profiles, along.label),
        data: data(&profiles, along.column)?,
    }))
}

fn caption(
    curve: &Curve<'_>,
    profiles: &[(&CaseRecord, Vec<ProfilePoint>)],
    along: &str,
) -> Caption {
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
    let largest = profiles.iter().flat_map(|(_, profile)| profile);
    let largest = largest
        .filter_map(|(_, density)| *density)
        .fold(0.0, f64::max);
    let (factor, unit) = Units::default().density(largest);
    Caption::new(format!(
        "Work that the indenter does on the surface per cycle and area, over the {along}"
    ))
    .say_all(curve.sentence())
    .say(format!("Curves: ω = {}.", listed(&omegas)))
    .say(format!(
        "Largest: {} {unit}. The integral over the surface is the energy loss per cycle.",
        super::scientific(factor * largest, 4)
    ))
}

/// What a profile runs along.
struct Along {
    label: &'static str,
    column: &'static str,
}

fn along(result: &CaseResult) -> Along {
    match result.surface_loss {
        SurfaceLoss::Radial { .. } => Along {
            label: "radius r",
            column: "radius_m",
        },
        SurfaceLoss::Cells { .. } => Along {
            label: "x",
            column: "x_m",
        },
    }
}

fn profile(surface: &SurfaceLoss) -> Vec<ProfilePoint> {
    match surface {
        SurfaceLoss::Radial {
            radius_m,
            density_j_per_m2,
        } => {
            let points = radius_m.iter().zip(density_j_per_m2);
            points.map(|(r, density)| (*r, *density)).collect()
        }
        SurfaceLoss::Cells {
            first_x_m,
            spacing_x_m,
            cells_x,
            density_j_per_m2,
            ..
        } => {
            let rows = density_j_per_m2.chunks_exact((*cells_x).max(1));
            let centre = centre_of_work(rows.clone());
            let cells = rows
                .clone()
                .nth(centre)
                .unwrap_or_default()
                .iter()
                .enumerate();
            cells
                .map(|(k, density)| {
                    let x_m = first_x_m + k as f64 * spacing_x_m;
                    (x_m, Some(f64::from(*density)))
                })
                .collect()
        }
    }
}

/// The row that the work lies about.
fn centre_of_work<'a>(rows: impl ExactSizeIterator<Item = &'a [f32]> + Clone) -> usize {
    let middle = rows.len() / 2;
    let work = rows.map(|row| row.iter().copied().map(f64::from).sum::<f64>());
    let (sum, moment) = work
        .enumerate()
        .fold((0.0, 0.0), |(sum, moment), (row, work)| {
            (sum + work, moment + row as f64 * work)
        });
    // Work that gives energy back in places may have no centre.
    if sum > 0.0 && (0.0..=2.0 * middle as f64).contains(&(moment / sum)) {
        (moment / sum).round() as usize
    } else {
        middle
    }
}

fn data(
    profiles: &[(&CaseRecord, Vec<ProfilePoint>)],
    place: &str,
) -> Result<Vec<u8>, ReportError> {
    let columns = ["angular_frequency_rad_per_s", place, "work_j_per_m2"];
    let mut table = Table::new("dissipation-profile.csv", &columns)?;
    for (record, profile) in profiles {
        for (x_m, density) in profile {
            table.row(&[
                number(record.angular_frequency_rad_per_s),
                number(*x_m),
                optional(*density),
            ])?;
        }
    }
    table.finish()
}
