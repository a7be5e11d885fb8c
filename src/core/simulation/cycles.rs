//! The sine segments of a history cycle by cycle: the numbers that a stabilised cycle has, of each cycle on the way to it.
//!
//! A cycle of a history does not close. The straight line through its two ends is taken off load and approach
//! ([`crate::cycle::analyse_open`]): what is left is the loop that an experimenter sees once a steady drift is taken off.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::cycle::{self, LoopAnalysis};
use crate::drive::Segment;
use crate::simulation::HistoryRow;
use crate::simulation::between::{self, SAME};
use crate::simulation::errors::Plan;
use crate::simulation::scenario::ScenarioPlan;

/// One cycle of one sine segment.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct HistoryCycle {
    /// The segment of the drive, and the cycle within it, both counted from 1.
    pub segment: usize,
    pub number: usize,
    /// When it begins, from the beginning of the history (s).
    pub start_s: f64,
    pub angular_frequency_rad_per_s: f64,
    /// `None` where the approach is undefined for a part of it, or its rows are too few.
    pub numbers: Option<CycleNumbers>,
    pub errors: CycleErrors,
}

/// What a cycle comes to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CycleNumbers {
    /// Of the closed loop.
    pub analysis: LoopAnalysis,
    /// What has been taken off: load (N) and approach (m) at the end less those at the beginning.
    pub load_change_n: f64,
    pub approach_change_m: f64,
    pub mean_contact_radius_m: f64,
    /// E' and E'' (Pa); `None` for a contact that is no disk, or none at all.
    pub moduli_pa: Option<(f64, f64)>,
}

/// Estimated errors, absolute; `None` where they were not asked for or could not be estimated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct CycleErrors {
    pub energy_loss_j: Option<f64>,
    pub phase_lag_rad: Option<f64>,
    pub storage_modulus_pa: Option<f64>,
    pub loss_modulus_pa: Option<f64>,
}

/// Uniform samples of a cycle.
const SAMPLES: usize = 200;
/// Rows that a cycle must have: fewer do not show its third harmonic.
const FEWEST_ROWS: usize = 12;

/// Every whole cycle of every sine segment, as far as the rows go.
pub fn in_rows(plan: &ScenarioPlan, rows: &[HistoryRow]) -> Vec<HistoryCycle> {
    let segments = plan.drive.segments().iter().enumerate();
    segments
        .flat_map(|(index, segment)| match segment {
            Segment::Sine {
                angular_frequency_rad_per_s,
                cycles,
                ..
            } => in_segment(plan, rows, index, (*angular_frequency_rad_per_s, *cycles)),
            _ => Vec::new(),
        })
        .collect()
}

/// Adds the errors that the same cycles at coarser resolutions tell.
pub(super) fn add_errors(cycles: &mut [HistoryCycle], coarser: &[Vec<HistoryCycle>], plan: &Plan) {
    type Value = fn(&CycleNumbers) -> Option<f64>;
    for (place, cycle) in cycles.iter_mut().enumerate() {
        let error = |value: Value| {
            let own = cycle.numbers.as_ref().and_then(value);
            let of = |cycles: &Vec<HistoryCycle>| value(cycles.get(place)?.numbers.as_ref()?);
            let values: Vec<_> = [own].into_iter().chain(coarser.iter().map(of)).collect();
            plan.error_of_whole(&values)
        };
        let errors = CycleErrors {
            energy_loss_j: error(|n| Some(n.analysis.energy_loss_j)),
            phase_lag_rad: error(|n| Some(n.analysis.phase_lag_rad)),
            storage_modulus_pa: error(|n| n.moduli_pa.map(|m| m.0)),
            loss_modulus_pa: error(|n| n.moduli_pa.map(|m| m.1)),
        };
        cycle.errors = errors;
    }
}

fn in_segment(
    plan: &ScenarioPlan,
    rows: &[HistoryRow],
    segment: usize,
    (angular_frequency_rad_per_s, cycles): (f64, f64),
) -> Vec<HistoryCycle> {
    let period_s = TAU / angular_frequency_rad_per_s;
    let Some(first_s) = plan.drive.start_s(segment) else {
        return Vec::new();
    };
    let whole = (cycles + SAME).floor() as usize;
    (1..=whole)
        .map_while(|number| {
            let start_s = first_s + (number - 1) as f64 * period_s;
            let rows = between::within(rows, start_s, period_s)?;
            Some(HistoryCycle {
                segment: segment + 1,
                number,
                start_s,
                angular_frequency_rad_per_s,
                numbers: numbers(plan, rows, start_s, period_s),
                errors: CycleErrors::default(),
            })
        })
        .collect()
}

fn numbers(
    plan: &ScenarioPlan,
    rows: &[HistoryRow],
    start_s: f64,
    period_s: f64,
) -> Option<CycleNumbers> {
    if rows.len() < FEWEST_ROWS {
        return None;
    }
    let times: Vec<f64> = rows.iter().map(|row| row.time_s).collect();
    let sampled = |value: fn(&HistoryRow) -> Option<f64>| -> Option<Vec<f64>> {
        let values: Vec<f64> = rows.iter().map(value).collect::<Option<_>>()?;
        let at = |k: usize| start_s + period_s * k as f64 / SAMPLES as f64;
        let samples = (0..=SAMPLES).map(|k| between::cubic(&times, &values, at(k)));
        Some(samples.collect())
    };
    let load_n = sampled(|row| Some(row.load_n))?;
    let approach_m = sampled(|row| row.approach_m)?;
    let radii = sampled(|row| Some(row.contact_radius_m))?;
    let analysis = cycle::analyse_open(&load_n, &approach_m).ok()?;
    let mean_contact_radius_m = radii.iter().skip(1).sum::<f64>() / SAMPLES as f64;
    let change = |samples: &[f64]| samples[SAMPLES] - samples[0];
    // Only of a disk the radius by its area is the one by its stiffness.
    let is_disk = plan.contact.indenter.axisymmetric().is_some();
    let moduli_pa = is_disk.then(|| {
        let nu = plan.contact.material.poisson_ratio().unwrap_or(0.0);
        let moduli = analysis.equivalent_moduli_pa(mean_contact_radius_m, nu)?;
        Some(match plan.contact.material.series() {
            Some(material) => material.of_loop(moduli, TAU / period_s),
            None => moduli,
        })
    });
    Some(CycleNumbers {
        load_change_n: change(&load_n),
        approach_change_m: change(&approach_m),
        mean_contact_radius_m,
        moduli_pa: moduli_pa.flatten(),
        analysis,
    })
}
