//! The checkpoint of a single history, from which an interrupted simulation goes on and ends with the very same bits.
//!
//! One file, `checkpoints/history`: the rows and surfaces so far at each resolution, and where the march stands within the step
//! that comes next, before its instant is solved. It says what it belongs to: build of the program and scenario. One that cannot be written
//! costs nothing but the time it would have saved.

use std::borrow::Cow;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::contact::half_space::grid::Grid;
use crate::contact::surface::{CellSurface, RadialSurface, Surface};
use crate::history::{StepState, Work};
use crate::sweep::history::follow::Course;
use crate::sweep::history::{HistoryRow, SurfaceRecord};
use crate::sweep::store::checkpoint_file::{
    self, FOLDER, Key, Rhythm, Unusable, from_numbers, numbers,
};
use crate::sweep::store::provenance::BUILD;
use crate::sweep::store::{Store, write_atomically};

/// Where the checkpoint of a history lies, and when it is written.
pub struct HistoryCheckpoint {
    /// `None`: nothing is kept.
    path: Option<PathBuf>,
    key: Key,
    rhythm: Rhythm,
}

/// What there is of an earlier run.
pub enum Found {
    Nothing,
    Stand(Box<Stand<'static>>),
    /// There is a checkpoint, but it cannot be used.
    Unusable {
        path: PathBuf,
        reason: Unusable,
    },
}

/// Where a history stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Stand<'a> {
    /// The history at the resolutions before, at their ends.
    pub(in crate::sweep) finished: Cow<'a, [Course]>,
    pub(in crate::sweep) course: Cow<'a, Course>,
    pub(in crate::sweep) step: StepState,
}

impl HistoryCheckpoint {
    /// Keeps nothing.
    pub fn none() -> Self {
        Self {
            path: None,
            key: checkpoint_file::key(""),
            rhythm: Rhythm::new(checkpoint_file::EVERY),
        }
    }

    /// That of the scenario of a folder, written every so often.
    pub fn of(store: &Store, every: Duration) -> Self {
        let owner = format!("{}\n{}\nhistory", BUILD, store.sweep_hash());
        Self {
            path: Some(store.folder().join(FOLDER).join("history")),
            key: checkpoint_file::key(&owner),
            rhythm: Rhythm::new(every),
        }
    }

    /// What an earlier run has left.
    pub fn find(&self) -> Found {
        let Some(path) = &self.path else {
            return Found::Nothing;
        };
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Found::Nothing,
            // What cannot be read is as good as torn.
            Err(_) => Vec::new(),
        };
        let unusable = |reason| Found::Unusable {
            path: path.clone(),
            reason,
        };
        match checkpoint_file::decode(&bytes, &self.key) {
            Ok((text, arrays)) => match Stand::from_parts(text, arrays) {
                Some(stand) => Found::Stand(Box::new(stand)),
                None => unusable(Unusable::Damaged),
            },
            Err(reason) => unusable(reason),
        }
    }

    /// Whether anything is kept at all.
    pub(in crate::sweep) fn keeps(&self) -> bool {
        self.path.is_some()
    }

    /// Whether it is time to write.
    pub(in crate::sweep) fn is_due(&self) -> bool {
        self.keeps() && self.rhythm.is_wanted() && self.rhythm.is_due()
    }

    /// Writes where the history stands, unless so little has been done that it is not worth it.
    pub(in crate::sweep) fn write(&self, stand: &Stand<'_>) {
        let Some(path) = self.path.as_ref().filter(|_| self.rhythm.is_wanted()) else {
            return;
        };
        self.rhythm.written(|| {
            let (text, arrays) = stand.parts();
            if let Ok(text) = serde_json::to_vec(&text) {
                let arrays: Vec<&[f64]> = arrays.iter().map(|array| array.as_ref()).collect();
                let bytes = checkpoint_file::encode(&self.key, &text, &arrays);
                // Without it, more is computed again.
                let _ = write_atomically(path, &bytes);
            }
        });
    }

    /// Removes it: the history is at its end, and its results are written.
    pub fn remove(&self) {
        if let Some(folder) = self.path.as_ref().and_then(|path| path.parent()) {
            // There is none, most often.
            let _ = fs::remove_dir_all(folder);
        }
    }
}

/// What is no array.
#[derive(Serialize, Deserialize)]
struct Text {
    stage: usize,
    finished: Vec<CourseText>,
    course: CourseText,
    work: Work,
    solved_iterations: Option<usize>,
    /// Numbers of arrays of the memory and of what the guesses look back on.
    memory: usize,
    looked_back_on: Option<usize>,
}

#[derive(Serialize, Deserialize)]
struct CourseText {
    growths: usize,
    iterations: u64,
    failed: Option<String>,
    surfaces: [Vec<Option<SurfaceText>>; 2],
}

#[derive(Serialize, Deserialize)]
struct SurfaceText {
    /// The grid of a surface over cells: cells and spacings (m) along x and y.
    grid: Option<(usize, usize, f64, f64)>,
    has_gap: bool,
}

/// Numbers of a row.
const ROW: usize = 5;

/// An undefined value is no number, as an array has it.
fn or_nan(value: Option<f64>) -> f64 {
    value.unwrap_or(f64::NAN)
}

fn not_nan(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

fn row_numbers(row: &HistoryRow) -> [f64; ROW] {
    [
        row.time_s,
        row.load_n,
        or_nan(row.approach_m),
        row.contact_radius_m,
        or_nan(row.peak_pressure_pa),
    ]
}

fn row_of(
    &[
        time_s,
        load_n,
        approach_m,
        contact_radius_m,
        peak_pressure_pa,
    ]: &[f64; ROW],
) -> HistoryRow {
    HistoryRow {
        time_s,
        load_n,
        approach_m: not_nan(approach_m),
        contact_radius_m,
        peak_pressure_pa: not_nan(peak_pressure_pa),
    }
}

type Array<'a> = Cow<'a, [f64]>;

impl<'a> Stand<'a> {
    /// How many moments have their rows, at all resolutions together.
    pub fn steps_done(&self) -> usize {
        let courses = self.finished.iter().chain([&*self.course]);
        courses.map(|course| course.rows.len()).sum()
    }

    /// Arrays: last instant, guess, hereditary part, memory, what guesses look back on; then of each course its rows, and of each
    /// of its surfaces row, radii, pressure, displacement and gap.
    fn parts(&'a self) -> (Text, Vec<Array<'a>>) {
        let step = &self.step;
        let mut arrays: Vec<Array<'a>> = vec![
            numbers(step.solution).into(),
            (&step.guess).into(),
            (&step.history).into(),
        ];
        let looked_back_on = step.course.iter().flatten();
        arrays.extend(step.memory.iter().chain(looked_back_on).map(Array::from));
        let finished = self.finished.iter();
        let text = Text {
            stage: step.stage,
            finished: finished.map(|c| course_parts(c, &mut arrays)).collect(),
            course: course_parts(&self.course, &mut arrays),
            work: step.work,
            solved_iterations: step.solution.map(|s| s.iterations),
            memory: step.memory.len(),
            looked_back_on: step.course.as_ref().map(Vec::len),
        };
        (text, arrays)
    }
}

fn course_parts<'a>(course: &'a Course, arrays: &mut Vec<Array<'a>>) -> CourseText {
    let rows: Vec<f64> = course.rows.iter().flat_map(row_numbers).collect();
    arrays.push(rows.into());
    let surfaces = [0, 1].map(|which| {
        let records = course.surfaces[which].iter();
        let text = records.map(|record| Some(surface_parts(record.as_ref()?, arrays)));
        text.collect()
    });
    CourseText {
        growths: course.growths,
        iterations: course.iterations,
        failed: course.failed.clone(),
        surfaces,
    }
}

fn surface_parts<'a>(record: &'a SurfaceRecord, arrays: &mut Vec<Array<'a>>) -> SurfaceText {
    arrays.push(row_numbers(&record.row).to_vec().into());
    let grid = match &record.surface {
        Surface::Radial(radial) => {
            let pressure: Vec<f64> = radial.pressure_pa.iter().map(|p| or_nan(*p)).collect();
            arrays.extend([(&radial.radius_m).into(), pressure.into()]);
            arrays.push((&radial.displacement_m).into());
            None
        }
        Surface::Cells(cells) => {
            arrays.extend([Vec::new().into(), (&cells.pressure_pa).into()]);
            arrays.push((&cells.displacement_m).into());
            let grid = &cells.grid;
            let spacings_m = (grid.spacing_x_m(), grid.spacing_y_m());
            Some((grid.cells_x(), grid.cells_y(), spacings_m.0, spacings_m.1))
        }
    };
    arrays.push(record.gap_m.as_deref().unwrap_or_default().into());
    SurfaceText {
        grid,
        has_gap: record.gap_m.is_some(),
    }
}

impl Stand<'static> {
    fn from_parts(text: &[u8], arrays: Vec<Vec<f64>>) -> Option<Self> {
        let text: Text = serde_json::from_slice(text).ok()?;
        let mut arrays = arrays.into_iter();
        let mut next = || arrays.next();
        let (solution, guess, history) = (next()?, next()?, next()?);
        let several = |count: usize, next: &mut dyn FnMut() -> Option<Vec<f64>>| {
            (0..count).map(|_| next()).collect::<Option<Vec<_>>>()
        };
        let memory = several(text.memory, &mut next)?;
        let looked_back_on = match text.looked_back_on {
            Some(count) => Some(several(count, &mut next)?),
            None => None,
        };
        let finished = text.finished.into_iter();
        let finished = finished.map(|text| course_of(text, &mut next));
        Some(Self {
            finished: Cow::Owned(finished.collect::<Option<_>>()?),
            course: Cow::Owned(course_of(text.course, &mut next)?),
            step: StepState {
                stage: text.stage,
                memory,
                guess,
                history,
                course: looked_back_on,
                solution: from_numbers(&solution, text.solved_iterations)?,
                work: text.work,
            },
        })
    }
}

fn course_of(text: CourseText, next: &mut dyn FnMut() -> Option<Vec<f64>>) -> Option<Course> {
    let rows = next()?;
    let (rows, rest) = rows.as_chunks();
    let mut surfaces = [Vec::new(), Vec::new()];
    for (texts, records) in text.surfaces.iter().zip(&mut surfaces) {
        for text in texts {
            records.push(match text {
                Some(text) => Some(surface_of(text, next)?),
                None => None,
            });
        }
    }
    rest.is_empty().then(|| Course {
        rows: rows.iter().map(row_of).collect(),
        surfaces,
        growths: text.growths,
        iterations: text.iterations,
        failed: text.failed,
    })
}

fn surface_of(
    text: &SurfaceText,
    next: &mut dyn FnMut() -> Option<Vec<f64>>,
) -> Option<SurfaceRecord> {
    let row = next()?;
    let (radius_m, pressure, displacement_m, gap_m) = (next()?, next()?, next()?, next()?);
    let points = displacement_m.len();
    let fits = pressure.len() == points && (!text.has_gap || gap_m.len() == points);
    let surface = match text.grid {
        _ if !fits => return None,
        None if radius_m.len() != points => return None,
        None => Surface::Radial(RadialSurface {
            radius_m,
            pressure_pa: pressure.into_iter().map(not_nan).collect(),
            displacement_m,
        }),
        Some((cells_x, cells_y, spacing_x_m, spacing_y_m)) => {
            let grid = Grid::new(cells_x, cells_y, spacing_x_m, spacing_y_m).ok()?;
            Surface::Cells(CellSurface {
                grid: (grid.cells() == points).then_some(grid)?,
                pressure_pa: pressure,
                displacement_m,
            })
        }
    };
    Some(SurfaceRecord {
        row: row_of(row.as_slice().try_into().ok()?),
        surface,
        gap_m: text.has_gap.then_some(gap_m),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Solution;

    fn row(time_s: f64) -> HistoryRow {
        HistoryRow {
            time_s,
            load_n: 1.0 / 3.0,
            approach_m: None,
            contact_radius_m: -0.0,
            peak_pressure_pa: Some(1e-300),
        }
    }

    fn stand() -> Stand<'static> {
        let radial = SurfaceRecord {
            row: row(2.0),
            surface: Surface::Radial(RadialSurface {
                radius_m: vec![0.0, 0.1],
                pressure_pa: vec![None, Some(3.0)],
                displacement_m: vec![1.0, 2.0],
            }),
            gap_m: None,
        };
        let cells = SurfaceRecord {
            row: row(1.0),
            surface: Surface::Cells(CellSurface {
                grid: Grid::new(2, 1, 0.1, 0.3).unwrap(),
                pressure_pa: vec![5.0, 6.0],
                displacement_m: vec![7.0, 8.0],
            }),
            gap_m: Some(vec![f64::INFINITY, 0.0]),
        };
        Stand {
            finished: Cow::Owned(vec![Course {
                rows: vec![row(0.1 + 0.2), row(1.0)],
                surfaces: [vec![Some(radial), None], vec![Some(cells)]],
                growths: 2,
                iterations: 7,
                failed: Some("too \"steep\"".to_owned()),
            }]),
            course: Cow::Owned(Course {
                rows: vec![row(5.0)],
                ..Course::default()
            }),
            step: StepState {
                stage: 1,
                memory: vec![vec![1.0, 2.0], Vec::new()],
                guess: vec![3.0],
                history: vec![4.0],
                course: Some(vec![vec![5.0]]),
                solution: Some(Solution {
                    load_n: 1.0,
                    approach_m: 2.0,
                    contact_radius_m: 3.0,
                    iterations: 4,
                    convolutions: 5,
                }),
                work: Work::default(),
            },
        }
    }

    #[test]
    fn a_history_comes_back_with_every_bit_and_only_where_it_belongs() {
        let folder = tempfile::TempDir::new().unwrap();
        let store = |text: &str| Store::open(folder.path(), text, true).unwrap();
        let one = store("title = \"a\"\n");
        let checkpoint = HistoryCheckpoint::of(&one, Duration::ZERO);
        assert!(matches!(checkpoint.find(), Found::Nothing));
        checkpoint.write(&stand());
        let Found::Stand(found) = checkpoint.find() else {
            panic!("nothing was found")
        };
        assert_eq!(*found, stand());
        let path = folder.path().join("checkpoints/history");
        let bytes = fs::read(&path).unwrap();
        drop(one);
        let other = HistoryCheckpoint::of(&store("title = \"b\"\n"), Duration::ZERO);
        // Another scenario has cleared the folder.
        assert!(matches!(other.find(), Found::Nothing));
        other.write(&stand());
        fs::write(&path, &bytes).unwrap();
        let reason = |checkpoint: &HistoryCheckpoint| match checkpoint.find() {
            Found::Unusable { reason, .. } => Some(reason),
            _ => None,
        };
        assert_eq!(reason(&other), Some(Unusable::Foreign));
        fs::write(&path, &bytes[..bytes.len() - 1]).unwrap();
        assert_eq!(reason(&checkpoint), Some(Unusable::Damaged));
        checkpoint.remove();
        assert!(!folder.path().join("checkpoints").exists());
    }

    #[test]
    fn what_has_hardly_begun_is_not_kept() {
        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), "", true).unwrap();
        let checkpoint = HistoryCheckpoint::of(&store, checkpoint_file::EVERY);
        checkpoint.write(&stand());
        assert!(matches!(checkpoint.find(), Found::Nothing) && !checkpoint.is_due());
    }
}
