//! The table of all cases: the numbers most asked for, to five digits, errors to two; the script knows the other columns.

use std::fmt::Write;

use maud::Render;

use crate::report::figure::prefix;
use crate::report::number::{cell, digits};
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::CaseRecord;
use crate::sweep::record::error_bars::Quantity;
use crate::sweep::search::run::Outcome;

/// A column: its name in sweep.csv, its heading, its SI unit where it takes a prefix, and its value.
struct Column {
    name: &'static str,
    heading: String,
    unit: Option<&'static str>,
    /// Significant digits, or as few as there are.
    digits: Option<usize>,
    value: Box<Value>,
}

/// A column's value of a case, where it has one.
type Value = dyn Fn(&CaseRecord) -> Option<f64>;

/// The table.
pub(super) fn table(plan: &SweepPlan, outcome: &Outcome) -> String {
    let columns = columns(plan);
    let records = &outcome.records;
    let mut html = String::from("<table id=\"cases\">\n<thead><tr>");
    let mut factors = Vec::with_capacity(columns.len());
    for column in &columns {
        let values = records.iter().filter_map(|r| (column.value)(r));
        let largest = values.fold(0.0_f64, |a, v| a.max(v.abs()));
        let (factor, unit) = match column.unit {
            Some(unit) => {
                let (factor, prefix) = prefix(largest);
                (factor, format!(" / {prefix}{unit}"))
            }
            None => (1.0, String::new()),
        };
        factors.push(factor);
        // Writing to a String cannot fail.
        let _ = write!(
            html,
            "<th scope=\"col\" data-column=\"{}\">{}{unit}</th>",
            column.name,
            column.heading.render().into_string()
        );
    }
    html.push_str("<th scope=\"col\" class=\"text\" data-column=\"status\">status</th></tr></thead>\n<tbody>\n");
    for record in records {
        let _ = write!(html, "<tr data-index=\"{}\">", record.index);
        for (k, (column, factor)) in columns.iter().zip(&factors).enumerate() {
            let value = (column.value)(record).map(|v| v * factor);
            let text = match column.digits {
                Some(significant) => digits(value, significant),
                None => cell(value),
            };
            let _ = match k {
                0 => write!(html, "<th scope=\"row\">{text}</th>"),
                _ => write!(html, "<td>{text}</td>"),
            };
        }
        let _ = writeln!(
            html,
            "<td class=\"text\">{}</td></tr>",
            record.status.name()
        );
    }
    html.push_str("</tbody>\n</table>");
    html
}

fn columns(plan: &SweepPlan) -> Vec<Column> {
    let column = |name, heading: &str, unit, value: fn(&CaseRecord) -> Option<f64>| Column {
        name,
        heading: heading.to_owned(),
        unit,
        digits: None,
        value: Box::new(value),
    };
    let quantity = |quantity: Quantity, heading: &str, unit| Column {
        name: quantity.columns().0,
        heading: heading.to_owned(),
        unit,
        digits: Some(5),
        value: Box::new(move |r: &CaseRecord| quantity.of(r.result.as_ref()?)),
    };
    let mut columns = vec![column(
        "angular_frequency_rad_per_s",
        "ω / rad·s⁻¹",
        None,
        |r| Some(r.angular_frequency_rad_per_s),
    )];
    if let Some(axis) = &plan.axis {
        use crate::sweep::plan::Varied;
        let unit = Some(plan.drive.control().unit());
        columns.push(match axis.varied {
            Varied::Amplitude => column("drive_amplitude", "amplitude", unit, |r| {
                Some(r.drive_amplitude)
            }),
            Varied::Mean => column("drive_mean", "mean", unit, |r| Some(r.drive_mean)),
        });
    }
    columns.extend([
        quantity(Quantity::EnergyLoss, "loss per cycle", Some("J")),
        Column {
            digits: Some(2),
            ..column("energy_loss_error_j", "its error", Some("J"), |r| {
                r.energy_loss_error_j()
            })
        },
        Column {
            digits: Some(5),
            ..column("phase_lag_rad", "phase lag / °", None, |r| {
                Some(r.result.as_ref()?.analysis.phase_lag_rad.to_degrees())
            })
        },
        quantity(Quantity::StorageModulus, "E′", Some("Pa")),
        quantity(Quantity::LossModulus, "E″", Some("Pa")),
        quantity(Quantity::ApproachMax, "largest approach", Some("m")),
        quantity(Quantity::ContactRadiusMax, "largest radius", Some("m")),
        quantity(Quantity::PeakPressureMax, "largest pressure", Some("Pa")),
        column("cycles", "cycles", None, |r| Some(r.cycles as f64)),
    ]);
    columns
}
