//! Where the energy goes in: the work that the indenter does on the surface per cycle and area, along a radius or, under an
//! indenter that is not of revolution, along x through the centre of the work.

use super::curve::{Curve, SweepCurves, chosen};
use super::loops::LOOPS;
use super::plot::Plot;
use super::quantity::{Quantity, WORK_PER_AREA};
use super::trace::{Point, Trace};
use super::units::Measure;
use super::{Drawn, Figure};
use crate::report::caption::Caption;
use crate::report::chart::Color;
use crate::report::number::largest;
use crate::report::words::listed;
use crate::report::work_line::{WorkAlong, WorkLine};
use crate::sweep::record::CaseRecord;

/// A case with its line.
type Profile<'a> = (&'a CaseRecord, WorkLine);

/// The figure, of one curve: profiles nearest to the frequencies asked for (rad/s), or evenly spread over its cases, that of the
/// largest loss among them.
pub fn figure(sweep: &SweepCurves<'_>, curve: &Curve<'_>, asked_rad_per_s: &[f64]) -> Drawn {
    let results = curve.results();
    let profiles: Vec<Profile<'_>> = chosen(&results, asked_rad_per_s, LOOPS)
        .into_iter()
        .map(|(record, result)| {
            let condition = sweep.condition(record).unwrap_or(&curve.condition);
            let indenter = condition.contact.indenter.as_ref();
            (record, WorkLine::of(&result.cycle.surface_loss, indenter))
        })
        .filter(|(_, line)| line.points.iter().any(|(_, density)| density.is_some()))
        .collect();
    if results.is_empty() {
        return Err("no dissipation profile: no case has a result");
    }
    let Some(along) = profiles.first().map(|(_, line)| line.along) else {
        return Err("no dissipation profile: nothing is dissipated");
    };
    let traces = profiles.iter().enumerate().map(|(step, (record, line))| {
        let points = line.points.iter();
        Trace::line(points.map(|(x_m, density)| Point::new(*x_m, *density)))
            .label(sweep.label_of(record))
            .member(sweep.place(record))
            .color(Color::of_family(step, profiles.len()))
    });
    let position = Quantity::new(along.column(), along.label(), Measure::Length);
    let plot = Plot::new(position, WORK_PER_AREA)
        .family(sweep.x.clone())
        .title(curve.label.clone())
        .traces(traces);
    let caption = caption(sweep, curve, &profiles, along);
    Ok(Figure::of(
        "dissipation-profile",
        &[plot],
        caption,
        &sweep.units,
    ))
}

fn caption(
    sweep: &SweepCurves<'_>,
    curve: &Curve<'_>,
    profiles: &[Profile<'_>],
    along: WorkAlong,
) -> Caption {
    let curves = profiles.iter().map(|(record, _)| sweep.label_of(record));
    let curves: Vec<String> = curves.collect();
    let densities = profiles.iter().flat_map(|(_, line)| &line.points);
    let largest = largest(densities.filter_map(|(_, density)| *density));
    Caption::new(format!(
        "Work that the indenter does on the surface per cycle and area, {}",
        along.words()
    ))
    .say_all(curve.sentence.clone())
    .say(format!("Curves: {}.", listed(&curves)))
    .say(format!(
        "Largest: {}. The integral over the surface is the energy loss per cycle.",
        sweep.units.value(Measure::EnergyPerArea, largest, 4)
    ))
}
