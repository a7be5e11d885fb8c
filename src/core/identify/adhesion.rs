//! The attraction of the surfaces as further unknowns beside the series: work of adhesion, and the range as well.

use std::sync::atomic::AtomicBool;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::identify::fit::{
    EXACTLY, Exact, STEP, most_branches, on_linearised, refuse_contradiction,
};
use crate::identify::identified::{Identified, judged};
use crate::identify::model::Model;
use crate::identify::selection::Linearised;
use crate::identify::series::Point;
use crate::identify::{IdentifyError, IdentifyPlan};
use crate::numerics::levenberg_marquardt::{Problem, Solution, central_difference, minimise};

/// How far work and range may go from where they are sought, as logarithms: a factor of a thousand.
const FARTHEST: f64 = 6.9;

/// Series and attraction together as a least squares problem: logarithms of those of the series first.
struct Joint<'a> {
    plan: &'a IdentifyPlan,
    linearised: &'a Linearised<'a>,
    interrupt: &'a AtomicBool,
    corrections: Vec<f64>,
    /// Unknowns of the series, and where those of the attraction begin.
    of_series: usize,
    start: Vec<f64>,
}

impl Problem for Joint<'_> {
    type Unknowns = Vec<f64>;

    fn residuals(&self, unknowns: &Vec<f64>) -> Option<DVector<f64>> {
        let (series, attraction) = unknowns.split_at_checked(self.of_series)?;
        let (point, plan) = (Point(series.to_vec()), self.plan.attracted_by(attraction));
        let mut model = Model::new(&plan, self.interrupt);
        model.corrections.clone_from(&self.corrections);
        let exact = Exact {
            model: &model,
            linearised: self.linearised,
        };
        exact.residuals(&point)
    }

    fn derivatives(&self, unknowns: &Vec<f64>) -> Option<DMatrix<f64>> {
        let moved = (0..unknowns.len()).into_par_iter().map(|place| {
            central_difference(unknowns, place, STEP, &|moved| self.residuals(&moved))
        });
        let columns: Option<Vec<DVector<f64>>> = moved.collect();
        Some(DMatrix::from_columns(&columns?))
    }

    fn clamp(&self, place: usize, value: f64) -> f64 {
        match place.checked_sub(self.of_series) {
            None => self.linearised.limits.clamp(place, value),
            Some(place) => value.clamp(self.start[place] - FARTHEST, self.start[place] + FARTHEST),
        }
    }
}

/// Finds the material and the attraction, from the attraction that the plan says on.
///
/// # Errors
/// As [`crate::identify::identify`].
pub(super) fn identify(
    plan: &IdentifyPlan,
    interrupt: &AtomicBool,
) -> Result<Identified, IdentifyError> {
    let mut linearised = Linearised::new(plan)?;
    let most = most_branches(plan)?;
    let model = Model::new(plan, interrupt);
    let (candidates, chosen) = on_linearised(&model, &mut linearised, most, 1.0)?;
    let point = candidates[chosen].point.clone();
    let start = plan.sought_attraction();
    let mut joint = Joint {
        plan,
        linearised: &linearised,
        interrupt,
        corrections: Vec::new(),
        of_series: point.0.len(),
        start: start.clone(),
    };
    let refined = |joint: &Joint<'_>, from: &Vec<f64>| {
        let found = minimise(joint, from, EXACTLY);
        found.ok_or(IdentifyError::NoFit("the exact model failed at the start"))
    };
    let mut found = refined(&joint, &[&point.0[..], &start].concat())?;
    let (series, attraction) = found.unknowns.split_at(joint.of_series);
    let attracted = plan.attracted_by(attraction);
    let mut model = Model::new(&attracted, interrupt);
    match model.learn_corrections(&Point(series.to_vec()).relaxation()?) {
        Ok(Some(_)) => joint.corrections.clone_from(&model.corrections),
        Err(IdentifyError::Interrupted) => return Err(IdentifyError::Interrupted),
        Ok(None) | Err(_) => {}
    }
    found = refined(&joint, &found.unknowns)?;
    let derivatives = joint.derivatives(&found.unknowns);
    let derivatives = derivatives.ok_or(IdentifyError::NoFit(
        "the exact model has no derivatives there",
    ))?;
    let (series, attraction) = found.unknowns.split_at(joint.of_series);
    let attracted = plan.attracted_by(attraction);
    let mut model = Model::new(&attracted, interrupt);
    model.corrections.clone_from(&joint.corrections);
    let of_series = Solution {
        unknowns: Point(series.to_vec()),
        residuals: found.residuals.clone(),
    };
    let mut identified = judged(
        &model,
        &linearised,
        candidates,
        point,
        of_series,
        (&derivatives, attraction),
    )?;
    identified.adhesion = attracted.contact.adhesion;
    refuse_contradiction(plan, &identified)?;
    Ok(identified)
}
