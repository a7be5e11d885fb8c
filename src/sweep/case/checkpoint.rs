//! Checkpoints inside a case, from which an interrupted case goes on and ends with the very same bits.
//!
//! A case solves several stabilised cycles one after another: its levels, by steps and nodes. A checkpoint holds a finished
//! level whole, and of the level under way everything that its next cycle depends on: the memory, the pressure (the guess of
//! the next instant), and what the acceleration of the search looks back on. What a thread carries besides is made anew.
//!
//! One file per level, `checkpoints/<case>/<level>.finished` or `.cycle`, that says what it belongs to: build of the program,
//! sweep, case and level. Files are written at most every few seconds and at an interruption, and removed with the case. One
//! that cannot be written costs nothing but the time it would have saved, and one that does not belong or is damaged is passed
//! over.

use std::cell::RefCell;
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::history::{MarchState, Work};
use crate::steady::SearchState;
use crate::sweep::case::stabilise::Stabilised;
use crate::sweep::plan::{Case, Method};
use crate::sweep::record::CaseResult;
use crate::sweep::store::archive::{Purpose, case_name};
use crate::sweep::store::checkpoint_file::{self, FOLDER, Key, Rhythm, from_numbers, numbers};
use crate::sweep::store::provenance::BUILD;
use crate::sweep::store::{Store, write_atomically};

/// The checkpoints of one case, in the hands of the thread that solves it.
pub struct Checkpoints {
    /// `None`: nothing is kept.
    folder: Option<PathBuf>,
    /// What they belong to, but for the level.
    owner: String,
    rhythm: Rhythm,
    state: RefCell<State>,
}

struct State {
    levels: usize,
    /// Finished levels that are not on disk yet: name and bytes.
    pending: Vec<(String, Vec<u8>)>,
    /// The level under way at its last cycle: name, key, state; made into bytes only where it is written.
    latest: Option<(String, Key, Progress)>,
}

/// One stabilised cycle to be found within a case.
pub(in crate::sweep) struct Level {
    ordinal: usize,
    key: Key,
}

/// Where the level under way stands.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::sweep) enum Progress {
    Searching(Box<SearchState>),
    Marching {
        /// Cycles of a direct search that failed before, and why.
        after_search: Option<(usize, String)>,
        cycles: usize,
        distance: Option<f64>,
        march: MarchState,
    },
}

impl Checkpoints {
    /// Keeps nothing.
    pub fn none() -> Self {
        Self::new(None, String::new(), checkpoint_file::EVERY)
    }

    /// Those of a case in the folder of its sweep.
    pub fn of(store: &Store, purpose: Purpose, case: &Case, every: Duration) -> Self {
        let name = case_name(purpose, case);
        let owner = format!(
            "{}\n{}\n{name}\n{:016x}",
            BUILD,
            store.sweep_hash(),
            case.angular_frequency_rad_per_s.to_bits()
        );
        let folder = store.folder().join(FOLDER).join(name);
        Self::new(Some(folder), owner, every)
    }

    fn new(folder: Option<PathBuf>, owner: String, every: Duration) -> Self {
        Self {
            folder,
            owner,
            rhythm: Rhythm::new(every),
            state: RefCell::new(State {
                levels: 0,
                pending: Vec::new(),
                latest: None,
            }),
        }
    }

    /// The next level, on so many nodes and in so many steps.
    pub(in crate::sweep) fn begin(&self, nodes: usize, steps: usize) -> Level {
        let mut state = self.state.borrow_mut();
        state.latest = None;
        let ordinal = state.levels;
        state.levels += 1;
        let owner = format!("{}\n{ordinal} {nodes} {steps}", self.owner);
        Level {
            ordinal,
            key: checkpoint_file::key(&owner),
        }
    }

    fn file(&self, name: &str) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(name))
    }

    fn read<T: for<'de> Deserialize<'de>>(
        &self,
        level: &Level,
        name: &str,
    ) -> Option<(T, Vec<Vec<f64>>)> {
        let bytes = fs::read(self.file(name)?).ok()?;
        let (text, arrays) = checkpoint_file::decode(&bytes, &level.key).ok()?;
        Some((serde_json::from_slice(text).ok()?, arrays))
    }

    /// The level as it ended before.
    pub(in crate::sweep) fn finished(&self, level: &Level) -> Option<Stabilised> {
        let (text, arrays): (FinishedText, _) = self.read(level, &level.finished_name())?;
        let [memory, last] = <[Vec<f64>; 2]>::try_from(arrays).ok()?;
        Some(Stabilised {
            method: text.method,
            cycles: text.cycles,
            work: text.work,
            distance: text.distance,
            message: text.message,
            memory,
            last: from_numbers(&last, text.last_iterations)?,
            result: text.result,
        })
    }

    /// Where the level stood.
    pub(in crate::sweep) fn progress(&self, level: &Level) -> Option<Progress> {
        let (text, arrays): (ProgressText, _) = self.read(level, &level.cycle_name())?;
        Progress::from_parts(text, arrays)
    }

    /// Whether the case runs long enough for its state to be worth keeping.
    pub(in crate::sweep) fn is_wanted(&self) -> bool {
        self.folder.is_some() && self.rhythm.is_wanted()
    }

    /// Takes in where the level stands between two cycles.
    pub(in crate::sweep) fn keep(&self, level: &Level, progress: Progress) {
        self.state.borrow_mut().latest = Some((level.cycle_name(), level.key, progress));
        self.write_where_due();
    }

    /// Takes in a finished level.
    pub(in crate::sweep) fn finish(&self, level: &Level, ended: &Stabilised) {
        if !self.is_wanted() {
            return;
        }
        let text = FinishedText {
            method: ended.method,
            cycles: ended.cycles,
            work: ended.work,
            distance: ended.distance,
            message: ended.message.clone(),
            last_iterations: ended.last.map(|last| last.iterations),
            result: ended.result.clone(),
        };
        if let Ok(text) = serde_json::to_vec(&text) {
            let last = numbers(ended.last);
            let bytes = checkpoint_file::encode(&level.key, &text, &[&ended.memory, &last]);
            let mut state = self.state.borrow_mut();
            state.pending.push((level.finished_name(), bytes));
            state.latest = None;
            drop(state);
            self.write_where_due();
        }
    }

    fn write_where_due(&self) {
        if self.rhythm.is_due() {
            self.flush();
        }
    }

    /// Writes what is not on disk yet.
    pub(in crate::sweep) fn flush(&self) {
        let Some(folder) = &self.folder else { return };
        let mut state = self.state.borrow_mut();
        let latest = state.latest.take();
        let latest = latest.and_then(|(name, key, progress)| Some((name, progress.bytes(&key)?)));
        self.rhythm.written(|| {
            for (name, bytes) in state.pending.drain(..).chain(latest) {
                // Without it, this level is solved again.
                let _ = write_atomically(&folder.join(name), &bytes);
            }
        });
    }

    /// Removes them: the case is done.
    pub(in crate::sweep) fn remove(&self) {
        if let Some(folder) = &self.folder {
            // There is none, most often.
            let _ = fs::remove_dir_all(folder);
        }
    }
}

impl Level {
    fn finished_name(&self) -> String {
        format!("{:02}.finished", self.ordinal)
    }

    fn cycle_name(&self) -> String {
        format!("{:02}.cycle", self.ordinal)
    }
}

#[derive(Serialize, Deserialize)]
struct FinishedText {
    method: Method,
    cycles: usize,
    work: Work,
    distance: Option<f64>,
    message: Option<String>,
    last_iterations: Option<usize>,
    result: Option<CaseResult>,
}

/// What is no array.
#[derive(Serialize, Deserialize)]
struct ProgressText {
    searching: bool,
    after_search: Option<(usize, String)>,
    cycles: usize,
    #[serde(default)]
    since_best: (usize, usize),
    work: Work,
    solved_iterations: Option<usize>,
}

impl Progress {
    /// A march that has not begun.
    pub(in crate::sweep) fn unmarched(after_search: Option<(usize, String)>) -> Self {
        Self::Marching {
            after_search,
            cycles: 0,
            distance: None,
            march: MarchState {
                variables: Vec::new(),
                pressure: Vec::new(),
                solution: None,
                work: Work::default(),
            },
        }
    }

    fn bytes(&self, key: &Key) -> Option<Vec<u8>> {
        let (text, arrays) = self.parts();
        let text = serde_json::to_vec(&text).ok()?;
        let arrays: Vec<&[f64]> = arrays.iter().map(Vec::as_slice).collect();
        Some(checkpoint_file::encode(key, &text, &arrays))
    }

    /// Arrays: scalars, memory, pressure, solution; of a search then start, best memory, best update, acceleration.
    fn parts(&self) -> (ProgressText, Vec<Vec<f64>>) {
        let (march, cycles) = match self {
            Self::Searching(state) => (&state.march, state.cycles),
            Self::Marching { march, cycles, .. } => (march, *cycles),
        };
        let text = ProgressText {
            searching: matches!(self, Self::Searching(_)),
            after_search: match self {
                Self::Searching(_) => None,
                Self::Marching { after_search, .. } => after_search.clone(),
            },
            cycles,
            since_best: match self {
                Self::Searching(state) => state.since_best,
                Self::Marching { .. } => (0, 0),
            },
            work: march.work,
            solved_iterations: march.solution.map(|s| s.iterations),
        };
        let scalars = match self {
            Self::Searching(state) => vec![state.distance, state.best.0],
            Self::Marching { distance, .. } => distance.iter().copied().collect(),
        };
        let mut arrays = vec![
            scalars,
            march.variables.clone(),
            march.pressure.clone(),
            numbers(march.solution),
        ];
        if let Self::Searching(state) = self {
            let vectors = [&state.start, &state.best.1, &state.best.2];
            arrays.extend(vectors.into_iter().cloned());
            arrays.extend(state.anderson.iter().cloned());
        }
        (text, arrays)
    }

    fn from_parts(text: ProgressText, arrays: Vec<Vec<f64>>) -> Option<Self> {
        let mut arrays = arrays.into_iter();
        let mut next = || arrays.next();
        let (scalars, variables, pressure, solution) = (next()?, next()?, next()?, next()?);
        let march = MarchState {
            variables,
            pressure,
            solution: from_numbers(&solution, text.solved_iterations)?,
            work: text.work,
        };
        if !text.searching {
            return Some(Self::Marching {
                after_search: text.after_search,
                cycles: text.cycles,
                distance: scalars.first().copied(),
                march,
            });
        }
        let &[distance, best] = scalars.as_slice() else {
            return None;
        };
        let (start, best_memory, best_update) = (next()?, next()?, next()?);
        Some(Self::Searching(Box::new(SearchState {
            start,
            march,
            best: (best, best_memory, best_update),
            anderson: arrays.collect(),
            since_best: text.since_best,
            cycles: text.cycles,
            distance,
        })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Solution;

    const KEY: Key = [7; 32];

    fn march() -> MarchState {
        MarchState {
            variables: vec![1.0 / 3.0, -0.0],
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
        }
    }

    fn there_and_back(progress: &Progress) -> Progress {
        let bytes = progress.bytes(&KEY).unwrap();
        let (text, arrays) = checkpoint_file::decode(&bytes, &KEY).unwrap();
        Progress::from_parts(serde_json::from_slice(text).unwrap(), arrays).unwrap()
    }

    #[test]
    fn progress_comes_back_with_every_bit_infinities_too() {
        let searching = Progress::Searching(Box::new(SearchState {
            start: vec![0.1, 0.2],
            march: march(),
            best: (f64::INFINITY, vec![1.0, 2.0], vec![3.0, 4.0]),
            anderson: vec![vec![], vec![1e-300], vec![5.0], vec![6.0]],
            since_best: (2, 1),
            cycles: 3,
            distance: f64::INFINITY,
        }));
        let marching = Progress::Marching {
            after_search: Some((40, "no".to_owned())),
            cycles: 17,
            distance: None,
            march: march(),
        };
        for progress in [searching, marching] {
            assert_eq!(there_and_back(&progress), progress);
        }
    }
}
