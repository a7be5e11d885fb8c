//! Warnings of a whole sweep: each kind once, with the cases that it is of.

use std::fmt;

use serde::Serialize;

use crate::quantity::{FrequencyUnit, format_prose};
use crate::sweep::record::CaseRecord;
use crate::sweep::record::warning::Warning;

/// A kind of warning over the cases of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OverCases {
    pub code: &'static str,
    /// What is to be said, of the case it is truest of.
    pub message: String,
    /// Cases it is to be said of, and the range of their frequencies.
    pub cases: usize,
    pub lowest_angular_frequency_rad_per_s: f64,
    pub highest_angular_frequency_rad_per_s: f64,
    #[serde(skip)]
    of: usize,
    #[serde(skip)]
    unit: FrequencyUnit,
    /// Whether the materials of the cases were measured at different times.
    #[serde(skip)]
    has_other_limits: bool,
}

/// What is to be said of these cases, with frequencies in this unit: one entry per kind, in the order in which kinds first occur.
pub fn over_cases(records: &[CaseRecord], unit: FrequencyUnit) -> Vec<OverCases> {
    let mut kinds: Vec<(Warning, OverCases)> = Vec::new();
    for record in records {
        let omega = record.angular_frequency_rad_per_s;
        for warning in &record.warnings {
            let known = (kinds.iter_mut()).find(|(_, over)| over.code == warning.code());
            match known {
                Some((worst, over)) => {
                    over.has_other_limits |= warning.measured_s() != worst.measured_s();
                    if warning.extent() > worst.extent() {
                        *worst = *warning;
                    }
                    over.cases += 1;
                    let (low, high) = (
                        &mut over.lowest_angular_frequency_rad_per_s,
                        &mut over.highest_angular_frequency_rad_per_s,
                    );
                    (*low, *high) = (low.min(omega), high.max(omega));
                }
                None => kinds.push((
                    *warning,
                    OverCases {
                        code: warning.code(),
                        message: String::new(),
                        cases: 1,
                        lowest_angular_frequency_rad_per_s: omega,
                        highest_angular_frequency_rad_per_s: omega,
                        of: records.len(),
                        unit,
                        has_other_limits: false,
                    },
                )),
            }
        }
    }
    let said = |(worst, over): (Warning, OverCases)| {
        let others = match over.has_other_limits {
            true => " in the case that is furthest outside",
            false => "",
        };
        OverCases {
            message: worst.message(unit) + others,
            ..over
        }
    };
    kinds.into_iter().map(said).collect()
}

/// One line: the message, and of which cases.
impl fmt::Display for OverCases {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = (
            self.lowest_angular_frequency_rad_per_s,
            self.highest_angular_frequency_rad_per_s,
        );
        let symbol = self.unit.symbol();
        let value = |omega| format_prose(self.unit.of(omega), self.unit.dimension(), 4);
        f.write_str(&self.message)?;
        let cases = match (self.cases == self.of, low == high) {
            (true, true) => return Ok(()),
            (true, false) => return f.write_str(" (all cases)"),
            (false, true) => value(low),
            (false, false) => format!("{} to {}", value(low), value(high)),
        };
        write!(
            f,
            " ({} of {} cases, {symbol} = {cases})",
            self.cases, self.of
        )
    }
}
