//! The tables of a scenario: the history, profiles and fields at the times asked for, the summary.

use std::path::Path;

use serde::Serialize;

use super::ReportError;
use super::npy;
use super::profile_lines::lines;
use super::quantities;
use super::table::{self, Cell, cells, csv};
use super::vti;
use crate::contact::surface::Surface;
use crate::simulation::body_material::BodyMaterial;
use crate::simulation::outside_model;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::{SimulationEnd, SimulationOutcome, SurfaceRecord};
use crate::sweep::store::Store;

/// The table of time steps.
pub(super) const HISTORY: &str = "history.csv";
/// The table of cycles of sine segments, where there are any.
const CYCLES: &str = "cycles.csv";

/// Writes the tables, as far as the simulation came.
///
/// # Errors
/// [`ReportError`] naming the file that could not be made.
pub fn write(
    store: &Store,
    plan: &ScenarioPlan,
    outcome: &SimulationOutcome,
) -> Result<(), ReportError> {
    store.write(HISTORY, &quantities::history(outcome))?;
    if !outcome.cycles.is_empty() {
        store.write(CYCLES, &quantities::cycles(outcome))?;
    }
    store.write("summary.json", &summary(plan, outcome, store.sweep_hash())?)?;
    if !outcome.profiles.is_empty() {
        store.write("profiles/index.csv", &index(&outcome.profiles))?;
        for (k, record) in outcome.profiles.iter().enumerate() {
            store.write(format!("profiles/{k}.csv"), &profile(record))?;
        }
    }
    if !outcome.fields.is_empty() {
        store.write("fields/index.csv", &index(&outcome.fields))?;
        for (k, record) in outcome.fields.iter().enumerate() {
            write_fields(store, k, record)?;
        }
    }
    Ok(())
}

/// `index.csv`: which time and state each file of a folder belongs to.
fn index(records: &[SurfaceRecord]) -> Vec<u8> {
    let grid = |record: &SurfaceRecord| match &record.surface {
        Surface::Radial(_) => None,
        Surface::Cells(cells) => Some(cells.grid),
    };
    let rows = records.iter().map(|record| (record.row, grid(record)));
    table::of_rows(
        rows.enumerate(),
        &[
            ("index", |(k, _)| (*k).into()),
            ("time_s", |(_, (row, _))| row.time_s.into()),
            ("load_n", |(_, (row, _))| row.load_n.into()),
            ("approach_m", |(_, (row, _))| row.approach_m.into()),
            ("contact_radius_m", |(_, (row, _))| {
                row.contact_radius_m.into()
            }),
            ("cells_x", |(_, (_, grid))| grid.map(|g| g.cells_x()).into()),
            ("cells_y", |(_, (_, grid))| grid.map(|g| g.cells_y()).into()),
            ("spacing_x_m", |(_, (_, grid))| {
                grid.map(|g| g.spacing_x_m()).into()
            }),
            ("spacing_y_m", |(_, (_, grid))| {
                grid.map(|g| g.spacing_y_m()).into()
            }),
        ],
    )
}

/// `profiles/<k>.csv`.
fn profile(record: &SurfaceRecord) -> Vec<u8> {
    let is_radial = matches!(record.surface, Surface::Radial(_));
    let places: &[&str] = match is_radial {
        true => &["radius_m"],
        false => &["line", "position_m"],
    };
    let columns = [places, &["pressure_pa", "displacement_m", "gap_m"]].concat();
    let rows = lines(record).into_iter().flat_map(|(line, points)| {
        points.into_iter().map(move |point| {
            let values = cells![
                point.position_m,
                point.pressure_pa,
                point.displacement_m,
                point.gap_m,
            ];
            let line = (!is_radial).then(|| Cell::from(line));
            line.into_iter().chain(values).collect::<Vec<_>>()
        })
    });
    csv(&columns, rows)
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
    let mut peaks = outcome.rows.iter().map(|row| row.peak_pressure_pa);
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
        largest_peak_pressure_pa: peaks
            .try_fold(0.0, |largest: f64, peak| Some(largest.max(peak?))),
        engine: plan.solver.engine.name(),
        hereditary_integral: match &plan.contact.material {
            BodyMaterial::Series(material) if material.origin.fit.is_some() => "fitted series",
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
    crate::report::summary::json(&summary)
}
