//! The table of all cases: the numbers most asked for, to five digits, errors to two; the script knows the other columns.

use maud::{Markup, html};
use serde::Serialize;

use crate::quantity::Dimension;
use crate::report::number::{cell, digits, largest, prefix};
use crate::report::quantities::all_of_cases;
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
    /// Values in SI units; in the table a unit has the prefix that suits the largest, angles but for those of an axis are in
    /// degrees.
    fn new(
        name: &str,
        heading: &str,
        dimension: Option<Dimension>,
        digits: Option<usize>,
        values: Vec<Option<f64>>,
    ) -> Self {
        let (factor, unit) = match dimension {
            None => (1.0, String::new()),
            Some(Dimension::Angle) if digits.is_some() => (1_f64.to_degrees(), " / °".to_owned()),
            Some(dimension) => {
                let largest = largest(values.iter().flatten().map(|v| v.abs()));
                let (factor, prefix) = prefix(largest);
                (factor, format!(" / {prefix}{}", dimension.si_unit()))
            }
        };
        let values = values.into_iter();
        Self {
            name: name.to_owned(),
            heading: format!("{heading}{unit}"),
            digits,
            factor,
            values: values.map(|v| v.map(|v| v * factor)).collect(),
            names: Vec::new(),
        }
    }

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

fn columns(plan: &SweepPlan, records: &[CaseRecord]) -> Vec<Column> {
    let unit = plan.figures.frequency_unit;
    let heading = format!("{} / {}", unit.symbol(), unit.name().replace("/s", "·s⁻¹"));
    let numbers = |value: &dyn Fn(&CaseRecord) -> Option<f64>| records.iter().map(value).collect();
    let frequencies = numbers(&|r| Some(unit.of(r.angular_frequency_rad_per_s)));
    let mut columns = vec![Column::new(
        unit.column(),
        &heading,
        None,
        None,
        frequencies,
    )];
    for (axis, varied) in (plan.axes.iter()).flat_map(|axes| axes.over.iter().enumerate()) {
        let (name, heading) = (varied.column(), varied.name());
        let values: Vec<_> = numbers(&|r| Some(r.varied.get(axis)?.as_number()));
        let name_of = |r: &CaseRecord| Some(varied.block_name(r.varied.get(axis)?)?.to_owned());
        columns.push(Column {
            names: records.iter().filter_map(name_of).collect(),
            ..Column::new(&name, &heading, varied.dimension, None, values)
        });
    }
    for known in all_of_cases(plan.is_attracted()) {
        let Some(heading) = known.in_cases else {
            continue;
        };
        let values: Vec<_> = numbers(&|r| known.number(r));
        // Most materials have no replicas.
        if known.name == "energy_loss_material_error_j" && values.iter().all(Option::is_none) {
            continue;
        }
        let (dimension, digits) = (known.dimension, known.dimension.map(|_| 5));
        columns.push(Column::new(known.name, heading, dimension, digits, values));
        // Of the errors that of the loss has a column here.
        if let (Some(Dimension::Energy), Some(name)) = (dimension, known.error_name()) {
            let errors = numbers(&|r| known.error(r));
            columns.push(Column::new(&name, "its error", dimension, Some(2), errors));
        }
    }
    columns
}
