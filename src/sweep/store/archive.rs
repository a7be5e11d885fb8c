//! Records of finished cases: on disk, sealed, and read again where they are whole and of the same sweep and program; or in memory.

use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};

use crate::sweep::plan::Case;
use crate::sweep::record::CaseRecord;
use crate::sweep::store::provenance::BUILD;
use crate::sweep::store::sealed;
use crate::sweep::store::{Store, StoreError};

/// Where the records of a sweep's cases are kept.
#[derive(Debug, Clone, Copy)]
pub enum Archive<'a> {
    Folder(&'a Store),
    Memory(&'a MemoryArchive),
}

/// The records of one sweep, in memory alone.
#[derive(Debug, Default)]
pub struct MemoryArchive {
    /// By purpose and the bits of mean, amplitude, frequency and varied number.
    records: Mutex<HashMap<(Purpose, Vec<u64>), CaseRecord>>,
}

impl<'a> From<&'a Store> for Archive<'a> {
    fn from(store: &'a Store) -> Self {
        Self::Folder(store)
    }
}

impl<'a> From<&'a MemoryArchive> for Archive<'a> {
    fn from(memory: &'a MemoryArchive) -> Self {
        Self::Memory(memory)
    }
}

impl<'a> Archive<'a> {
    /// The folder, of an archive that has one.
    pub fn store(self) -> Option<&'a Store> {
        match self {
            Self::Folder(store) => Some(store),
            Self::Memory(_) => None,
        }
    }

    /// As [`Store::save_case`].
    ///
    /// # Errors
    /// [`StoreError`] with the path, of a folder.
    pub fn save_case(
        self,
        purpose: Purpose,
        case: &Case,
        record: &CaseRecord,
    ) -> Result<(), StoreError> {
        match self {
            Self::Folder(store) => return store.save_case(purpose, case, record),
            Self::Memory(memory) => {
                memory
                    .records()
                    .insert((purpose, bits(case)), record.clone());
            }
        }
        Ok(())
    }

    /// As [`Store::load_case`].
    ///
    /// # Errors
    /// [`StoreError`] with the path, of a folder.
    pub fn load_case(self, purpose: Purpose, case: &Case) -> Result<Kept, StoreError> {
        match self {
            Self::Folder(store) => store.load_case(purpose, case),
            Self::Memory(memory) => Ok(match memory.records().get(&(purpose, bits(case))) {
                Some(record) => Kept::Intact(Box::new(CaseRecord {
                    index: case.index,
                    ..record.clone()
                })),
                None => Kept::Absent,
            }),
        }
    }
}

impl MemoryArchive {
    fn records(&self) -> MutexGuard<'_, HashMap<(Purpose, Vec<u64>), CaseRecord>> {
        // A record is in it whole or not at all, whatever became of the thread that put it there.
        self.records.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Mean, amplitude and frequency of a case, and the varied number where there is one, bit for bit.
fn bits(case: &Case) -> Vec<u64> {
    let (drive, omega) = (&case.condition.drive, case.angular_frequency_rad_per_s);
    let numbers = [drive.mean(), drive.amplitude(), omega].into_iter();
    let numbers = numbers.chain(case.condition.value);
    numbers.map(f64::to_bits).collect()
}

/// What a case was solved for, which decides where its record lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Purpose {
    /// A case of the sweep: `records/<index>.json`.
    Sweep,
    /// A frequency between those of the sweep, to locate a peak: `peaks/<bits of mean, amplitude, frequency, varied number>.json`.
    Peak,
}

/// What the folder holds of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum Kept {
    Intact(Box<CaseRecord>),
    Absent,
    /// There is a record of this version of the program, but of another build, whose numbers may be others.
    OfAnotherBuild {
        path: PathBuf,
        record: Box<CaseRecord>,
    },
    /// There is a record, but it cannot be used.
    Unusable {
        path: PathBuf,
        reason: String,
    },
}

/// A record as stored, with what it takes to know that it belongs to the sweep.
#[derive(Serialize)]
struct Stored<'a> {
    program_version: &'a str,
    build: &'a str,
    sweep_hash: &'a str,
    case: &'a CaseRecord,
}

/// The part that every version of the program writes and reads.
#[derive(Deserialize)]
struct Heading {
    program_version: String,
    /// None in records of programs that did not know theirs.
    build: Option<String>,
    sweep_hash: String,
}

#[derive(Deserialize)]
struct Content {
    case: CaseRecord,
}

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What is said of a record of another build.
pub const OF_ANOTHER_BUILD: &str = concat!(
    "it was written by another build of version ",
    env!("CARGO_PKG_VERSION"),
    " of the program"
);

/// The name of a case in the folder, without its ending: the same in every process that solves it.
pub(in crate::sweep) fn case_name(purpose: Purpose, case: &Case) -> String {
    match purpose {
        Purpose::Sweep => format!("{:04}", case.index),
        Purpose::Peak => {
            let numbers = bits(case).into_iter();
            let names: Vec<String> = numbers.map(|bits| format!("{bits:016x}")).collect();
            names.join("-")
        }
    }
}

fn file_name(purpose: Purpose, case: &Case) -> PathBuf {
    let folder = match purpose {
        Purpose::Sweep => "records",
        Purpose::Peak => "peaks",
    };
    PathBuf::from(folder).join(case_name(purpose, case) + ".json")
}

impl Store {
    /// Stores the record of a finished case.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub fn save_case(
        &self,
        purpose: Purpose,
        case: &Case,
        record: &CaseRecord,
    ) -> Result<(), StoreError> {
        let name = file_name(purpose, case);
        let stored = Stored {
            program_version: VERSION,
            build: BUILD,
            sweep_hash: self.sweep_hash(),
            case: record,
        };
        let content = serde_json::to_vec(&stored).map_err(|error| StoreError::Encode {
            path: self.folder().join(&name),
            reason: error.to_string(),
        })?;
        self.write(name, &sealed::seal(&content))
    }

    /// The record of a case, where there is a usable one.
    ///
    /// # Errors
    /// [`StoreError`] where the record cannot be read, or was written by a newer program and may not be replaced.
    pub fn load_case(&self, purpose: Purpose, case: &Case) -> Result<Kept, StoreError> {
        let path = self.folder().join(file_name(purpose, case));
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Kept::Absent),
            Err(source) => return Err(StoreError::Read { path, source }),
        };
        match self.usable(case, &bytes) {
            Ok((record, true)) => Ok(Kept::Intact(Box::new(record))),
            Ok((record, false)) => Ok(Kept::OfAnotherBuild {
                path,
                record: Box::new(record),
            }),
            Err(Unusable::Newer(version)) if !self.force => {
                Err(StoreError::NewerProgram { path, version })
            }
            Err(why) => Ok(Kept::Unusable {
                path,
                reason: why.to_string(),
            }),
        }
    }

    /// The record, and whether it is one of this build.
    fn usable(&self, case: &Case, bytes: &[u8]) -> Result<(CaseRecord, bool), Unusable> {
        let content = sealed::unseal(bytes).ok_or(Unusable::Damaged)?;
        let heading: Heading = serde_json::from_slice(content).map_err(|_| Unusable::Damaged)?;
        if heading.program_version != VERSION {
            let other = heading.program_version;
            return Err(match numbers(&other) > numbers(VERSION) {
                true => Unusable::Newer(other),
                false => Unusable::Older(other),
            });
        }
        if heading.sweep_hash != self.sweep_hash() {
            return Err(Unusable::Foreign);
        }
        let Content { case: record } =
            serde_json::from_slice(content).map_err(|_| Unusable::Damaged)?;
        let same_frequency = record.angular_frequency_rad_per_s.to_bits()
            == case.angular_frequency_rad_per_s.to_bits();
        if !same_frequency || !record.is_of(&case.condition) {
            return Err(Unusable::Foreign);
        }
        let record = CaseRecord {
            index: case.index,
            ..record
        };
        Ok((record, heading.build.as_deref() == Some(BUILD)))
    }
}

/// Why a record is not used.
#[derive(Debug, thiserror::Error)]
enum Unusable {
    #[error("it is damaged or torn (its checksum does not match)")]
    Damaged,
    #[error("it belongs to another sweep")]
    Foreign,
    #[error("it was written by version {0} of the program, older than this one")]
    Older(String),
    #[error("it was written by version {0} of the program, newer than this one")]
    Newer(String),
}

/// The numbers of a version; what is no number counts as 0.
fn numbers(version: &str) -> Vec<u64> {
    let release = version.split(['-', '+']).next().unwrap_or_default();
    release
        .split('.')
        .map(|part| part.parse().unwrap_or(0))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::plan::Method;
    use crate::sweep::record::Status;

    fn case() -> Case {
        Case {
            index: 7,
            angular_frequency_rad_per_s: 0.1 + 0.2,
            condition: crate::sweep::plan::tests::condition(),
        }
    }

    fn record(case: &Case) -> CaseRecord {
        CaseRecord {
            index: case.index,
            angular_frequency_rad_per_s: case.angular_frequency_rad_per_s,
            varied: case.condition.value,
            drive_mean: case.condition.drive.mean(),
            drive_amplitude: case.condition.drive.amplitude(),
            status: Status::NotConverged,
            message: Some("reached \"nothing\"".to_owned()),
            warnings: vec![
                crate::sweep::record::warning::Warning::LargeStrain { strain: 0.1 + 0.2 },
                crate::sweep::record::warning::Warning::NoErrorBars {
                    because: crate::sweep::record::warning::NoErrorBars::OwnCells,
                },
            ],
            method: Method::March,
            steps: 200,
            nodes: 400,
            cycles: 1000,
            steady_distance: Some(1.0 / 3.0),
            domain_half_width_m: 1e-3,
            domain_enlarged: 0,
            work: crate::history::Work {
                instants: 1_234,
                iterations: 12_345,
                convolutions: 0,
            },
            result: None,
        }
    }

    fn store(folder: &tempfile::TempDir) -> Store {
        let text = "title = \"a\"\n";
        Store::open(folder.path(), text, false).unwrap()
    }

    #[test]
    fn a_record_comes_back_bit_for_bit_and_only_for_its_own_case() {
        let folder = tempfile::TempDir::new().unwrap();
        let (store, case) = (store(&folder), case());
        for purpose in [Purpose::Sweep, Purpose::Peak] {
            assert_eq!(store.load_case(purpose, &case).unwrap(), Kept::Absent);
            store.save_case(purpose, &case, &record(&case)).unwrap();
            let kept = store.load_case(purpose, &case).unwrap();
            assert_eq!(kept, Kept::Intact(Box::new(record(&case))));
        }
        let other = Case {
            angular_frequency_rad_per_s: 0.3,
            ..case
        };
        let kept = store.load_case(Purpose::Sweep, &other).unwrap();
        assert!(matches!(kept, Kept::Unusable { reason, .. } if reason.contains("another sweep")));
    }

    #[test]
    fn every_flipped_byte_of_a_record_is_detected() {
        let folder = tempfile::TempDir::new().unwrap();
        let (store, case) = (store(&folder), case());
        store
            .save_case(Purpose::Sweep, &case, &record(&case))
            .unwrap();
        let path = folder.path().join("records/0007.json");
        let whole = fs::read(&path).unwrap();
        for byte in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[byte] ^= 0x20;
            fs::write(&path, damaged).unwrap();
            let kept = store.load_case(Purpose::Sweep, &case).unwrap();
            assert!(
                matches!(&kept, Kept::Unusable { reason, .. } if reason.contains("damaged")),
                "byte {byte}: {kept:?}"
            );
        }
    }

    #[test]
    fn records_of_other_versions_are_not_used() {
        let folder = tempfile::TempDir::new().unwrap();
        let (store, case) = (store(&folder), case());
        let write_of = |version: &str, build: &str| {
            let stored = Stored {
                program_version: version,
                build,
                sweep_hash: store.sweep_hash(),
                case: &record(&case),
            };
            let content = serde_json::to_vec(&stored).unwrap();
            store
                .write("records/0007.json", &sealed::seal(&content))
                .unwrap();
        };
        let write = |version: &str| write_of(version, BUILD);
        write_of(VERSION, "0123");
        let kept = store.load_case(Purpose::Sweep, &case).unwrap();
        assert!(
            matches!(kept, Kept::OfAnotherBuild { record: found, .. } if *found == record(&case))
        );
        write("0.0.1");
        let kept = store.load_case(Purpose::Sweep, &case).unwrap();
        assert!(matches!(kept, Kept::Unusable { reason, .. } if reason.contains("older")));
        write("1000.0.0");
        let refused = store.load_case(Purpose::Sweep, &case);
        assert!(matches!(refused, Err(StoreError::NewerProgram { .. })));
        let forced = Store {
            force: true,
            ..store.clone()
        };
        let kept = forced.load_case(Purpose::Sweep, &case).unwrap();
        assert!(matches!(kept, Kept::Unusable { .. }));
    }
}
