//! The table of all cases: the numbers most asked for, to five digits, errors to two; the script knows the other columns.

use maud::{Markup, html};
use serde::Serialize;

use crate::quantity::Dimension;
use crate::report::number::{cell, digits, largest, prefix};
use crate::report::quantities::SWEEP;
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::CaseRecord;
use crate::sweep::search::run::Outcome;

/// A column: its name in sweep.csv, its heading with its unit, and its values, case by case.
struct Column {
    name: String,
    heading: String,
    /// Significant digits, or as few as there are.
    digits: Option<usize>,
    /// From the unit of `sweep.csv` to that of the heading.
    factor: f64,
    /// In the unit of the heading.
    values: Vec<Option<f64>>,
    /// In place of the values, where these are names.
    names: Vec<String>,
}

/// How the script shows a column: its name in `sweep.csv`, the factor to the unit of its heading, and its digits.
#[derive(Serialize)]
pub(super) struct ShownColumn(String, f64, Option<usize>);

/// Rows that the table of a large sweep has before its script turns the page.
const ROWS: usize = 50;

/// The columns as the script shows them.
pub(super) fn shown(plan: &SweepPlan, outcome: &Outcome) -> Vec<ShownColumn> {
    let columns = columns(plan, &outcome.records).into_iter();
    columns
        .map(|column| ShownColumn(column.name, column.factor, column.digits))
        .collect()
}

/// The table.
pub(super) fn table(plan: &SweepPlan, outcome: &Outcome) -> Markup {
    let columns = columns(plan, &outcome.records);
    let rows = match plan.is_small() {
        true => outcome.records.len(),
        false => ROWS,
    };
    html! {
        table id="cases" {
            thead {
                tr {
                    @for column in &columns {
                        th scope="col" data-column=(column.name) { (column.heading) }
                    }
                    th scope="col" class="text" data-column="status" { "status" }
                }
            }
            tbody {
                @for (place, record) in outcome.records.iter().enumerate().take(rows) {
                    tr data-index=(record.index) {
                        @for (k, column) in columns.iter().enumerate() {
                            @if k == 0 {
                                th scope="row" { (column.text(place)) }
                            } @else {
                                td { (column.text(place)) }
                            }
                        }
                        td class="text" { (record.status.name()) }
                    }
                }
            }
        }
    }
}

impl Column {
    fn text(&self, case: usize) -> String {
        if let Some(name) = self.names.get(case) {
            return name.clone();
        }
        let value = self.values.get(case).copied().flatten();
        match self.digits {
            Some(significant) => digits(value, significant),
            None => cell(value),
        }
    }
}

/// A column of bare numbers, or of numbers in the unit of the heading.
fn bare(name: &str, heading: &str, values: Vec<Option<f64>>) -> Column {
    Column {
        name: name.to_owned(),
        heading: heading.to_owned(),
        digits: None,
        factor: 1.0,
        values,
        names: Vec::new(),
    }
}

fn columns(plan: &SweepPlan, records: &[CaseRecord]) -> Vec<Column> {
    let unit = plan.figures.frequency_unit;
    // A unit that takes a prefix gets the one that suits the largest value.
    let column = |name: &str, heading: &str, si: &str, digits, values: Vec<Option<f64>>| {
        let (factor, prefix) = prefix(largest(values.iter().flatten().map(|v| v.abs())));
        let (factor, heading) = match si {
            "" => (1.0, heading.to_owned()),
            si => (factor, format!("{heading} / {prefix}{si}")),
        };
        Column {
            digits,
            factor,
            ..bare(
                name,
                &heading,
                values.iter().map(|v| v.map(|v| v * factor)).collect(),
            )
        }
    };
    let numbers = |value: &dyn Fn(&CaseRecord) -> Option<f64>| records.iter().map(value).collect();
    let mut columns = vec![bare(
        unit.column(),
        &format!("{} / {}", unit.symbol(), unit.name().replace("/s", "·s⁻¹")),
        numbers(&|r| Some(unit.of(r.angular_frequency_rad_per_s))),
    )];
    for (axis, varied) in plan
        .axes
        .iter()
        .flat_map(|axes| axes.over.iter().enumerate())
    {
        let si = varied.dimension.map_or("", Dimension::si_unit);
        let (name, heading) = (varied.column(), varied.name());
        let values = numbers(&|r| r.varied.get(axis));
        let name_of = |value: &Option<f64>| Some(varied.block_name((*value)?)?.to_owned());
        columns.push(Column {
            names: values.iter().filter_map(name_of).collect(),
            ..column(&name, &heading, si, None, values)
        });
    }
    let shown = SWEEP.iter().filter_map(|c| Some((c, c.in_cases?)));
    for (known, heading) in shown {
        let values: Vec<Option<f64>> = numbers(&|r| known.number(r));
        // Most materials have no replicas.
        if known.name == "energy_loss_material_error_j" && values.iter().all(Option::is_none) {
            continue;
        }
        match known.dimension {
            None => columns.push(bare(known.name, heading, values)),
            Some(Dimension::Angle) => columns.push(Column {
                digits: Some(5),
                factor: 1_f64.to_degrees(),
                ..bare(
                    known.name,
                    &format!("{heading} / °"),
                    values
                        .into_iter()
                        .map(|v: Option<f64>| v.map(f64::to_degrees))
                        .collect(),
                )
            }),
            Some(dimension) => {
                columns.push(column(
                    known.name,
                    heading,
                    dimension.si_unit(),
                    Some(5),
                    values,
                ));
            }
        }
        // Of the errors that of the loss has a column here.
        if let (Some(Dimension::Energy), Some(name)) = (known.dimension, known.error_name()) {
            let values = numbers(&|r| known.error(r));
            columns.push(column(&name, "its error", "J", Some(2), values));
        }
    }
    columns
}
