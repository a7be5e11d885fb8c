//! Energy loss over frequency and second axis: the map of a sweep of two axes, its peaks as rings.

use super::curve::Curve;
use super::drive_map::{self, Mapped};
use super::units::Units;
use super::{Drawn, Figure};
use crate::quantity::Dimension;
use crate::report::caption::{self, Caption};
use crate::report::number::{largest, with_error};
use crate::sweep::plan::{Axes, SweepPlan};
use crate::sweep::record::CaseRecord;
use crate::sweep::search::run::Outcome;

/// The figure.
pub fn figure(
    plan: &SweepPlan,
    outcome: &Outcome,
    axis: &Axes,
    curves: &[Curve<'_>],
    units: &Units,
) -> Drawn {
    let losses = outcome.records.iter().filter_map(|r| r.energy_loss_j());
    let (factor, unit) = units.energy(largest(losses));
    let rings = outcome
        .peaks
        .iter()
        .filter_map(|peak| Some((peak.angular_frequency_rad_per_s, peak.varied.first()?)));
    let mapped = Mapped {
        value: &|record| Some(factor * record.energy_loss_j()?),
        label: format!("energy loss per cycle / {unit}"),
        rings: rings.collect(),
    };
    let Some(map) = drive_map::map(plan, axis, (curves, units), mapped) else {
        return Drawn::left_out(
            "no loss map: it takes two frequencies with results under each of two values of the second axis",
        );
    };
    let data = drive_map::data(
        axis,
        (curves, units),
        [
            ("energy_loss_j", &CaseRecord::energy_loss_j),
            ("energy_loss_error_j", &CaseRecord::energy_loss_error_j),
        ],
    );
    Drawn::Figure(Figure {
        name: "loss-map",
        picture: map.into(),
        caption: caption(outcome, axis, curves, units),
        data,
    })
}

fn caption(outcome: &Outcome, axis: &Axes, curves: &[Curve<'_>], units: &Units) -> Caption {
    let cases = drive_map::words(curves);
    let (over, varied) = (units.frequency_words(), axis.varied().words());
    let title = format!("Energy loss per cycle over {over} and {varied}");
    let losses = outcome.records.iter().filter_map(|record| {
        let loss_j = record.energy_loss_j()?;
        Some((loss_j, record.energy_loss_error_j()))
    });
    let largest = losses
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(loss_j, error_j)| {
            let loss = with_error(loss_j, error_j, Dimension::Energy);
            format!("Largest computed loss: {loss}.")
        });
    Caption::new(title)
        .say(format!(
            "{cases}; lines: the values labelled at the colour bar; rings: peaks over frequency."
        ))
        .say_all(largest.into_iter().chain(caption::absent(outcome)))
}
