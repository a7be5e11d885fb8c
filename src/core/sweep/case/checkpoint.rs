//! Checkpoints inside a case, from which an interrupted case goes on and ends with the very same bits.
//!
//! A case solves several stabilised cycles one after another: its levels, by steps and nodes. A checkpoint holds a finished
//! level whole, and of the level under way everything that its next cycle depends on: the memory, the pressure (the guess of
//! the next instant), and what the acceleration of the search looks back on. What a thread carries besides is made anew.
//!
//! One file per level, `checkpoints/<case>/<level>.finished` or `.cycle`. Files are written at most every few seconds and at an
//! interruption, and removed with the case. One that cannot be written costs nothing but the time it would have saved, and one
//! that does not belong or is damaged is passed over.

use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::history::MarchState;
use crate::steady::{Cause, SearchState};
use crate::sweep::case::stabilise::Stabilised;
use crate::sweep::plan::Case;
use crate::sweep::store::Store;
use crate::sweep::store::archive::Purpose;
use crate::sweep::store::checkpoint_file::{CheckpointFile, Rhythm};
use crate::sweep::store::records::Key;

/// The checkpoints of one case, in the hands of the thread that solves it.
pub struct Checkpoints {
    /// The folder of the sweep, and the case by name and frequency.
    store: Store,
    case: String,
    frequency: u64,
    rhythm: Rhythm,
    levels: Cell<usize>,
    /// Levels at their ends that are not on disk yet.
    unwritten: RefCell<Vec<(CheckpointFile, Stabilised)>>,
}

/// One stabilised cycle to be found within a case, and its files.
pub(in crate::sweep) struct Level<'a> {
    of: &'a Checkpoints,
    finished: CheckpointFile,
    cycle: CheckpointFile,
}

/// The state of the level under way between two cycles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::sweep) enum LevelState<'a> {
    Searching(Cow<'a, SearchState>),
    Marching(Cow<'a, Marching>),
}

/// A march under way, or none that has begun.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sweep) struct Marching {
    /// Cycles of a direct search that failed before, and why.
    pub after_search: Option<(usize, String)>,
    pub cycles: usize,
    pub distance: Option<f64>,
    pub march: MarchState,
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

    /// The next level, on this number of nodes and in this number of steps.
    pub(in crate::sweep) fn begin(&self, nodes: usize, steps: usize) -> Level<'_> {
        let level = self.levels.replace(self.levels.get() + 1);
        let file = |ending: &str| {
            let name = format!("{}/{level:02}.{ending}", self.case);
            let owner = format!("{name}\n{:016x}\n{nodes} {steps}", self.frequency);
            CheckpointFile::new(&self.store, name, &owner)
        };
        Level {
            of: self,
            finished: file("finished"),
            cycle: file("cycle"),
        }
    }

    /// Writes the levels that are not on disk yet.
    pub(in crate::sweep) fn flush(&self) {
        self.write(None);
    }

    /// The same, and where the level under way stands.
    fn write(&self, under_way: Option<(&CheckpointFile, LevelState<'_>)>) {
        let finished = self.unwritten.take();
        self.rhythm.written(|| {
            for (file, ended) in &finished {
                file.write(ended);
            }
            if let Some((file, state)) = under_way {
                file.write(&state);
            }
        });
    }

    /// Removes them: the case is done.
    pub(in crate::sweep) fn remove(&self) {
        self.store.remove_checkpoints(&self.case);
    }
}

impl Level<'_> {
    /// The level as it ended before.
    pub(in crate::sweep) fn finished(&self) -> Option<Stabilised> {
        self.finished.read().ok().flatten()
    }

    /// The state in which the level was left.
    pub(in crate::sweep) fn state(&self) -> Option<LevelState<'static>> {
        self.cycle.read().ok().flatten()
    }

    /// Whether the case runs long enough for the states of its levels to be worth keeping.
    pub(in crate::sweep) fn is_wanted(&self) -> bool {
        self.of.rhythm.is_wanted()
    }

    /// Takes in the state of the level between two cycles: written where it is time, and where the case is stopped.
    pub(in crate::sweep) fn keep(&self, state: LevelState<'_>, cause: Cause) {
        let rhythm = &self.of.rhythm;
        if rhythm.is_wanted() && (cause == Cause::Stopped || rhythm.is_due()) {
            self.of.write(Some((&self.cycle, state)));
        }
    }

    /// Takes in its end.
    pub(in crate::sweep) fn finish(&self, ended: &Stabilised) {
        if self.is_wanted() {
            let finished = (self.finished.clone(), ended.clone());
            self.of.unwritten.borrow_mut().push(finished);
            if self.of.rhythm.is_due() {
                self.of.flush();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Solution;
    use crate::history::{LastInstant, Work};
    use crate::steady::Anderson;

    fn march() -> MarchState {
        MarchState {
            variables: vec![1.0 / 3.0, -0.0],
            last: LastInstant {
                pressure: vec![2.0],
                solution: Some(Solution {
                    load_n: 1.0,
                    approach_m: 2.0,
                    contact_radius_m: 3.0,
                    iterations: 4,
                    convolutions: 5,
                }),
                work: Work {
                    instants: 97,
                    iterations: 99,
                    convolutions: 98,
                },
            },
        }
    }

    #[test]
    fn a_state_comes_back_with_every_bit_and_only_at_its_own_level() {
        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), "", false).unwrap();
        let case = Case {
            index: 3,
            angular_frequency_rad_per_s: 0.1,
            condition: crate::sweep::plan::tests::condition(),
        };
        let checkpoints = || Checkpoints::of(&store, Purpose::Sweep, &case, Duration::ZERO);
        let mut anderson = Anderson::default();
        anderson.advance(&mut [0.1, 0.2], &[1e-300, 5.0], &[1.0, 1.0]);
        anderson.advance(&mut [0.2, 0.4], &[0.3, 4.0], &[1.0, 1.0]);
        let searching = LevelState::Searching(Cow::Owned(SearchState {
            start: vec![0.1, 0.2],
            last: march().last,
            best: (f64::INFINITY, vec![1.0, 2.0], vec![3.0, 4.0]),
            anderson,
            since_best: (2, 1),
            cycles: 3,
            distance: f64::INFINITY,
        }));
        let marching = LevelState::Marching(Cow::Owned(Marching {
            after_search: Some((40, "no".to_owned())),
            cycles: 17,
            distance: None,
            march: march(),
        }));
        for state in [searching, marching] {
            let kept = checkpoints();
            kept.begin(12, 34).keep(state.clone(), Cause::NextCycle);
            let found = checkpoints();
            let level = found.begin(12, 34);
            assert_eq!(level.state(), Some(state));
            assert!(level.finished().is_none());
            assert_eq!(found.begin(12, 34).state(), None);
            let finer = checkpoints();
            assert_eq!(finer.begin(12, 68).state(), None);
        }
        checkpoints().remove();
        assert!(!folder.path().join("checkpoints/0003").exists());
    }
}
