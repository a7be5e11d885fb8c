//! A law of a material from a force curve: force over indentation over time, while a probe approaches, holds and retracts.
//!
//! # How
//!
//! 1. The indentation is freed of its noise: straight between knots, as few as leave nothing but noise. Samples that then lie on a line are
//!    one point, the mean of them, with the noise of the force that the scatter of neighbours tells ([`record`]).
//! 2. The indentation is prescribed, and the force follows from the springs of the axisymmetric engine, loading and
//!    unloading, as often as they come; those of a half-space or of a layer.
//! 3. Unknown are the parameters of a law ([`crate::material::law`]), where the indentation begins, and, where the curve has a part before
//!    contact, offset and drift of the force, and a drag where the speed changes: all at once, by least squares. What is linear is
//!    projected out (G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413).
//! 4. A retraction that pulls, as no law without attraction does, is left out. Where an attraction is given, the attracted springs answer in
//!    place of the others, work and range may be unknowns too, and only what follows the largest pull is left out.
//! 5. Laws are compared by the criterion of G. Schwarz (Ann. Statist. 6 (1978) 461). The band of E* has in it what the others say otherwise,
//!    each by the weight that H. Akaike's criterion gives it (K. P. Burnham, D. R. Anderson, *Model Selection and Multimodel Inference*,
//!    Springer 2002): that of Schwarz, which finds the law, leaves too little to laws of more parameters for a band that is to hold the
//!    truth. Where the best law misses the curve, all intervals are wider by the root of chi squared per degree of freedom.

mod attracted;
mod fit;
mod found;
mod kept;
mod problem;
pub mod record;
pub mod resolved;
mod smooth;
mod springs;
mod touch;

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

pub use fit::{CurveError, CurvePlan, fit};
pub use found::CurveFit;
pub use kept::Kept;
pub use record::ForceCurve;
pub use touch::Nuisance;

use crate::identify::IdentifyError;
use resolved::CurvesPlan;

/// All curves of a plan, side by side, but those whose laws are kept; `done` is told after each.
///
/// # Errors
/// [`IdentifyError`] where it was interrupted, and where no curve could be fitted.
pub fn fit_all(
    plan: &CurvesPlan,
    kept: &Kept,
    interrupt: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Result<CurveFit, CurveError>>, IdentifyError> {
    let common = kept::common(plan);
    let fits = plan.curves.par_iter().map(|curve| {
        let key = kept.key(&common, curve);
        let known = key.as_ref().and_then(|key| kept.get(key));
        let found = fit::fit_knowing(&plan.fit, curve, known, interrupt);
        if let (Ok(found), Some(key)) = (&found, key) {
            kept.put(key, found);
        }
        done();
        found
    });
    let fits: Vec<Result<CurveFit, CurveError>> = fits.collect();
    match &fits[..] {
        _ if interrupt.load(Ordering::Relaxed) => Err(IdentifyError::Interrupted),
        [Err(error), ..] if fits.iter().all(Result::is_err) => Err(IdentifyError::NoLaw {
            curve: plan.curves[0].name.clone(),
            why: error.to_string(),
        }),
        _ => Ok(fits),
    }
}
