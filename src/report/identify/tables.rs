//! The tables of an identification: measured and computed numbers, and the moduli with their bands.

use super::IdentifyReport;
use crate::identify::ModulusBand;
use crate::report::table::{Cell, cells, csv};

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
    let place = match report.plan.measurements.is_history() {
        true => "time_s",
        false => "angular_frequency_rad_per_s",
    };
    let columns = [
        place,
        "column",
        "measured",
        "error",
        "computed",
        "computed_low",
        "computed_high",
    ];
    csv(&columns, rows)
}

/// A frequency, the moduli there, and the ends of their 95 % bands.
pub(in crate::report) const MODULI: [&str; 7] = [
    "angular_frequency_rad_per_s",
    "storage_modulus_pa",
    "storage_modulus_low_pa",
    "storage_modulus_high_pa",
    "loss_modulus_pa",
    "loss_modulus_low_pa",
    "loss_modulus_high_pa",
];

/// The values of [`MODULI`] at an angular frequency (rad/s).
pub(super) fn moduli_at(report: &IdentifyReport<'_>, omega: f64) -> [f64; 7] {
    with_ends(omega, &report.found.band(omega))
}

/// The values of [`MODULI`] of a band.
pub(in crate::report) fn with_ends(omega: f64, band: &ModulusBand) -> [f64; 7] {
    let of = |value: f64, factor: f64| [value, value / factor, value * factor];
    let [storage, storage_low, storage_high] = of(band.storage_pa, band.storage_factor);
    let [loss, loss_low, loss_high] = of(band.loss_pa, band.loss_factor);
    [
        omega,
        storage,
        storage_low,
        storage_high,
        loss,
        loss_low,
        loss_high,
    ]
}

/// `moduli.csv`: E' and E'' with their 95 % bands, over the data and a little beyond.
pub fn moduli(report: &IdentifyReport<'_>) -> Vec<u8> {
    let rows = frequencies(report).into_iter();
    csv(
        &MODULI,
        rows.map(|omega| moduli_at(report, omega).map(Cell::from)),
    )
}

/// Angular frequencies (rad/s) for smooth curves of the moduli.
pub fn frequencies(report: &IdentifyReport<'_>) -> Vec<f64> {
    over(report.found.window_rad_per_s)
}

/// The same over a window and a little beyond.
pub(in crate::report) fn over((lowest, highest): (f64, f64)) -> Vec<f64> {
    let (low, high) = (lowest / BEYOND, highest * BEYOND);
    let count = (PER_DECADE * (high / low).log10()).ceil().max(1.0);
    (0..=count as usize)
        .map(|k| low * (high / low).powf(k as f64 / count))
        .collect()
}
