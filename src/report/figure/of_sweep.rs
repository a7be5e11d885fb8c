//! All figures of a sweep, as far as they apply to it.

use std::collections::BTreeSet;

use super::curve::{Curve, SweepCurves, chosen, largest};
use super::equivalent::Equivalent;
use super::line::{self, Line};
use super::{
    Drawn, Figure, cole_cole, dissipation, dissipation_map, dissipation_profile, energy_loss,
    harmonic_map, loops, loss_map, loss_tangent, moduli, moduli_error, peaks_over_axis,
    van_gurp_palmen,
};
use crate::report::ReportError;
use crate::sweep::plan::{SweepPlan, axes};
use crate::sweep::search::run::Outcome;

/// The figures, and what was left out and why. Of a sweep over several axes each figure shows one of them, the others at their values
/// where the loss is largest.
///
/// # Errors
/// [`ReportError::Scale`] where normalised axes are asked for and there is nothing to normalise by.
pub fn figures(
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<(Vec<Figure>, Vec<String>), ReportError> {
    let mut drawn = match line::along(plan, outcome, 0) {
        None => of_first_axis(&SweepCurves::of(plan, outcome)?),
        Some(line) => said(&line, of_first_axis(&line.curves()?)),
    };
    let lines = (1..axes::MOST).map_while(|axis| Some((axis, line::along(plan, outcome, axis)?)));
    for (axis, line) in lines {
        drawn.extend(said(&line, of_other_axis(axis, &line.curves()?)));
    }
    let (mut figures, mut left_out) = (Vec::new(), Vec::new());
    for drawn in drawn {
        match drawn {
            Ok(figure) => figures.push(figure),
            Err(why) => left_out.push(why.to_owned()),
        }
    }
    Ok((figures, left_out))
}

fn said(line: &Line, drawn: Vec<Drawn>) -> Vec<Drawn> {
    let said = |drawn: Drawn| drawn.map(|figure| line.say(figure));
    drawn.into_iter().map(said).collect()
}

fn of_first_axis(sweep: &SweepCurves<'_>) -> Vec<Drawn> {
    let (plan, units) = (sweep.plan, &sweep.units);
    let asked = &plan.figures.loops_rad_per_s;
    let Some(curve) = largest(&sweep.curves).filter(|curve| !curve.results().is_empty()) else {
        return vec![Err(
            "no figures: no case converged, so there is nothing to draw",
        )];
    };
    let mut drawn = vec![
        Ok(energy_loss::figure(sweep)),
        Ok(loops::figure(curve, asked, units)),
        dissipation::figure(curve, units),
        dissipation_profile::figure(curve, asked, units),
        dissipation_map::figure(curve, units),
    ];
    match Equivalent::of(curve) {
        Some(equivalent) => drawn.extend([
            Ok(moduli::with_loops(&equivalent, sweep)),
            Ok(cole_cole::figure(&equivalent, units)),
            Ok(van_gurp_palmen::figure(&equivalent, units)),
            Ok(loss_tangent::figure(&equivalent, units)),
        ]),
        None => drawn.push(Err(
            "no figures of the moduli: fewer than two loops have equivalent moduli",
        )),
    }
    // Names have no order to draw along.
    if let Some(axes) = plan.axes.as_ref().filter(|axes| !axes.varied().is_whole()) {
        drawn.extend([
            loss_map::figure(sweep, axes),
            harmonic_map::figure(sweep, axes),
            moduli_error::figure(sweep, axes),
            peaks_over_axis::figure(sweep, axes),
        ]);
    }
    drawn
}

/// Names of the figures over the second, third and fourth axis.
const OF_OTHER_AXES: [[&str; 3]; axes::MOST - 1] = [
    ["energy-loss-2", "loss-map-2", "peaks-2"],
    ["energy-loss-3", "loss-map-3", "peaks-3"],
    ["energy-loss-4", "loss-map-4", "peaks-4"],
];

fn of_other_axis(axis: usize, sweep: &SweepCurves<'_>) -> Vec<Drawn> {
    let (Some(names), Some(axes)) = (OF_OTHER_AXES.get(axis - 1), &sweep.plan.axes) else {
        return Vec::new();
    };
    if sweep.records().all(|record| record.result.is_none()) {
        return Vec::new();
    }
    let mut drawn = vec![Ok(energy_loss::figure(sweep))];
    if !axes.varied().is_whole() {
        drawn.push(loss_map::figure(sweep, axes));
        drawn.push(peaks_over_axis::figure(sweep, axes));
    }
    let named = |(drawn, &name): (Drawn, _)| drawn.map(|figure| Figure { name, ..figure });
    drawn.into_iter().zip(names).map(named).collect()
}

/// The cases whose cycles the figures show: of the curve of the largest loss.
///
/// # Errors
/// As [`figures`].
pub fn drawn(plan: &SweepPlan, outcome: &Outcome) -> Result<BTreeSet<usize>, ReportError> {
    // The curve of the largest loss lies on every line.
    let sweep = SweepCurves::of(plan, outcome)?;
    let curve = largest(&sweep.curves);
    Ok(curve.map_or(BTreeSet::new(), |curve| {
        cycles_of(curve, &plan.figures.loops_rad_per_s)
    }))
}

/// The cases of a curve whose cycles are shown, where those at some frequencies are asked for or none.
pub fn cycles_of(curve: &Curve<'_>, asked_rad_per_s: &[f64]) -> BTreeSet<usize> {
    let shown = chosen(&curve.results(), asked_rad_per_s, loops::LOOPS).into_iter();
    let shown = shown.chain(curve.largest_result());
    shown.map(|(record, _)| record.index).collect()
}
