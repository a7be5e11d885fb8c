//! Hysteresis loops: load against approach at a few frequencies of the sweep, or of every material or indenter of a list.

use super::Figure;
use super::curve::{Curve, SweepCurves, chosen, largest};
use super::plot::Plot;
use super::quantity::{APPROACH, LOAD};
use super::trace::Trace;
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::Color;
use crate::report::number::with_error;
use crate::report::words::listed;
use crate::sweep::record::{CaseRecord, CaseResult, Status};

/// Loops in one figure; more cannot be told apart.
pub const LOOPS: usize = 5;

/// A loop, and what it is called.
pub struct Shown<'a> {
    label: String,
    pub record: &'a CaseRecord,
    result: &'a CaseResult,
}

/// The loops that are drawn. Of the curve of the largest loss those nearest to the frequencies asked for, or some evenly spread, the one of
/// the largest loss among them; of a list of materials or indenters that of the largest loss of each.
pub fn shown<'a>(sweep: &SweepCurves<'a>) -> Vec<Shown<'a>> {
    let at = |record: &CaseRecord| {
        sweep
            .units
            .frequency_label(record.angular_frequency_rad_per_s)
    };
    if !sweep.is_of_one_curve() {
        let of_curve = |curve: &&Curve<'a>| {
            let (record, result) = curve.largest_result()?;
            let label = format!("{}, {}", curve.label.as_deref()?, at(record));
            Some(Shown {
                label,
                record,
                result,
            })
        };
        return sweep.shown(LOOPS).iter().filter_map(of_curve).collect();
    }
    let results = largest(&sweep.curves).map_or(Vec::new(), Curve::results);
    let asked = &sweep.plan.figures.loops_rad_per_s;
    let chosen = chosen(&results, asked, LOOPS).into_iter();
    let shown = chosen.map(|(record, result)| Shown {
        label: sweep.label_of(record),
        record,
        result,
    });
    shown.collect()
}

/// The figure.
pub fn figure(sweep: &SweepCurves<'_>) -> Figure {
    let shown = shown(sweep);
    let of = shown.len();
    let traces = shown.iter().enumerate().map(|(step, one)| {
        let samples = &one.result.cycle.samples;
        let points = samples.approach_m.iter().zip(&samples.load_n);
        Trace::line(points.map(|(approach_m, load_n)| (*approach_m, *load_n)))
            .label(&one.label)
            .member(sweep.place(one.record))
            .color(Color::of_family(step, of))
    });
    let curve = largest(&sweep.curves).filter(|_| sweep.is_of_one_curve());
    let plot = Plot::new(APPROACH, LOAD)
        .family(curve.map(|_| sweep.x.clone()))
        .title(curve.and_then(|curve| curve.label.clone()))
        .traces(traces);
    let caption = caption(curve, &shown);
    Figure::of("loops", &[plot], caption, &sweep.units)
}

fn caption(curve: Option<&Curve<'_>>, shown: &[Shown<'_>]) -> Caption {
    let loops = shown.iter().map(|one| {
        let loss_j = one.result.analysis.energy_loss_j;
        let loss = with_error(loss_j, one.record.energy_loss_error_j(), Dimension::Energy);
        format!("{loss} at {}", one.label)
    });
    let loops: Vec<String> = loops.collect();
    let mut records = shown.iter().map(|one| one.record.status);
    let (of, areas) = match records.any(|status| status == Status::Transient) {
        true => (
            "a cycle on the way to the stabilised one",
            "The areas that they have once a straight line has closed them",
        ),
        false => ("the stabilised cycle", "Their areas"),
    };
    Caption::new(format!("Hysteresis loops: load W over approach δ in {of}"))
        .say_all(curve.and_then(|curve| curve.sentence.clone()))
        .say(format!(
            "{areas} are the energy losses per cycle: {}.",
            listed(&loops)
        ))
}
