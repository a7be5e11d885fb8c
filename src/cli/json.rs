//! `--format json`: what a command has found, as one JSON object on standard output. An absent value is null.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::{Ended, Failure, write_out};
use crate::engine::EngineKind;
use crate::material::Material;
use crate::material::fit::{Fit, FitReport};
use crate::report::comparison::Comparison;
use crate::report::machine;
use crate::report::material::MaterialReport;
use crate::report::table::Cell;
use crate::sweep::case::Setup;
use crate::sweep::plan::{AxisValues, SweepPlan, resolved};
use crate::sweep::share::cost::Cost;

/// Prints one object.
pub(super) fn print(value: &Value) -> Result<Ended, Failure> {
    let text = serde_json::to_string_pretty(value).map_err(Failure::run)?;
    write_out(&(text + "\n"))
}

/// A JSON file that was written.
pub(super) fn file(path: &Path) -> Result<Value, Failure> {
    let failed = |why: String| Failure::run(format!("cannot read {}: {why}", path.display()));
    let bytes = fs::read(path).map_err(|error| failed(error.to_string()))?;
    serde_json::from_slice(&bytes).map_err(|error| failed(error.to_string()))
}

/// The values of axes, blocks of a list by their names; of one axis alone its value, of none nothing.
fn varied(plan: &SweepPlan, values: &AxisValues) -> Value {
    let over = plan.axes.iter().flat_map(|axes| &axes.over);
    let values = over.zip(values.all());
    let told = values.map(|(varied, value)| machine::value(Cell::of_axis(varied, Some(*value))));
    let mut told: Vec<_> = told.collect();
    match told.len() {
        0 | 1 => told.pop().unwrap_or_default(),
        _ => told.into(),
    }
}

/// What a sweep would compute, and what that costs.
pub(super) fn plan(setup: &Setup, cost: &Cost) -> Value {
    let plan = setup.plan();
    let own = plan.base.contact.indenter.own_cells();
    let (springs, cells) = match (plan.solver.engine, own) {
        (EngineKind::Axisymmetric, _) => (Some(plan.solver.springs), None),
        (EngineKind::HalfSpace, Some((x, y))) => (None, Some([x, y])),
        (EngineKind::HalfSpace, None) => (None, Some([plan.solver.cells; 2])),
    };
    let cases = cost.cases.iter().map(|case| {
        json!({
            "index": case.case.index,
            "angular_frequency_rad_per_s": case.case.angular_frequency_rad_per_s,
            "varied": varied(plan, &case.case.condition.values),
            "drive_mean": case.case.condition.drive.mean(),
            "drive_amplitude": case.case.condition.drive.amplitude(),
            "cycles": case.cycles,
            "time_s": case.time_s,
        })
    });
    json!({
        "title": plan.title,
        "engine": plan.solver.engine.name(),
        "springs": springs,
        "cells": cells,
        "steps_per_cycle": plan.cycle.steps,
        "cases": cases.collect::<Vec<_>>(),
        "time_on_one_thread_s": cost.on_threads_s(1),
        "time_of_peaks_s": cost.peaks_s,
        "time_of_figures_s": cost.report_s,
        "disk_bytes": cost.disk_bytes,
        "time_per_step_s": cost.step_s,
        "memory_per_thread_bytes": cost.memory_bytes,
        "memory_of_results_bytes": cost.results_bytes,
        "useful_shards": cost.shards(),
    })
}

/// What a comparison found.
pub(super) fn comparison(comparison: &Comparison) -> Value {
    let mut value = json!(comparison);
    value["differs"] = comparison.differs().into();
    value["verdict"] = comparison.verdict().into();
    value
}

/// A material: its series both ways, moduli over frequency, peaks of its losses, its fit where it has one.
pub(super) fn material(material: &Material) -> Result<Value, Failure> {
    let peaks = material.loss_peaks(material.kind());
    Ok(json!({
        "name": material.name(),
        "poisson_ratio": material.poisson_ratio(),
        "bulk_modulus_pa": material.compressibility().constant_bulk_modulus_pa(),
        "modulus": material.kind().name(),
        "relaxation": material.relaxation(),
        "creep": material.creep(),
        "moduli": MaterialReport::new(material).moduli(10),
        "peaks": peaks.map_err(Failure::input)?,
        "fit": material.origin.fit.as_ref().map(fit_report),
        "approximation": material.origin.approximation.as_ref(),
        "material_toml": resolved::material_text(material),
    }))
}

/// A fit to a table, with the material that it makes.
pub(super) fn fit(fit: &Fit, made: &Material) -> Result<Value, Failure> {
    let mut value = material(made)?;
    value["fit"] = fit_report(fit.report());
    Ok(value)
}

fn fit_report(report: &FitReport) -> Value {
    let remarks = report
        .remarks
        .iter()
        .map(|remark| json!({ "text": remark.to_string(), "is_warning": remark.is_warning() }));
    json!({
        "samples": report.samples,
        "first_s": report.first_s,
        "last_s": report.last_s,
        "branches": report.branches,
        "relative_misfit": report.misfit,
        "remarks": remarks.collect::<Vec<_>>(),
    })
}
