//! The form of a checkpoint on disk, and when one is written.
//!
//! Little endian: eight bytes of mark, 32 bytes that say what it belongs to (a SHA-256), the length of a JSON text and the
//! text, the number of arrays, of each its length and its f64s; at the end the SHA-256 of all that. Numbers that may be
//! infinite, which JSON cannot write, are in arrays.

use std::cell::Cell;
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};

use crate::contact::Solution;

/// Time between two writes, unless told otherwise.
pub const EVERY: Duration = Duration::from_secs(10);

/// The folder of all checkpoints.
pub(in crate::sweep) const FOLDER: &str = "checkpoints";

/// What has run for less than this is sooner computed again than read.
const WORTH_KEEPING: Duration = Duration::from_secs(1);

/// Writing takes at most one part in so many of the time, unless every moment is to be kept.
const SHARE: u32 = 20;

const MARK: &[u8; 8] = b"CDMACHK\x01";
const HASH_BYTES: usize = 32;

/// What a checkpoint belongs to.
pub(in crate::sweep) type Key = [u8; HASH_BYTES];

/// The key of what this text names.
pub(in crate::sweep) fn key(owner: &str) -> Key {
    Sha256::digest(owner).into()
}

/// Says when to write, by the time that has passed on a clock that never jumps.
pub(in crate::sweep) struct Rhythm {
    every: Duration,
    began: Instant,
    written: Cell<Instant>,
    /// What the last write took.
    cost: Cell<Duration>,
}

impl Rhythm {
    /// Begins now.
    pub(in crate::sweep) fn new(every: Duration) -> Self {
        let now = Instant::now();
        Self {
            every,
            began: now,
            written: Cell::new(now),
            cost: Cell::new(Duration::ZERO),
        }
    }

    /// Whether enough has been computed for its state to be worth keeping.
    pub(in crate::sweep) fn is_wanted(&self) -> bool {
        self.began.elapsed() >= WORTH_KEEPING.min(self.every)
    }

    /// Whether it is time to write.
    pub(in crate::sweep) fn is_due(&self) -> bool {
        let waited = self.written.get().elapsed();
        let cost = self.cost.get().saturating_mul(SHARE);
        waited >= self.every && (self.every.is_zero() || waited >= cost)
    }

    /// Takes the time of a write.
    pub(in crate::sweep) fn written<T>(&self, write: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let ended = write();
        self.cost.set(begun.elapsed());
        self.written.set(Instant::now());
        ended
    }
}

/// An instant's numbers but for its iterations; none where there was no instant.
pub(in crate::sweep) fn numbers(solution: Option<Solution>) -> Vec<f64> {
    solution.map_or(Vec::new(), |s| {
        let convolutions = s.convolutions as f64;
        vec![s.load_n, s.approach_m, s.contact_radius_m, convolutions]
    })
}

/// What [`numbers`] and the iterations were made from; `None` where they were made from nothing alike.
pub(in crate::sweep) fn from_numbers(
    numbers: &[f64],
    iterations: Option<usize>,
) -> Option<Option<Solution>> {
    match (numbers, iterations) {
        (&[load_n, approach_m, contact_radius_m, convolutions], Some(iterations)) => {
            Some(Some(Solution {
                load_n,
                approach_m,
                contact_radius_m,
                iterations,
                // Written from a whole number far below 2^53.
                convolutions: convolutions as usize,
            }))
        }
        ([], None) => Some(None),
        _ => None,
    }
}

pub(in crate::sweep) fn encode(key: &Key, text: &[u8], arrays: &[&[f64]]) -> Vec<u8> {
    let values: usize = arrays.iter().map(|array| array.len() + 1).sum();
    let mut bytes = Vec::with_capacity(2 * HASH_BYTES + 24 + text.len() + 8 * values);
    let length = |length: usize| (length as u64).to_le_bytes();
    bytes.extend_from_slice(MARK);
    bytes.extend_from_slice(key);
    bytes.extend_from_slice(&length(text.len()));
    bytes.extend_from_slice(text);
    bytes.extend_from_slice(&length(arrays.len()));
    for array in arrays {
        bytes.extend_from_slice(&length(array.len()));
        bytes.extend(array.iter().flat_map(|value| value.to_le_bytes()));
    }
    let hash = Sha256::digest(&bytes);
    bytes.extend_from_slice(&hash);
    bytes
}

/// The text and the arrays of a checkpoint.
pub(in crate::sweep) type Content<'a> = (&'a [u8], Vec<Vec<f64>>);

/// Why a checkpoint is not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Unusable {
    #[error("it is damaged or torn (its checksum does not match)")]
    Damaged,
    #[error("it belongs to something else, or was written by another build of the program")]
    Foreign,
}

/// The content of a checkpoint that is whole and has this key.
pub(in crate::sweep) fn decode<'a>(bytes: &'a [u8], key: &Key) -> Result<Content<'a>, Unusable> {
    let whole = || {
        let (content, hash) = bytes.split_at_checked(bytes.len().checked_sub(HASH_BYTES)?)?;
        let is_whole = Sha256::digest(content).as_slice() == hash;
        content.strip_prefix(MARK).filter(|_| is_whole)
    };
    let content = whole().ok_or(Unusable::Damaged)?;
    let content = content.strip_prefix(key).ok_or(Unusable::Foreign)?;
    parts(content).ok_or(Unusable::Damaged)
}

fn parts(mut rest: &[u8]) -> Option<Content<'_>> {
    let text_length = take_length(&mut rest)?;
    let text = take(&mut rest, text_length)?;
    let count = take_length(&mut rest)?;
    let mut arrays = Vec::new();
    for _ in 0..count {
        let length = take_length(&mut rest)?;
        let values = take(&mut rest, length.checked_mul(8)?)?;
        let values = values.chunks_exact(8).map(|value| {
            let mut bytes = [0; 8];
            bytes.copy_from_slice(value);
            f64::from_le_bytes(bytes)
        });
        arrays.push(values.collect());
    }
    rest.is_empty().then_some((text, arrays))
}

fn take<'a>(rest: &mut &'a [u8], length: usize) -> Option<&'a [u8]> {
    let (taken, left) = rest.split_at_checked(length)?;
    *rest = left;
    Some(taken)
}

fn take_length(rest: &mut &[u8]) -> Option<usize> {
    let bytes: [u8; 8] = take(rest, 8)?.try_into().ok()?;
    usize::try_from(u64::from_le_bytes(bytes)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: Key = [7; HASH_BYTES];

    #[test]
    fn a_damaged_or_foreign_checkpoint_is_known_for_what_it_is() {
        let bytes = encode(&KEY, b"{}", &[&[1.0, 2.0], &[]]);
        assert!(decode(&bytes, &KEY).is_ok());
        let of_another = decode(&bytes, &[8; HASH_BYTES]);
        assert_eq!(of_another, Err(Unusable::Foreign));
        for byte in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[byte] ^= 1;
            let found = [&damaged, &bytes[..byte]].map(|b| decode(b, &KEY));
            assert_eq!(found, [(); 2].map(|()| Err(Unusable::Damaged)), "{byte}");
        }
    }

    #[test]
    fn lengths_that_lie_are_refused_without_taking_memory() {
        let mut content = [&MARK[..], &KEY].concat();
        content.extend_from_slice(&u64::MAX.to_le_bytes());
        let hash = Sha256::digest(&content);
        content.extend_from_slice(&hash);
        assert_eq!(decode(&content, &KEY), Err(Unusable::Damaged));
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
