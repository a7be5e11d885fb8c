//! Where a result comes from, as far as the files beside its table say.

use std::path::Path;

use serde::Deserialize;

use super::{ComparisonError, SweepTable};
use crate::input::diagnostic::Diagnostics;
use crate::input::loop_file;
use crate::report::measured::Computed;
use crate::report::number::range;
use crate::sweep::store::RESOLVED;
use crate::sweep::store::files::{Found, OfCase, Place};

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

/// A result and where it comes from.
#[derive(Debug, Clone)]
pub struct Opened {
    pub table: SweepTable,
    pub source: Source,
}

impl Opened {
    /// The result in a folder, with its peaks, or in a single table, without; to be compared with another. `read` reads a file.
    ///
    /// # Errors
    /// What `read` says, and [`ComparisonError`] where the table is none.
    pub fn read<E: From<ComparisonError>>(
        path: &Path,
        other: Option<&SweepTable>,
        read: impl Fn(&Path) -> Result<Vec<u8>, E>,
    ) -> Result<Self, E> {
        let name = path.display().to_string();
        if !path.is_dir() {
            return Ok(Self {
                table: SweepTable::parse_beside(other, &name, &read(path)?, None)?,
                source: Source {
                    name,
                    ..Source::default()
                },
            });
        }
        let beside = |file: &str| {
            let file = path.join(file);
            file.exists().then(|| read(&file)).transpose()
        };
        let csv = path.join("sweep.csv");
        let (bytes, summary) = (read(&csv)?, beside("summary.json")?);
        let csv = csv.display().to_string();
        let table = SweepTable::parse_beside(other, &csv, &bytes, summary.as_deref())?;
        let run = beside("run.json")?;
        let resolved = beside(RESOLVED)?;
        let source = Source {
            name,
            run: RunFacts::read([run, summary].iter().flatten().map(Vec::as_slice)),
            resolved: resolved.map(|bytes| String::from_utf8_lossy(&bytes).into_owned()),
        };
        Ok(Self { table, source })
    }
}

/// The cases of a computed sweep with their cycles, beside which measured ones are drawn. `read` reads a file.
///
/// # Errors
/// What `read` says, [`ComparisonError`] where the table is none, and what is wrong with the file of a cycle.
pub fn computed<E: From<ComparisonError> + From<Diagnostics>>(
    folder: &Path,
    read: impl Fn(&Path) -> Result<Vec<u8>, E>,
) -> Result<Vec<Computed>, E> {
    let table = folder.join("sweep.csv");
    let name = table.display().to_string();
    let rows = SweepTable::parse(&name, &read(&table)?, None)?.numbers_under([
        "angular_frequency_rad_per_s",
        "index",
        "energy_loss_j",
        "storage_modulus_pa",
        "loss_modulus_pa",
    ])?;
    let files = Found::of(folder);
    let cases = rows
        .into_iter()
        .filter_map(|[angular, index, loss, storage, of_loss]| {
            let (angular_rad_per_s, index) = angular.zip(index)?;
            let name = format!("{}.csv", index as u64);
            let cycle = cycle(&files.path(Place::Case(OfCase::Loops, &name)));
            Some(cycle.map(|cycle| Computed {
                angular_rad_per_s,
                energy_loss_j: loss,
                storage_modulus_pa: storage,
                loss_modulus_pa: of_loss,
                cycle,
            }))
        });
    Ok(cases.collect::<Result<_, Diagnostics>>()?)
}

/// Loads (N) and approaches (m) of a computed cycle; none where the sweep did not write it.
fn cycle(file: &Path) -> Result<Vec<(f64, f64)>, Diagnostics> {
    if !file.exists() {
        return Ok(Vec::new());
    }
    let signal = loop_file::read(file)?;
    Ok(signal.load_n.into_iter().zip(signal.approach_m).collect())
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
