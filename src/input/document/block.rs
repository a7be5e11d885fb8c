//! Reading of the blocks that are declared as structs: what a document knows of their keys, and their problems with places.

use serde_json::{Value as Json, json};

use super::kind::{Array, Boolean, Describe, Integer, Kind, OneOf, Spot};
use super::plain;
use super::reader::TableReader;
use super::row::{AnyRow, Others, Rows};
use super::tree::Node;
use crate::input::diagnostic::Diagnostics;
use crate::quantity::block::{Block, Reported, Source};
use crate::quantity::key::{Entries, Key, Kind as KeyKind, Number, Presence};
use crate::quantity::setting::Value;
use crate::quantity::{Dimension, format_si};

/// The keys of a block.
pub(crate) const fn rows_of<B: Block>() -> Rows {
    Rows {
        means: B::MEANS,
        keys: &[],
        block: B::KEYS,
        others: Others::None,
    }
}

/// Reads a block to its end, with the values of `given` where the table has none; `None` where a problem was reported.
pub(crate) fn read<B: Block>(mut table: TableReader<'_>, given: Option<&B>) -> Option<B> {
    let block = read_from(&mut table, given);
    table.finish();
    block
}

/// The same of a table that has other keys besides.
pub(crate) fn read_from<B: Block>(table: &mut TableReader<'_>, given: Option<&B>) -> Option<B> {
    let block = B::read(table, given)?;
    let Some(conflict) = block.conflict() else {
        return Some(block);
    };
    let place = table.place_of(conflict.key);
    let place = place.unwrap_or_else(|| table.as_ref().clone());
    let report = table.problems().at(&place, conflict.what);
    let report = match conflict.because {
        None => report,
        Some(because) => report.because(because),
    };
    report.help(conflict.help);
    None
}

impl Source for TableReader<'_> {
    fn value(&mut self, key: &'static Key) -> Result<Option<Value>, Reported> {
        let found = self.under(key.name, &key.kind).ok_or(Reported)?;
        Ok(found.map(|located| located.value))
    }

    fn report_absent(&mut self, key: &'static Key) {
        self.report_none(key.name, &key.kind);
    }
}

impl AnyRow for Key {
    fn name(&self) -> &'static str {
        self.name
    }

    fn means(&self) -> &'static str {
        self.means.trim_start()
    }

    fn kind(&self) -> &dyn Describe {
        &self.kind
    }

    fn is_required(&self) -> bool {
        matches!(self.presence, Presence::Required)
    }

    fn default(&self) -> Option<Json> {
        self.default().map(|value| self.kind.written(&value))
    }
}

fn list<K>(item: K, entries: &Entries) -> Array<K> {
    Array {
        item,
        entries: entries.number.clone(),
        repeats: entries.repeats,
        instead: entries.instead,
    }
}

/// The kind of value that a key has, as documents read it.
fn described(kind: &KeyKind) -> Box<dyn Describe> {
    match kind {
        KeyKind::Flag => Box::new(Boolean),
        KeyKind::Integer(range) => Box::new(Integer(range.clone())),
        KeyKind::Number(number) => Box::new(*number),
        KeyKind::Word(words) => Box::new(OneOf(words.to_vec())),
        KeyKind::Numbers(number, entries) => Box::new(list(*number, entries)),
        KeyKind::Words(words, entries) => Box::new(list(OneOf(words.to_vec()), entries)),
    }
}

impl Describe for KeyKind {
    fn expected(&self) -> String {
        self.expected()
    }

    fn example(&self) -> String {
        described(self).example()
    }

    fn schema(&self) -> Json {
        described(self).schema()
    }

    fn words(&self) -> Vec<&'static str> {
        described(self).words()
    }

    fn number(&self, controlled: Dimension) -> Option<Number> {
        described(self).number(controlled)
    }
}

impl Kind for KeyKind {
    type Value = Value;

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<Value, Diagnostics> {
        Ok(match self {
            Self::Flag => Boolean.convert(node, spot)?.into(),
            Self::Integer(range) => Integer(range.clone()).convert(node, spot)?.into(),
            Self::Number(number) => number.value(number.convert(node, spot)?),
            Self::Word(words) => OneOf(words.to_vec()).convert(node, spot)?.into(),
            Self::Numbers(number, entries) => {
                let numbers = plain(list(*number, entries).convert(node, spot)?);
                match number.dimension {
                    Some(dimension) => Value::Quantities(numbers, dimension),
                    None => Value::Numbers(numbers),
                }
            }
            Self::Words(words, entries) => {
                let words = list(OneOf(words.to_vec()), entries).convert(node, spot)?;
                Value::Texts(plain(words).into_iter().map(str::to_owned).collect())
            }
        })
    }

    fn written(&self, value: &Value) -> Json {
        match value {
            Value::Quantity(value, dimension) => json!(format_si(*value, *dimension)),
            Value::Number(number) | Value::Tolerance(number) => json!(number),
            Value::Integer(integer) => json!(integer),
            Value::Flag(flag) => json!(flag),
            Value::Text(text) => json!(text),
            Value::Texts(texts) => json!(texts),
            other => json!(other.toml()),
        }
    }
}
