//! What is to be known of a record before its numbers are used: data with a sentence each.

use std::fmt;

use serde::{Deserialize, Serialize};

/// One thing that was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "code", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Finding {
    /// Rows without a number.
    EmptyCells { rows: usize },
    /// Times that step back.
    UnorderedTimes { places: usize },
    /// Gaps in times that are regular otherwise.
    MissingSamples { samples: usize, largest_gap_s: f64 },
    /// Standard deviation of the intervals over the interval.
    Jitter { relative: f64 },
    /// Times without an interval of their own.
    NotUniform { spread: f64 },
    /// A signal stays at its largest or smallest value.
    Clipped {
        signal: String,
        end: String,
        cycles: usize,
    },
    /// Not all harmonics are resolved.
    FewPoints { points: f64, harmonics: usize },
    /// Cycles too few to tell a trend.
    FewCycles { cycles: usize },
    /// Single samples far from the rest.
    Spikes {
        signal: String,
        samples: usize,
        first_s: f64,
    },
    /// A line in what is left of a signal.
    Line {
        signal: String,
        hz: f64,
        amplitude: f64,
        /// The harmonic that the sampling folds to this frequency, where there is one.
        folded_harmonic: Option<usize>,
    },
    /// The given frequency is not that of the record.
    OtherFrequency { given_hz: f64, found_hz: f64 },
    /// Cycles that miss samples.
    Incomplete { cycles: Vec<usize> },
    /// Cycles that stand apart: the quantity, and by how much, relative to the median.
    Outliers { cycles: Vec<Outlier> },
    /// A quantity changes up to the end: relative change over the cycles judged.
    NotStabilised { quantity: String, change: f64 },
    /// The approach runs ahead of the load.
    Leads,
    /// What the instrument adds is larger than the contact.
    CorrectionDominates { ratio: f64 },
    /// The load becomes a pull in part of the cycle.
    Pull,
    /// No contact radius.
    NoRadius { reason: String },
    /// The bias of the formula is not known.
    NoBias { reason: String },
}

/// A cycle that stands apart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outlier {
    /// Counted from 1.
    pub cycle: usize,
    pub quantity: String,
    /// Over the median.
    pub relative: f64,
}

impl Finding {
    /// The word for it in tables.
    pub fn code(&self) -> &'static str {
        match self {
            Self::EmptyCells { .. } => "empty-cells",
            Self::UnorderedTimes { .. } => "unordered-times",
            Self::MissingSamples { .. } => "missing-samples",
            Self::Jitter { .. } => "jitter",
            Self::NotUniform { .. } => "not-uniform",
            Self::Clipped { .. } => "clipped",
            Self::FewPoints { .. } => "few-points",
            Self::FewCycles { .. } => "few-cycles",
            Self::Spikes { .. } => "spikes",
            Self::Line {
                folded_harmonic: Some(_),
                ..
            } => "aliasing",
            Self::Line { .. } => "line",
            Self::OtherFrequency { .. } => "other-frequency",
            Self::Incomplete { .. } => "incomplete-cycles",
            Self::Outliers { .. } => "outliers",
            Self::NotStabilised { .. } => "not-stabilised",
            Self::Leads => "leads",
            Self::CorrectionDominates { .. } => "correction-dominates",
            Self::Pull => "pull",
            Self::NoRadius { .. } => "no-radius",
            Self::NoBias { .. } => "no-bias",
        }
    }
}

/// `cycle 3`, `cycles 3, 5 and 7`; of many the first ones.
fn cycles(numbers: &[usize]) -> String {
    const NAMED: usize = 8;
    let named: Vec<String> = numbers
        .iter()
        .take(NAMED)
        .map(ToString::to_string)
        .collect();
    let s = if numbers.len() == 1 { "" } else { "s" };
    let rest = match numbers.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("cycle{s} {}{rest}", named.join(", "))
}

fn plural(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |part: f64| format!("{:.2} %", 100.0 * part);
        match self {
            Self::EmptyCells { rows } => {
                let (rows, be) = match rows {
                    1 => ("1 row has".to_owned(), "is"),
                    many => (format!("{many} rows have"), "are"),
                };
                write!(f, "{rows} no number in a column and {be} left out")
            }
            Self::UnorderedTimes { places } => {
                let places = plural(*places, "place", "places");
                write!(
                    f,
                    "times step back at {places}; the samples are put in order"
                )
            }
            Self::MissingSamples {
                samples,
                largest_gap_s,
            } => {
                let samples = plural(*samples, "sample is", "samples are");
                write!(
                    f,
                    "{samples} missing between regular times; the largest gap is {largest_gap_s:.4e} s"
                )
            }
            Self::Jitter { relative } => {
                let relative = percent(*relative);
                write!(
                    f,
                    "sampling times jitter by {relative} of the interval (standard deviation); they are taken as given"
                )
            }
            Self::NotUniform { .. } => {
                write!(
                    f,
                    "times have no interval of their own; missing samples cannot be told"
                )
            }
            Self::Clipped {
                signal,
                end,
                cycles,
            } => {
                let cycles = plural(*cycles, "cycle", "cycles");
                write!(
                    f,
                    "the {signal} stays at its {end} value in {cycles}: it is clipped, and loss and harmonics are those of the clipped signal"
                )
            }
            Self::FewPoints { points, harmonics } => {
                write!(f, "{points:.1} samples a cycle resolve ")?;
                match harmonics {
                    1 => write!(
                        f,
                        "no harmonic beyond the first; what is there is folded into it"
                    ),
                    n => write!(f, "harmonics up to {n} alone"),
                }
            }
            Self::FewCycles { cycles } => {
                let cycles = plural(*cycles, "cycle is", "cycles are");
                write!(f, "{cycles} too few to tell whether the loop still changes")
            }
            Self::Spikes {
                signal,
                samples,
                first_s,
            } => {
                let samples = plural(*samples, "sample", "samples");
                write!(
                    f,
                    "{samples} of the {signal}, the first at {first_s:.6} s, lie far from the rest and are left out"
                )
            }
            Self::Line {
                signal,
                hz,
                amplitude,
                folded_harmonic,
            } => {
                write!(
                    f,
                    "beside the oscillation the {signal} has a line at {hz:.5} Hz with an amplitude of {amplitude:.2e} (SI)"
                )?;
                match folded_harmonic {
                    Some(n) => write!(f, ": harmonic {n} is there by aliasing; sample faster"),
                    None => write!(f, ", which is no harmonic"),
                }
            }
            Self::OtherFrequency { given_hz, found_hz } => {
                write!(
                    f,
                    "the record oscillates at {found_hz:.7} Hz and not at the {given_hz} Hz that were given"
                )
            }
            Self::Incomplete { cycles: numbers } => {
                let (cycles, s) = (cycles(numbers), if numbers.len() == 1 { "es" } else { "" });
                write!(f, "{cycles} miss{s} samples and count in no mean")
            }
            Self::Outliers { cycles } => {
                let one = |outlier: &Outlier| {
                    let part = 100.0 * outlier.relative;
                    format!(
                        "cycle {} ({} {part:+.2} %)",
                        outlier.cycle, outlier.quantity
                    )
                };
                let named: Vec<String> = cycles.iter().take(8).map(one).collect();
                let (count, named) = (cycles.len(), named.join(", "));
                let verb = if count == 1 { "stands" } else { "stand" };
                write!(
                    f,
                    "{named} {verb} apart from the other cycles and count in no mean"
                )
            }
            Self::NotStabilised { quantity, change } => {
                let change = percent(*change);
                write!(
                    f,
                    "the {quantity} still changes by {change} over the last cycles: there is no stabilised cycle to take a mean of"
                )
            }
            Self::Leads => write!(
                f,
                "the approach runs ahead of the load, so that the loop gives energy; look for the sign of a column, or a lag between the \
                 channels (`time_lag` of the setup)"
            ),
            Self::CorrectionDominates { ratio } => write!(
                f,
                "mass, damping and stiffness of the instrument take {ratio:.1} times the load that is left for the contact: errors of theirs \
                 count as much more"
            ),
            Self::Pull => write!(
                f,
                "the load becomes a pull in a part of the cycle: the contact may open or stick"
            ),
            Self::NoRadius { reason } => {
                write!(f, "there is no contact radius, and no modulus: {reason}")
            }
            Self::NoBias { reason } => write!(
                f,
                "the bias of the small-amplitude formula is not computed: {reason}"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_are_sentences_with_one_and_with_many() {
        let text = |finding: Finding| finding.to_string();
        assert_eq!(
            text(Finding::EmptyCells { rows: 1 }),
            "1 row has no number in a column and is left out"
        );
        assert!(text(Finding::Incomplete { cycles: vec![3] }).starts_with("cycle 3 misses"));
        let many = Finding::Incomplete {
            cycles: (1..=10).collect(),
        };
        assert!(text(many).starts_with("cycles 1, 2, 3, 4, 5, 6, 7, 8 and 2 more miss samples"));
        let outlier = Outlier {
            cycle: 7,
            quantity: "energy loss".to_owned(),
            relative: 0.123,
        };
        let outliers = Finding::Outliers {
            cycles: vec![outlier],
        };
        assert!(text(outliers).starts_with("cycle 7 (energy loss +12.30 %) stands apart"));
    }
}
