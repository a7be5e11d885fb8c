//! What the indentation formula gets wrong: the relative difference of the equivalent moduli from the material's own, over the
//! second axis of a sweep.

use super::curve::{SweepCurves, evenly};
use super::equivalent::{self, LoopModulus, of_loops};
use super::{Drawn, Figure, Picture, axis};
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, LegendPlace, Marker, Series};
use crate::report::number::{largest, range};
use crate::sweep::plan::Axes;

/// Frequencies in one figure; more cannot be told apart.
const FREQUENCIES: usize = 5;
/// Values that vary by more than this have a logarithmic axis.
pub(super) const WIDE: f64 = 5.0;

/// One frequency: (varied number, what the loop there gives), where it gives anything.
type Row<'a> = Vec<(f64, Option<LoopModulus<'a>>)>;

/// The figure: storage modulus above, loss modulus below, one curve per frequency.
pub fn figure(sweep: &SweepCurves<'_>, over: &Axes) -> Drawn {
    let units = &sweep.units;
    let rows = rows(sweep);
    let loops = rows.iter().flat_map(|(_, row)| row);
    if loops.filter_map(|(_, at)| *at).count() < 2 {
        return Err("no figure of the error of the moduli: too few loops have moduli");
    }
    let unit = &units.varied(&over.varied(), largest(sweep.values().map(f64::abs)));
    let label = unit.title(&over.varied(), sweep.plan.base.drive.control());
    let x_axis = |label: String| axis(range(sweep.values()), WIDE, label);
    let series = |difference: fn(&LoopModulus<'_>) -> Option<f64>| {
        let of = rows.len();
        let series = rows.iter().enumerate().map(move |(step, (omega, row))| {
            let points = row.iter().map(|(value, at)| {
                let percent = 100.0 * difference(at.as_ref()?)?;
                Some((unit.of(*value), percent))
            });
            Series::line(points)
                .marker(Marker::nth(step))
                .color(Color::Ramp { step, of })
                .label(units.frequency_label(*omega))
        });
        series.collect::<Vec<_>>()
    };
    let storage = Chart::new(
        x_axis(String::new()),
        Axis::linear("error of E′ from the loop / %"),
    )
    .all_series(series(|at| Some(at.storage_difference())))
    .legend(LegendPlace::Above)
    .size(800, 380);
    let loss = Chart::new(x_axis(label), Axis::linear("error of E″ from the loop / %"))
        .all_series(series(|at| at.loss_difference()))
        .legend(None)
        .size(800, 360);
    Ok(Figure {
        name: "moduli-error",
        picture: Picture(vec![storage, loss]),
        caption: caption(over, &rows),
        data: equivalent::table(sweep),
    })
}

fn caption(axis: &Axes, rows: &[(f64, Row<'_>)]) -> Caption {
    let varied = axis.varied().words();
    let loops = || {
        rows.iter()
            .flat_map(|(_, row)| row)
            .filter_map(|(_, at)| at.as_ref())
    };
    let [storage, loss] = equivalent::largest_differences(loops);
    Caption::new(format!(
        "Relative difference of the moduli that indentation reads from the hysteresis loops from those of the material, storage \
         modulus E′ above and loss modulus E″ below, over the {varied}"
    ))
    .say(format!("Largest: {storage} % in E′, {loss} % in E″."))
}

/// Some of the planned frequencies, each over the second axis.
fn rows<'a>(sweep: &SweepCurves<'a>) -> Vec<(f64, Row<'a>)> {
    let curves = sweep.curves.iter();
    let loops: Vec<(f64, Vec<LoopModulus<'a>>)> = curves
        .filter_map(|curve| Some((curve.condition.number()?, of_loops(curve))))
        .collect();
    let planned = &sweep.plan.angular_frequencies_rad_per_s;
    let some = evenly(planned.len(), FREQUENCIES).into_iter();
    some.filter_map(|k| planned.get(k))
        .map(|&omega| {
            let row = loops.iter().map(|(value, loops)| {
                let at = loops.iter().find(|at| at.omega() == omega);
                (*value, at.copied())
            });
            (omega, row.collect())
        })
        .collect()
}
