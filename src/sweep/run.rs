//! The sweep itself: cases in parallel, the dearest first, each on disk before its thread takes the next; then the peaks.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::sweep::case::Setup;
use crate::sweep::peak::{self, Peak, PeakError, Point};
use crate::sweep::record::{CaseRecord, Status};
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
    /// Finished cases in ascending frequency; fewer than planned only after an interruption.
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

/// Files at the top of a sweep's folder that later runs replace.
pub const SUMMARY_FILES: [&str; 10] = [
    "sweep.csv",
    "summary.json",
    "energy-loss.csv",
    "energy-loss.svg",
    "energy-loss.png",
    "energy-loss@2x.png",
    "loops.csv",
    "loops.svg",
    "loops.png",
    "loops@2x.png",
];

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
    let frequencies = &setup.plan().angular_frequencies_rad_per_s;
    let records = solve_all(&pool, setup, frequencies, interrupt, &finish)?;
    let mut outcome = Outcome {
        interrupted: records.len() < frequencies.len(),
        records,
        peaks: Vec::new(),
        peak_problems: Vec::new(),
    };
    if !outcome.interrupted {
        let curve: Vec<Point> = outcome
            .records
            .iter()
            .filter_map(|r| Some((r.angular_frequency_rad_per_s, r.energy_loss_j()?)))
            .collect();
        let brackets = peak::brackets(&curve);
        progress.locating_peaks(brackets.len());
        for bracket in &brackets {
            let losses = |omegas: &[f64]| losses_at(&pool, setup, omegas, interrupt);
            match peak::refine(bracket, &losses) {
                Ok(found) => outcome.peaks.push(found),
                Err(error) => outcome.peak_problems.push(error.to_string()),
            }
        }
        let larger = |a: &Peak, b: &Peak| b.energy_loss_j.total_cmp(&a.energy_loss_j);
        outcome.peaks.sort_by(larger);
        outcome.interrupted = interrupt.load(Ordering::Relaxed);
    }
    Ok(outcome)
}

/// Solves these frequencies in parallel, the dearest first: each thread takes the next from a common counter, so that the
/// uneven cases end together.
fn solve_all(
    pool: &ThreadPool,
    setup: &Setup,
    omegas: &[f64],
    interrupt: &AtomicBool,
    finish: &(dyn Fn(&CaseRecord) -> Result<(), StoreError> + Sync),
) -> Result<Vec<CaseRecord>, StoreError> {
    let mut order: Vec<usize> = (0..omegas.len()).collect();
    let cost = |&i: &usize| setup.predicted_cycles(omegas[i]);
    order.sort_by(|a, b| cost(b).total_cmp(&cost(a)).then(a.cmp(b)));
    let next = AtomicUsize::new(0);
    let failure: Mutex<Option<StoreError>> = Mutex::new(None);
    let stop = AtomicBool::new(false);
    let parts: Vec<Vec<CaseRecord>> = pool.broadcast(|_| {
        let mut done = Vec::new();
        while !stop.load(Ordering::Relaxed) && !interrupt.load(Ordering::Relaxed) {
            let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) else {
                break;
            };
            let Some(record) = setup.run(index, omegas[index], interrupt) else {
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
fn losses_at(
    pool: &ThreadPool,
    setup: &Setup,
    omegas: &[f64],
    interrupt: &AtomicBool,
) -> Result<Vec<f64>, PeakError> {
    let records = solve_all(pool, setup, omegas, interrupt, &|_| Ok(()))
        .map_err(|_| PeakError::Interrupted)?;
    if records.len() < omegas.len() {
        return Err(PeakError::Interrupted);
    }
    let loss = |record: &CaseRecord| {
        record.energy_loss_j().ok_or_else(|| PeakError::Case {
            angular_frequency_rad_per_s: record.angular_frequency_rad_per_s,
            reason: record.message.clone().unwrap_or_default(),
        })
    };
    records.iter().map(loss).collect()
}

impl Outcome {
    /// Number of cases with this status.
    pub fn count(&self, status: Status) -> usize {
        self.records.iter().filter(|r| r.status == status).count()
    }
}
