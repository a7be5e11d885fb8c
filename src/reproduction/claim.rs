//! Claims: one number each, as it is, as both engines compute it, and what the paper states of it.

use super::Figure;
use super::number::{difference, significant};
use super::run::ByEngine;
use crate::report::table::{Cell, cells, csv};

/// One number.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    pub quantity: String,
    pub source: Source,
    /// `None` where it is undefined or not computed.
    pub values: ByEngine<Option<f64>>,
    /// What unit differences are in; `None` where they are relative to the exact value.
    pub unit: Option<String>,
    /// How near the axisymmetric and the half-space engine must come.
    pub tolerances: [f64; 2],
    /// What the paper states of it; of several statements one after the other.
    pub paper: String,
    pub(super) stated: Verdict,
    pub note: String,
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

/// What stands in place of a value that is undefined.
const UNDEFINED: &str = "undefined";

impl Claim {
    /// Adds a statement of the paper. One that disagrees decides the verdict.
    pub(super) fn add(&mut self, paper: &str, verdict: Verdict) {
        if !self.paper.is_empty() {
            self.paper.push(' ');
        }
        self.paper.push_str(paper);
        if self.stated != Verdict::Disagrees {
            self.stated = verdict;
        }
    }

    /// Whether there is no value to compare: no exact one, or of a difference none that is computed.
    pub fn is_undefined(&self) -> bool {
        let [exact, axisymmetric, half_space] = self.values;
        match self.source {
            Source::Difference => axisymmetric.or(half_space).is_none(),
            _ => exact.is_none(),
        }
    }

    fn unit(&self) -> &str {
        self.unit.as_deref().unwrap_or("relative")
    }

    /// The verdict, which a value that is undefined does not allow.
    pub fn judged(&self) -> Verdict {
        match self.is_undefined() {
            true => Verdict::Undefined,
            false => self.stated,
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
            texts[0].clear();
        }
        texts
    }

    /// By how much the computed values differ; `None` where one of the two is undefined.
    pub fn errors(&self) -> [Option<f64>; 2] {
        let [exact, axisymmetric, half_space] = self.values;
        let unit = self.unit.as_ref().map(|_| 1.0).or(exact.map(f64::abs));
        [axisymmetric, half_space].map(|value| Some((value? - exact?) / unit?))
    }

    /// The same as printed; empty where the value is itself a difference or a count.
    fn error_texts(&self) -> [String; 2] {
        self.errors().map(|error| match self.source {
            Source::Difference | Source::Count => String::new(),
            _ => error.map(difference).unwrap_or_default(),
        })
    }

    /// The exact value in a table to be read.
    fn exact_text(&self) -> String {
        let [exact, ..] = self.texts();
        match self.source {
            Source::Difference => exact,
            _ if self.is_undefined() => UNDEFINED.to_owned(),
            Source::Refined | Source::Count => format!("{exact} (refined)"),
            Source::ClosedForm => exact,
        }
    }

    /// Both errors, likewise.
    fn errors_text(&self) -> String {
        let mut texts = self.error_texts().to_vec();
        texts.retain(|text| !text.is_empty());
        match texts.is_empty() {
            true => String::new(),
            false => format!("{} {}", texts.join(", "), self.unit()),
        }
    }

    /// Whether both engines come as near as they must; `None` where the value is undefined.
    pub fn is_accurate(&self) -> Option<bool> {
        let mut pairs = self.errors().into_iter().zip(self.tolerances);
        let near = pairs.all(|(error, allowed)| error.is_none_or(|e| e.abs() <= allowed));
        (!self.is_undefined()).then_some(near)
    }
}

type Column = (&'static str, fn(&Claim) -> String);

const QUANTITY: Column = ("quantity", |c| c.quantity.clone());
const AXISYMMETRIC: Column = ("axisymmetric", |c| c.texts()[1].clone());
const VERDICT: Column = ("verdict", |c| c.judged().name().to_owned());
const NOTE: Column = ("note", |c| c.note.clone());

/// Columns of a table to be read.
pub(super) const COLUMNS: [Column; 8] = [
    QUANTITY,
    ("the paper", |c| c.paper.clone()),
    ("exact", Claim::exact_text),
    AXISYMMETRIC,
    ("half-space", |c| c.texts()[2].clone()),
    ("errors", Claim::errors_text),
    VERDICT,
    NOTE,
];

/// Its rows: what the paper states of one and of the next stands once.
pub(super) fn rows(claims: &[Claim]) -> impl Iterator<Item = [String; 8]> {
    let above = std::iter::once("").chain(claims.iter().map(|claim| &claim.paper[..]));
    claims.iter().zip(above).map(|(claim, above)| {
        let mut cells = COLUMNS.map(|(_, cell)| cell(claim));
        if !above.is_empty() && above == claim.paper {
            cells[1] = "as above".to_owned();
        }
        cells
    })
}

/// Columns of `claims.csv` after the number of the figure.
const TABLE: [Column; 12] = [
    QUANTITY,
    ("paper", |c| c.paper.clone()),
    ("exact", |c| c.texts()[0].clone()),
    ("exact_source", |c| {
        let source = match c.source {
            Source::ClosedForm => "closed form",
            Source::Refined | Source::Count => "refined",
            Source::Difference => "difference",
        };
        source.to_owned()
    }),
    AXISYMMETRIC,
    ("half_space", |c| c.texts()[2].clone()),
    ("error_unit", |c| c.unit().to_owned()),
    ("axisymmetric_error", |c| c.error_texts()[0].clone()),
    ("half_space_error", |c| c.error_texts()[1].clone()),
    ("within_accuracy", |c| {
        let word = |accurate| if accurate { "yes" } else { "no" };
        c.is_accurate().map(word).unwrap_or_default().to_owned()
    }),
    VERDICT,
    NOTE,
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

    fn claim(source: Source, exact: Option<f64>, unit: Option<&str>) -> Claim {
        Claim {
            quantity: "largest pressure / p_H".to_owned(),
            source,
            values: [exact, Some(1.5), None],
            unit: unit.map(str::to_owned),
            tolerances: [1e-3; 2],
            paper: String::new(),
            stated: Verdict::Agrees,
            note: String::new(),
        }
    }

    #[test]
    fn a_claim_whose_value_is_undefined_says_so_and_has_no_error() {
        for (source, unit) in [
            (Source::ClosedForm, None),
            (Source::Refined, Some("of p_H")),
            (Source::Count, Some("of p_H")),
        ] {
            let claim = claim(source, None, unit);
            assert!(claim.is_undefined());
            assert_eq!(claim.judged(), Verdict::Undefined);
            assert_eq!(claim.is_accurate(), None);
            assert_eq!(claim.errors(), [None, None]);
            let cells = rows(std::slice::from_ref(&claim)).next().unwrap();
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
            discussion: None,
            panels: Vec::new(),
            data: Vec::new(),
            claims: vec![claim(Source::Refined, None, Some("of p_H"))],
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
        let mut computed = claim(Source::Difference, Some(0.0), Some("of p_H"));
        assert_eq!(computed.judged(), Verdict::Agrees);
        computed.values[1] = None;
        assert_eq!(computed.judged(), Verdict::Undefined);
        assert_eq!(computed.is_accurate(), None);
    }
}
