//! All figures of a sweep, as far as they apply to it.

use std::collections::BTreeSet;

use super::curve::{Abscissa, Curve, SweepCurves, chosen, largest};
use super::line::{self, Line};
use super::{
    Drawn, Figure, attracted, dissipation, dissipation_map, dissipation_profile, energy_loss,
    harmonic_map, loops, loss_map, moduli, moduli_error, peaks_over_axis,
};
use crate::report::ReportError;
use crate::sweep::plan::{SweepPlan, Varied};
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
    let over = Abscissa::of(plan);
    let mut drawn = match (over, line::along(plan, outcome, 0)) {
        (Abscissa::Frequency, Some(line)) => {
            said(&line, of_main_axis(&line.curves(Abscissa::Frequency)?))
        }
        _ => of_main_axis(&SweepCurves::of(plan, outcome, over)?),
    };
    if over == Abscissa::Frequency {
        drawn.extend(over_axes(plan, outcome)?);
    }
    let (mut figures, mut left_out) = (Vec::new(), Vec::new());
    for drawn in drawn {
        match drawn {
            Ok(figure) => figures.push(figure),
            Err(why) if left_out.iter().any(|known| known == why) => {}
            Err(why) => left_out.push(why.to_owned()),
        }
    }
    Ok((figures, left_out))
}

fn said(line: &Line, drawn: Vec<Drawn>) -> Vec<Drawn> {
    let said = |drawn: Drawn| drawn.map(|figure| line.say(figure));
    drawn.into_iter().map(said).collect()
}

/// Over frequency, or over the first axis of numbers at one frequency.
fn of_main_axis(sweep: &SweepCurves<'_>) -> Vec<Drawn> {
    let plan = sweep.plan;
    let asked = &plan.figures.loops_rad_per_s;
    let Some(curve) = largest(&sweep.curves).filter(|curve| !curve.results().is_empty()) else {
        return vec![Err(
            "no figures: no case converged, so there is nothing to draw",
        )];
    };
    let mut drawn = vec![Ok(energy_loss::figure(sweep)), Ok(loops::figure(sweep))];
    match plan.is_attracted() {
        true => drawn.extend(attracted::figures(sweep, curve)),
        false => drawn.extend([
            dissipation::figure(sweep, curve),
            dissipation_profile::figure(sweep, curve, asked),
            dissipation_map::figure(sweep, curve),
        ]),
    }
    drawn.extend(moduli::of_sweep(sweep));
    if sweep.family.is_some() && sweep.curves.len() > 1 {
        drawn.extend([loss_map::figure(sweep), harmonic_map::figure(sweep)]);
    }
    match (sweep.over, &plan.axes) {
        (Abscissa::Axis(_), _) => drawn.push(moduli_error::figure(sweep)),
        (Abscissa::Frequency, Some(axes)) if !axes.varied().is_whole() => {
            drawn.push(peaks_over_axis::figure(sweep, axes));
        }
        (Abscissa::Frequency, _) => {}
    }
    drawn
}

/// Over each axis of numbers: the loss and the moduli at some frequencies, and of all axes but the first, which the main figures
/// show, the loss over frequency and the peaks.
fn over_axes(plan: &SweepPlan, outcome: &Outcome) -> Result<Vec<Drawn>, ReportError> {
    let over = plan.axes.as_ref().map_or(&[][..], |axes| &axes.over);
    let mut drawn = Vec::new();
    for (axis, varied) in over.iter().enumerate() {
        let line = line::along(plan, outcome, axis);
        let (plan, outcome) = match &line {
            Some(line) => (&line.plan, &line.outcome),
            // Of pairs, the first axis shows all.
            None if axis > 0 => continue,
            None => (plan, outcome),
        };
        let mut of_axis = Vec::new();
        if !varied.is_whole() {
            let sweep = SweepCurves::of(plan, outcome, Abscissa::Axis(0))?;
            of_axis.extend(of_values(&sweep, axis, &ending(over, axis)));
        }
        if axis > 0 {
            let sweep = SweepCurves::of(plan, outcome, Abscissa::Frequency)?;
            of_axis.extend(of_other_axis(axis, &sweep));
        }
        match &line {
            Some(line) => drawn.extend(said(line, of_axis)),
            None => drawn.extend(of_axis),
        }
    }
    Ok(drawn)
}

/// The figures over the values of an axis.
fn of_values(sweep: &SweepCurves<'_>, axis: usize, ending: &str) -> Vec<Drawn> {
    if sweep.records().all(|record| record.result.is_none()) {
        return Vec::new();
    }
    let named = |figure: Figure| Figure {
        name: format!("{}-over-{ending}", figure.name).into(),
        ..figure
    };
    let of_moduli = moduli::over_axis(sweep).map(|figure| Ok(named(figure)));
    [Ok(named(energy_loss::figure(sweep)))]
        .into_iter()
        .chain(of_moduli)
        .chain([
            moduli_error::figure(sweep).map(|error| if axis == 0 { error } else { named(error) })
        ])
        .collect()
}

/// What names of figures over an axis end with: its key, and where several axes have it, its block too.
fn ending(over: &[Varied], axis: usize) -> String {
    let slug = |text: &str| {
        let letters = text.chars();
        let letters = letters.map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_lowercase()
            } else {
                '-'
            }
        });
        let text: String = letters.collect();
        let words = text.split('-').filter(|word| !word.is_empty());
        words.collect::<Vec<_>>().join("-")
    };
    let varied = &over[axis];
    let name = slug(&varied.name());
    let same = over.iter().filter(|other| slug(&other.name()) == name);
    match same.count() {
        1 => name,
        _ => slug(&varied.path()),
    }
}

/// The loss over frequency with curves of the second, third or fourth axis, its map and its peaks.
fn of_other_axis(axis: usize, sweep: &SweepCurves<'_>) -> Vec<Drawn> {
    let Some(axes) = &sweep.plan.axes else {
        return Vec::new();
    };
    if sweep.records().all(|record| record.result.is_none()) {
        return Vec::new();
    }
    let mut drawn = vec![Ok(energy_loss::figure(sweep))];
    if !axes.varied().is_whole() {
        drawn.push(loss_map::figure(sweep));
        drawn.push(peaks_over_axis::figure(sweep, axes));
    }
    let named = |figure: Figure| Figure {
        name: format!("{}-{}", figure.name, axis + 1).into(),
        ..figure
    };
    drawn.into_iter().map(|drawn| drawn.map(named)).collect()
}

/// The cases whose cycles the figures show.
///
/// # Errors
/// As [`figures`].
pub fn drawn(plan: &SweepPlan, outcome: &Outcome) -> Result<BTreeSet<usize>, ReportError> {
    // The curve of the largest loss lies on every line.
    let sweep = SweepCurves::of(plan, outcome, Abscissa::of(plan))?;
    let mut cases = match largest(&sweep.curves) {
        Some(curve) => cycles_of(curve, &plan.figures.loops_rad_per_s),
        None => BTreeSet::new(),
    };
    cases.extend(loops::shown(&sweep).iter().map(|one| one.record.index));
    Ok(cases)
}

/// The cases of a curve whose cycles are shown, where those at some frequencies are asked for or none.
pub fn cycles_of(curve: &Curve<'_>, asked_rad_per_s: &[f64]) -> BTreeSet<usize> {
    let shown = chosen(&curve.results(), asked_rad_per_s, loops::LOOPS).into_iter();
    let shown = shown.chain(curve.largest_result());
    shown.map(|(record, _)| record.index).collect()
}
