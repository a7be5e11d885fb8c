//! The sweep itself: cases in parallel, the dearest first, each on disk before its thread takes the next; then the peaks.
//!
//! The folder is the memory of a sweep. A case whose record is there is not solved again, be it from an earlier run, another
//! process at work in the same folder, or a merged part: the outcome is the same, bit for bit.

use std::cell::RefCell;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::drive::HarmonicDrive;
use crate::sweep::archive::{Kept, Purpose};
use crate::sweep::case::Setup;
use crate::sweep::checkpoint::{self, Checkpoints};
use crate::sweep::peak::{self, Loss, Peak, PeakError, Point};
use crate::sweep::plan::Case;
use crate::sweep::record::{CaseRecord, Status};
use crate::sweep::refine;
use crate::sweep::shard::{self, Shard};
use crate::sweep::store::{Store, StoreError};

/// Why a sweep stopped without an outcome.
#[derive(Debug, thiserror::Error)]
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
    fn case_finished(&self, record: &CaseRecord);
    fn locating_peaks(&self, brackets: usize);
    /// So many of the cases to do have records already.
    fn cases_found(&self, _done: usize, _of: usize) {}
    /// Something a user should know, such as a record that is damaged and computed again.
    fn told(&self, _what: &str) {}
}

/// How a sweep is run; none of it changes its results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    pub threads: usize,
    /// Time between two checkpoints of a long case.
    pub checkpoint_every: Duration,
}

impl Options {
    /// On so many threads, all else as usual.
    pub fn on_threads(threads: usize) -> Self {
        Self {
            threads,
            checkpoint_every: checkpoint::EVERY,
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
pub fn run(
    setup: &Setup,
    store: &Store,
    threads: usize,
    interrupt: &AtomicBool,
    progress: &dyn Progress,
) -> Result<Outcome, RunError> {
    let options = Options::on_threads(threads);
    run_with(setup, store, &options, interrupt, progress)
}

/// As [`run`], with options.
///
/// # Errors
/// As [`run`].
pub fn run_with(
    setup: &Setup,
    store: &Store,
    options: &Options,
    interrupt: &AtomicBool,
    progress: &dyn Progress,
) -> Result<Outcome, RunError> {
    let pool = pool(options.threads)?;
    let search = Search {
        pool: &pool,
        setup,
        store,
        checkpoint_every: options.checkpoint_every,
        solves: true,
        interrupt,
        progress,
    };
    let (records, missing) = search.planned(&setup.plan().cases())?;
    search.outcome(records, missing > 0)
}

/// Runs one shard of the sweep; where its last case is the last of the whole sweep in this folder, peaks are located too.
///
/// # Errors
/// As [`run`].
pub fn run_shard(
    setup: &Setup,
    store: &Store,
    shard: Shard,
    options: &Options,
    interrupt: &AtomicBool,
    progress: &dyn Progress,
) -> Result<Part, RunError> {
    let pool = pool(options.threads)?;
    let search = Search {
        pool: &pool,
        setup,
        store,
        checkpoint_every: options.checkpoint_every,
        solves: true,
        interrupt,
        progress,
    };
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
    let whole = match lacking.is_empty() {
        true => Some(search.outcome(all, false)?),
        false => None,
    };
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
pub fn collect(setup: &Setup, store: &Store, progress: &dyn Progress) -> Result<Outcome, RunError> {
    let pool = pool(1)?;
    let search = Search {
        pool: &pool,
        setup,
        store,
        checkpoint_every: checkpoint::EVERY,
        solves: false,
        interrupt: &AtomicBool::new(false),
        progress,
    };
    let (records, missing) = search.known(Purpose::Sweep, &setup.plan().cases())?;
    search.outcome(records, !missing.is_empty())
}

fn pool(threads: usize) -> Result<ThreadPool, RunError> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| RunError::Threads {
        threads,
        reason: error.to_string(),
    })
}

/// What solving more cases takes.
struct Search<'a> {
    pool: &'a ThreadPool,
    setup: &'a Setup,
    store: &'a Store,
    checkpoint_every: Duration,
    /// Whether cases without a record are solved.
    solves: bool,
    interrupt: &'a AtomicBool,
    progress: &'a dyn Progress,
}

/// How often a neighbourhood may be halved before it is left as it is.
const REFINEMENTS: usize = 6;

impl Search<'_> {
    /// The records of cases of the sweep, and how many of these have none in the end.
    fn planned(&self, cases: &[Case]) -> Result<(Vec<CaseRecord>, usize), StoreError> {
        let (mut records, lacking) = self.known(Purpose::Sweep, cases)?;
        if !records.is_empty() {
            self.progress.cases_found(records.len(), cases.len());
        }
        records.extend(self.compute(Purpose::Sweep, &lacking)?);
        records.sort_by_key(|r| r.index);
        let missing = cases.len() - records.len();
        Ok((records, missing))
    }

    /// What is left to do once the cases planned have records: refinement, order, peaks.
    fn outcome(
        &self,
        mut records: Vec<CaseRecord>,
        mut interrupted: bool,
    ) -> Result<Outcome, RunError> {
        let plan = self.setup.plan();
        if plan.refine && !interrupted {
            interrupted = self.refine(&mut records)?;
        }
        let drives = plan.drives();
        let drive = |r: &CaseRecord| drives.iter().position(|drive| r.is_under(drive));
        records.sort_by(|a, b| {
            let omegas = [a, b].map(|r| r.angular_frequency_rad_per_s);
            (drive(a).cmp(&drive(b))).then(omegas[0].total_cmp(&omegas[1]))
        });
        let mut outcome = Outcome {
            interrupted,
            records,
            peaks: Vec::new(),
            peak_problems: Vec::new(),
        };
        if !outcome.interrupted {
            outcome.interrupted = !self.locate_peaks(&mut outcome)?;
        }
        if !outcome.interrupted {
            self.store.remove_checkpoints();
        }
        Ok(outcome)
    }

    /// Adds frequencies where the records do not resolve their curve; says whether it was interrupted.
    fn refine(&self, records: &mut Vec<CaseRecord>) -> Result<bool, StoreError> {
        for _ in 0..REFINEMENTS {
            let mut added = Vec::new();
            for drive in self.setup.plan().drives() {
                for omega in refine::candidates(&curve_of(records, drive)) {
                    added.push(Case {
                        index: records.len() + added.len(),
                        angular_frequency_rad_per_s: omega,
                        drive: *drive,
                    });
                }
            }
            if added.is_empty() {
                break;
            }
            let more = self.records_of(Purpose::Sweep, &added)?;
            let interrupted = more.len() < added.len();
            records.extend(more);
            if interrupted {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Locates the peaks of every curve; false where it was interrupted, or a case that it takes has no record and none is
    /// solved.
    fn locate_peaks(&self, outcome: &mut Outcome) -> Result<bool, StoreError> {
        let plan = self.setup.plan();
        let drives = plan.drives().iter();
        let brackets: Vec<(HarmonicDrive, [Point; 3])> = drives
            .flat_map(|drive| {
                let found = peak::brackets(&curve_of(&outcome.records, drive));
                found.into_iter().map(move |bracket| (*drive, bracket))
            })
            .collect();
        self.progress.locating_peaks(brackets.len());
        let mut whole = true;
        for (drive, bracket) in &brackets {
            let failed = RefCell::new(None);
            let losses = |omegas: &[f64]| self.losses_at(drive, omegas, &failed);
            let found = peak::refine(bracket, &losses);
            if let Some(error) = failed.into_inner() {
                return Err(error);
            }
            whole &= found != Err(PeakError::Interrupted);
            match found {
                Ok(mut found) => {
                    if plan.axis.is_some() {
                        found.drive_mean = Some(drive.mean());
                        found.drive_amplitude = Some(drive.amplitude());
                    }
                    outcome.peaks.push(found);
                }
                Err(error) => outcome.peak_problems.push(error.to_string()),
            }
        }
        let larger = |a: &Peak, b: &Peak| b.energy_loss_j.total_cmp(&a.energy_loss_j);
        outcome.peaks.sort_by(larger);
        Ok(whole)
    }

    /// The records of these cases, solved where there are none; fewer after an interruption.
    fn records_of(&self, purpose: Purpose, cases: &[Case]) -> Result<Vec<CaseRecord>, StoreError> {
        let (mut records, lacking) = self.known(purpose, cases)?;
        records.extend(self.compute(purpose, &lacking)?);
        records.sort_by_key(|r| r.index);
        Ok(records)
    }

    /// The usable records of these cases, and the cases that have none.
    fn known(
        &self,
        purpose: Purpose,
        cases: &[Case],
    ) -> Result<(Vec<CaseRecord>, Vec<Case>), StoreError> {
        let (mut records, mut lacking) = (Vec::new(), Vec::new());
        for case in cases {
            match self.store.load_case(purpose, case)? {
                Kept::Intact(record) => records.push(*record),
                Kept::Absent => lacking.push(*case),
                Kept::Unusable { path, reason } => {
                    let path = path.display();
                    let then = match self.solves {
                        true => "the case is computed again",
                        false => "the case is left out",
                    };
                    self.progress.told(&format!("{path}: {reason}; {then}"));
                    lacking.push(*case);
                }
            }
        }
        Ok((records, lacking))
    }

    /// Solves these cases in parallel, the dearest first: each thread takes the next from a common counter, so that the
    /// uneven cases end together.
    fn compute(&self, purpose: Purpose, cases: &[Case]) -> Result<Vec<CaseRecord>, StoreError> {
        if !self.solves {
            return Ok(Vec::new());
        }
        let mut order: Vec<&Case> = cases.iter().collect();
        let cost = |case: &Case| self.setup.predicted_cycles(case);
        order.sort_by(|a, b| cost(b).total_cmp(&cost(a)).then(a.index.cmp(&b.index)));
        let next = AtomicUsize::new(0);
        let failure: Mutex<Option<StoreError>> = Mutex::new(None);
        let stop = AtomicBool::new(false);
        let parts: Vec<Vec<CaseRecord>> = self.pool.broadcast(|_| {
            let mut done = Vec::new();
            while !stop.load(Ordering::Relaxed) && !self.interrupt.load(Ordering::Relaxed) {
                let Some(case) = order.get(next.fetch_add(1, Ordering::Relaxed)) else {
                    break;
                };
                match self.compute_one(purpose, case) {
                    Ok(Some(record)) => done.push(record),
                    Ok(None) => break,
                    Err(error) => {
                        stop.store(true, Ordering::Relaxed);
                        if let Ok(mut slot) = failure.lock() {
                            slot.get_or_insert(error);
                        }
                        break;
                    }
                }
            }
            done
        });
        match failure.into_inner().ok().flatten() {
            Some(error) => Err(error),
            None => Ok(parts.into_iter().flatten().collect()),
        }
    }

    /// Solves a case and stores its record, unless another process has done so meanwhile; `None` where it was interrupted.
    fn compute_one(&self, purpose: Purpose, case: &Case) -> Result<Option<CaseRecord>, StoreError> {
        let record = match self.store.load_case(purpose, case)? {
            Kept::Intact(record) => *record,
            Kept::Absent | Kept::Unusable { .. } => {
                let every = self.checkpoint_every;
                let checkpoints = Checkpoints::of(self.store, purpose, case, every);
                let Some(record) = self.setup.run_from(&checkpoints, case, self.interrupt) else {
                    return Ok(None);
                };
                self.store.save_case(purpose, case, &record)?;
                checkpoints.remove();
                record
            }
        };
        if purpose == Purpose::Sweep {
            self.progress.case_finished(&record);
        }
        Ok(Some(record))
    }

    /// Losses at frequencies between the samples, for the peak search. `failed` receives an error of the folder.
    fn losses_at(
        &self,
        drive: &HarmonicDrive,
        omegas: &[f64],
        failed: &RefCell<Option<StoreError>>,
    ) -> Result<Vec<Loss>, PeakError> {
        let case = |(index, omega): (usize, &f64)| Case {
            index,
            angular_frequency_rad_per_s: *omega,
            drive: *drive,
        };
        let cases: Vec<Case> = omegas.iter().enumerate().map(case).collect();
        let records = self.records_of(Purpose::Peak, &cases).map_err(|error| {
            failed.replace(Some(error));
            PeakError::Interrupted
        })?;
        if records.len() < omegas.len() {
            return Err(PeakError::Interrupted);
        }
        let loss = |record: &CaseRecord| {
            let loss_j = record.energy_loss_j().ok_or_else(|| PeakError::Case {
                angular_frequency_rad_per_s: record.angular_frequency_rad_per_s,
                reason: record.message.clone().unwrap_or_default(),
            })?;
            Ok((loss_j, record.energy_loss_error_j()))
        };
        records.iter().map(loss).collect()
    }
}

/// Loss over frequency under one drive, ascending.
fn curve_of(records: &[CaseRecord], drive: &HarmonicDrive) -> Vec<Point> {
    let mut curve: Vec<Point> = records
        .iter()
        .filter(|r| r.is_under(drive))
        .filter_map(|r| Some((r.angular_frequency_rad_per_s, r.energy_loss_j()?)))
        .collect();
    curve.sort_by(|a, b| a.0.total_cmp(&b.0));
    curve
}

impl Outcome {
    /// Retardation times (s) of the material's creep compliance, as the results list its branches; none without a result.
    pub fn retardation_times_s(&self) -> Vec<f64> {
        let result = self.records.iter().find_map(|r| r.result.as_ref());
        let branches = result.map_or(&[][..], |r| &r.branches);
        branches.iter().map(|b| b.retardation_time_s).collect()
    }

    /// Number of cases with this status.
    pub fn count(&self, status: Status) -> usize {
        self.records.iter().filter(|r| r.status == status).count()
    }
}
