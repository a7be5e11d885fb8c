//! JSON of TRIOS (TA Instruments), after the schema and the examples of TA-Instruments/tadatakit: `Results.Processed` (or `Results`) has the
//! columns by name in `ColumnHeaders`, each with `DisplayName` and `Unit.Name`; the steps in `ResultsSteps`; and `Rows`, objects of numbers
//! by column, whose `Results Step Id` says to which step they belong. Every step is read as a sheet of a workbook is.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::steps;
use crate::input::diagnostic::Diagnostic;

/// The address of the schema, which every export begins with.
const SCHEMA: &[u8] = b"TRIOSJSONExportSchema";

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct Export {
    results: Results,
}

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct Results {
    processed: Option<Table>,
    #[serde(flatten)]
    own: Table,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "PascalCase", default)]
struct Table {
    results_steps: Vec<Step>,
    column_headers: BTreeMap<String, Header>,
    rows: Vec<BTreeMap<String, serde_json::Value>>,
}

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct Step {
    id: String,
    #[serde(default)]
    name: String,
}

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct Header {
    display_name: String,
    unit: Option<Unit>,
}

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct Unit {
    name: String,
}

/// Whether bytes are such an export.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(4096)];
    head.windows(SCHEMA.len()).any(|part| part == SCHEMA)
}

/// Every step, its name and its rows as a text with tabs under rows of names and of units.
///
/// # Errors
/// No JSON, or none of this kind.
pub(super) fn sheets(name: &str, bytes: &[u8]) -> Result<Vec<(String, String)>, Diagnostic> {
    let export: Export = serde_json::from_slice(bytes).map_err(|error| {
        Diagnostic::new(format!(
            "`{name}` cannot be read as a JSON export of TRIOS: {error}"
        ))
        .help("export it again, with all results; or as CSV, as text or to LIMS")
    })?;
    let table = export.results.processed.unwrap_or(export.results.own);
    let headers = || table.column_headers.values();
    let names: Vec<&str> = headers().map(|header| &header.display_name[..]).collect();
    let units = headers().map(|header| header.unit.as_ref().map_or("", |unit| &unit.name));
    let head = format!(
        "{}\n{}\n",
        names.join("\t"),
        units.collect::<Vec<_>>().join("\t")
    );
    let sheets = table
        .results_steps
        .iter()
        .filter(|step| !steps::is_derived(&step.name));
    let sheets = sheets.map(|step| {
        let is_own = |row: &&BTreeMap<_, serde_json::Value>| {
            row.get("Results Step Id").and_then(|id| id.as_str()) == Some(&step.id)
        };
        let rows = table.rows.iter().filter(is_own).map(|row| {
            let cells = table
                .column_headers
                .keys()
                .map(|column| match row.get(column) {
                    Some(serde_json::Value::Number(number)) => number.to_string(),
                    _ => String::new(),
                });
            cells.collect::<Vec<_>>().join("\t") + "\n"
        });
        (step.name.clone(), head.clone() + &rows.collect::<String>())
    });
    Ok(sheets.collect())
}
