//! The tables of a scenario: the history, profiles and fields at the times asked for, the summary.

use serde::Serialize;

use super::ReportError;
use super::npy;
use super::profile_lines::{self, Profile, ProfilePoint};
use super::quantities::Place::{Count, Number, Optional, OptionalCount, Text};
use super::quantities::{self, Column, PlaceIn};
use super::table::Cell;
use super::vti;
use crate::contact::half_space::grid::Grid;
use crate::contact::statistics::ContactStatistics;
use crate::contact::surface::Surface;
use crate::simulation::body_material::BodyMaterial;
use crate::simulation::outside_model;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::work::{self, HistoryWork, Separation};
use crate::simulation::{HistoryRow, SimulationEnd, SimulationOutcome, SurfaceRecord};
use crate::sweep::record::attracted::Jump;
use crate::sweep::store::Store;
use crate::sweep::store::files::{OfCase, Place};

/// The table of time steps.
pub(super) const HISTORY: &str = "history.csv";
/// The table of cycles of sine segments, where there are any.
pub(super) const CYCLES: &str = "cycles.csv";
/// What the simulation came to.
pub(super) const SUMMARY: &str = "summary.json";

/// Which time and state the files of a folder belong to.
pub(super) const INDEX_FILE: &str = "index.csv";

/// The table of the profile `k`.
pub(super) fn profile_file(k: usize) -> String {
    format!("{k}.csv")
}

/// One quantity of the field `k`.
pub(super) fn field_file(k: usize, quantity: &str) -> String {
    format!("{k}-{quantity}.npy")
}

/// A history with its profiles along their lines: all that its tables, figures and page are made of.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    /// Without profiles of its own where it was read from a folder.
    pub outcome: SimulationOutcome,
    pub profiles: Vec<Profile>,
}

impl From<SimulationOutcome> for History {
    fn from(outcome: SimulationOutcome) -> Self {
        let profiles = profiles(&outcome);
        Self { outcome, profiles }
    }
}

/// The profiles of a history.
pub fn profiles(outcome: &SimulationOutcome) -> Vec<Profile> {
    outcome.profiles.iter().map(Profile::of).collect()
}

/// Writes the tables, as far as the simulation came.
///
/// # Errors
/// [`ReportError`] naming the file that could not be made.
pub fn write(
    store: &Store,
    plan: &ScenarioPlan,
    (outcome, profiles): (&SimulationOutcome, &[Profile]),
) -> Result<(), ReportError> {
    store.write(Place::Top(HISTORY), &quantities::history(outcome))?;
    if !outcome.cycles.is_empty() {
        store.write(Place::Top(CYCLES), &quantities::cycles(outcome))?;
    }
    store.write(
        Place::Top(SUMMARY),
        &summary(plan, outcome, store.sweep_hash())?,
    )?;
    if !profiles.is_empty() {
        let surfaces = profiles.iter().map(|profile| (profile.row, profile.grid));
        let rows: Vec<Indexed> = surfaces.enumerate().map(listed).collect();
        let index = quantities::table(INDEX, &rows);
        store.write(Place::Case(OfCase::Profiles, INDEX_FILE), &index)?;
        for (k, profile) in profiles.iter().enumerate() {
            let place = Place::Case(OfCase::Profiles, &profile_file(k));
            store.write(place, &points(profile))?;
        }
    }
    if !outcome.fields.is_empty() {
        let rows = outcome
            .fields
            .iter()
            .enumerate()
            .map(|(k, record)| Indexed {
                contact: statistics(plan, record),
                ..listed((k, (record.row, profile_lines::grid(record))))
            });
        let rows: Vec<Indexed> = rows.collect();
        let index = quantities::table(INDEX.iter().chain(CONTACT), &rows);
        store.write(Place::Case(OfCase::Fields, INDEX_FILE), &index)?;
        for (k, record) in outcome.fields.iter().enumerate() {
            write_fields(store, k, record)?;
        }
    }
    Ok(())
}

/// A row of [`INDEX_FILE`].
#[derive(Debug, Clone, Default)]
pub(super) struct Indexed {
    pub(super) index: usize,
    pub(super) row: HistoryRow,
    /// Cells along x and y and their sides (m), of a surface on a grid.
    pub(super) cells: [Option<usize>; 2],
    pub(super) spacing_m: [Option<f64>; 2],
    /// Of a field, not read back.
    contact: Option<ContactStatistics>,
}

type OfIndex = Column<Indexed>;

/// The columns of [`INDEX_FILE`].
#[rustfmt::skip]
pub(super) static INDEX: &[OfIndex] = &[
    OfIndex::new("index", |r| r.index.into(), "the number in the names of its files").read_into(|r| Count(&mut r.index)),
    OfIndex::new("time_s", |r| r.row.time_s.into(), "time").read_into(|r| Number(&mut r.row.time_s)),
    OfIndex::new("load_n", |r| r.row.load_n.into(), "load W").read_into(|r| Number(&mut r.row.load_n)),
    OfIndex::new("approach_m", |r| r.row.approach_m.into(), "approach δ").read_into(|r| Optional(&mut r.row.approach_m)),
    OfIndex::new("contact_radius_m", |r| r.row.contact_radius_m.into(), "contact radius a").read_into(|r| Number(&mut r.row.contact_radius_m)),
    OfIndex::new("cells_x", |r| r.cells[0].into(), "cells along x; empty along a radius").read_into(|r| OptionalCount(&mut r.cells[0])),
    OfIndex::new("cells_y", |r| r.cells[1].into(), "cells along y").read_into(|r| OptionalCount(&mut r.cells[1])),
    OfIndex::new("spacing_x_m", |r| r.spacing_m[0].into(), "side of a cell along x").read_into(|r| Optional(&mut r.spacing_m[0])),
    OfIndex::new("spacing_y_m", |r| r.spacing_m[1].into(), "side along y").read_into(|r| Optional(&mut r.spacing_m[1])),
];

/// Of fields, what the contact is like as a whole.
#[rustfmt::skip]
pub(super) static CONTACT: &[OfIndex] = &[
    OfIndex::new("contact_fraction", |r| r.contact.map(|c| c.area_fraction).into(), "cells in contact over all cells"),
    OfIndex::new("contact_patches", |r| r.contact.map(|c| c.patches).into(), "patches of which no two have cells side by side"),
    OfIndex::new("largest_patch_m2", |r| r.contact.and_then(|c| c.largest_patch_m2).into(), "area of the largest patch"),
    OfIndex::new("mean_pressure_pa", |r| r.contact.and_then(|c| c.mean_pressure_pa).into(), "pressure, mean over the contact"),
    OfIndex::new("rms_pressure_pa", |r| r.contact.and_then(|c| c.rms_pressure_pa).into(), "the same, root mean square"),
    OfIndex::new("mean_gap_m", |r| r.contact.and_then(|c| c.mean_gap_m).into(), "gap, mean over all cells under the indenter, 0 in contact"),
    OfIndex::new("rms_gap_m", |r| r.contact.and_then(|c| c.rms_gap_m).into(), "the same, root mean square"),
];

/// The statistics of a field on cells.
fn statistics(plan: &ScenarioPlan, record: &SurfaceRecord) -> Option<ContactStatistics> {
    let Surface::Cells(cells) = &record.surface else {
        return None;
    };
    let repeats = plan.contact.indenter.is_periodic();
    Some(ContactStatistics::of(
        cells,
        record.gap_m.as_deref(),
        repeats,
    ))
}

/// The row of a surface and its grid.
type Listed = (HistoryRow, Option<Grid>);

fn listed((index, (row, grid)): (usize, Listed)) -> Indexed {
    Indexed {
        index,
        row,
        cells: [Grid::cells_x, Grid::cells_y].map(|of| grid.map(|grid| of(&grid))),
        spacing_m: [Grid::spacing_x_m, Grid::spacing_y_m].map(|of| grid.map(|grid| of(&grid))),
        contact: None,
    }
}

/// A row of [`profile_file`].
#[derive(Debug, Clone, Default)]
pub(super) struct OnLine {
    pub(super) line: String,
    pub(super) point: ProfilePoint,
}

const fn on_line(
    name: &'static str,
    value: fn(&OnLine) -> Cell,
    place: PlaceIn<OnLine>,
) -> Column<OnLine> {
    Column::new(name, value, "").read_into(place)
}

const PRESSURE: Column<OnLine> = on_line(
    "pressure_pa",
    |r| r.point.pressure_pa.into(),
    |r| Optional(&mut r.point.pressure_pa),
);
const DISPLACEMENT: Column<OnLine> = on_line(
    "displacement_m",
    |r| r.point.displacement_m.into(),
    |r| Number(&mut r.point.displacement_m),
);
const GAP: Column<OnLine> = on_line(
    "gap_m",
    |r| r.point.gap_m.into(),
    |r| Optional(&mut r.point.gap_m),
);

/// The columns of [`profile_file`] along a radius.
pub(super) static ALONG_RADIUS: &[Column<OnLine>] = &[
    on_line(
        "radius_m",
        |r| r.point.position_m.into(),
        |r| Number(&mut r.point.position_m),
    ),
    PRESSURE,
    DISPLACEMENT,
    GAP,
];
/// The same along the axes of a grid.
pub(super) static ALONG_AXES: &[Column<OnLine>] = &[
    on_line("line", |r| r.line.as_str().into(), |r| Text(&mut r.line)),
    on_line(
        "position_m",
        |r| r.point.position_m.into(),
        |r| Number(&mut r.point.position_m),
    ),
    PRESSURE,
    DISPLACEMENT,
    GAP,
];

/// The content of [`profile_file`].
fn points(profile: &Profile) -> Vec<u8> {
    let columns = match profile.grid {
        None => ALONG_RADIUS,
        Some(_) => ALONG_AXES,
    };
    let rows = profile.lines.iter().flat_map(|(line, points)| {
        let row = |point: &ProfilePoint| OnLine {
            line: line.clone(),
            point: *point,
        };
        points.iter().map(row)
    });
    quantities::table(columns, &rows.collect::<Vec<_>>())
}

/// Every quantity of a field, [`field_file`], and all of them for ParaView, `<k>.vti`. The gap is infinite where there is no indenter, and left out where the
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
        let place = Place::Case(OfCase::Fields, &field_file(k, name));
        store.write(place, &npy::matrix(rows, columns, values))?;
    }
    let image = vti::image(&cells.grid, record.row.time_s, &fields);
    store.write(Place::Case(OfCase::Fields, &format!("{k}.vti")), &image)?;
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
    /// Of the indenter on the body over the whole history.
    work_j: Option<f64>,
    work_error_j: Option<f64>,
    /// The same, where the history ends without load; otherwise why not.
    energy_dissipated_j: Option<f64>,
    energy_dissipated_error_j: Option<f64>,
    energy_dissipated_missing: Option<&'a str>,
    /// The largest pull on an indenter whose edge an attraction moves, and the work of the pull that parts the surfaces.
    #[serde(skip_serializing_if = "Option::is_none")]
    separation: Option<Separation>,
    #[serde(skip_serializing_if = "<[Jump]>::is_empty")]
    jumps: &'a [Jump],
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
///
/// # Errors
/// [`ReportError`] where it cannot be written as JSON.
pub fn summary(
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
    let work = HistoryWork::of(plan, outcome);
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
        work_j: work.map(|work| work.work_j),
        work_error_j: work.and_then(|work| work.error_j),
        energy_dissipated_j: work.and_then(|work| work.dissipated_j()),
        energy_dissipated_error_j: work.and_then(|work| work.dissipated_error_j()),
        energy_dissipated_missing: work.map_or(Some(work::UNKNOWN), |work| work.stored),
        separation: outcome.separation,
        jumps: &outcome.jumps,
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
