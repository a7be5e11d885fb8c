//! The work behind a sweep: cases that have records are read, the others solved in parallel, frequencies added where the
//! curve is not resolved.

pub mod builder;
mod locate;
pub mod peak;
pub mod refine;
mod replica_peaks;
pub mod run;

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rayon::ThreadPool;
use rayon::prelude::*;

use crate::sweep::case::checkpoint::Checkpoints;
use crate::sweep::case::{Aim, Setup};
use crate::sweep::plan::{AxisValues, Case, Condition};
use crate::sweep::record::CaseRecord;
use crate::sweep::search::locate::curve_of;
use crate::sweep::search::run::{Mode, Outcome, Progress};
use crate::sweep::share::shard::{self, Shard};
use crate::sweep::store::entry::Purpose;
use crate::sweep::store::{Archive, StoreError};

/// What solving more cases takes.
pub(crate) struct Search<'a> {
    pub pool: ThreadPool,
    pub setup: &'a Setup,
    pub archive: &'a dyn Archive,
    pub mode: Mode,
    pub interrupt: &'a AtomicBool,
    pub progress: &'a dyn Progress,
    /// Where nothing is solved: whether it was reported that records of another build are drawn.
    reported_builds: AtomicBool,
}

/// How often a neighbourhood may be halved before it is left as it is.
const REFINEMENTS: usize = 6;

impl Search<'_> {
    /// The cases of the sweep or of a shard of it; once all of the sweep have records, refinement and peaks too.
    pub fn outcome(&self, shard: Option<Shard>) -> Result<Outcome, StoreError> {
        let plan = self.setup.plan();
        let all = plan.cases();
        let of_shard = shard.map(|shard| shard::cases(self.setup, shard));
        let own = of_shard.as_deref().unwrap_or(&all);
        let mut records = self.records_of(Aim::PLAN, own, false, &|found| {
            if found > 0 && self.mode != Mode::Read {
                self.progress.cases_found(found, own.len());
            }
        })?;
        let mut missing = own.len() - records.len();
        let mut interrupted = missing > 0;
        if of_shard.is_some() && !interrupted {
            let (found, lacking) = self.known(Purpose::Sweep, &all)?;
            missing = lacking.len();
            if missing == 0 {
                records = found;
            }
        }
        if missing == 0 && plan.refine {
            interrupted = self.refine(&mut records)?;
        }
        sort(&mut records, plan.conditions());
        let mut outcome = Outcome {
            records,
            missing,
            interrupted,
            peaks: Vec::new(),
            peak_problems: Vec::new(),
        };
        if missing == 0 && !interrupted {
            outcome.interrupted = !self.locate_peaks(&mut outcome)?;
            // Where nothing is solved, another process may be at work in the folder.
            if self.mode != Mode::Read
                && !outcome.interrupted
                && let Some(store) = self.archive.store()
            {
                store.remove_checkpoints("");
            }
        }
        self.archive.records().sync()?;
        Ok(outcome)
    }

    /// Adds frequencies where the records do not resolve their curve; says whether it was interrupted.
    fn refine(&self, records: &mut Vec<CaseRecord>) -> Result<bool, StoreError> {
        let conditions = self.setup.plan().conditions();
        for _ in 0..REFINEMENTS {
            let mut added = Vec::new();
            sort(records, conditions);
            for (condition, of_curve) in by_condition(records, conditions) {
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
            let more = self.records_of(Aim::PLAN, &added, false, &|found| {
                self.progress.cases_added(added.len(), found);
            })?;
            let interrupted = more.len() < added.len();
            records.extend(more);
            if interrupted {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The records of these cases, solved where there are none, by all threads or on this one alone: for what many threads do at
    /// once. Fewer after an interruption. `found` is called with how many there are already.
    pub fn records_of(
        &self,
        aim: Aim,
        cases: &[Case],
        alone: bool,
        found: &dyn Fn(usize),
    ) -> Result<Vec<CaseRecord>, StoreError> {
        let (mut records, lacking) = self.known(aim.purpose(), cases)?;
        found(records.len());
        records.extend(self.compute(aim, &lacking, alone)?);
        Ok(records)
    }

    /// The usable records of these cases, and the cases that have none.
    pub fn known(
        &self,
        purpose: Purpose,
        cases: &[Case],
    ) -> Result<(Vec<CaseRecord>, Vec<Case>), StoreError> {
        // Losses at peaks are nobody else's.
        if purpose == Purpose::Sweep {
            for unread in self.archive.records().look()? {
                self.progress.notice(&unread);
            }
        }
        let then = match self.mode {
            Mode::Solve { .. } => "the case is computed again",
            Mode::Read => "the case is left out",
        };
        let with_cycle = purpose == Purpose::Sweep && self.holds_cycles();
        let (mut records, mut lacking) = (Vec::new(), Vec::new());
        for case in cases {
            let kept = self.archive.records().load(purpose, case, with_cycle)?;
            match (kept.record, kept.refusal) {
                (Some(record), None) => records.push(*record),
                (Some(record), Some(refusal)) if self.mode == Mode::Read => {
                    if !self.reported_builds.swap(true, Ordering::Relaxed) {
                        let shown = "it and those like it are shown as they are";
                        self.progress.notice(&format!("{refusal}; {shown}"));
                    }
                    records.push(*record);
                }
                (_, refusal) => {
                    if let Some(refusal) = refusal {
                        self.progress.notice(&format!("{refusal}; {then}"));
                    }
                    lacking.push(case.clone());
                }
            }
        }
        Ok((records, lacking))
    }

    /// Whether the outcome holds the cycles of all cases; of a large sweep in a folder they stay there.
    fn holds_cycles(&self) -> bool {
        self.archive.store().is_none() || self.setup.plan().is_small()
    }

    /// Solves these cases in parallel, the most expensive first: each thread takes the next of them, so that the uneven cases end
    /// together.
    fn compute(
        &self,
        aim: Aim,
        cases: &[Case],
        alone: bool,
    ) -> Result<Vec<CaseRecord>, StoreError> {
        let Mode::Solve {
            checkpoint_every, ..
        } = self.mode
        else {
            return Ok(Vec::new());
        };
        self.progress.solving();
        let mut order: Vec<&Case> = cases.iter().collect();
        let cost = |case: &Case| self.setup.predicted_cycles(case);
        order.sort_by(|a, b| cost(b).total_cmp(&cost(a)).then(a.index.cmp(&b.index)));
        let solve = |case: &Case| self.compute_one(aim, case, checkpoint_every).transpose();
        match alone {
            true => order.into_iter().map_while(solve).collect(),
            false => (self.pool).install(|| {
                let next = order.into_iter().par_bridge();
                next.map(solve).while_some().collect()
            }),
        }
    }

    /// Solves a case and stores its record; `None` where it was interrupted.
    fn compute_one(
        &self,
        aim: Aim,
        case: &Case,
        every: Duration,
    ) -> Result<Option<CaseRecord>, StoreError> {
        if self.interrupt.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let purpose = aim.purpose();
        let store = self.archive.store();
        let checkpoints = store.map(|store| Checkpoints::of(store, purpose, case, every));
        let checkpoints = checkpoints.as_ref();
        let Some(record) = (self.setup).run_for(aim, checkpoints, case, self.interrupt) else {
            return Ok(None);
        };
        if let Some(store) = store {
            store.check_plan()?;
        }
        self.archive.records().insert(purpose, case, &record)?;
        if let Some(checkpoints) = checkpoints {
            checkpoints.remove();
        }
        let record = match self.holds_cycles() {
            true => record,
            false => record.without_cycle(),
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
        let numbers = values.all().iter().map(|value| value.as_number());
        let numbers = numbers.chain(drive);
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
