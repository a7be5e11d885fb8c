//! The tables of an identification: measured and computed numbers, and the moduli with their bands.

use serde_json::{Map, Value};

use super::IdentifyReport;
use crate::identify::ModulusBand;
use crate::identify::laws::Drawn;
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

/// The columns of `moduli.csv`: behind these whether the frequency lies outside what was measured.
pub(in crate::report) const COLUMNS: [&str; 8] = {
    let mut columns = [EXTRAPOLATED; 8];
    let mut k = 0;
    while k < MODULI.len() {
        columns[k] = MODULI[k];
        k += 1;
    }
    columns
};
const EXTRAPOLATED: &str = "extrapolated";

/// Whether a frequency lies outside a window, by more than rounding.
fn is_outside(omega: f64, (lowest, highest): (f64, f64)) -> bool {
    omega < lowest * (1.0 - 1e-9) || omega > highest * (1.0 + 1e-9)
}

/// A row of `moduli.csv`.
pub(in crate::report) fn cells_of(
    omega: f64,
    band: &ModulusBand,
    window_rad_per_s: (f64, f64),
) -> Vec<Cell> {
    let values = with_ends(omega, band).map(Cell::from);
    let outside = Cell::from(is_outside(omega, window_rad_per_s).to_string());
    values.into_iter().chain([outside]).collect()
}

/// The same for the summary.
pub(in crate::report) fn row(
    omega: f64,
    band: &ModulusBand,
    window_rad_per_s: (f64, f64),
) -> Map<String, Value> {
    let values = with_ends(omega, band).map(Value::from).into_iter();
    let values = values.chain([is_outside(omega, window_rad_per_s).into()]);
    let names = COLUMNS.map(str::to_owned).into_iter();
    names.zip(values).collect()
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
    let found = report.found;
    let rows = frequencies(report).into_iter();
    let rows = rows.map(|omega| cells_of(omega, &found.band(omega), found.window_rad_per_s));
    csv(&COLUMNS, rows)
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

/// `ensemble.csv`: the moduli of every sample, at both ends of the window and in the middle.
pub fn ensemble(report: &IdentifyReport<'_>) -> Vec<u8> {
    let window = report.found.window_rad_per_s;
    let samples = report.found.ensemble.iter().enumerate();
    let rows = samples.flat_map(|(number, drawn)| {
        let before = cells![number + 1, drawn.form.in_words()];
        sampled(&before, drawn, window)
    });
    csv(&[&["sample", "law"][..], &SAMPLED].concat(), rows)
}

/// A frequency, and the moduli of a sample there.
pub(in crate::report) const SAMPLED: [&str; 3] = [
    "angular_frequency_rad_per_s",
    "storage_modulus_pa",
    "loss_modulus_pa",
];

/// The rows of a sample behind some cells: [`SAMPLED`] at both ends of the window and in the middle.
pub(in crate::report) fn sampled(
    before: &[Cell],
    drawn: &Drawn,
    (low, high): (f64, f64),
) -> Vec<Vec<Cell>> {
    let row = |omega: f64| {
        let modulus = drawn.complex_modulus_pa(omega);
        let moduli = modulus.map(|modulus| [modulus.re, modulus.im]);
        let values = [Some(omega), moduli.map(|m| m[0]), moduli.map(|m| m[1])];
        [before, &values.map(Cell::from)].concat()
    };
    [low, (low * high).sqrt(), high].map(row).to_vec()
}
