//! All figures of a sweep, as far as they apply to it.

use super::curve::{curves, largest};
use super::equivalent::Equivalent;
use super::{
    Drawn, Figure, cole_cole, dissipation, dissipation_map, dissipation_profile, energy_loss,
    harmonic_map, loops, loss_map, loss_tangent, moduli, moduli_error, van_gurp_palmen,
};
use crate::report::ReportError;
use crate::sweep::plan::SweepPlan;
use crate::sweep::run::Outcome;

/// The figures, and what was left out and why.
///
/// # Errors
/// Where a table behind a figure cannot be made.
pub fn figures(
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<(Vec<Figure>, Vec<String>), ReportError> {
    let curves = curves(plan, outcome);
    let Some(curve) = largest(&curves).filter(|curve| !curve.results().is_empty()) else {
        let why = "no figures: no case converged, so there is nothing to draw";
        return Ok((Vec::new(), vec![why.to_owned()]));
    };
    let mut drawn = vec![
        Drawn::Figure(energy_loss::figure(plan, outcome)?),
        Drawn::Figure(loops::figure(curve)?),
        dissipation::figure(curve)?,
        dissipation_profile::figure(curve)?,
        dissipation_map::figure(curve)?,
    ];
    match Equivalent::of(&plan.material, curve) {
        Some(equivalent) => drawn.extend(
            [
                moduli::with_loops(&equivalent, plan, outcome)?,
                cole_cole::figure(&equivalent)?,
                van_gurp_palmen::figure(&equivalent)?,
                loss_tangent::figure(&equivalent)?,
            ]
            .map(Drawn::Figure),
        ),
        None => drawn.push(Drawn::left_out(
            "no figures of the moduli: fewer than two loops have equivalent moduli",
        )),
    }
    if let Some(axis) = &plan.axis {
        drawn.extend([
            loss_map::figure(plan, outcome, axis, &curves)?,
            harmonic_map::figure(plan, axis, &curves)?,
            moduli_error::figure(plan, outcome, axis, &curves)?,
        ]);
    }
    let (mut figures, mut left_out) = (Vec::new(), Vec::new());
    for drawn in drawn {
        match drawn {
            Drawn::Figure(figure) => figures.push(figure),
            Drawn::LeftOut(why) => left_out.push(why),
        }
    }
    Ok((figures, left_out))
}
