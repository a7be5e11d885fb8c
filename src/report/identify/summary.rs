//! `summary.json` of an identification.

use serde_json::{Map, Value, json};

use super::{IdentifyReport, dimension, tables};
use crate::identify::data::Datum;
use crate::identify::{CellError, Identified, Knowledge};
use crate::report::laws;

/// The summary as an object; what is undefined is null.
pub fn summary(report: &IdentifyReport<'_>) -> Value {
    let found = report.found;
    let measured = &report.plan.measurements;
    let unknowns = found.unknowns.iter().map(|unknown| {
        json!({
            "name": unknown.name,
            "value": unknown.value,
            "unit": dimension(unknown).si_unit(),
            "low": unknown.value / unknown.factor,
            "high": unknown.value * unknown.factor,
            "determined": unknown.is_determined,
        })
    });
    let candidates = found.candidates.iter().map(|c| {
        json!({
            "branches": c.branches,
            "chi_squared": c.chi_squared,
            "akaike": c.akaike,
            "schwarz": c.schwarz,
            "weight": c.weight,
            "two_times_are_one": c.has_close_times,
        })
    });
    let columns = measured.numbers().into_iter().map(
        |number| json!({ "column": number.column(), "relative_error": report.noise_of(number) }),
    );
    let undetermined = found.undetermined.iter().map(|open| {
        let powers = open
            .parts
            .iter()
            .map(|(name, power)| json!({ "name": name, "power": power }));
        json!({ "factor": open.factor, "powers": powers.collect::<Vec<_>>() })
    });
    let read = &report.plan.columns;
    let set_aside = read.set_aside.iter();
    let set_aside = set_aside.map(|(column, why)| json!({ "column": column, "reason": why }));
    let summary = json!({
        "title": report.plan.title,
        "of": if measured.is_history() { "history" } else { "cycles" },
        "numbers": found.compared.len(),
        "columns": columns.collect::<Vec<_>>(),
        "columns_read": read.read,
        "columns_set_aside": set_aside.collect::<Vec<_>>(),
        "columns_not_understood": report.not_understood(),
        "errors": match found.knowledge {
            Knowledge::All => "given",
            Knowledge::Some => "given-in-part",
            Knowledge::None => "estimated",
        },
        "branches": found.relaxation.branches().len(),
        "branches_asked": report.plan.branches,
        "equilibrium_modulus_pa": found.relaxation.equilibrium_modulus(),
        "poisson_ratio": report.plan.contact.material.compressibility.poisson_ratio(),
        "bulk_modulus_pa": report.plan.contact.material.compressibility.constant_bulk_modulus_pa(),
        "unknowns": unknowns.collect::<Vec<_>>(),
        "correlations": found.correlations,
        "singular_values": found.singular_values,
        "undetermined": undetermined.collect::<Vec<_>>(),
        "candidates": candidates.collect::<Vec<_>>(),
        "reduced_chi_squared": found.reduced_chi_squared,
        "intervals_widened_by": found.inflation,
        "worst": worst(found),
        "degrees_of_freedom": found.degrees_of_freedom,
        "change_with_twice_the_cells": match found.cell_error {
            Some(CellError::Included(change) | CellError::Negligible(change)) => Some(change),
            Some(CellError::Unknown) | None => None,
        },
        "window_rad_per_s": found.window_rad_per_s,
        "moduli": moduli(report),
        "ensemble": found.ensemble.len(),
        "notes": measured.notes(),
        "warnings": report.warnings(),
        "program": env!("CARGO_PKG_NAME"),
        "program_version": env!("CARGO_PKG_VERSION"),
    });
    laws::extended(summary, found.laws.as_ref().map(laws::summary))
}

/// The number that is missed by the most of its errors.
fn worst(found: &Identified) -> Option<Value> {
    let (worst, times) = found.worst()?;
    Some(json!({
        "column": worst.number.column(),
        "row": worst.row,
        "errors": times,
        "left_out": found.left_out.is_some(),
    }))
}

/// The moduli with their bands at every frequency of the data.
fn moduli(report: &IdentifyReport<'_>) -> Vec<Map<String, Value>> {
    let measured = &report.plan.measurements;
    let data = measured.data().iter();
    let mut omegas: Vec<f64> = data.map(Datum::angular_frequency).collect();
    omegas.sort_by(f64::total_cmp);
    omegas.dedup();
    let found = report.found;
    let moduli = omegas
        .into_iter()
        .map(|omega| tables::row(omega, &found.band(omega), found.window_rad_per_s));
    moduli.collect()
}
