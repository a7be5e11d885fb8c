//! `summary.json` of measured loops: what a program wants to know at a glance.

use serde_json::{Value, json};

use super::Analysis;
use crate::sweep::plan::resolved;
use crate::sweep::record::Status;

/// The summary as an object.
pub fn summary(analysis: &Analysis) -> Value {
    let rows = &analysis.rows;
    let count = |status: Status| rows.iter().filter(|row| row.status() == status).count();
    let files: Vec<&str> = rows.iter().map(|row| row.file.as_str()).collect();
    let findings = rows.iter().flat_map(|row| {
        row.findings().map(|finding| {
            json!({ "file": row.file, "code": finding.code(), "sentence": finding.to_string() })
        })
    });
    json!({
        "title": analysis.title,
        // Those of a sweep are located by solving between its frequencies; of measured loops there are none.
        "peaks": [],
        "cases": {
            "planned": rows.len(),
            "converged": count(Status::Converged),
            "not-converged": count(Status::NotConverged),
            "failed": count(Status::Failed),
        },
        "files": files,
        "findings": findings.collect::<Vec<_>>(),
        "engine": "measured",
        "program": env!("CARGO_PKG_NAME"),
        "program_version": env!("CARGO_PKG_VERSION"),
        "setup_hash": analysis.setup.as_deref().map(resolved::hash),
    })
}
