//! Claims: one number each, as it is, as both engines compute it, and what the paper states of it.

use super::number::{difference, significant};
use super::{ByEngine, Figure};
use crate::report::table::{Cell, cells, csv};

/// One number.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    pub quantity: String,
    pub source: Source,
    /// `None` where it is undefined or not computed.
    pub values: ByEngine<Option<f64>>,
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

/// Where the value comes from that computed values are held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// A formula.
    ClosedForm,
    /// The axisymmetric engine, refined.
    Refined,
    /// The value is zero: the computed values are differences themselves.
    Difference,
    /// As [`Source::Refined`], a whole number.
    Count,
}

/// How near computed values must come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// What unit differences are in; `None` where they are relative to the exact value.
    unit: Option<&'static str>,
    axisymmetric: f64,
    half_space: f64,
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

impl Measure {
    /// Differences relative to the exact value.
    pub fn relative(axisymmetric: f64, half_space: f64) -> Self {
        Self {
            unit: None,
            axisymmetric,
            half_space,
        }
    }

    /// Differences in the normalised unit of the quantity itself.
    pub fn absolute(unit: &'static str, axisymmetric: f64, half_space: f64) -> Self {
        Self {
            unit: Some(unit),
            axisymmetric,
            half_space,
        }
    }

    fn name(self) -> &'static str {
        self.unit.unwrap_or("relative")
    }
}

impl Claim {
    /// One of which the paper states nothing yet.
    pub fn new(
        quantity: impl Into<String>,
        source: Source,
        values: ByEngine<Option<f64>>,
        measure: Measure,
    ) -> Self {
        Self {
            quantity: quantity.into(),
            source,
            values,
            measure,
            stated: Stated::default(),
            note: String::new(),
        }
    }

    /// One whose computed values are differences themselves.
    pub fn difference(
        quantity: impl Into<String>,
        computed: [Option<f64>; 2],
        measure: Measure,
    ) -> Self {
        let values = ByEngine::of(Some(0.0), computed);
        Self::new(quantity, Source::Difference, values, measure)
    }

    /// The same with a note.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Whether there is no value to compare: no exact one, or of a difference none that is computed.
    pub fn is_undefined(&self) -> bool {
        let ByEngine {
            exact,
            axisymmetric,
            half_space,
        } = self.values;
        match self.source {
            Source::Difference => axisymmetric.or(half_space).is_none(),
            _ => exact.is_none(),
        }
    }

    /// The verdict, which a value that is undefined does not allow.
    pub fn judged(&self) -> Verdict {
        match self.is_undefined() {
            true => Verdict::Undefined,
            false => self.stated.verdict,
        }
    }

    /// The values as printed; empty where they are undefined, and the exact one of a difference.
    pub fn texts(&self) -> ByEngine<String> {
        let text = |value: f64| match self.source {
            Source::Difference => difference(value).replace('+', ""),
            Source::Count => value.to_string(),
            Source::ClosedForm | Source::Refined => significant(value, 5),
        };
        let mut texts = self.values.map(|value| value.map(text).unwrap_or_default());
        if self.source == Source::Difference {
            texts.exact.clear();
        }
        texts
    }

    /// By how much the computed values differ; `None` where one of the two is undefined.
    pub fn errors(&self) -> [Option<f64>; 2] {
        let ByEngine { exact, .. } = self.values;
        let unit = self.measure.unit.map(|_| 1.0).or(exact.map(f64::abs));
        [self.values.axisymmetric, self.values.half_space]
            .map(|value| Some((value? - exact?) / unit?))
    }

    /// The same as printed; empty where the value is itself a difference or a count.
    fn error_texts(&self) -> [String; 2] {
        self.errors().map(|error| match self.source {
            Source::Difference | Source::Count => String::new(),
            _ => error.map(difference).unwrap_or_default(),
        })
    }

    /// The claim as a row to be read, below another one: what the paper states of both stands once.
    pub(super) fn cells_below(&self, above: Option<&Claim>) -> [String; 8] {
        let is_same = |above: &Claim| above.stated.paper == self.stated.paper;
        let paper = match !self.stated.paper.is_empty() && above.is_some_and(is_same) {
            true => "as above".to_owned(),
            false => self.stated.paper.clone(),
        };
        let ByEngine {
            exact,
            axisymmetric,
            half_space,
        } = self.texts();
        let exact = match self.source {
            Source::Refined | Source::Count if !exact.is_empty() => format!("{exact} (refined)"),
            Source::Difference => exact,
            _ if self.is_undefined() => UNDEFINED.to_owned(),
            _ => exact,
        };
        let errors = self.error_texts().into_iter();
        let errors: Vec<String> = errors.filter(|text| !text.is_empty()).collect();
        let mut errors = errors.join(", ");
        if !errors.is_empty() {
            errors.push_str(&format!(" {}", self.measure.name()));
        }
        let verdict = self.judged().name().to_owned();
        let (quantity, note) = (self.quantity.clone(), self.note.clone());
        [
            quantity,
            paper,
            exact,
            axisymmetric,
            half_space,
            errors,
            verdict,
            note,
        ]
    }

    /// Whether both engines come as near as they must; `None` where the value is undefined.
    pub fn is_accurate(&self) -> Option<bool> {
        let allowed = [self.measure.axisymmetric, self.measure.half_space];
        let mut pairs = self.errors().into_iter().zip(allowed);
        let near = pairs.all(|(error, allowed)| error.is_none_or(|e| e.abs() <= allowed));
        (!self.is_undefined()).then_some(near)
    }
}

type Column = (&'static str, fn(&Claim) -> String);

/// Columns of `claims.csv` after the number of the figure.
const TABLE: [Column; 12] = [
    ("quantity", |c| c.quantity.clone()),
    ("paper", |c| c.stated.paper.clone()),
    ("exact", |c| c.texts().exact),
    ("exact_source", |c| {
        let source = match c.source {
            Source::ClosedForm => "closed form",
            Source::Refined | Source::Count => "refined",
            Source::Difference => "difference",
        };
        source.to_owned()
    }),
    ("axisymmetric", |c| c.texts().axisymmetric),
    ("half_space", |c| c.texts().half_space),
    ("error_unit", |c| c.measure.name().to_owned()),
    ("axisymmetric_error", |c| c.error_texts()[0].clone()),
    ("half_space_error", |c| c.error_texts()[1].clone()),
    ("within_accuracy", |c| {
        let word = |accurate| if accurate { "yes" } else { "no" };
        c.is_accurate().map(word).unwrap_or_default().to_owned()
    }),
    ("verdict", |c| c.judged().name().to_owned()),
    ("note", |c| c.note.clone()),
];

/// The columns and rows of `claims.csv`.
pub fn claims(figures: &[Figure]) -> (Vec<&'static str>, Vec<Vec<Cell>>) {
    let columns = std::iter::once("figure").chain(TABLE.map(|(name, _)| name));
    let rows = figures.iter().flat_map(|figure| {
        figure.claims.iter().map(|claim| {
            let cells = TABLE.map(|(_, cell)| Cell::from(cell(claim)));
            [cells![usize::from(figure.number)].as_slice(), &cells].concat()
        })
    });
    (columns.collect(), rows.collect())
}

/// `claims.csv`.
pub(super) fn table(figures: &[Figure]) -> Vec<u8> {
    let (columns, rows) = claims(figures);
    csv(&columns, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(source: Source, exact: Option<f64>, measure: Measure) -> Claim {
        let values = ByEngine::of(exact, [Some(1.5), None]);
        let mut claim = Claim::new("largest pressure / p_H", source, values, measure);
        claim.stated.verdict = Verdict::Agrees;
        claim
    }

    #[test]
    fn a_claim_whose_value_is_undefined_says_so_and_has_no_error() {
        let relative = Measure::relative(1e-3, 1e-3);
        let absolute = Measure::absolute("of p_H", 1e-3, 1e-3);
        for (source, measure) in [
            (Source::ClosedForm, relative),
            (Source::Refined, absolute),
            (Source::Count, absolute),
        ] {
            let claim = claim(source, None, measure);
            assert!(claim.is_undefined());
            assert_eq!(claim.judged(), Verdict::Undefined);
            assert_eq!(claim.is_accurate(), None);
            assert_eq!(claim.errors(), [None, None]);
            let cells = claim.cells_below(None);
            assert_eq!([cells[2].as_str(), &cells[5]], ["undefined", ""]);
            // What is computed stands nevertheless.
            assert!(cells[3].starts_with("1.5") && cells[4].is_empty());
            assert_eq!(cells[6], "undefined");
        }
    }

    #[test]
    fn the_table_of_claims_has_empty_cells_where_a_value_is_undefined() {
        let measure = Measure::absolute("of p_H", 1e-3, 1e-3);
        let figure = Figure {
            number: 10,
            caption: String::new(),
            panels: Vec::new(),
            data: Vec::new(),
            claims: vec![claim(Source::Refined, None, measure)],
            statements: Vec::new(),
        };
        let text = String::from_utf8(table(&[figure])).unwrap();
        let row = text.lines().nth(1).unwrap();
        assert_eq!(
            row,
            "10,largest pressure / p_H,,,refined,1.5000,,of p_H,,,,undefined,"
        );
    }

    #[test]
    fn a_difference_that_no_engine_has_is_undefined() {
        let measure = Measure::absolute("of p_H", 1e-3, 1e-3);
        let mut computed = claim(Source::Difference, Some(0.0), measure);
        assert_eq!(computed.judged(), Verdict::Agrees);
        computed.values.axisymmetric = None;
        assert_eq!(computed.judged(), Verdict::Undefined);
        assert_eq!(computed.is_accurate(), None);
    }
}
