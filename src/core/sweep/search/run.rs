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
use crate::sweep::share::shard::{self, Shard};
use crate::sweep::store::entry::Purpose;
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

/// What a sweep came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Finished cases, drive after drive, each in ascending frequency; fewer than planned only after an interruption.
    pub records: Vec<CaseRecord>,
    /// Local maxima of the loss, largest first.
    pub peaks: Vec<Peak>,
    /// Peaks that are bracketed by the samples but could not be located, with the reason.
    pub peak_problems: Vec<String>,
    /// Whether the sweep was stopped before all cases were done.
    pub interrupted: bool,
}

/// Hears of progress; called from the threads that do the work.
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

/// Hears of nothing.
impl Progress for () {}

/// How a sweep is run; none of it changes its results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    pub threads: usize,
    /// Time between two checkpoints of a long case.
    pub checkpoint_every: Duration,
}

impl Options {
    /// On this many threads, all else as usual.
    pub fn on_threads(threads: usize) -> Self {
        Self {
            threads,
            checkpoint_every: checkpoint_file::EVERY,
        }
    }
}

/// What a shard of a sweep came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// The finished cases of this shard.
    pub records: Vec<CaseRecord>,
    /// How many cases of the whole sweep have no record in the folder yet.
    pub missing: usize,
    /// The whole sweep, where this shard's last case was the last of all.
    pub whole: Option<Outcome>,
    pub interrupted: bool,
}

/// Runs every case of the sweep that has no record yet on `threads` threads and stores each as it is finished.
///
/// The result does not depend on the number of threads: a case shares nothing that changes with another. `interrupt` stops
/// the cases under way at their next time step.
///
/// # Errors
/// [`RunError`]: where a record cannot be written (the other threads then stop too) or threads cannot be started.
pub fn run<'a>(
    setup: &Setup,
    archive: impl Into<Archive<'a>>,
    threads: usize,
    interrupt: &AtomicBool,
    progress: &dyn Progress,
) -> Result<Outcome, RunError> {
    let options = Options::on_threads(threads);
    run_with(setup, archive, &options, interrupt, progress)
}

/// As [`run`], with options.
///
/// # Errors
/// As [`run`].
pub fn run_with<'a>(
    setup: &Setup,
    archive: impl Into<Archive<'a>>,
    options: &Options,
    interrupt: &AtomicBool,
    progress: &dyn Progress,
) -> Result<Outcome, RunError> {
    let archive = archive.into();
    archive.claim(true)?;
    let search = Search::new(setup, archive, Some(options), (interrupt, progress))?;
    let (records, missing) = search.planned(&setup.plan().cases())?;
    search.outcome(records, missing > 0)
}

/// Runs one shard of the sweep; where its last case is the last of the whole sweep in this folder, peaks are located too.
///
/// # Errors
/// As [`run`].
pub fn run_shard<'a>(
    setup: &Setup,
    archive: impl Into<Archive<'a>>,
    shard: Shard,
    options: &Options,
    interrupt: &AtomicBool,
    progress: &dyn Progress,
) -> Result<Part, RunError> {
    let archive = archive.into();
    archive.claim(false)?;
    let search = Search::new(setup, archive, Some(options), (interrupt, progress))?;
    let own = shard::cases(setup, shard);
    let (records, missing) = search.planned(&own)?;
    if missing > 0 {
        return Ok(Part {
            records,
            missing,
            whole: None,
            interrupted: true,
        });
    }
    let (all, lacking) = search.known(Purpose::Sweep, &setup.plan().cases())?;
    let whole = (lacking.is_empty()).then(|| search.outcome(all, false));
    let whole = whole.transpose()?;
    Ok(Part {
        records,
        missing: lacking.len(),
        interrupted: whole.as_ref().is_some_and(|whole| whole.interrupted),
        whole,
    })
}

/// What the records of a folder say, without solving anything; cases without a record are missing in the outcome.
///
/// # Errors
/// [`RunError`] where a record cannot be read.
pub fn collect<'a>(
    setup: &Setup,
    archive: impl Into<Archive<'a>>,
    progress: &dyn Progress,
) -> Result<Outcome, RunError> {
    let interrupt = AtomicBool::new(false);
    let search = Search::new(setup, archive.into(), None, (&interrupt, progress))?;
    let (records, missing) = search.known(Purpose::Sweep, &setup.plan().cases())?;
    search.outcome(records, !missing.is_empty())
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
