//! Tables as CSV: one header line, then rows; numbers as short as they can be without losing a bit, absent values empty.

use super::ReportError;
use crate::cycle::Loop;
use crate::sweep::record::CaseRecord;

/// A table being written.
pub struct Table {
    name: &'static str,
    writer: csv::Writer<Vec<u8>>,
}

/// A number as it stands in every table: `3.4737e-6`.
pub fn number(value: f64) -> String {
    format!("{value:e}")
}

/// A value that may be absent.
pub fn optional(value: Option<f64>) -> String {
    value.map(number).unwrap_or_default()
}

impl Table {
    /// A table with these columns. `name` is for error messages.
    pub fn new(name: &'static str, columns: &[&str]) -> Result<Self, ReportError> {
        let mut table = Self {
            name,
            writer: csv::Writer::from_writer(Vec::new()),
        };
        table.row(columns)?;
        Ok(table)
    }

    /// Adds a row.
    pub fn row<C: AsRef<[u8]>>(&mut self, cells: &[C]) -> Result<(), ReportError> {
        self.writer
            .write_record(cells)
            .map_err(|error| ReportError::Table {
                name: self.name,
                reason: error.to_string(),
            })
    }

    /// Adds a row of numbers.
    pub fn numbers(&mut self, values: &[f64]) -> Result<(), ReportError> {
        let cells: Vec<String> = values.iter().copied().map(number).collect();
        self.row(&cells)
    }

    /// The finished text.
    pub fn finish(self) -> Result<Vec<u8>, ReportError> {
        self.writer
            .into_inner()
            .map_err(|error| ReportError::Table {
                name: self.name,
                reason: error.to_string(),
            })
    }
}

/// `sweep.csv`: one row per case, ascending frequency.
pub fn sweep(records: &[CaseRecord]) -> Result<Vec<u8>, ReportError> {
    let columns: Vec<&str> = COLUMNS.iter().map(|(name, _)| *name).collect();
    let mut table = Table::new("sweep.csv", &columns)?;
    for record in records {
        let cells: Vec<String> = COLUMNS.iter().map(|(_, cell)| cell(record)).collect();
        table.row(&cells)?;
    }
    table.finish()
}

type Column = (&'static str, fn(&CaseRecord) -> String);

const COLUMNS: [Column; 23] = [
    ("angular_frequency_rad_per_s", |r| {
        number(r.angular_frequency_rad_per_s)
    }),
    ("frequency_hz", |r| number(r.frequency_hz())),
    ("energy_loss_j", |r| optional(r.energy_loss_j())),
    // Empty until the discretisation error is estimated.
    ("energy_loss_error_j", |_| String::new()),
    ("phase_lag_rad", |r| {
        optional(r.result.as_ref().map(|c| c.analysis.phase_lag_rad))
    }),
    ("storage_modulus_pa", |r| {
        optional(r.result.as_ref().and_then(|c| c.storage_modulus_pa))
    }),
    ("loss_modulus_pa", |r| {
        optional(r.result.as_ref().and_then(|c| c.loss_modulus_pa))
    }),
    ("approach_min_m", |r| {
        optional(r.result.as_ref().map(|c| c.approach_m.minimum))
    }),
    ("approach_max_m", |r| {
        optional(r.result.as_ref().map(|c| c.approach_m.maximum))
    }),
    ("contact_radius_min_m", |r| {
        optional(r.result.as_ref().map(|c| c.contact_radius_m.minimum))
    }),
    ("contact_radius_max_m", |r| {
        optional(r.result.as_ref().map(|c| c.contact_radius_m.maximum))
    }),
    ("peak_pressure_min_pa", |r| {
        let peaks = r.result.as_ref().and_then(|c| c.peak_pressure_pa);
        optional(peaks.map(|p| p.minimum))
    }),
    ("peak_pressure_max_pa", |r| {
        let peaks = r.result.as_ref().and_then(|c| c.peak_pressure_pa);
        optional(peaks.map(|p| p.maximum))
    }),
    ("harmonic_2", |r| optional(harmonic(r, 2))),
    ("harmonic_3", |r| optional(harmonic(r, 3))),
    ("harmonic_4", |r| optional(harmonic(r, 4))),
    ("harmonic_5", |r| optional(harmonic(r, 5))),
    ("polygon_loss_j", |r| {
        optional(r.result.as_ref().map(|c| c.analysis.polygon_loss_j))
    }),
    ("cycles", |r| r.cycles.to_string()),
    ("steady_distance", |r| optional(r.steady_distance)),
    ("domain_half_width_m", |r| number(r.domain_half_width_m)),
    ("status", |r| r.status.name().to_owned()),
    ("message", |r| r.message.clone().unwrap_or_default()),
];

/// Amplitude of a harmonic of the approach, relative to the first.
fn harmonic(record: &CaseRecord, n: usize) -> Option<f64> {
    record.result.as_ref()?.analysis.approach_harmonic(n)
}

/// `loops/<index>.csv`: the stabilised cycle of one case.
pub fn samples(samples: &Loop) -> Result<Vec<u8>, ReportError> {
    let mut table = Table::new(
        "loops",
        &[
            "time_s",
            "load_n",
            "approach_m",
            "contact_radius_m",
            "peak_pressure_pa",
        ],
    )?;
    let signals = samples.time_s.iter().zip(&samples.load_n);
    let contact = samples.approach_m.iter().zip(&samples.contact_radius_m);
    for (((time, load), (approach, radius)), peak) in
        signals.zip(contact).zip(&samples.peak_pressure_pa)
    {
        table.row(&[
            number(*time),
            number(*load),
            number(*approach),
            number(*radius),
            optional(*peak),
        ])?;
    }
    table.finish()
}
