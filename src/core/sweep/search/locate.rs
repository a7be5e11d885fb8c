//! Peaks of the curves that a sweep has sampled: bracketed by its cases, then located by solving between them. A bracket of more
//! than a decade may hold several, all of which are located.

use rayon::prelude::*;

use crate::sweep::case::{Aim, Resolution};
use crate::sweep::plan::{Case, Condition};
use crate::sweep::record::CaseRecord;
use crate::sweep::search::peak::{self, Loss, Peak, PeakError, Point};
use crate::sweep::search::replica_peaks;
use crate::sweep::search::run::{Mode, Outcome};
use crate::sweep::search::{Search, by_condition};
use crate::sweep::store::StoreError;

/// Why a peak that the cases bracket has no place.
#[derive(Debug, thiserror::Error)]
enum LocateError {
    #[error(transparent)]
    Peak(#[from] PeakError),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error("interrupted")]
    Interrupted,
    #[error(
        "losses near {angular_frequency_rad_per_s:.4e} rad/s that it takes have no record in {folder}, and none is computed \
         here: `contact-dma sweep FILE --out {folder}` with the file of this sweep computes them"
    )]
    NoRecords {
        angular_frequency_rad_per_s: f64,
        folder: String,
    },
}

impl Search<'_> {
    /// Locates the peaks of every curve; false where it was interrupted. Where nothing is solved, a peak whose losses have no
    /// records is a peak that was not located.
    pub fn locate_peaks(&self, outcome: &mut Outcome) -> Result<bool, StoreError> {
        let plan = self.setup.plan();
        let conditions = plan.conditions();
        let curves = by_condition(&outcome.records, conditions);
        let brackets: Vec<(Bracket, &[CaseRecord])> = curves
            .flat_map(|(condition, of_curve)| {
                let brackets = Bracket::of_curve(of_curve, condition).into_iter();
                brackets.map(move |bracket| (bracket, of_curve))
            })
            .collect();
        self.progress.locating_peaks(brackets.len());
        let refine = |bracket: &Bracket, alone: bool| {
            let losses = |omegas: &[f64]| self.losses_at(bracket, omegas, alone);
            match peak::brackets_within(&bracket.points, &losses) {
                Ok(within) => (within.iter())
                    .map(|points| peak::refine(points, &losses))
                    .collect(),
                Err(error) => vec![Err(error)],
            }
        };
        // A thread for each bracket, or all threads for each of a few.
        let found: Vec<Vec<Result<Peak, LocateError>>> =
            match brackets.len() < self.pool.current_num_threads() {
                true => brackets.iter().map(|(b, _)| refine(b, false)).collect(),
                false => (self.pool)
                    .install(|| brackets.par_iter().map(|(b, _)| refine(b, true)).collect()),
            };
        let mut whole = true;
        let found = brackets.iter().zip(found);
        let found = found.flat_map(|(bracket, found)| found.into_iter().map(move |f| (bracket, f)));
        for ((bracket, of_curve), found) in found {
            match found {
                Ok(mut found) => {
                    let condition = &bracket.condition;
                    if plan.axes.is_some() {
                        found.varied = condition.values;
                        found.drive_mean = Some(condition.drive.mean());
                        found.drive_amplitude = Some(condition.drive.amplitude());
                    }
                    replica_peaks::add_errors(&mut found, of_curve);
                    outcome.peaks.push(found);
                }
                Err(LocateError::Store(error)) => return Err(error),
                Err(LocateError::Interrupted) => whole = false,
                Err(error @ (LocateError::Peak(_) | LocateError::NoRecords { .. })) => {
                    outcome.peak_problems.push(error.to_string());
                }
            }
        }
        (outcome.peaks).sort_by(|a, b| b.energy_loss_j.total_cmp(&a.energy_loss_j));
        Ok(whole)
    }

    /// Losses at frequencies inside a bracket, computed on this thread alone or on all.
    fn losses_at(
        &self,
        bracket: &Bracket,
        omegas: &[f64],
        alone: bool,
    ) -> Result<Vec<Loss>, LocateError> {
        let case = |(index, omega): (usize, &f64)| Case {
            index,
            angular_frequency_rad_per_s: *omega,
            condition: bracket.condition.clone(),
        };
        let cases: Vec<Case> = omegas.iter().enumerate().map(case).collect();
        let aim = Aim::loss(bracket.resolution);
        let mut records = self.records_of(aim, &cases, alone, &|_| ())?;
        if records.len() < omegas.len() {
            return Err(match (self.mode, self.archive.store()) {
                (Mode::Read, Some(store)) => LocateError::NoRecords {
                    angular_frequency_rad_per_s: bracket.points[1].0,
                    folder: store.folder().display().to_string(),
                },
                _ => LocateError::Interrupted,
            });
        }
        records.sort_by_key(|record| record.index);
        let loss = |record: &CaseRecord| {
            let angular_frequency_rad_per_s = record.angular_frequency_rad_per_s;
            let loss_j = record.energy_loss_j().ok_or_else(|| PeakError::Case {
                angular_frequency_rad_per_s,
                reason: record.message.clone().unwrap_or_default(),
            })?;
            let relative = bracket.relative_error_at(angular_frequency_rad_per_s);
            Ok((loss_j, relative.map(|error| error * loss_j.abs())))
        };
        records.iter().map(loss).collect()
    }
}

/// Three neighbouring cases of one curve, the middle one with the largest loss.
///
/// All losses inside are computed at the resolution of the middle case, so that they have one and the same error of
/// discretisation, which then hardly moves their maximum; that error is read between the three.
struct Bracket {
    condition: Condition,
    points: [Point; 3],
    resolution: Resolution,
    /// Relative errors of the three losses, where all have one.
    relative_errors: Option<[f64; 3]>,
}

impl Bracket {
    fn of_curve(records: &[CaseRecord], condition: &Condition) -> Vec<Self> {
        let at = |omega: f64| (records.iter()).find(|r| r.angular_frequency_rad_per_s == omega);
        let relative = |point: &Point| {
            let error_j = at(point.0)?.energy_loss_error_j()?;
            (point.1 != 0.0).then(|| (error_j / point.1).abs())
        };
        peak::brackets(&curve_of(records))
            .into_iter()
            .filter_map(|points| {
                let [a, b, c] = points.each_ref().map(relative);
                let middle = at(points[1].0)?;
                Some(Self {
                    condition: condition.clone(),
                    points,
                    resolution: Resolution::of(middle),
                    relative_errors: a.zip(b).zip(c).map(|((a, b), c)| [a, b, c]),
                })
            })
            .collect()
    }

    /// Relative error of the loss at a frequency inside, linear in its logarithm between the three cases.
    fn relative_error_at(&self, omega: f64) -> Option<f64> {
        let errors = self.relative_errors?;
        let at = |i: usize| (self.points[i].0, errors[i]);
        let ((from, first), (to, last)) = match omega < self.points[1].0 {
            true => (at(0), at(1)),
            false => (at(1), at(2)),
        };
        let fraction = ((omega / from).ln() / (to / from).ln()).clamp(0.0, 1.0);
        Some(first + fraction * (last - first))
    }
}

/// Loss over frequency, of the records of one curve in ascending frequency.
pub(crate) fn curve_of(records: &[CaseRecord]) -> Vec<Point> {
    let points = records.iter();
    points
        .filter_map(|r| Some((r.angular_frequency_rad_per_s, r.energy_loss_j()?)))
        .collect()
}
