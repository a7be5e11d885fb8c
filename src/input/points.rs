//! The points of an axis of a sweep: a list of quantities, one of them, or a range.

use serde_json::{Value as Json, json};

use super::diagnostic::{Diagnostic, Diagnostics};
use super::document::kind::{Asked, Describe};
use super::document::reader::TableReader;
use super::document::schema;
use super::document::tree::Value;
use super::keys::drive::{FROM, POINTS, SPACING, TO};
use crate::quantity::block::Field;
use crate::quantity::key::{Entries, Key, Kind, Number};
use crate::quantity::rows::Rows;
use crate::sweep::plan::SweepPlan;
use contact_dma_core::words;

pub(super) const MOST_POINTS: usize = SweepPlan::MAX_POINTS;

words! {
    pub(crate) enum Spacing {
        Logarithmic = "log",
        Linear = "linear",
    }
}

/// What a JSON Schema says of points of this kind, or of a range with these keys.
pub(super) fn schema(number: &Number, range: &Rows) -> Json {
    let points = json!({ "type": "array", "items": number.schema(), "minItems": 1, "maxItems": MOST_POINTS });
    let mut range = schema::of_table(range);
    for end in [FROM, TO] {
        let means = range["properties"][end.name]["description"].take();
        range["properties"][end.name] = number.schema();
        range["properties"][end.name]["description"] = means;
    }
    json!({ "anyOf": [number.schema(), points, range] })
}

/// Points of this kind, ascending, each once.
pub(super) fn read(asked: &Asked<'_>, number: &Number) -> Result<Vec<f64>, Diagnostics> {
    let Asked { node, spot, .. } = *asked;
    match &node.value {
        Value::Table(table) => spot.read_table(table, node, |table| of_range(table, number)),
        Value::Array(items) if items.is_empty() => {
            let example = format!("{} = [{}]", spot.key.unwrap_or_default(), number.example());
            let problem = Diagnostic::at(&node.location, "the sweep is empty");
            let help = format!("give at least one point, for example {example}");
            Err(problem.help(help).into())
        }
        _ => {
            let distinct = Entries {
                repeats: false,
                ..Entries::of(1..=MOST_POINTS, "")
            };
            let kind = &Kind::Numbers(*number, distinct);
            let mut points = Vec::of(Asked { kind, node, spot }.read()?).unwrap_or_default();
            points.sort_by(f64::total_cmp);
            Ok(points)
        }
    }
}

fn of_range(mut table: TableReader<'_>, number: &Number) -> Option<Vec<f64>> {
    let problems = table.problems();
    let end = |key: Key| Key {
        kind: Kind::Number(*number),
        ..key
    };
    let (from, to) = (table.read(&end(FROM)), table.read(&end(TO)));
    let (points, spacing) = (table.read(&POINTS), table.value(&SPACING));
    table.finish();
    let (from, to, points) = (from?, to?, points?);
    if points.value == 1 && to.value == from.value {
        return Some(vec![from.value]);
    }
    if to.value <= from.value {
        problems
            .at(&to, "the sweep ends before it begins")
            .because("not above the first point")
            .label(&from, "its first point");
        return None;
    }
    if points.value < 2 {
        problems
            .at(&points, "a range needs at least 2 points, its two ends")
            .help("for one point write a list with one entry");
        return None;
    }
    let spacing = spacing?;
    if spacing == Spacing::Logarithmic && from.value <= 0.0 {
        problems
            .at(&from, "points on a logarithmic scale begin above zero")
            .because("zero or below")
            .help("begin above zero, or add spacing = \"linear\" to the range");
        return None;
    }
    Some(spaced(from.value, to.value, points.value, spacing))
}

/// `points` values from `from` to `to`, both exact.
fn spaced(from: f64, to: f64, points: usize, spacing: Spacing) -> Vec<f64> {
    let last = points - 1;
    let between = |a: f64, b: f64, i: usize| a + (b - a) * i as f64 / last as f64;
    (0..points)
        .map(|i| match i {
            0 => from,
            _ if i == last => to,
            _ => match spacing {
                // Through decimal logarithms, so that decades come out as written.
                Spacing::Logarithmic => 10_f64.powf(between(from.log10(), to.log10(), i)),
                Spacing::Linear => between(from, to, i),
            },
        })
        .collect()
}
