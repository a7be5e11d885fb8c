//! Claims: one number each, as the paper states it, as it is, and as both engines compute it.

use super::number::{difference, significant};
use super::{Figure, ReproductionError};
use crate::report::table::Table;

/// One number.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    pub figure: u8,
    pub quantity: String,
    /// What the paper states.
    pub paper: String,
    pub exact: Value,
    pub axisymmetric: Option<f64>,
    pub half_space: Option<f64>,
    pub measure: Measure,
    pub verdict: Verdict,
    pub note: String,
}

/// The value computed values are held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// From a formula.
    ClosedForm(f64),
    /// From the axisymmetric engine, refined.
    Refined(f64),
    /// Zero: the computed values are differences themselves.
    Difference,
    /// A whole number, from the axisymmetric engine, refined.
    Count(f64),
}

/// How computed values are compared, and how near they must come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// Differences are divided by this and named so.
    pub unit: f64,
    pub unit_name: &'static str,
    /// Largest differences allowed.
    pub axisymmetric: f64,
    pub half_space: f64,
    /// A difference below this is not resolved and not printed.
    pub floor: f64,
}

/// Whether what the paper states is what comes out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    Agrees,
    Disagrees,
    /// The paper says nothing of it that could be compared.
    NotStated,
}

impl Verdict {
    /// As printed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Disagrees => "disagrees",
            Self::NotStated => "not stated",
        }
    }
}

impl Value {
    /// The number.
    pub fn number(self) -> f64 {
        match self {
            Self::ClosedForm(value) | Self::Refined(value) | Self::Count(value) => value,
            Self::Difference => 0.0,
        }
    }

    /// Where it comes from.
    pub fn source(self) -> &'static str {
        match self {
            Self::ClosedForm(_) => "closed form",
            Self::Refined(_) | Self::Count(_) => "refined",
            Self::Difference => "difference",
        }
    }
}

/// How many claims there are, by verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Count {
    pub all: usize,
    pub agree: usize,
    pub disagree: usize,
    pub not_stated: usize,
}

impl Count {
    /// Counts them.
    pub fn of<'a>(claims: impl Iterator<Item = &'a Claim> + Clone) -> Self {
        let count = |verdict| {
            claims
                .clone()
                .filter(|claim| claim.verdict == verdict)
                .count()
        };
        Self {
            all: claims.clone().count(),
            agree: count(Verdict::Agrees),
            disagree: count(Verdict::Disagrees),
            not_stated: count(Verdict::NotStated),
        }
    }
}

/// What [`Claim::cells`] are.
pub(super) const COLUMNS: [&str; 8] = [
    "quantity",
    "the paper",
    "exact",
    "axisymmetric",
    "half-space",
    "errors",
    "verdict",
    "note",
];

/// Differences below this depend on the tolerance of the half-space solver.
const UNRESOLVED: f64 = 1e-6;

impl Measure {
    /// Relative to the exact value.
    pub fn relative(exact: f64, axisymmetric: f64, half_space: f64) -> Self {
        Self {
            unit: exact.abs(),
            unit_name: "relative",
            axisymmetric,
            half_space,
            floor: UNRESOLVED,
        }
    }

    /// In the normalised unit of the quantity itself.
    pub fn absolute(unit_name: &'static str, axisymmetric: f64, half_space: f64) -> Self {
        Self {
            unit: 1.0,
            unit_name,
            axisymmetric,
            half_space,
            floor: UNRESOLVED,
        }
    }
}

impl Claim {
    /// The exact value as printed.
    pub fn exact_text(&self) -> String {
        match self.exact {
            Value::ClosedForm(value) | Value::Refined(value) => significant(value, 5),
            Value::Count(value) => format!("{value}"),
            Value::Difference => String::new(),
        }
    }

    /// A computed value as printed.
    pub fn value_text(&self, value: Option<f64>) -> String {
        let Some(value) = value else {
            return String::new();
        };
        match self.exact {
            Value::Difference => difference(value, self.measure.floor).replace('+', ""),
            Value::Count(_) => format!("{value}"),
            _ => significant(value, 5),
        }
    }

    /// By how much a computed value differs.
    pub fn error(&self, value: Option<f64>) -> Option<f64> {
        value.map(|value| (value - self.exact.number()) / self.measure.unit)
    }

    /// The same as printed; empty where the value is itself a difference or a count.
    pub fn error_text(&self, value: Option<f64>) -> String {
        match self.exact {
            Value::Difference | Value::Count(_) => String::new(),
            _ => self
                .error(value)
                .map(|error| difference(error, self.measure.floor))
                .unwrap_or_default(),
        }
    }

    /// The claim as a row to be read.
    pub(super) fn cells(&self) -> [String; 8] {
        let errors = [self.axisymmetric, self.half_space]
            .map(|value| self.error_text(value))
            .into_iter()
            .filter(|text| !text.is_empty())
            .collect::<Vec<_>>()
            .join(", ");
        let exact = match self.exact {
            Value::Difference => String::new(),
            Value::ClosedForm(_) => self.exact_text(),
            Value::Refined(_) | Value::Count(_) => format!("{} (refined)", self.exact_text()),
        };
        [
            self.quantity.clone(),
            self.paper.clone(),
            exact,
            self.value_text(self.axisymmetric),
            self.value_text(self.half_space),
            if errors.is_empty() {
                errors
            } else {
                format!("{errors} {}", self.measure.unit_name)
            },
            self.verdict.name().to_owned(),
            self.note.clone(),
        ]
    }

    /// Whether both engines come as near as they must.
    pub fn is_accurate(&self) -> bool {
        let near = |value, allowed| self.error(value).is_none_or(|e: f64| e.abs() <= allowed);
        near(self.axisymmetric, self.measure.axisymmetric)
            && near(self.half_space, self.measure.half_space)
    }
}

/// `claims.csv`.
pub(super) fn table(figures: &[Figure]) -> Result<Vec<u8>, ReproductionError> {
    let mut table = Table::new(
        "claims.csv",
        &[
            "figure",
            "quantity",
            "paper",
            "exact",
            "exact_source",
            "axisymmetric",
            "half_space",
            "error_unit",
            "axisymmetric_error",
            "half_space_error",
            "within_accuracy",
            "verdict",
            "note",
        ],
    )?;
    for claim in figures.iter().flat_map(|figure| &figure.claims) {
        table.row(&[
            claim.figure.to_string(),
            claim.quantity.clone(),
            claim.paper.clone(),
            claim.exact_text(),
            claim.exact.source().to_owned(),
            claim.value_text(claim.axisymmetric),
            claim.value_text(claim.half_space),
            claim.measure.unit_name.to_owned(),
            claim.error_text(claim.axisymmetric),
            claim.error_text(claim.half_space),
            if claim.is_accurate() { "yes" } else { "no" }.to_owned(),
            claim.verdict.name().to_owned(),
            claim.note.clone(),
        ])?;
    }
    Ok(table.finish()?)
}
