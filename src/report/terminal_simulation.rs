//! What a simulation prints at its end. At most 80 columns.

use std::fmt::Write;

use crate::quantity::{Dimension, format_human};
use crate::report::{fit, samples, terminal};
use crate::sweep::body_material::BodyMaterial;
use crate::sweep::scenario::ScenarioPlan;
use crate::sweep::simulate::{HistoryRow, SimulationEnd, SimulationOutcome};
use crate::sweep::warnings;

/// Title, material where it comes from a table, extent of the history, its largest contact and its end.
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
    if let Some(widest) = outcome.rows.iter().reduce(wider) {
        line(&mut text, "widest", widest);
    }
    line(&mut text, "last", last);
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
    let warnings = terminal::warned(warnings::of_history(plan, outcome));
    if !warnings.is_empty() {
        let _ = write!(text, "\n{warnings}");
    }
    if outcome.damped_throughout {
        text.push_str(
            "Time steps are long beside the shortest relaxation time and were damped;\n\
             a shorter [time] step gives sharper pressures at the contact's edge.\n",
        );
    }
    text
}

fn line(text: &mut String, name: &str, row: &HistoryRow) {
    let human = |value: f64, dimension| format_human(value, dimension, 4);
    let or_dash = |value: Option<f64>, dimension| match value {
        Some(value) => human(value, dimension),
        None => "-".to_owned(),
    };
    let _ = writeln!(
        text,
        "{name:<8}{:>14} {:>12} {:>12} {:>12} {:>12}",
        human(row.time_s, Dimension::Time),
        human(row.load_n, Dimension::Force),
        or_dash(row.approach_m, Dimension::Length),
        human(row.contact_radius_m, Dimension::Length),
        or_dash(row.peak_pressure_pa, Dimension::Stress),
    );
}
