//! What a simulation prints at its end. At most 80 columns.

use std::fmt::Write;

use crate::quantity::{Dimension, format_human};
use crate::report::{fit, samples, terminal};
use crate::sweep::history::errors::RowErrors;
use crate::sweep::history::outside_model;
use crate::sweep::history::{HistoryRow, SimulationEnd, SimulationOutcome};
use crate::sweep::plan::body_material::BodyMaterial;
use crate::sweep::plan::scenario::ScenarioPlan;

/// Title, material where it comes from a table, extent of the history, its largest contact and its end, with errors.
pub fn text(plan: &ScenarioPlan, outcome: &SimulationOutcome) -> String {
    let mut text = format!("{}\n\n", plan.title);
    let material = match &plan.material {
        BodyMaterial::Series(material) => material.fit().map(fit::text),
        BodyMaterial::Samples(sampled) => Some(samples::text(sampled, plan.drive.duration_s())),
    };
    if let Some(material) = material {
        let _ = writeln!(text, "{material}");
    }
    let Some(last) = outcome.rows.last() else {
        text.push_str("Interrupted before the first time step.\n");
        return text;
    };
    if outcome.ended == SimulationEnd::Interrupted {
        let duration = format_human(plan.drive.duration_s(), Dimension::Time, 4);
        // Writing to a String cannot fail.
        let _ = writeln!(text, "Interrupted: the history was to last {duration}.");
    }
    text.push_str("                  time         load     approach       radius     pressure\n");
    let wider = |a, b| {
        let (a, b): (&HistoryRow, &HistoryRow) = (a, b);
        if b.contact_radius_m > a.contact_radius_m {
            b
        } else {
            a
        }
    };
    let place = |row: &HistoryRow| {
        outcome
            .rows
            .iter()
            .position(|other| std::ptr::eq(other, row))
    };
    let errors = |row: &HistoryRow| outcome.errors.get(place(row)?);
    if let Some(widest) = outcome.rows.iter().reduce(wider) {
        line(&mut text, "widest", widest, errors(widest));
    }
    line(&mut text, "last", last, errors(last));
    let _ = writeln!(
        text,
        "\n{} time steps, {} engine{}",
        outcome.rows.len(),
        plan.solver.engine.name(),
        match outcome.domain_enlarged {
            0 => String::new(),
            n => format!(", domain enlarged {n} times"),
        }
    );
    let warnings = terminal::warned(outside_model::warnings(plan, outcome));
    if !warnings.is_empty() {
        let _ = write!(text, "\n{warnings}");
    }
    if let Some(why) = &outcome.errors_missing {
        let _ = writeln!(text, "Without errors: {why}.");
    }
    text
}

/// A row, and its errors below it.
fn line(text: &mut String, name: &str, row: &HistoryRow, errors: Option<&RowErrors>) {
    let or_dash = |value: Option<f64>, dimension, digits| match value {
        Some(value) => format_human(value, dimension, digits),
        None => "-".to_owned(),
    };
    let mut add = |name: &str, time: String, values: [Option<f64>; 4], digits| {
        let dimensions = [
            Dimension::Force,
            Dimension::Length,
            Dimension::Length,
            Dimension::Stress,
        ];
        let mut line = format!("{name:<8}{time:>14}");
        for (value, dimension) in values.into_iter().zip(dimensions) {
            // Writing to a String cannot fail.
            let _ = write!(line, " {:>12}", or_dash(value, dimension, digits));
        }
        let _ = writeln!(text, "{line}");
    };
    let time = format_human(row.time_s, Dimension::Time, 4);
    let radius_m = Some(row.contact_radius_m);
    let values = [
        Some(row.load_n),
        row.approach_m,
        radius_m,
        row.peak_pressure_pa,
    ];
    add(name, time, values, 4);
    if let Some(errors) = errors {
        let values = [
            errors.load_n,
            errors.approach_m,
            errors.contact_radius_m,
            errors.peak_pressure_pa,
        ];
        add("", "+-".to_owned(), values, 2);
    }
}
