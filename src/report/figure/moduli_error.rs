//! What the indentation formula gets wrong: the relative difference of the equivalent moduli from the material's own, over an axis
//! of a sweep.

use super::curve::SweepCurves;
use super::equivalent::{LoopModulus, largest_differences};
use super::quantity::Quantity;
use super::trace::{Point, Trace};
use super::units::Measure;
use super::{Drawn, Figure};
use crate::report::caption::Caption;
use crate::report::chart::{LegendPlace, Marker};

/// Curves in one figure; more cannot be told apart.
const CURVES: usize = 5;

const STORAGE: Quantity = Quantity::new(
    "storage_relative_difference",
    "error of E′ from the loop",
    Measure::Percent,
);
const LOSS: Quantity = Quantity::new(
    "loss_relative_difference",
    "error of E″ from the loop",
    Measure::Percent,
);

/// The figure of a sweep over an axis: storage modulus above, loss modulus below.
pub fn figure(sweep: &SweepCurves<'_>) -> Drawn {
    let shown = sweep.shown(CURVES);
    let loops: Vec<Vec<(f64, Option<LoopModulus<'_>>)>> = shown
        .iter()
        .map(|curve| {
            let records = curve.records.iter();
            let of = |record| LoopModulus::of(sweep, record);
            records
                .map(|&record| (sweep.place(record), of(record)))
                .collect()
        })
        .collect();
    let found = || loops.iter().flatten().filter_map(|(_, at)| at.as_ref());
    if found().count() < 2 {
        return Err("no figure of the error of the moduli: too few loops have moduli");
    }
    let plot = |y: Quantity, difference: fn(&LoopModulus<'_>) -> Option<f64>| {
        let traces = shown
            .iter()
            .zip(&loops)
            .enumerate()
            .map(|(step, (curve, loops))| {
                let point = |(x, at): &(f64, Option<LoopModulus<'_>>)| {
                    Point::new(*x, at.as_ref().and_then(difference))
                };
                Trace::line(loops.iter().map(point))
                    .marker(Marker::Disc)
                    .of_family(step, shown.len())
                    .maybe_label(curve.label.clone())
                    .member(curve.member)
                    .smooth([])
            });
        sweep
            .plot(y)
            .traces(traces)
            .legend(Some(LegendPlace::Above))
    };
    let plots = [
        plot(STORAGE, |at| Some(at.storage_difference())),
        plot(LOSS, |at| at.loss_difference()),
    ];
    let [storage, loss] = largest_differences(found);
    let caption = Caption::new(format!(
        "Relative difference of the moduli that indentation reads from the hysteresis loops from those of the material, storage \
         modulus E′ above and loss modulus E″ below, {}",
        sweep.over_words(shown.len())
    ))
    .say(format!("Largest drawn: {storage} % in E′, {loss} % in E″."));
    Ok(Figure::of("moduli-error", &plots, caption, &sweep.units))
}
