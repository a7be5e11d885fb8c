//! Results for other programs: the summary and every case with all its columns, as one JSON object.

use serde_json::{Map, Value, json};

use super::ReportError;
use super::quantities;
use super::summary;
use super::table::Cell;
use crate::sweep::plan::SweepPlan;
use crate::sweep::search::run::Outcome;

/// `{"summary": as in summary.json, "cases": one object per row of sweep.csv}`; an absent value is null.
///
/// # Errors
/// [`ReportError`] where the summary cannot be made.
pub fn sweep(plan: &SweepPlan, outcome: &Outcome, sweep_hash: &str) -> Result<String, ReportError> {
    let failed = |error: serde_json::Error| ReportError::Table {
        name: "the results as JSON",
        reason: error.to_string(),
    };
    let summary = summary::summary(plan, outcome, sweep_hash)?;
    let summary: Value = serde_json::from_slice(&summary).map_err(failed)?;
    let branches = outcome.branches();
    let columns = quantities::of_cases(branches, plan.figures.frequency_unit, plan.axes.as_ref());
    let case = |record| -> Map<String, Value> {
        let cells = columns.iter();
        cells
            .map(|column| (column.name.clone(), value((column.cell)(record))))
            .collect()
    };
    let cases: Vec<_> = outcome.records.iter().map(case).collect();
    let results = json!({ "summary": summary, "cases": cases });
    let text = serde_json::to_string_pretty(&results).map_err(failed)?;
    Ok(text + "\n")
}

fn value(cell: Cell) -> Value {
    match cell {
        Cell::Absent => Value::Null,
        Cell::Number(number) => number.into(),
        Cell::Count(count) => count.into(),
        Cell::Text(text) => text.into(),
    }
}
