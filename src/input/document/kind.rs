//! The kinds of value a key can have: how each is read, what messages call it, and an example of it.

mod array;
mod scalar;

use std::ops::RangeInclusive;

use serde_json::{Value as Json, json};

use super::Located;
use super::reader::TableReader;
use super::row::Rows;
use super::similar::similar;
use super::tree::{Node, Table as TomlTable, Value};
use crate::input::axis::AxisOf;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::quantity::Dimension;
use crate::quantity::block::alternatives;
use crate::quantity::key::expected_integer;
pub(crate) use crate::quantity::key::{Number, number, quantity};
pub(crate) use array::{Array, list, pair};
pub(crate) use scalar::{Decided, Dependent, text_definitions};

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
        table: &TomlTable,
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

/// What can be said of the values of a key, whatever they are.
pub(crate) trait Describe: Sync {
    /// What is expected, with its article: `a force`.
    fn expected(&self) -> String;

    /// The value of an example, as TOML.
    fn example(&self) -> String;

    /// What a JSON Schema says of it.
    fn schema(&self) -> Json;

    /// Words that the value may be.
    fn words(&self) -> Vec<&'static str> {
        Vec::new()
    }

    /// The keys below, where the value is a table or an array of tables.
    fn rows(&self) -> Option<&'static Rows> {
        None
    }

    /// Whether what stands there is a list.
    fn is_list(&self) -> bool {
        false
    }

    /// What the number is, where the value is one; `controlled` is the dimension of what the drive controls.
    fn number(&self, _controlled: Dimension) -> Option<Number> {
        None
    }

    /// The axes of a sweep over numbers of a block, where the value is those.
    fn axes(&self) -> Option<&AxisOf> {
        None
    }
}

/// A kind of value.
pub(crate) trait Kind: Describe {
    type Value: Clone + Sync;

    /// The value at `node`, or everything that is wrong with it.
    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<Self::Value, Diagnostics>;

    /// A value as it is written in a file.
    fn written(&self, value: &Self::Value) -> Json;

    /// A value of another type than expected.
    fn wrong_type(&self, node: &Node, spot: &Spot<'_>) -> Diagnostic {
        must_be(spot, &self.expected(), node).because(format!("found {}", node.describe()))
    }

    /// What to write, with an example.
    fn advice(&self, node: &Node, spot: &Spot<'_>) -> String {
        let written = spot.write(&node.location, &self.example());
        format!("write {}, such as {written}", self.expected())
    }

    /// The same of a value of another type, with what to write.
    fn refused(&self, node: &Node, spot: &Spot<'_>) -> Diagnostics {
        let help = self.advice(node, spot);
        self.wrong_type(node, spot).help(help).into()
    }
}

fn must_be(spot: &Spot<'_>, expected: &str, node: &Node) -> Diagnostic {
    let message = format!("`{}` must be {expected}", spot.path);
    Diagnostic::at(&node.location, message)
}

/// User text in double quotes, shortened and without control characters.
fn quoted(text: &str) -> String {
    let mut shown: String = text.chars().take(MAX_QUOTED).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    format!("\"{}\"", shown.escape_debug())
}

/// An integer within a range.
pub(crate) struct Integer(pub(crate) RangeInclusive<usize>);

impl Describe for Integer {
    fn expected(&self) -> String {
        expected_integer(&self.0)
    }

    fn example(&self) -> String {
        let example = EXAMPLE_INTEGER.min(*self.0.end()).max(*self.0.start());
        example.to_string()
    }

    fn schema(&self) -> Json {
        let mut schema = json!({ "type": "integer", "minimum": self.0.start() });
        if *self.0.end() < i64::MAX as usize {
            schema["maximum"] = json!(self.0.end());
        }
        schema
    }
}

impl Kind for Integer {
    type Value = usize;

    fn written(&self, value: &usize) -> Json {
        json!(value)
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<usize, Diagnostics> {
        let fits = |integer: &usize| self.0.contains(integer);
        let probably: Option<usize> = match &node.value {
            Value::Integer(integer) => {
                let integer = integer.ok().and_then(|integer| integer.try_into().ok());
                return integer.filter(fits).ok_or_else(|| {
                    must_be(spot, &self.expected(), node)
                        .because("out of this range")
                        .help(self.advice(node, spot))
                        .into()
                });
            }
            // 2^53: up to here every integer is a float, so the cast keeps the value.
            Value::Float(Ok(float)) if float.fract() == 0.0 && (0.0..9e15).contains(float) => {
                Some(*float as usize)
            }
            Value::Text(text) => text.trim().parse().ok(),
            _ => None,
        };
        let help = match probably.filter(fits) {
            Some(integer) => {
                let written = spot.write(&node.location, &integer.to_string());
                format!("write {written}")
            }
            None => self.advice(node, spot),
        };
        Err(self.wrong_type(node, spot).help(help).into())
    }
}

/// `true` or `false`.
pub(crate) struct Boolean;

impl Describe for Boolean {
    fn expected(&self) -> String {
        "`true` or `false`".to_owned()
    }

    fn example(&self) -> String {
        "true".to_owned()
    }

    fn schema(&self) -> Json {
        json!({ "type": "boolean" })
    }
}

impl Kind for Boolean {
    type Value = bool;

    fn written(&self, value: &bool) -> Json {
        json!(value)
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<bool, Diagnostics> {
        let meant = match &node.value {
            Value::Boolean(boolean) => return Ok(*boolean),
            Value::Text(text) => match text.trim().to_lowercase().as_str() {
                "true" | "yes" | "on" => "true",
                "false" | "no" | "off" => "false",
                _ => "true",
            },
            _ => "true",
        };
        let written = spot.write(&node.location, meant);
        let diagnostic = self.wrong_type(node, spot);
        Err(diagnostic.help(format!("write {written}")).into())
    }
}

/// Any text.
pub(crate) struct Text;

impl Describe for Text {
    fn expected(&self) -> String {
        "a string".to_owned()
    }

    fn example(&self) -> String {
        "\"...\"".to_owned()
    }

    fn schema(&self) -> Json {
        json!({ "type": "string" })
    }
}

impl Kind for Text {
    type Value = String;

    fn written(&self, value: &String) -> Json {
        json!(value)
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<String, Diagnostics> {
        let written = node.location.text();
        let is_word = !written.is_empty() && !written.contains(['"', '\'', '\\', '\n', '[', '{']);
        let help = match &node.value {
            Value::Text(text) => return without_control_characters(text, node, spot),
            _ if is_word && node.location.source().is_flag() => {
                format!("write `--set '{}=\"{written}\"'`", spot.path)
            }
            _ if is_word => {
                let in_quotes = spot.write(&node.location, &format!("\"{written}\""));
                format!("write it in quotes: {in_quotes}")
            }
            _ => self.advice(node, spot),
        };
        Err(self.wrong_type(node, spot).help(help).into())
    }
}

/// Text that can be printed and drawn: line ends and tabs are the only control characters, and it has no noncharacters, which no
/// SVG or XML may hold.
fn without_control_characters(
    text: &str,
    node: &Node,
    spot: &Spot<'_>,
) -> Result<String, Diagnostics> {
    let is_unfit =
        |c: &char| (c.is_control() && !"\n\t".contains(*c)) || matches!(c, '\u{fffe}' | '\u{ffff}');
    let Some(unfit) = text.chars().find(is_unfit) else {
        return Ok(text.to_owned());
    };
    let problem = must_be(spot, "text without control characters", node);
    let because = format!("it has the character U+{:04X}", u32::from(unfit));
    Err(problem
        .because(because)
        .help("leave that character out")
        .into())
}

/// One of a few words, each standing for a value.
pub(crate) struct Choice<T: 'static>(pub(crate) &'static [(&'static str, T)]);

impl<T: Clone + PartialEq + Sync> Choice<T> {
    fn one_of(&self) -> OneOf {
        OneOf(self.words())
    }
}

impl<T: Clone + PartialEq + Sync> Describe for Choice<T> {
    fn expected(&self) -> String {
        self.one_of().expected()
    }

    fn example(&self) -> String {
        self.one_of().example()
    }

    fn schema(&self) -> Json {
        self.one_of().schema()
    }

    fn words(&self) -> Vec<&'static str> {
        self.0.iter().map(|(word, _)| *word).collect()
    }
}

impl<T: Clone + PartialEq + Sync> Kind for Choice<T> {
    type Value = T;

    fn written(&self, value: &T) -> Json {
        let named = self.0.iter().find(|(_, known)| known == value);
        json!(named.map(|(word, _)| *word))
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<T, Diagnostics> {
        let found = self.one_of().convert(node, spot)?;
        let named = self.0.iter().find(|(word, _)| *word == found);
        let named = named.map(|(_, value)| value.clone());
        named.ok_or_else(|| self.refused(node, spot))
    }
}

/// One of a few words.
pub(crate) struct OneOf(pub(crate) Vec<&'static str>);

impl Describe for OneOf {
    fn expected(&self) -> String {
        alternatives(&self.0)
    }

    fn example(&self) -> String {
        format!("\"{}\"", self.0.first().unwrap_or(&"..."))
    }

    fn schema(&self) -> Json {
        json!({ "enum": self.0 })
    }

    fn words(&self) -> Vec<&'static str> {
        self.0.clone()
    }
}

impl Kind for OneOf {
    type Value = &'static str;

    fn written(&self, word: &&'static str) -> Json {
        json!(word)
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<&'static str, Diagnostics> {
        let Value::Text(text) = &node.value else {
            return Err(self.refused(node, spot));
        };
        if let Some(word) = self.0.iter().find(|word| *word == text) {
            return Ok(word);
        }
        let diagnostic = must_be(spot, &self.expected(), node);
        let diagnostic = match similar(text, &self.0) {
            Some(meant) => {
                let written = spot.write(&node.location, &format!("\"{meant}\""));
                diagnostic
                    .because(format!("did you mean \"{meant}\"?"))
                    .help(format!("write {written}"))
            }
            None => {
                let written = spot.write(&node.location, &self.example());
                diagnostic
                    .because(format!("{} is none of these", quoted(text)))
                    .help(format!("write, for example, {written}"))
            }
        };
        Err(diagnostic.into())
    }
}

/// A table below, with these keys.
pub(crate) struct Table(pub(crate) &'static Rows);

impl Describe for Table {
    fn expected(&self) -> String {
        "a table".to_owned()
    }

    fn example(&self) -> String {
        "{ ... }".to_owned()
    }

    fn schema(&self) -> Json {
        self.0.schema()
    }

    fn rows(&self) -> Option<&'static Rows> {
        Some(self.0)
    }
}

/// An array of tables with these keys, and how many it may have.
pub(crate) struct Tables {
    pub(crate) rows: &'static Rows,
    pub(crate) most: usize,
    /// What to do in place of too many.
    pub(crate) instead: &'static str,
}

impl Describe for Tables {
    fn expected(&self) -> String {
        "an array of tables".to_owned()
    }

    fn example(&self) -> String {
        "[{ ... }]".to_owned()
    }

    fn schema(&self) -> Json {
        json!({ "type": "array", "items": self.rows.schema(), "maxItems": self.most })
    }

    fn rows(&self) -> Option<&'static Rows> {
        Some(self.rows)
    }

    fn is_list(&self) -> bool {
        true
    }
}
