//! What a simulation prints at its end.

use crate::quantity::{Dimension, format_human};
use crate::report::fit;
use crate::report::number::with_error;
use crate::report::quantities::{Column, HISTORY, Moment};
use crate::report::samples;
use crate::report::terminal;
use crate::report::text::{Column as Shown, Table, Text};
use crate::report::words;
use crate::simulation::body_material::BodyMaterial;
use crate::simulation::cycles::HistoryCycle;
use crate::simulation::outside_model;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::work::HistoryWork;
use crate::simulation::{SimulationEnd, SimulationOutcome};

/// Title, material where it comes from a table, extent of the history, its largest contact and its end, with errors.
pub fn text(plan: &ScenarioPlan, outcome: &SimulationOutcome) -> Text {
    let mut text = Text::from(format!("{}\n\n", plan.title));
    let material = match &plan.contact.material {
        BodyMaterial::Series(material) => fit::origin(material),
        BodyMaterial::Samples(sampled) => samples::text(sampled, plan.drive.duration_s()),
    };
    if !material.is_empty() {
        text.append(material);
        text.blank();
    }
    if outcome.rows.is_empty() {
        text.line("Interrupted before the first time step.");
        return text;
    }
    if outcome.ended == SimulationEnd::Interrupted {
        let duration = format_human(plan.drive.duration_s(), Dimension::Time, 4);
        text.line(format!("Interrupted: the history was to last {duration}."));
    }
    text.append(extremes(outcome));
    if let Some(work) = HistoryWork::of(plan, outcome) {
        text.blank();
        text.paragraph(format!("Work of the indenter: {}.", words::work(&work)));
    }
    if let Some(separation) = &outcome.separation {
        text.paragraph(words::separation(separation));
    }
    let enlarged = match outcome.domain_enlarged {
        0 => String::new(),
        n => format!(", domain enlarged {n} times"),
    };
    text.append(format!(
        "\n{} time steps, {} engine{enlarged}",
        outcome.rows.len(),
        plan.solver.engine.name(),
    ));
    text.append(cycles(outcome));
    text.append_apart(terminal::warned(outside_model::warnings(plan, outcome)));
    if let Some(why) = &outcome.errors_missing {
        text.line(format!("Without errors: {why}."));
    }
    text
}

/// The largest contact and the end, each with its errors below.
fn extremes(outcome: &SimulationOutcome) -> Table {
    let moments: Vec<Moment> = Moment::all(outcome).collect();
    let radius_m = |moment: &&Moment| moment.row.contact_radius_m;
    // Of equals the first.
    let wider = |a, b| if radius_m(&b) > radius_m(&a) { b } else { a };
    let headings = columns().map(|column| Shown::right(column.heading, 12));
    let first = [Shown::left("", 8), Shown::right("time", 13)];
    let mut table = Table::new(1, first.into_iter().chain(headings));
    for (name, moment) in [
        ("widest", moments.iter().reduce(wider)),
        ("last", moments.last()),
    ] {
        let Some(moment) = moment else { continue };
        let mut row =
            |name: &str, time: String, value: &dyn Fn(&Column<Moment>) -> Option<f64>, digits| {
                let cell = |column: &'static Column<Moment>| {
                    let value = value(column).zip(column.dimension);
                    let value =
                        value.map(|(value, dimension)| format_human(value, dimension, digits));
                    value.unwrap_or_else(|| "-".to_owned())
                };
                table.row(
                    [name.to_owned(), time]
                        .into_iter()
                        .chain(columns().map(cell)),
                );
            };
        let time = format_human(moment.row.time_s, Dimension::Time, 4);
        row(name, time, &|column| column.number(moment), 4);
        if !outcome.errors.is_empty() {
            row("", "±".to_owned(), &|column| column.error(moment), 2);
        }
    }
    table
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

/// What a moment has with an error; the work is one of the whole history.
fn columns() -> impl Iterator<Item = &'static Column<Moment>> {
    HISTORY
        .iter()
        .filter(|column| column.error_name().is_some() && column.name != "work_j")
}
