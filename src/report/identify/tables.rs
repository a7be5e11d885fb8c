//! The tables of an identification: measured and computed numbers, and the moduli with their bands.

use super::IdentifyReport;
use crate::report::table::{cells, csv};

/// Points of the moduli over a decade, and how far beyond the data they go.
const PER_DECADE: f64 = 20.0;
const BEYOND: f64 = 3.0;

/// `fit.csv`: every number as measured and as computed, with the 95 % band of the computed one.
pub fn fit(report: &IdentifyReport<'_>) -> Vec<u8> {
    let rows = report.found.compared.iter().map(|c| {
        cells![
            c.place,
            c.number.column(),
            c.measured,
            c.error,
            c.computed,
            c.computed / c.factor,
            c.computed * c.factor,
        ]
    });
    let columns = [
        place_column(report),
        "column",
        "measured",
        "error",
        "computed",
        "computed_low",
        "computed_high",
    ];
    csv(&columns, rows)
}

/// The column of the place of a number: a frequency, or a time.
fn place_column(report: &IdentifyReport<'_>) -> &'static str {
    match report.plan.measurements.is_history() {
        true => "time_s",
        false => "angular_frequency_rad_per_s",
    }
}

/// `moduli.csv`: E' and E'' with their 95 % bands, over the data and a little beyond.
pub fn moduli(report: &IdentifyReport<'_>) -> Vec<u8> {
    let rows = frequencies(report).into_iter().map(|omega| {
        let band = report.found.band(omega);
        cells![
            omega,
            band.storage_pa,
            band.storage_pa / band.storage_factor,
            band.storage_pa * band.storage_factor,
            band.loss_pa,
            band.loss_pa / band.loss_factor,
            band.loss_pa * band.loss_factor,
        ]
    });
    let columns = [
        "angular_frequency_rad_per_s",
        "storage_modulus_pa",
        "storage_modulus_low_pa",
        "storage_modulus_high_pa",
        "loss_modulus_pa",
        "loss_modulus_low_pa",
        "loss_modulus_high_pa",
    ];
    csv(&columns, rows)
}

/// Angular frequencies (rad/s) for smooth curves of the moduli.
pub fn frequencies(report: &IdentifyReport<'_>) -> Vec<f64> {
    let (lowest, highest) = report.found.window_rad_per_s;
    let (low, high) = (lowest / BEYOND, highest * BEYOND);
    let count = (PER_DECADE * (high / low).log10()).ceil().max(1.0);
    (0..=count as usize)
        .map(|k| low * (high / low).powf(k as f64 / count))
        .collect()
}
