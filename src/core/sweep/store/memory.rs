//! The records of a sweep that is in no folder; they can be moved to another process, and into a folder.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::sweep::record::CaseRecord;
use crate::sweep::store::packed_record;
use crate::sweep::store::records::{Key, Origin};
use crate::sweep::store::{Store, StoreError};

/// The records of one sweep, in memory alone.
#[derive(Debug, Default)]
pub struct MemoryArchive {
    records: Mutex<HashMap<Key, CaseRecord>>,
}

impl MemoryArchive {
    /// Every record with its cycle, for another process of the same build.
    ///
    /// # Errors
    /// Why a record cannot be encoded.
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        let records = self.records();
        let packed = (records.iter())
            .map(|(key, record)| Ok((key, packed_record::pack(record)?)))
            .collect::<Result<Vec<_>, String>>()?;
        postcard::to_stdvec(&packed).map_err(|error| error.to_string())
    }

    /// The records of [`Self::to_bytes`]; `None` of anything else.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let packed: Vec<(Key, Vec<u8>)> = postcard::from_bytes(bytes).ok()?;
        let record = |(key, packed): (Key, Vec<u8>)| {
            let mut record = packed_record::numbers(&packed)?;
            packed_record::add_cycle(&mut record, &packed);
            Some((key, record))
        };
        let records: HashMap<_, _> = packed.into_iter().map(record).collect::<Option<_>>()?;
        Some(Self {
            records: Mutex::new(records),
        })
    }

    /// Puts every record into the folder of the same sweep, but those of cases that have one there.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub fn put_into(&self, store: &Store) -> Result<(), StoreError> {
        store.check_plan()?;
        store.records.look()?;
        let records = self.records();
        let mut all: Vec<_> = records.iter().collect();
        all.sort_by_key(|(key, record)| (key.purpose, record.index, *key));
        for (key, record) in all {
            let place = store.records.place(key)?;
            if place.is_none_or(|place| place.origin != Origin::ThisBuild) {
                store.append(key.clone(), record)?;
            }
        }
        store.sync()
    }

    /// Every record by its case.
    pub(super) fn records(&self) -> MutexGuard<'_, HashMap<Key, CaseRecord>> {
        // A record is in it whole or not at all, whatever became of the thread that put it there.
        self.records.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::Sweep;
    use crate::sweep::case::Setup;
    use crate::sweep::plan::{self, resolved::resolved_text};
    use crate::sweep::search::run;

    /// A sweep with a peak, and its records.
    fn solved() -> (Setup, MemoryArchive) {
        let condition = plan::tests::condition();
        let material = condition.material.as_ref().clone();
        let sphere = crate::indenter::Sphere::new(0.01).unwrap();
        let sweep = Sweep::new(material, sphere, condition.drive).title("a");
        let sweep = sweep.steps(16).unwrap().springs(16).unwrap();
        let sweep = sweep.frequencies_hz([1e-4, 1e-3, 1e-2]).unwrap();
        let setup = Setup::new(sweep.into_plan()).unwrap();
        let archive = MemoryArchive::default();
        run::run(&setup, &archive, 1, &false.into(), &()).unwrap();
        (setup, archive)
    }

    #[test]
    fn records_that_were_moved_give_the_same_outcome_with_its_cycles_and_peaks() {
        let (setup, archive) = solved();
        let outcome = run::collect(&setup, &archive, &()).unwrap();
        assert!(outcome.records.iter().all(|r| r.result.is_some()));
        let moved = MemoryArchive::from_bytes(&archive.to_bytes().unwrap()).unwrap();
        assert_eq!(run::collect(&setup, &moved, &()).unwrap(), outcome);

        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), &resolved_text(setup.plan()), false).unwrap();
        // The second time there is nothing left to do.
        for _ in 0..2 {
            archive.put_into(&store).unwrap();
            assert_eq!(run::collect(&setup, &store, &()).unwrap(), outcome);
        }
        let records = folder.path().join("records");
        let length =
            |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().metadata().unwrap().len();
        let once: u64 = std::fs::read_dir(&records).unwrap().map(length).sum();
        archive.put_into(&store).unwrap();
        assert_eq!(
            std::fs::read_dir(&records)
                .unwrap()
                .map(length)
                .sum::<u64>(),
            once
        );
    }

    #[test]
    fn bytes_of_anything_else_are_no_records() {
        let (_, archive) = solved();
        let bytes = archive.to_bytes().unwrap();
        assert!(MemoryArchive::from_bytes(&bytes[..bytes.len() - 1]).is_none());
        assert!(MemoryArchive::from_bytes(b"records").is_none());
    }
}
