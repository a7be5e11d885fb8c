//! `cycles.npz`: the cycles and profiles of all cases in one file, which `numpy.load` opens.
//!
//! Every array has one row a case, in the order of `sweep.csv`; NaN stands where a case has no result, a pressure is unbounded, or a row
//! is shorter than the longest.

use std::borrow::Cow;
use std::io::{self, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::npy;
use super::work_line::WorkLine;
use crate::contact::surface::PressureLine;
use crate::indenter::Indenter;
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::{CaseRecord, PressureProfile, RecordedCycle};
use crate::sweep::search::run::Outcome;
use crate::sweep::store::{Store, StoreError};

/// The name of the file.
pub const NAME: &str = "cycles.npz";

/// A name, the numbers of one case that a row is made of, and whether these are profiles: instants by places, as many of each.
type Array = (&'static str, fn(&Case<'_>) -> Vec<f64>, bool);

struct Case<'a> {
    record: &'a CaseRecord,
    cycle: &'a RecordedCycle,
    indenter: &'a dyn Indenter,
}

/// Instants at which profiles are recorded.
const INSTANTS: usize = 4;

const ARRAYS: [Array; 15] = [
    (
        "angular_frequency_rad_per_s",
        |c| vec![c.record.angular_frequency_rad_per_s],
        false,
    ),
    ("varied", |c| c.record.varied.all().to_vec(), false),
    ("drive_mean", |c| vec![c.record.drive_mean], false),
    ("drive_amplitude", |c| vec![c.record.drive_amplitude], false),
    (
        "energy_loss_j",
        |c| c.record.energy_loss_j().into_iter().collect(),
        false,
    ),
    ("time_s", |c| c.cycle.samples.time_s.clone(), false),
    ("load_n", |c| c.cycle.samples.load_n.clone(), false),
    ("approach_m", |c| c.cycle.samples.approach_m.clone(), false),
    (
        "contact_radius_m",
        |c| c.cycle.samples.contact_radius_m.clone(),
        false,
    ),
    (
        "peak_pressure_pa",
        |c| numbers(&c.cycle.samples.peak_pressure_pa),
        false,
    ),
    (
        "profile_time_s",
        |c| c.cycle.pressures.iter().map(|p| p.time_s).collect(),
        false,
    ),
    (
        "profile_position_m",
        |c| profiles(c, |line| line.position_m.clone()),
        true,
    ),
    (
        "profile_pressure_pa",
        |c| profiles(c, |line| numbers(&line.pressure_pa)),
        true,
    ),
    (
        "work_position_m",
        |c| c.work().map(|(x_m, _)| x_m).collect(),
        false,
    ),
    (
        "work_j_per_m2",
        |c| {
            c.work()
                .map(|(_, density)| density.unwrap_or(f64::NAN))
                .collect()
        },
        false,
    ),
];

impl Case<'_> {
    fn work(&self) -> impl Iterator<Item = (f64, Option<f64>)> {
        let line = WorkLine::of(&self.cycle.surface_loss, self.indenter);
        line.points.into_iter()
    }
}

fn numbers(values: &[Option<f64>]) -> Vec<f64> {
    values.iter().map(|v| v.unwrap_or(f64::NAN)).collect()
}

/// The first line of every instant, each as long as the longest.
fn profiles(case: &Case<'_>, values: fn(&PressureLine) -> Vec<f64>) -> Vec<f64> {
    let of = |profile: &PressureProfile| profile.lines.first().map(values).unwrap_or_default();
    let rows: Vec<Vec<f64>> = case.cycle.pressures.iter().map(of).collect();
    let longest = rows.iter().map(Vec::len).max().unwrap_or(0);
    let padded = rows.into_iter().map(|mut row| {
        row.resize(longest, f64::NAN);
        row
    });
    padded.flatten().collect()
}

/// Writes the file; cycles that the outcome does not hold are read from the folder of the records, one at a time.
///
/// # Errors
/// [`StoreError`] with the path.
pub fn write(
    to: &Store,
    records: &Store,
    plan: &SweepPlan,
    outcome: &Outcome,
) -> Result<(), StoreError> {
    let widths = widths(records, plan, outcome)?;
    to.write_with(NAME, |file| {
        let mut zip = ZipWriter::new(file);
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(true);
        for (array, width) in ARRAYS.iter().zip(&widths) {
            let name = format!("{}.npy", array.0);
            zip.start_file(name, options).map_err(io::Error::other)?;
            write_array((records, plan, outcome), array, *width, &mut zip)?;
        }
        zip.finish().map_err(io::Error::other)?;
        Ok(())
    })
}

/// The longest row of every array.
fn widths(store: &Store, plan: &SweepPlan, outcome: &Outcome) -> Result<Vec<usize>, StoreError> {
    let mut widths = vec![0; ARRAYS.len()];
    for record in &outcome.records {
        with_cycle(store, plan, record, |case| {
            for (width, (_, row, _)) in widths.iter_mut().zip(&ARRAYS) {
                *width = (*width).max(row(case).len());
            }
        })?;
    }
    Ok(widths)
}

fn write_array(
    (store, plan, outcome): (&Store, &SweepPlan, &Outcome),
    (_, row_of, is_profile): &Array,
    width: usize,
    to: &mut impl Write,
) -> io::Result<()> {
    let cases = outcome.records.len();
    // Each profile of a case is as long as the longest of all cases.
    let (shape, instants, width) = match (is_profile, width) {
        (true, width) => (
            vec![cases, INSTANTS, width / INSTANTS],
            INSTANTS,
            width / INSTANTS,
        ),
        (false, 0 | 1) => (vec![cases], 1, 1),
        (false, width) => (vec![cases, width], 1, width),
    };
    to.write_all(&npy::header(&shape))?;
    for record in &outcome.records {
        let mut row = Vec::new();
        with_cycle(store, plan, record, |case| row = row_of(case)).map_err(io::Error::other)?;
        let length = row.len() / instants;
        for instant in 0..instants {
            let values = row.iter().skip(instant * length).take(length).copied();
            let padded = values.chain(std::iter::repeat(f64::NAN)).take(width);
            let bytes: Vec<u8> = padded.flat_map(f64::to_le_bytes).collect();
            to.write_all(&bytes)?;
        }
    }
    Ok(())
}

/// A case with its cycle, from the outcome or the folder; without one where it has no result.
fn with_cycle(
    store: &Store,
    plan: &SweepPlan,
    record: &CaseRecord,
    mut take: impl FnMut(&Case<'_>),
) -> Result<(), StoreError> {
    let mut record = Cow::Borrowed(record);
    if record.result.as_ref().is_some_and(|r| !r.cycle.is_held()) {
        store.load_cycle(record.to_mut())?;
    }
    let nothing = RecordedCycle::default();
    take(&Case {
        record: &record,
        cycle: record.result.as_ref().map_or(&nothing, |r| &r.cycle),
        indenter: plan.indenter_under(&record.varied),
    });
    Ok(())
}
