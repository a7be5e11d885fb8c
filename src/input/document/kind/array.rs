//! Lists of values of one kind.

use std::collections::HashMap;
use std::ops::RangeInclusive;

use serde_json::{Value as Json, json};

use super::{Decided, Dependent, Describe, Kind, Number, Spot};
use crate::input::diagnostic::{Diagnostics, Problems};
use crate::input::document::Located;
use crate::input::document::tree::{Node, Value};
use crate::quantity::Dimension;
use crate::quantity::key::expected_list;

/// A list of values of one kind, each with its own place; a single value is a list of one.
#[derive(Clone)]
pub(crate) struct Array<K> {
    pub(crate) item: K,
    pub(crate) entries: RangeInclusive<usize>,
    /// Whether an entry may be there twice.
    pub(crate) repeats: bool,
    /// What to do about entries too few or too many.
    pub(crate) instead: &'static str,
}

/// A list of any length.
pub(crate) const fn list<K>(item: K) -> Array<K> {
    Array {
        item,
        entries: 0..=usize::MAX,
        repeats: true,
        instead: "",
    }
}

/// Exactly two values, and what to write in place of another number of them.
pub(crate) const fn pair<K: Copy>(item: K, instead: &'static str) -> Array<K> {
    Array {
        item,
        entries: 2..=2,
        repeats: true,
        instead,
    }
}

impl<K: Kind> Array<K> {
    fn check(&self, values: &[Located<K::Value>], node: &Node, spot: &Spot<'_>, found: &Problems) {
        let (least, most) = (*self.entries.start(), *self.entries.end());
        if !self.entries.contains(&values.len()) {
            let allowed = match (least, most) {
                (least, usize::MAX) => format!("at least {least}"),
                (least, most) if least == most => format!("exactly {most}"),
                (0, most) => format!("at most {most}"),
                (least, most) => format!("{least} to {most}"),
            };
            let message = format!(
                "`{}` has {} entries, where {allowed} are allowed",
                spot.path,
                values.len()
            );
            let problem = found.at(&node.location, message);
            if !self.instead.is_empty() {
                problem.help(self.instead);
            }
        }
        if self.repeats {
            return;
        }
        let mut known: HashMap<String, &Located<K::Value>> = HashMap::new();
        for value in values {
            let written = self.item.written(&value.value).to_string();
            if let Some(other) = known.insert(written, value) {
                found
                    .at(value, format!("`{}` is listed twice", value.path))
                    .label(other, "the other one")
                    .help("write every entry once");
            }
        }
    }
}

impl<K: Describe> Describe for Array<K> {
    fn expected(&self) -> String {
        expected_list(&self.item.expected(), &self.entries)
    }

    fn example(&self) -> String {
        let item = self.item.example();
        match *self.entries.end() {
            2 => format!("[{item}, {item}]"),
            _ => format!("[{item}]"),
        }
    }

    fn schema(&self) -> Json {
        let mut array = json!({ "type": "array", "items": self.item.schema() });
        array["minItems"] = json!(self.entries.start());
        if *self.entries.end() < usize::MAX {
            array["maxItems"] = json!(self.entries.end());
        }
        if !self.repeats {
            array["uniqueItems"] = json!(true);
        }
        match self.entries.contains(&1) {
            true => json!({ "anyOf": [array, self.item.schema()] }),
            false => array,
        }
    }

    fn words(&self) -> Vec<&'static str> {
        self.item.words()
    }
}

impl<K: Kind> Kind for Array<K> {
    type Value = Vec<Located<K::Value>>;

    fn written(&self, values: &Self::Value) -> Json {
        let items = values
            .iter()
            .map(|located| self.item.written(&located.value));
        items.collect()
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<Self::Value, Diagnostics> {
        let (found, mut values) = (Problems::new(), Vec::new());
        match &node.value {
            Value::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    let path = format!("{}[{index}]", spot.path);
                    let spot = Spot {
                        path: &path,
                        key: None,
                    };
                    match self.item.convert(item, &spot) {
                        Ok(value) => values.push(spot.located(value, item)),
                        Err(diagnostics) => found.extend(diagnostics),
                    }
                }
            }
            Value::Text(_) | Value::Integer(_) | Value::Float(_) => {
                values.push(spot.located(self.item.convert(node, spot)?, node));
            }
            _ => return Err(self.refused(node, spot)),
        }
        if found.is_empty() {
            self.check(&values, node, spot, &found);
        }
        found.into_result(Some(values))
    }
}

impl Decided for Array<Dependent> {
    type Kind = Array<Number>;

    fn of(&self, dimension: Dimension) -> Array<Number> {
        Array {
            item: self.item.of(dimension),
            entries: self.entries.clone(),
            repeats: self.repeats,
            instead: self.instead,
        }
    }
}
