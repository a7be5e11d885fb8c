//! The kinds of value a key can have: how each is read, what messages call it, and an example of it.

use std::collections::HashMap;
use std::ops::RangeInclusive;

use serde_json::{Value as Json, json};

use super::Located;
use super::limits::Limits;
use super::row::Rows;
use super::similar::similar;
use super::tree::{Node, NumberFault, Value};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::quantity::{self, Dimension, QuantityError};

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
    fn scalar(&self, _controlled: Dimension) -> Option<Scalar> {
        None
    }

    /// Whether its keys are written behind a dot, those of [`Self::dotted`].
    fn has_dotted_keys(&self) -> bool {
        false
    }

    /// Parts of its JSON Schema that are referred to by these names.
    fn definitions(&self) -> serde_json::Map<String, Json> {
        serde_json::Map::new()
    }

    /// Keys with dots that may be written, in quotes, in place of a table below, and what a JSON Schema says of each.
    fn dotted(&self) -> serde_json::Map<String, Json> {
        serde_json::Map::new()
    }

    /// The same of keys that lead into tables and lists, by the pattern of each.
    fn dotted_patterns(&self) -> serde_json::Map<String, Json> {
        serde_json::Map::new()
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

/// A number: bare, or a quantity, which is a string with a unit or a bare number in SI units and is read as its SI value.
#[derive(Clone, Copy)]
pub(crate) struct Scalar {
    dimension: Option<Dimension>,
    limits: Limits,
    /// In place of that of the dimension, as TOML.
    example: Option<&'static str>,
}

/// A quantity of any size.
pub(crate) const fn quantity(dimension: Dimension) -> Scalar {
    Scalar {
        dimension: Some(dimension),
        limits: Limits::NONE,
        example: None,
    }
}

/// A bare number of any size, with an example.
pub(crate) const fn number(example: &'static str) -> Scalar {
    Scalar {
        dimension: None,
        limits: Limits::NONE,
        example: Some(example),
    }
}

impl Scalar {
    /// The same within limits.
    pub(crate) const fn within(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }

    pub(crate) const fn above_zero(self) -> Self {
        self.within(Limits::ABOVE_ZERO)
    }

    pub(crate) const fn not_negative(self) -> Self {
        self.within(Limits::NOT_NEGATIVE)
    }

    /// The same with what to write in place of a value beyond the limits.
    pub(crate) const fn or_else(self, instead: &'static str) -> Self {
        self.within(self.limits.or_else(instead))
    }

    /// The same with another example than that of the dimension, as TOML.
    pub(crate) const fn such_as(self, example: &'static str) -> Self {
        Self {
            example: Some(example),
            ..self
        }
    }

    /// `None` for a bare number.
    pub(crate) fn dimension(&self) -> Option<Dimension> {
        self.dimension
    }

    fn help(&self, node: &Node, spot: &Spot<'_>) -> String {
        if self.dimension.is_none() {
            return such_as(self, node, spot);
        }
        let written = spot.write(&node.location, &self.example());
        format!("write a quantity with its unit, such as {written}")
    }

    fn number(&self, node: &Node, spot: &Spot<'_>) -> Result<f64, Diagnostic> {
        match (&node.value, self.dimension) {
            (Value::Integer(_) | Value::Float(_), _) => finite(self, node, spot),
            (Value::Text(text), Some(dimension)) => parse(text, dimension).map_err(|error| {
                must_be(spot, &self.expected(), node)
                    .because(error.to_string())
                    .help(self.help(node, spot))
            }),
            (Value::Text(text), None) => {
                let diagnostic = self.wrong_type(node, spot);
                Err(match text.trim().parse::<f64>() {
                    Ok(number) if number.is_finite() => {
                        let written = spot.write(&node.location, &shortest(number));
                        diagnostic.help(format!("write it without quotes: {written}"))
                    }
                    _ => diagnostic.help(self.help(node, spot)),
                })
            }
            _ => Err(self.wrong_type(node, spot).help(self.help(node, spot))),
        }
    }
}

/// A quantity with its unit. An angular frequency may be given in Hz and a frequency in rad/s: the unit tells which is meant.
fn parse(text: &str, dimension: Dimension) -> Result<f64, QuantityError> {
    use std::f64::consts::TAU;
    quantity::parse(text, dimension).or_else(|error| match dimension {
        Dimension::AngularFrequency => quantity::parse(text, Dimension::Frequency)
            .map(|hertz| hertz * TAU)
            .map_err(|_| error),
        Dimension::Frequency => quantity::parse(text, Dimension::AngularFrequency)
            .map(|angular| angular / TAU)
            .map_err(|_| error),
        _ => Err(error),
    })
}

impl Describe for Scalar {
    fn scalar(&self, _controlled: Dimension) -> Option<Scalar> {
        Some(*self)
    }

    fn expected(&self) -> String {
        let limits = self.limits.qualify(self.dimension);
        match self.dimension {
            Some(dimension) => format!("{dimension}{limits}"),
            None => format!("a number{limits}"),
        }
    }

    fn example(&self) -> String {
        match (self.example, self.dimension) {
            (Some(example), _) => example.to_owned(),
            (None, Some(dimension)) => format!("\"{}\"", dimension.example()),
            (None, None) => "1.0".to_owned(),
        }
    }

    fn schema(&self) -> Json {
        let mut number = self.limits.schema();
        number["type"] = json!("number");
        let Some(dimension) = self.dimension else {
            return number;
        };
        let mut texts = vec![dimension];
        texts.extend(match dimension {
            Dimension::AngularFrequency => Some(Dimension::Frequency),
            Dimension::Frequency => Some(Dimension::AngularFrequency),
            _ => None,
        });
        let text = |dimension: Dimension| {
            let name = text_name(dimension, self.limits.allow_negative());
            json!({ "$ref": format!("#/$defs/{name}") })
        };
        let mut any: Vec<Json> = texts.into_iter().map(text).collect();
        any.push(number);
        json!({ "anyOf": any })
    }
}

impl Kind for Scalar {
    type Value = f64;

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<f64, Diagnostics> {
        let value = self.number(node, spot)?;
        if self.limits.contains(value) {
            return Ok(value);
        }
        let message = format!("`{}` {}", spot.path, self.limits.rule(self.dimension));
        let help = match self.limits.instead() {
            "" => such_as(self, node, spot),
            instead => instead.to_owned(),
        };
        Err(Diagnostic::at(&node.location, message).help(help).into())
    }

    fn written(&self, value: &f64) -> Json {
        match self.dimension {
            Some(dimension) => json!(quantity::format_si(*value, dimension)),
            None => json!(value),
        }
    }
}

/// What a JSON Schema calls the texts of a dimension.
fn text_name(dimension: Dimension, allow_negative: bool) -> String {
    let words = dimension.to_string();
    let name = words
        .split_once(' ')
        .map_or("", |(_, name)| name)
        .replace(' ', "-");
    match allow_negative {
        true => name,
        false => format!("{name}-not-negative"),
    }
}

/// Definitions of the texts of every dimension, for a JSON Schema that refers to them.
pub(crate) fn text_definitions() -> Vec<(String, Json)> {
    let all = Dimension::ALL
        .into_iter()
        .flat_map(|d| [(d, true), (d, false)]);
    all.map(|(dimension, allow_negative)| {
        let definition = json!({
            "type": "string",
            "pattern": quantity::pattern(dimension, allow_negative),
            "description": format!("{dimension} with its unit, such as \"{}\"", dimension.example()),
        });
        (text_name(dimension, allow_negative), definition)
    })
    .collect()
}

/// A quantity whose dimension another key decides: one of these.
#[derive(Clone, Copy)]
pub(crate) struct Dependent {
    pub(crate) dimensions: &'static [Dimension],
    pub(crate) limits: Limits,
}

/// A kind of which a part is decided by another key.
pub(crate) trait Decided {
    type Kind: Kind;

    /// The kind, once the dimension is known.
    fn of(&self, dimension: Dimension) -> Self::Kind;
}

impl Decided for Dependent {
    type Kind = Scalar;

    fn of(&self, dimension: Dimension) -> Scalar {
        quantity(dimension).within(self.limits)
    }
}

impl Describe for Dependent {
    fn scalar(&self, controlled: Dimension) -> Option<Scalar> {
        Some(self.of(controlled))
    }

    fn expected(&self) -> String {
        let names = self.dimensions.iter().map(Dimension::to_string);
        let names: Vec<String> = names.collect();
        format!("{}{}", names.join(" or "), self.limits.qualify(None))
    }

    fn example(&self) -> String {
        self.of(self.dimensions[0]).example()
    }

    fn schema(&self) -> Json {
        let dimensions = self.dimensions.iter();
        let ways: Vec<Json> = dimensions
            .map(|dimension| self.of(*dimension).schema())
            .collect();
        json!({ "anyOf": ways })
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
pub(crate) struct Integer(pub(crate) RangeInclusive<usize>);

impl Describe for Integer {
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
pub(crate) struct Choice<T: 'static>(pub(crate) &'static [(&'static str, T)]);

impl<T: Clone + PartialEq + Sync> Describe for Choice<T> {
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

    fn schema(&self) -> Json {
        json!({ "enum": self.words() })
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
        let Value::Text(text) = &node.value else {
            let help = such_as(self, node, spot);
            return Err(self.wrong_type(node, spot).help(help).into());
        };
        if let Some((_, value)) = self.0.iter().find(|(word, _)| word == text) {
            return Ok(value.clone());
        }
        let diagnostic = must_be(spot, &self.expected(), node);
        let diagnostic = match similar(text, &self.words()) {
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
        match *self.entries.end() {
            2 => format!("an array of two, each {}", self.item.expected()),
            _ => format!("an array, each item {}", self.item.expected()),
        }
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
                        Ok(value) => values.push(Located {
                            value,
                            location: item.location.clone(),
                            path,
                        }),
                        Err(diagnostics) => found.extend(diagnostics),
                    }
                }
            }
            Value::Text(_) | Value::Integer(_) | Value::Float(_) => values.push(Located {
                value: self.item.convert(node, spot)?,
                path: spot.path.to_owned(),
                location: node.location.clone(),
            }),
            _ => {
                let help = such_as(self, node, spot);
                return Err(self.wrong_type(node, spot).help(help).into());
            }
        }
        if found.is_empty() {
            self.check(&values, node, spot, &found);
        }
        found.into_result(Some(values))
    }
}

impl Decided for Array<Dependent> {
    type Kind = Array<Scalar>;

    fn of(&self, dimension: Dimension) -> Array<Scalar> {
        Array {
            item: self.item.of(dimension),
            entries: self.entries.clone(),
            repeats: self.repeats,
            instead: self.instead,
        }
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
