//! The axes of a sweep besides the frequency: any number of `[material]`, `[indenter]` or `[drive]`, by its key, as a list or a range.

use std::borrow::Cow;
use std::collections::BTreeMap;

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

/// A key that has a number.
struct Number {
    /// From the block on, items of lists without their places: `relaxation.branches[].time`.
    key: String,
    row: &'static dyn AnyRow,
    scalar: Scalar,
}

/// Every key of a block that has a number, those of the tables within it too.
fn numbers(rows: &'static Rows, controlled: Dimension) -> Vec<Number> {
    let mut numbers = Vec::new();
    add_numbers(rows, "", controlled, &mut numbers);
    numbers
}

fn add_numbers(rows: &'static Rows, path: &str, controlled: Dimension, to: &mut Vec<Number>) {
    for row in rows.all() {
        let key = join(path, row.name());
        match (row.kind().scalar(controlled), row.kind().rows()) {
            (Some(_), _) if to.iter().any(|number| number.key == key) => {}
            (Some(scalar), _) => to.push(Number { key, row, scalar }),
            (None, Some(rows)) if may_vary_within(rows) => {
                let items = if row.kind().is_list() { "[]" } else { "" };
                add_numbers(rows, &format!("{key}{items}"), controlled, to);
            }
            (None, _) => {}
        }
    }
}

/// Whether a number of a table within a block may vary: not where data are read from a file, which are what they are.
fn may_vary_within(rows: &'static Rows) -> bool {
    let names_a_file = |row: &&dyn AnyRow| row.name() == "file" || row.name() == "files";
    !rows.all().iter().any(names_a_file)
}

/// The name of the definition of such numbers as an axis: `over-a-time-above-zero`.
fn of_kind(scalar: &Scalar) -> String {
    format!("over-{}", scalar.expected().replace(' ', "-"))
}

/// A key without the places in its lists: `relaxation.branches[].time` of `relaxation.branches[0].time`.
fn without_places(key: &str) -> String {
    let mut general = String::new();
    for (k, part) in key.split('[').enumerate() {
        match part.split_once(']') {
            Some((place, rest)) if k > 0 && place.bytes().all(|b| b.is_ascii_digit()) => {
                general.push_str("[]");
                general.push_str(rest);
            }
            _ => general.push_str(part),
        }
    }
    general
}

impl AxisOf {
    /// References to what may stand under each key of the block itself.
    fn references(&self) -> Map<String, Json> {
        let keys = self.names().into_iter();
        let keys = keys.filter(|key| !key.contains('.'));
        keys.map(|key| (key.clone(), self.reference(&key)))
            .collect()
    }

    /// The same under the keys of the tables within it, behind this: a pattern of all that take the same kind of number.
    fn patterns(&self, before: &str) -> Map<String, Json> {
        let mut keys: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for number in self.nested() {
            let dots = number.key.replace('.', "\\.");
            let of_kind = keys.entry(of_kind(&number.scalar)).or_default();
            of_kind.push(dots.replace("[]", "\\[[0-9]+\\]"));
        }
        let before = before.replace('.', "\\.");
        let pattern = |(kind, keys): (String, Vec<String>)| {
            let reference = json!({ "$ref": format!("#/$defs/{kind}") });
            (format!("^{before}({})$", keys.join("|")), reference)
        };
        keys.into_iter().map(pattern).collect()
    }

    fn nested(&self) -> Vec<Number> {
        let mut numbers = numbers(self.rows, Dimension::Force);
        numbers.retain(|number| number.key.contains('.'));
        numbers
    }

    fn reference(&self, key: &str) -> Json {
        json!({ "$ref": format!("#/$defs/{}", self.definition(key)) })
    }

    fn definition(&self, key: &str) -> String {
        format!("over-{}-{key}", self.block.name())
    }

    fn names(&self) -> Vec<String> {
        let numbers = numbers(self.rows, Dimension::Force).into_iter();
        numbers.map(|number| number.key).collect()
    }
}

impl Describe for AxisOf {
    fn expected(&self) -> String {
        format!("a table with keys of [{}]", self.block.name())
    }

    fn example(&self) -> String {
        let first = self.names().into_iter().next().unwrap_or_default();
        format!("{{ {first} = [...] }}")
    }

    fn schema(&self) -> Json {
        json!({
            "type": "object",
            "properties": self.references(),
            "patternProperties": self.patterns(""),
            "minProperties": 1,
            "additionalProperties": false,
        })
    }

    /// What may stand under each key, whatever the drive controls.
    fn definitions(&self) -> Map<String, Json> {
        let [load, approach] = [Dimension::Force, Dimension::Length].map(|controlled| {
            let numbers = numbers(self.rows, controlled).into_iter();
            let own = numbers.filter(|number| !number.key.contains('.'));
            own.map(|number| (number.key, number.row, Points(number.scalar).schema()))
        });
        let both = load.zip(approach).map(|((key, row, one), (_, _, other))| {
            let mut schema = match one == other {
                true => one,
                false => json!({ "anyOf": [one, other] }),
            };
            schema["description"] = json!(row.means());
            (self.definition(&key), schema)
        });
        let own: Map<String, Json> = both.collect();
        let nested = self.nested().into_iter();
        let nested = nested.map(|n| (of_kind(&n.scalar), Points(n.scalar).schema()));
        own.into_iter().chain(nested).collect()
    }

    fn dotted(&self) -> Map<String, Json> {
        let keys = self.references().into_iter();
        keys.map(|(key, schema)| (format!("{}.{key}", self.block.name()), schema))
            .collect()
    }

    fn dotted_patterns(&self) -> Map<String, Json> {
        self.patterns(&format!("{}.", self.block.name()))
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
        let entries =
            entries.map(|swept| (swept.varied.key.to_string(), json!(swept.values.value)));
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
        let numbers = numbers(self.of.rows, self.controlled);
        let mut all = Vec::new();
        for (key, entry) in &table.entries {
            self.add_swept(&numbers, key, entry, spot, &mut all)?;
        }
        Ok(all)
    }
}

impl DecidedAxisOf {
    /// The same, whose values go with those of other axes one by one.
    pub(super) fn in_order(self, in_order: bool) -> Self {
        Self { in_order, ..self }
    }

    /// The axis of a key, or those of the keys of the table that is given there: `zener = { time = [...] }` is `zener.time = [...]`.
    fn add_swept(
        &self,
        numbers: &[Number],
        key: &str,
        entry: &Entry,
        spot: &Spot<'_>,
        to: &mut Vec<Swept>,
    ) -> Result<(), Diagnostics> {
        let general = without_places(key);
        let number = numbers.iter().find(|number| number.key == general);
        let below = format!("{general}.");
        let items = format!("{general}[].");
        let leads_to = |start: &str| numbers.iter().any(|n| n.key.starts_with(start));
        match (number, &entry.node.value) {
            (Some(number), _) => to.push(self.swept(number, key, entry, spot)?),
            (None, Value::Table(table)) if leads_to(&below) || leads_to(&items) => {
                for (inner, entry) in &table.entries {
                    // An item of a list, as `--set` says it.
                    let key = match leads_to(&items) {
                        true => format!("{key}[{inner}]"),
                        false => format!("{key}.{inner}"),
                    };
                    self.add_swept(numbers, &key, entry, spot, to)?;
                }
            }
            (None, _) => {
                let path = join(spot.path, key);
                return Err(self.no_number(&path, entry, numbers).into());
            }
        }
        Ok(())
    }

    fn swept(
        &self,
        number: &Number,
        key: &str,
        entry: &Entry,
        spot: &Spot<'_>,
    ) -> Result<Swept, Diagnostics> {
        let Number { row, scalar, .. } = number;
        let path = join(spot.path, key);
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
                key: match number.key.contains('.') {
                    true => Cow::Owned(key.to_owned()),
                    false => Cow::Borrowed(row.name()),
                },
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
    fn no_number(&self, path: &str, entry: &Entry, numbers: &[Number]) -> Diagnostic {
        let names: Vec<&str> = numbers.iter().map(|number| number.key.as_str()).collect();
        let block = self.of.block.name();
        let problem = Diagnostic::at(&entry.key, format!("`{path}` cannot be an axis"))
            .because(format!("no key of [{block}] that takes one number"));
        let key = path.splitn(3, '.').last().unwrap_or(path);
        if let Some(meant) = similar(key, &names) {
            return problem.help(format!("write `{meant}` instead of `{key}`"));
        }
        // What the other body may be made of is as long again as the rest.
        let is_own = |name: &&str| !name.starts_with("material.");
        let own: Vec<&str> = names.iter().copied().filter(is_own).collect();
        let others = match own.len() == names.len() {
            true => "",
            false => ", and those of its `material`",
        };
        problem.help(format!(
            "keys of [{block}] that can: {}{others}",
            in_backticks(&own)
        ))
    }
}

impl Swept {
    /// Whether the block has what varies.
    pub(super) fn is_in(&self, block: &Table) -> bool {
        at_key(&mut block.clone(), &self.varied.key, |_, _| {}).is_some()
    }

    /// The table of a block with this value (SI units) in place of its own; what is wrong with it is told at the axis.
    ///
    /// # Errors
    /// A number in a table or a list that the block does not have.
    pub(super) fn put_into(&self, block: &Table, value: f64) -> Result<Table, Diagnostic> {
        let mut table = block.clone();
        let entry = Entry {
            key: self.key_location.clone(),
            node: Node {
                value: Value::Float(Ok(value)),
                location: self.values.location.clone(),
            },
        };
        let key = &self.varied.key;
        let put = match self.varied.is_nested() {
            true => at_key(&mut table, key, |table, key| {
                table.entries.insert(key.to_owned(), entry)
            }),
            false => Some(table.entries.insert(key.to_string(), entry)),
        };
        let name = self.varied.block.name();
        let missing = || {
            Diagnostic::at(&self.key_location, format!("[{name}] has no `{key}`"))
                .because("varies what the block does not have")
                .help(format!("write the number into [{name}], or another key here; items of lists are counted from 0"))
        };
        put.map(|_| table).ok_or_else(missing)
    }
}

/// What `then` makes of the table that has the last part of a key, which is there.
fn at_key<T>(table: &mut Table, key: &str, then: impl FnOnce(&mut Table, &str) -> T) -> Option<T> {
    let Some((first, rest)) = key.split_once('.') else {
        return table.entries.contains_key(key).then(|| then(table, key));
    };
    let (name, place) = match first.split_once('[') {
        Some((name, place)) => (name, Some(place.strip_suffix(']')?.parse::<usize>().ok()?)),
        None => (first, None),
    };
    match (&mut table.entries.get_mut(name)?.node.value, place) {
        (Value::Table(below), None) => at_key(below, rest, then),
        (Value::Array(items), Some(place)) => match &mut items.get_mut(place)?.value {
            Value::Table(below) => at_key(below, rest, then),
            _ => None,
        },
        _ => None,
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
