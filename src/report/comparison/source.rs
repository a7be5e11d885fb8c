//! Where a result comes from, as far as the files beside its table say.

use serde::Deserialize;

use super::SweepTable;
use crate::report::number::range;

/// The origin of one of two results.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Source {
    /// What the reader calls it: the path that was given.
    pub name: String,
    pub run: RunFacts,
    /// The sweep with every default.
    pub resolved: Option<String>,
}

/// What `run.json` and `summary.json` say alike of the program and the input; neither host nor times, which belong to no
/// comparison.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default)]
pub struct RunFacts {
    pub program_version: Option<String>,
    pub commit: Option<String>,
    pub sweep_hash: Option<String>,
    pub engine: Option<String>,
    pub cycle_tolerance: Option<f64>,
    pub solver_tolerance: Option<f64>,
}

impl RunFacts {
    /// From the bytes of these files, the first that has a fact deciding; what is no JSON says nothing.
    pub fn read<'a>(files: impl IntoIterator<Item = &'a [u8]>) -> Self {
        files.into_iter().fold(Self::default(), |known, bytes| {
            let next: Self = serde_json::from_slice(bytes).unwrap_or_default();
            Self {
                program_version: known.program_version.or(next.program_version),
                commit: known.commit.or(next.commit),
                sweep_hash: known.sweep_hash.or(next.sweep_hash),
                engine: known.engine.or(next.engine),
                cycle_tolerance: known.cycle_tolerance.or(next.cycle_tolerance),
                solver_tolerance: known.solver_tolerance.or(next.solver_tolerance),
            }
        })
    }
}

impl SweepTable {
    /// Steps per cycle, and nodes, of all cases: smallest and largest as written.
    pub fn resolution(&self, column: &str) -> Option<(f64, f64)> {
        let numbers = self.rows.iter();
        let numbers = numbers.filter_map(|row| self.number(row, column).ok()?);
        let (low, high) = range(numbers);
        (low <= high).then_some((low, high))
    }

    /// Cases.
    pub fn cases(&self) -> usize {
        self.rows.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_file_that_knows_decides_and_others_fill_in() {
        let run = br#"{"program_version":"2","commit":"abc","host":"h"}"#;
        let summary = br#"{"program_version":"1","sweep_hash":"d1"}"#;
        let facts = RunFacts::read([&run[..], &summary[..], b"no json"]);
        assert_eq!(facts.program_version.as_deref(), Some("2"));
        assert_eq!(facts.commit.as_deref(), Some("abc"));
        assert_eq!(facts.sweep_hash.as_deref(), Some("d1"));
        assert_eq!(facts.engine, None);
    }
}
