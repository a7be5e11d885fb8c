//! What is known of a key of a block: its name, what it means, what may stand under it and what counts without it.

use std::ops::{Bound, Range, RangeBounds, RangeInclusive};

use super::block::Field;
use super::rows::Rows;
use super::setting::{Setting, Value};
use super::{Dimension, format_human, format_si, parse};

/// One key of a block. Reading, range checks, the JSON Schema, the reference in the guides and the resolved files come from it.
#[derive(Clone)]
pub struct Key {
    /// As it is written in a file.
    pub name: &'static str,
    /// A sentence; opens with a blank, as documentation comments do.
    pub means: &'static str,
    pub kind: Kind,
    pub presence: Presence,
}

impl Key {
    /// What it means, as a sentence.
    pub fn means(&self) -> &'static str {
        self.means.trim_start()
    }

    /// The key with this value, where a resolved file has one.
    pub fn setting<T: Field>(&self, value: T) -> Option<Setting> {
        Some(Setting::new(self.name, value.written(&self.kind)?))
    }

    /// The same key once the dimension is chosen, of numbers that may have several.
    #[must_use]
    pub fn of(&self, dimension: Dimension) -> Self {
        Self {
            kind: self.kind.of(dimension),
            ..self.clone()
        }
    }

    pub fn is_required(&self) -> bool {
        matches!(self.presence, Presence::Required)
    }

    /// Whether another key is this one, where it stands in several tables.
    pub fn is(&self, other: &Self) -> bool {
        let same_below = match (self.kind.rows(), other.kind.rows()) {
            (Some(own), Some(others)) => std::ptr::eq(own, others) || own.is(others),
            (own, others) => own.is_none() && others.is_none(),
        };
        self.name == other.name && self.means == other.means && same_below
    }

    /// What counts where the key is left out.
    pub fn default(&self) -> Option<Value> {
        match self.presence {
            Presence::Or(value) => value(),
            Presence::Required | Presence::Optional => None,
        }
    }
}

/// Whether a key must be there, and what counts where it is not.
#[derive(Clone, Copy)]
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
    Text,
    /// One of a few words.
    Word(&'static [&'static str]),
    /// Numbers of one kind; a single one is a list of one.
    Numbers(Number, Entries),
    Texts(Entries),
    /// Words, each of the same few; a single one is a list of one.
    Words(&'static [&'static str], Entries),
    /// Numbers, each once: a list, one of them, or a table of a range.
    Points(Number, &'static Rows),
    /// A table below.
    Table(&'static Rows),
    /// An array of at most this many tables, and what to do in place of more.
    Tables(&'static Rows, usize, &'static str),
    /// What is no such text or table as the second is the first. Behind the second stands what is said of it beyond its kind.
    Either(&'static Kind, &'static Kind, &'static str),
    /// Numbers of a block, each with the values that it takes in a sweep.
    Axes(AxesOf),
}

/// The block whose numbers may vary.
#[derive(Clone, Copy)]
pub struct AxesOf {
    pub block: &'static str,
    pub rows: &'static Rows,
    /// The keys of a block of a list, where whole blocks may vary.
    pub listed: Option<&'static Rows>,
}

impl Kind {
    /// In place of a number: as many as it takes.
    pub const AUTO: Self = Self::Word(&["auto"]);

    /// What is expected, with its article.
    pub fn expected(&self) -> String {
        if let Some((item, entries)) = self.item() {
            return entries.expected(&item.expected());
        }
        match self {
            Self::Flag => "`true` or `false`".to_owned(),
            Self::Integer(range) => expected_integer(range),
            Self::Number(number) => number.expected(),
            Self::Word(words) => alternatives(words),
            Self::Points(number, _) => format!("a list or a range, each {}", number.expected()),
            Self::Table(_) => "a table".to_owned(),
            Self::Tables(..) => "an array of tables".to_owned(),
            Self::Either(first, second, more) => {
                format!("{}, or {}{more}", first.expected(), second.expected())
            }
            Self::Axes(AxesOf { block, listed, .. }) => match listed {
                Some(_) => format!("a table with keys of `[{block}]`, or a list of such blocks"),
                None => format!("a table with keys of `[{block}]`"),
            },
            _ => "a string".to_owned(),
        }
    }

    /// What each entry of a list is, and how many there are.
    pub fn item(&self) -> Option<(Self, &Entries)> {
        match self {
            Self::Numbers(number, entries) => Some((Self::Number(*number), entries)),
            Self::Texts(entries) => Some((Self::Text, entries)),
            Self::Words(words, entries) => Some((Self::Word(words), entries)),
            _ => None,
        }
    }

    /// Words that the value may be.
    pub fn words(&self) -> &'static [&'static str] {
        match self {
            Self::Word(words) | Self::Words(words, _) => words,
            Self::Either(first, ..) => first.words(),
            _ => &[],
        }
    }

    /// The keys below, where the value may be a table or an array of tables.
    pub fn rows(&self) -> Option<&'static Rows> {
        match self {
            Self::Table(rows) | Self::Tables(rows, ..) | Self::Points(_, rows) => Some(rows),
            Self::Either(_, second, _) => second.rows(),
            _ => None,
        }
    }

    /// What the number is, where the value may be one; of several dimensions this one.
    pub fn number(&self, chosen: Dimension) -> Option<Number> {
        match self {
            Self::Number(number) => Some(number.of(chosen)),
            Self::Either(first, ..) => first.number(chosen),
            _ => None,
        }
    }

    /// The same once the dimension is known of numbers that may have several.
    #[must_use]
    pub fn of(&self, chosen: Dimension) -> Self {
        match self {
            Self::Number(number) => Self::Number(number.of(chosen)),
            Self::Numbers(number, entries) => Self::Numbers(number.of(chosen), entries.clone()),
            other => other.clone(),
        }
    }

    /// Whether a value is one of these.
    pub fn has(&self, value: &Value) -> bool {
        let fits =
            |found: &f64, number: &Number| found.is_finite() && number.limits.contains(*found);
        match (self, value) {
            (Self::Integer(range), Value::Integer(found)) => {
                usize::try_from(*found).is_ok_and(|found| range.contains(&found))
            }
            (Self::Number(number), value) => value.number().is_some_and(|f| fits(&f, number)),
            (
                Self::Numbers(number, entries),
                Value::Numbers(found) | Value::Quantities(found, _),
            ) => {
                entries.number.contains(&found.len())
                    && found.iter().all(|found| fits(found, number))
            }
            _ => true,
        }
    }
}

/// The words of a table of what each stands for.
pub const fn words_of<T, const N: usize>(table: &[(&'static str, T)]) -> [&'static str; N] {
    let mut words = [""; N];
    let mut place = 0;
    while place < N {
        words[place] = table[place].0;
        place += 1;
    }
    words
}

/// `"a", "b" or "c"`.
pub fn alternatives(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => "absent".to_owned(),
    }
}

/// A number: bare, or a quantity, which is written with its unit and kept as its SI value.
#[derive(Clone, Copy)]
pub struct Number {
    /// `None` for a bare number.
    pub dimension: Option<Dimension>,
    /// Dimensions that another key may choose in place of it.
    pub or: &'static [Dimension],
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
    pub const ANY: Self = Self::of(0..=usize::MAX, "");

    /// Two of them, and what to write in place of more or fewer.
    pub const fn two(instead: &'static str) -> Self {
        Self::of(2..=2, instead)
    }

    /// So many, and what to write in place of more or fewer.
    pub const fn of(number: RangeInclusive<usize>, instead: &'static str) -> Self {
        Self {
            number,
            repeats: true,
            instead,
        }
    }

    /// What is expected of such a list: `an array, each item a time`.
    fn expected(&self, item: &str) -> String {
        match *self.number.end() {
            2 => format!("an array of two, each {item}"),
            _ => format!("an array, each item {item}"),
        }
    }
}

/// A quantity of any size.
pub const fn quantity(dimension: Dimension) -> Number {
    Number {
        dimension: Some(dimension),
        or: &[],
        limits: Limits::NONE,
        example: None,
        has_exponent: false,
    }
}

/// A bare number of any size, with an example.
pub const fn number(example: &'static str) -> Number {
    Number {
        dimension: None,
        or: &[],
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

    /// The same where another key may choose one of these dimensions for it.
    #[must_use]
    pub const fn or_of(self, or: &'static [Dimension]) -> Self {
        Self { or, ..self }
    }

    /// The same once the dimension is chosen, where there is a choice.
    #[must_use]
    pub const fn of(self, dimension: Dimension) -> Self {
        match self.or {
            [] => self,
            _ => Self {
                dimension: Some(dimension),
                or: &[],
                ..self
            },
        }
    }

    /// What is expected, with its article: `a force above zero`.
    pub fn expected(&self) -> String {
        let limits = self.limits.qualify(self.dimension);
        let dimensions = self.dimension.iter().chain(self.or);
        let names: Vec<String> = dimensions.map(Dimension::to_string).collect();
        match names.as_slice() {
            [] => format!("a number{limits}"),
            names => format!("{}{limits}", names.join(" or ")),
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
fn expected_integer(range: &RangeInclusive<usize>) -> String {
    match (*range.start(), *range.end()) {
        (1, usize::MAX) => "a positive integer".to_owned(),
        (least, usize::MAX) => format!("an integer of at least {least}"),
        (least, most) => format!("an integer from {least} to {most}"),
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
