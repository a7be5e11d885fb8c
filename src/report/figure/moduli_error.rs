//! What the indentation formula gets wrong: the relative difference of the equivalent moduli from the material's own, over the
//! amplitude or the mean of the drive.

use super::curve::{Curve, evenly};
use super::equivalent::{self, LoopModulus, of_loops};
use super::units::Units;
use super::{Drawn, Figure, Picture, axis};
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, LegendPlace, Marker, Series};
use crate::report::number::{largest, range};
use crate::sweep::plan::{DriveAxis, SweepPlan};
use crate::sweep::search::run::Outcome;

/// Frequencies in one figure; more cannot be told apart.
const FREQUENCIES: usize = 5;
/// Values of the drive that vary by more than this have a logarithmic axis.
pub(super) const WIDE: f64 = 5.0;

/// One frequency: (value of the drive, what the loop there gives), where it gives anything.
type Row<'a> = Vec<(f64, Option<LoopModulus<'a>>)>;

/// The figure: storage modulus above, loss modulus below, one curve per frequency.
pub fn figure(
    plan: &SweepPlan,
    outcome: &Outcome,
    drives: &DriveAxis,
    curves: &[Curve<'_>],
    units: &Units,
) -> Drawn {
    let rows = rows(plan, drives, curves);
    let loops = rows.iter().flat_map(|(_, row)| row);
    if loops.filter_map(|(_, at)| *at).count() < 2 {
        return Drawn::left_out("no figure of the error of the moduli: too few loops have moduli");
    }
    let control = plan.drive.control();
    let values = || curves.iter().map(|curve| drives.varied.value(&curve.drive));
    let (factor, unit) = units.drive(control, largest(values().map(f64::abs)));
    let name = format!("{} {}", control.name(), drives.varied.name());
    let label = format!("{name} / {unit}");
    let x_axis = |label: String| axis(range(values()), WIDE, label);
    let series = |difference: fn(&LoopModulus<'_>) -> Option<f64>| {
        let of = rows.len();
        let series = rows.iter().enumerate().map(move |(step, (omega, row))| {
            let points = row.iter().map(|(value, at)| {
                let percent = 100.0 * difference(at.as_ref()?)?;
                Some((factor * value, percent))
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
    Drawn::Figure(Figure {
        name: "moduli-error",
        picture: Picture::Stack(vec![storage, loss]),
        caption: caption(drives, &rows),
        data: equivalent::table(plan, outcome, units),
    })
}

fn caption(axis: &DriveAxis, rows: &[(f64, Row<'_>)]) -> Caption {
    let varied = axis.varied.name();
    let loops = || {
        rows.iter()
            .flat_map(|(_, row)| row)
            .filter_map(|(_, at)| at.as_ref())
    };
    let [storage, loss] = equivalent::largest_differences(loops);
    Caption::new(format!(
        "Relative difference of the moduli that indentation reads from the hysteresis loops from those of the material, storage \
         modulus E′ above and loss modulus E″ below, over the {varied} of the drive"
    ))
    .say(format!("Largest: {storage} % in E′, {loss} % in E″."))
}

/// Some of the planned frequencies, each over the drives.
fn rows<'a>(plan: &SweepPlan, axis: &DriveAxis, curves: &[Curve<'a>]) -> Vec<(f64, Row<'a>)> {
    let loops: Vec<(f64, Vec<LoopModulus<'a>>)> = curves
        .iter()
        .map(|curve| {
            (
                axis.varied.value(&curve.drive),
                of_loops(&plan.material, curve),
            )
        })
        .collect();
    let planned = &plan.angular_frequencies_rad_per_s;
    evenly(planned.len(), FREQUENCIES)
        .into_iter()
        .filter_map(|k| planned.get(k))
        .map(|&omega| {
            let at =
                |loops: &[LoopModulus<'a>]| loops.iter().find(|at| at.omega() == omega).copied();
            let row = loops.iter().map(|(value, loops)| (*value, at(loops)));
            (omega, row.collect())
        })
        .collect()
}
