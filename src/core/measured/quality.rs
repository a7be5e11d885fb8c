//! What is to be known of a record before its numbers are used: data with a sentence each.

use serde::{Deserialize, Serialize};

/// One thing that was found, displayed as a sentence.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[serde(tag = "code", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Finding {
    /// Rows without a number.
    #[error("{} no number in a column and {} left out", plural(.rows, "row has", "rows have"), if *.rows == 1 { "is" } else { "are" })]
    EmptyCells { rows: usize },
    /// Times that step back.
    #[error("times step back at {}; the samples are put in order", plural(.places, "place", "places"))]
    UnorderedTimes { places: usize },
    /// Times that step back at every sample.
    #[error("the times descend from the first sample to the last; the samples are put in order")]
    DescendingTimes,
    /// Gaps in times that are regular otherwise.
    #[error(
        "{} missing between regular times; the largest gap is {largest_gap_s:.4e} s",
        plural(.samples, "sample is", "samples are")
    )]
    MissingSamples { samples: usize, largest_gap_s: f64 },
    /// Standard deviation of the intervals over the interval.
    #[error(
        "sampling times jitter by {:.2} % of the interval (standard deviation); they are taken as given",
        100.0 * .relative
    )]
    Jitter { relative: f64 },
    /// Times without an interval of their own.
    #[error("times have no interval of their own; missing samples cannot be told")]
    NotUniform { spread: f64 },
    /// A signal stays at its largest or smallest value.
    #[error(
        "the {signal} stays at its {end} value in {}: it is clipped, and loss and harmonics are those of the clipped signal",
        plural(.cycles, "cycle", "cycles")
    )]
    Clipped {
        signal: String,
        end: String,
        cycles: usize,
    },
    /// A signal in steps, which cycles do not average out: its step in SI units.
    #[error(
        "the {signal} is read in steps of {step:.2e} (SI), its noise is smaller, and samples fall on the same phases in every cycle: more \
         cycles do not take the rounding out; it is in the intervals"
    )]
    Quantised { signal: String, step: f64 },
    /// Not all harmonics are resolved.
    #[error("{points:.1} samples a cycle resolve {}", resolved(*.harmonics))]
    FewPoints { points: f64, harmonics: usize },
    /// Cycles too few to tell a trend.
    #[error("{} too few to tell whether the loop still changes", plural(.cycles, "cycle is", "cycles are"))]
    FewCycles { cycles: usize },
    /// Single samples far from the rest.
    #[error(
        "{} of the {signal}, the first at {first_s:.6} s, lie far from the rest and are left out",
        plural(.samples, "sample", "samples")
    )]
    Spikes {
        signal: String,
        samples: usize,
        first_s: f64,
    },
    /// A line in what is left of a signal.
    #[error(
        "beside the oscillation the {signal} has a line at {hz:.5} Hz with an amplitude of {amplitude:.2e} (SI){}",
        folded(*.folded_harmonic)
    )]
    Line {
        signal: String,
        hz: f64,
        amplitude: f64,
        /// The harmonic that the sampling folds to this frequency, where there is one.
        folded_harmonic: Option<usize>,
    },
    /// The given frequency is not that of the record.
    #[error(
        "the record oscillates at {found_hz:.7} Hz and not at the {given_hz} Hz that were given"
    )]
    OtherFrequency { given_hz: f64, found_hz: f64 },
    /// Cycles that miss samples.
    #[error("{} samples and count in no mean", missing(.cycles))]
    Incomplete { cycles: Vec<usize> },
    /// Cycles that stand apart: the quantity, and by how much, relative to the median.
    #[error("{} apart from the other cycles and count in no mean", standing(.cycles))]
    Outliers { cycles: Vec<Outlier> },
    /// A quantity changes up to the end: relative change over the cycles judged.
    #[error(
        "the {quantity} still changes by {:.2} % over the last cycles: there is no stabilised cycle to take a mean of",
        100.0 * .change
    )]
    NotStabilised { quantity: String, change: f64 },
    /// The approach runs ahead of the load.
    #[error(
        "the approach runs ahead of the load, so that the loop gives energy; look for the sign of a column, or a lag between the \
         channels (`time_lag` of the setup)"
    )]
    Leads,
    /// What the instrument adds is larger than the contact.
    #[error(
        "mass, damping and stiffness of the instrument take {ratio:.1} times the load that is left for the contact: errors of theirs \
         count as much more"
    )]
    CorrectionDominates { ratio: f64 },
    /// The load becomes a pull in part of the cycle.
    #[error("the load becomes a pull in a part of the cycle: the contact may open or stick")]
    Pull,
    /// No contact radius.
    #[error("there is no contact radius, and no modulus: {reason}")]
    NoRadius { reason: String },
    /// The bias of the formula is not known.
    #[error("the bias of the small-amplitude formula is not computed: {reason}")]
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
            Self::DescendingTimes => "descending-times",
            Self::MissingSamples { .. } => "missing-samples",
            Self::Jitter { .. } => "jitter",
            Self::NotUniform { .. } => "not-uniform",
            Self::Clipped { .. } => "clipped",
            Self::Quantised { .. } => "quantised",
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

/// Cycles of which no more are named.
const NAMED: usize = 8;

fn plural(count: &usize, one: &str, many: &str) -> String {
    format!("{count} {}", if *count == 1 { one } else { many })
}

fn resolved(harmonics: usize) -> String {
    match harmonics {
        1 => "no harmonic beyond the first; what is there is folded into it".to_owned(),
        n => format!("harmonics up to {n} alone"),
    }
}

fn folded(harmonic: Option<usize>) -> String {
    match harmonic {
        Some(n) => format!(": harmonic {n} is there by aliasing; sample faster"),
        None => ", which is no harmonic".to_owned(),
    }
}

/// `cycle 3 misses`, `cycles 3, 5, 7 miss`; of many the first ones.
fn missing(cycles: &[usize]) -> String {
    let named: Vec<String> = cycles.iter().take(NAMED).map(usize::to_string).collect();
    let rest = match cycles.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let (s, es) = if cycles.len() == 1 {
        ("", "es")
    } else {
        ("s", "")
    };
    format!("cycle{s} {}{rest} miss{es}", named.join(", "))
}

/// `cycle 3 (energy loss +4.00 %) stands`; of many the first ones.
fn standing(cycles: &[Outlier]) -> String {
    let one = |outlier: &Outlier| {
        let percent = 100.0 * outlier.relative;
        format!(
            "cycle {} ({} {percent:+.2} %)",
            outlier.cycle, outlier.quantity
        )
    };
    let named: Vec<String> = cycles.iter().take(NAMED).map(one).collect();
    let verb = if cycles.len() == 1 { "stands" } else { "stand" };
    format!("{} {verb}", named.join(", "))
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
