//! `summary.json`: what a program wants to know of a sweep at a glance.

use serde::Serialize;

use super::ReportError;
use crate::report::warnings::{self, OverCases};
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::Status;
use crate::sweep::search::peak::{Peak, RELATIVE_ACCURACY};
use crate::sweep::search::run::Outcome;

#[derive(Serialize)]
pub(super) struct Summary<'a> {
    title: &'a str,
    peaks: &'a [Peak],
    peak_relative_accuracy: f64,
    peak_problems: &'a [String],
    /// Retardation times (s) of the branches whose losses `sweep.csv` lists, in its order.
    retardation_times_s: Vec<f64>,
    cases: Cases,
    /// What axes besides the frequency vary, in the order in which a peak has their values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    axes: Vec<AxisOf<'a>>,
    /// What lies outside the model, or was not estimated, by kind.
    warnings: Vec<OverCases>,
    interrupted: bool,
    engine: &'a str,
    program: &'a str,
    program_version: &'a str,
    sweep_hash: &'a str,
}

/// The column of `sweep.csv` with the values of an axis; where these are the places of blocks in a list, what those are called.
#[derive(Serialize)]
struct AxisOf<'a> {
    column: String,
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    names: &'a [String],
}

#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
struct Cases {
    planned: usize,
    converged: usize,
    transient: usize,
    not_converged: usize,
    failed: usize,
}

/// What the file says.
pub(super) fn of<'a>(
    plan: &'a SweepPlan,
    outcome: &'a Outcome,
    sweep_hash: &'a str,
) -> Summary<'a> {
    Summary {
        title: &plan.title,
        peaks: &outcome.peaks,
        peak_relative_accuracy: RELATIVE_ACCURACY,
        peak_problems: &outcome.peak_problems,
        retardation_times_s: outcome.retardation_times_s(),
        cases: Cases {
            planned: plan.cases().len(),
            converged: outcome.count(Status::Converged),
            transient: outcome.count(Status::Transient),
            not_converged: outcome.count(Status::NotConverged),
            failed: outcome.count(Status::Failed),
        },
        axes: (plan.axes.iter().flat_map(|axes| &axes.over))
            .map(|varied| AxisOf {
                column: varied.column(),
                names: &varied.names,
            })
            .collect(),
        warnings: warnings::over_cases(&outcome.records, plan.figures.frequency_unit),
        interrupted: outcome.interrupted,
        engine: plan.solver.engine.name(),
        program: env!("CARGO_PKG_NAME"),
        program_version: env!("CARGO_PKG_VERSION"),
        sweep_hash,
    }
}

/// The file's bytes.
///
/// # Errors
/// [`ReportError`] where the summary cannot be made.
pub fn summary(
    plan: &SweepPlan,
    outcome: &Outcome,
    sweep_hash: &str,
) -> Result<Vec<u8>, ReportError> {
    json(&of(plan, outcome, sweep_hash))
}

/// A `summary.json`: indented, with a line end.
pub(super) fn json(summary: &impl Serialize) -> Result<Vec<u8>, ReportError> {
    let mut bytes = serde_json::to_vec_pretty(summary).map_err(|error| ReportError::Table {
        name: "summary.json",
        reason: error.to_string(),
    })?;
    bytes.push(b'\n');
    Ok(bytes)
}
