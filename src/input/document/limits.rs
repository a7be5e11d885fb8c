//! The limits of a number, and how they are said.

use std::ops::{Bound, Range, RangeBounds};

use serde_json::{Value as Json, json};

use crate::quantity::{Dimension, format_human, format_si, parse};

/// From where to where a number may be, in SI units.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    low: Bound<f64>,
    high: Bound<f64>,
    /// What to write in place of a number beyond them; empty: an example.
    instead: &'static str,
}

impl Limits {
    pub(crate) const NONE: Self = Self::new(Bound::Unbounded, Bound::Unbounded);
    pub(crate) const ABOVE_ZERO: Self = Self::new(Bound::Excluded(0.0), Bound::Unbounded);
    pub(crate) const NOT_NEGATIVE: Self = Self::new(Bound::Included(0.0), Bound::Unbounded);

    pub(crate) const fn new(low: Bound<f64>, high: Bound<f64>) -> Self {
        Self {
            low,
            high,
            instead: "",
        }
    }

    /// From `low` to `high`, both allowed.
    pub(crate) const fn between(low: f64, high: f64) -> Self {
        Self::new(Bound::Included(low), Bound::Included(high))
    }

    /// Those of a range.
    pub(crate) const fn of(range: Range<f64>) -> Self {
        Self::new(Bound::Included(range.start), Bound::Excluded(range.end))
    }

    pub(crate) const fn or_else(self, instead: &'static str) -> Self {
        Self { instead, ..self }
    }

    pub(super) fn instead(&self) -> &'static str {
        self.instead
    }

    pub(super) fn contains(&self, value: f64) -> bool {
        (self.low, self.high).contains(&value)
    }

    /// Whether there is a negative number within them.
    pub(super) fn allow_negative(&self) -> bool {
        match self.low {
            Bound::Unbounded => true,
            Bound::Included(low) | Bound::Excluded(low) => low < 0.0,
        }
    }

    /// As a predicate: `must be above zero`.
    pub(super) fn rule(&self, dimension: Option<Dimension>) -> String {
        match (self.low, self.high) {
            (Bound::Included(0.0), Bound::Unbounded) => "cannot be negative".to_owned(),
            (Bound::Included(low), Bound::Included(high)) => {
                let [low, high] = [low, high].map(|limit| shown(limit, dimension));
                format!("must lie between {low} and {high}")
            }
            _ => format!(
                "must be{}",
                self.qualify(dimension).replace(" of at least", " at least")
            ),
        }
    }

    /// Behind a noun: ` above zero`, or nothing.
    pub(super) fn qualify(&self, dimension: Option<Dimension>) -> String {
        let show = |limit| shown(limit, dimension);
        if let (Bound::Included(low), Bound::Included(high)) = (self.low, self.high) {
            return format!(" from {} to {}", show(low), show(high));
        }
        let low = match self.low {
            Bound::Included(0.0) => Some("not below zero".to_owned()),
            Bound::Excluded(0.0) => Some("above zero".to_owned()),
            Bound::Included(low) => Some(format!("of at least {}", show(low))),
            Bound::Excluded(low) => Some(format!("above {}", show(low))),
            Bound::Unbounded => None,
        };
        let high = match self.high {
            Bound::Included(high) => Some(format!("at most {}", show(high))),
            Bound::Excluded(high) => Some(format!("below {}", show(high))),
            Bound::Unbounded => None,
        };
        let both: Vec<String> = low.into_iter().chain(high).collect();
        match both.is_empty() {
            true => String::new(),
            false => format!(" {}", both.join(" and ")),
        }
    }

    /// As a JSON Schema says it of a number.
    pub(super) fn schema(&self) -> Json {
        let mut schema = json!({});
        let mut say = |bound: Bound<f64>, included: &str, excluded: &str| match bound {
            Bound::Included(limit) => schema[included] = json!(limit),
            Bound::Excluded(limit) => schema[excluded] = json!(limit),
            Bound::Unbounded => {}
        };
        say(self.low, "minimum", "exclusiveMinimum");
        say(self.high, "maximum", "exclusiveMaximum");
        schema
    }
}

/// A limit with its unit: `20 mm`.
fn shown(limit: f64, dimension: Option<Dimension>) -> String {
    let Some(dimension) = dimension else {
        // The exponent of a small number is its message; others are written as one would.
        return match limit.abs() {
            magnitude if magnitude > 0.0 && magnitude < 1e-3 => format!("{limit:e}"),
            _ => limit.to_string(),
        };
    };
    let round = format_human(limit, dimension, 1);
    match parse(&round, dimension) {
        Ok(same) if same == limit => round,
        _ => format_si(limit, dimension),
    }
}
