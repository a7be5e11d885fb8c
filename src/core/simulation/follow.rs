//! Follows one drive history from moment to moment, on domains that grow with the contact: rows, surfaces at the times asked for,
//! checkpoints.

use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

use crate::contact::half_space::grid::Grid;
use crate::contact::surface::Surface;
use crate::contact::{ContactError, Prescribed, Solution};
use crate::drive::{Control, Moment, Schedule};
use crate::engine::growing::{self, Layout};
use crate::engine::{self, EngineBuilder, EngineError, MAX_GROWTHS};
use crate::history::{DirectMemory, Hereditary, March, Step, StepState};
use crate::simulation::body_material::Compliance;
use crate::simulation::checkpoint::{HistoryCheckpoint, HistoryState};
use crate::simulation::work::WorkDone;
use crate::simulation::{HistoryRow, Level, Progress, Simulation, SurfaceRecord};
use crate::sweep::record::attracted::Jump;

/// Why a march ended early.
#[derive(Debug, thiserror::Error)]
pub(super) enum MarchError {
    #[error(transparent)]
    Contact(#[from] ContactError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The contact reached the edge, and goes on from here on a wider domain.
    #[error("the contact has outgrown its domain")]
    Outgrown(Box<StepState<'static>>),
}

/// A history as far as it was followed at one resolution.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Trajectory {
    pub(super) rows: Vec<HistoryRow>,
    pub(super) work: WorkDone,
    /// Profiles, then fields, in the order in which they were asked for.
    pub(super) surfaces: [Vec<Option<SurfaceRecord>>; 2],
    /// How often the contact moved to a domain twice as wide.
    pub(super) growths: usize,
    /// Contact iterations over all moments.
    pub(super) iterations: u64,
    /// Jumps of a contact whose edge an attraction moves, of which no checkpoint is written.
    #[serde(skip)]
    pub(super) jumps: Vec<Jump>,
    /// Why it ended early, where it did.
    pub(super) failed: Option<String>,
}

/// What a run hands to every resolution.
pub(super) struct Run<'a> {
    /// What was followed before, at other resolutions.
    pub finished: &'a [Trajectory],
    pub checkpoint: Option<&'a HistoryCheckpoint>,
    pub interrupt: &'a AtomicBool,
    pub progress: &'a Progress<'a>,
}

/// One resolution of a history on one domain.
struct Following<'a> {
    simulation: &'a Simulation,
    schedule: &'a Schedule,
    run: &'a Run<'a>,
    field_grid: &'a Grid,
    /// Where the nodes are, and where those of a wider domain would be, if there can be one.
    layout: Layout,
    wider: Option<Layout>,
}

impl Simulation {
    /// Follows the history at one resolution, from where it was begun, on domains that grow with the contact.
    pub(super) fn follow(
        &self,
        level: &Level,
        begun: Option<(Trajectory, StepState<'_>)>,
        run: &Run<'_>,
    ) -> (Trajectory, Result<(), MarchError>) {
        if self.plan.contact.is_attracted() {
            return self.follow_attracted(level, run);
        }
        let (mut trajectory, mut step) = match begun {
            Some((trajectory, step)) => (trajectory, Some(step)),
            None => (Trajectory::default(), None),
        };
        loop {
            match self.follow_on_domain(level, step.take(), &mut trajectory, run) {
                Err(MarchError::Outgrown(state)) => {
                    step = Some(*state);
                    trajectory.growths += 1;
                }
                ended => return (trajectory, ended),
            }
        }
    }

    /// The same on the domain that the trajectory has come to.
    fn follow_on_domain(
        &self,
        level: &Level,
        step: Option<StepState<'_>>,
        trajectory: &mut Trajectory,
        run: &Run<'_>,
    ) -> Result<(), MarchError> {
        let engines = self.domain(level, trajectory.growths)?;
        let not_enlarged = engines.not_enlarged(0);
        let wider = match not_enlarged.is_none() && trajectory.growths < self.halvings + MAX_GROWTHS
        {
            true => Some(self.domain(level, trajectory.growths + 1)?.layout()),
            false => None,
        };
        let mut engine = engines.engine(0)?;
        if let Some(flag) = &self.interrupt {
            engine.interrupted_by(Arc::clone(flag));
        }
        let following = Following {
            simulation: self,
            schedule: &level.schedule,
            run,
            field_grid: &engines.field_grid(self.plan.output.field_cells, 0)?,
            layout: engines.layout(),
            wider,
        };
        let (rule, steps) = (self.plan.solver.time_rule, level.schedule.moments.len());
        let ended = match &self.compliance {
            Compliance::Series(creep) => {
                let march = March::new(engine.as_mut(), creep.clone(), rule);
                following.run(march, step, trajectory)
            }
            Compliance::Samples(curve) => {
                let memory = DirectMemory::with_room_for(curve.clone(), engine.nodes(), steps);
                let march = March::with_memory(engine.as_mut(), memory, rule);
                following.run(march, step, trajectory)
            }
        };
        match (ended, not_enlarged) {
            (Err(MarchError::Contact(ContactError::ReachedEdge { .. })), Some(why)) => {
                Err(why.into())
            }
            (ended, _) => ended,
        }
    }

    /// Engines on the domain that the contact needs after it has outgrown this many: each is twice as wide as the one before.
    pub(super) fn domain(
        &self,
        level: &Level,
        growths: usize,
    ) -> Result<EngineBuilder, EngineError> {
        let doublings = growths as i32 - self.halvings as i32;
        level.engines.scaled(2_f64.powi(doublings))
    }
}

impl Following<'_> {
    /// Marches to the end, from within a step where an earlier run was if that fits; what there is by then is in the trajectory
    /// either way.
    fn run<M: Hereditary>(
        &self,
        mut march: March<'_, M>,
        state: Option<StepState<'_>>,
        trajectory: &mut Trajectory,
    ) -> Result<(), MarchError> {
        let profiles = self.simulation.plan.output.profiles_at_s.len();
        // Surfaces are asked for at full resolution alone.
        let wanted = (self.schedule.requested.split_at_checked(profiles)).unwrap_or_default();
        let wanted = [wanted.0, wanted.1];
        let state = state.filter(|_| self.fits(trajectory, wanted));
        let stage = state
            .map(|step| (step.stage, step))
            .and_then(|(stage, step)| march.restore_step(step).then_some(stage));
        if stage.is_none() {
            *trajectory = Trajectory {
                surfaces: wanted.map(|moments| vec![None; moments.len()]),
                growths: trajectory.growths,
                ..Trajectory::default()
            };
        }
        let ended = self.go_on(&mut march, stage, trajectory, wanted);
        trajectory.iterations = march.work().iterations;
        ended
    }

    /// Whether the trajectory can be one of this history.
    fn fits(&self, trajectory: &Trajectory, wanted: [&[usize]; 2]) -> bool {
        let mut surfaces = trajectory.surfaces.iter().zip(wanted);
        trajectory.rows.len() < self.schedule.moments.len()
            && surfaces.all(|(stored, wanted)| stored.len() == wanted.len())
    }

    /// Marches from moment to moment, and keeps what is asked for. `stage`: the march is within this one of the first step.
    fn go_on<M: Hereditary>(
        &self,
        march: &mut March<'_, M>,
        mut stage: Option<usize>,
        trajectory: &mut Trajectory,
        wanted: [&[usize]; 2],
    ) -> Result<(), MarchError> {
        let moments = &self.schedule.moments;
        let drive = &self.simulation.plan.drive;
        let prescribed = |value| engine::prescribed(drive.control(), value);
        let mut guess = Vec::new();
        for (index, moment) in moments.iter().enumerate().skip(trajectory.rows.len()) {
            let stages = march.stages(moment.step_s);
            let first = stage.unwrap_or(0);
            for (at, stage_of_step) in stages.iter().enumerate().skip(first) {
                if stage.take().is_none() {
                    march.begin_step(&stage_of_step.weights);
                }
                guess.clear();
                guess.extend_from_slice(march.pressure());
                let value = |at| prescribed(drive.value_within(moment, at));
                let prescribed = stage_of_step.prescribed(value);
                let weights = &stage_of_step.weights;
                self.end_stage(march, weights, prescribed, (at, &guess), trajectory)?;
            }
            let Some(solution) = march.solution() else {
                continue;
            };
            let floating = is_floating(drive.control(), moments, index);
            let mut row = row(march, moment, prescribed(moment.value), solution, floating)?;
            if index == 0 && moment.value == 0.0 {
                // First touch of an undisturbed body: zero by definition, whatever node lies nearest to the axis.
                row.approach_m = Some(0.0);
            }
            let touch_m = row.approach_m.unwrap_or(solution.approach_m);
            let work_j = trajectory.work.add(
                march,
                (moment, moments.get(index + 1)),
                (row.load_n, touch_m),
                drive.pull_off_n(),
            )?;
            row.work_j = Some(work_j);
            for (kind, moments) in wanted.into_iter().enumerate() {
                if moments.contains(&index)
                    && let Some(surface) = match kind {
                        0 => march.surface()?,
                        _ => march.field(self.field_grid)?,
                    }
                {
                    let record = self.surface_record(row, surface);
                    let places = moments.iter().zip(&mut trajectory.surfaces[kind]);
                    let mut places = places.filter(|(moment, _)| **moment == index);
                    // Of the same moment asked for twice, a copy; else none is made of so much.
                    let first = places.next();
                    for (_, place) in places {
                        *place = Some(record.clone());
                    }
                    if let Some((_, place)) = first {
                        *place = Some(record);
                    }
                }
            }
            trajectory.rows.push(row);
            (self.run.progress)(index + 1, moments.len());
        }
        Ok(())
    }

    /// Solves the instant of a stage.
    fn end_stage<M: Hereditary>(
        &self,
        march: &mut March<'_, M>,
        weights: &Step<M::Weights>,
        prescribed: Prescribed,
        at: (usize, &[f64]),
        trajectory: &Trajectory,
    ) -> Result<(), MarchError> {
        let interrupted = self.run.interrupt.load(Ordering::Relaxed);
        if interrupted || (self.run.checkpoint).is_some_and(HistoryCheckpoint::is_due) {
            self.keep(march, at, trajectory);
        }
        if interrupted {
            return Err(ContactError::Interrupted.into());
        }
        match (march.end_step(weights, prescribed), &self.wider) {
            (Err(ContactError::ReachedEdge { .. }), Some(wider)) => {
                let state = march.step_state(at.0, at.1);
                let state = growing::moved(state, &self.layout, wider);
                return Err(MarchError::Outgrown(Box::new(state)));
            }
            (Err(ContactError::Interrupted), _) => {
                self.keep(march, at, trajectory);
                return Err(ContactError::Interrupted.into());
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
        trajectory: &Trajectory,
    ) {
        if let Some(checkpoint) = self.run.checkpoint {
            checkpoint.write(&HistoryState {
                finished: Cow::Borrowed(self.run.finished),
                trajectory: Cow::Borrowed(trajectory),
                step: march.step_state(stage, guess),
            });
        }
    }

    fn surface_record(&self, row: HistoryRow, surface: Surface) -> SurfaceRecord {
        let indenter = self.simulation.plan.contact.indenter.as_ref();
        let gap_m = row.approach_m.map(|approach_m| {
            let gap_m = |x_m, y_m, u: &f64| indenter.gap_m(x_m, y_m) + u - approach_m;
            match &surface {
                Surface::Radial(radial) => {
                    let points = radial.radius_m.iter().zip(&radial.displacement_m);
                    points.map(|(r, u)| gap_m(*r, 0.0, u)).collect()
                }
                Surface::Cells(cells) => {
                    let centers = (0..cells.displacement_m.len()).map(|c| cells.grid.center(c));
                    let points = centers.zip(&cells.displacement_m);
                    points.map(|((x_m, y_m), u)| gap_m(x_m, y_m, u)).collect()
                }
            }
        });
        SurfaceRecord {
            row,
            surface,
            gap_m,
        }
    }
}

/// The row of the instant just solved.
fn row<M: Hereditary>(
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
    Ok(HistoryRow {
        time_s: moment.time_s,
        // What was prescribed, without the rounding of the sum over the nodes.
        load_n: match prescribed {
            Prescribed::LoadN(load_n) => load_n,
            Prescribed::ApproachM(_) => solution.load_n,
        },
        approach_m: (!floating).then_some(solution.approach_m),
        contact_radius_m: solution.contact_radius_m,
        peak_pressure_pa,
        work_j: None,
    })
}

/// Whether the indenter is clear of the surface at a moment, at a place that the drive does not say.
pub(super) fn is_floating(control: Control, moments: &[Moment], index: usize) -> bool {
    let is_loaded = |moment: &Moment| moment.value > 0.0;
    let moment = &moments[index];
    if control == Control::Approach || is_loaded(moment) {
        return false;
    }
    let before = index.checked_sub(1).and_then(|i| moments.get(i));
    let after = moments.get(index + 1);
    let jumps = (index > 0 && moment.is_jump()) || after.is_some_and(Moment::is_jump);
    let is_touch = !jumps && [before, after].into_iter().flatten().all(is_loaded);
    !is_touch
}
