//! The points of an axis of a sweep: a list of quantities, one of them, or a range.

use serde_json::{Value as Json, json};

use super::diagnostic::{Diagnostic, Diagnostics};
use super::document::kind::{Array, Describe, Kind, Number, Spot, list};
use super::document::plain;
use super::document::reader::TableReader;
use super::document::row::table;
use super::document::row::{Row, Rows};
use super::document::tree::{Node, Value};
use super::keys::drive::{FROM, POINTS, RANGE_KEYS, SPACING, TO};
use crate::sweep::plan::SweepPlan;
use contact_dma_core::words;

pub(super) const MOST_POINTS: usize = SweepPlan::MAX_POINTS;

words! {
    pub(crate) enum Spacing {
        Logarithmic = "log",
        Linear = "linear",
    }
}

static RANGE: Rows = table(
    " A range in place of a list; `from` and `to` are what an entry of the list would be.",
    RANGE_KEYS,
);

/// Points of this kind, ascending, each once.
pub(crate) struct Points(pub(crate) Number);

impl Describe for Points {
    fn expected(&self) -> String {
        format!("a list or a range, each {}", self.0.expected())
    }

    fn example(&self) -> String {
        format!("[{}]", self.0.example())
    }

    fn schema(&self) -> Json {
        let points = json!({ "type": "array", "items": self.0.schema(), "minItems": 1, "maxItems": MOST_POINTS });
        let mut range = RANGE.schema();
        for end in [&FROM, &TO] {
            let means = range["properties"][end.name]["description"].take();
            range["properties"][end.name] = self.0.schema();
            range["properties"][end.name]["description"] = means;
        }
        json!({ "anyOf": [self.0.schema(), points, range] })
    }

    fn rows(&self) -> Option<&'static Rows> {
        Some(&RANGE)
    }
}

impl Kind for Points {
    type Value = Vec<f64>;

    fn written(&self, values: &Vec<f64>) -> Json {
        json!(values)
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<Vec<f64>, Diagnostics> {
        match &node.value {
            Value::Table(table) => spot.read_table(table, node, |table| self.range(table)),
            Value::Array(items) if items.is_empty() => {
                let example = format!("{} = {}", spot.key.unwrap_or_default(), self.example());
                let problem = Diagnostic::at(&node.location, "the sweep is empty");
                let help = format!("give at least one point, for example {example}");
                Err(problem.help(help).into())
            }
            _ => {
                let distinct = Array {
                    entries: 1..=MOST_POINTS,
                    repeats: false,
                    ..list(self.0)
                };
                let mut points = plain(distinct.convert(node, spot)?);
                points.sort_by(f64::total_cmp);
                Ok(points)
            }
        }
    }
}

impl Points {
    fn range(&self, mut table: TableReader<'_>) -> Option<Vec<f64>> {
        let problems = table.problems();
        let end = |row: &Row<Number, _>| Row {
            kind: self.0,
            ..*row
        };
        let (from, to) = (table.read(&end(&FROM)), table.read(&end(&TO)));
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
