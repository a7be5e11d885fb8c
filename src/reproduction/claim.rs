//! Claims: one number each, as it is, as both engines compute it, and what the paper states of it.

use super::number::{difference, significant};
use super::{Figure, ReproductionError};
use crate::report::table::Table;

/// One number.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    pub figure: u8,
    pub quantity: String,
    pub exact: Value,
    pub axisymmetric: Option<f64>,
    pub half_space: Option<f64>,
    pub measure: Measure,
    pub stated: Stated,
    pub note: String,
}

/// What the paper states of a value, and whether that is what comes out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stated {
    /// Its words; of several statements one after the other.
    pub paper: String,
    verdict: Verdict,
}

impl Stated {
    /// Adds a statement. One that disagrees is heard.
    pub(super) fn add(&mut self, paper: &str, verdict: Verdict) {
        if !self.paper.is_empty() {
            self.paper.push(' ');
        }
        self.paper.push_str(paper);
        if self.verdict != Verdict::Disagrees {
            self.verdict = verdict;
        }
    }
}

/// The value computed values are held against; `None` where it is undefined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// From a formula.
    ClosedForm(Option<f64>),
    /// From the axisymmetric engine, refined.
    Refined(Option<f64>),
    /// Zero: the computed values are differences themselves.
    Difference,
    /// A whole number, from the axisymmetric engine, refined.
    Count(Option<f64>),
}

/// How computed values are compared, and how near they must come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// Differences are divided by this and named so; `None` where they are relative to a value that is undefined.
    pub unit: Option<f64>,
    pub unit_name: &'static str,
    /// Largest differences allowed.
    pub axisymmetric: f64,
    pub half_space: f64,
    /// A difference below this is not resolved and not printed.
    pub floor: f64,
}

/// Whether what the paper states is what comes out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Verdict {
    Agrees,
    Disagrees,
    /// The paper says nothing of it that could be compared.
    #[default]
    NotStated,
    /// There is no value that could be compared.
    Undefined,
}

impl Verdict {
    /// As printed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Disagrees => "disagrees",
            Self::NotStated => "not stated",
            Self::Undefined => UNDEFINED,
        }
    }
}

impl Value {
    /// The number, where it is defined.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::ClosedForm(value) | Self::Refined(value) | Self::Count(value) => value,
            Self::Difference => Some(0.0),
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

/// What [`Claim::cells_below`] are.
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

/// What stands in place of a value that is undefined.
const UNDEFINED: &str = "undefined";

/// Differences below this depend on the tolerance of the half-space solver.
const UNRESOLVED: f64 = 1e-6;

impl Measure {
    /// Relative to the exact value.
    pub fn relative(exact: Option<f64>, axisymmetric: f64, half_space: f64) -> Self {
        Self {
            unit: exact.map(f64::abs),
            unit_name: "relative",
            axisymmetric,
            half_space,
            floor: UNRESOLVED,
        }
    }

    /// In the normalised unit of the quantity itself.
    pub fn absolute(unit_name: &'static str, axisymmetric: f64, half_space: f64) -> Self {
        Self {
            unit: Some(1.0),
            unit_name,
            axisymmetric,
            half_space,
            floor: UNRESOLVED,
        }
    }
}

impl Claim {
    /// Whether there is no value to compare: no exact one, or of a difference none that is computed.
    pub fn is_undefined(&self) -> bool {
        match self.exact {
            Value::Difference => self.axisymmetric.or(self.half_space).is_none(),
            value => value.number().is_none(),
        }
    }

    /// The verdict, which a value that is undefined does not allow.
    pub fn judged(&self) -> Verdict {
        match self.is_undefined() {
            true => Verdict::Undefined,
            false => self.stated.verdict,
        }
    }

    /// The exact value as printed; empty where it is undefined, and of a difference.
    pub fn exact_text(&self) -> String {
        match self.exact {
            Value::ClosedForm(value) | Value::Refined(value) => {
                value.map(|value| significant(value, 5)).unwrap_or_default()
            }
            Value::Count(value) => value.map(|value| value.to_string()).unwrap_or_default(),
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

    /// By how much a computed value differs; `None` where one of the two is undefined.
    pub fn error(&self, value: Option<f64>) -> Option<f64> {
        Some((value? - self.exact.number()?) / self.measure.unit?)
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

    /// The claim as a row to be read, below another one: what the paper states of both stands once.
    pub(super) fn cells_below(&self, above: Option<&Claim>) -> [String; 8] {
        let mut cells = self.cells();
        let is_same = |above: &Claim| above.stated.paper == self.stated.paper;
        if !self.stated.paper.is_empty() && above.is_some_and(is_same) {
            cells[1] = "as above".to_owned();
        }
        cells
    }

    /// The claim as a row to be read.
    fn cells(&self) -> [String; 8] {
        let errors = [self.axisymmetric, self.half_space]
            .map(|value| self.error_text(value))
            .into_iter()
            .filter(|text| !text.is_empty())
            .collect::<Vec<_>>()
            .join(", ");
        let exact = match self.exact {
            Value::Difference => String::new(),
            _ if self.is_undefined() => UNDEFINED.to_owned(),
            Value::ClosedForm(_) => self.exact_text(),
            Value::Refined(_) | Value::Count(_) => format!("{} (refined)", self.exact_text()),
        };
        [
            self.quantity.clone(),
            self.stated.paper.clone(),
            exact,
            self.value_text(self.axisymmetric),
            self.value_text(self.half_space),
            if errors.is_empty() {
                errors
            } else {
                format!("{errors} {}", self.measure.unit_name)
            },
            self.judged().name().to_owned(),
            self.note.clone(),
        ]
    }

    /// Whether both engines come as near as they must; `None` where the value is undefined.
    pub fn is_accurate(&self) -> Option<bool> {
        let near = |value, allowed| self.error(value).is_none_or(|e: f64| e.abs() <= allowed);
        let both = near(self.axisymmetric, self.measure.axisymmetric)
            && near(self.half_space, self.measure.half_space);
        (!self.is_undefined()).then_some(both)
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
            claim.stated.paper.clone(),
            claim.exact_text(),
            claim.exact.source().to_owned(),
            claim.value_text(claim.axisymmetric),
            claim.value_text(claim.half_space),
            claim.measure.unit_name.to_owned(),
            claim.error_text(claim.axisymmetric),
            claim.error_text(claim.half_space),
            match claim.is_accurate() {
                Some(true) => "yes".to_owned(),
                Some(false) => "no".to_owned(),
                None => String::new(),
            },
            claim.judged().name().to_owned(),
            claim.note.clone(),
        ])?;
    }
    Ok(table.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(exact: Value, measure: Measure) -> Claim {
        Claim {
            figure: 10,
            quantity: "largest pressure / p_H".to_owned(),
            exact,
            axisymmetric: Some(1.5),
            half_space: None,
            measure,
            stated: Stated {
                paper: String::new(),
                verdict: Verdict::Agrees,
            },
            note: String::new(),
        }
    }

    #[test]
    fn a_claim_whose_value_is_undefined_says_so_and_has_no_error() {
        let relative = Measure::relative(None, 1e-3, 1e-3);
        let absolute = Measure::absolute("of p_H", 1e-3, 1e-3);
        for (value, measure) in [
            (Value::ClosedForm(None), relative),
            (Value::Refined(None), absolute),
            (Value::Count(None), absolute),
        ] {
            let claim = claim(value, measure);
            assert!(claim.is_undefined());
            assert_eq!(claim.judged(), Verdict::Undefined);
            assert_eq!(claim.is_accurate(), None);
            assert_eq!(claim.error(claim.axisymmetric), None);
            let cells = claim.cells();
            assert_eq!([cells[2].as_str(), &cells[5]], ["undefined", ""]);
            // What is computed stands nevertheless.
            assert!(cells[3].starts_with("1.5") && cells[4].is_empty());
            assert_eq!(cells[6], "undefined");
        }
    }

    #[test]
    fn the_table_of_claims_has_empty_cells_where_a_value_is_undefined() {
        let figure = Figure {
            number: 10,
            caption: String::new(),
            panels: Vec::new(),
            data: Vec::new(),
            claims: vec![claim(
                Value::Refined(None),
                Measure::absolute("of p_H", 1e-3, 1e-3),
            )],
            statements: Vec::new(),
        };
        let text = String::from_utf8(table(&[figure]).unwrap()).unwrap();
        let row = text.lines().nth(1).unwrap();
        assert_eq!(
            row,
            "10,largest pressure / p_H,,,refined,1.5000,,of p_H,,,,undefined,"
        );
    }

    #[test]
    fn a_difference_that_no_engine_has_is_undefined() {
        let measure = Measure::absolute("of p_H", 1e-3, 1e-3);
        let computed = claim(Value::Difference, measure);
        assert_eq!(computed.judged(), Verdict::Agrees);
        let lacking = Claim {
            axisymmetric: None,
            ..computed
        };
        assert_eq!(lacking.judged(), Verdict::Undefined);
        assert_eq!(lacking.is_accurate(), None);
    }
}
