//! Tables and figures, from records alone: nothing here solves anything.

pub mod chart;
pub mod comparison;
pub mod figure;
pub mod fit;
pub mod machine;
pub mod material;
pub mod npy;
pub mod page;
pub mod samples;
pub mod scenario;
pub mod stamp;
pub mod summary;
pub mod table;
pub mod terminal;
pub mod terminal_simulation;
pub mod vti;

use crate::sweep::files;
use crate::sweep::plan::SweepPlan;
use crate::sweep::run::Outcome;
use crate::sweep::store::{Store, StoreError};
use chart::ChartError;
use page::Pictures;
use stamp::Stamp;

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
    #[error("cannot make the table {name}: {reason}")]
    Table { name: &'static str, reason: String },
}

/// Writes everything a sweep leaves behind: table, loops, summary, figures with their data. Returns what was left out and
/// why.
///
/// # Errors
/// [`ReportError`] naming the file that could not be made.
pub fn write_sweep(
    store: &Store,
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<Vec<String>, ReportError> {
    let branches = outcome.retardation_times_s().len();
    store.write("sweep.csv", &table::sweep(&outcome.records, branches)?)?;
    for record in &outcome.records {
        if let Some(result) = &record.result {
            let name = format!("loops/{}.csv", record.index);
            store.write(name, &table::samples(&result.samples)?)?;
        }
    }
    let summary = summary::summary(plan, outcome, store.sweep_hash())?;
    store.write("summary.json", &summary)?;
    let (figures, left_out) = figure::of_sweep::figures(plan, outcome)?;
    let stamp = Stamp::of(store.sweep_hash());
    let pictures = Pictures::default();
    figure::write_all(&figures, &|name, bytes| {
        pictures.see(name, bytes);
        store.write(name, &stamp.on(name, bytes))
    })?;
    let page = page::sweep(plan, outcome, &pictures, store.sweep_hash())?;
    store.write("index.html", page.as_bytes())?;
    // An earlier run of the same sweep, which came further, may have left figures that this one has not.
    let has = |name: &str| figures.iter().any(|figure| figure.name == name);
    for name in files::FIGURES.into_iter().filter(|name| !has(name)) {
        for file in files::of_figure(name) {
            store.remove(&file)?;
        }
    }
    Ok(left_out)
}
