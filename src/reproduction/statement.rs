//! What the paper states of a figure (`figures.toml`), and whether it agrees with what is computed: a verdict follows from the values,
//! and one trend over many values counts once.

use serde::Deserialize;

use super::claim::{Claim, Verdict};
use super::run::unfit;
use super::{Figure, Result};

/// Times further from an extremum of the load than this (in the time of the figure) are other times.
const OTHER_TIME: f64 = 0.05;

/// What stays changes by no more than this part of itself.
const STAYS: f64 = 1e-6;

/// One statement of the paper.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Statement {
    /// Beginnings of the names of the values that it is about.
    rows: Vec<String>,
    /// The words, or the place of the number.
    paper: String,
    holds: Rule,
}

/// When a statement holds, of all its rows together.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Rule {
    /// The number, and half a unit of its last digit.
    Is(f64, f64),
    AtMost(f64),
    AtLeast(f64),
    AsTheTheory,
    Falls,
    Rises,
    NeverFalls,
    Stays,
    Positive,
    OtherTimes(Vec<f64>),
}

/// A statement that has been held against what is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    pub paper: String,
    /// The values that it is about, as printed.
    pub computed: String,
    /// Whether the paper gives a number.
    pub is_number: bool,
    pub verdict: Verdict,
    /// Notes on these values.
    pub note: String,
}

impl Judged {
    /// Headings of a table of statements, and the row of one.
    pub(super) const COLUMNS: [&str; 3] = ["the paper states", "kind", "verdict"];

    pub(super) fn cells(&self) -> [&str; 3] {
        let kind = if self.is_number { "number" } else { "words" };
        [&self.paper, kind, self.verdict.name()]
    }

    /// A sentence on one that disagrees, of the figure with this number.
    fn disagreement(&self, figure: u8) -> String {
        let Self {
            paper,
            computed,
            note,
            ..
        } = self;
        let note = match note.is_empty() {
            true => String::new(),
            false => format!(" ({note})"),
        };
        format!("Figure {figure}: \u{201c}{paper}\u{201d} Computed: {computed}{note}.")
    }
}

/// Every statement with its figure.
pub(super) fn all<'a>(figures: &'a [Figure]) -> impl Iterator<Item = (&'a Figure, &'a Judged)> {
    let of = |figure: &'a Figure| std::iter::repeat(figure).zip(&figure.statements);
    figures.iter().flat_map(of)
}

/// A sentence for each statement of the paper that disagrees.
pub(super) fn disagreeing(figures: &[Figure]) -> Vec<String> {
    let disagree = all(figures).filter(|(_, one)| one.verdict == Verdict::Disagrees);
    disagree
        .map(|(figure, one)| one.disagreement(figure.number))
        .collect()
}

/// How many statements there are in these figures, numbers and words apart, and how many values besides: `14 numbers of the paper
/// (9 agree, 5 disagree), 18 statements in words (18 agree); 40 values more are computed ...`.
pub fn counted(figures: &[Figure]) -> String {
    let tally = |is_number: bool| {
        let of_kind = all(figures).filter(|(_, one)| one.is_number == is_number);
        let verdicts: Vec<Verdict> = of_kind.map(|(_, one)| one.verdict).collect();
        let named = [
            (Verdict::Agrees, "agree"),
            (Verdict::Disagrees, "disagree"),
            (Verdict::Undefined, "are undefined"),
        ];
        let named = named.map(|(verdict, name)| {
            let count = verdicts.iter().filter(|v| **v == verdict).count();
            (count > 0).then(|| format!("{count} {name}"))
        });
        let named: Vec<String> = named.into_iter().flatten().collect();
        match named.is_empty() {
            true => (0, String::new()),
            false => (verdicts.len(), format!(" ({})", named.join(", "))),
        }
    };
    let ((numbers, of_numbers), (words, of_words)) = (tally(true), tally(false));
    let claims = figures.iter().flat_map(|figure| &figure.claims);
    let more = claims
        .filter(|claim| claim.judged() == Verdict::NotStated)
        .count();
    format!(
        "{numbers} numbers of the paper{of_numbers}, {words} statements in words{of_words}; {more} values more are computed that are \
         not stated there"
    )
}

impl Statement {
    /// Holds it against the values that it is about, which get the verdict.
    ///
    /// # Errors
    /// [`ReproductionError::Unfit`] where it says something that cannot be held against values.
    pub fn judged(&self, claims: &mut [Claim]) -> Result<Judged> {
        let is_meant = |claim: &Claim| self.rows.iter().any(|r| claim.quantity.starts_with(r));
        let meant: Vec<&Claim> = claims.iter().filter(|claim| is_meant(claim)).collect();
        if meant.is_empty() {
            let rows = self.rows.join(", ");
            return Err(unfit(format!(
                "figures.toml, {}: no value is named {rows}",
                self.paper
            )));
        }
        let verdict = self.verdict(&meant);
        let each = |text: &dyn Fn(&Claim) -> String| {
            let mut texts: Vec<String> = meant.iter().map(|claim| text(claim)).collect();
            texts.retain(|text| !text.is_empty());
            texts
        };
        let values = each(&|claim| claim.texts()[0].clone());
        let mut notes = each(&|claim| claim.note.clone());
        notes.dedup();
        let (near, count) = (accurate(&meant), meant.len());
        let judged = Judged {
            paper: self.paper.clone(),
            computed: match self.holds == Rule::AsTheTheory || values.is_empty() {
                true => format!("{near} of {count} values within the accuracy asked for"),
                false => format!("{}: {}", self.rows.join("; "), values.join(", ")),
            },
            is_number: matches!(
                self.holds,
                Rule::Is(..) | Rule::AtMost(_) | Rule::AtLeast(_)
            ),
            verdict,
            note: notes.join("; "),
        };
        for claim in claims.iter_mut().filter(|claim| is_meant(claim)) {
            claim.add(&self.paper, verdict);
        }
        Ok(judged)
    }

    fn verdict(&self, claims: &[&Claim]) -> Verdict {
        let numbers: Option<Vec<f64>> = claims.iter().map(|claim| claim.values[0]).collect();
        let defined = claims.iter().all(|claim| !claim.is_undefined());
        let Some(values) = numbers.filter(|_| defined) else {
            return Verdict::Undefined;
        };
        let all = |rule: &dyn Fn(f64) -> bool| values.iter().all(|value| rule(*value));
        let step = |rule: fn(f64, f64) -> bool| {
            values.len() > 1 && values.windows(2).all(|pair| rule(pair[0], pair[1]))
        };
        let holds = match &self.holds {
            Rule::Is(number, within) => all(&|v| (v - number).abs() <= *within),
            Rule::AtMost(most) => all(&|v| v <= *most),
            Rule::AtLeast(least) => all(&|v| v >= *least),
            Rule::AsTheTheory => accurate(claims) == claims.len(),
            Rule::Falls => step(|a, b| b < a),
            Rule::Rises => step(|a, b| b > a),
            Rule::NeverFalls => step(|a, b| b >= a),
            Rule::Stays => all(&|v| (v - values[0]).abs() <= STAYS * values[0].abs()),
            Rule::Positive => all(&|v| v > 0.0),
            Rule::OtherTimes(times) => {
                let mut pairs = values.iter().zip(times);
                times.len() == values.len() && pairs.all(|(v, t)| (v - t).abs() > OTHER_TIME)
            }
        };
        match holds {
            true => Verdict::Agrees,
            false => Verdict::Disagrees,
        }
    }
}

fn accurate(claims: &[&Claim]) -> usize {
    let claims = claims.iter();
    claims
        .filter(|claim| claim.is_accurate() == Some(true))
        .count()
}

#[cfg(test)]
mod tests {
    use super::super::claim::Source;
    use super::*;

    fn claim(quantity: &str, value: Option<f64>) -> Claim {
        Claim {
            quantity: quantity.to_owned(),
            source: Source::Refined,
            values: [value, value, None],
            unit: Some("of a_H".to_owned()),
            tolerances: [1e-3; 2],
            paper: String::new(),
            stated: Verdict::NotStated,
            note: String::new(),
        }
    }

    fn verdict(text: &str, values: &[Option<f64>]) -> Verdict {
        let statement: Statement = toml::from_str(&format!(
            "rows = [\"radius\"]\npaper = \"\"\nholds = {text}"
        ))
        .unwrap();
        let mut claims: Vec<Claim> = values.iter().map(|v| claim("radius", *v)).collect();
        claims.push(claim("another", Some(7.0)));
        let judged = statement.judged(&mut claims).unwrap();
        assert_eq!(claims[0].judged(), judged.verdict);
        assert_eq!(claims.last().unwrap().judged(), Verdict::NotStated);
        judged.verdict
    }

    #[test]
    fn a_verdict_follows_from_the_values() {
        use Verdict::{Agrees, Disagrees, Undefined};
        let falling = [Some(3.0), Some(2.0), Some(1.0)];
        let level = [Some(2.0), Some(2.0)];
        for (text, values, expected) in [
            ("{ is = [2.0, 0.05] }", &level[..], Agrees),
            ("{ is = [2.06, 0.05] }", &level, Disagrees),
            ("{ at-most = 2.5 }", &falling, Disagrees),
            ("{ at-least = 1.0 }", &falling, Agrees),
            ("\"falls\"", &falling, Agrees),
            ("\"rises\"", &falling, Disagrees),
            ("\"falls\"", &level, Disagrees),
            ("\"never-falls\"", &level, Agrees),
            ("\"stays\"", &level, Agrees),
            ("\"stays\"", &falling, Disagrees),
            ("\"positive\"", &falling, Agrees),
            ("{ other-times = [2.0, 2.1] }", &level, Disagrees),
            ("{ other-times = [1.9, 2.1] }", &level, Agrees),
            ("\"as-the-theory\"", &level, Agrees),
            ("\"falls\"", &[Some(1.0), None], Undefined),
        ] {
            assert_eq!(verdict(text, values), expected, "{text}");
        }
    }

    #[test]
    fn a_statement_without_a_value_or_with_two_rules_is_refused() {
        let of = |text: &str| toml::from_str::<Statement>(&format!("paper = \"\"\n{text}"));
        let missing = of("rows = [\"depth\"]\nholds = { is = [1.0, 1.0] }").unwrap();
        let refused = missing.judged(&mut [claim("radius", Some(1.0))]);
        assert!(refused.unwrap_err().to_string().contains("depth"));
        for wrong in [
            "{ at-most = 1.0, at-least = 1.0 }",
            "{ is = [1.0] }",
            "\"wobbles\"",
        ] {
            assert!(
                of(&format!("rows = [\"radius\"]\nholds = {wrong}")).is_err(),
                "{wrong}"
            );
        }
        assert!(of("rows = [\"radius\"]").is_err());
    }

    #[test]
    fn numbers_and_words_are_counted_apart_and_a_trend_once() {
        let mut figure = Figure {
            number: 10,
            caption: String::new(),
            discussion: None,
            panels: Vec::new(),
            data: Vec::new(),
            claims: [Some(2.0), Some(1.0)].map(|v| claim("radius", v)).to_vec(),
            statements: Vec::new(),
        };
        figure.claims.push(claim("depth", None));
        figure.claims.push(claim("another", Some(7.0)));
        for text in [
            "rows = [\"radius\"]\nholds = \"falls\"",
            "rows = [\"radius\"]\nholds = { at-most = 1.5 }",
            "rows = [\"depth\"]\nholds = { at-most = 1.5 }",
        ] {
            let text = format!("paper = \"p\"\n{text}");
            let statement: Statement = toml::from_str(&text).unwrap();
            let judged = statement.judged(&mut figure.claims).unwrap();
            figure.statements.push(judged);
        }
        // One that disagrees is heard.
        assert_eq!(figure.claims[0].judged(), Verdict::Disagrees);
        assert_eq!(
            counted(&[figure]),
            "2 numbers of the paper (1 disagree, 1 are undefined), 1 statements in words (1 agree); 1 values more are computed that \
             are not stated there"
        );
        assert_eq!(
            counted(&[]),
            "0 numbers of the paper, 0 statements in words; 0 values more are computed that are not stated there"
        );
    }
}
