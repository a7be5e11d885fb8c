//! `cycles.npz`: the cycles and profiles of all cases in one file, which `numpy.load` opens.
//!
//! Every array has one row a case, in the order of `sweep.csv`; NaN stands where a case has no result, a pressure is unbounded, or a row
//! is shorter than the longest.

use std::io::{self, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::npy;
use super::work_line::WorkLine;
use crate::indenter::Indenter;
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::{CaseRecord, PressureProfile, RecordedCycle};
use crate::sweep::search::run::Outcome;
use crate::sweep::store::{Store, StoreError};

/// The name of the file.
pub const NAME: &str = "cycles.npz";

/// What a row is made of: the numbers of one case, and of which shape.
struct Array {
    name: &'static str,
    row: fn(&Case<'_>) -> Vec<f64>,
    /// Rows of profiles: instants by places.
    instants: Option<usize>,
}

struct Case<'a> {
    record: &'a CaseRecord,
    cycle: &'a RecordedCycle,
    indenter: &'a dyn Indenter,
}

const fn of_case(name: &'static str, row: fn(&Case<'_>) -> Vec<f64>) -> Array {
    Array {
        name,
        row,
        instants: None,
    }
}

const fn of_instants(name: &'static str, row: fn(&Case<'_>) -> Vec<f64>) -> Array {
    Array {
        name,
        row,
        instants: Some(INSTANTS),
    }
}

/// Instants at which profiles are recorded.
const INSTANTS: usize = 4;

const ARRAYS: [Array; 15] = [
    of_case("angular_frequency_rad_per_s", |c| {
        vec![c.record.angular_frequency_rad_per_s]
    }),
    of_case("varied", |c| c.record.varied.all().to_vec()),
    of_case("drive_mean", |c| vec![c.record.drive_mean]),
    of_case("drive_amplitude", |c| vec![c.record.drive_amplitude]),
    of_case("energy_loss_j", |c| {
        c.record.energy_loss_j().into_iter().collect()
    }),
    of_case("time_s", |c| c.cycle.samples.time_s.clone()),
    of_case("load_n", |c| c.cycle.samples.load_n.clone()),
    of_case("approach_m", |c| c.cycle.samples.approach_m.clone()),
    of_case("contact_radius_m", |c| {
        c.cycle.samples.contact_radius_m.clone()
    }),
    of_case("peak_pressure_pa", |c| {
        numbers(&c.cycle.samples.peak_pressure_pa)
    }),
    of_instants("profile_time_s", |c| {
        c.cycle.pressures.iter().map(|p| p.time_s).collect()
    }),
    of_instants("profile_position_m", |c| {
        profiles(c, |line| line.position_m.clone())
    }),
    of_instants("profile_pressure_pa", |c| {
        profiles(c, |line| numbers(&line.pressure_pa))
    }),
    of_case("work_position_m", |c| {
        let line = WorkLine::of(&c.cycle.surface_loss, c.indenter);
        line.points.iter().map(|(x_m, _)| *x_m).collect()
    }),
    of_case("work_j_per_m2", |c| {
        let line = WorkLine::of(&c.cycle.surface_loss, c.indenter);
        let densities = line.points.iter().map(|(_, density)| *density);
        numbers(&densities.collect::<Vec<_>>())
    }),
];

fn numbers(values: &[Option<f64>]) -> Vec<f64> {
    values.iter().map(|v| v.unwrap_or(f64::NAN)).collect()
}

/// The first line of every instant, each as long as the longest.
fn profiles(
    case: &Case<'_>,
    values: fn(&crate::contact::surface::PressureLine) -> Vec<f64>,
) -> Vec<f64> {
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
            zip.start_file(format!("{}.npy", array.name), options)
                .map_err(io::Error::other)?;
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
            for (width, array) in widths.iter_mut().zip(&ARRAYS) {
                *width = (*width).max((array.row)(case).len());
            }
        })?;
    }
    Ok(widths)
}

fn write_array(
    (store, plan, outcome): (&Store, &SweepPlan, &Outcome),
    array: &Array,
    width: usize,
    to: &mut impl Write,
) -> io::Result<()> {
    let cases = outcome.records.len();
    let shape = match (array.instants, width) {
        (None, 0 | 1) => vec![cases],
        (Some(instants), width) if width > instants => vec![cases, instants, width / instants],
        (_, width) => vec![cases, width],
    };
    to.write_all(&npy::header(&shape))?;
    let width: usize = shape.iter().skip(1).product();
    for record in &outcome.records {
        let mut row = Vec::new();
        with_cycle(store, plan, record, |case| row = (array.row)(case))
            .map_err(io::Error::other)?;
        row.resize(width, f64::NAN);
        let bytes: Vec<u8> = row.iter().flat_map(|value| value.to_le_bytes()).collect();
        to.write_all(&bytes)?;
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
    let read;
    let held = record.result.as_ref().is_none_or(|r| r.cycle.is_held());
    let record = match held {
        true => record,
        false => {
            let mut with = record.clone();
            store.load_cycle(&mut with)?;
            read = with;
            &read
        }
    };
    let nothing = RecordedCycle::default();
    take(&Case {
        record,
        cycle: record.result.as_ref().map_or(&nothing, |r| &r.cycle),
        indenter: plan.indenter_under(&record.varied),
    });
    Ok(())
}
