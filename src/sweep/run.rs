//! The sweep itself: cases in parallel, the dearest first, each on disk before its thread takes the next; then the peaks.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::drive::HarmonicDrive;
use crate::sweep::case::Setup;
use crate::sweep::peak::{self, Loss, Peak, PeakError, Point};
use crate::sweep::plan::Case;
use crate::sweep::record::{CaseRecord, Status};
use crate::sweep::refine;
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
}

/// Runs every case of the sweep on `threads` threads and stores each record as it is finished.
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
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| RunError::Threads {
            threads,
            reason: error.to_string(),
        })?;
    let finish = |record: &CaseRecord| -> Result<(), StoreError> {
        store.save_case(record)?;
        progress.case_finished(record);
        Ok(())
    };
    let search = Search {
        pool: &pool,
        setup,
        interrupt,
    };
    let cases = setup.plan().cases();
    let mut records = search.solve(&cases, &finish)?;
    let mut interrupted = records.len() < cases.len();
    if setup.plan().refine && !interrupted {
        interrupted = search.refine(&mut records, &finish)?;
    }
    let drives = setup.plan().drives();
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
        search.locate_peaks(&mut outcome, progress);
        outcome.interrupted = interrupt.load(Ordering::Relaxed);
    }
    Ok(outcome)
}

/// Called with each finished record.
type Finish<'a> = dyn Fn(&CaseRecord) -> Result<(), StoreError> + Sync + 'a;

/// What solving more cases takes.
struct Search<'a> {
    pool: &'a ThreadPool,
    setup: &'a Setup,
    interrupt: &'a AtomicBool,
}

/// How often a neighbourhood may be halved before it is left as it is.
const REFINEMENTS: usize = 6;

impl Search<'_> {
    /// Adds frequencies where the records do not resolve their curve; says whether it was interrupted.
    fn refine(
        &self,
        records: &mut Vec<CaseRecord>,
        finish: &Finish<'_>,
    ) -> Result<bool, StoreError> {
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
            let more = self.solve(&added, finish)?;
            let interrupted = more.len() < added.len();
            records.extend(more);
            if interrupted {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Locates the peaks of every curve.
    fn locate_peaks(&self, outcome: &mut Outcome, progress: &dyn Progress) {
        let plan = self.setup.plan();
        let drives = plan.drives().iter();
        let brackets: Vec<(HarmonicDrive, [Point; 3])> = drives
            .flat_map(|drive| {
                let found = peak::brackets(&curve_of(&outcome.records, drive));
                found.into_iter().map(move |bracket| (*drive, bracket))
            })
            .collect();
        progress.locating_peaks(brackets.len());
        for (drive, bracket) in &brackets {
            let losses = |omegas: &[f64]| self.losses_at(drive, omegas);
            match peak::refine(bracket, &losses) {
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
    }

    /// Solves these cases in parallel, the dearest first: each thread takes the next from a common counter, so that the
    /// uneven cases end together.
    fn solve(&self, cases: &[Case], finish: &Finish<'_>) -> Result<Vec<CaseRecord>, StoreError> {
        let Self {
            pool,
            setup,
            interrupt,
        } = self;
        let mut order: Vec<&Case> = cases.iter().collect();
        let cost = |case: &Case| setup.predicted_cycles(case);
        order.sort_by(|a, b| cost(b).total_cmp(&cost(a)).then(a.index.cmp(&b.index)));
        let next = AtomicUsize::new(0);
        let failure: Mutex<Option<StoreError>> = Mutex::new(None);
        let stop = AtomicBool::new(false);
        let parts: Vec<Vec<CaseRecord>> = pool.broadcast(|_| {
            let mut done = Vec::new();
            while !stop.load(Ordering::Relaxed) && !interrupt.load(Ordering::Relaxed) {
                let Some(case) = order.get(next.fetch_add(1, Ordering::Relaxed)) else {
                    break;
                };
                let Some(record) = setup.run(case, interrupt) else {
                    break;
                };
                if let Err(error) = finish(&record) {
                    stop.store(true, Ordering::Relaxed);
                    if let Ok(mut slot) = failure.lock() {
                        slot.get_or_insert(error);
                    }
                    break;
                }
                done.push(record);
            }
            done
        });
        if let Some(error) = failure.into_inner().ok().flatten() {
            return Err(error);
        }
        let mut records: Vec<CaseRecord> = parts.into_iter().flatten().collect();
        records.sort_by_key(|r| r.index);
        Ok(records)
    }

    /// Losses at frequencies between the samples, for the peak search.
    fn losses_at(&self, drive: &HarmonicDrive, omegas: &[f64]) -> Result<Vec<Loss>, PeakError> {
        let case = |(index, omega): (usize, &f64)| Case {
            index,
            angular_frequency_rad_per_s: *omega,
            drive: *drive,
        };
        let cases: Vec<Case> = omegas.iter().enumerate().map(case).collect();
        let records = self
            .solve(&cases, &|_| Ok(()))
            .map_err(|_| PeakError::Interrupted)?;
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
