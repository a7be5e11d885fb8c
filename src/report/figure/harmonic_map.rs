//! Second harmonic of the approach over two axes of a sweep: how far the contact is from a linear one.

use super::Drawn;
use super::curve::SweepCurves;
use super::drive_map::{self, Mapped};
use super::quantity::Quantity;
use super::units::Measure;
use crate::drive::Control;
use crate::report::caption::Caption;
use crate::report::number::{largest, scientific};
use crate::sweep::record::CaseRecord;

const SECOND: Quantity = Quantity::new(
    "harmonic_2",
    "second harmonic of the approach over the first",
    Measure::Percent,
);

/// The figure.
pub fn figure(sweep: &SweepCurves<'_>) -> Drawn {
    if sweep.plan.base.drive.control() == Control::Approach {
        return Err("no harmonic-2 map: the approach is prescribed and has none");
    }
    let largest = scientific(100.0 * largest(sweep.records().filter_map(second)), 3);
    let words = sweep.family.as_ref().map_or("", |family| &family.words);
    let caption = Caption::new(format!(
        "Second harmonic of the approach relative to its first, over {} and {words}",
        sweep.x.words
    ));
    drive_map::figure(
        sweep,
        Mapped {
            name: "harmonic-2-map",
            caption: caption.say(format!("Largest computed: {largest} %.")),
            quantity: SECOND,
            value: &second,
            error: &|_| None,
            rings: Vec::new(),
        },
    )
}

fn second(record: &CaseRecord) -> Option<f64> {
    record.result.as_ref()?.analysis.approach_harmonic(2)
}
