//! `--format json`: what a command has found, as one JSON object on standard output. An absent value is null.

use std::fs;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::{Ended, Failure, write_out};
use crate::material::fit::{Fit, FitReport};
use crate::material::library::LibraryEntry;
use crate::material::{LossPeak, Material, ModulusKind};
use crate::report::comparison::{Comparison, Place};
use crate::report::material::MaterialReport;
use crate::sweep::case::Setup;
use crate::sweep::plan::{EngineKind, resolved};
use crate::sweep::share::cost::Cost;

/// Prints one object.
pub(super) fn print(value: &Value) -> Result<Ended, Failure> {
    let text = serde_json::to_string_pretty(value).map_err(Failure::run)?;
    write_out(&(text + "\n"))
}

/// The rows of a table that was written, as objects: numbers where a cell is one, text elsewhere, null where it is empty.
pub(super) fn rows_of(file: &Path) -> Result<Vec<Value>, Failure> {
    let name = file.display();
    let failed = |error: csv::Error| Failure::run(format!("cannot read {name}: {error}"));
    let mut reader = csv::Reader::from_path(file).map_err(failed)?;
    let columns = reader.headers().map_err(failed)?.clone();
    let rows = reader.records().map(|row| {
        let row = row.map_err(failed)?;
        let cells = columns.iter().zip(&row);
        let object: Map<_, _> = cells
            .map(|(c, cell)| (c.to_owned(), value_of(cell)))
            .collect();
        Ok(Value::Object(object))
    });
    rows.collect()
}

fn value_of(cell: &str) -> Value {
    let number = || cell.parse::<f64>().ok().filter(|number| number.is_finite());
    match cell {
        "" => Value::Null,
        _ => number().map_or_else(|| Value::from(cell), Value::from),
    }
}

/// A JSON file that was written.
pub(super) fn file(path: &Path) -> Result<Value, Failure> {
    let failed = |why: String| Failure::run(format!("cannot read {}: {why}", path.display()));
    let bytes = fs::read(path).map_err(|error| failed(error.to_string()))?;
    serde_json::from_slice(&bytes).map_err(|error| failed(error.to_string()))
}

/// What a sweep would compute, and what that costs.
pub(super) fn plan(setup: &Setup, cost: &Cost) -> Value {
    let plan = setup.plan();
    let own = plan.indenter.own_cells();
    let (springs, cells) = match (plan.solver.engine, own) {
        (EngineKind::Axisymmetric, _) => (Some(plan.solver.springs), None),
        (EngineKind::HalfSpace, Some((x, y))) => (None, Some([x, y])),
        (EngineKind::HalfSpace, None) => (None, Some([plan.solver.cells; 2])),
    };
    let cases = cost.cases.iter().map(|case| {
        json!({
            "index": case.case.index,
            "angular_frequency_rad_per_s": case.case.angular_frequency_rad_per_s,
            "drive_mean": case.case.drive.mean(),
            "drive_amplitude": case.case.drive.amplitude(),
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
        "time_on_one_thread_s": cost.time_s(),
        "time_per_step_s": cost.step_s,
        "memory_per_thread_bytes": cost.memory_bytes,
        "useful_shards": cost.shards(),
    })
}

/// What a comparison found.
pub(super) fn comparison(comparison: &Comparison) -> Value {
    let place = |place: &Place| {
        json!({
            "angular_frequency_rad_per_s": place.angular_frequency_rad_per_s,
            "drive_mean": place.drive_mean,
            "drive_amplitude": place.drive_amplitude,
        })
    };
    let places = |places: &[Place]| places.iter().map(place).collect::<Vec<_>>();
    let columns = comparison.columns.iter().map(|column| {
        json!({
            "name": column.name,
            "largest_relative_difference": column.largest.map(|(difference, _)| difference),
            "largest_at": column.largest.as_ref().map(|(_, at)| place(at)),
            "cases_beyond_tolerance": column.beyond,
            "cases_within_error_bars": column.within_bars,
            "cases_absent_in_one": column.absent,
            "cases_different": column.different,
        })
    });
    let statuses = comparison
        .statuses
        .iter()
        .map(|(at, baseline, new)| json!({ "case": place(at), "baseline": baseline, "new": new }));
    let peaks = comparison
        .peaks
        .iter()
        .map(|peak| json!({ "baseline": peak.baseline, "new": peak.new, "differs": peak.differs }));
    json!({
        "differs": comparison.differs(),
        "cases_compared": comparison.compared,
        "cases_missing": places(&comparison.missing),
        "cases_added": places(&comparison.added),
        "columns_missing": comparison.missing_columns,
        "columns_added": comparison.added_columns,
        "statuses": statuses.collect::<Vec<_>>(),
        "columns": columns.collect::<Vec<_>>(),
        "peaks": peaks.collect::<Vec<_>>(),
    })
}

/// An entry of the library.
pub(super) fn entry(entry: &LibraryEntry) -> Value {
    json!({
        "name": entry.name,
        "title": entry.title,
        "notes": entry.notes,
        "source": entry.source,
        "measured_window_s": entry.measured_window_s,
    })
}

/// A material: its series both ways, moduli over frequency, peaks of its losses, its fit where it has one.
pub(super) fn material(material: &Material) -> Result<Value, Failure> {
    let kind = match material.kind() {
        ModulusKind::Longitudinal => "longitudinal",
        ModulusKind::Shear => "shear",
    };
    let relaxation = material.relaxation().map(|relaxation| {
        let branches = relaxation.branches().iter();
        let branches = branches.map(|b| json!({ "modulus_pa": b.modulus_pa, "time_s": b.time_s }));
        json!({
            "equilibrium_modulus_pa": relaxation.equilibrium_modulus(),
            "branches": branches.collect::<Vec<_>>(),
        })
    });
    let creep = material.creep();
    let branches = creep.branches().iter();
    let branches =
        branches.map(|b| json!({ "compliance_per_pa": b.compliance_per_pa, "time_s": b.time_s }));
    let moduli = MaterialReport::new(material)
        .moduli(10)
        .into_iter()
        .map(|point| {
            json!({
                "angular_frequency_rad_per_s": point.angular_frequency_rad_per_s,
                "storage_modulus_pa": point.storage_modulus_pa,
                "loss_modulus_pa": point.loss_modulus_pa,
                "storage_compliance_per_pa": point.storage_compliance_per_pa,
                "loss_compliance_per_pa": point.loss_compliance_per_pa,
            })
        });
    let peaks = material
        .loss_peaks(material.kind())
        .map_err(Failure::input)?;
    let listed = |peaks: &[LossPeak], value: &str| -> Vec<Value> {
        let each = |peak: &LossPeak| json!({ "angular_frequency_rad_per_s": peak.angular_frequency_rad_per_s, value: peak.value });
        peaks.iter().map(each).collect()
    };
    Ok(json!({
        "name": material.name(),
        "poisson_ratio": material.poisson_ratio(),
        "modulus": kind,
        "relaxation": relaxation,
        "creep": {
            "instantaneous_compliance_per_pa": creep.instantaneous_compliance(),
            "branches": branches.collect::<Vec<_>>(),
            "viscosity_pa_s": creep.viscosity_pa_s(),
        },
        "moduli": moduli.collect::<Vec<_>>(),
        "peaks": {
            "loss_modulus": listed(&peaks.loss_modulus, "loss_modulus_pa"),
            "loss_compliance": listed(&peaks.loss_compliance, "loss_compliance_per_pa"),
            "loss_tangent": listed(&peaks.loss_tangent, "loss_tangent"),
        },
        "fit": material.fit().map(fit_report),
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
        "relative_misfit_rms": report.misfit.rms,
        "relative_misfit_largest": report.misfit.largest,
        "relative_misfit_largest_at_s": report.misfit.largest_at_s,
        "remarks": remarks.collect::<Vec<_>>(),
    })
}
