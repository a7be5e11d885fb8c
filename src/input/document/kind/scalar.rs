//! Numbers: bare, or quantities with a unit, whose dimension another key may decide.

use std::f64::consts::TAU;
use std::ops::Bound;

use serde_json::{Value as Json, json};

use super::{Describe, Kind, Spot, must_be};
use crate::input::diagnostic::{Diagnostic, Diagnostics};
use crate::input::document::tree::{Node, NumberFault, Value};
use crate::quantity::key::{Limits, Number, quantity};
use crate::quantity::{self, Dimension, QuantityError};

/// The number under a key.
trait ReadNumber {
    fn at(&self, node: &Node, spot: &Spot<'_>) -> Result<f64, Diagnostic>;
}

impl ReadNumber for Number {
    fn at(&self, node: &Node, spot: &Spot<'_>) -> Result<f64, Diagnostic> {
        let fault = |fault| number_fault(fault, self, node, spot);
        let help = || match self.dimension {
            None => self.advice(node, spot),
            Some(_) => {
                let written = spot.write(&node.location, &self.example());
                format!("write a quantity with its unit, such as {written}")
            }
        };
        match (&node.value, self.dimension) {
            (Value::Integer(integer), _) => integer.map(|integer| integer as f64).map_err(fault),
            (Value::Float(float), _) => float.map_err(fault),
            (Value::Text(text), Some(dimension)) => parse(text, dimension).map_err(|error| {
                must_be(spot, &self.expected(), node)
                    .because(error.to_string())
                    .help(help())
            }),
            (Value::Text(text), None) => {
                let number = text.trim().parse().ok();
                Err(self.wrong_type(node, spot).help(
                    match number.filter(|n: &f64| n.is_finite()) {
                        Some(number) => {
                            // Debug keeps the decimal point, and has an exponent where Display would write out zeros.
                            let written = spot.write(&node.location, &format!("{number:?}"));
                            format!("write it without quotes: {written}")
                        }
                        None => help(),
                    },
                ))
            }
            _ => Err(self.wrong_type(node, spot).help(help())),
        }
    }
}

/// The dimension whose quantities may be given in place of this one: an angular frequency in Hz, a frequency in rad/s.
fn also(dimension: Dimension) -> Option<Dimension> {
    match dimension {
        Dimension::AngularFrequency => Some(Dimension::Frequency),
        Dimension::Frequency => Some(Dimension::AngularFrequency),
        _ => None,
    }
}

/// A quantity with its unit, which tells the dimension where two may be given.
fn parse(text: &str, dimension: Dimension) -> Result<f64, QuantityError> {
    quantity::parse(text, dimension).or_else(|error| {
        let other = also(dimension).and_then(|other| quantity::parse(text, other).ok());
        other.ok_or(error).map(|value| match dimension {
            Dimension::AngularFrequency => value * TAU,
            _ => value / TAU,
        })
    })
}

impl Describe for Number {
    fn number(&self, _controlled: Dimension) -> Option<Number> {
        Some(*self)
    }

    fn expected(&self) -> String {
        self.expected()
    }

    fn example(&self) -> String {
        match (self.example, self.dimension) {
            (Some(example), _) => example.to_owned(),
            (None, Some(dimension)) => format!("\"{}\"", dimension.example()),
            (None, None) => "1.0".to_owned(),
        }
    }

    fn schema(&self) -> Json {
        let mut number = of_limits(&self.limits);
        number["type"] = json!("number");
        let Some(dimension) = self.dimension else {
            return number;
        };
        let text = |dimension: Dimension| {
            let name = text_name(dimension, self.limits.allow_negative());
            json!({ "$ref": format!("#/$defs/{name}") })
        };
        let texts = [dimension].into_iter().chain(also(dimension));
        let any: Vec<Json> = texts.map(text).chain([number]).collect();
        json!({ "anyOf": any })
    }
}

impl Kind for Number {
    type Value = f64;

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<f64, Diagnostics> {
        let value = self.at(node, spot)?;
        if self.limits.contains(value) {
            return Ok(value);
        }
        let message = format!("`{}` {}", spot.path, self.limits.rule(self.dimension));
        let help = match self.limits.instead {
            "" => self.advice(node, spot),
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

/// Limits as a JSON Schema says them of a number.
fn of_limits(limits: &Limits) -> Json {
    let mut schema = json!({});
    let mut say = |bound: Bound<f64>, included: &str, excluded: &str| match bound {
        Bound::Included(limit) => schema[included] = json!(limit),
        Bound::Excluded(limit) => schema[excluded] = json!(limit),
        Bound::Unbounded => {}
    };
    say(limits.low, "minimum", "exclusiveMinimum");
    say(limits.high, "maximum", "exclusiveMaximum");
    schema
}

/// What a JSON Schema calls the texts of a dimension; no path of keys begins so.
fn text_name(dimension: Dimension, allow_negative: bool) -> String {
    let words = dimension.to_string();
    let name = words.split_once(' ').map_or("", |(_, name)| name);
    let name = name.replace(' ', "-");
    match allow_negative {
        true => format!("text-{name}"),
        false => format!("text-{name}-not-negative"),
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
    type Kind = Number;

    fn of(&self, dimension: Dimension) -> Number {
        quantity(dimension).within(self.limits)
    }
}

impl Describe for Dependent {
    fn number(&self, controlled: Dimension) -> Option<Number> {
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

/// A number that cannot be computed with.
fn number_fault(fault: NumberFault, kind: &Number, node: &Node, spot: &Spot<'_>) -> Diagnostic {
    let example = kind.advice(node, spot);
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
