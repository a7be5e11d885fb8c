//! The folder of a history, read back into what a simulation came to: tables, figures and page are made of it again, without solving.
//!
//! Numbers in its tables are written without losing a bit, so that what is read is what was computed. The numbers of cycles follow
//! from the rows; of their table the errors alone are read.

use std::path::Path;

use serde::Deserialize;

use super::npy;
use super::profile_lines::{Profile, ProfilePoint};
use super::quantities::{self, Column, Moment};
use super::scenario_tables::{
    ALONG_AXES, ALONG_RADIUS, CYCLES, HISTORY, History, INDEX, INDEX_FILE, Indexed, OnLine,
    SUMMARY, field_file, profile_file,
};
use super::table_reader::{self, MAX_BYTES};
use crate::contact::half_space::grid::Grid;
use crate::contact::surface::{CellSurface, Surface};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Source};
use crate::input::document::read_limited;
use crate::simulation::cycles::{self, HistoryCycle};
use crate::simulation::errors::RowErrors;
use crate::simulation::work::Separation;
use crate::simulation::{HistoryRow, Simulation, SimulationEnd, SimulationOutcome, SurfaceRecord};
use crate::simulation::{scenario, work};
use crate::sweep::plan::resolved::hash;
use crate::sweep::record::attracted::Jump;
use crate::sweep::store::files::{Found, OfCase, Place};

/// What is read of `summary.json`.
#[derive(Deserialize)]
struct Kept {
    status: String,
    message: Option<String>,
    errors_missing: Option<String>,
    domain_half_width_m: f64,
    domain_enlarged: usize,
    iterations: u64,
    #[serde(default)]
    jumps: Vec<Jump>,
    separation: Option<Separation>,
    scenario_hash: String,
}

/// Reads what the history of this scenario has left in its folder.
///
/// # Errors
/// Files that are missing, that are not as they were written, or that are of another scenario; with file and line.
pub fn read(folder: &Path, simulation: &Simulation) -> Result<History, Diagnostics> {
    let plan = simulation.plan();
    let folder = Folder {
        path: folder,
        found: Found::of(folder),
    };
    let kept = folder.summary()?;
    if kept.scenario_hash != hash(&scenario::resolved_text(plan)) {
        return Err(folder.wrong(
            SUMMARY,
            "these results are of another scenario than resolved.toml",
        ));
    }
    let most = simulation.schedule().moments.len();
    let moments = folder.table(HISTORY, quantities::HISTORY, &Moment::default(), most)?;
    let errors: Vec<RowErrors> = moments.iter().map(|moment| moment.errors).collect();
    let mut rows: Vec<HistoryRow> = moments.into_iter().map(|moment| moment.row).collect();
    if rows.iter().all(|row| row.work_j.is_none()) {
        work::fill_in(plan, &mut rows);
    }
    if !rows.is_sorted_by(|a, b| a.time_s <= b.time_s) {
        return Err(folder.wrong(HISTORY, "its times descend"));
    }
    let profiles = match plan.output.profiles_at_s.len() {
        0 => Vec::new(),
        most => folder.surfaces(OfCase::Profiles, most, |k, row, grid| {
            folder.profile(k, row, grid)
        })?,
    };
    let fields = match plan.output.fields_at_s.len() {
        0 => Vec::new(),
        most => folder.surfaces(OfCase::Fields, most, |k, row, grid| {
            folder.field(k, row, grid)
        })?,
    };
    let mut cycles = cycles::in_rows(plan, &rows);
    if !cycles.is_empty() {
        folder.add_errors(&mut cycles)?;
    }
    let outcome = SimulationOutcome {
        rows,
        profiles: Vec::new(),
        fields,
        cycles,
        errors: match errors.iter().all(|errors| *errors == RowErrors::default()) {
            true => Vec::new(),
            false => errors,
        },
        errors_missing: kept.errors_missing,
        domain_half_width_m: kept.domain_half_width_m,
        domain_enlarged: kept.domain_enlarged,
        iterations: kept.iterations,
        jumps: kept.jumps,
        separation: kept.separation,
        ended: match (&kept.status[..], kept.message) {
            ("interrupted", _) => SimulationEnd::Interrupted,
            (_, Some(message)) => SimulationEnd::Failed(message),
            (_, None) => SimulationEnd::Done,
        },
    };
    Ok(History { outcome, profiles })
}

/// What to do where a folder is not as it was written.
const AGAIN: &str = "run `contact-dma simulate` again for this folder";

/// The folder of a history.
struct Folder<'a> {
    path: &'a Path,
    found: Found,
}

impl Folder<'_> {
    fn name(&self, file: &str) -> String {
        self.path.join(file).display().to_string()
    }

    /// What is wrong with a file as a whole.
    fn wrong(&self, file: &str, message: impl Into<String>) -> Diagnostics {
        let place = Location::whole(&Source::file(self.name(file), ""));
        Diagnostic::at(&place, message).help(AGAIN).into()
    }

    fn bytes(&self, file: &str, most: usize) -> Result<Vec<u8>, Diagnostics> {
        match read_limited(&self.path.join(file), most) {
            Ok(bytes) if bytes.len() <= most => Ok(bytes),
            Ok(_) => Err(self.wrong(file, format!("larger than {} MB", most / 1_000_000))),
            Err(error) => {
                let message = format!("cannot read `{}`: {error}", self.name(file));
                Err(Diagnostic::new(message).help(AGAIN).into())
            }
        }
    }

    fn summary(&self) -> Result<Kept, Diagnostics> {
        let bytes = self.bytes(SUMMARY, MAX_BYTES)?;
        let wrong = |error: serde_json::Error| self.wrong(SUMMARY, error.to_string());
        serde_json::from_slice(&bytes).map_err(wrong)
    }

    fn table<R: Clone>(
        &self,
        file: &str,
        columns: &[Column<R>],
        row: &R,
        most: usize,
    ) -> Result<Vec<R>, Diagnostics> {
        let bytes = self.bytes(file, MAX_BYTES)?;
        table_reader::rows((&self.name(file), &bytes), columns, row, most)
    }

    /// Gives the cycles the errors that their table has.
    fn add_errors(&self, cycles: &mut [HistoryCycle]) -> Result<(), Diagnostics> {
        let (row, most) = (HistoryCycle::default(), cycles.len());
        let kept = self.table(CYCLES, quantities::CYCLES, &row, most)?;
        let of = |cycle: &HistoryCycle| (cycle.segment, cycle.number);
        if !cycles.iter().map(of).eq(kept.iter().map(of)) {
            let message = format!("its cycles are not those of {HISTORY}");
            return Err(self.wrong(CYCLES, message));
        }
        for (cycle, kept) in cycles.iter_mut().zip(kept) {
            cycle.errors = kept.errors;
        }
        Ok(())
    }

    /// The surfaces that the index of a folder names; none where the history did not come to the first of them.
    fn surfaces<S>(
        &self,
        kind: OfCase,
        most: usize,
        surface: impl Fn(usize, HistoryRow, Option<Grid>) -> Result<S, Diagnostics>,
    ) -> Result<Vec<S>, Diagnostics> {
        let file = self.found.name(Place::Case(kind, INDEX_FILE));
        if !self.path.join(&file).exists() {
            return Ok(Vec::new());
        }
        let indexed = self.table(&file, INDEX, &Indexed::default(), most)?;
        let surface = |of: Indexed| {
            let grid = match (of.cells, of.spacing_m) {
                ([Some(x), Some(y)], [Some(x_m), Some(y_m)]) => {
                    let grid = Grid::new(x, y, x_m, y_m);
                    Some(grid.map_err(|error| self.wrong(&file, error.to_string()))?)
                }
                _ => None,
            };
            surface(of.index, of.row, grid)
        };
        indexed.into_iter().map(surface).collect()
    }

    fn profile(
        &self,
        k: usize,
        row: HistoryRow,
        grid: Option<Grid>,
    ) -> Result<Profile, Diagnostics> {
        let (columns, line) = match grid {
            None => (ALONG_RADIUS, "r"),
            Some(_) => (ALONG_AXES, ""),
        };
        let of_line = OnLine {
            line: line.to_owned(),
            ..OnLine::default()
        };
        let file = self
            .found
            .name(Place::Case(OfCase::Profiles, &profile_file(k)));
        let points = self.table(&file, columns, &of_line, usize::MAX)?;
        let lines = points.chunk_by(|a, b| a.line == b.line).map(|points| {
            let line = points.first().map_or("", |point| &point.line);
            let points: Vec<ProfilePoint> = points.iter().map(|point| point.point).collect();
            (line.to_owned(), points)
        });
        Ok(Profile {
            row,
            grid,
            lines: lines.collect(),
        })
    }

    fn field(
        &self,
        k: usize,
        row: HistoryRow,
        grid: Option<Grid>,
    ) -> Result<SurfaceRecord, Diagnostics> {
        let index = self.found.name(Place::Case(OfCase::Fields, INDEX_FILE));
        let grid = grid.ok_or_else(|| self.wrong(&index, "a field without cells"))?;
        let file = |quantity: &str| {
            let name = field_file(k, quantity);
            self.found.name(Place::Case(OfCase::Fields, &name))
        };
        let values = |quantity: &str| {
            let file = file(quantity);
            let (rows, columns) = (grid.cells_y(), grid.cells_x());
            let values = npy::values(rows, columns, &self.bytes(&file, MAX_BYTES)?);
            let other =
                || format!("no matrix of {rows} rows and {columns} columns, as {index} has it");
            values.ok_or_else(|| self.wrong(&file, other()))
        };
        let has_gap = self.path.join(file("gap_m")).exists();
        Ok(SurfaceRecord {
            row,
            surface: Surface::Cells(CellSurface {
                grid,
                pressure_pa: values("pressure_pa")?,
                displacement_m: values("displacement_m")?,
            }),
            gap_m: has_gap.then(|| values("gap_m")).transpose()?,
        })
    }
}
