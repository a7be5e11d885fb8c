//! Why a text is refused as a quantity, and what to write instead.

use thiserror::Error;

use super::{Dimension, units};

/// Why a text is not a quantity of the expected dimension.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum QuantityError {
    /// Nothing that begins like a number.
    #[error(
        "'{text}' does not begin with a number; {expected} is expected, for example \"{}\"",
        expected.example()
    )]
    NotANumber {
        /// What was read.
        text: String,
        /// What was wanted.
        expected: Dimension,
    },

    /// A comma where the point belongs.
    #[error(
        "'{text}' has a comma in its number: write a decimal point, and no thousands separator"
    )]
    Comma {
        /// What was read.
        text: String,
    },

    /// A number in quotes without a unit.
    #[error(
        "'{number}' has no unit: write \"{number} {common_unit}\", or the bare number {number} without quotes for SI ({})",
        expected.si_unit()
    )]
    MissingUnit {
        /// The number, as read.
        number: String,
        /// The unit that is usual for the dimension.
        common_unit: &'static str,
        /// What was wanted.
        expected: Dimension,
    },

    /// A unit that does not exist.
    #[error(
        "'{text}' has the unknown unit '{unit}'{}; {expected} is written for example \"{}\"",
        instead(unit, suggestions),
        expected.example()
    )]
    UnknownUnit {
        /// What was read.
        text: String,
        /// The part that is not a unit.
        unit: String,
        /// Units that look like it, the likeliest first.
        suggestions: Vec<String>,
        /// What was wanted.
        expected: Dimension,
    },

    /// A product after a division sign, which may be read in two ways.
    #[error(
        "the unit of '{text}' can be read in two ways, because a product follows a '/': use negative exponents, for example \"Pa^-1 s\""
    )]
    AmbiguousUnit {
        /// What was read.
        text: String,
    },

    /// A unit of another dimension.
    #[error("'{text}' is {found}, {expected} is expected, for example \"{}\"", expected.example())]
    WrongDimension {
        /// What was read.
        text: String,
        /// What that is, with its article.
        found: String,
        /// What was wanted.
        expected: Dimension,
    },

    /// An infinity or a NaN.
    #[error("'{text}' is not a finite number; {expected} is expected, for example \"{}\"", expected.example())]
    NotFinite {
        /// What was read.
        text: String,
        /// What was wanted.
        expected: Dimension,
    },

    /// Too large for a double.
    #[error("'{text}' is too large: in {} it exceeds 1.8e308", expected.si_unit())]
    TooLarge {
        /// What was read.
        text: String,
        /// What was wanted.
        expected: Dimension,
    },

    /// Not zero, but too small for a double.
    #[error("'{text}' is too small: in {} it is below 5e-324, yet not zero", expected.si_unit())]
    TooSmall {
        /// What was read.
        text: String,
        /// What was wanted.
        expected: Dimension,
    },
}

/// What to write instead of an unknown unit, in brackets: what it is in known units, else the units that look like it.
fn instead(unit: &str, suggestions: &[String]) -> String {
    match (units::conversion(unit), suggestions) {
        (Some(equal), _) => format!(" (1 {unit} is {equal})"),
        (None, []) => String::new(),
        (None, _) => format!(" (did you mean \"{}\"?)", suggestions.join("\" or \"")),
    }
}
