//! All figures of a sweep, as far as they apply to it.

use std::collections::BTreeSet;

use super::curve::{Curve, chosen, curves, largest};
use super::equivalent::Equivalent;
use super::units::Units;
use super::{
    Drawn, Figure, cole_cole, dissipation, dissipation_map, dissipation_profile, energy_loss,
    harmonic_map, loops, loss_map, loss_tangent, moduli, moduli_error, peaks_over_axis,
    van_gurp_palmen,
};
use crate::report::ReportError;
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::{CaseRecord, CaseResult};
use crate::sweep::search::run::Outcome;

/// The figures, and what was left out and why.
///
/// # Errors
/// [`ReportError::Scale`] where normalised axes are asked for and there is nothing to normalise by.
pub fn figures(
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<(Vec<Figure>, Vec<String>), ReportError> {
    let units = &Units::of_sweep(plan)?;
    let asked = &plan.figures.loops_rad_per_s;
    let curves = curves(plan, outcome, units);
    let Some(curve) = largest(&curves).filter(|curve| !curve.results().is_empty()) else {
        let why = "no figures: no case converged, so there is nothing to draw";
        return Ok((Vec::new(), vec![why.to_owned()]));
    };
    let mut drawn = vec![
        Drawn::Figure(energy_loss::figure(plan, outcome, &curves, units)),
        Drawn::Figure(loops::figure(curve, asked, units)),
        dissipation::figure(curve, units),
        dissipation_profile::figure(curve, plan.indenter.as_ref(), asked, units),
        dissipation_map::figure(curve, units),
    ];
    match Equivalent::of(curve) {
        Some(equivalent) => drawn.extend(
            [
                moduli::with_loops(&equivalent, plan, outcome, units),
                cole_cole::figure(&equivalent, units),
                van_gurp_palmen::figure(&equivalent, units),
                loss_tangent::figure(&equivalent, units),
            ]
            .map(Drawn::Figure),
        ),
        None => drawn.push(Drawn::left_out(
            "no figures of the moduli: fewer than two loops have equivalent moduli",
        )),
    }
    if let Some(axis) = &plan.axis {
        drawn.extend([
            loss_map::figure(plan, outcome, axis, &curves, units),
            harmonic_map::figure(plan, axis, &curves, units),
            moduli_error::figure(plan, outcome, axis, &curves, units),
            peaks_over_axis::figure(plan, outcome, axis, units),
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

/// The cases whose cycles the figures show: of the curve of the largest loss.
///
/// # Errors
/// As [`figures`].
pub fn drawn(plan: &SweepPlan, outcome: &Outcome) -> Result<BTreeSet<usize>, ReportError> {
    let units = Units::of_sweep(plan)?;
    let curves = curves(plan, outcome, &units);
    let Some(curve) = largest(&curves) else {
        return Ok(BTreeSet::new());
    };
    Ok(cycles_of(curve, &plan.figures.loops_rad_per_s))
}

/// The cases of a curve whose cycles are shown, where those at some frequencies are asked for or none.
pub fn cycles_of(curve: &Curve<'_>, asked_rad_per_s: &[f64]) -> BTreeSet<usize> {
    let results = curve.results();
    let loss = |(_, result): &&(&CaseRecord, &CaseResult)| result.analysis.energy_loss_j;
    let highest = results.iter().max_by(|a, b| loss(a).total_cmp(&loss(b)));
    let shown = chosen(&results, asked_rad_per_s, loops::LOOPS);
    let shown = shown.iter().chain(highest);
    shown.map(|(record, _)| record.index).collect()
}
