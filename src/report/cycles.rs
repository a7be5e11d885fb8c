//! `cycles.npz`: the cycles and profiles of all cases in one file, which `numpy.load` opens.
//!
//! Every array has one row a case, in the order of `sweep.csv`; NaN stands where a case has no result, a pressure is unbounded, or a row
//! is shorter than the longest.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::npy;
use super::work_line::WorkLine;
use crate::contact::surface::PressureLine;
use crate::indenter::Indenter;
use crate::sweep::plan::SweepPlan;
use crate::sweep::record::{CaseRecord, PressureProfile, RecordedCycle};
use crate::sweep::search::run::Outcome;
use crate::sweep::store::files::Place;
use crate::sweep::store::{Store, StoreError};

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
    (
        "varied",
        |c| {
            c.record
                .varied
                .all()
                .iter()
                .map(|value| value.as_number())
                .collect()
        },
        false,
    ),
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

/// Writes the file; cycles that the outcome does not hold are read from the folder of the records, one at a time: once for the lengths
/// of the rows and once for the rows.
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
    to.write_with(Place::Archive, |file| {
        let arrays = arrays((records, plan, outcome), &widths)?;
        let mut file = FirstError { file, error: None };
        {
            let mut zip = ZipWriter::new(&mut file);
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Stored)
                .large_file(true);
            for ((name, ..), mut array) in ARRAYS.iter().zip(arrays) {
                zip.start_file(format!("{name}.npy"), options)
                    .map_err(io::Error::other)?;
                array.rewind()?;
                io::copy(&mut array, &mut zip)?;
            }
            zip.finish().map_err(io::Error::other)?;
        }
        file.error.map_or(Ok(()), Err)
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

/// Every array as the bytes of its file, on the disk: all cases may be more than the memory holds.
fn arrays(
    (store, plan, outcome): (&Store, &SweepPlan, &Outcome),
    widths: &[usize],
) -> io::Result<Vec<File>> {
    let cases = outcome.records.len();
    // Each profile of a case is as long as the longest of all cases.
    let layouts = ARRAYS.iter().zip(widths).map(|((.., is_profile), width)| {
        let of_instant = width / INSTANTS;
        match (is_profile, width) {
            (true, _) => (vec![cases, INSTANTS, of_instant], INSTANTS, of_instant),
            (false, 0 | 1) => (vec![cases], 1, 1),
            (false, width) => (vec![cases, *width], 1, *width),
        }
    });
    let mut arrays = Vec::new();
    for (shape, instants, width) in layouts {
        let mut file = BufWriter::new(tempfile::tempfile_in(store.folder())?);
        file.write_all(&npy::header(&shape))?;
        arrays.push((file, instants, width));
    }
    for record in &outcome.records {
        let mut written = Ok(());
        with_cycle(store, plan, record, |case| {
            written = arrays.iter_mut().zip(&ARRAYS).try_for_each(
                |((file, instants, width), (_, row_of, _))| {
                    write_row(&row_of(case), (*instants, *width), file)
                },
            );
        })
        .map_err(io::Error::other)?;
        written?;
    }
    let files = arrays.into_iter().map(|(file, ..)| Ok(file.into_inner()?));
    files.collect()
}

/// The numbers of one case: of every instant as many as the array is wide.
fn write_row(
    row: &[f64],
    (instants, width): (usize, usize),
    to: &mut impl Write,
) -> io::Result<()> {
    let length = row.len() / instants;
    for instant in 0..instants {
        let values = row.iter().skip(instant * length).take(length).copied();
        for value in values.chain(std::iter::repeat(f64::NAN)).take(width) {
            to.write_all(&value.to_le_bytes())?;
        }
    }
    Ok(())
}

/// A file that takes everything after its first error, which is told in the end: an archive that is given up writes its directory
/// all the same, and prints what that comes to.
struct FirstError<'a> {
    file: &'a mut File,
    error: Option<io::Error>,
}

impl FirstError<'_> {
    fn kept<T>(&mut self, done: impl FnOnce(&mut File) -> io::Result<T>, otherwise: T) -> T {
        if self.error.is_some() {
            return otherwise;
        }
        done(self.file).unwrap_or_else(|error| {
            self.error = Some(error);
            otherwise
        })
    }
}

impl Write for FirstError<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Ok(self.kept(|file| file.write(bytes), bytes.len()))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.kept(|file| file.flush(), ());
        Ok(())
    }
}

impl Seek for FirstError<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        Ok(self.kept(|file| file.seek(to), 0))
    }
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
        store.records().load_cycle(record.to_mut())?;
    }
    let nothing = RecordedCycle::default();
    take(&Case {
        record: &record,
        cycle: record.result.as_ref().map_or(&nothing, |r| &r.cycle),
        indenter: plan.indenter_under(&record.varied),
    });
    Ok(())
}
