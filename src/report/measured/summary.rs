//! `summary.json` of measured loops: what a program wants to know at a glance.

use serde::Serialize;
use serde_json::{Value, json};

use super::Analysis;
use crate::report::ReportError;
use crate::sweep::plan::resolved;
use crate::sweep::record::Status;

#[derive(Serialize)]
struct Summary<'a> {
    title: &'a str,
    /// Those of a sweep are located by solving between its frequencies; of measured loops there are none.
    peaks: Vec<Value>,
    cases: Value,
    files: Vec<&'a str>,
    findings: Vec<Value>,
    engine: &'static str,
    program: &'a str,
    program_version: &'a str,
    /// Of the setup, where there is one.
    setup_hash: Option<String>,
}

/// The summary as an object.
///
/// # Errors
/// [`ReportError::Table`] where it is no JSON.
pub fn summary(analysis: &Analysis) -> Result<Value, ReportError> {
    let rows = &analysis.rows;
    let count = |status: Status| rows.iter().filter(|row| row.status() == status).count();
    let findings = rows.iter().flat_map(|row| {
        let findings = row.measured.iter().flat_map(|m| &m.findings);
        findings.map(move |finding| {
            json!({ "file": row.file, "code": finding.code(), "sentence": finding.to_string() })
        })
    });
    let summary = Summary {
        title: &analysis.title,
        peaks: Vec::new(),
        cases: json!({
            "planned": rows.len(),
            "converged": count(Status::Converged),
            "not-converged": count(Status::NotConverged),
            "failed": count(Status::Failed),
        }),
        files: rows.iter().map(|row| row.file.as_str()).collect(),
        findings: findings.collect(),
        engine: "measured",
        program: env!("CARGO_PKG_NAME"),
        program_version: env!("CARGO_PKG_VERSION"),
        setup_hash: analysis.setup.as_deref().map(resolved::hash),
    };
    serde_json::to_value(summary).map_err(|error| ReportError::Table {
        name: "summary.json",
        reason: error.to_string(),
    })
}
