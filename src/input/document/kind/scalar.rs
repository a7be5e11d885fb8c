//! Numbers: bare, or quantities with a unit.

use std::f64::consts::TAU;
use std::ops::Bound;

use serde_json::{Value as Json, json};

use super::{Asked, Describe};
use crate::input::diagnostic::{Diagnostic, Diagnostics};
use crate::input::document::tree::{NumberFault, Value};
use crate::quantity::key::{Limits, Number};
use crate::quantity::{self, Dimension, QuantityError};

impl Asked<'_> {
    /// The number, which this kind is.
    pub(super) fn number(&self, number: &Number) -> Result<f64, Diagnostics> {
        let value = self.number_at(number)?;
        if number.limits.contains(value) {
            return Ok(value);
        }
        let rule = number.limits.rule(number.dimension);
        let message = format!("`{}` {rule}", self.spot.path);
        let help = match number.limits.instead {
            "" => self.advice(),
            instead => instead.to_owned(),
        };
        let problem = Diagnostic::at(&self.node.location, message);
        Err(problem.help(help).into())
    }

    fn number_at(&self, number: &Number) -> Result<f64, Diagnostic> {
        let fault = |fault| self.number_fault(fault);
        let help = || match number.dimension {
            None => self.advice(),
            Some(_) => {
                let written = self.write(&number.example());
                format!("write a quantity with its unit, such as {written}")
            }
        };
        match (&self.node.value, number.dimension) {
            (Value::Integer(integer), _) => integer.map(|integer| integer as f64).map_err(fault),
            (Value::Float(float), _) => float.map_err(fault),
            (Value::Text(text), Some(dimension)) => parse(text, dimension).map_err(|error| {
                let problem = self.must_be_expected().because(error.to_string());
                problem.help(help())
            }),
            (Value::Text(text), None) => {
                let meant = text.trim().parse().ok();
                let help = match meant.filter(|n: &f64| n.is_finite()) {
                    Some(meant) => {
                        // Debug keeps the decimal point, and has an exponent where Display would write out zeros.
                        let written = self.write(&format!("{meant:?}"));
                        format!("write it without quotes: {written}")
                    }
                    None => help(),
                };
                Err(self.wrong_type().help(help))
            }
            _ => Err(self.wrong_type().help(help())),
        }
    }

    /// A number that cannot be computed with.
    fn number_fault(&self, fault: NumberFault) -> Diagnostic {
        let example = self.advice();
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
        self.must_be_expected().because(because).help(help)
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
        let text = |dimension: Dimension| {
            let name = text_name(dimension, self.limits.allow_negative());
            json!({ "$ref": format!("#/$defs/{name}") })
        };
        let of_dimension = |dimension: Dimension| {
            let texts = [dimension].into_iter().chain(also(dimension));
            let any: Vec<Json> = texts.map(text).chain([number.clone()]).collect();
            json!({ "anyOf": any })
        };
        let dimensions = self.dimension.into_iter().chain(self.or.iter().copied());
        let mut ways: Vec<Json> = dimensions.map(of_dimension).collect();
        match ways.len() {
            0 => number,
            1 => ways.remove(0),
            _ => json!({ "anyOf": ways }),
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
