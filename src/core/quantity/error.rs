//! Why a text is refused as a quantity, and what to write instead.

use std::fmt;

use super::{Dimension, units};

/// A text that is not a quantity of the expected dimension.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct QuantityError {
    /// What was read.
    pub text: String,
    /// What was wanted.
    pub expected: Dimension,
    pub problem: QuantityProblem,
}

/// What is wrong with the text of a quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum QuantityProblem {
    /// Nothing that begins like a number.
    NotANumber,
    /// A comma where the point belongs.
    Comma,
    /// A number in quotes without a unit.
    MissingUnit,
    /// A unit that does not exist, and units that look like it, the likeliest first.
    UnknownUnit {
        unit: String,
        suggestions: Vec<String>,
    },
    /// A product after a division sign, which may be read in two ways.
    AmbiguousUnit,
    /// A unit of another dimension: what that is, with its article.
    WrongDimension { found: String },
    /// An infinity or a NaN.
    NotFinite,
    /// Too large for a double.
    TooLarge,
    /// Not zero, but too small for a double.
    TooSmall,
}

impl std::error::Error for QuantityError {}

impl fmt::Display for QuantityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use QuantityProblem as Problem;
        let Self { text, expected, .. } = self;
        let (si, example) = (expected.si_unit(), expected.example());
        let such = format!("{expected} is expected, for example \"{example}\"");
        match &self.problem {
            Problem::NotANumber => write!(f, "'{text}' does not begin with a number; {such}"),
            Problem::Comma => write!(
                f,
                "'{text}' has a comma in its number: write a decimal point, and no thousands separator"
            ),
            Problem::MissingUnit => write!(
                f,
                "'{text}' has no unit: write \"{text} {}\", or the bare number {text} without quotes for SI ({si})",
                expected.common_unit()
            ),
            Problem::UnknownUnit { unit, suggestions } => write!(
                f,
                "'{text}' has the unknown unit '{unit}'{}; {expected} is written for example \"{example}\"",
                instead(unit, suggestions)
            ),
            Problem::AmbiguousUnit => write!(
                f,
                "the unit of '{text}' can be read in two ways, because a product follows a '/': use negative exponents, for example \"Pa^-1 s\""
            ),
            Problem::WrongDimension { found } => write!(f, "'{text}' is {found}, {such}"),
            Problem::NotFinite => write!(f, "'{text}' is not a finite number; {such}"),
            Problem::TooLarge => write!(f, "'{text}' is too large: in {si} it exceeds 1.8e308"),
            Problem::TooSmall => write!(
                f,
                "'{text}' is too small: in {si} it is below 5e-324, yet not zero"
            ),
        }
    }
}

/// What to write instead of an unknown unit, in brackets: what it is in known units, else the units that look like it.
fn instead(unit: &str, suggestions: &[String]) -> String {
    match (units::conversion(unit), suggestions) {
        (Some(equal), _) => format!(" (1 {unit} is {equal})"),
        (None, []) => String::new(),
        (None, _) => format!(" (did you mean \"{}\"?)", suggestions.join("\" or \"")),
    }
}
