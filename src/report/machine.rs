//! Results for other programs: the summary and every case with all its columns, as one JSON object.

use serde_json::{Map, Value};

use super::{ReportError, summary, table};
use crate::sweep::plan::SweepPlan;
use crate::sweep::search::run::Outcome;

/// `{"summary": as in summary.json, "cases": one object per row of sweep.csv}`; an absent value is null.
///
/// # Errors
/// [`ReportError`] where a table cannot be made.
pub fn sweep(plan: &SweepPlan, outcome: &Outcome, sweep_hash: &str) -> Result<String, ReportError> {
    let failed = |reason: String| ReportError::Table {
        name: "the results as JSON",
        reason,
    };
    let summary = summary::summary(plan, outcome, sweep_hash)?;
    let summary: Value = serde_json::from_slice(&summary).map_err(|e| failed(e.to_string()))?;
    let branches = outcome.retardation_times_s().len();
    let csv = table::sweep(&outcome.records, branches)?;
    let mut reader = csv::Reader::from_reader(csv.as_slice());
    let columns = reader.headers().map_err(|e| failed(e.to_string()))?.clone();
    let mut cases = Vec::with_capacity(outcome.records.len());
    for row in reader.records() {
        let row = row.map_err(|e| failed(e.to_string()))?;
        let cells = columns.iter().zip(&row);
        let case: Map<String, Value> = cells
            .map(|(column, cell)| (column.to_owned(), value(column, cell)))
            .collect();
        cases.push(Value::Object(case));
    }
    let mut results = Map::new();
    results.insert("summary".to_owned(), summary);
    results.insert("cases".to_owned(), Value::Array(cases));
    let text = serde_json::to_string_pretty(&Value::Object(results));
    text.map(|text| text + "\n")
        .map_err(|e| failed(e.to_string()))
}

/// A cell as what it is: text in the columns of text, elsewhere a number.
fn value(column: &str, cell: &str) -> Value {
    if cell.is_empty() {
        return Value::Null;
    }
    if ["method", "warnings", "status", "message"].contains(&column) {
        return Value::from(cell);
    }
    let whole = cell.parse::<u64>().map(Value::from);
    whole
        .or_else(|_| cell.parse::<f64>().map(Value::from))
        .unwrap_or_else(|_| Value::from(cell))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_becomes_what_it_is() {
        assert_eq!(value("index", "3"), Value::from(3));
        assert_eq!(value("energy_loss_j", "3.5e-6"), Value::from(3.5e-6));
        assert_eq!(value("energy_loss_j", ""), Value::Null);
        assert_eq!(value("message", "12"), Value::from("12"));
    }
}
