//! Results for other programs: the summary and every case with all its columns, as one JSON object.

use serde_json::{Map, Value, json};

use super::quantities::{self, Named};
use super::summary;
use super::table::Cell;
use crate::sweep::plan::SweepPlan;
use crate::sweep::search::run::Outcome;

/// `{"summary": as in summary.json, "cases": one object per row of sweep.csv}`; an absent value is null.
pub fn sweep(plan: &SweepPlan, outcome: &Outcome, sweep_hash: &str) -> Value {
    let summary = summary::of(plan, outcome, sweep_hash);
    let of = (outcome.branches(), plan.is_attracted());
    let columns = quantities::of_cases(of, plan.figures.frequency_unit, plan.axes.as_ref());
    json!({ "summary": summary, "cases": rows(&columns, &outcome.records) })
}

/// The rows of a table as objects: the type of a value is that of its column, whatever its text looks like.
pub fn rows<R>(columns: &[Named<R>], rows: &[R]) -> Vec<Value> {
    let cells = |row| {
        columns
            .iter()
            .map(move |column| (&column.name[..], (column.cell)(row)))
    };
    rows.iter().map(|row| object(cells(row))).collect()
}

/// Cells under the names of their columns.
pub fn object<'a>(cells: impl Iterator<Item = (&'a str, Cell)>) -> Value {
    let object: Map<_, _> = cells
        .map(|(column, cell)| (column.to_owned(), value(cell)))
        .collect();
    object.into()
}

/// One cell.
pub fn value(cell: Cell) -> Value {
    match cell {
        Cell::Absent => Value::Null,
        Cell::Number(number) => number.into(),
        Cell::Count(count) => count.into(),
        Cell::Text(text) => text.into(),
    }
}
