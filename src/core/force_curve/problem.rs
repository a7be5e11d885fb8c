//! A curve as a least squares problem for any law.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::attracted::Attracted;
use super::fit::CurvePlan;
use super::record::{Points, span};
use super::springs::Springs;
use super::touch::{Nuisance, Touch, nuisances};
use crate::identify::laws::clamped;
use crate::material::law::{Form, Scale};
use crate::numerics::levenberg_marquardt::{
    Ending, Problem, Solution, central_difference, minimise_along_valleys,
};
use crate::quantity::Dimension;

/// Of every start, of the best of them, and from near the solution on.
const AT_FIRST: Ending = Ending {
    iterations: 5,
    enough: 1e-2,
};
const ON_THE_WAY: Ending = Ending {
    iterations: 20,
    enough: 1e-3,
};
pub(super) const EXACTLY: Ending = Ending {
    iterations: 30,
    enough: 1e-5,
};

/// Steps of unknowns for derivatives; that of the contact point is a part of the indentation.
const STEP: f64 = 0.01;
const STEP_OF_CONTACT: f64 = 2e-3;

/// How far the forces of attracted springs may be off, as a part of their range.
const OFF: f64 = 5e-4;

/// By how many times they are longer where edges that pass springs make the response less smooth.
const LONGER: f64 = 2.0;

/// The same for a search, to one side alone.
const AHEAD: f64 = 1e-3;

/// How far work and range may go from what is expected, as logarithms: a factor of a thousand.
const FARTHEST: f64 = 6.9;

/// A law is not followed whose squares are beyond this factor of the least and so many more.
const HOPELESS: (f64, f64) = (1.2, 10.0);

/// How the contact answers an indentation, on the way to a solution and at it.
pub(super) enum Answer {
    Springs([Springs; 2]),
    Attracted([Attracted; 2]),
}

/// By how many times a start may be farther from the curve than the best and be followed too, and how many are.
const NEARLY: f64 = 4.0;
const FOLLOWED: usize = 2;

/// Starts of a work of adhesion that is sought, over what is expected.
const WORKS: [f64; 3] = [0.4, 1.0, 2.5];

/// A curve as a least squares problem for any law.
pub(super) struct Fitted<'a> {
    pub(super) plan: &'a CurvePlan,
    pub(super) points: &'a Points,
    pub(super) answer: &'a Answer,
    /// The finest and the whole time (s) of the curve.
    pub(super) times_s: (f64, f64),
    /// The unknown contact point is a part of this.
    pub(super) scale_m: f64,
    pub(super) sigma_n: Vec<f64>,
    pub(super) nuisances: Vec<Nuisance>,
    /// What the instrument adds, orthogonal and of length one, in standard deviations of the points.
    pub(super) basis: Vec<DVector<f64>>,
    pub(super) interrupt: &'a AtomicBool,
}

/// The same for one.
pub(super) struct OfForm<'a> {
    pub(super) fitted: &'a Fitted<'a>,
    pub(super) form: Form,
    /// Whether forces are to be exact: on the way to a solution they are cheaper.
    pub(super) is_near: bool,
}

impl<'a> Fitted<'a> {
    pub(super) fn new(
        plan: &'a CurvePlan,
        points: &'a Points,
        answer: &'a Answer,
        (touch, deepest_m): (&Touch, f64),
        interrupt: &'a AtomicBool,
    ) -> Self {
        let time_s = &points.time_s;
        let steps = time_s.windows(2).map(|t| t[1] - t[0]);
        let finest_s = steps
            .filter(|step| *step > 0.0)
            .fold(f64::INFINITY, f64::min);
        let sigma_n = points.samples.iter().map(|n| points.noise_n / n.sqrt());
        let off_n = match answer {
            Answer::Springs(_) => 0.0,
            Answer::Attracted(_) => OFF * span(&points.force_n),
        };
        let mut fitted = Self {
            plan,
            points,
            answer,
            times_s: (finest_s, time_s[time_s.len() - 1] - time_s[0]),
            scale_m: deepest_m,
            sigma_n: sigma_n.map(|sigma_n| sigma_n.hypot(off_n)).collect(),
            nuisances: nuisances(points, touch, plan.probe.drag_n_s_per_m.is_none()),
            basis: Vec::new(),
            interrupt,
        };
        for nuisance in fitted.nuisances.clone() {
            let column = fitted.projected(fitted.column(nuisance));
            let length = column.norm();
            fitted.basis.push(column / length);
        }
        fitted
    }

    /// The same with other forces at its points.
    pub(super) fn with_points<'b>(&'b self, points: &'b Points) -> Fitted<'b> {
        Fitted {
            plan: self.plan,
            points,
            answer: self.answer,
            times_s: self.times_s,
            scale_m: self.scale_m,
            sigma_n: self.sigma_n.clone(),
            nuisances: self.nuisances.clone(),
            basis: self.basis.clone(),
            interrupt: self.interrupt,
        }
    }

    /// What one of a nuisance adds to the force of every point, in its standard deviations.
    pub(super) fn column(&self, nuisance: Nuisance) -> DVector<f64> {
        let points = self.points;
        let of = |k: usize| match nuisance {
            Nuisance::Offset => 1.0,
            Nuisance::Drift => points.time_s[k] - points.time_s[0],
            Nuisance::Drag => points.speed_m_per_s[k],
        };
        let all = (0..points.time_s.len()).map(|k| of(k) / self.sigma_n[k]);
        DVector::from_iterator(points.time_s.len(), all)
    }

    fn is_attracted(&self) -> bool {
        matches!(self.answer, Answer::Attracted(_))
    }

    /// Those of the law, the contact point as a part of the depth, and those of the attraction.
    pub(super) fn parts<'u>(&self, unknowns: &'u [f64]) -> Option<(&'u [f64], f64, &'u [f64])> {
        let of_law = unknowns
            .len()
            .checked_sub(1 + self.plan.attraction.count())?;
        let (of_law, behind) = unknowns.split_at(of_law);
        Some((of_law, behind[0], &behind[1..]))
    }

    /// Forces (N) at the points; on the way to a solution what is fast is good enough.
    pub(super) fn response(&self, form: Form, unknowns: &[f64], is_near: bool) -> Option<Vec<f64>> {
        let (of_law, contact_part, attraction) = self.parts(unknowns)?;
        let series = form.series_within(&form.values(of_law), self.times_s)?;
        let contact_point_m = contact_part * self.scale_m;
        let depths = self.points.path_m.iter();
        let depths: Vec<f64> = depths.map(|d| d - contact_point_m).collect();
        let path = (&self.points.path_s[..], &depths[..]);
        let force_n = match self.answer {
            Answer::Springs(springs) => {
                let springs = &springs[usize::from(is_near)];
                springs.response(&self.plan.relaxation(&series)?, path)?
            }
            Answer::Attracted(springs) => {
                let springs = &springs[usize::from(is_near)];
                let adhesion = self.plan.contact.adhesion?.with_logarithms(attraction);
                springs.response(&self.plan.creep(&series)?, &adhesion, path)?
            }
        };
        Some(self.points.on_path.iter().map(|k| force_n[*k]).collect())
    }

    /// Computed less measured forces in their standard deviations.
    pub(super) fn off(&self, form: Form, unknowns: &[f64], is_near: bool) -> Option<DVector<f64>> {
        if self.interrupt.load(Ordering::Relaxed) {
            return None;
        }
        let response = self.response(form, unknowns, is_near)?;
        let all = response.iter().zip(&self.points.force_n);
        let off = all
            .zip(&self.sigma_n)
            .map(|((computed, measured), sigma)| (computed - measured) / sigma);
        Some(DVector::from_iterator(self.sigma_n.len(), off))
    }

    pub(super) fn projected(&self, mut residuals: DVector<f64>) -> DVector<f64> {
        for column in &self.basis {
            let along = column.dot(&residuals);
            residuals -= column * along;
        }
        residuals
    }

    /// About the least squares solution of a law, from the best of its starts on.
    pub(super) fn roughly(
        &self,
        form: Form,
        (modulus_pa, window_s, contact_point_m): (f64, (f64, f64), f64),
    ) -> Option<Solution<Vec<f64>>> {
        let problem = OfForm {
            fitted: self,
            form,
            is_near: false,
        };
        let expected = (self.plan.attraction).logarithms(self.plan.contact.adhesion.as_ref());
        let works: &[f64] = if expected.is_empty() { &[1.0] } else { &WORKS };
        // Of every start of the law the best of the works.
        let best = |start: Vec<f64>| {
            let all = works.iter().filter_map(|factor| {
                let mut start = start.clone();
                start.push(contact_point_m / self.scale_m);
                start.extend(&expected);
                if let Some(work) = work_of(form, &mut start) {
                    *work += factor.ln();
                }
                self.scaled(form, start)
            });
            all.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let starts = form.starts(modulus_pa, window_s);
        let mut starts: Vec<_> = starts.into_iter().filter_map(best).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let nearly = NEARLY * starts.first()?.0;
        let all = starts.iter().take(FOLLOWED);
        let all = all.filter(|(left, _)| *left <= nearly);
        let found = all.filter_map(|(_, start)| minimise_along_valleys(&problem, start, AT_FIRST));
        let best = found.min_by(|a, b| a.squares().total_cmp(&b.squares()))?;
        minimise_along_valleys(&problem, &best.unknowns, ON_THE_WAY)
    }

    /// The same from unknowns near it on.
    pub(super) fn exactly(&self, form: Form, unknowns: &Vec<f64>) -> Option<Solution<Vec<f64>>> {
        let problem = OfForm {
            fitted: self,
            form,
            is_near: true,
        };
        minimise_along_valleys(&problem, unknowns, EXACTLY)
    }

    /// The least squares solutions of all laws that may be the right one: where a solution costs seconds, those are left out that are far
    /// behind the best on the way to it.
    pub(super) fn solved(
        &self,
        forms: &[Form],
        began: (f64, (f64, f64), f64),
    ) -> Vec<(Form, Solution<Vec<f64>>)> {
        let roughly = |form: &Form| Some((*form, self.roughly(*form, began)?));
        let mut rough: Vec<_> = forms.par_iter().filter_map(roughly).collect();
        if self.is_attracted() {
            let misses = |(form, found): &(Form, Solution<Vec<f64>>)| {
                let unknowns = form.scales().count() as f64;
                found.squares() + unknowns * (self.sigma_n.len() as f64).ln()
            };
            let least = rough.iter().map(misses).fold(f64::INFINITY, f64::min);
            rough.retain(|found| misses(found) <= HOPELESS.0 * least + HOPELESS.1);
        }
        let exactly = |(form, found): &(Form, Solution<Vec<f64>>)| {
            Some((*form, self.exactly(*form, &found.unknowns)?))
        };
        rough.par_iter().filter_map(exactly).collect()
    }

    /// A law with unknowns that were found before.
    pub(super) fn at(&self, form: Form, unknowns: &[f64]) -> Option<Solution<Vec<f64>>> {
        let problem = OfForm {
            fitted: self,
            form,
            is_near: true,
        };
        let unknowns = unknowns.to_vec();
        let residuals = problem.residuals(&unknowns)?;
        Some(Solution {
            unknowns,
            residuals,
        })
    }

    /// A start with all its moduli, and the work of adhesion where it is sought, multiplied so that it comes nearest to the curve, and the
    /// sum of squares that are left.
    fn scaled(&self, form: Form, mut start: Vec<f64>) -> Option<(f64, Vec<f64>)> {
        let response = self.response(form, &start, false)?;
        let weighed = |force: &[f64]| {
            let all = force.iter().zip(&self.sigma_n).map(|(f, s)| f / s);
            self.projected(DVector::from_iterator(self.sigma_n.len(), all))
        };
        let (computed, measured) = (weighed(&response), weighed(&self.points.force_n));
        let factor = computed.dot(&measured) / computed.norm_squared();
        let more = factor.max(1e-3).ln();
        let left = (computed * factor - measured).norm_squared();
        for (unknown, scale) in start.iter_mut().zip(form.scales()) {
            if scale == Scale::Logarithm(Dimension::Stress) {
                *unknown += more;
            }
        }
        // Moduli and work in proportion leave every displacement as it is.
        if let Some(work) = work_of(form, &mut start) {
            *work += more;
        }
        Some((left, start))
    }
}

/// The work of adhesion among the unknowns, behind those of the law and the contact point, where it is sought.
fn work_of(form: Form, unknowns: &mut [f64]) -> Option<&mut f64> {
    unknowns.get_mut(form.scales().count() + 1)
}

impl OfForm<'_> {
    /// Derivatives of the residuals before anything is projected out.
    pub(super) fn columns(&self, unknowns: &[f64]) -> Option<Vec<DVector<f64>>> {
        let contact = self.fitted.parts(unknowns)?.0.len();
        let column = |k: usize| {
            let step = if k == contact { STEP_OF_CONTACT } else { STEP };
            let step = if self.fitted.is_attracted() {
                LONGER * step
            } else {
                step
            };
            central_difference(unknowns, k, step, &|moved| {
                self.fitted.off(self.form, &moved, self.is_near)
            })
        };
        (0..unknowns.len()).map(column).collect()
    }
}

impl Problem for OfForm<'_> {
    type Unknowns = Vec<f64>;

    fn residuals(&self, unknowns: &Vec<f64>) -> Option<DVector<f64>> {
        let off = self.fitted.off(self.form, unknowns, self.is_near)?;
        Some(self.fitted.projected(off))
    }

    fn derivatives(&self, unknowns: &Vec<f64>) -> Option<DMatrix<f64>> {
        let columns = self.columns(unknowns)?.into_iter();
        let columns: Vec<_> = columns.map(|c| self.fitted.projected(c)).collect();
        Some(DMatrix::from_columns(&columns))
    }

    /// By differences to one side, but where edges pass springs of an attracted contact.
    fn derivatives_at(&self, found: &Solution<Vec<f64>>) -> Option<DMatrix<f64>> {
        if self.fitted.is_attracted() {
            return self.derivatives(&found.unknowns);
        }
        let column = |k: usize| {
            let mut moved = found.unknowns.clone();
            moved[k] += AHEAD;
            Some((self.residuals(&moved)? - &found.residuals) / AHEAD)
        };
        let columns: Option<Vec<_>> = (0..found.unknowns.len()).map(column).collect();
        Some(DMatrix::from_columns(&columns?))
    }

    fn clamp(&self, place: usize, value: f64) -> f64 {
        let plan = self.fitted.plan;
        let behind = place.checked_sub(self.form.scales().count() + 1);
        let expected = plan.attraction.logarithms(plan.contact.adhesion.as_ref());
        match behind.and_then(|place| expected.get(place)) {
            Some(expected) => value.clamp(expected - FARTHEST, expected + FARTHEST),
            None => clamped(self.form, place, value),
        }
    }
}
