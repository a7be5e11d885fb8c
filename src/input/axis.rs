//! The axes of a sweep besides the frequency: any number of `[material]`, `[layer]`, `[indenter]` or `[drive]`, by its key, as a list or
//! a range; and materials or indenters in the place of one another, as a list of blocks with names.

mod swept;

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde_json::{Map, Value as Json, json};

use super::diagnostic::{Diagnostic, Diagnostics, Problems};
use super::document::Located;
use super::document::kind::{Asked, Describe, Spot};
use super::document::reader::{TableReader, in_backticks, join};
use super::document::row;
use super::document::similar::similar;
use super::document::tree::{Entry, Node, Table, Value};
use super::keys::drive::RANGE;
use super::keys::material::{LIBRARY, NAME};
use super::points::{self, MOST_POINTS};
use crate::quantity::Dimension;
use crate::quantity::block::{Field, Word};
use crate::quantity::key::{AxesOf, Entries, Key, Kind, Number};
use crate::quantity::rows::Rows;
use crate::sweep::plan::{Block, Varied};
pub(in crate::input) use swept::{Swept, has_list, unquote};
use swept::{WHOLE, beside_numbers};

/// One key of a block that has a number, with the values that it takes.
pub(crate) struct AxisOf {
    block: Block,
    of: AxesOf,
    /// The dimension of what the drive controls.
    controlled: Dimension,
    /// Whether the values are taken in their order, repeats and all.
    in_order: bool,
}

/// Characters of a name; more do not fit into a legend.
const NAME_LENGTH: usize = 60;

/// A key that has a number.
struct AxisNumber {
    /// From the block on, items of lists without their places: `relaxation.branches[].time`.
    key: String,
    row: &'static Key,
    scalar: Number,
}

/// Every key of a block that has a number, those of the tables within it too.
fn numbers(rows: &'static Rows, controlled: Dimension) -> Vec<AxisNumber> {
    let mut numbers = Vec::new();
    add_numbers(rows, "", controlled, &mut numbers);
    numbers
}

fn add_numbers(rows: &'static Rows, path: &str, controlled: Dimension, to: &mut Vec<AxisNumber>) {
    for row in rows.all() {
        let key = join(path, row.name);
        match (row.kind.number(controlled), row.kind.rows()) {
            (Some(_), _) if to.iter().any(|number| number.key == key) => {}
            (Some(scalar), _) => to.push(AxisNumber { key, row, scalar }),
            (None, Some(rows)) if may_vary_within(rows) => {
                let is_list = matches!(row.kind, Kind::Tables(..));
                let items = if is_list { "[]" } else { "" };
                add_numbers(rows, &format!("{key}{items}"), controlled, to);
            }
            (None, _) => {}
        }
    }
}

/// Whether a number of a table within a block may vary: not where data are read from a file, which are what they are.
fn may_vary_within(rows: &'static Rows) -> bool {
    let names_a_file = |key: &&Key| key.name == "file" || key.name == "files";
    !rows.all().iter().any(names_a_file)
}

/// The name of the definition of such numbers as an axis: `over-a-time-above-zero`.
fn of_kind(scalar: &Number) -> String {
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

/// What an axis of a sweep takes under a key of `[sweep]`; `None` where a problem was reported. It is known by then what the drive
/// controls, and whether the values go with those of other axes one by one.
pub(super) fn read(
    table: &mut TableReader<'_>,
    key: &Key,
    of: (Dimension, bool),
) -> Option<Vec<Swept>> {
    let (Some(node), Kind::Axes(axes)) = (table.node(key), &key.kind) else {
        return Some(Vec::new());
    };
    let (path, kind) = (join("sweep", key.name), &key.kind);
    let spot = &Spot {
        path: &path,
        key: Some(key.name),
    };
    let axis = AxisOf::new(axes).of(of.0, of.1);
    let swept = axis.convert(&Asked { kind, node, spot });
    swept.map_err(|found| table.problems().extend(found)).ok()
}

impl AxisOf {
    /// Numbers of a block.
    pub(crate) fn new(of: &AxesOf) -> Self {
        let block = Block::ALL.iter().find(|(name, _)| *name == of.block);
        Self {
            block: block.map_or(Block::Material, |(_, block)| *block),
            of: *of,
            controlled: Dimension::Force,
            in_order: false,
        }
    }

    /// The same once it is known what the drive controls, and whether the values go with those of other axes one by one.
    fn of(self, controlled: Dimension, in_order: bool) -> Self {
        Self {
            controlled,
            in_order,
            ..self
        }
    }

    /// References to what may stand under each key of the block itself.
    pub(super) fn references(&self) -> Map<String, Json> {
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

    fn nested(&self) -> impl Iterator<Item = AxisNumber> {
        let numbers = numbers(self.of.rows, self.controlled).into_iter();
        numbers.filter(|number| number.key.contains('.'))
    }

    fn reference(&self, key: &str) -> Json {
        json!({ "$ref": format!("#/$defs/{}", self.definition(key)) })
    }

    fn definition(&self, key: &str) -> String {
        format!("over-{}-{key}", self.block.name())
    }

    fn names(&self) -> Vec<String> {
        let numbers = numbers(self.of.rows, self.controlled).into_iter();
        numbers.map(|number| number.key).collect()
    }

    /// What a JSON Schema says of each key, by the name that it is referred to; whatever the drive controls.
    pub(super) fn definitions(&self) -> Map<String, Json> {
        let [load, approach] = [Dimension::Force, Dimension::Length].map(|controlled| {
            let numbers = numbers(self.of.rows, controlled).into_iter();
            let own = numbers.filter(|number| !number.key.contains('.'));
            own.map(|number| (number.key, number.row, as_axis(&number.scalar)))
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
        let nested = self.nested();
        let nested = nested.map(|n| (of_kind(&n.scalar), as_axis(&n.scalar)));
        own.into_iter().chain(nested).collect()
    }

    /// Keys with dots that may be written, in quotes, in place of the table, and what a JSON Schema says of each.
    pub(super) fn dotted(&self) -> Map<String, Json> {
        let keys = self.references().into_iter();
        keys.map(|(key, schema)| (format!("{}.{key}", self.block.name()), schema))
            .collect()
    }

    /// The same of keys that lead into tables and lists, by the pattern of each.
    pub(super) fn dotted_patterns(&self) -> Map<String, Json> {
        self.patterns(&format!("{}.", self.block.name()))
    }
}

/// What a JSON Schema says of such a number as an axis.
fn as_axis(scalar: &Number) -> Json {
    points::schema(scalar, &RANGE)
}

impl Describe for AxisOf {
    fn example(&self) -> String {
        let first = self.names().into_iter().next().unwrap_or_default();
        format!("{{ {first} = [...] }}")
    }

    fn schema(&self) -> Json {
        let numbers = json!({
            "type": "object",
            "properties": self.references(),
            "patternProperties": self.patterns(""),
            "minProperties": 1,
            "additionalProperties": false,
        });
        let listed = |rows: &'static Rows| json!({ "type": "array", "items": row::schema(rows), "minItems": 1 });
        match self.of.listed {
            Some(rows) => json!({ "anyOf": [numbers, listed(rows)] }),
            None => numbers,
        }
    }
}

impl AxisOf {
    fn convert(&self, asked: &Asked<'_>) -> Result<Vec<Swept>, Diagnostics> {
        let Asked { node, spot, .. } = *asked;
        let listed;
        let table = match &node.value {
            Value::Table(table) => table,
            Value::Array(_) if self.of.listed.is_some() => {
                listed = beside_numbers(node);
                &listed
            }
            _ => {
                let help = format!("write `{}.KEY = [...]`", spot.key.unwrap_or_default());
                return Err(asked.wrong_type().help(help).into());
            }
        };
        if table.entries.is_empty() {
            let problem = Diagnostic::at(&node.location, format!("`{}` is empty", spot.path));
            let help = format!("write the key of [{}] that varies", self.block.name());
            return Err(problem.help(help).into());
        }
        let numbers = numbers(self.of.rows, self.controlled);
        let mut all = Vec::new();
        for (key, entry) in &table.entries {
            self.add_swept(&numbers, key, entry, spot, &mut all)?;
        }
        let nested = all.iter().find(|swept| swept.varied.is_nested());
        match nested.filter(|_| all.iter().any(|swept| swept.varied.is_whole())) {
            Some(nested) => Err(self.number_within_listed(nested).into()),
            None => Ok(all),
        }
    }

    /// The axis of a key, or those of the keys of the table that is given there: `zener = { time = [...] }` is `zener.time = [...]`.
    fn add_swept(
        &self,
        numbers: &[AxisNumber],
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
            (_, Value::Array(items)) if key == WHOLE && self.of.listed.is_some() => {
                to.push(self.listed(items, entry, spot)?);
            }
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
        number: &AxisNumber,
        key: &str,
        entry: &Entry,
        spot: &Spot<'_>,
    ) -> Result<Swept, Diagnostics> {
        let AxisNumber { row, scalar, .. } = number;
        let path = join(spot.path, key);
        let spot = Spot {
            path: &path,
            key: Some(row.name),
        };
        let (node, in_order) = (&entry.node, Entries::of(1..=MOST_POINTS, ""));
        let kind = &match (&node.value, self.in_order) {
            (Value::Array(_), true) => Kind::Numbers(*scalar, in_order),
            _ => Kind::Points(*scalar, &RANGE),
        };
        let points = Asked {
            kind,
            node,
            spot: &spot,
        };
        let points = Vec::of(points.read()?).unwrap_or_default();
        Ok(Swept {
            varied: Varied::number(
                self.block,
                match number.key.contains('.') {
                    true => Cow::Owned(key.to_owned()),
                    false => Cow::Borrowed(row.name),
                },
                scalar.dimension,
            ),
            key_location: entry.key.clone(),
            values: spot.located(points, &entry.node),
            blocks: Vec::new(),
        })
    }

    /// The axis that a list of blocks is, each with a name of its own.
    fn listed(&self, items: &[Node], entry: &Entry, spot: &Spot<'_>) -> Result<Swept, Diagnostics> {
        let (problems, block) = (Problems::new(), self.block.name());
        let mut blocks: Vec<(String, Located<Table>)> = Vec::with_capacity(items.len());
        for (k, item) in items.iter().enumerate() {
            let (name, table) = match self.named(item, &format!("{}[{k}]", spot.path)) {
                Ok(named) => named,
                Err(found) => {
                    problems.extend(found);
                    continue;
                }
            };
            if let Some((_, other)) = blocks.iter().find(|(known, _)| *known == name) {
                problems
                    .at(
                        &table,
                        format!("two blocks of `{}` are called `{name}`", spot.path),
                    )
                    .label(other, "the other one")
                    .help(format!("give every {block} a `name` of its own"));
            }
            blocks.push((name, table));
        }
        if items.is_empty() {
            problems
                .at(&entry.node.location, format!("`{}` is empty", spot.path))
                .help(format!("write a `[[sweep.{block}]]` for each {block}"));
        }
        let (names, blocks): (Vec<String>, Vec<_>) = blocks.into_iter().unzip();
        // Cases, and so blocks, are far fewer than the integers of a float.
        let places = (0..blocks.len()).map(|place| place as f64);
        let swept = Swept {
            key_location: entry.key.clone(),
            values: spot.located(places.collect(), &entry.node),
            varied: Varied::blocks(self.block, names),
            blocks,
        };
        problems.into_result(Some(swept))
    }

    /// A block of a list with its name: what stands under `name`, else the material of the library that it is.
    fn named(&self, item: &Node, path: &str) -> Result<(String, Located<Table>), Diagnostics> {
        let Value::Table(table) = &item.value else {
            let problem = Diagnostic::at(&item.location, format!("`{path}` must be a table"));
            let problem = problem.because(format!("found {}", item.describe()));
            return Err(match (&item.value, self.block) {
                (Value::Text(name), Block::Material) => {
                    problem.help(format!("write `{{ library = \"{name}\" }}`"))
                }
                _ => problem.help("write the keys of the block in braces"),
            }
            .into());
        };
        let mut table = table.clone();
        let given = table.entries.remove(NAME.name);
        let library = |table: &Table| match &table.entries.get(LIBRARY.name)?.node.value {
            Value::Text(name) => Some(name.trim().to_lowercase()),
            _ => None,
        };
        let name = match (&given, library(&table)) {
            (Some(entry), _) => {
                let path = join(path, NAME.name);
                let spot = Spot {
                    path: &path,
                    key: Some(NAME.name),
                };
                let text = Asked {
                    kind: &Kind::Text,
                    node: &entry.node,
                    spot: &spot,
                };
                String::of(text.read()?).unwrap_or_default()
            }
            (None, Some(library)) => library,
            (None, None) => {
                let problem = format!("`{path}` needs a `name`");
                let help = "tables and figures call it by that: name = \"...\"";
                return Err(Diagnostic::at(&item.location, problem).help(help).into());
            }
        };
        let is_long = name.chars().count() > NAME_LENGTH;
        let is_formula = name.starts_with(['=', '+', '-', '@']);
        if name.trim() != name
            || name.is_empty()
            || is_long
            || name.contains(char::is_control)
            || is_formula
        {
            let place = given
                .as_ref()
                .map_or(&item.location, |entry| &entry.node.location);
            let problem = format!(
                "`{path}.name` must have 1 to {NAME_LENGTH} characters, no blanks at its ends, no line ends, and none of = + - @ at its beginning"
            );
            let mut diagnostic = Diagnostic::at(place, problem);
            if is_formula {
                diagnostic = diagnostic
                    .because("a spreadsheet that opens the tables would take it for a formula")
                    .help("begin the name with a letter or a digit");
            }
            return Err(diagnostic.into());
        }
        if self.block == Block::Material {
            let named = Entry {
                key: item.location.clone(),
                node: Node {
                    value: Value::Text(name.clone()),
                    location: item.location.clone(),
                },
            };
            let entry = given.unwrap_or(named);
            table.entries.insert(NAME.name.to_owned(), entry);
        }
        let table = Located {
            value: table,
            path: path.to_owned(),
            location: item.location.clone(),
        };
        Ok((name, table))
    }

    /// A number in a table or list of blocks that may each have others.
    fn number_within_listed(&self, nested: &Swept) -> Diagnostic {
        let (block, key) = (self.block.name(), &nested.varied.key);
        let problem = format!("`{block}.{key}` cannot be an axis beside a list of blocks");
        Diagnostic::at(&nested.key_location, problem)
            .because("a number within a table of the block")
            .help(format!(
                "write a `[[sweep.{block}]]` for each of its values"
            ))
    }

    /// A key that no number stands under.
    fn no_number(&self, path: &str, entry: &Entry, numbers: &[AxisNumber]) -> Diagnostic {
        let names: Vec<&str> = numbers.iter().map(|number| number.key.as_str()).collect();
        let block = self.block.name();
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
