//! What the paper states, as data (`sweeps/spinu-2018/claims.toml`), and whether it agrees with what is computed: a verdict follows
//! from the values, and one trend over many values counts once.

use serde::Deserialize;

use super::claim::{Claim, Verdict};
use super::{Figure, ReproductionError, Result};

/// The file, in the program.
const FILE: &str = include_str!("../../sweeps/spinu-2018/claims.toml");

/// Times further from an extremum of the load than this (in the time of the figure) are other times.
const OTHER_TIME: f64 = 0.05;

/// What stays changes by no more than this part of itself.
const STAYS: f64 = 1e-6;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    claim: Vec<Statement>,
}

/// One statement of the paper.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Statement {
    figure: u8,
    /// Beginnings of the names of the values that it is about.
    rows: Vec<String>,
    /// The words, or the place of the number.
    paper: String,
    is: Option<f64>,
    tolerance: Option<f64>,
    at_most: Option<f64>,
    at_least: Option<f64>,
    qualitative: Option<Trend>,
    #[serde(default)]
    times: Vec<f64>,
}

/// What is stated in words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Trend {
    #[serde(rename = "as the theory")]
    AsTheTheory,
    Falls,
    Rises,
    #[serde(rename = "never falls")]
    NeverFalls,
    Stays,
    Positive,
    #[serde(rename = "other times")]
    OtherTimes,
}

/// A statement that has been held against what is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    pub figure: u8,
    pub paper: String,
    /// The values that it is about, as printed.
    pub computed: String,
    /// Whether the paper gives a number.
    pub is_number: bool,
    pub verdict: Verdict,
    /// Notes on these values.
    pub note: String,
}

/// How many statements there are: numbers and words apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Count {
    /// Agree, disagree, and cannot be compared.
    pub numbers: [usize; 3],
    pub words: [usize; 3],
    /// Values that are computed and not stated in the paper.
    pub not_stated: usize,
}

impl Count {
    /// Of these figures.
    pub fn of<'a>(figures: impl IntoIterator<Item = &'a Figure>) -> Self {
        let mut count = Self::default();
        for figure in figures {
            for statement in &figure.statements {
                let place = match statement.verdict {
                    Verdict::Agrees => 0,
                    Verdict::Disagrees => 1,
                    Verdict::Undefined | Verdict::NotStated => 2,
                };
                match statement.is_number {
                    true => count.numbers[place] += 1,
                    false => count.words[place] += 1,
                }
            }
            let not_stated = |claim: &&Claim| claim.judged() == Verdict::NotStated;
            count.not_stated += figure.claims.iter().filter(not_stated).count();
        }
        count
    }

    /// `14 numbers (9 agree, 5 disagree), 18 statements in words (18 agree)`, and what is not stated.
    pub fn text(&self) -> String {
        let verdicts = |counts: [usize; 3]| {
            let named = counts
                .into_iter()
                .zip(["agree", "disagree", "are undefined"]);
            let named = named.filter(|(count, _)| *count > 0);
            let named: Vec<String> = named
                .map(|(count, name)| format!("{count} {name}"))
                .collect();
            match named.is_empty() {
                true => String::new(),
                false => format!(" ({})", named.join(", ")),
            }
        };
        format!(
            "{} numbers of the paper{}, {} statements in words{}; {} values more are computed that are not stated there",
            self.numbers.iter().sum::<usize>(),
            verdicts(self.numbers),
            self.words.iter().sum::<usize>(),
            verdicts(self.words),
            self.not_stated
        )
    }
}

/// Holds what the paper states of these figures against their values; both are told the verdict.
///
/// # Errors
/// [`ReproductionError::Unfit`] where the file says something that cannot be held against values.
pub(super) fn judge(figures: &mut [Figure]) -> Result<()> {
    let statements = statements()?;
    for figure in figures {
        let of_figure = statements.iter().filter(|s| s.figure == figure.number);
        for statement in of_figure {
            let judged = statement.judged(&mut figure.claims)?;
            figure.statements.push(judged);
        }
    }
    Ok(())
}

fn statements() -> Result<Vec<Statement>> {
    let file: Result<File, _> = toml::from_str(FILE);
    file.map(|file| file.claim)
        .map_err(|error| ReproductionError::Unfit(format!("claims.toml: {error}")))
}

impl Statement {
    fn judged(&self, claims: &mut [Claim]) -> Result<Judged> {
        let is_meant = |claim: &Claim| self.rows.iter().any(|r| claim.quantity.starts_with(r));
        let meant: Vec<&Claim> = claims.iter().filter(|claim| is_meant(claim)).collect();
        if meant.is_empty() {
            let rows = self.rows.join(", ");
            return Err(self.unfit(&format!("no value is named {rows}")));
        }
        let verdict = self.verdict(&meant)?;
        let values = meant.iter().map(|claim| claim.texts().exact);
        let values: Vec<String> = values.filter(|text| !text.is_empty()).collect();
        let mut notes: Vec<&str> = Vec::new();
        for claim in &meant {
            if !claim.note.is_empty() && !notes.contains(&claim.note.as_str()) {
                notes.push(&claim.note);
            }
        }
        let judged = Judged {
            figure: self.figure,
            paper: self.paper.clone(),
            computed: match (self.qualitative, values.is_empty()) {
                (Some(Trend::AsTheTheory), _) | (_, true) => {
                    format!(
                        "{} of {} values within the accuracy asked for",
                        accurate(&meant),
                        meant.len()
                    )
                }
                _ => format!("{}: {}", self.rows.join("; "), values.join(", ")),
            },
            is_number: self.qualitative.is_none(),
            verdict,
            note: notes.join("; "),
        };
        for claim in claims.iter_mut().filter(|claim| is_meant(claim)) {
            claim.stated.add(&self.paper, verdict);
        }
        Ok(judged)
    }

    fn unfit(&self, what: &str) -> ReproductionError {
        ReproductionError::Unfit(format!("claims.toml, figure {}: {what}", self.figure))
    }

    fn verdict(&self, claims: &[&Claim]) -> Result<Verdict> {
        let numbers: Option<Vec<f64>> = claims.iter().map(|claim| claim.values.exact).collect();
        let defined = claims.iter().all(|claim| !claim.is_undefined());
        let Some(values) = numbers.filter(|_| defined) else {
            return Ok(Verdict::Undefined);
        };
        let holds = match (
            self.is.zip(self.tolerance),
            self.at_most,
            self.at_least,
            self.qualitative,
        ) {
            (Some((is, within)), None, None, None) => {
                values.iter().all(|v| (v - is).abs() <= within)
            }
            (None, Some(most), None, None) => values.iter().all(|v| *v <= most),
            (None, None, Some(least), None) => values.iter().all(|v| *v >= least),
            (None, None, None, Some(trend)) => self.follows(trend, &values, claims),
            _ => {
                let needed = "give `is` with `tolerance`, `at_most`, `at_least` or `qualitative`, one of them";
                return Err(self.unfit(needed));
            }
        };
        Ok(if holds {
            Verdict::Agrees
        } else {
            Verdict::Disagrees
        })
    }

    fn follows(&self, trend: Trend, values: &[f64], claims: &[&Claim]) -> bool {
        let step = |rule: fn(f64, f64) -> bool| values.windows(2).all(|w| rule(w[0], w[1]));
        match trend {
            Trend::AsTheTheory => accurate(claims) == claims.len(),
            Trend::Falls => values.len() > 1 && step(|a, b| b < a),
            Trend::Rises => values.len() > 1 && step(|a, b| b > a),
            Trend::NeverFalls => values.len() > 1 && step(|a, b| b >= a),
            Trend::Stays => values
                .iter()
                .all(|v| (v - values[0]).abs() <= STAYS * values[0].abs()),
            Trend::Positive => values.iter().all(|v| *v > 0.0),
            Trend::OtherTimes => {
                self.times.len() == values.len()
                    && values
                        .iter()
                        .zip(&self.times)
                        .all(|(v, t)| (v - t).abs() > OTHER_TIME)
            }
        }
    }
}

fn accurate(claims: &[&Claim]) -> usize {
    claims
        .iter()
        .filter(|claim| claim.is_accurate() == Some(true))
        .count()
}

#[cfg(test)]
mod tests {
    use super::super::{ByEngine, Measure, Source};
    use super::*;

    fn claim(quantity: &str, value: Option<f64>) -> Claim {
        let values = ByEngine::of(value, [value, None]);
        let measure = Measure::absolute("of a_H", 1e-3, 1e-3);
        Claim::new(quantity, Source::Refined, values, measure)
    }

    fn verdict(text: &str, values: &[Option<f64>]) -> Verdict {
        let statement: Statement = toml::from_str(&format!(
            "figure = 10\nrows = [\"radius\"]\npaper = \"\"\n{text}"
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
            ("is = 2.0\ntolerance = 0.05", &level[..], Agrees),
            ("is = 2.06\ntolerance = 0.05", &level, Disagrees),
            ("at_most = 2.5", &falling, Disagrees),
            ("at_least = 1.0", &falling, Agrees),
            ("qualitative = \"falls\"", &falling, Agrees),
            ("qualitative = \"rises\"", &falling, Disagrees),
            ("qualitative = \"falls\"", &level, Disagrees),
            ("qualitative = \"never falls\"", &level, Agrees),
            ("qualitative = \"stays\"", &level, Agrees),
            ("qualitative = \"stays\"", &falling, Disagrees),
            ("qualitative = \"positive\"", &falling, Agrees),
            (
                "qualitative = \"other times\"\ntimes = [2.0, 2.1]",
                &level,
                Disagrees,
            ),
            (
                "qualitative = \"other times\"\ntimes = [1.9, 2.1]",
                &level,
                Agrees,
            ),
            ("qualitative = \"as the theory\"", &level, Agrees),
            ("qualitative = \"falls\"", &[Some(1.0), None], Undefined),
        ] {
            assert_eq!(verdict(text, values), expected, "{text}");
        }
    }

    #[test]
    fn a_statement_without_a_value_or_with_two_rules_is_refused() {
        let of =
            |text: &str| toml::from_str::<Statement>(&format!("figure = 10\npaper = \"\"\n{text}"));
        let missing = of("rows = [\"depth\"]\nis = 1.0\ntolerance = 1.0").unwrap();
        let mut claims = [claim("radius", Some(1.0))];
        assert!(
            missing
                .judged(&mut claims)
                .unwrap_err()
                .to_string()
                .contains("depth")
        );
        let both = of("rows = [\"radius\"]\nat_most = 1.0\nat_least = 1.0").unwrap();
        assert!(both.judged(&mut claims).is_err());
        assert!(of("rows = []\nqualitative = \"wobbles\"").is_err());
    }

    #[test]
    fn numbers_and_words_are_counted_apart_and_a_trend_once() {
        let mut figure = Figure {
            number: 10,
            caption: String::new(),
            panels: Vec::new(),
            data: Vec::new(),
            claims: [Some(2.0), Some(1.0)].map(|v| claim("radius", v)).to_vec(),
            statements: Vec::new(),
        };
        figure.claims.push(claim("depth", None));
        figure.claims.push(claim("another", Some(7.0)));
        for text in [
            "rows = [\"radius\"]\nqualitative = \"falls\"",
            "rows = [\"radius\"]\nat_most = 1.5",
            "rows = [\"depth\"]\nat_most = 1.5",
        ] {
            let text = format!("figure = 10\npaper = \"p\"\n{text}");
            let statement: Statement = toml::from_str(&text).unwrap();
            let judged = statement.judged(&mut figure.claims).unwrap();
            figure.statements.push(judged);
        }
        // One that disagrees is heard.
        assert_eq!(figure.claims[0].judged(), Verdict::Disagrees);
        let count = Count::of([&figure]);
        assert_eq!((count.numbers, count.words), ([0, 1, 1], [1, 0, 0]));
        assert_eq!(
            count.text(),
            "2 numbers of the paper (1 disagree, 1 are undefined), 1 statements in words (1 agree); 1 values more are computed that \
             are not stated there"
        );
    }

    #[test]
    fn the_file_can_be_read_and_states_something_of_every_figure() {
        let statements = statements().unwrap();
        for figure in super::super::FIGURES {
            assert!(statements.iter().any(|s| s.figure == figure), "{figure}");
        }
    }
}
