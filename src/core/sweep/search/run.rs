//! The sweep itself: cases in parallel, the most expensive first, each on disk before its thread takes the next; then the peaks.
//!
//! The archive, most often a folder, is the memory of a sweep. A case whose record is there is not solved again, be it from an earlier run,
//! a shard, or a merged part: the outcome is the same, bit for bit.

use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::sweep::case::Setup;
use crate::sweep::plan::Condition;
use crate::sweep::record::{BranchLoss, CaseRecord, Status};
use crate::sweep::search::Search;
use crate::sweep::search::peak::Peak;
use crate::sweep::share::shard::Shard;
use crate::sweep::store::{Archive, StoreError, checkpoint_file};

/// Why a sweep stopped without an outcome.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error("cannot start {threads} threads: {reason}")]
    Threads { threads: usize, reason: String },
}

/// The result of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Finished cases, drive after drive, each in ascending frequency; where `missing` is not 0, those of this run alone.
    pub records: Vec<CaseRecord>,
    /// How many cases have no record: after an interruption of those of this run, else those of other shards.
    pub missing: usize,
    /// Local maxima of the loss, largest first.
    pub peaks: Vec<Peak>,
    /// Peaks that are bracketed by the samples but could not be located, with the reason.
    pub peak_problems: Vec<String>,
    /// Whether the sweep was stopped before all cases were done.
    pub interrupted: bool,
}

/// Is called with progress, from the threads that do the work.
pub trait Progress: Sync {
    fn case_finished(&self, _record: &CaseRecord) {}
    fn locating_peaks(&self, _brackets: usize) {}
    /// What there is has been read; what is solved from now on would be lost if nobody waited for it.
    fn solving(&self) {}
    /// This many of the cases to do have records already.
    fn cases_found(&self, _done: usize, _of: usize) {}
    /// Refinement adds this many cases to those planned, of which `found` have records already.
    fn cases_added(&self, _added: usize, _found: usize) {}
    /// Something a user should know, such as a record that is damaged and computed again.
    fn notice(&self, _what: &str) {}
}

/// Ignores it.
impl Progress for () {}

/// Which cases of a sweep are solved, and how; none of it changes its results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mode {
    /// Those without a usable record.
    Solve {
        threads: usize,
        /// Time between two checkpoints of a long case.
        checkpoint_every: Duration,
        /// This part of the sweep alone, for a process that shares its folder with those of the others.
        shard: Option<Shard>,
    },
    /// None: the outcome is what the records say.
    Read,
}

impl Mode {
    /// All cases on this many threads, all else as usual.
    pub fn on_threads(threads: usize) -> Self {
        Self::Solve {
            threads,
            checkpoint_every: checkpoint_file::EVERY,
            shard: None,
        }
    }
}

/// Runs the cases of the sweep, or of a shard of it, that have no record yet and stores each as it is finished. Once every case of
/// the sweep has a record, the curve is refined and its peaks are located: by the shard whose last case was the last of all.
///
/// The result does not depend on the number of threads: a case shares nothing that changes with another. `interrupt` stops
/// the cases under way at their next time step.
///
/// # Errors
/// [`RunError`]: where a record cannot be read or written (the other threads then stop too) or threads cannot be started.
pub fn run(
    setup: &Setup,
    archive: &dyn Archive,
    mode: Mode,
    interrupt: &AtomicBool,
    progress: &dyn Progress,
) -> Result<Outcome, RunError> {
    let (threads, shard) = match mode {
        Mode::Solve { threads, shard, .. } => {
            if let Some(store) = archive.store() {
                store.claim(shard.is_none())?;
            }
            (threads, shard)
        }
        Mode::Read => (1, None),
    };
    let search = Search {
        pool: pool(threads)?,
        setup,
        archive,
        mode,
        interrupt,
        progress,
        reported_builds: AtomicBool::new(false),
    };
    Ok(search.outcome(shard)?)
}

/// Threads for every processor at most. More than one gains nothing, and each takes memory; a few do no harm.
const THREADS_PER_PROCESSOR: usize = 4;

/// As many threads as are asked for, but no more than this machine has a use for; without a number, one per processor.
pub fn useful_threads(asked: Option<NonZeroUsize>) -> usize {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    asked.map_or(processors, |asked| {
        (asked.get()).min(THREADS_PER_PROCESSOR * processors)
    })
}

/// Threads to work on, no more than are useful.
///
/// # Errors
/// [`RunError::Threads`] where they cannot be started.
pub fn pool(threads: usize) -> Result<ThreadPool, RunError> {
    let threads = useful_threads(NonZeroUsize::new(threads));
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| RunError::Threads {
        threads,
        reason: error.to_string(),
    })
}

impl Outcome {
    /// Retardation times (s) of the material's creep compliance, as the results list its branches; none without a result.
    pub fn retardation_times_s(&self) -> Vec<f64> {
        let times = |branches: &[BranchLoss]| -> Vec<f64> {
            branches.iter().map(|b| b.retardation_time_s).collect()
        };
        let mut results = self.branches_of_results().map(times);
        let first = results.next().unwrap_or_default();
        match results.all(|other| other == first) {
            true => first,
            false => Vec::new(),
        }
    }

    /// The peak that is the largest loss of its curve; `None` where the loss is larger at an end of the sweep.
    pub fn highest_peak(&self, condition: &Condition) -> Option<&Peak> {
        /// A sample beside the peak may lie above it by what the cycles are not quite stabilised.
        const ABOVE: f64 = 1e-4;
        // The peaks are in order, the largest first.
        let peak = self.peaks.iter().find(|peak| peak.is_of(condition))?;
        let of_curve = self.records.iter().filter(|r| r.is_of(condition));
        let mut losses = of_curve.filter_map(CaseRecord::energy_loss_j);
        losses
            .all(|loss_j| loss_j <= (1.0 + ABOVE) * peak.energy_loss_j)
            .then_some(peak)
    }

    /// The most branches that the creep compliance of a case has.
    pub fn branches(&self) -> usize {
        self.branches_of_results()
            .map(<[_]>::len)
            .max()
            .unwrap_or(0)
    }

    fn branches_of_results(&self) -> impl Iterator<Item = &[BranchLoss]> {
        let results = self.records.iter().filter_map(|r| r.result.as_ref());
        results.map(|result| result.branches.as_slice())
    }

    /// Number of cases with this status.
    pub fn count(&self, status: Status) -> usize {
        self.records.iter().filter(|r| r.status == status).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_threads_are_started_than_the_processors_have_a_use_for() {
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        let useful = |asked: usize| useful_threads(NonZeroUsize::new(asked));
        assert_eq!([0, 1, 2].map(useful), [processors, 1, 2]);
        for many in [100_000, usize::MAX] {
            assert_eq!(useful(many), 4 * processors);
            assert_eq!(pool(many).unwrap().current_num_threads(), 4 * processors);
        }
    }
}
