//! Second harmonic of the approach over frequency and drive: how far the contact is from a linear one.

use super::curve::Curve;
use super::drive_map::{self, Mapped};
use super::{Drawn, Figure};
use crate::drive::Control;
use crate::report::ReportError;
use crate::sweep::plan::{DriveAxis, SweepPlan};
use crate::sweep::record::CaseRecord;

/// The figure.
///
/// # Errors
/// Where the table behind it cannot be made.
pub fn figure(
    plan: &SweepPlan,
    axis: &DriveAxis,
    curves: &[Curve<'_>],
) -> Result<Drawn, ReportError> {
    if plan.drive.control() == Control::Approach {
        return Ok(Drawn::left_out(
            "no harmonic-2 map: the approach is prescribed and has none",
        ));
    }
    let mapped = Mapped {
        value: &|record| Some(100.0 * second(record)?),
        label: "second harmonic of the approach / % of the first".to_owned(),
        rings: Vec::new(),
    };
    let Some(map) = drive_map::map(plan, axis, curves, mapped) else {
        return Ok(Drawn::left_out(
            "no harmonic-2 map: it takes two frequencies and two drives with results",
        ));
    };
    Ok(Drawn::Figure(Figure {
        name: "harmonic-2-map",
        picture: map.into(),
        data: drive_map::data("harmonic-2-map.csv", curves, &[("harmonic_2", &second)])?,
    }))
}

fn second(record: &CaseRecord) -> Option<f64> {
    record.result.as_ref()?.analysis.approach_harmonic(2)
}
