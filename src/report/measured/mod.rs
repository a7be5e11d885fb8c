//! Measured loops as tables, text and summary: the columns and files of a sweep, one row a record.

pub mod columns;
pub mod summary;
pub mod text;

use serde::{Deserialize, Serialize};

use crate::cycle::Loop;
use crate::measured::bias::Unbiased;
use crate::measured::{self, Estimate, Finding, MeasuredLoop, Options, Quantity, Signal};
use crate::report::table::{self, Cell, csv};
use crate::sweep::record::Status;
use crate::sweep::store::files::{OfCase, Place};

/// What an analysis came to: all that tables, figures and the page are made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Analysis {
    pub title: String,
    /// The setup file, where there was one.
    pub setup: Option<String>,
    pub rows: Vec<MeasuredRow>,
    /// What is drawn beside the measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub computed: Vec<Computed>,
}

/// A computed case beside which measured ones are drawn.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Computed {
    pub angular_rad_per_s: f64,
    pub energy_loss_j: Option<f64>,
    pub storage_modulus_pa: Option<f64>,
    pub loss_modulus_pa: Option<f64>,
    /// Loads (N) and approaches (m) of its cycle.
    pub cycle: Vec<(f64, f64)>,
}

/// What one file came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredRow {
    /// Place among all by ascending frequency, in the names of its files.
    pub index: usize,
    /// The file as it was named.
    pub file: String,
    pub measured: Option<MeasuredLoop>,
    /// Why there is nothing of it.
    pub reason: Option<String>,
}

/// Samples of a loop as it is written.
const SAMPLES: usize = 200;

impl MeasuredRow {
    /// What the record of this file comes to, still without its place.
    pub fn of(file: String, signal: &Signal, options: &Options) -> Self {
        let (measured, reason) = match measured::analyse(signal, options) {
            Ok(measured) => (Some(measured), None),
            Err(error) => (None, Some(error.to_string())),
        };
        Self {
            index: 0,
            file,
            measured,
            reason,
        }
    }

    /// The moduli without the bias of the formula.
    pub fn unbiased(&self) -> Option<Unbiased> {
        self.measured.as_ref()?.unbiased
    }

    /// What is to be known of the record.
    pub fn findings(&self) -> impl Iterator<Item = &Finding> {
        self.measured.iter().flat_map(|measured| &measured.findings)
    }

    /// How it ended, in the words of a sweep.
    pub fn status(&self) -> Status {
        match &self.measured {
            Some(measured) if measured.energy_loss_j().is_some() => Status::Converged,
            Some(_) => Status::NotConverged,
            None => Status::Failed,
        }
    }

    /// The mean of a quantity.
    pub fn mean(&self, quantity: Quantity) -> Option<Estimate> {
        self.measured.as_ref()?.mean(quantity)
    }

    /// Angular frequency (rad/s).
    pub fn angular_rad_per_s(&self) -> Option<f64> {
        Some(self.measured.as_ref()?.frequency.angular_rad_per_s())
    }

    /// The mean cycle as a loop of uniform samples, from the first sample of the record on.
    pub fn samples(&self) -> Option<Loop> {
        let measured = self.measured.as_ref()?;
        if measured.mean_cycle.load_n.is_empty() {
            return None;
        }
        let (load_n, approach_m) = measured.mean_cycle.sampled(SAMPLES);
        let step_s = 1.0 / (measured.frequency.hz * SAMPLES as f64);
        Some(Loop {
            time_s: (0..=SAMPLES).map(|k| step_s * k as f64).collect(),
            load_n,
            approach_m,
            contact_radius_m: Vec::new(),
            peak_pressure_pa: Vec::new(),
        })
    }
}

/// Rows of all files, in the order of their frequencies and numbered by it; those without a frequency last, in the order of the
/// files.
pub fn ordered(mut rows: Vec<MeasuredRow>) -> Vec<MeasuredRow> {
    let key = |row: &MeasuredRow| row.angular_rad_per_s().unwrap_or(f64::INFINITY);
    rows.sort_by(|a, b| key(a).total_cmp(&key(b)));
    for (index, row) in rows.iter_mut().enumerate() {
        row.index = index;
    }
    rows
}

/// The file that holds everything, of which tables and figures can be made again.
pub const ANALYSIS: Place<'_> = Place::Record("analysis.json");

/// Every file of the folder but figures and page: name and bytes.
///
/// # Errors
/// Where the analysis is no JSON.
pub fn files(analysis: &Analysis) -> serde_json::Result<Vec<(String, Vec<u8>)>> {
    let mut files = Vec::new();
    let mut add = |place: Place<'_>, bytes| files.push((place.to_string(), bytes));
    add(Place::Top("sweep.csv"), columns::sweep(&analysis.rows));
    for row in &analysis.rows {
        let name = format!("{}.csv", row.index);
        if let Some(samples) = row.samples() {
            add(Place::Case(OfCase::Loops, &name), table::samples(&samples));
        }
        if let Some(measured) = &row.measured {
            add(Place::Case(OfCase::Cycles, &name), cycles(measured));
        }
    }
    let summary = format!("{:#}\n", summary::summary(analysis));
    add(Place::Top("summary.json"), summary.into_bytes());
    add(ANALYSIS, serde_json::to_vec(analysis)?);
    Ok(files)
}

/// `cases/cycles/<index>.csv`: every cycle by itself.
fn cycles(measured: &MeasuredLoop) -> Vec<u8> {
    let mut columns = vec!["cycle", "start_s", "samples", "is_used"];
    columns.extend(Quantity::ALL.iter().map(|(_, column, _)| *column));
    columns.extend(["load_drift_n", "approach_drift_m"]);
    let rows = measured.cycles.iter().zip(&measured.values);
    let rows = rows.map(|(cycle, values)| {
        let is_used = measured.used.binary_search(&cycle.number).is_ok();
        let mut row: Vec<Cell> = vec![
            cycle.number.into(),
            cycle.start_s.into(),
            cycle.samples.into(),
            usize::from(is_used).into(),
        ];
        row.extend(values.iter().map(|value| Cell::from(*value)));
        row.extend([cycle.load_drift_n.into(), cycle.approach_drift_m.into()]);
        row
    });
    csv(&columns, rows)
}
