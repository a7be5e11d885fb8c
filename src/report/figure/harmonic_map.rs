//! Second harmonic of the approach over frequency and second axis: how far the contact is from a linear one.

use super::curve::SweepCurves;
use super::drive_map::{self, Mapped};
use super::{Drawn, Figure};
use crate::drive::Control;
use crate::report::caption::Caption;
use crate::report::number::{largest, scientific};
use crate::sweep::plan::Axes;
use crate::sweep::record::CaseRecord;

/// The figure.
pub fn figure(sweep: &SweepCurves<'_>, axes: &Axes) -> Drawn {
    if sweep.plan.base.drive.control() == Control::Approach {
        return Err("no harmonic-2 map: the approach is prescribed and has none");
    }
    let mapped = Mapped {
        value: &|record| Some(100.0 * second(record)?),
        label: "second harmonic of the approach / % of the first".to_owned(),
        rings: Vec::new(),
    };
    let chart = drive_map::chart(sweep, axes, mapped).ok_or(
        "no harmonic-2 map: it takes two frequencies with results under each of two values of the second axis",
    )?;
    let largest = scientific(100.0 * largest(sweep.records().filter_map(second)), 3);
    Ok(Figure {
        name: "harmonic-2-map",
        picture: chart.into(),
        caption: Caption::new(format!(
            "Second harmonic of the approach relative to its first, over {} and {}",
            sweep.units.frequency_words(),
            axes.varied().words()
        ))
        .say(format!(
            "{}; lines: the values labelled at the colour bar.",
            drive_map::words(sweep)
        ))
        .say(format!("Largest computed: {largest} %.")),
        data: drive_map::data(sweep, &[("harmonic_2", &second)]),
    })
}

fn second(record: &CaseRecord) -> Option<f64> {
    record.result.as_ref()?.analysis.approach_harmonic(2)
}
