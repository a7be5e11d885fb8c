//! Energy loss over two axes of a sweep as a map, its peaks as rings.

use super::Drawn;
use super::curve::SweepCurves;
use super::drive_map::{self, Mapped};
use super::quantity::ENERGY_LOSS;
use crate::quantity::Dimension;
use crate::report::caption::{self, Caption};
use crate::report::number::with_error;
use crate::sweep::record::CaseRecord;

/// The figure.
pub fn figure(sweep: &SweepCurves<'_>) -> Drawn {
    let peaks = sweep.curves.iter().flat_map(|curve| {
        let peaks = sweep.peaks_of(curve);
        peaks.filter_map(|peak| Some((peak.angular_frequency_rad_per_s, curve.member?)))
    });
    let rings: Vec<(f64, f64)> = peaks.collect();
    let losses = sweep
        .records()
        .filter_map(|r| Some((r.energy_loss_j()?, r.energy_loss_error_j())));
    let largest = losses.max_by(|a, b| a.0.total_cmp(&b.0));
    let largest = largest.map(|(loss_j, error_j)| {
        let loss = with_error(loss_j, error_j, Dimension::Energy);
        format!("Largest computed loss: {loss}.")
    });
    let pointed = (!rings.is_empty()).then(|| "Rings: peaks over frequency.".to_owned());
    let words = sweep.family.as_ref().map_or("", |family| &family.words);
    let caption = Caption::new(format!(
        "Energy loss per cycle over {} and {words}",
        sweep.x.words
    ));
    drive_map::figure(
        sweep,
        Mapped {
            name: "loss-map",
            caption: caption.say_all(
                largest
                    .into_iter()
                    .chain(pointed)
                    .chain(caption::absent(sweep.outcome)),
            ),
            quantity: ENERGY_LOSS,
            value: &CaseRecord::energy_loss_j,
            error: &CaseRecord::energy_loss_error_j,
            rings,
        },
    )
}
