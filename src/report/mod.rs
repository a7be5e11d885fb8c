//! Tables and figures, from records alone: nothing here solves anything.
//!
//! Its parts from top to bottom, each of which may use those above it: numbers, words and peaks as text; lines over the surface;
//! tables, and the quantities that are their columns; captions; comparison; chart; figure; material; page; summary and results for
//! programs; terminal; scenario. A test holds them to that.
//!
//! ```
//! use contact_dma::prelude::*;
//! use contact_dma::report;
//! use contact_dma::sweep::case::Setup;
//! use contact_dma::sweep::plan::resolved::resolved_text;
//! use contact_dma::sweep::store::Store;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let folder = folder.path();
//! let pmma = library::find("pmma").ok_or("not in the library")?.material()?;
//! let sweep = Sweep::new(pmma, Sphere::new(0.01)?, HarmonicDrive::load(10.0, 5.0)?);
//! let sweep = sweep.title("PMMA").steps(32)?.springs(32)?.frequencies_hz([1e-4, 1e-3, 1e-2])?;
//! let outcome = sweep.clone().solve()?;
//! // As the program prepares it: the half-space engine takes its cells from some indenters.
//! let setup = Setup::new(sweep.into_plan())?;
//! let store = Store::open(folder, &resolved_text(setup.plan()), false)?;
//! report::write_sweep(&store, setup.plan(), &outcome)?;
//! assert!(folder.join("sweep.csv").exists() && folder.join("energy-loss.svg").exists());
//! # Ok(())
//! # }
//! ```

pub mod caption;
pub mod chart;
pub mod comparison;
pub mod cycles;
pub mod dynamic;
pub mod figure;
pub mod fit;
pub mod identify;
pub mod machine;
pub mod material;
pub mod measured;
pub mod npy;
pub mod number;
pub mod page;
pub mod peaks;
pub mod profile_lines;
pub mod quantities;
pub mod samples;
pub mod scenario;
pub mod summary;
pub mod table;
pub mod terminal;
pub mod terminal_simulation;
pub mod vti;
pub mod words;
pub mod work_line;

use crate::sweep::figures::figure_plan::AxisUnits;
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::{CaseRecord, CaseResult};
use crate::sweep::scales::elastic::NoScale;
use crate::sweep::search::run::Outcome;
use crate::sweep::store::files;
use crate::sweep::store::{Store, StoreError};
use caption::Setting;
use chart::ChartError;
use figure::press::{self, Press};
use figure::units::Units;
use page::Pictures;
use work_line::WorkLine;

/// Why a report cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error("cannot draw {name}: {source}")]
    Chart {
        name: &'static str,
        source: ChartError,
    },
    #[error("cannot normalise the figures: {0}")]
    Scale(#[from] NoScale),
    #[error("cannot make the table {name}: {reason}")]
    Table { name: &'static str, reason: String },
}

/// Reads the cycles of the cases that figures and page show, where the outcome does not hold them already.
///
/// # Errors
/// [`ReportError`] where the folder cannot be read.
pub fn load_drawn_cycles(
    store: &Store,
    plan: &SweepPlan,
    outcome: &mut Outcome,
) -> Result<(), ReportError> {
    if plan.is_small() {
        return Ok(());
    }
    let mut shown = figure::of_sweep::drawn(plan, outcome)?;
    shown.extend(page::shown(plan, outcome)?);
    for record in &mut outcome.records {
        if shown.contains(&record.index) {
            store.load_cycle(record)?;
        }
    }
    Ok(())
}

/// Writes everything a sweep leaves behind: table, loops, pressures, work, summary, figures with their data. Returns what was left out and
/// why.
///
/// # Errors
/// [`ReportError`] naming the file that could not be made.
pub fn write_sweep(
    store: &Store,
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<Vec<String>, ReportError> {
    tables_of_sweep(store, plan, outcome)?;
    figures_of_sweep(store, plan, outcome)
}

/// As [`write_sweep`], without figures and page; those of an earlier run, which may show less, are removed.
///
/// # Errors
/// As [`write_sweep`].
pub fn write_tables_of_sweep(
    store: &Store,
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<Vec<String>, ReportError> {
    tables_of_sweep(store, plan, outcome)?;
    for file in files::FIGURES.into_iter().flat_map(files::of_figure) {
        store.remove(&file)?;
    }
    store.remove("index.html")?;
    Ok(Vec::new())
}

fn tables_of_sweep(store: &Store, plan: &SweepPlan, outcome: &Outcome) -> Result<(), ReportError> {
    let branches = outcome.branches();
    let unit = plan.figures.frequency_unit;
    store.write(
        "sweep.csv",
        &quantities::sweep(&outcome.records, branches, unit, plan.axes.as_ref()),
    )?;
    // Of a large sweep these are the cases that are drawn.
    let drawn = match plan.is_small() {
        true => None,
        false => Some(figure::of_sweep::drawn(plan, outcome)?),
    };
    let is_drawn = |record: &&CaseRecord| drawn.as_ref().is_none_or(|d| d.contains(&record.index));
    for record in outcome.records.iter().filter(is_drawn) {
        let Some(cycle) = record.result.as_ref().and_then(CaseResult::cycle) else {
            continue;
        };
        let name = |folder: &str| format!("{folder}/{}.csv", record.index);
        store.write(name("loops"), &table::samples(&cycle.samples))?;
        let pressures = table::pressures(&cycle.pressures, plan.drive.control());
        store.write(name("pressures"), &pressures)?;
        let work = WorkLine::of(&cycle.surface_loss, plan.indenter.as_ref());
        store.write(name("work"), &table::work(&work))?;
    }
    if plan.is_small() {
        cycles::write(store, store, plan, outcome)?;
    }
    let summary = summary::summary(plan, outcome, store.sweep_hash())?;
    store.write("summary.json", &summary)?;
    Ok(())
}

fn figures_of_sweep(
    store: &Store,
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<Vec<String>, ReportError> {
    let (figures, left_out) = figure::of_sweep::figures(plan, outcome)?;
    let units = Units::of_sweep(plan)?.sentence();
    let pictures = Pictures::of_sweep(store.sweep_hash());
    let press = Press {
        plan: &plan.figures,
        write: &|name, bytes| store.write(name, bytes),
        pictures: &pictures,
    };
    press.figures(&figures, &Setting::of_sweep(plan, outcome, units))?;
    if plan.figures.axes != AxisUnits::Si {
        picture_in_si(plan, outcome, &pictures)?;
    }
    let page = page::sweep(plan, outcome, &pictures, store.sweep_hash())?;
    store.write("index.html", page.as_bytes())?;
    // An earlier run of the same sweep, which came further or was asked for other forms, may have left more than this one.
    let has = |name: &str| figures.iter().any(|figure| figure.name == name);
    for name in files::FIGURES {
        let left = match has(name) {
            true => press::not_asked(&plan.figures, name),
            false => files::of_figure(name).into(),
        };
        for file in left {
            store.remove(&file)?;
        }
    }
    Ok(left_out)
}

/// The page shows SI units throughout, since its own script draws in them: gives it its figures in these.
fn picture_in_si(
    plan: &SweepPlan,
    outcome: &Outcome,
    pictures: &Pictures,
) -> Result<(), ReportError> {
    let mut in_si = plan.clone();
    in_si.figures.axes = AxisUnits::Si;
    let (figures, _) = figure::of_sweep::figures(&in_si, outcome)?;
    for figure in figures.iter().filter(|f| page::FIGURES.contains(&f.name)) {
        let drawing = figure.picture.draw();
        let drawing = drawing.map_err(|source| ReportError::Chart {
            name: figure.name,
            source,
        })?;
        pictures.insert(figure.name, &drawing);
    }
    Ok(())
}
