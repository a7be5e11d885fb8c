//! What a scenario leaves behind: the history, profiles and fields at the times asked for, figures, a summary.

use std::path::Path;

use serde::Serialize;

use super::caption::Setting;
use super::figure::Drawn;
use super::figure::press::{self, Press};
use super::figure::units::Units;
use super::page::Pictures;
use super::table::{Table, number, optional};
use super::{ReportError, figure, npy, page, vti};
use crate::contact::surface::{CellSurface, Surface};
use crate::sweep::figures::figure_plan::AxisUnits;
use crate::sweep::history::outside_model;
use crate::sweep::history::{SimulationEnd, SimulationOutcome, SurfaceRecord};
use crate::sweep::plan::body_material::BodyMaterial;
use crate::sweep::plan::scenario::{self, ScenarioPlan};
use crate::sweep::store::Store;

/// Writes everything, as far as the simulation came. Returns what was left out and why.
///
/// # Errors
/// [`ReportError`] naming the file that could not be made.
pub fn write(
    store: &Store,
    plan: &ScenarioPlan,
    outcome: &SimulationOutcome,
) -> Result<Vec<String>, ReportError> {
    store.write("history.csv", &history(outcome)?)?;
    store.write("summary.json", &summary(plan, outcome, store.sweep_hash())?)?;
    if !outcome.profiles.is_empty() {
        store.write("profiles/index.csv", &index(&outcome.profiles)?)?;
        for (k, record) in outcome.profiles.iter().enumerate() {
            store.write(format!("profiles/{k}.csv"), &profile(record)?)?;
        }
    }
    if !outcome.fields.is_empty() {
        store.write("fields/index.csv", &index(&outcome.fields)?)?;
        for (k, record) in outcome.fields.iter().enumerate() {
            write_fields(store, k, record)?;
        }
    }
    let pictures = Pictures::default();
    let left_out = figures(store, plan, outcome, &pictures)?;
    if plan.figures.axes != AxisUnits::Si
        && let Some(history) = figure::history::in_si(outcome)?
    {
        // The page shows SI units throughout, since its own script draws in them.
        pictures.insert("history", &history);
    }
    let page = page::simulation(plan, outcome, &pictures, store.sweep_hash())?;
    store.write("index.html", page.as_bytes())?;
    Ok(left_out)
}

fn figures(
    store: &Store,
    plan: &ScenarioPlan,
    outcome: &SimulationOutcome,
    pictures: &Pictures,
) -> Result<Vec<String>, ReportError> {
    let units = Units::of_scenario(plan)?;
    let setting = Setting::of_scenario(plan, outcome, units.sentence());
    let press = Press {
        plan: &plan.figures,
        write: &|name, bytes| store.write(name, bytes),
        pictures,
    };
    let (mut figures, mut left_out) = (Vec::new(), Vec::new());
    match figure::history::figure(outcome, &units) {
        Drawn::Figure(figure) => figures.push(figure),
        Drawn::LeftOut(why) => left_out.push(why),
    }
    let (profiles, not_drawn) = figure::profiles::figure(&outcome.profiles, &units)?;
    figures.extend(profiles);
    left_out.extend(not_drawn);
    press.figures(&figures, &setting)?;
    left_out.extend(figure::pressure_map::write(
        &outcome.fields,
        &press,
        (&units, &setting),
    )?);
    let maps = (0..outcome.fields.len()).map(figure::pressure_map::file);
    let files = scenario::FIGURES.into_iter().map(str::to_owned).chain(maps);
    for file in files.flat_map(|file| press::not_asked(&plan.figures, &file)) {
        store.remove(&file)?;
    }
    Ok(left_out)
}

/// `history.csv`: one row per time step, two with the same time at a jump. Errors are absolute.
fn history(outcome: &SimulationOutcome) -> Result<Vec<u8>, ReportError> {
    let mut table = Table::new(
        "history.csv",
        &[
            "time_s",
            "load_n",
            "approach_m",
            "contact_radius_m",
            "contact_area_m2",
            "peak_pressure_pa",
            "load_error_n",
            "approach_error_m",
            "contact_radius_error_m",
            "peak_pressure_error_pa",
        ],
    )?;
    for (place, row) in outcome.rows.iter().enumerate() {
        let errors = outcome.errors.get(place).copied().unwrap_or_default();
        table.row(&[
            number(row.time_s),
            number(row.load_n),
            optional(row.approach_m),
            number(row.contact_radius_m),
            number(row.contact_area_m2()),
            optional(row.peak_pressure_pa),
            optional(errors.load_n),
            optional(errors.approach_m),
            optional(errors.contact_radius_m),
            optional(errors.peak_pressure_pa),
        ])?;
    }
    table.finish()
}

/// `index.csv`: which time and state each file of a folder belongs to.
fn index(records: &[SurfaceRecord]) -> Result<Vec<u8>, ReportError> {
    let mut table = Table::new(
        "index.csv",
        &[
            "index",
            "time_s",
            "load_n",
            "approach_m",
            "contact_radius_m",
            "cells_x",
            "cells_y",
            "spacing_x_m",
            "spacing_y_m",
        ],
    )?;
    for (k, record) in records.iter().enumerate() {
        let row = &record.row;
        let grid = match &record.surface {
            Surface::Radial(_) => None,
            Surface::Cells(cells) => Some(cells.grid),
        };
        let count = |value: Option<usize>| value.map(|n| n.to_string()).unwrap_or_default();
        table.row(&[
            k.to_string(),
            number(row.time_s),
            number(row.load_n),
            optional(row.approach_m),
            number(row.contact_radius_m),
            count(grid.map(|g| g.cells_x())),
            count(grid.map(|g| g.cells_y())),
            optional(grid.map(|g| g.spacing_x_m())),
            optional(grid.map(|g| g.spacing_y_m())),
        ])?;
    }
    table.finish()
}

/// One point of a profile. The pressure is absent where it is unbounded, the gap where there is no indenter or its place is
/// unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ProfilePoint {
    pub(super) position_m: f64,
    pub(super) pressure_pa: Option<f64>,
    pub(super) displacement_m: f64,
    pub(super) gap_m: Option<f64>,
}

/// The lines along which a surface is shown: its radius, or the axes of its grid.
pub(super) fn lines(record: &SurfaceRecord) -> Vec<(&'static str, Vec<ProfilePoint>)> {
    let gap = |i: usize| {
        let gap = record.gap_m.as_ref().and_then(|gap| gap.get(i).copied());
        gap.filter(|gap| gap.is_finite())
    };
    match &record.surface {
        Surface::Radial(radial) => {
            let values = radial.pressure_pa.iter().zip(&radial.displacement_m);
            let points = radial.radius_m.iter().zip(values).enumerate();
            let point = |(i, (&position_m, (&pressure_pa, &displacement_m)))| ProfilePoint {
                position_m,
                pressure_pa,
                displacement_m,
                gap_m: gap(i),
            };
            vec![("r", points.map(point).collect())]
        }
        Surface::Cells(cells) => vec![
            ("x", centre_line(cells, &gap, cells.grid.centre_row())),
            ("y", centre_line(cells, &gap, cells.grid.centre_column())),
        ],
    }
}

/// Values along x or y through the centre, as [`Grid::centre_row`](crate::contact::half_space::grid::Grid::centre_row) finds
/// them.
fn centre_line(
    cells: &CellSurface,
    gap: &dyn Fn(usize) -> Option<f64>,
    places: Vec<(f64, [usize; 2])>,
) -> Vec<ProfilePoint> {
    let mean = |field: &[f64], [a, b]: [usize; 2]| 0.5 * (field[a] + field[b]);
    let point = |(position_m, pair): (f64, [usize; 2])| ProfilePoint {
        position_m,
        pressure_pa: Some(mean(&cells.pressure_pa, pair)),
        displacement_m: mean(&cells.displacement_m, pair),
        gap_m: gap(pair[0]).zip(gap(pair[1])).map(|(a, b)| 0.5 * (a + b)),
    };
    places.into_iter().map(point).collect()
}

/// `profiles/<k>.csv`.
fn profile(record: &SurfaceRecord) -> Result<Vec<u8>, ReportError> {
    let is_radial = matches!(record.surface, Surface::Radial(_));
    let values = ["pressure_pa", "displacement_m", "gap_m"];
    let columns: Vec<&str> = if is_radial {
        ["radius_m"].into_iter().chain(values).collect()
    } else {
        ["line", "position_m"].into_iter().chain(values).collect()
    };
    let mut table = Table::new("profile", &columns)?;
    for (line, points) in lines(record) {
        for point in points {
            let mut cells = if is_radial {
                Vec::new()
            } else {
                vec![line.to_owned()]
            };
            cells.extend([
                number(point.position_m),
                optional(point.pressure_pa),
                number(point.displacement_m),
                optional(point.gap_m),
            ]);
            table.row(&cells)?;
        }
    }
    table.finish()
}

/// `fields/<k>-<quantity>.npy` and `fields/<k>.vti`. The gap is infinite where there is no indenter, and left out where the
/// indenter's place is unknown.
fn write_fields(store: &Store, k: usize, record: &SurfaceRecord) -> Result<(), ReportError> {
    let Surface::Cells(cells) = &record.surface else {
        return Ok(());
    };
    let mut fields: Vec<(&str, &[f64])> = vec![
        ("pressure_pa", &cells.pressure_pa),
        ("displacement_m", &cells.displacement_m),
    ];
    if let Some(gap_m) = &record.gap_m {
        fields.push(("gap_m", gap_m));
    }
    let (rows, columns) = (cells.grid.cells_y(), cells.grid.cells_x());
    for (name, values) in &fields {
        let path = Path::new("fields").join(format!("{k}-{name}.npy"));
        store.write(path, &npy::matrix(rows, columns, values))?;
    }
    let image = vti::image(&cells.grid, record.row.time_s, &fields);
    store.write(format!("fields/{k}.vti"), &image)?;
    Ok(())
}

#[derive(Serialize)]
struct Summary<'a> {
    title: &'a str,
    /// done | interrupted | failed.
    status: &'a str,
    message: Option<&'a str>,
    /// What lies outside the model.
    warnings: Vec<Warned>,
    time_steps: usize,
    end_time_s: Option<f64>,
    largest_contact_radius_m: f64,
    largest_peak_pressure_pa: Option<f64>,
    engine: &'a str,
    /// series | fitted series | direct sum: how the body's past is kept.
    hereditary_integral: &'a str,
    domain_half_width_m: f64,
    domain_enlarged: usize,
    iterations: u64,
    /// Why error columns are empty although they were asked for.
    errors_missing: Option<&'a str>,
    program: &'a str,
    program_version: &'a str,
    scenario_hash: &'a str,
}

/// A warning.
#[derive(Serialize)]
struct Warned {
    code: &'static str,
    message: String,
}

/// `summary.json`.
fn summary(
    plan: &ScenarioPlan,
    outcome: &SimulationOutcome,
    scenario_hash: &str,
) -> Result<Vec<u8>, ReportError> {
    let (status, message) = match &outcome.ended {
        SimulationEnd::Done => ("done", None),
        SimulationEnd::Interrupted => ("interrupted", None),
        SimulationEnd::Failed(message) => ("failed", Some(message.as_str())),
    };
    let radii = outcome.rows.iter().map(|row| row.contact_radius_m);
    let peaks: Option<Vec<f64>> = outcome
        .rows
        .iter()
        .map(|row| row.peak_pressure_pa)
        .collect();
    let warnings = outside_model::warnings(plan, outcome).into_iter();
    let warnings = warnings.map(|warning| Warned {
        code: warning.code(),
        message: warning.to_string(),
    });
    let summary = Summary {
        title: &plan.title,
        status,
        message,
        warnings: warnings.collect(),
        time_steps: outcome.rows.len(),
        end_time_s: outcome.rows.last().map(|row| row.time_s),
        largest_contact_radius_m: radii.fold(0.0, f64::max),
        largest_peak_pressure_pa: peaks.map(|peaks| peaks.into_iter().fold(0.0, f64::max)),
        engine: plan.solver.engine.name(),
        hereditary_integral: match &plan.material {
            BodyMaterial::Series(material) if material.fit().is_some() => "fitted series",
            BodyMaterial::Series(_) => "series",
            BodyMaterial::Samples(_) => "direct sum",
        },
        domain_half_width_m: outcome.domain_half_width_m,
        domain_enlarged: outcome.domain_enlarged,
        iterations: outcome.iterations,
        errors_missing: outcome.errors_missing.as_deref(),
        program: env!("CARGO_PKG_NAME"),
        program_version: env!("CARGO_PKG_VERSION"),
        scenario_hash,
    };
    super::summary::json(&summary)
}
