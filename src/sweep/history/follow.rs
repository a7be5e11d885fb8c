//! Follows one drive history on one engine, from moment to moment: rows, surfaces at the times asked for, checkpoints.

use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

use crate::contact::half_space::grid::Grid;
use crate::contact::surface::Surface;
use crate::contact::{ContactError, Prescribed, Solution};
use crate::drive::{Moment, Schedule};
use crate::history::{Hereditary, March, StepState};
use crate::sweep::engine::growing::{self, Layout};
use crate::sweep::engine::{self, EngineError};
use crate::sweep::history::checkpoint::{HistoryCheckpoint, HistoryState};
use crate::sweep::history::{HistoryRow, Progress, SurfaceRecord};
use crate::sweep::plan::scenario::ScenarioPlan;

/// Why a march ended early.
#[derive(Debug, thiserror::Error)]
pub(in crate::sweep) enum MarchError {
    #[error(transparent)]
    Contact(ContactError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error("interrupted")]
    Interrupted,
    /// The contact reached the edge, and goes on from here on a wider domain.
    #[error("the contact has outgrown its domain")]
    Outgrown(Box<StepState>),
}

impl From<ContactError> for MarchError {
    fn from(error: ContactError) -> Self {
        match error {
            ContactError::Interrupted => Self::Interrupted,
            other => Self::Contact(other),
        }
    }
}

/// A history as far as it was followed at one resolution.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(in crate::sweep) struct Course {
    pub(in crate::sweep) rows: Vec<HistoryRow>,
    /// Profiles, then fields, in the order in which they were asked for.
    pub(in crate::sweep) surfaces: [Vec<Option<SurfaceRecord>>; 2],
    /// How often the contact moved to a domain twice as wide.
    pub(in crate::sweep) growths: usize,
    /// Contact iterations over all moments.
    pub(in crate::sweep) iterations: u64,
    /// Why it ended early, where it did.
    pub(in crate::sweep) failed: Option<String>,
}

/// A history to follow, and how.
pub(in crate::sweep) struct Following<'a> {
    pub(in crate::sweep) plan: &'a ScenarioPlan,
    pub(in crate::sweep) schedule: &'a Schedule,
    /// Per moment, whether the approach is undefined.
    pub(in crate::sweep) floating: &'a [bool],
    pub(in crate::sweep) field_grid: &'a Grid,
    /// Where the nodes are, and where those of a wider domain would be, if there can be one.
    pub(in crate::sweep) layout: Layout,
    pub(in crate::sweep) wider: Option<Layout>,
    /// What was followed before, at other resolutions.
    pub(in crate::sweep) finished: &'a [Course],
    pub(in crate::sweep) checkpoint: &'a HistoryCheckpoint,
    pub(in crate::sweep) interrupt: &'a AtomicBool,
    pub(in crate::sweep) progress: &'a Progress<'a>,
}

impl Following<'_> {
    /// Marches to the end, from within a step where an earlier run was if that fits; what there is by then is in the course
    /// either way.
    pub(in crate::sweep) fn run<M: Hereditary>(
        &self,
        mut march: March<'_, M>,
        state: Option<&StepState>,
        course: &mut Course,
    ) -> Result<(), MarchError> {
        let profiles = self.plan.output.profiles_at_s.len();
        // Surfaces are asked for at full resolution alone.
        let wanted = (self.schedule.requested.split_at_checked(profiles)).unwrap_or_default();
        let wanted = [wanted.0, wanted.1];
        let state = state.filter(|_| self.fits(course, wanted));
        let stage = state
            .filter(|step| march.restore_step(step))
            .map(|step| step.stage);
        if stage.is_none() {
            *course = Course {
                surfaces: wanted.map(|moments| vec![None; moments.len()]),
                growths: course.growths,
                ..Course::default()
            };
        }
        let ended = self.go_on(&mut march, stage, course, wanted);
        course.iterations = march.work().iterations;
        ended
    }

    /// Whether the course can be one of this history.
    fn fits(&self, course: &Course, wanted: [&[usize]; 2]) -> bool {
        let mut surfaces = course.surfaces.iter().zip(wanted);
        course.rows.len() < self.schedule.moments.len()
            && surfaces.all(|(stored, wanted)| stored.len() == wanted.len())
    }

    /// Marches from moment to moment, and keeps what is asked for. `stage`: the march is within this one of the first step.
    fn go_on<M: Hereditary>(
        &self,
        march: &mut March<'_, M>,
        mut stage: Option<usize>,
        course: &mut Course,
        wanted: [&[usize]; 2],
    ) -> Result<(), MarchError> {
        let moments = &self.schedule.moments;
        let wanted = wanted.map(Wanted::new);
        let mut guess = Vec::new();
        for (index, moment) in moments.iter().enumerate().skip(course.rows.len()) {
            let stages = march.stages(moment.step_s);
            let first = stage.unwrap_or(0);
            for (at, stage_of_step) in stages.iter().enumerate().skip(first) {
                if stage.take().is_none() {
                    march.begin_step(&stage_of_step.weights);
                }
                guess.clear();
                guess.extend_from_slice(march.pressure());
                let drive = |at| {
                    let value = self.plan.drive.value_within(moment, at);
                    engine::prescribed(self.plan.drive.control(), value)
                };
                let prescribed = stage_of_step.prescribed(drive);
                let weights = &stage_of_step.weights;
                self.end_stage(march, weights, prescribed, (at, &guess), course)?;
            }
            let Some(solution) = march.solution() else {
                continue;
            };
            let prescribed = engine::prescribed(self.plan.drive.control(), moment.value);
            let mut row = self.row(march, moment, prescribed, solution, self.floating[index])?;
            if index == 0 && moment.value == 0.0 {
                // First touch of an undisturbed body: zero by definition, whatever node lies nearest to the axis.
                row.approach_m = Some(0.0);
            }
            let [profiles, fields] = &mut course.surfaces;
            if wanted[0].has(index)
                && let Some(surface) = march.surface()?
            {
                wanted[0].keep(index, &self.surface_record(row, surface), profiles);
            }
            if wanted[1].has(index)
                && let Some(surface) = march.field(self.field_grid)?
            {
                wanted[1].keep(index, &self.surface_record(row, surface), fields);
            }
            course.rows.push(row);
            (self.progress)(index + 1, moments.len());
        }
        Ok(())
    }

    /// Solves the instant of a stage.
    fn end_stage<M: Hereditary>(
        &self,
        march: &mut March<'_, M>,
        weights: &M::Step,
        prescribed: Prescribed,
        at: (usize, &[f64]),
        course: &Course,
    ) -> Result<(), MarchError> {
        let interrupted = self.interrupt.load(Ordering::Relaxed);
        if interrupted || self.checkpoint.is_due() {
            self.keep(march, at, course);
        }
        if interrupted {
            return Err(MarchError::Interrupted);
        }
        match (march.end_step(weights, prescribed), &self.wider) {
            (Err(ContactError::ReachedEdge { .. }), Some(wider)) => {
                let state = march.step_state(at.0, at.1);
                let state = growing::moved::<M>(state, &self.layout, wider);
                return Err(MarchError::Outgrown(Box::new(state)));
            }
            (Err(ContactError::Interrupted), _) => {
                self.keep(march, at, course);
                return Err(MarchError::Interrupted);
            }
            (solved, _) => solved?,
        };
        Ok(())
    }

    /// Writes the state of the history: in the stage of a step whose guess this is.
    fn keep<M: Hereditary>(
        &self,
        march: &March<'_, M>,
        (stage, guess): (usize, &[f64]),
        course: &Course,
    ) {
        if self.checkpoint.keeps() {
            self.checkpoint.write(&HistoryState {
                finished: Cow::Borrowed(self.finished),
                course: Cow::Borrowed(course),
                step: march.step_state(stage, guess),
            });
        }
    }

    /// The row of the instant just solved.
    fn row<M: Hereditary>(
        &self,
        march: &mut March<'_, M>,
        moment: &Moment,
        prescribed: Prescribed,
        solution: Solution,
        floating: bool,
    ) -> Result<HistoryRow, ContactError> {
        let mut peak_pressure_pa = None;
        march.observe(&mut |engine, pressure, solution| {
            peak_pressure_pa = engine.peak_pressure_pa(pressure, solution)?;
            Ok(())
        })?;
        if solution.load_n == 0.0 {
            peak_pressure_pa = Some(0.0);
        }
        let Solution {
            load_n,
            approach_m,
            contact_radius_m,
            ..
        } = solution;
        Ok(HistoryRow {
            time_s: moment.time_s,
            // What was prescribed, without the rounding of the sum over the nodes.
            load_n: match prescribed {
                Prescribed::LoadN(load_n) => load_n,
                Prescribed::ApproachM(_) => load_n,
            },
            approach_m: (!floating).then_some(approach_m),
            contact_radius_m,
            peak_pressure_pa,
        })
    }

    fn surface_record(&self, row: HistoryRow, surface: Surface) -> SurfaceRecord {
        let indenter = self.plan.contact.indenter.as_ref();
        let gap_m = row.approach_m.map(|approach_m| match &surface {
            Surface::Radial(radial) => {
                let points = radial.radius_m.iter().zip(&radial.displacement_m);
                points
                    .map(|(r, u)| indenter.gap_m(*r, 0.0) + u - approach_m)
                    .collect()
            }
            Surface::Cells(cells) => {
                let points = cells.displacement_m.iter().enumerate();
                points
                    .map(|(cell, u)| {
                        let (x_m, y_m) = cells.grid.center(cell);
                        indenter.gap_m(x_m, y_m) + u - approach_m
                    })
                    .collect()
            }
        });
        SurfaceRecord {
            row,
            surface,
            gap_m,
        }
    }
}

/// Surfaces wanted at some moments, in the order of the wishes.
struct Wanted<'a> {
    moments: &'a [usize],
    all: HashSet<usize>,
}

impl<'a> Wanted<'a> {
    fn new(moments: &'a [usize]) -> Self {
        Self {
            moments,
            all: moments.iter().copied().collect(),
        }
    }

    fn has(&self, moment: usize) -> bool {
        self.all.contains(&moment)
    }

    /// Puts the record of a moment into every place where it is wanted.
    fn keep(&self, moment: usize, record: &SurfaceRecord, records: &mut [Option<SurfaceRecord>]) {
        for (wanted, slot) in self.moments.iter().zip(records) {
            if *wanted == moment {
                *slot = Some(record.clone());
            }
        }
    }
}
