//! Tables as CSV: one header line, then rows; numbers as short as they can be without losing a bit, absent values empty.

use super::ReportError;
use super::work_line::WorkLine;
use crate::cycle::Loop;
use crate::drive::Control;
use crate::sweep::record::error_bars::Quantity;
use crate::sweep::record::{CaseRecord, CaseResult, PressureProfile};

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

/// `sweep.csv`: one row per case, in the order given. `branches` is how many the material's creep compliance has.
pub fn sweep(records: &[CaseRecord], branches: usize) -> Result<Vec<u8>, ReportError> {
    let mut columns: Vec<String> = FIRST.iter().map(|(name, _)| (*name).to_owned()).collect();
    for (value, error) in Quantity::ALL.map(Quantity::columns) {
        columns.extend([value.to_owned(), error.to_owned()]);
    }
    columns.extend((1..=branches).map(|k| format!("branch_{k}_loss_j")));
    columns.extend(LAST.iter().map(|(name, _)| (*name).to_owned()));
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let mut table = Table::new("sweep.csv", &columns)?;
    for record in records {
        let mut cells: Vec<String> = FIRST.iter().map(|(_, cell)| cell(record)).collect();
        let result = record.result.as_ref();
        let errors = result.and_then(|r| r.errors.as_ref());
        for quantity in Quantity::ALL {
            cells.push(optional(result.and_then(|r| quantity.of(r))));
            cells.push(optional(errors.and_then(|e| e.of(quantity))));
        }
        let branch = |k: usize| Some(result?.branches.get(k)?.energy_loss_j);
        cells.extend((0..branches).map(|k| optional(branch(k))));
        cells.extend(LAST.iter().map(|(_, cell)| cell(record)));
        table.row(&cells)?;
    }
    table.finish()
}

type Column = (&'static str, fn(&CaseRecord) -> String);

/// Which case it is.
const FIRST: [Column; 4] = [
    ("angular_frequency_rad_per_s", |r| {
        number(r.angular_frequency_rad_per_s)
    }),
    ("frequency_hz", |r| number(r.frequency_hz())),
    ("drive_mean", |r| number(r.drive_mean)),
    ("drive_amplitude", |r| number(r.drive_amplitude)),
];

/// What has no error bar, and how the numbers came about.
const LAST: [Column; 18] = [
    ("dissipated_j", |r| {
        optional(r.result.as_ref().map(CaseResult::dissipated_j))
    }),
    ("energy_imbalance", |r| {
        optional(r.result.as_ref().and_then(CaseResult::energy_imbalance))
    }),
    ("polygon_loss_j", |r| {
        optional(r.result.as_ref().map(|c| c.analysis.polygon_loss_j))
    }),
    ("harmonic_4", |r| optional(harmonic(r, 4))),
    ("harmonic_5", |r| optional(harmonic(r, 5))),
    // The number in the names of its loop and its record.
    ("index", |r| r.index.to_string()),
    ("method", |r| r.method.name().to_owned()),
    ("steps", |r| r.steps.to_string()),
    ("nodes", |r| r.nodes.to_string()),
    ("cycles", |r| r.cycles.to_string()),
    ("steady_distance", |r| optional(r.steady_distance)),
    ("domain_half_width_m", |r| number(r.domain_half_width_m)),
    ("instants", |r| r.work.instants.to_string()),
    ("iterations", |r| r.work.iterations.to_string()),
    ("convolutions", |r| r.work.convolutions.to_string()),
    ("warnings", |r| {
        let codes: Vec<&str> = r.warnings.iter().map(|warning| warning.code()).collect();
        codes.join(" ")
    }),
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

/// `pressures/<index>.csv`: the pressure over the contact at the instants recorded of the stabilised cycle, one row per place.
pub fn pressures(profiles: &[PressureProfile], control: Control) -> Result<Vec<u8>, ReportError> {
    let columns = [
        "instant",
        "time_s",
        "load_n",
        "approach_m",
        "contact_radius_m",
        "line",
        "position_m",
        "pressure_pa",
    ];
    let mut table = Table::new("pressures", &columns)?;
    for profile in profiles {
        let instant = [
            profile.quarter.name(control),
            number(profile.time_s),
            number(profile.load_n),
            number(profile.approach_m),
            number(profile.contact_radius_m),
        ];
        for line in &profile.lines {
            for (position_m, pressure_pa) in line.position_m.iter().zip(&line.pressure_pa) {
                let place = [
                    line.along.symbol().to_owned(),
                    number(*position_m),
                    optional(*pressure_pa),
                ];
                table.row(&instant.iter().cloned().chain(place).collect::<Vec<_>>())?;
            }
        }
    }
    table.finish()
}

/// `work/<index>.csv`: the density of the work per cycle along one line.
pub fn work(line: &WorkLine) -> Result<Vec<u8>, ReportError> {
    let mut table = Table::new("work", &[line.along.column(), "work_j_per_m2"])?;
    for (position_m, density) in &line.points {
        table.row(&[number(*position_m), optional(*density)])?;
    }
    table.finish()
}
