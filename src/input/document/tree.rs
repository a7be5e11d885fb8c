//! The parsed tree: tables, arrays and values, each with its place.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use toml::de::{DeFloat, DeInteger, DeTable, DeValue};

use crate::input::diagnostic::{Location, Source};
use crate::quantity::setting::toml_string;

/// The entries of a table, by key.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    pub(crate) entries: BTreeMap<String, Entry>,
}

/// A key and what it holds.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) key: Location,
    pub(crate) node: Node,
}

/// A value and its place; of a `[table]` the place is its header.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) value: Value,
    pub(crate) location: Location,
}

/// What TOML can hold.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    Integer(Result<i64, NumberFault>),
    Float(Result<f64, NumberFault>),
    Boolean(bool),
    DateTime,
    Array(Vec<Node>),
    Table(Table),
}

/// Why a number as written cannot be computed with. Kept until the number is asked for, so that all
/// problems of a file are told together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NumberFault {
    /// `nan`.
    NotANumber,
    /// `inf`.
    Infinite,
    /// Rounds to infinity, as `1e400` does.
    TooLarge,
    /// Rounds to zero, though it is not zero, as `1e-400` does.
    TooSmall,
    /// An integer of more than 64 bits.
    TooManyDigits,
}

impl Table {
    /// Takes over a table parsed by `toml` from the text that begins at `offset` in `source`.
    pub(crate) fn from_toml(table: DeTable<'_>, source: &Arc<Source>, offset: usize) -> Self {
        let entries = table
            .into_iter()
            .map(|(key, value)| {
                let entry = Entry {
                    key: Location::new(source, moved(key.span(), offset)),
                    node: Node::from_toml(value.span(), value.into_inner(), source, offset),
                };
                (key.into_inner().into_owned(), entry)
            })
            .collect();
        Self { entries }
    }

    /// Visits every text in the table, and in those below, but titles.
    pub(in crate::input) fn for_each_text(&self, visit: &mut dyn FnMut(&str, &Location)) {
        for (_, entry) in self.entries.iter().filter(|(key, _)| *key != "title") {
            entry.node.for_each_text(visit);
        }
    }

    /// The table below that stands under a key.
    pub(in crate::input) fn table(&self, key: &str) -> Option<&Table> {
        match &self.entries.get(key)?.node.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// The table as TOML under this header, its tables inline.
    pub(in crate::input) fn toml(&self, header: &str) -> String {
        let entries = self.entries.iter();
        let lines = entries.map(|(key, entry)| format!("{key} = {}\n", entry.node.value.toml()));
        format!("[{header}]\n{}", lines.collect::<String>())
    }
}

impl Node {
    fn for_each_text(&self, visit: &mut dyn FnMut(&str, &Location)) {
        match &self.value {
            Value::Text(text) => visit(text, &self.location),
            Value::Array(items) => items.iter().for_each(|item| item.for_each_text(visit)),
            Value::Table(table) => table.for_each_text(visit),
            _ => {}
        }
    }

    /// Takes over a value parsed by `toml` at `span` of the text that begins at `offset` in `source`.
    pub(crate) fn from_toml(
        span: Range<usize>,
        value: DeValue<'_>,
        source: &Arc<Source>,
        offset: usize,
    ) -> Self {
        let value = match value {
            DeValue::String(text) => Value::Text(text.into_owned()),
            DeValue::Integer(integer) => Value::Integer(parse_integer(&integer)),
            DeValue::Float(float) => Value::Float(parse_float(&float)),
            DeValue::Boolean(boolean) => Value::Boolean(boolean),
            DeValue::Datetime(_) => Value::DateTime,
            DeValue::Array(array) => Value::Array(
                array
                    .into_iter()
                    .map(|item| Self::from_toml(item.span(), item.into_inner(), source, offset))
                    .collect(),
            ),
            DeValue::Table(table) => Value::Table(Table::from_toml(table, source, offset)),
        };
        Self {
            value,
            location: Location::new(source, moved(span, offset)),
        }
    }

    /// An empty table, made for the sake of a key.
    pub(in crate::input) fn empty_table(key: &Location) -> Self {
        Self {
            value: Value::Table(Table::default()),
            location: key.clone(),
        }
    }

    /// What is here, with its article, for `found ...`.
    pub(crate) fn describe(&self) -> &'static str {
        self.value.describe()
    }
}

impl Value {
    /// The value as TOML. A number that cannot be computed with has been refused before, and is not a number here.
    fn toml(&self) -> String {
        match self {
            Self::Text(text) => toml_string(text),
            Self::Integer(Ok(integer)) => integer.to_string(),
            Self::Float(Ok(float)) => format!("{float:?}"),
            Self::Integer(Err(_)) | Self::Float(Err(_)) | Self::DateTime => "nan".to_owned(),
            Self::Boolean(truth) => truth.to_string(),
            Self::Array(items) => {
                let items: Vec<String> = items.iter().map(|item| item.value.toml()).collect();
                format!("[{}]", items.join(", "))
            }
            Self::Table(table) => {
                let entries = table.entries.iter();
                let entries: Vec<String> = entries
                    .map(|(key, entry)| format!("{key} = {}", entry.node.value.toml()))
                    .collect();
                format!("{{ {} }}", entries.join(", "))
            }
        }
    }

    /// As [`Node::describe`].
    pub(crate) fn describe(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Integer(_) => "an integer",
            Self::Float(_) => "a float",
            Self::Boolean(_) => "a boolean",
            Self::DateTime => "a date or time",
            Self::Array(_) => "an array",
            Self::Table(_) => "a table",
        }
    }
}

fn moved(span: Range<usize>, offset: usize) -> Range<usize> {
    span.start + offset..span.end + offset
}

fn parse_integer(integer: &DeInteger<'_>) -> Result<i64, NumberFault> {
    i64::from_str_radix(integer.as_str(), integer.radix()).map_err(|_| NumberFault::TooManyDigits)
}

fn parse_float(float: &DeFloat<'_>) -> Result<f64, NumberFault> {
    let text = float.as_str();
    let value: f64 = text.parse().map_err(|_| NumberFault::NotANumber)?;
    let mantissa = text.split(['e', 'E']).next().unwrap_or_default();
    if value.is_nan() {
        Err(NumberFault::NotANumber)
    } else if value.is_infinite() && text.contains("inf") {
        Err(NumberFault::Infinite)
    } else if value.is_infinite() {
        Err(NumberFault::TooLarge)
    } else if value == 0.0 && mantissa.contains(|digit| matches!(digit, '1'..='9')) {
        Err(NumberFault::TooSmall)
    } else {
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(text: &str) -> Result<f64, NumberFault> {
        let source = Source::file("test", text);
        let value = DeValue::parse(source.text()).expect("the tests below hold valid TOML");
        match Node::from_toml(value.span(), value.into_inner(), &source, 0).value {
            Value::Float(float) => float,
            Value::Integer(integer) => integer.map(|integer| integer as f64),
            other => panic!("not a number: {other:?}"),
        }
    }

    #[test]
    fn numbers_are_read_in_every_notation_of_toml() {
        for (text, value) in [
            ("1_000", 1000.0),
            ("0xff", 255.0),
            ("0b11", 3.0),
            ("-5", -5.0),
            ("+1.5e-3", 1.5e-3),
            ("0.0e-400", 0.0),
            ("-0.0", 0.0),
            ("4.9e-324", 4.9e-324),
        ] {
            assert_eq!(number(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn numbers_that_cannot_be_computed_with_say_why() {
        for (text, fault) in [
            ("nan", NumberFault::NotANumber),
            ("-nan", NumberFault::NotANumber),
            ("-inf", NumberFault::Infinite),
            ("1e400", NumberFault::TooLarge),
            ("-1e400", NumberFault::TooLarge),
            ("1e-400", NumberFault::TooSmall),
            ("9223372036854775808", NumberFault::TooManyDigits),
        ] {
            assert_eq!(number(text), Err(fault), "{text}");
        }
    }
}
