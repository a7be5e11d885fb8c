//! All figures of a sweep, as far as they apply to it.

use std::collections::BTreeSet;

use super::curve::{Curve, chosen, curves, largest};
use super::equivalent::Equivalent;
use super::line::{self, Line};
use super::units::Units;
use super::{
    Drawn, Figure, cole_cole, dissipation, dissipation_map, dissipation_profile, energy_loss,
    harmonic_map, loops, loss_map, loss_tangent, moduli, moduli_error, peaks_over_axis,
    van_gurp_palmen,
};
use crate::report::ReportError;
use crate::sweep::plan::{SweepPlan, axes};
use crate::sweep::record::{CaseRecord, CaseResult};
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
    let along = line::along(plan, outcome, 0);
    let (one_plan, one) = along
        .as_ref()
        .map_or((plan, outcome), |line| (&line.plan, &line.outcome));
    let mut drawn = of_first_axis(one_plan, one)?;
    if let Some(line) = &along {
        drawn = drawn.into_iter().map(|drawn| line.say(drawn)).collect();
    }
    let lines = (1..axes::MOST).map_while(|axis| Some((axis, line::along(plan, outcome, axis)?)));
    for (axis, line) in lines {
        let others = of_other_axis(axis, &line)?.into_iter();
        drawn.extend(others.map(|drawn| line.say(drawn)));
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

fn of_first_axis(plan: &SweepPlan, outcome: &Outcome) -> Result<Vec<Drawn>, ReportError> {
    let units = &Units::of_sweep(plan)?;
    let asked = &plan.figures.loops_rad_per_s;
    let curves = curves(plan, outcome, units);
    let Some(curve) = largest(&curves).filter(|curve| !curve.results().is_empty()) else {
        let why = "no figures: no case converged, so there is nothing to draw";
        return Ok(vec![Drawn::left_out(why)]);
    };
    let mut drawn = vec![
        Drawn::Figure(energy_loss::figure(plan, outcome, &curves, units)),
        Drawn::Figure(loops::figure(curve, asked, units)),
        dissipation::figure(curve, units),
        dissipation_profile::figure(curve, asked, units),
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
    // Names have no order to draw along.
    if let Some(axes) = plan.axes.as_ref().filter(|axes| !axes.varied().is_whole()) {
        drawn.extend([
            loss_map::figure(plan, outcome, axes, &curves, units),
            harmonic_map::figure(plan, axes, &curves, units),
            moduli_error::figure(plan, outcome, axes, &curves, units),
            peaks_over_axis::figure(plan, outcome, axes, units),
        ]);
    }
    Ok(drawn)
}

/// Names of the figures over the second, third and fourth axis.
const OF_OTHER_AXES: [[&str; 3]; axes::MOST - 1] = [
    ["energy-loss-2", "loss-map-2", "peaks-2"],
    ["energy-loss-3", "loss-map-3", "peaks-3"],
    ["energy-loss-4", "loss-map-4", "peaks-4"],
];

fn of_other_axis(axis: usize, line: &Line) -> Result<Vec<Drawn>, ReportError> {
    let (plan, outcome) = (&line.plan, &line.outcome);
    let units = &Units::of_sweep(plan)?;
    let curves = curves(plan, outcome, units);
    let (Some(names), Some(axes)) = (OF_OTHER_AXES.get(axis - 1), &plan.axes) else {
        return Ok(Vec::new());
    };
    let has_results = curves.iter().any(|curve| !curve.results().is_empty());
    let drawn = match has_results {
        false => Vec::new(),
        true if axes.varied().is_whole() => {
            vec![Drawn::Figure(energy_loss::figure(
                plan, outcome, &curves, units,
            ))]
        }
        true => vec![
            Drawn::Figure(energy_loss::figure(plan, outcome, &curves, units)),
            loss_map::figure(plan, outcome, axes, &curves, units),
            peaks_over_axis::figure(plan, outcome, axes, units),
        ],
    };
    let named = drawn
        .into_iter()
        .zip(names)
        .map(|(drawn, name)| match drawn {
            Drawn::Figure(figure) => Drawn::Figure(Figure { name, ..figure }),
            left_out => left_out,
        });
    Ok(named.collect())
}

/// The cases whose cycles the figures show: of the curve of the largest loss.
///
/// # Errors
/// As [`figures`].
pub fn drawn(plan: &SweepPlan, outcome: &Outcome) -> Result<BTreeSet<usize>, ReportError> {
    let units = Units::of_sweep(plan)?;
    // The curve of the largest loss lies on every line.
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
