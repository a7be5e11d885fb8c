//! How a value of each kind is read, an example of it, and what a JSON Schema says of it.

mod list;
mod scalar;

use std::ops::RangeInclusive;

use serde_json::{Value as Json, json};

use super::Located;
use super::reader::TableReader;
use super::schema;
use super::similar::similar;
use super::tree::{Node, Table, Value as Toml};
use crate::input::axis::AxisOf;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::input::points;
use crate::quantity::format_si;
use crate::quantity::key::Kind;
use crate::quantity::setting::Value;
pub(crate) use scalar::text_definitions;

/// Characters of the user's text repeated in a message.
const MAX_QUOTED: usize = 32;

/// Integer shown as an example, where the range allows it.
const EXAMPLE_INTEGER: usize = 100;

/// The key a value belongs to.
pub(crate) struct Spot<'a> {
    /// Full dotted key, for messages.
    pub(crate) path: &'a str,
    /// The key alone, as written in its table; absent for an item of an array.
    pub(crate) key: Option<&'a str>,
}

impl Spot<'_> {
    /// How to write TOML `value` here, in backticks: as a flag where `place` is one.
    fn write(&self, place: &Location, value: &str) -> String {
        match self.key {
            None => format!("`{value}`"),
            Some(_) if place.source().is_flag() => {
                let bare = value.trim_matches('"');
                let argument = format!("{}={bare}", self.path);
                if bare.contains([' ', '"']) {
                    format!("`--set '{argument}'`")
                } else {
                    format!("`--set {argument}`")
                }
            }
            Some(key) => format!("`{key} = {value}`"),
        }
    }

    /// A value with the place of the one at `node`.
    pub(crate) fn located<T>(&self, value: T, node: &Node) -> Located<T> {
        Located {
            value,
            path: self.path.to_owned(),
            location: node.location.clone(),
        }
    }

    /// What is read of the table that the value at `node` is, or everything that is wrong with it.
    pub(crate) fn read_table<T>(
        &self,
        table: &Table,
        node: &Node,
        read: impl FnOnce(TableReader<'_>) -> Option<T>,
    ) -> Result<T, Diagnostics> {
        let (problems, place) = (Problems::new(), node.location.clone());
        let value = read(TableReader::new(
            table,
            place,
            self.path.to_owned(),
            &problems,
        ));
        problems.into_result(value)
    }
}

/// What documents know of a kind of value besides its declaration.
pub(crate) trait Describe {
    /// The value of an example, as TOML.
    fn example(&self) -> String;

    /// What a JSON Schema says of it.
    fn schema(&self) -> Json;
}

impl Describe for Kind {
    fn example(&self) -> String {
        if let Some((item, entries)) = self.item() {
            let item = item.example();
            return match *entries.number.end() {
                2 => format!("[{item}, {item}]"),
                _ => format!("[{item}]"),
            };
        }
        match self {
            Self::Flag => "true".to_owned(),
            Self::Integer(range) => {
                let example = EXAMPLE_INTEGER.min(*range.end()).max(*range.start());
                example.to_string()
            }
            Self::Number(number) => number.example(),
            Self::Word(words) => format!("\"{}\"", words.first().unwrap_or(&"...")),
            Self::Points(number, _) => format!("[{}]", number.example()),
            Self::Table(_) => "{ ... }".to_owned(),
            Self::Tables(..) => "[{ ... }]".to_owned(),
            Self::Either(first, ..) => first.example(),
            Self::Axes(axes) => AxisOf(axes).example(),
            _ => "\"...\"".to_owned(),
        }
    }

    fn schema(&self) -> Json {
        if let Some((item, entries)) = self.item() {
            return list::schema(&item.schema(), entries);
        }
        match self {
            Self::Flag => json!({ "type": "boolean" }),
            Self::Integer(range) => {
                let mut schema = json!({ "type": "integer", "minimum": range.start() });
                if *range.end() < i64::MAX as usize {
                    schema["maximum"] = json!(range.end());
                }
                schema
            }
            Self::Number(number) => number.schema(),
            Self::Word(words) => json!({ "enum": words }),
            Self::Points(number, range) => points::schema(number, range),
            Self::Table(rows) => schema::of_table(rows),
            Self::Tables(rows, most, _) => {
                json!({ "type": "array", "items": schema::of_table(rows), "maxItems": most })
            }
            Self::Either(first, second, _) => json!({ "anyOf": [first.schema(), second.schema()] }),
            Self::Axes(axes) => AxisOf(axes).schema(),
            _ => json!({ "type": "string" }),
        }
    }
}

/// A value as a JSON Schema and the reference have it.
pub(crate) fn json_of(value: &Value) -> Json {
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

/// A value of this kind, which is to be read at this node under this key.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'a> {
    pub(crate) kind: &'a Kind,
    pub(crate) node: &'a Node,
    pub(crate) spot: &'a Spot<'a>,
}

impl Asked<'_> {
    /// The value, or everything that is wrong with it. A table is read key by key instead.
    pub(crate) fn read(&self) -> Result<Value, Diagnostics> {
        if let Some((item, entries)) = self.kind.item() {
            return list::read(self, &item, entries);
        }
        let value = match self.kind {
            Kind::Flag => Value::Flag(self.flag()?),
            Kind::Integer(range) => self.integer(range)?.into(),
            Kind::Number(number) => number.value(self.number(number)?),
            Kind::Text => Value::Text(self.text()?),
            Kind::Word(words) => self.word(words)?.into(),
            Kind::Points(number, _) => Value::Numbers(points::read(self, number)?),
            Kind::Either(first, second, _) => {
                let is_second = match second {
                    Kind::Table(_) => matches!(self.node.value, Toml::Table(_)),
                    Kind::Text => {
                        let words = first.words();
                        !matches!(&self.node.value, Toml::Text(text) if words.contains(&&**text))
                    }
                    _ => !matches!(self.node.value, Toml::Text(_)),
                };
                let kind = if is_second { second } else { first };
                return Asked { kind, ..*self }.read();
            }
            Kind::Table(_) | Kind::Tables(..) | Kind::Axes(_) => return Err(self.refused()),
            // Lists were read above.
            Kind::Numbers(..) | Kind::Texts(_) | Kind::Words(..) => return Err(self.refused()),
        };
        Ok(value)
    }

    fn must(&self, what: &str) -> Diagnostic {
        let message = format!("`{}` must be {what}", self.spot.path);
        Diagnostic::at(&self.node.location, message)
    }

    fn must_be_expected(&self) -> Diagnostic {
        self.must(&self.kind.expected())
    }

    /// A value of another type than expected.
    pub(crate) fn wrong_type(&self) -> Diagnostic {
        let found = format!("found {}", self.node.describe());
        self.must_be_expected().because(found)
    }

    /// TOML `value` as it is written here.
    fn write(&self, value: &str) -> String {
        self.spot.write(&self.node.location, value)
    }

    /// What to write, with an example.
    fn advice(&self) -> String {
        let written = self.write(&self.kind.example());
        format!("write {}, such as {written}", self.kind.expected())
    }

    /// A value of another type than expected, with what to write.
    fn refused(&self) -> Diagnostics {
        self.wrong_type().help(self.advice()).into()
    }

    fn integer(&self, range: &RangeInclusive<usize>) -> Result<usize, Diagnostics> {
        let fits = |integer: &usize| range.contains(integer);
        let probably: Option<usize> = match &self.node.value {
            Toml::Integer(integer) => {
                let integer = integer.ok().and_then(|integer| integer.try_into().ok());
                return integer.filter(fits).ok_or_else(|| {
                    let problem = self.must_be_expected().because("out of this range");
                    problem.help(self.advice()).into()
                });
            }
            // 2^53: up to here every integer is a float, so the cast keeps the value.
            Toml::Float(Ok(float)) if float.fract() == 0.0 && (0.0..9e15).contains(float) => {
                Some(*float as usize)
            }
            Toml::Text(text) => text.trim().parse().ok(),
            _ => None,
        };
        let help = match probably.filter(fits) {
            Some(integer) => format!("write {}", self.write(&integer.to_string())),
            None => self.advice(),
        };
        Err(self.wrong_type().help(help).into())
    }

    fn flag(&self) -> Result<bool, Diagnostics> {
        let meant = match &self.node.value {
            Toml::Boolean(boolean) => return Ok(*boolean),
            Toml::Text(text) => match text.trim().to_lowercase().as_str() {
                "false" | "no" | "off" => "false",
                _ => "true",
            },
            _ => "true",
        };
        let help = format!("write {}", self.write(meant));
        Err(self.wrong_type().help(help).into())
    }

    /// Text that can be printed and drawn: line ends and tabs are the only control characters, and it has no noncharacters, which no
    /// SVG or XML may hold.
    fn text(&self) -> Result<String, Diagnostics> {
        let Toml::Text(text) = &self.node.value else {
            return Err(self.no_text());
        };
        let is_unfit = |c: &char| {
            (c.is_control() && !"\n\t".contains(*c)) || matches!(c, '\u{fffe}' | '\u{ffff}')
        };
        let Some(unfit) = text.chars().find(is_unfit) else {
            return Ok(text.to_owned());
        };
        let because = format!("it has the character U+{:04X}", u32::from(unfit));
        let problem = self.must("text without control characters");
        let problem = problem.because(because);
        Err(problem.help("leave that character out").into())
    }

    fn no_text(&self) -> Diagnostics {
        let written = self.node.location.text();
        let is_word = !written.is_empty() && !written.contains(['"', '\'', '\\', '\n', '[', '{']);
        let help = match is_word {
            true if self.node.location.source().is_flag() => {
                format!("write `--set '{}=\"{written}\"'`", self.spot.path)
            }
            true => {
                let in_quotes = self.write(&format!("\"{written}\""));
                format!("write it in quotes: {in_quotes}")
            }
            false => self.advice(),
        };
        self.wrong_type().help(help).into()
    }

    fn word(&self, words: &'static [&'static str]) -> Result<&'static str, Diagnostics> {
        let Toml::Text(text) = &self.node.value else {
            return Err(self.refused());
        };
        if let Some(word) = words.iter().find(|word| *word == text) {
            return Ok(word);
        }
        let (because, help) = match similar(text, words) {
            Some(meant) => {
                let written = self.write(&format!("\"{meant}\""));
                let because = format!("did you mean \"{meant}\"?");
                (because, format!("write {written}"))
            }
            None => {
                let written = self.write(&self.kind.example());
                let because = format!("{} is none of these", quoted(text));
                (because, format!("write, for example, {written}"))
            }
        };
        let problem = self.must_be_expected().because(because);
        Err(problem.help(help).into())
    }
}

/// User text in double quotes, shortened and without control characters.
fn quoted(text: &str) -> String {
    let mut shown: String = text.chars().take(MAX_QUOTED).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    format!("\"{}\"", shown.escape_debug())
}
