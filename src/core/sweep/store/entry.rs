//! One record as it stands in a log: a heading, which names the program, the build, the plan and the case that it belongs to, then the
//! numbers of the case, then its cycle, which is read only where it is asked for.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use super::VERSION;
use super::provenance::BUILD;
use crate::sweep::plan::{AxisValues, Case};
use crate::sweep::record::{CaseRecord, RecordedCycle};

/// What a case was solved for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Purpose {
    /// A case of the sweep.
    Sweep,
    /// The loss at a frequency between those of the sweep, to locate a peak.
    Peak,
}

/// Which case a record is of: what it was solved for, and its numbers bit for bit.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Key {
    purpose: Purpose,
    /// Mean, amplitude, frequency, and what else varies.
    bits: Vec<u64>,
}

impl Key {
    pub(crate) fn of(purpose: Purpose, case: &Case) -> Self {
        let (drive, omega) = (&case.condition.drive, case.angular_frequency_rad_per_s);
        let drive = [drive.mean(), drive.amplitude()];
        Self::new(purpose, drive, omega, case.condition.values)
    }

    /// The case of the sweep whose record this is.
    pub(super) fn of_record(record: &CaseRecord) -> Self {
        let drive = [record.drive_mean, record.drive_amplitude];
        let omega = record.angular_frequency_rad_per_s;
        Self::new(Purpose::Sweep, drive, omega, record.varied)
    }

    /// The name of a case in the folder: the same in every process that solves it.
    pub(crate) fn name(purpose: Purpose, case: &Case) -> String {
        match purpose {
            Purpose::Sweep => format!("{:04}", case.index),
            Purpose::Peak => {
                let bits = Self::of(purpose, case).bits.into_iter();
                let names: Vec<String> = bits.map(|bits| format!("{bits:016x}")).collect();
                names.join("-")
            }
        }
    }

    fn new(purpose: Purpose, drive: [f64; 2], omega: f64, varied: AxisValues) -> Self {
        let numbers = drive.into_iter().chain([omega]);
        let numbers = numbers.chain(varied.all().iter().map(|value| value.as_number()));
        Self {
            purpose,
            bits: numbers.map(f64::to_bits).collect(),
        }
    }
}

/// How the content of a record begins, in every version of the program.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Heading<'a> {
    pub program_version: &'a str,
    pub build: &'a str,
    pub sweep_hash: &'a str,
    pub key: Key,
}

/// Whose record it is.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Origin {
    ThisBuild,
    AnotherBuild,
    Older(String),
    Newer(String),
}

impl Origin {
    pub fn of(version: &str, build: &str) -> Self {
        match numbers_of(version).cmp(&numbers_of(VERSION)) {
            Ordering::Less => Self::Older(version.to_owned()),
            Ordering::Greater => Self::Newer(version.to_owned()),
            Ordering::Equal if build == BUILD => Self::ThisBuild,
            Ordering::Equal => Self::AnotherBuild,
        }
    }
}

/// The numbers of a version; what is no number counts as 0.
fn numbers_of(version: &str) -> Vec<u64> {
    let release = version.split(['-', '+']).next().unwrap_or_default();
    let parts = release.split('.');
    parts.map(|part| part.parse().unwrap_or(0)).collect()
}

/// A record as it is stored behind its heading: its numbers, then its cycle, where it has one and that is to be kept.
///
/// # Errors
/// Why it cannot be encoded.
pub fn encoded(record: &CaseRecord, with_cycle: bool) -> Result<Vec<u8>, String> {
    let result = record.result.as_ref().filter(|_| with_cycle);
    let cycle = result.and_then(|result| result.cycle());
    let encoded = postcard::to_stdvec(&(record.without_cycle(), cycle));
    encoded.map_err(|error| error.to_string())
}

/// The numbers of an [`encoded`] record, and its cycle as it is encoded; `None` of anything else.
pub fn numbers(encoded: &[u8]) -> Option<(CaseRecord, &[u8])> {
    postcard::take_from_bytes(encoded).ok()
}

/// Gives a record its cycle, where what [`numbers`] has left holds one.
pub(super) fn add_cycle(record: &mut CaseRecord, cycle: &[u8]) {
    let cycle = postcard::from_bytes::<Option<RecordedCycle>>(cycle);
    if let (Some(result), Ok(Some(cycle))) = (&mut record.result, cycle) {
        result.cycle = cycle;
    }
}
