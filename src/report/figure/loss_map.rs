//! Energy loss over frequency and second axis: the map of a sweep of two axes, its peaks as rings.

use super::curve::SweepCurves;
use super::drive_map::{self, Mapped};
use super::{Drawn, Figure};
use crate::quantity::Dimension;
use crate::report::caption::{self, Caption};
use crate::report::number::{largest, with_error};
use crate::sweep::plan::Axes;
use crate::sweep::record::CaseRecord;

/// The figure.
pub fn figure(sweep: &SweepCurves<'_>, axes: &Axes) -> Drawn {
    let records = || sweep.outcome.records.iter();
    let losses = records().filter_map(CaseRecord::energy_loss_j);
    let (factor, unit) = sweep.units.energy(largest(losses));
    let peaks = sweep.outcome.peaks.iter();
    let mapped = Mapped {
        value: &|record| Some(factor * record.energy_loss_j()?),
        label: format!("energy loss per cycle / {unit}"),
        rings: peaks
            .filter_map(|peak| {
                Some((
                    peak.angular_frequency_rad_per_s,
                    peak.varied.first_number()?,
                ))
            })
            .collect(),
    };
    let chart = drive_map::chart(sweep, axes, mapped).ok_or(
        "no loss map: it takes two frequencies with results under each of two values of the second axis",
    )?;
    let losses = records().filter_map(|r| Some((r.energy_loss_j()?, r.energy_loss_error_j())));
    let largest = losses.max_by(|a, b| a.0.total_cmp(&b.0));
    let largest = largest.map(|(loss_j, error_j)| {
        let loss = with_error(loss_j, error_j, Dimension::Energy);
        format!("Largest computed loss: {loss}.")
    });
    Ok(Figure {
        name: "loss-map",
        picture: chart.into(),
        caption: Caption::new(format!(
            "Energy loss per cycle over {} and {}",
            sweep.units.frequency_words(),
            axes.varied().words()
        ))
        .say(format!(
            "{}; lines: the values labelled at the colour bar; rings: peaks over frequency.",
            drive_map::words(sweep)
        ))
        .say_all(largest.into_iter().chain(caption::absent(sweep.outcome))),
        data: drive_map::data(
            sweep,
            &[
                ("energy_loss_j", &CaseRecord::energy_loss_j),
                ("energy_loss_error_j", &CaseRecord::energy_loss_error_j),
            ],
        ),
    })
}
