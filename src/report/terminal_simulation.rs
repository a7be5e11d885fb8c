//! What a simulation prints at its end. At most 80 columns.

use std::fmt::Write;

use crate::quantity::{Dimension, format_human};
use crate::report::fit;
use crate::report::number::with_error;
use crate::report::quantities::{Column, HISTORY, Moment};
use crate::report::samples;
use crate::report::terminal;
use crate::simulation::body_material::BodyMaterial;
use crate::simulation::cycles::HistoryCycle;
use crate::simulation::outside_model;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::{SimulationEnd, SimulationOutcome};

/// Title, material where it comes from a table, extent of the history, its largest contact and its end, with errors.
pub fn text(plan: &ScenarioPlan, outcome: &SimulationOutcome) -> String {
    let mut text = format!("{}\n\n", plan.title);
    let material = match &plan.contact.material {
        BodyMaterial::Series(material) if material.origin.approximation.is_some() => {
            Some(fit::approximation(material))
        }
        BodyMaterial::Series(material) => fit::fitted(material),
        BodyMaterial::Samples(sampled) => Some(samples::text(sampled, plan.drive.duration_s())),
    };
    if let Some(material) = material {
        let _ = writeln!(text, "{material}");
    }
    if outcome.rows.is_empty() {
        text.push_str("Interrupted before the first time step.\n");
        return text;
    }
    if outcome.ended == SimulationEnd::Interrupted {
        let duration = format_human(plan.drive.duration_s(), Dimension::Time, 4);
        // Writing to a String cannot fail.
        let _ = writeln!(text, "Interrupted: the history was to last {duration}.");
    }
    let headings: String = columns()
        .map(|column| format!(" {:>12}", column.heading))
        .collect();
    let _ = writeln!(text, "{:>22}{headings}", "time");
    let moments: Vec<Moment> = Moment::all(outcome).collect();
    let radius_m = |moment: &&Moment| moment.row.contact_radius_m;
    // Of equals the first.
    let wider = |a, b| if radius_m(&b) > radius_m(&a) { b } else { a };
    let has_errors = !outcome.errors.is_empty();
    for (name, moment) in [
        ("widest", moments.iter().reduce(wider)),
        ("last", moments.last()),
    ] {
        if let Some(moment) = moment {
            line(&mut text, name, moment, has_errors);
        }
    }
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
    text.push_str(&cycles(outcome));
    let warnings = terminal::warned(outside_model::warnings(plan, outcome));
    if !warnings.is_empty() {
        let _ = write!(text, "\n{warnings}");
    }
    if let Some(why) = &outcome.errors_missing {
        let _ = writeln!(text, "Without errors: {why}.");
    }
    text
}

/// The loss of the first and the last cycle of every sine segment; nothing where there is none.
fn cycles(outcome: &SimulationOutcome) -> String {
    let segments = outcome.cycles.chunk_by(|a, b| a.segment == b.segment);
    let losses = segments.filter_map(|cycles| {
        let loss = |cycle: &HistoryCycle| {
            let numbers = cycle.numbers.as_ref()?;
            let (loss_j, error) = (numbers.analysis.energy_loss_j, cycle.errors.energy_loss_j);
            Some((cycle.number, with_error(loss_j, error, Dimension::Energy)))
        };
        let (first, last) = (cycles.first()?, cycles.last()?);
        let ((first_number, first), (number, last)) = (loss(first)?, loss(last)?);
        let then = match number {
            1 => String::new(),
            _ => format!("\n  cycle {number}: {last}"),
        };
        let segment = cycles.first()?.segment;
        Some(format!(
            "Loss in segment {segment}\n  cycle {first_number}: {first}{then}\n"
        ))
    });
    losses.collect()
}

/// What has an error.
fn columns() -> impl Iterator<Item = &'static Column<Moment>> {
    HISTORY
        .iter()
        .filter(|column| column.error_name().is_some())
}

/// A row, and its errors below it.
fn line(text: &mut String, name: &str, moment: &Moment, has_errors: bool) {
    let cells = |value: &dyn Fn(&Column<Moment>) -> Option<f64>, digits| -> String {
        let cell = |column: &'static Column<Moment>| {
            let value = value(column).zip(column.dimension);
            let value = value.map(|(value, dimension)| format_human(value, dimension, digits));
            format!(" {:>12}", value.as_deref().unwrap_or("-"))
        };
        columns().map(cell).collect()
    };
    let time = format_human(moment.row.time_s, Dimension::Time, 4);
    let values = cells(&|column| column.number(moment), 4);
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{name:<8}{time:>14}{values}");
    if has_errors {
        let errors = cells(&|column| column.error(moment), 2);
        let _ = writeln!(text, "{:<8}{:>14}{errors}", "", "±");
    }
}
