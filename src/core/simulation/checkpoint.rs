//! The checkpoint of a single history, from which an interrupted simulation goes on and ends with the very same bits.
//!
//! One file, `records/checkpoints/history`: the rows and surfaces so far at each resolution, and where the march stands within the step
//! that comes next, before its instant is solved. One that cannot be written costs nothing but the time it would have saved.

use std::borrow::Cow;
use std::path::PathBuf;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::contact::surface::Surface;
use crate::history::StepState;
use crate::simulation::SurfaceRecord;
use crate::simulation::follow::Trajectory;
use crate::sweep::store::Store;
use crate::sweep::store::checkpoint_file::{CheckpointFile, Rhythm, Unusable};

/// Where the checkpoint of a history lies, and when it is written.
pub struct HistoryCheckpoint {
    file: CheckpointFile,
    rhythm: Rhythm,
}

/// There is a checkpoint, but it cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct UnusableCheckpoint {
    pub path: PathBuf,
    pub reason: Unusable,
}

/// The state of a history under way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HistoryState<'a> {
    /// The history at the resolutions before, at their ends.
    pub(super) finished: Cow<'a, [Trajectory]>,
    pub(super) trajectory: Cow<'a, Trajectory>,
    pub(super) step: StepState<'a>,
}

impl HistoryState<'_> {
    /// How many moments have their rows, at all resolutions together.
    pub fn steps_done(&self) -> usize {
        self.trajectories()
            .map(|trajectory| trajectory.rows.len())
            .sum()
    }

    fn trajectories(&self) -> impl Iterator<Item = &Trajectory> {
        self.finished.iter().chain([&*self.trajectory])
    }

    /// Whether every surface has one value of each kind at each of its points.
    fn is_whole(&self) -> bool {
        let surfaces = self
            .trajectories()
            .flat_map(|trajectory| &trajectory.surfaces);
        surfaces.flatten().flatten().all(is_whole)
    }
}

fn is_whole(record: &SurfaceRecord) -> bool {
    let (points, others) = match &record.surface {
        Surface::Radial(radial) => {
            let others = [radial.radius_m.len(), radial.pressure_pa.len()];
            (radial.displacement_m.len(), others)
        }
        Surface::Cells(cells) => {
            let others = [cells.grid.cells(), cells.pressure_pa.len()];
            (cells.displacement_m.len(), others)
        }
    };
    let gap_fits = |gap_m: &Vec<f64>| gap_m.len() == points;
    others == [points; 2] && record.gap_m.as_ref().is_none_or(gap_fits)
}

impl HistoryCheckpoint {
    /// That of the scenario of a folder, written every so often.
    pub fn of(store: &Store, every: Duration) -> Self {
        Self {
            file: CheckpointFile::new(store, "history", "history"),
            rhythm: Rhythm::new(every),
        }
    }

    /// What an earlier run has left, if anything.
    ///
    /// # Errors
    /// [`UnusableCheckpoint`] where that is of no use.
    pub fn find(&self) -> Result<Option<HistoryState<'static>>, UnusableCheckpoint> {
        let found = match self.file.read::<HistoryState<'static>>() {
            Ok(Some(state)) if !state.is_whole() => Err(Unusable::Damaged),
            found => found,
        };
        found.map_err(|reason| UnusableCheckpoint {
            path: self.file.path(),
            reason,
        })
    }

    /// Whether it is time to write.
    pub(super) fn is_due(&self) -> bool {
        self.rhythm.is_wanted() && self.rhythm.is_due()
    }

    /// Writes the state, unless so little has been done that it is not worth it.
    pub(super) fn write(&self, state: &HistoryState<'_>) {
        if self.rhythm.is_wanted() {
            self.rhythm.written(|| self.file.write(state));
        }
    }

    /// Removes it: the history is at its end, and its results are written.
    pub fn remove(&self) {
        self.file.remove_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Solution;
    use crate::contact::half_space::grid::Grid;
    use crate::contact::surface::{CellSurface, RadialSurface};
    use crate::history::{Extrapolation, PastState, Work};
    use crate::simulation::HistoryRow;
    use crate::simulation::work::WorkDone;
    use crate::sweep::store::checkpoint_file;
    use std::fs;

    fn row(time_s: f64) -> HistoryRow {
        HistoryRow {
            time_s,
            load_n: 1.0 / 3.0,
            approach_m: None,
            contact_radius_m: -0.0,
            peak_pressure_pa: Some(1e-300),
            work_j: Some(2e-300),
        }
    }

    fn state() -> HistoryState<'static> {
        let mut looking_back = Extrapolation::default();
        looking_back.guess(0.5, &mut [5.0]);
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
        HistoryState {
            finished: Cow::Owned(vec![Trajectory {
                rows: vec![row(0.1 + 0.2), row(1.0)],
                work: WorkDone::default(),
                surfaces: [vec![Some(radial), None], vec![Some(cells)]],
                growths: 2,
                iterations: 7,
                failed: Some("too \"steep\"".to_owned()),
                jumps: Vec::new(),
            }]),
            trajectory: Cow::Owned(Trajectory {
                rows: vec![row(5.0)],
                ..Trajectory::default()
            }),
            step: StepState {
                stage: 1,
                memory: PastState {
                    nodal: vec![vec![1.0, 2.0].into(), Cow::default()],
                    steps: Cow::default(),
                },
                guess: vec![3.0].into(),
                history: vec![4.0].into(),
                course: Some(Cow::Owned(looking_back)),
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
        let one = store("steps = 8\n");
        let checkpoint = HistoryCheckpoint::of(&one, Duration::ZERO);
        assert_eq!(checkpoint.find().unwrap(), None);
        checkpoint.write(&state());
        assert_eq!(checkpoint.find().unwrap(), Some(state()));
        let path = folder.path().join("records/checkpoints/history");
        let bytes = fs::read(&path).unwrap();
        // Both work in the folder, and so hold it.
        drop((one, checkpoint));
        let other = HistoryCheckpoint::of(&store("steps = 16\n"), Duration::ZERO);
        // Another scenario has cleared the folder.
        assert_eq!(other.find().unwrap(), None);
        other.write(&state());
        fs::write(&path, &bytes).unwrap();
        let reason = |checkpoint: &HistoryCheckpoint| checkpoint.find().err().map(|e| e.reason);
        assert_eq!(reason(&other), Some(Unusable::Foreign));
        fs::write(&path, &bytes[..bytes.len() - 1]).unwrap();
        assert_eq!(reason(&other), Some(Unusable::Damaged));
        other.remove();
        assert!(!folder.path().join("checkpoints").exists());
    }

    #[test]
    fn what_has_hardly_begun_is_not_kept() {
        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), "", true).unwrap();
        let checkpoint = HistoryCheckpoint::of(&store, checkpoint_file::EVERY);
        checkpoint.write(&state());
        assert!(checkpoint.find().unwrap().is_none() && !checkpoint.is_due());
    }
}
