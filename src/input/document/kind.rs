//! The kinds of value a key can have: how each is read, what messages call it, and an example of it.

use std::ops::RangeInclusive;

use super::Located;
use super::similar::similar;
use super::tree::{Node, NumberFault, Value};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::quantity::{self, Dimension};

/// Characters of the user's text repeated in a message.
const MAX_QUOTED: usize = 32;

/// Integer shown as an example, where the range allows it.
const EXAMPLE_INTEGER: usize = 100;

/// The key a value belongs to.
pub(super) struct Spot<'a> {
    /// Full dotted key, for messages.
    pub(super) path: &'a str,
    /// The key alone, as written in its table; absent for an item of an array.
    pub(super) key: Option<&'a str>,
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
}

/// A kind of value.
pub(super) trait Kind {
    type Value;

    /// What is expected, with its article: `a force`.
    fn expected(&self) -> String;

    /// The value of an example, as TOML.
    fn example(&self) -> String;

    /// The value at `node`, or everything that is wrong with it.
    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<Self::Value, Diagnostics>;

    /// A value of another type than expected.
    fn wrong_type(&self, node: &Node, spot: &Spot<'_>) -> Diagnostic {
        must_be(spot, &self.expected(), node).because(format!("found {}", node.describe()))
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

/// A quantity: a string with a unit, or a bare number in SI units. Read as its SI value.
pub(super) struct Quantity(pub(super) Dimension);

impl Kind for Quantity {
    type Value = f64;

    fn expected(&self) -> String {
        self.0.to_string()
    }

    fn example(&self) -> String {
        format!("\"{}\"", self.0.example())
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<f64, Diagnostics> {
        let help = || {
            let written = spot.write(&node.location, &self.example());
            format!("write a quantity with its unit, such as {written}")
        };
        match &node.value {
            Value::Text(text) => quantity::parse(text, self.0).map_err(|error| {
                must_be(spot, &self.expected(), node)
                    .because(error.to_string())
                    .help(help())
                    .into()
            }),
            Value::Integer(_) | Value::Float(_) => Ok(finite(self, node, spot)?),
            _ => Err(self.wrong_type(node, spot).help(help()).into()),
        }
    }
}

/// A bare number.
pub(super) struct Number;

impl Kind for Number {
    type Value = f64;

    fn expected(&self) -> String {
        "a number".to_owned()
    }

    fn example(&self) -> String {
        "1e-4".to_owned()
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<f64, Diagnostics> {
        match &node.value {
            Value::Integer(_) | Value::Float(_) => Ok(finite(self, node, spot)?),
            Value::Text(text) => {
                let diagnostic = self.wrong_type(node, spot);
                let diagnostic = match text.trim().parse::<f64>() {
                    Ok(number) if number.is_finite() => {
                        let written = spot.write(&node.location, &shortest(number));
                        diagnostic.help(format!("write it without quotes: {written}"))
                    }
                    _ => diagnostic.help(such_as(self, node, spot)),
                };
                Err(diagnostic.into())
            }
            _ => {
                let help = such_as(self, node, spot);
                Err(self.wrong_type(node, spot).help(help).into())
            }
        }
    }
}

fn such_as(kind: &impl Kind, node: &Node, spot: &Spot<'_>) -> String {
    let written = spot.write(&node.location, &kind.example());
    format!("write {}, such as {written}", kind.expected())
}

/// A number as TOML reads it back.
fn shortest(number: f64) -> String {
    // Debug keeps the decimal point and switches to an exponent where Display would write out zeros.
    format!("{number:?}")
}

/// The number at `node`, which holds an integer or a float.
fn finite(kind: &impl Kind, node: &Node, spot: &Spot<'_>) -> Result<f64, Diagnostic> {
    let number = match &node.value {
        Value::Integer(integer) => integer.map(|integer| integer as f64),
        Value::Float(float) => *float,
        _ => return Err(kind.wrong_type(node, spot)),
    };
    number.map_err(|fault| number_fault(fault, kind, node, spot))
}

fn number_fault(fault: NumberFault, kind: &impl Kind, node: &Node, spot: &Spot<'_>) -> Diagnostic {
    let example = such_as(kind, node, spot);
    let (because, help) = match fault {
        NumberFault::NotANumber => ("`nan` is not a number", example),
        NumberFault::Infinite => ("not finite", example),
        NumberFault::TooLarge => (
            "beyond the largest number, 1.8e308",
            format!("check the exponent; {example}"),
        ),
        NumberFault::TooSmall => (
            "below the smallest number, 4.9e-324",
            format!("check the exponent, or write `0.0`; {example}"),
        ),
        NumberFault::TooManyDigits => (
            "an integer of more than 64 bits",
            format!("write it with an exponent; {example}"),
        ),
    };
    must_be(spot, &kind.expected(), node)
        .because(because)
        .help(help)
}

/// An integer within a range.
pub(super) struct Integer(pub(super) RangeInclusive<usize>);

impl Kind for Integer {
    type Value = usize;

    fn expected(&self) -> String {
        match (*self.0.start(), *self.0.end()) {
            (1, usize::MAX) => "a positive integer".to_owned(),
            (least, usize::MAX) => format!("an integer of at least {least}"),
            (least, most) => format!("an integer from {least} to {most}"),
        }
    }

    fn example(&self) -> String {
        let example = EXAMPLE_INTEGER.min(*self.0.end()).max(*self.0.start());
        example.to_string()
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<usize, Diagnostics> {
        let probably = match &node.value {
            Value::Integer(integer) => {
                let within = integer
                    .ok()
                    .and_then(|integer| usize::try_from(integer).ok());
                return match within.filter(|integer| self.0.contains(integer)) {
                    Some(integer) => Ok(integer),
                    None => Err(must_be(spot, &self.expected(), node)
                        .because("out of this range")
                        .help(such_as(self, node, spot))
                        .into()),
                };
            }
            // 2^53: up to here every integer is a float, so the cast keeps the value.
            Value::Float(Ok(float)) if float.fract() == 0.0 && (0.0..9e15).contains(float) => {
                Some(*float as usize)
            }
            Value::Text(text) => text.trim().parse().ok(),
            _ => None,
        };
        let diagnostic = self.wrong_type(node, spot);
        let help = match probably.filter(|integer| self.0.contains(integer)) {
            Some(integer) => {
                let written = spot.write(&node.location, &integer.to_string());
                format!("write {written}")
            }
            None => such_as(self, node, spot),
        };
        Err(diagnostic.help(help).into())
    }
}

/// `true` or `false`.
pub(super) struct Boolean;

impl Kind for Boolean {
    type Value = bool;

    fn expected(&self) -> String {
        "`true` or `false`".to_owned()
    }

    fn example(&self) -> String {
        "true".to_owned()
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
pub(super) struct Text;

impl Kind for Text {
    type Value = String;

    fn expected(&self) -> String {
        "a string".to_owned()
    }

    fn example(&self) -> String {
        "\"...\"".to_owned()
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<String, Diagnostics> {
        let written = node.location.text();
        let is_word = !written.is_empty() && !written.contains(['"', '\'', '\\', '\n', '[', '{']);
        let help = match &node.value {
            Value::Text(text) => return Ok(text.clone()),
            _ if is_word && node.location.source().is_flag() => {
                format!("write `--set '{}=\"{written}\"'`", spot.path)
            }
            _ if is_word => {
                let in_quotes = spot.write(&node.location, &format!("\"{written}\""));
                format!("write it in quotes: {in_quotes}")
            }
            _ => such_as(self, node, spot),
        };
        Err(self.wrong_type(node, spot).help(help).into())
    }
}

/// One of a few words, each standing for a value.
pub(super) struct Choice<'a, T>(pub(super) &'a [(&'a str, T)]);

impl<T: Copy> Kind for Choice<'_, T> {
    type Value = T;

    fn expected(&self) -> String {
        let words: Vec<String> = self
            .0
            .iter()
            .map(|(word, _)| format!("\"{word}\""))
            .collect();
        match words.split_last() {
            Some((last, [])) => last.clone(),
            Some((last, others)) => format!("{} or {last}", others.join(", ")),
            None => "absent".to_owned(),
        }
    }

    fn example(&self) -> String {
        let word = self.0.first().map_or("...", |(word, _)| word);
        format!("\"{word}\"")
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<T, Diagnostics> {
        let Value::Text(text) = &node.value else {
            let help = such_as(self, node, spot);
            return Err(self.wrong_type(node, spot).help(help).into());
        };
        if let Some((_, value)) = self.0.iter().find(|(word, _)| word == text) {
            return Ok(*value);
        }
        let words: Vec<&str> = self.0.iter().map(|(word, _)| *word).collect();
        let diagnostic = must_be(spot, &self.expected(), node);
        let diagnostic = match similar(text, &words) {
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

/// An array whose items are all of one kind, each with its own place.
pub(super) struct Array<K>(pub(super) K);

impl<K: Kind> Kind for Array<K> {
    type Value = Vec<Located<K::Value>>;

    fn expected(&self) -> String {
        format!("an array, each item {}", self.0.expected())
    }

    fn example(&self) -> String {
        format!("[{}]", self.0.example())
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<Self::Value, Diagnostics> {
        let Value::Array(items) = &node.value else {
            let help = such_as(self, node, spot);
            return Err(self.wrong_type(node, spot).help(help).into());
        };
        let mut values = Vec::with_capacity(items.len());
        let found = Problems::new();
        for (index, item) in items.iter().enumerate() {
            let path = format!("{}[{index}]", spot.path);
            let spot = Spot {
                path: &path,
                key: None,
            };
            match self.0.convert(item, &spot) {
                Ok(value) => values.push(Located {
                    value,
                    path,
                    location: item.location.clone(),
                }),
                Err(diagnostics) => found.extend(diagnostics),
            }
        }
        found.into_result(Some(values))
    }
}
