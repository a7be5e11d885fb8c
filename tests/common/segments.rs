//! The records of a folder as the tests read, damage and replace them.

#![allow(dead_code)] // Each test file uses its own part.

use std::fs;
use std::path::{Path, PathBuf};

use contact_dma::sweep::store::log::{self, Met};
use serde::{Deserialize, Serialize};

/// One record: what its heading says, and the rest.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Stored {
    pub heading: Heading,
    pub record: Vec<u8>,
}

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Heading {
    pub program_version: String,
    pub build: String,
    pub sweep_hash: String,
    /// 0 for a case of the sweep, 1 for one between them.
    pub purpose: u32,
    /// Mean, amplitude, frequency.
    pub bits: Vec<u64>,
}

impl Stored {
    pub fn is_of_sweep(&self) -> bool {
        self.heading.purpose == 0
    }

    fn content(&self) -> Vec<u8> {
        let mut content = postcard::to_stdvec(&self.heading).unwrap();
        content.extend_from_slice(&self.record);
        content
    }
}

fn paths(out: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(out.join("records"));
    let entries = entries.into_iter().flatten();
    let paths = entries.map(|entry| entry.unwrap().path());
    let is_log = |path: &PathBuf| path.extension().is_some_and(|ending| ending == log::ENDING);
    let mut paths: Vec<_> = paths.filter(is_log).collect();
    paths.sort();
    paths
}

/// All whole records of a folder, cases of the sweep first, in ascending frequency.
pub fn read(out: &Path) -> Vec<Stored> {
    let mut all = Vec::new();
    for path in paths(out) {
        let meet = |met: Met<'_>| {
            if let Met::Record { content, .. } = met {
                let (heading, record) = postcard::take_from_bytes(content).unwrap();
                let record = record.to_vec();
                all.push(Stored { heading, record });
            }
        };
        log::read(&path, 0, meet).unwrap();
    }
    // Positive numbers are in the order of their bits.
    let place = |stored: &Stored| {
        let heading = &stored.heading;
        let bits = heading.bits.iter().rev().copied().collect::<Vec<_>>();
        (heading.purpose, bits)
    };
    all.sort_by_key(place);
    all
}

/// Replaces all records of a folder by these, in one segment; where each of them begins and ends in it.
pub fn replace(out: &Path, records: &[Stored]) -> Vec<(usize, usize)> {
    for path in paths(out) {
        fs::remove_file(path).unwrap();
    }
    let (mut bytes, mut places) = (Vec::new(), Vec::new());
    for stored in records {
        let from = bytes.len();
        bytes.extend(log::framed(&stored.content()).unwrap());
        places.push((from, bytes.len()));
    }
    fs::create_dir_all(out.join("records")).unwrap();
    fs::write(one(out), bytes).unwrap();
    places
}

/// The segment that [`replace`] writes.
pub fn one(out: &Path) -> PathBuf {
    out.join("records/one.segment")
}

/// How many cases of the sweep have records.
pub fn count(out: &Path) -> usize {
    let records = read(out);
    records.iter().filter(|stored| stored.is_of_sweep()).count()
}
