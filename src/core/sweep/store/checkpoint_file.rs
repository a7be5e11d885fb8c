//! The file of a checkpoint of any content, and when one is written.
//!
//! 32 bytes that say what it belongs to (a SHA-256), the content as postcard encodes it, and the SHA-256 of all that.

use std::cell::Cell;
use std::fs;
use std::io::{self, Read, Seek, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};

use crate::sweep::store::Store;
use crate::sweep::store::files::Place;
use crate::sweep::store::provenance::BUILD;

/// Default time between two writes.
pub const EVERY: Duration = Duration::from_secs(10);

/// What has run for less than this is sooner computed again than read.
const WORTH_KEEPING: Duration = Duration::from_secs(1);

/// One over the part of the time that writing takes at most, unless every moment is to be kept.
const SHARE: u32 = 20;

const HASH_BYTES: usize = 32;

/// Says when to write, by the time that has passed on a clock that never jumps.
pub(crate) struct Rhythm {
    every: Duration,
    began: Instant,
    written: Cell<Instant>,
    /// What the last write took.
    cost: Cell<Duration>,
}

impl Rhythm {
    /// Begins now.
    pub(crate) fn new(every: Duration) -> Self {
        let now = Instant::now();
        Self {
            every,
            began: now,
            written: Cell::new(now),
            cost: Cell::new(Duration::ZERO),
        }
    }

    /// Whether enough has been computed for its state to be worth keeping.
    pub(crate) fn is_wanted(&self) -> bool {
        self.began.elapsed() >= WORTH_KEEPING.min(self.every)
    }

    /// Whether it is time to write.
    pub(crate) fn is_due(&self) -> bool {
        let waited = self.written.get().elapsed();
        let cost = self.cost.get().saturating_mul(SHARE);
        waited >= self.every && (self.every.is_zero() || waited >= cost)
    }

    /// Takes the time of a write.
    pub(crate) fn written<T>(&self, write: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let ended = write();
        self.cost.set(begun.elapsed());
        self.written.set(Instant::now());
        ended
    }
}

/// The file of a checkpoint, and what it belongs to.
#[derive(Debug, Clone)]
pub(crate) struct CheckpointFile {
    store: Store,
    name: String,
    owner: Owner,
}

/// SHA-256 of what a checkpoint belongs to.
#[derive(Debug, Clone)]
struct Owner([u8; HASH_BYTES]);

/// Why a checkpoint is not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unusable {
    #[error("it is damaged or torn (its checksum does not match)")]
    Damaged,
    #[error("it belongs to something else, or was written by another build of the program")]
    Foreign,
}

impl CheckpointFile {
    /// The file of this name among the checkpoints of a folder. It belongs to this build of the program, to the sweep or scenario
    /// of the folder, and to what `owner` names in it.
    pub(crate) fn new(store: &Store, name: &str, owner: &str) -> Self {
        let owner = format!("{BUILD}\n{}\n{owner}", store.sweep_hash());
        Self {
            store: store.clone(),
            name: name.to_owned(),
            owner: Owner(Sha256::digest(owner).into()),
        }
    }

    fn place(&self) -> Place<'_> {
        Place::Checkpoint(&self.name)
    }

    pub(crate) fn path(&self) -> PathBuf {
        self.store.folder().join(self.place().to_string())
    }

    /// What it holds; `None` where there is none.
    pub(crate) fn read<T: DeserializeOwned>(&self) -> Result<Option<T>, Unusable> {
        match fs::read(self.path()) {
            Ok(bytes) => self.owner.decode(&bytes).map(Some),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            // What cannot be read is as good as torn.
            Err(_) => Err(Unusable::Damaged),
        }
    }

    /// Writes it. Where it cannot be written, more is computed again, and nothing else is lost; in a folder that another sweep has
    /// taken, nothing is left behind.
    pub(crate) fn write(&self, content: &impl Serialize) {
        let write = |file: &mut fs::File| self.owner.encode(content, file);
        let _ = (self.store.check_plan()).and_then(|()| self.store.write_with(self.place(), write));
    }

    /// Removes all checkpoints of the folder.
    pub(crate) fn remove_all(&self) {
        self.store.remove_checkpoints("");
    }
}

impl Owner {
    /// The content may fill much of the memory: it is written as it is encoded, and no copy of it is made.
    fn encode(
        &self,
        content: &impl Serialize,
        mut file: impl Read + Write + Seek,
    ) -> io::Result<()> {
        let mut buffered = io::BufWriter::new(&mut file);
        buffered.write_all(&self.0)?;
        postcard::to_io(content, &mut buffered).map_err(io::Error::other)?;
        buffered.flush()?;
        drop(buffered);
        file.rewind()?;
        let mut hash = Sha256::new();
        io::copy(&mut file, &mut hash)?;
        file.write_all(&hash.finalize())
    }

    fn decode<T: DeserializeOwned>(&self, bytes: &[u8]) -> Result<T, Unusable> {
        let (content, hash) = bytes
            .split_last_chunk::<HASH_BYTES>()
            .ok_or(Unusable::Damaged)?;
        if Sha256::digest(content).as_slice() != hash {
            return Err(Unusable::Damaged);
        }
        let content = content.strip_prefix(&self.0).ok_or(Unusable::Foreign)?;
        match postcard::take_from_bytes(content) {
            Ok((content, [])) => Ok(content),
            _ => Err(Unusable::Damaged),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Content = (Vec<f64>, Option<f64>);

    fn owner(byte: u8) -> Owner {
        Owner([byte; HASH_BYTES])
    }

    fn encoded(byte: u8, content: &impl Serialize) -> Vec<u8> {
        let mut bytes = io::Cursor::new(Vec::new());
        owner(byte).encode(content, &mut bytes).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn every_bit_comes_back_of_infinities_and_negative_zeros_too() {
        let content = (vec![1.0 / 3.0, -0.0, f64::INFINITY], None);
        let bytes = encoded(7, &content);
        let found: Content = owner(7).decode(&bytes).unwrap();
        assert_eq!(found.1, content.1);
        let bits = |(values, _): Content| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(found), bits(content));
    }

    #[test]
    fn a_damaged_or_foreign_checkpoint_is_known_for_what_it_is() {
        let content: Content = (vec![1.0, 2.0], Some(3.0));
        let bytes = encoded(7, &content);
        let decode = |byte, bytes: &[u8]| owner(byte).decode::<Content>(bytes);
        assert_eq!(decode(7, &bytes), Ok(content));
        assert_eq!(decode(8, &bytes), Err(Unusable::Foreign));
        for byte in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[byte] ^= 1;
            let found = [&damaged, &bytes[..byte]].map(|bytes| decode(7, bytes));
            assert_eq!(found, [(); 2].map(|()| Err(Unusable::Damaged)), "{byte}");
        }
    }

    #[test]
    fn lengths_that_lie_are_refused_without_taking_memory() {
        let lies = encoded(7, &u64::MAX);
        assert_eq!(owner(7).decode::<Content>(&lies), Err(Unusable::Damaged));
    }

    #[test]
    fn what_takes_long_to_write_is_written_less_often() {
        let rhythm = Rhythm::new(Duration::from_millis(1));
        std::thread::sleep(Duration::from_millis(2));
        assert!(rhythm.is_due() && rhythm.is_wanted());
        rhythm.written(|| ());
        rhythm.cost.set(Duration::from_secs(1000));
        std::thread::sleep(Duration::from_millis(2));
        assert!(!rhythm.is_due());
        assert!(Rhythm::new(Duration::ZERO).is_due());
        // No interval is too long to be waited for.
        let never = Rhythm::new(Duration::MAX);
        assert!(!never.is_due() && !never.is_wanted());
    }
}
