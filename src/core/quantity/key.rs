//! What is known of a key of a block: its name, what it means, what may stand under it and what counts without it.

use std::ops::{Bound, Range, RangeBounds, RangeInclusive};

use super::setting::Value;
use super::{Dimension, format_human, format_si, parse};

/// One key of a block. Reading, range checks, the JSON Schema, the reference in the guides and the resolved files come from it.
pub struct Key {
    /// As it is written in a file.
    pub name: &'static str,
    /// A sentence; opens with a blank, as documentation comments do.
    pub means: &'static str,
    pub kind: Kind,
    pub presence: Presence,
}

/// Whether a key must be there, and what counts where it is not.
pub enum Presence {
    Required,
    /// Left out, it has no value, or one that is chosen by what else is in the file.
    Optional,
    /// Left out, this counts.
    Or(fn() -> Option<Value>),
}

/// What may stand under a key.
#[derive(Clone)]
pub enum Kind {
    Flag,
    Integer(RangeInclusive<usize>),
    Number(Number),
    /// One of a few words.
    Word(&'static [&'static str]),
    /// Numbers of one kind; a single one is a list of one.
    Numbers(Number, Entries),
    /// Words, each of the same few; a single one is a list of one.
    Words(&'static [&'static str], Entries),
}

/// A number: bare, or a quantity, which is written with its unit and kept as its SI value.
#[derive(Clone, Copy)]
pub struct Number {
    /// `None` for a bare number.
    pub dimension: Option<Dimension>,
    pub limits: Limits,
    /// In place of that of the dimension, as TOML.
    pub example: Option<&'static str>,
    /// Whether it is written with its power of ten, as tolerances are.
    pub has_exponent: bool,
}

/// How many entries a list has.
#[derive(Clone)]
pub struct Entries {
    pub number: RangeInclusive<usize>,
    /// Whether an entry may be there twice.
    pub repeats: bool,
    /// What to do about entries too few or too many.
    pub instead: &'static str,
}

impl Entries {
    /// Any number of them.
    pub const ANY: Self = Self {
        number: 0..=usize::MAX,
        repeats: true,
        instead: "",
    };
}

/// A quantity of any size.
pub const fn quantity(dimension: Dimension) -> Number {
    Number {
        dimension: Some(dimension),
        limits: Limits::NONE,
        example: None,
        has_exponent: false,
    }
}

/// A bare number of any size, with an example.
pub const fn number(example: &'static str) -> Number {
    Number {
        dimension: None,
        limits: Limits::NONE,
        example: Some(example),
        has_exponent: false,
    }
}

/// A bare number that is written with its power of ten.
pub const fn tolerance(example: &'static str) -> Number {
    Number {
        has_exponent: true,
        ..number(example)
    }
}

impl Number {
    /// The same within limits.
    #[must_use]
    pub const fn within(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }

    #[must_use]
    pub const fn above_zero(self) -> Self {
        self.within(Limits::ABOVE_ZERO)
    }

    #[must_use]
    pub const fn not_negative(self) -> Self {
        self.within(Limits::NOT_NEGATIVE)
    }

    /// The same with what to write in place of a value beyond the limits.
    #[must_use]
    pub const fn or_else(self, instead: &'static str) -> Self {
        self.within(self.limits.or_else(instead))
    }

    /// The same with another example than that of the dimension, as TOML.
    #[must_use]
    pub const fn such_as(self, example: &'static str) -> Self {
        Self {
            example: Some(example),
            ..self
        }
    }

    /// What is expected, with its article: `a force above zero`.
    pub fn expected(&self) -> String {
        let limits = self.limits.qualify(self.dimension);
        match self.dimension {
            Some(dimension) => format!("{dimension}{limits}"),
            None => format!("a number{limits}"),
        }
    }

    /// A value of this kind as it is written in a resolved file.
    pub fn value(&self, value: f64) -> Value {
        match (self.dimension, self.has_exponent) {
            (Some(dimension), _) => Value::Quantity(value, dimension),
            (None, true) => Value::Tolerance(value),
            (None, false) => Value::Number(value),
        }
    }
}

/// A Poisson ratio.
pub const POISSON_RATIO: Number = number("0.4")
    .within(Limits::new(Bound::Excluded(-1.0), Bound::Included(0.5)))
    .or_else("an incompressible material has poisson_ratio = 0.5");

/// An integer, with what is expected of it: `an integer from 8 to 1000000`.
pub fn expected_integer(range: &RangeInclusive<usize>) -> String {
    match (*range.start(), *range.end()) {
        (1, usize::MAX) => "a positive integer".to_owned(),
        (least, usize::MAX) => format!("an integer of at least {least}"),
        (least, most) => format!("an integer from {least} to {most}"),
    }
}

/// A list of so many items, with what is expected of each: `an array, each item a time`.
pub fn expected_list(item: &str, number: &RangeInclusive<usize>) -> String {
    match *number.end() {
        2 => format!("an array of two, each {item}"),
        _ => format!("an array, each item {item}"),
    }
}

/// From where to where a number may be, in SI units.
#[derive(Clone, Copy)]
pub struct Limits {
    pub low: Bound<f64>,
    pub high: Bound<f64>,
    /// What to write in place of a number beyond them; empty: an example.
    pub instead: &'static str,
}

impl Limits {
    pub const NONE: Self = Self::new(Bound::Unbounded, Bound::Unbounded);
    pub const ABOVE_ZERO: Self = Self::new(Bound::Excluded(0.0), Bound::Unbounded);
    pub const NOT_NEGATIVE: Self = Self::new(Bound::Included(0.0), Bound::Unbounded);

    pub const fn new(low: Bound<f64>, high: Bound<f64>) -> Self {
        Self {
            low,
            high,
            instead: "",
        }
    }

    /// From `low` to `high`, both allowed.
    pub const fn between(low: f64, high: f64) -> Self {
        Self::new(Bound::Included(low), Bound::Included(high))
    }

    /// Those of a range.
    pub const fn of(range: Range<f64>) -> Self {
        Self::new(Bound::Included(range.start), Bound::Excluded(range.end))
    }

    pub const fn or_else(self, instead: &'static str) -> Self {
        Self { instead, ..self }
    }

    pub fn contains(&self, value: f64) -> bool {
        (self.low, self.high).contains(&value)
    }

    /// Whether there is a negative number within them.
    pub fn allow_negative(&self) -> bool {
        match self.low {
            Bound::Unbounded => true,
            Bound::Included(low) | Bound::Excluded(low) => low < 0.0,
        }
    }

    /// As a predicate: `must be above zero`.
    pub fn rule(&self, dimension: Option<Dimension>) -> String {
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
    pub fn qualify(&self, dimension: Option<Dimension>) -> String {
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
