//! The axes of a sweep besides the frequency: any number of `[material]`, `[indenter]` or `[drive]`, by its key, as a list or a range.

use serde_json::{Map, Value as Json, json};

use super::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use super::document::Located;
use super::document::kind::{Array, Decided, Describe, Kind, Scalar, Spot, list};
use super::document::reader::{in_backticks, join};
use super::document::row::{AnyRow, Rows};
use super::document::similar::similar;
use super::document::tree::{Entry, Node, Table, Value};
use super::points::{MOST_POINTS, Points};
use crate::quantity::Dimension;
use crate::sweep::plan::{Block, Varied};

/// One key of a block that has a number, with the values that it takes.
#[derive(Clone, Copy)]
pub(crate) struct AxisOf {
    pub(crate) block: Block,
    pub(crate) rows: &'static Rows,
}

/// The same, once the dimension of what the drive controls is known.
pub(crate) struct DecidedAxisOf {
    of: AxisOf,
    controlled: Dimension,
    /// Whether the values are taken in their order, repeats and all.
    in_order: bool,
}

/// What the key varies.
#[derive(Debug, Clone)]
pub(crate) struct Swept {
    pub(super) varied: Varied,
    pub(super) key_location: Location,
    /// SI units, ascending but in pairs.
    pub(super) values: Located<Vec<f64>>,
}

/// Every key of a block that has a number: its row, and what the number is.
fn numbers(rows: &'static Rows, controlled: Dimension) -> Vec<(&'static dyn AnyRow, Scalar)> {
    let mut numbers: Vec<(&'static dyn AnyRow, Scalar)> = Vec::new();
    for row in rows.all() {
        let known = numbers.iter().any(|(known, _)| known.name() == row.name());
        if let (Some(scalar), false) = (row.kind().scalar(controlled), known) {
            numbers.push((row, scalar));
        }
    }
    numbers
}

impl AxisOf {
    /// References to what may stand under each key.
    fn references(&self) -> Map<String, Json> {
        let keys = self.names().into_iter();
        keys.map(|key| {
            let definition = format!("#/$defs/{}", self.definition(key));
            (key.to_owned(), json!({ "$ref": definition }))
        })
        .collect()
    }

    fn definition(&self, key: &str) -> String {
        format!("over-{}-{key}", self.block.name())
    }

    fn names(&self) -> Vec<&'static str> {
        let numbers = numbers(self.rows, Dimension::Force).into_iter();
        numbers.map(|(row, _)| row.name()).collect()
    }
}

impl Describe for AxisOf {
    fn expected(&self) -> String {
        format!("a table with keys of [{}]", self.block.name())
    }

    fn example(&self) -> String {
        let first = self.names().first().copied().unwrap_or_default();
        format!("{{ {first} = [...] }}")
    }

    fn schema(&self) -> Json {
        json!({
            "type": "object",
            "properties": self.references(),
            "minProperties": 1,
            "additionalProperties": false,
        })
    }

    /// What may stand under each key, whatever the drive controls.
    fn definitions(&self) -> Map<String, Json> {
        let [load, approach] = [Dimension::Force, Dimension::Length].map(|controlled| {
            let numbers = numbers(self.rows, controlled).into_iter();
            numbers.map(|(row, scalar)| (row, Points(scalar).schema()))
        });
        let both = load.zip(approach).map(|((row, one), (_, other))| {
            let mut schema = match one == other {
                true => one,
                false => json!({ "anyOf": [one, other] }),
            };
            schema["description"] = json!(row.means());
            (self.definition(row.name()), schema)
        });
        both.collect()
    }

    fn dotted(&self) -> Map<String, Json> {
        let keys = self.references().into_iter();
        keys.map(|(key, schema)| (format!("{}.{key}", self.block.name()), schema))
            .collect()
    }

    fn has_dotted_keys(&self) -> bool {
        true
    }
}

impl Decided for AxisOf {
    type Kind = DecidedAxisOf;

    fn of(&self, controlled: Dimension) -> DecidedAxisOf {
        DecidedAxisOf {
            of: *self,
            controlled,
            in_order: false,
        }
    }
}

impl Describe for DecidedAxisOf {
    fn expected(&self) -> String {
        self.of.expected()
    }

    fn example(&self) -> String {
        self.of.example()
    }

    fn schema(&self) -> Json {
        self.of.schema()
    }
}

impl Kind for DecidedAxisOf {
    type Value = Vec<Swept>;

    fn written(&self, all: &Vec<Swept>) -> Json {
        let entries = all.iter();
        let entries = entries.map(|swept| (swept.varied.key.to_owned(), json!(swept.values.value)));
        Json::Object(entries.collect())
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<Vec<Swept>, Diagnostics> {
        let Value::Table(table) = &node.value else {
            let help = format!("write `{}.KEY = [...]`", spot.key.unwrap_or_default());
            return Err(self.wrong_type(node, spot).help(help).into());
        };
        if table.entries.is_empty() {
            let problem = Diagnostic::at(&node.location, format!("`{}` is empty", spot.path));
            let help = format!("write the key of [{}] that varies", self.of.block.name());
            return Err(problem.help(help).into());
        }
        let entries = table.entries.iter();
        entries
            .map(|(key, entry)| self.swept(key, entry, spot))
            .collect()
    }
}

impl DecidedAxisOf {
    /// The same, whose values go with those of other axes one by one.
    pub(super) fn in_order(self, in_order: bool) -> Self {
        Self { in_order, ..self }
    }

    fn swept(&self, key: &str, entry: &Entry, spot: &Spot<'_>) -> Result<Swept, Diagnostics> {
        let numbers = numbers(self.of.rows, self.controlled);
        let path = join(spot.path, key);
        let Some((row, scalar)) = numbers.iter().find(|(row, _)| row.name() == key) else {
            return Err(self.no_number(&path, entry, &numbers).into());
        };
        let spot = Spot {
            path: &path,
            key: Some(row.name()),
        };
        let points = match (&entry.node.value, self.in_order) {
            (Value::Array(_), true) => {
                let all = Array {
                    entries: 1..=MOST_POINTS,
                    ..list(*scalar)
                };
                let points = all.convert(&entry.node, &spot)?;
                points.into_iter().map(|point| point.value).collect()
            }
            _ => Points(*scalar).convert(&entry.node, &spot)?,
        };
        Ok(Swept {
            varied: Varied {
                block: self.of.block,
                key: row.name(),
                dimension: scalar.dimension(),
            },
            key_location: entry.key.clone(),
            values: Located {
                value: points,
                path: path.clone(),
                location: entry.node.location.clone(),
            },
        })
    }

    /// A key that no number stands under.
    fn no_number(
        &self,
        path: &str,
        entry: &Entry,
        numbers: &[(&'static dyn AnyRow, Scalar)],
    ) -> Diagnostic {
        let names: Vec<&str> = numbers.iter().map(|(row, _)| row.name()).collect();
        let block = self.of.block.name();
        let problem = Diagnostic::at(&entry.key, format!("`{path}` cannot be an axis"))
            .because(format!("no key of [{block}] that takes one number"));
        let key = path.rsplit('.').next().unwrap_or(path);
        match similar(key, &names) {
            Some(meant) => problem.help(format!("write `{meant}` instead of `{key}`")),
            None => problem.help(format!(
                "keys of [{block}] that can: {}",
                in_backticks(&names)
            )),
        }
    }
}

impl Swept {
    /// The table of a block with this value (SI units) in place of its own; what is wrong with it is told at the axis.
    pub(super) fn put_into(&self, block: &Table, value: f64) -> Table {
        let mut table = block.clone();
        let entry = Entry {
            key: self.key_location.clone(),
            node: Node {
                value: Value::Float(Ok(value)),
                location: self.values.location.clone(),
            },
        };
        table.entries.insert(self.varied.key.to_owned(), entry);
        table
    }
}

/// Takes the quotes off the keys of `[sweep]`: `"material.temperature" = [...]` is the same as `material.temperature = [...]`.
pub(super) fn unquote(root: &mut Table, problems: &Problems) {
    let Some(Entry { node, .. }) = root.entries.get_mut("sweep") else {
        return;
    };
    let Value::Table(sweep) = &mut node.value else {
        return;
    };
    let quoted: Vec<String> = (sweep.entries.keys())
        .filter(|key| key.contains('.'))
        .cloned()
        .collect();
    for key in quoted {
        let (Some((block, inner)), Some(entry)) = (key.split_once('.'), sweep.entries.remove(&key))
        else {
            continue;
        };
        let below = sweep
            .entries
            .entry(block.to_owned())
            .or_insert_with(|| Entry {
                key: entry.key.clone(),
                node: Node::empty_table(&entry.key),
            });
        match &mut below.node.value {
            Value::Table(table) if !table.entries.contains_key(inner) => {
                table.entries.insert(inner.to_owned(), entry);
            }
            _ => {
                problems
                    .at(&entry.key, format!("`sweep.{key}` is given twice"))
                    .help("keep one of them");
            }
        }
    }
}
