//! Second harmonic of the approach over frequency and second axis: how far the contact is from a linear one.

use super::curve::Curve;
use super::drive_map::{self, Mapped};
use super::units::Units;
use super::{Drawn, Figure};
use crate::drive::Control;
use crate::report::caption::Caption;
use crate::report::number::{largest, scientific};
use crate::sweep::plan::{Axes, SweepPlan};
use crate::sweep::record::CaseRecord;

/// The figure.
pub fn figure(plan: &SweepPlan, axis: &Axes, curves: &[Curve<'_>], units: &Units) -> Drawn {
    if plan.drive.control() == Control::Approach {
        return Drawn::left_out("no harmonic-2 map: the approach is prescribed and has none");
    }
    let mapped = Mapped {
        value: &|record| Some(100.0 * second(record)?),
        label: "second harmonic of the approach / % of the first".to_owned(),
        rings: Vec::new(),
    };
    let Some(map) = drive_map::map(plan, axis, (curves, units), mapped) else {
        return Drawn::left_out(
            "no harmonic-2 map: it takes two frequencies with results under each of two values of the second axis",
        );
    };
    Drawn::Figure(Figure {
        name: "harmonic-2-map",
        picture: map.into(),
        caption: caption(axis, curves, units),
        data: drive_map::data(axis, (curves, units), [("harmonic_2", &second)]),
    })
}

fn second(record: &CaseRecord) -> Option<f64> {
    record.result.as_ref()?.analysis.approach_harmonic(2)
}

fn caption(axis: &Axes, curves: &[Curve<'_>], units: &Units) -> Caption {
    let (over, varied) = (units.frequency_words(), axis.varied().words());
    let title =
        format!("Second harmonic of the approach relative to its first, over {over} and {varied}");
    let values = curves.iter().flat_map(|curve| &curve.records);
    let values = values.filter_map(|record| second(record));
    let largest = scientific(100.0 * largest(values), 3);
    Caption::new(title)
        .say(format!(
            "{}; lines: the values labelled at the colour bar.",
            drive_map::words(curves)
        ))
        .say(format!("Largest computed: {largest} %."))
}
