//! Results for other programs: the summary and every case with all its columns, as one JSON object.

use serde_json::{Map, Value, json};

use super::quantities;
use super::summary;
use super::table::Cell;
use crate::sweep::plan::SweepPlan;
use crate::sweep::search::run::Outcome;

/// `{"summary": as in summary.json, "cases": one object per row of sweep.csv}`; an absent value is null.
pub fn sweep(plan: &SweepPlan, outcome: &Outcome, sweep_hash: &str) -> Value {
    let summary = summary::of(plan, outcome, sweep_hash);
    let branches = outcome.branches();
    let columns = quantities::of_cases(branches, plan.figures.frequency_unit, plan.axes.as_ref());
    let cases = outcome.records.iter().map(|record| {
        let cells = columns.iter();
        let cells = cells.map(|column| (column.name.clone(), value((column.cell)(record))));
        cells.collect::<Map<_, _>>()
    });
    json!({ "summary": summary, "cases": cases.collect::<Vec<_>>() })
}

fn value(cell: Cell) -> Value {
    match cell {
        Cell::Absent => Value::Null,
        Cell::Number(number) => number.into(),
        Cell::Count(count) => count.into(),
        Cell::Text(text) => text.into(),
    }
}
