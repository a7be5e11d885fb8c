//! The laws of a curve: what is known, and the way from samples to laws.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::attracted::Attracted;
use super::found::{CurveFit, Solved};
use super::kept::Known;
use super::problem::{Answer, Fitted};
use super::record::ForceCurve;
use super::resolved::Probe;
use super::springs::Springs;
use super::touch::{contact_times, jump_in, largest, pulled, torn, touch};
use crate::engine::body_of_revolution;
use crate::identify::{Sought, SoughtAttraction};
use crate::material::law::Form;
use crate::material::{Creep, Material, ModulusKind, Relaxation};
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::layer::LayerPlan;

/// What is known before a curve is fitted.
#[derive(Debug, Clone)]
pub struct CurvePlan {
    /// The bodies: of an attraction that is sought, as it is expected.
    pub contact: ContactPlan<Sought>,
    pub attraction: SoughtAttraction,
    /// The laws that are tried.
    pub forms: Vec<Form>,
    pub probe: Probe,
    /// How often the curve is fitted again with its noise drawn anew.
    pub samples: usize,
}

/// Why a curve was not fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    #[error("the curve has {0} samples, and at least {FEWEST} are needed")]
    TooFew(usize),
    #[error("the indentation does not change: there is no approach")]
    Still,
    #[error("{0}")]
    Shape(String),
    #[error(
        "no contact was found: the force does not rise with the indentation; are force and indentation positive into the specimen?"
    )]
    NoContact,
    #[error("the contact has {0} points, and at least {FEWEST_POINTS} are needed")]
    ShortContact(usize),
    #[error("none of the laws could be fitted")]
    NoLaw,
    #[error("interrupted")]
    Interrupted,
}

const FEWEST: usize = 16;
const FEWEST_POINTS: usize = 8;

/// The finest time that a curve tells anything about, as a part of its contact.
const FINEST: f64 = 0.02;

/// By how much softer than on the approach a body may become, on which an attracted contact is wider.
const SOFTER: f64 = 3.0;

/// By how much deeper than expected a contact may become during a fit.
const DEEPER: f64 = 1.3;

impl CurvePlan {
    /// The relaxation modulus of the contact of a body of this series; `None` where the pair has none.
    pub(super) fn relaxation(&self, series: &Relaxation) -> Option<Relaxation> {
        let known = &self.contact.material;
        match (
            &known.indenter_material,
            known.compressibility.poisson_ratio(),
        ) {
            (None, Some(nu)) => series.scaled(1.0 / (1.0 - nu * nu)).ok(),
            _ => self.creep(series)?.to_relaxation().ok(),
        }
    }

    /// The compliance of the same contact.
    pub(super) fn creep(&self, series: &Relaxation) -> Option<Creep> {
        let (kind, known) = (ModulusKind::Longitudinal, &self.contact.material);
        let compressibility = known.compressibility.clone();
        let body = Material::from_relaxation(series.clone(), kind, compressibility).ok()?;
        let pair = match &known.indenter_material {
            Some(indenter) => body.against(indenter.clone()),
            None => body,
        };
        pair.contact_compliance().ok()
    }
}

/// The laws of a curve.
///
/// # Errors
/// [`CurveError`].
pub fn fit(
    plan: &CurvePlan,
    curve: &ForceCurve,
    interrupt: &AtomicBool,
) -> Result<CurveFit, CurveError> {
    fit_knowing(plan, curve, None, interrupt)
}

/// The same where the laws may be known.
pub(super) fn fit_knowing(
    plan: &CurvePlan,
    curve: &ForceCurve,
    known: Option<&Known>,
    interrupt: &AtomicBool,
) -> Result<CurveFit, CurveError> {
    if plan.probe.drag_height_m.is_none() {
        return fit_above(plan, curve, (None, known), interrupt);
    }
    // The drag depends on where the surface is, which only a fit tells well enough.
    let once = CurvePlan {
        samples: 0,
        ..plan.clone()
    };
    let found = fit_above(&once, curve, (None, None), interrupt)?;
    let surface_m = Some(found.contact_point_m.value);
    fit_above(plan, curve, (surface_m, None), interrupt)
}

/// The same where the drag counts its height from a surface (m), or from a first estimate of it.
fn fit_above(
    plan: &CurvePlan,
    curve: &ForceCurve,
    (surface_m, known): (Option<f64>, Option<&Known>),
    interrupt: &AtomicBool,
) -> Result<CurveFit, CurveError> {
    let count = curve.time_s.len();
    if count < FEWEST {
        return Err(CurveError::TooFew(count));
    }
    let indenter = &plan.contact.indenter;
    let profile = body_of_revolution(indenter.as_ref())
        .map_err(|error| CurveError::Shape(error.to_string()))?;
    let nu = plan.contact.material.compressibility.poisson_ratio();
    let layer = LayerPlan::for_body(plan.contact.layer, nu)
        .map_err(|error| CurveError::Shape(error.to_string()))?;
    let mut points = curve.points();
    points.less_drag(plan.probe.drag_n_s_per_m.unwrap_or(0.0), |_| 1.0);
    let mut touch = touch(profile, layer, &points)?;
    let adhesion = plan.contact.adhesion.as_ref();
    let jump = adhesion.and_then(|_| jump_in(&points, &touch));
    if let Some(about) = &jump {
        let middle = usize::midpoint(about.start, about.end);
        touch.contact_point_m = points.indentation_m[middle];
        touch.before = about.start;
    }
    points.drag_falls(&plan.probe, surface_m.unwrap_or(touch.contact_point_m));
    let pulled = match adhesion {
        None => pulled(&points, &touch),
        Some(_) => torn(&points, &touch),
    };
    let mut contact = 0..points.path_s.len();
    if let Some(left_out) = pulled.clone() {
        contact.end = points.leave_out(left_out).start;
    }
    if let Some(about) = jump {
        contact.start = points.leave_out(about).start;
    }
    let deepest_m = largest(&points.indentation_m) - touch.contact_point_m;
    let nu = nu.unwrap_or(0.5);
    let modulus_pa = touch.modulus_pa * (1.0 - nu * nu);
    let depth_m = DEEPER * deepest_m;
    let answer = match adhesion {
        None => Springs::new(profile, layer, depth_m)
            .map(|springs| Answer::Springs([springs.coarser(), springs])),
        Some(adhesion) => {
            let expected = (depth_m, SOFTER / touch.modulus_pa);
            Attracted::new(indenter, adhesion, expected, &contact).map(Answer::Attracted)
        }
    };
    let answer = answer.ok_or(CurveError::NoLaw)?;
    let deeper = points.indentation_m.iter();
    let in_contact = deeper.filter(|d| **d > touch.contact_point_m).count();
    if in_contact < FEWEST_POINTS {
        return Err(CurveError::ShortContact(in_contact));
    }
    let fitted = Fitted::new(plan, &points, &answer, (&touch, deepest_m), interrupt);
    let (first_s, last_s) = contact_times(&points, touch.contact_point_m);
    let window_s = (FINEST * (last_s - first_s), last_s - first_s);
    let began = (modulus_pa, window_s, touch.contact_point_m);
    let found: Vec<Solved> = match known {
        None => fitted.solved(&plan.forms, began),
        Some(known) => {
            let at = |form: &Form| {
                let (_, unknowns) = known.iter().find(|(own, _)| own == form)?;
                Some((*form, fitted.at(*form, unknowns)?))
            };
            plan.forms.par_iter().filter_map(at).collect()
        }
    };
    match interrupt.load(Ordering::Relaxed) {
        true => Err(CurveError::Interrupted),
        false => {
            let mut found = fitted.judged(&found, window_s)?;
            found.is_pulled = pulled.is_some();
            found.ensemble = fitted.ensemble(&found, plan.samples);
            Ok(found)
        }
    }
}
