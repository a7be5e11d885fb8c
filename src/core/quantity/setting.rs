//! Settings as a file of this program has them: keys with values in SI units, in tables; and the TOML that they are written as.

use std::borrow::Cow;

use super::{Dimension, format_si};

/// A key with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    pub key: Cow<'static, str>,
    pub value: Value,
}

/// What a key may have, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    Quantity(f64, Dimension),
    Quantities(Vec<f64>, Dimension),
    /// The same, written in a line each.
    QuantityLines(Vec<f64>, Dimension),
    Number(f64),
    Numbers(Vec<f64>),
    /// A number that is written with its power of ten: `1e-4`.
    Tolerance(f64),
    Integer(u64),
    Flag(bool),
    Text(String),
    Texts(Vec<String>),
    /// A table in each line.
    Tables(Vec<Vec<Setting>>),
    /// The same, all of them in one line.
    TablesInLine(Vec<Vec<Setting>>),
}

/// A table of a file, and the tables below it.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    name: &'static str,
    /// Whether it is an item of a list of tables, `[[name]]`.
    is_item: bool,
    settings: Vec<Setting>,
    below: Vec<Self>,
}

impl Setting {
    pub fn new(key: impl Into<Cow<'static, str>>, value: impl Into<Value>) -> Self {
        Self {
            key: key.into(),
            value: value.into(),
        }
    }

    /// A length (m).
    pub fn length(key: &'static str, value_m: f64) -> Self {
        Self::new(key, Value::Quantity(value_m, Dimension::Length))
    }

    /// The same without its unit, as one of many numbers is written.
    #[must_use]
    pub fn bare(self) -> Self {
        let value = match self.value {
            Value::Quantity(number, _) => Value::Number(number),
            Value::Quantities(numbers, _) => Value::Numbers(numbers),
            other => other,
        };
        Self { value, ..self }
    }

    /// The line that gives the setting, without its end.
    pub fn toml(&self) -> String {
        format!("{} = {}", self.key, self.value.toml())
    }
}

impl Value {
    /// The number that it is, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) | Self::Tolerance(number) | Self::Quantity(number, _) => {
                Some(*number)
            }
            _ => None,
        }
    }

    /// As it stands in a file.
    pub fn toml(&self) -> String {
        let quoted = |value: &f64, dimension| format!("\"{}\"", format_si(*value, dimension));
        match self {
            Self::Quantity(value, dimension) => quoted(value, *dimension),
            Self::Quantities(values, dimension) => list(values, |v| quoted(v, *dimension)),
            Self::QuantityLines(values, dimension) => lines(values, |v| quoted(v, *dimension)),
            // Debug keeps the decimal point or the exponent that TOML asks of a float, and loses no bit.
            Self::Number(number) => format!("{number:?}"),
            Self::Numbers(numbers) => list(numbers, |number| format!("{number:?}")),
            Self::Tolerance(number) => format!("{number:e}"),
            Self::Integer(integer) => integer.to_string(),
            Self::Flag(flag) => flag.to_string(),
            Self::Text(text) => toml_string(text),
            Self::Texts(texts) => list(texts, |text| toml_string(text)),
            Self::Tables(tables) => lines(tables, |table| inline(table)),
            Self::TablesInLine(tables) => list(tables, |table| inline(table)),
        }
    }
}

fn list<T>(items: &[T], text: impl Fn(&T) -> String) -> String {
    let items: Vec<String> = items.iter().map(text).collect();
    format!("[{}]", items.join(", "))
}

fn lines<T>(items: &[T], text: impl Fn(&T) -> String) -> String {
    let items = items.iter().map(|item| format!("    {},\n", text(item)));
    format!("[\n{}]", items.collect::<String>())
}

fn inline(table: &[Setting]) -> String {
    let settings: Vec<String> = table.iter().map(Setting::toml).collect();
    format!("{{ {} }}", settings.join(", "))
}

/// A TOML basic string.
pub fn toml_string(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

impl Table {
    /// `[name]`.
    pub fn new(name: &'static str) -> Self {
        Self {
            name,
            is_item: false,
            settings: Vec::new(),
            below: Vec::new(),
        }
    }

    /// The same table as an item of the list `[[name]]`.
    #[must_use]
    pub fn listed(mut self) -> Self {
        self.is_item = true;
        self
    }

    /// With one setting more.
    #[must_use]
    pub fn with(mut self, key: impl Into<Cow<'static, str>>, value: impl Into<Value>) -> Self {
        self.settings.push(Setting::new(key, value));
        self
    }

    /// The same, where there is a value.
    #[must_use]
    pub fn with_some(self, key: &'static str, value: Option<impl Into<Value>>) -> Self {
        match value {
            Some(value) => self.with(key, value),
            None => self,
        }
    }

    /// With these settings more.
    #[must_use]
    pub fn and(mut self, settings: impl IntoIterator<Item = Setting>) -> Self {
        self.settings.extend(settings);
        self
    }

    /// With these tables below it, behind all settings.
    #[must_use]
    pub fn above(mut self, tables: impl IntoIterator<Item = Self>) -> Self {
        self.below.extend(tables);
        self
    }

    /// The table, where it has any setting.
    pub fn unless_empty(self) -> Option<Self> {
        (!self.settings.is_empty()).then_some(self)
    }

    /// The table as text: an empty line stands between it and each below it.
    pub fn toml(&self) -> String {
        self.toml_below("")
    }

    /// The same of a table below the one of this name.
    pub fn toml_below(&self, name: &str) -> String {
        let path = match name {
            "" => self.name.to_owned(),
            above => format!("{above}.{}", self.name),
        };
        let head = match self.is_item {
            true => format!("[[{path}]]\n"),
            false => format!("[{path}]\n"),
        };
        let settings = self.settings.iter().map(|s| s.toml() + "\n");
        let below = self
            .below
            .iter()
            .map(|t| format!("\n{}", t.toml_below(&path)));
        head + &settings.chain(below).collect::<String>()
    }
}

/// Titled text of blocks, each ending with a line, with an empty line before each that says something.
pub fn document(title: &str, blocks: impl IntoIterator<Item = String>) -> String {
    let blocks = blocks.into_iter().filter(|block| !block.is_empty());
    let blocks: String = blocks.map(|block| format!("\n{block}")).collect();
    format!("title = {}\n{blocks}", toml_string(title))
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<usize> for Value {
    fn from(integer: usize) -> Self {
        Self::Integer(integer as u64)
    }
}

impl From<bool> for Value {
    fn from(flag: bool) -> Self {
        Self::Flag(flag)
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_again_as_what_they_say_wherever_they_stand() {
        let length = |value| Value::Quantity(value, Dimension::Length);
        let branch = |time: f64| vec![Setting::new("modulus", 2.0), Setting::new("time", time)];
        let below = Table::new("material")
            .with("name", "a \"[b]\"\n[c]")
            .above([
                Table::new("creep")
                    .with("branches", Value::Tables(vec![branch(1.0), branch(1e-9)])),
                Table::new("alternative")
                    .listed()
                    .with("rows", Value::TablesInLine(vec![branch(3.0)])),
            ]);
        let table = Table::new("indenter")
            .with("radius", length(0.01))
            .with("tolerance", Value::Tolerance(1e-4));
        let text = table.above([below.clone()]).toml();
        assert_eq!(text.lines().next(), Some("[indenter]"));
        assert!(text.contains("radius = \"0.01 m\"\ntolerance = 1e-4\n\n[indenter.material]\n"));
        assert!(text.contains(
            "\n[[indenter.material.alternative]]\nrows = [{ modulus = 2.0, time = 3.0 }]\n"
        ));
        let read: toml::Table = text.parse().unwrap();
        let alone: toml::Table = below.toml().parse().unwrap();
        assert_eq!(read["indenter"]["material"], alone["material"]);
        assert_eq!(alone["material"]["name"].as_str(), Some("a \"[b]\"\n[c]"));
        let item: toml::Table = below.listed().toml_below("sweep").parse().unwrap();
        assert_eq!(item["sweep"]["material"][0], alone["material"]);
    }

    #[test]
    fn an_empty_line_stands_between_blocks_and_none_where_a_block_says_nothing() {
        let blocks = ["[a]\n", "", "[b]\nc = 1\n"].map(str::to_owned);
        assert_eq!(
            document("t", blocks),
            "title = \"t\"\n\n[a]\n\n[b]\nc = 1\n"
        );
    }
}
