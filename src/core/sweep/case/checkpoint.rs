//! The levels of a case that are solved already, from which an interrupted case goes on and ends with the very same bits.
//!
//! A case solves several stabilised cycles one after another: its levels, by steps and nodes. Each that has ended is kept in a file of
//! its own, `records/checkpoints/<case>/<level>.finished`, once the case has run for a while; files are written at most every few seconds
//! and at an interruption, and removed with the case. One that cannot be written costs nothing but the time it would have saved, and
//! one that does not belong or is damaged is passed over.

use std::cell::{Cell, RefCell};
use std::time::Duration;

use crate::sweep::case::stabilise::Stabilised;
use crate::sweep::plan::Case;
use crate::sweep::store::Store;
use crate::sweep::store::checkpoint_file::{CheckpointFile, Rhythm};
use crate::sweep::store::entry::{Key, Purpose};

/// The checkpoints of one case, in the hands of the thread that solves it.
pub struct Checkpoints {
    store: Store,
    /// The case by name and frequency.
    case: String,
    frequency: u64,
    rhythm: Rhythm,
    levels: Cell<usize>,
    /// Levels at their ends that are not on disk yet.
    unwritten: RefCell<Vec<(CheckpointFile, Stabilised)>>,
}

impl Checkpoints {
    /// Those of a case in the folder of its sweep.
    pub fn of(store: &Store, purpose: Purpose, case: &Case, every: Duration) -> Self {
        Self {
            store: store.clone(),
            case: Key::name(purpose, case),
            frequency: case.angular_frequency_rad_per_s.to_bits(),
            rhythm: Rhythm::new(every),
            levels: Cell::new(0),
            unwritten: RefCell::default(),
        }
    }

    /// The file of the next level, on this number of nodes and in this number of steps.
    pub(crate) fn next_level(&self, nodes: usize, steps: usize) -> CheckpointFile {
        let level = self.levels.replace(self.levels.get() + 1);
        let name = format!("{}/{level:02}.finished", self.case);
        let owner = format!("{name}\n{:016x}\n{nodes} {steps}", self.frequency);
        CheckpointFile::new(&self.store, &name, &owner)
    }

    /// Takes in the end of a level.
    pub(crate) fn finished(&self, level: CheckpointFile, ended: &Stabilised) {
        if self.rhythm.is_wanted() {
            self.unwritten.borrow_mut().push((level, ended.clone()));
            if self.rhythm.is_due() {
                self.flush();
            }
        }
    }

    /// Writes the levels that are not on disk yet.
    pub(crate) fn flush(&self) {
        let finished = self.unwritten.take();
        self.rhythm.written(|| {
            for (level, ended) in &finished {
                level.write(ended);
            }
        });
    }

    /// Removes them: the case is done.
    pub(crate) fn remove(&self) {
        self.store.remove_checkpoints(&self.case);
    }
}
