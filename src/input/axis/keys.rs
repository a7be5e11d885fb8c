//! What of a block may be an axis: every key that has a number, and whole blocks; and what a JSON Schema says of them.

use std::collections::BTreeMap;

use serde_json::{Map, Value as Json, json};

use crate::input::document::kind::Describe;
use crate::input::document::reader::join;
use crate::input::document::schema;
use crate::input::keys::drive::RANGE;
use crate::input::points;
use crate::quantity::Dimension;
use crate::quantity::key::{AxesOf, Key, Kind, Number};
use crate::quantity::rows::Rows;

/// The numbers of a block, or the block itself.
pub(crate) struct AxisOf<'a>(pub(crate) &'a AxesOf);

/// A key that has a number.
pub(super) struct AxisNumber {
    /// In the block, items of lists without their places: `relaxation.branches[].time`.
    pub(super) key: String,
    pub(super) row: &'static Key,
    pub(super) scalar: Number,
}

impl AxisNumber {
    /// Whether it is in a table within the block.
    pub(super) fn is_nested(&self) -> bool {
        self.key.contains('.')
    }

    /// The name of the definition of such numbers as an axis: `over-a-time-above-zero`.
    fn definition(&self) -> String {
        format!("over-{}", self.scalar.expected().replace(' ', "-"))
    }
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

fn reference(definition: &str) -> Json {
    json!({ "$ref": format!("#/$defs/{definition}") })
}

impl AxisOf<'_> {
    /// Every key of the block that has a number, those of the tables within it too; `controlled` is the dimension of what the drive controls.
    pub(super) fn numbers(&self, controlled: Dimension) -> Vec<AxisNumber> {
        let mut numbers = Vec::new();
        add_numbers(self.0.rows, "", controlled, &mut numbers);
        numbers
    }

    /// Those of the block itself, and those of the tables within it.
    fn own_and_nested(&self, controlled: Dimension) -> (Vec<AxisNumber>, Vec<AxisNumber>) {
        let numbers = self.numbers(controlled).into_iter();
        numbers.partition(|number| !number.is_nested())
    }

    /// References to what may stand under each key of the block itself, behind this.
    pub(in crate::input) fn references(&self, before: &str) -> Map<String, Json> {
        let (own, _) = self.own_and_nested(Dimension::Force);
        let reference = |AxisNumber { key, .. }: &AxisNumber| {
            (format!("{before}{key}"), reference(&self.definition(key)))
        };
        own.iter().map(reference).collect()
    }

    /// The same under the keys of the tables within it: a pattern of all that take the same kind of number.
    pub(in crate::input) fn patterns(&self, before: &str) -> Map<String, Json> {
        let mut keys: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for number in self.own_and_nested(Dimension::Force).1 {
            let dots = number.key.replace('.', "\\.");
            let alike = keys.entry(number.definition()).or_default();
            alike.push(dots.replace("[]", "\\[[0-9]+\\]"));
        }
        let before = before.replace('.', "\\.");
        let pattern = |(definition, keys): (String, Vec<String>)| {
            let keys = format!("^{before}({})$", keys.join("|"));
            (keys, reference(&definition))
        };
        keys.into_iter().map(pattern).collect()
    }

    fn definition(&self, key: &str) -> String {
        format!("over-{}-{key}", self.0.block)
    }

    /// What a JSON Schema says of each key, by the name that it is referred to; whatever the drive controls.
    pub(in crate::input) fn definitions(&self) -> Map<String, Json> {
        let (load, nested) = self.own_and_nested(Dimension::Force);
        let (approach, _) = self.own_and_nested(Dimension::Length);
        let own = load.into_iter().zip(approach).map(|(load, approach)| {
            let one = points::schema(&load.scalar, &RANGE);
            let other = points::schema(&approach.scalar, &RANGE);
            let mut schema = match one == other {
                true => one,
                false => json!({ "anyOf": [one, other] }),
            };
            schema["description"] = json!(load.row.means());
            (self.definition(&load.key), schema)
        });
        let nested = nested.into_iter();
        let nested = nested.map(|n| (n.definition(), points::schema(&n.scalar, &RANGE)));
        own.chain(nested).collect()
    }
}

impl Describe for AxisOf<'_> {
    fn example(&self) -> String {
        let numbers = self.numbers(Dimension::Force);
        let first = numbers.first().map_or("", |number| &number.key);
        format!("{{ {first} = [...] }}")
    }

    fn schema(&self) -> Json {
        let numbers = json!({
            "type": "object",
            "properties": self.references(""),
            "patternProperties": self.patterns(""),
            "minProperties": 1,
            "additionalProperties": false,
        });
        let listed = |rows: &'static Rows| json!({ "type": "array", "items": schema::of_table(rows), "minItems": 1 });
        match self.0.listed {
            Some(rows) => json!({ "anyOf": [numbers, listed(rows)] }),
            None => numbers,
        }
    }
}
