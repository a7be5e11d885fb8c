//! From measurements to a material: the search on the linearised contact, and the refinement on the exact one.

use std::sync::atomic::AtomicBool;

use nalgebra::{DMatrix, DVector};

use crate::engine::EngineKind;
use crate::identify::candidate::{Candidate, candidates, choose, leave_out_outlier};
use crate::identify::chosen::with_laws;
use crate::identify::ensemble::ensemble;
use crate::identify::identified::{CellError, Identified, judged};
use crate::identify::model::Model;
use crate::identify::noise::Knowledge;
use crate::identify::selection::Linearised;
use crate::identify::series::Point;
use crate::identify::{IdentifyError, IdentifyPlan, MOST_BRANCHES, SoughtAttraction, adhesion};
use crate::material::Relaxation;
use crate::numerics::levenberg_marquardt::{Ending, Problem, minimise};

/// Step of an unknown for derivatives of the exact model: wide beside what springs and steps leave of roughness in it.
pub(super) const STEP: f64 = 0.02;

/// Which part of a change of the factors is made where all of it did not lead to a solid.
const PARTS: [f64; 2] = [0.5, 0.25];

/// Which part of the noise of a number the error of the resolution may be.
const SEEN: f64 = 0.1;

/// How often the factors between the exact and the linearised model are taken, and the change that is none.
const ROUNDS: usize = 8;
const SETTLED: f64 = 1e-3;

pub(super) const EXACTLY: Ending = Ending {
    iterations: 12,
    enough: 1e-4,
};

/// Misfit (root mean square of relative differences) from which data contradict one another, and how many times their errors it
/// must be.
const CONTRADICTION: f64 = 0.15;
const TIMES_ERRORS: f64 = 5.0;

/// Finds the material.
///
/// # Errors
/// [`IdentifyError`]: too few numbers, cycles that are not found, numbers that no solid has together.
pub fn identify(plan: &IdentifyPlan, interrupt: &AtomicBool) -> Result<Identified, IdentifyError> {
    if plan.attraction != SoughtAttraction::Known {
        return adhesion::identify(plan, interrupt);
    }
    let most = most_branches(plan)?;
    let mut model = Model::new(plan, interrupt);
    let mut linearised = Linearised::new(plan)?;
    let mut found = tried(&model, &mut linearised, most, 1.0);
    // Far from the solution the factors may overshoot: what was not found is sought again with smaller changes of them. On cells, whose
    // cycles take a second each, that would be many minutes.
    if plan.solver.engine == EngineKind::Axisymmetric {
        for part in PARTS {
            if !found.as_ref().is_err_and(IdentifyError::ends_search) {
                break;
            }
            linearised.start_over(&model)?;
            let mut other = tried(&model, &mut linearised, most, part);
            if let Ok(near) = &other {
                // It may be near the solution only: once more with the factors there.
                linearised.take_factors(&near.point, &near.computed(), 1.0);
                let again = tried(&model, &mut linearised, most, part);
                if again.as_ref().is_ok_and(|a| a.misfit() <= near.misfit()) {
                    other = again;
                }
            }
            found = match other {
                Err(error) if error.ends_search() => found,
                other => other,
            };
        }
    }
    let found = at_full_resolution(&mut model, &linearised, found?)?;
    let mut found = match plan.laws {
        Some(_) => with_laws(&model, &mut linearised, found)?,
        None => found,
    };
    found.ensemble = ensemble(&mut linearised, &found, plan.samples);
    Ok(found)
}

impl IdentifyError {
    /// Whether it says that a search did not lead to a solid, and nothing of the plan.
    fn ends_search(&self) -> bool {
        matches!(
            self,
            Self::Contradiction { .. } | Self::NoFit(_) | Self::NoCycle { .. } | Self::NoHistory(_)
        )
    }
}

/// A search on the linearised contact, and what comes of it on the exact model.
fn tried(
    model: &Model<'_>,
    linearised: &mut Linearised<'_>,
    most: usize,
    part: f64,
) -> Result<Identified, IdentifyError> {
    let (candidates, chosen) = on_linearised(model, linearised, most, part)?;
    let start = candidates[chosen].point.clone();
    let found = on_exact(model, linearised, candidates, start.clone(), &start)?;
    refuse_contradiction(linearised.plan, &found)?;
    Ok(found)
}

/// The same without the error of the model's own resolution, where that is seen beside the noise.
fn at_full_resolution(
    model: &mut Model<'_>,
    linearised: &Linearised<'_>,
    mut found: Identified,
) -> Result<Identified, IdentifyError> {
    let noise = linearised.noise.relative.iter().copied();
    let noise = noise.fold(f64::INFINITY, f64::min);
    match model.learn_corrections(&found.relaxation) {
        Ok(Some(change)) if change > SEEN * noise => {}
        Ok(Some(change)) => {
            found.cell_error = (found.cell_error).map(|_| CellError::Negligible(change));
            return Ok(found);
        }
        Err(IdentifyError::Interrupted) => return Err(IdentifyError::Interrupted),
        Ok(None) | Err(_) => return Ok(found),
    }
    let (candidates, start) = (found.candidates.clone(), found.linearised.clone());
    match on_exact(model, linearised, candidates, start, &found.point) {
        Err(IdentifyError::Interrupted) => Err(IdentifyError::Interrupted),
        // What was found holds without the correction too.
        Err(_) => Ok(found),
        corrected => corrected,
    }
}

/// Refines a candidate, which was found on the linearised contact at `start`, on the exact model, `from` some point on.
fn on_exact(
    model: &Model<'_>,
    linearised: &Linearised<'_>,
    candidates: Vec<Candidate>,
    start: Point,
    from: &Point,
) -> Result<Identified, IdentifyError> {
    let exact = Exact { model, linearised };
    let found = minimise(&exact, from, EXACTLY);
    let found = found.ok_or(IdentifyError::NoFit("the exact model failed at the start"))?;
    let derivatives = exact.derivatives(&found.unknowns);
    let derivatives = derivatives.ok_or(IdentifyError::NoFit(
        "the exact model has no derivatives there",
    ))?;
    judged(
        model,
        linearised,
        candidates,
        start,
        found,
        (&derivatives, &[]),
    )
}

/// How many branches the number of data allows.
pub(super) fn most_branches(plan: &IdentifyPlan) -> Result<usize, IdentifyError> {
    let numbers = plan.measurements.data().len();
    // As many unknowns, and one number over.
    let needed = |branches: usize| 2 * branches + 2;
    let asked = plan.branches.unwrap_or(1);
    if numbers < needed(asked) {
        return Err(IdentifyError::TooFew {
            numbers,
            branches: asked,
            needed: needed(asked),
        });
    }
    let allowed = (1..=MOST_BRANCHES)
        .rev()
        .find(|most| needed(*most) <= numbers);
    Ok(plan.branches.or(allowed).unwrap_or(1))
}

/// Searches with factors from the exact model until they stand still; which candidate the data ask for.
pub(super) fn on_linearised(
    model: &Model<'_>,
    linearised: &mut Linearised<'_>,
    most: usize,
    part: f64,
) -> Result<(Vec<Candidate>, usize), IdentifyError> {
    let plan = linearised.plan;
    let mut known: Vec<Point> = Vec::new();
    let mut last = None;
    for round in 0..ROUNDS {
        known = linearised.search(&known, most);
        let candidates = candidates(linearised, &known);
        let chosen = match plan.branches {
            Some(asked) => asked.min(candidates.len()).saturating_sub(1),
            None => choose(&candidates),
        };
        let point = known.get(chosen);
        let point = point.ok_or(IdentifyError::NoFit("no start could be tried"))?;
        let exact = model.numbers_where_found(&point.relaxation()?);
        let exact = exact.map_err(|error| explained(linearised, point, error))?;
        let change = linearised.take_factors(point, &exact, part);
        let is_settled = change < SETTLED && last == Some(chosen);
        // Of a series that is pulled by an outlier nothing is left as it is: once more without that.
        let is_last = round + 1 == ROUNDS
            || is_settled && !leave_out_outlier(linearised, &candidates, chosen);
        if is_last {
            return Ok((candidates, chosen));
        }
        last = Some(chosen);
        // With the factors of the exact model, what is left is noise; of a series with branches to spare, less than that.
        let relative = linearised.relative(point);
        let noise = &mut linearised.noise;
        noise.estimate(&plan.measurements, &relative, point.0.len());
    }
    Err(IdentifyError::NoFit("no round was tried"))
}

/// The exact model as a least squares problem.
pub(super) struct Exact<'a> {
    pub(super) model: &'a Model<'a>,
    pub(super) linearised: &'a Linearised<'a>,
}

impl Exact<'_> {
    fn scaled(&self, numbers: &[f64], point: &Point) -> Option<DVector<f64>> {
        let data = self.linearised.plan.measurements.data().iter().zip(numbers);
        let relative = data.map(|(d, number)| (number.max(1e-6 * d.value) / d.value).ln());
        self.linearised.weighed(relative, point)
    }
}

impl Problem for Exact<'_> {
    type Unknowns = Point;

    fn residuals(&self, point: &Point) -> Option<DVector<f64>> {
        let series = point.relaxation().ok()?;
        self.scaled(&self.model.numbers(&series).ok()?, point)
    }

    fn derivatives(&self, point: &Point) -> Option<DMatrix<f64>> {
        let moved = (0..point.0.len()).flat_map(|k| [STEP, -STEP].map(|step| point.moved(k, step)));
        let moved: Vec<Point> = moved.collect();
        let series: Option<Vec<Relaxation>> = moved.iter().map(|p| p.relaxation().ok()).collect();
        let numbers = self.model.numbers_of_each(&series?).ok()?;
        let scaled = numbers.iter().zip(&moved);
        let scaled = scaled.map(|(numbers, point)| self.scaled(numbers, point));
        let columns: Vec<DVector<f64>> = (scaled.collect::<Option<Vec<_>>>()?)
            .chunks_exact(2)
            .map(|pair| (&pair[0] - &pair[1]) / (2.0 * STEP))
            .collect();
        Some(DMatrix::from_columns(&columns))
    }

    fn clamp(&self, place: usize, value: f64) -> f64 {
        self.linearised.limits.clamp(place, value)
    }
}

/// Refuses what no solid explains.
pub(super) fn refuse_contradiction(
    plan: &IdentifyPlan,
    found: &Identified,
) -> Result<(), IdentifyError> {
    let within =
        found.knowledge == Knowledge::All && found.reduced_chi_squared.sqrt() < TIMES_ERRORS;
    match contradiction(plan, found.relaxation.branches().len(), &found.missed()) {
        Some(error) if !within => Err(error),
        _ => Ok(()),
    }
}

/// A cycle that is not found, where the series is one that no data should lead to, is the data's fault.
fn explained(linearised: &Linearised<'_>, point: &Point, error: IdentifyError) -> IdentifyError {
    let (IdentifyError::NoCycle { .. } | IdentifyError::NoHistory(_)) = error else {
        return error;
    };
    let missed = linearised.relative(point);
    contradiction(linearised.plan, point.branches(), &missed).unwrap_or(error)
}

/// What is wrong with data that the best series misses by so much, as logarithms of computed over measured numbers; `None` where it
/// is not much.
fn contradiction(plan: &IdentifyPlan, branches: usize, missed: &[f64]) -> Option<IdentifyError> {
    let squares: f64 = missed.iter().map(|off| off * off).sum();
    let rms = (squares / missed.len() as f64).sqrt();
    if rms < CONTRADICTION {
        return None;
    }
    let data = plan.measurements.data().iter().zip(missed);
    let (datum, off) = data.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    Some(IdentifyError::Contradiction {
        branches,
        may_have_more: plan.branches.is_some_and(|asked| asked < MOST_BRANCHES),
        row: datum.row,
        misfit_percent: format!("{:.0}", 100.0 * rms),
        place: datum.place_in_words(),
        column: datum.number.column(),
        times: format!("{:.2e}", off.exp()),
    })
}
