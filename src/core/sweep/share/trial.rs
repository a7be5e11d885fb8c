//! Some cases of a sweep solved as a trial, so that what the sweep costs is predicted from what cases cost.

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use crate::drive::Control;
use crate::engine::EngineKind;
use crate::sweep::case::{Aim, Resolution, Setup, SetupError, accuracy};
use crate::sweep::plan::Condition;
use crate::sweep::share::cost;
use crate::sweep::store::entry;

/// Trials end after this time, whole cases each.
const LONGEST: Duration = Duration::from_millis(1500);
/// Cases that are tried, evenly spread over the sweep.
const CASES: usize = 25;
/// A case that is predicted to take longer (s) is tried on fewer cells.
const LONG_S: f64 = 0.4;
/// Cells on which it is then tried.
const FEW_CELLS: usize = 32;
/// Losses that locating a peak takes.
const LOSSES_OF_A_PEAK: f64 = 10.0;

/// What the trials showed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trial {
    /// Time of the tried cases relative to what was predicted from steps alone.
    pub factor: f64,
    /// Time of one loss to locate a peak relative to that of a case.
    pub loss: f64,
    /// Bytes of a record.
    pub record_bytes: u64,
}

impl Trial {
    /// Nothing was tried.
    const NONE: Self = Self {
        factor: 1.0,
        loss: 0.3,
        record_bytes: 9_000,
    };

    /// Tries some cases of a sweep.
    ///
    /// # Errors
    /// As [`Setup::new`].
    pub fn of(setup: &Setup, predicted_s: &[f64]) -> Result<Self, SetupError> {
        let longest_s = predicted_s.iter().copied().fold(0.0, f64::max);
        if longest_s <= LONG_S {
            return Ok(Self::run(setup, predicted_s));
        }
        let plan = setup.plan();
        let has_fewer = plan.solver.engine == EngineKind::HalfSpace
            && plan.base.contact.indenter.own_cells().is_none()
            && plan.solver.cells > FEW_CELLS;
        if !has_fewer {
            return Ok(Self::NONE);
        }
        let mut fewer = plan.clone();
        fewer.solver.cells = FEW_CELLS;
        let fewer = Setup::new(fewer)?;
        let predicted_s = cost::predicted(&fewer)?.1;
        Ok(Self::run(&fewer, &predicted_s))
    }

    fn run(setup: &Setup, predicted_s: &[f64]) -> Self {
        let cases = setup.plan().cases();
        let interrupt = AtomicBool::new(false);
        let begun = Instant::now();
        let (mut taken_s, mut expected_s) = (0.0, 0.0);
        let mut trial = Self::NONE;
        let most = CASES.min(cases.len());
        for k in 0..most {
            let place = match most {
                1 => 0,
                most => k * (cases.len() - 1) / (most - 1),
            };
            let (Some(case), Some(predicted_s)) = (cases.get(place), predicted_s.get(place)) else {
                break;
            };
            let clock = Instant::now();
            let Some(record) = setup.run(case, &interrupt) else {
                break;
            };
            taken_s += clock.elapsed().as_secs_f64();
            expected_s += predicted_s;
            if let Ok(encoded) = entry::encoded(&record, true) {
                trial.record_bytes = encoded.len() as u64;
            }
            if k == most / 2 {
                let own_s = clock.elapsed().as_secs_f64();
                let at = Resolution::of(&record);
                let clock = Instant::now();
                setup.run_for(Aim::loss(at), None, case, &interrupt);
                trial.loss = clock.elapsed().as_secs_f64() / own_s;
            }
            if begun.elapsed() > LONGEST {
                break;
            }
        }
        if expected_s > 0.0 && taken_s > 0.0 {
            trial.factor = taken_s / expected_s;
        }
        trial
    }
}

/// The sweep at the resolution that its accuracy is predicted to take, from the errors of its middle case on few nodes; `None` where
/// no accuracy is asked for.
///
/// # Errors
/// As [`Setup::new`].
pub(super) fn at_accuracy(setup: &Setup) -> Result<Option<Setup>, SetupError> {
    /// Nodes on which the choice of a resolution begins.
    const FIRST_NODES: usize = 64;
    let mut plan = setup.plan().clone();
    let Some(accuracy) = plan.cycle.accuracy.take() else {
        return Ok(None);
    };
    plan.cycle.tolerance = plan.cycle.tolerance.min(0.1 * accuracy);
    plan.cycle.error_bars = true;
    let cases = plan.cases();
    let middle = cases.get(cases.len() / 2);
    let is_free = plan.base.contact.indenter.own_cells().is_none();
    if let Some(case) = middle.filter(|_| is_free) {
        plan.solver = plan.solver.with_nodes(FIRST_NODES);
        let record = Setup::new(plan.clone())?.run(case, &AtomicBool::new(false));
        let finer = record.and_then(|record| accuracy::next_resolution(&record, accuracy));
        if let Some(finer) = finer {
            plan.cycle.steps = finer.steps;
            plan.solver = plan.solver.with_nodes(finer.nodes);
        }
    }
    Setup::new(plan).map(Some)
}

/// Losses that locating all peaks takes: the loss follows the loss compliance, or under a prescribed approach the loss modulus, and
/// has a peak between the frequencies of the sweep wherever that has one.
pub(super) fn losses_of_peaks(setup: &Setup) -> f64 {
    let omegas = &setup.plan().angular_frequencies_rad_per_s;
    let of_condition = |condition: &Condition| {
        let Ok(solid) = setup.solid(condition) else {
            return 0;
        };
        let loss = |omega: &f64| match condition.drive.control() {
            Control::Load => -solid.compliance.complex_compliance(*omega).im,
            Control::Approach => solid.compliance.complex_modulus(*omega).im,
        };
        let losses: Vec<f64> = omegas.iter().map(loss).collect();
        let tops = losses.windows(3).filter(|w| w[1] > w[0] && w[1] >= w[2]);
        tops.count()
    };
    let peaks: usize = setup.plan().conditions().iter().map(of_condition).sum();
    LOSSES_OF_A_PEAK * peaks as f64
}
