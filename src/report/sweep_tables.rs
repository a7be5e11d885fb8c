//! The tables of a sweep: `sweep.csv`, loops, pressures and work of single cases, `cycles.npz`, the summary.

use std::collections::BTreeSet;

use super::ReportError;
use super::cycles;
use super::quantities;
use super::summary;
use super::table;
use super::work_line::WorkLine;
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::{CaseRecord, CaseResult};
use crate::sweep::search::run::Outcome;
use crate::sweep::store::Store;
use crate::sweep::store::files::{OfCase, Place};

/// Writes the tables. `only` are the cases that have tables of their own; without it, all that hold their cycle.
///
/// # Errors
/// [`ReportError`] naming the file that could not be made.
pub fn write(
    store: &Store,
    plan: &SweepPlan,
    outcome: &Outcome,
    only: Option<&BTreeSet<usize>>,
) -> Result<(), ReportError> {
    let columns = (outcome.branches(), plan.is_attracted());
    let unit = plan.figures.frequency_unit;
    store.write(
        Place::Top("sweep.csv"),
        &quantities::sweep(&outcome.records, columns, unit, plan.axes.as_ref()),
    )?;
    let has_tables = |record: &&CaseRecord| only.is_none_or(|only| only.contains(&record.index));
    for record in outcome.records.iter().filter(has_tables) {
        let Some(cycle) = record.result.as_ref().and_then(CaseResult::cycle) else {
            continue;
        };
        let name = format!("{}.csv", record.index);
        let place = |kind| Place::Case(kind, &name);
        store.write(place(OfCase::Loops), &table::samples(&cycle.samples))?;
        let pressures = table::pressures(&cycle.pressures, plan.base.drive.control());
        store.write(place(OfCase::Pressures), &pressures)?;
        let work = WorkLine::of(&cycle.surface_loss, plan.indenter_under(&record.varied));
        store.write(place(OfCase::Work), &table::work(&work))?;
    }
    if plan.is_small() {
        cycles::write(store, store, plan, outcome)?;
    }
    let summary = summary::summary(plan, outcome, store.sweep_hash())?;
    store.write(Place::Top("summary.json"), &summary)?;
    Ok(())
}
