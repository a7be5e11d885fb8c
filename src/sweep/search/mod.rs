//! The work behind a sweep: cases that have records are read, the others solved in parallel, frequencies added where the
//! curve is not resolved.

pub mod builder;
mod locate;
pub mod peak;
pub mod refine;
mod replica_peaks;
pub mod run;

use std::collections::HashMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use rayon::ThreadPool;

use crate::sweep::case::checkpoint::Checkpoints;
use crate::sweep::case::{Aim, Setup};
use crate::sweep::plan::{AxisValues, Case, Condition};
use crate::sweep::record::CaseRecord;
use crate::sweep::search::locate::curve_of;
use crate::sweep::search::run::{Outcome, Progress, RunError};
use crate::sweep::store::StoreError;
use crate::sweep::store::archive::{Archive, Kept, OF_ANOTHER_BUILD, Purpose};

/// What solving more cases takes.
pub(in crate::sweep) struct Search<'a> {
    pub pool: &'a ThreadPool,
    pub setup: &'a Setup,
    pub archive: Archive<'a>,
    pub missing: Missing,
    pub interrupt: &'a AtomicBool,
    pub progress: &'a dyn Progress,
    /// Where nothing is solved: whether it was said that records of another build are drawn.
    told_of_builds: AtomicBool,
}

/// What becomes of cases that have no usable record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::sweep) enum Missing {
    /// They are solved, those that take long with a checkpoint every so often.
    Solved { checkpoint_every: Duration },
    /// Nothing is solved.
    LeftOut,
}

/// How often a neighbourhood may be halved before it is left as it is.
const REFINEMENTS: usize = 6;

impl<'a> Search<'a> {
    pub fn new(
        pool: &'a ThreadPool,
        setup: &'a Setup,
        archive: Archive<'a>,
        missing: Missing,
        (interrupt, progress): (&'a AtomicBool, &'a dyn Progress),
    ) -> Self {
        Self {
            pool,
            setup,
            archive,
            missing,
            interrupt,
            progress,
            told_of_builds: AtomicBool::new(false),
        }
    }

    /// The records of cases of the sweep, and how many of these have none in the end.
    pub fn planned(&self, cases: &[Case]) -> Result<(Vec<CaseRecord>, usize), StoreError> {
        let (mut records, lacking) = self.known(Purpose::Sweep, cases)?;
        if !records.is_empty() {
            self.progress.cases_found(records.len(), cases.len());
        }
        records.extend(self.compute(Aim::Plan, &lacking)?);
        records.sort_by_key(|r| r.index);
        let missing = cases.len() - records.len();
        Ok((records, missing))
    }

    /// What is left to do once the cases planned have records: refinement, order, peaks.
    pub fn outcome(
        &self,
        mut records: Vec<CaseRecord>,
        mut interrupted: bool,
    ) -> Result<Outcome, RunError> {
        let plan = self.setup.plan();
        if plan.refine && !interrupted {
            interrupted = self.refine(&mut records)?;
        }
        sort(&mut records, &plan.conditions());
        let mut outcome = Outcome {
            interrupted,
            records,
            peaks: Vec::new(),
            peak_problems: Vec::new(),
        };
        if !outcome.interrupted {
            outcome.interrupted = !self.locate_peaks(&mut outcome)?;
        }
        // Where nothing is solved, another process may be at work in the folder.
        if self.missing != Missing::LeftOut
            && !outcome.interrupted
            && let Some(store) = self.archive.store()
        {
            store.remove_checkpoints();
        }
        Ok(outcome)
    }

    /// Adds frequencies where the records do not resolve their curve; says whether it was interrupted.
    fn refine(&self, records: &mut Vec<CaseRecord>) -> Result<bool, StoreError> {
        let conditions = self.setup.plan().conditions();
        for _ in 0..REFINEMENTS {
            let mut added = Vec::new();
            sort(records, &conditions);
            for (condition, of_curve) in by_condition(records, &conditions) {
                for omega in refine::candidates(&curve_of(of_curve)) {
                    added.push(Case {
                        index: records.len() + added.len(),
                        angular_frequency_rad_per_s: omega,
                        condition: condition.clone(),
                    });
                }
            }
            if added.is_empty() {
                break;
            }
            let more = self.records_of(Aim::Plan, &added)?;
            let interrupted = more.len() < added.len();
            records.extend(more);
            if interrupted {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The records of these cases, solved where there are none; fewer after an interruption.
    pub fn records_of(&self, aim: Aim, cases: &[Case]) -> Result<Vec<CaseRecord>, StoreError> {
        let (mut records, lacking) = self.known(aim.purpose(), cases)?;
        records.extend(self.compute(aim, &lacking)?);
        records.sort_by_key(|r| r.index);
        Ok(records)
    }

    /// The same, solved one after another on this thread: for what many threads do at once.
    pub fn records_here(&self, aim: Aim, cases: &[Case]) -> Result<Vec<CaseRecord>, StoreError> {
        let (mut records, lacking) = self.known(aim.purpose(), cases)?;
        if let Missing::Solved { checkpoint_every } = self.missing {
            for case in &lacking {
                match self.compute_one(aim, case, checkpoint_every)? {
                    Some(record) if !self.interrupt.load(Ordering::Relaxed) => records.push(record),
                    _ => break,
                }
            }
        }
        records.sort_by_key(|r| r.index);
        Ok(records)
    }

    /// The usable records of these cases, and the cases that have none.
    pub fn known(
        &self,
        purpose: Purpose,
        cases: &[Case],
    ) -> Result<(Vec<CaseRecord>, Vec<Case>), StoreError> {
        for unread in self.archive.look()? {
            let path = unread.path.display();
            self.progress.told(&format!("{path}: {}", unread.reason));
        }
        let (mut records, mut lacking) = (Vec::new(), Vec::new());
        for case in cases {
            match self.archive.load_case(purpose, case)? {
                Kept::Intact(record) => records.push(*record),
                Kept::Absent => lacking.push(case.clone()),
                Kept::OfAnotherBuild { path, record } if self.missing == Missing::LeftOut => {
                    if !self.told_of_builds.swap(true, Ordering::Relaxed) {
                        let path = path.display();
                        self.progress.told(&format!(
                            "{path}: {OF_ANOTHER_BUILD}; it and those like it are shown as they are"
                        ));
                    }
                    records.push(*record);
                }
                Kept::OfAnotherBuild { path, .. } => {
                    self.lacks(&path, OF_ANOTHER_BUILD);
                    lacking.push(case.clone());
                }
                Kept::Unusable { path, reason } => {
                    self.lacks(&path, &reason);
                    lacking.push(case.clone());
                }
            }
        }
        for record in &mut records {
            self.hold_cycle(purpose, record)?;
        }
        Ok((records, lacking))
    }

    /// Gives a record that was read its cycle, where the outcome holds them.
    fn hold_cycle(&self, purpose: Purpose, record: &mut CaseRecord) -> Result<(), StoreError> {
        match self.archive.store() {
            Some(store) if purpose == Purpose::Sweep && self.holds_cycles() => {
                store.load_cycle(record)
            }
            _ => Ok(()),
        }
    }

    /// Whether the outcome holds the cycles of all cases; of a large sweep in a folder they stay there.
    fn holds_cycles(&self) -> bool {
        self.archive.store().is_none() || self.setup.plan().is_small()
    }

    /// Tells why a record is not used.
    fn lacks(&self, path: &Path, reason: &str) {
        let then = match self.missing {
            Missing::Solved { .. } => "the case is computed again",
            Missing::LeftOut => "the case is left out",
        };
        let path = path.display();
        self.progress.told(&format!("{path}: {reason}; {then}"));
    }

    /// Solves these cases in parallel, the dearest first: each thread takes the next from a common counter, so that the
    /// uneven cases end together.
    fn compute(&self, aim: Aim, cases: &[Case]) -> Result<Vec<CaseRecord>, StoreError> {
        let Missing::Solved { checkpoint_every } = self.missing else {
            return Ok(Vec::new());
        };
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
                match self.compute_one(aim, case, checkpoint_every) {
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
    fn compute_one(
        &self,
        aim: Aim,
        case: &Case,
        every: Duration,
    ) -> Result<Option<CaseRecord>, StoreError> {
        let purpose = aim.purpose();
        let record = match self.archive.load_case(purpose, case)? {
            Kept::Intact(mut record) => {
                self.hold_cycle(purpose, &mut record)?;
                *record
            }
            Kept::Absent | Kept::OfAnotherBuild { .. } | Kept::Unusable { .. } => {
                let checkpoints = match self.archive.store() {
                    Some(store) => Checkpoints::of(store, purpose, case, every),
                    None => Checkpoints::none(),
                };
                let found = (self.setup).run_for(aim, &checkpoints, case, self.interrupt);
                let Some(record) = found else {
                    return Ok(None);
                };
                self.archive.save_case(purpose, case, &record)?;
                checkpoints.remove();
                match self.holds_cycles() {
                    true => record,
                    false => record.without_cycle(),
                }
            }
        };
        if purpose == Purpose::Sweep {
            self.progress.case_finished(&record);
        }
        Ok(Some(record))
    }
}

/// Curve after curve in the order of the conditions, each in ascending frequency.
fn sort(records: &mut [CaseRecord], conditions: &[Condition]) {
    let bits = |values: AxisValues, drive: [f64; 2]| {
        let numbers = values.all().iter().copied().chain(drive);
        numbers.map(f64::to_bits).collect::<Vec<_>>()
    };
    let of_condition = |c: &Condition| bits(c.values, [c.drive.mean(), c.drive.amplitude()]);
    let places = conditions.iter().map(of_condition).zip(0..);
    let places: HashMap<Vec<u64>, usize> = places.collect();
    records.sort_by_cached_key(|r| {
        let place = places.get(&bits(r.varied, [r.drive_mean, r.drive_amplitude]));
        // Positive numbers are in the order of their bits.
        (place.copied(), r.angular_frequency_rad_per_s.to_bits())
    });
}

/// The records of each condition, of records that are [sorted](sort).
fn by_condition<'a>(
    records: &'a [CaseRecord],
    conditions: &'a [Condition],
) -> impl Iterator<Item = (&'a Condition, &'a [CaseRecord])> {
    let mut rest = records;
    conditions.iter().map(move |condition| {
        let count = rest.iter().take_while(|r| r.is_of(condition)).count();
        let (own, others) = rest.split_at(count);
        rest = others;
        (condition, own)
    })
}
