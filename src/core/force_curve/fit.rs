//! The laws of a curve: what is known, and the way from samples to laws.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::found::{CurveFit, Solved};
use super::kept::Known;
use super::problem::Fitted;
use super::record::ForceCurve;
use super::resolved::Probe;
use super::springs::Springs;
use super::touch::{contact_times, largest, pulled_from, touch};
use crate::engine::body_of_revolution;
use crate::indenter::Indenter;
use crate::material::law::Form;
use crate::material::{Compressibility, Material, ModulusKind, Relaxation};

/// What is known before a curve is fitted.
#[derive(Debug, Clone)]
pub struct CurvePlan {
    pub indenter: Arc<dyn Indenter>,
    pub compressibility: Compressibility,
    /// What the indenter is made of, where it is not rigid.
    pub indenter_material: Option<Material>,
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

/// By how much deeper than expected a contact may become during a fit.
const DEEPER: f64 = 1.3;

impl CurvePlan {
    /// The relaxation modulus of the contact of a body of this series; `None` where the pair has none.
    pub(super) fn contact(&self, series: &Relaxation) -> Option<Relaxation> {
        let kind = ModulusKind::Longitudinal;
        match (
            &self.indenter_material,
            self.compressibility.poisson_ratio(),
        ) {
            (None, Some(nu)) => series.scaled(1.0 / (1.0 - nu * nu)).ok(),
            (indenter, _) => {
                let body =
                    Material::from_relaxation(series.clone(), kind, self.compressibility.clone())
                        .ok()?;
                let pair = match indenter {
                    Some(indenter) => body.against(indenter.clone()),
                    None => body,
                };
                pair.contact_compliance().ok()?.to_relaxation().ok()
            }
        }
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
    let count = curve.time_s.len();
    if count < FEWEST {
        return Err(CurveError::TooFew(count));
    }
    let profile = body_of_revolution(plan.indenter.as_ref())
        .map_err(|error| CurveError::Shape(error.to_string()))?;
    let mut points = curve.points();
    if let Some(drag) = plan.probe.drag_n_s_per_m {
        for (force_n, speed) in points.force_n.iter_mut().zip(&points.speed_m_per_s) {
            *force_n -= drag * speed;
        }
    }
    let touch = touch(profile, &points)?;
    let pulled_from = pulled_from(&points, &touch);
    if let Some(count) = pulled_from {
        points.truncate(count);
    }
    let deepest_m = largest(&points.indentation_m) - touch.contact_point_m;
    let springs = Springs::new(profile, DEEPER * deepest_m);
    let deeper = points.indentation_m.iter();
    let in_contact = deeper.filter(|d| **d > touch.contact_point_m).count();
    if in_contact < FEWEST_POINTS {
        return Err(CurveError::ShortContact(in_contact));
    }
    let fitted = Fitted::new(plan, &points, &springs, (&touch, deepest_m), interrupt);
    let (first_s, last_s) = contact_times(&points, touch.contact_point_m);
    let window_s = (FINEST * (last_s - first_s), last_s - first_s);
    let nu = plan.compressibility.poisson_ratio().unwrap_or(0.5);
    let modulus_pa = touch.modulus_pa * (1.0 - nu * nu);
    let began = (modulus_pa, window_s, touch.contact_point_m);
    let forms = plan.forms.par_iter();
    let solved = |form: Form| match known {
        None => fitted.best(form, began),
        Some(known) => {
            let (_, unknowns) = known.iter().find(|(own, _)| *own == form)?;
            fitted.at(form, unknowns)
        }
    };
    let found = forms.filter_map(|form| Some((*form, solved(*form)?)));
    let found: Vec<Solved> = found.collect();
    match interrupt.load(Ordering::Relaxed) {
        true => Err(CurveError::Interrupted),
        false => {
            let mut found = fitted.judged(&found, window_s)?;
            found.is_pulled = pulled_from.is_some();
            found.ensemble = fitted.ensemble(&found, plan.samples);
            Ok(found)
        }
    }
}
