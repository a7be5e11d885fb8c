//! One drive history from its beginning to its end: the march, and what is kept of it.
//!
//! # Out of contact
//!
//! Under a load of zero, or with the indenter retracted beyond the surface, there is no contact: no pressure, contact radius
//! 0, and the surface recovers freely until it is met again, where it may still be deformed. Under load control the indenter
//! may then be anywhere clear of the surface, and its approach is undefined (`None`). One case is different: where a drive
//! that does not jump touches zero load at a single instant, the approach has a limit there, that at which the indenter just
//! touches the surface. Both engines return it, and it is reported for exactly these instants; those at which the history
//! begins or ends count, provided that the load is above zero on the other side.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::contact::Engine;
use crate::contact::surface::Surface;
use crate::drive::{Control, Moment, Schedule, ScheduleError, Steps};
use crate::history::{DirectMemory, March};
use crate::material::MaterialError;
use crate::quantity::{Dimension, format_human};
use crate::sweep::body_material::Compliance;
use crate::sweep::engines::{EngineBuilder, EngineError, LargestContact, missed_contact};
use crate::sweep::follow::{Following, MarchError};
use crate::sweep::history_checkpoint::{HistoryCheckpoint, Stand};
use crate::sweep::scenario::ScenarioPlan;

/// Why a simulation cannot be set up.
#[derive(Debug, Clone, thiserror::Error)]
pub enum SimulationError {
    #[error(transparent)]
    Material(#[from] MaterialError),
    #[error(transparent)]
    Schedule(#[from] ScheduleError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(
        "{steps} time steps on {nodes} nodes are too many for the direct sum, which keeps the pressure of every step (at most \
         {MAX_DIRECT_STEPS} steps and {} GB) and whose cost grows with their square: set a longer [time] step, fewer cells, \
         or material.table.evaluation = \"fit\"",
        MAX_DIRECT_BYTES / 1_000_000_000
    )]
    DirectSum { steps: usize, nodes: usize },
}

/// Steps of a direct sum: half of their square are evaluations of the compliance, a minute for as many as this.
const MAX_DIRECT_STEPS: usize = 20_000;
/// Memory of a direct sum, bytes.
const MAX_DIRECT_BYTES: usize = 2_000_000_000;

/// A scenario, ready to run.
pub struct Simulation {
    plan: ScenarioPlan,
    compliance: Compliance,
    schedule: Schedule,
    /// Per moment, whether the approach is undefined.
    floating: Vec<bool>,
    engines: EngineBuilder,
    /// Ends an instant under way, where the engine's instants are long.
    interrupt: Option<Arc<AtomicBool>>,
}

/// One row of the history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryRow {
    pub time_s: f64,
    pub load_n: f64,
    /// `None` where the indenter is clear of the surface under load control.
    pub approach_m: Option<f64>,
    pub contact_radius_m: f64,
    /// `None` where the indenter's shape makes the pressure unbounded.
    pub peak_pressure_pa: Option<f64>,
}

/// The surface at a requested time.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceRecord {
    pub row: HistoryRow,
    pub surface: Surface,
    /// Gap between indenter and surface per point, infinite where there is no indenter; `None` where the approach is
    /// undefined.
    pub gap_m: Option<Vec<f64>>,
}

/// What a simulation came to.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationOutcome {
    /// One row per moment; two with the same time at a jump.
    pub rows: Vec<HistoryRow>,
    /// At the requested times, in the order in which they were requested, as far as the march came.
    pub profiles: Vec<SurfaceRecord>,
    pub fields: Vec<SurfaceRecord>,
    /// Half width of the computational domain (m) and how often it had to be enlarged.
    pub domain_half_width_m: f64,
    pub domain_enlarged: usize,
    /// Contact iterations over all moments.
    pub iterations: u64,
    /// Whether every time step was damped, not just those after a joint; see [`Simulation::run`].
    pub damped_throughout: bool,
    pub ended: SimulationEnd,
}

/// How a simulation ended.
#[derive(Debug, Clone, PartialEq)]
pub enum SimulationEnd {
    Done,
    /// It was stopped from outside.
    Interrupted,
    /// The next moment could not be solved.
    Failed(String),
}

/// Hears of progress: moments done, moments in all.
pub type Progress<'p> = dyn Fn(usize, usize) + 'p;

impl Simulation {
    /// Checks the plan against the physics, lays out the time steps and sizes the domain.
    ///
    /// # Errors
    /// [`SimulationError`] where the material cannot make a contact, a requested time lies outside the history, or the engine
    /// cannot treat the indenter or give what is asked for.
    pub fn new(plan: ScenarioPlan) -> Result<Self, SimulationError> {
        let compliance = plan.material.compliance()?;
        let steps = match plan.step_s {
            Some(step_s) => Steps::Given { step_s },
            None => Steps::Chosen {
                shortest_time_s: plan.material.shortest_time_s(),
            },
        };
        let output = &plan.output;
        let requested_s = [&output.profiles_at_s[..], &output.fields_at_s[..]].concat();
        let schedule = Schedule::new(&plan.drive, steps, &requested_s)?;
        // A solid or fluid meets no more than its compliance at the end, and no more than the largest load.
        let largest = LargestContact {
            control: plan.drive.control(),
            maximum: plan.drive.maximum(),
            compliance_per_pa: compliance.largest_per_pa(plan.drive.duration_s()),
        };
        let engines = EngineBuilder::new(plan.indenter.clone(), plan.solver, largest)?;
        let (steps, nodes) = (schedule.moments.len(), engines.nodes());
        let bytes = steps.saturating_mul(nodes).saturating_mul(size_of::<f64>());
        if matches!(compliance, Compliance::Samples(_))
            && (steps > MAX_DIRECT_STEPS || bytes > MAX_DIRECT_BYTES)
        {
            return Err(SimulationError::DirectSum { steps, nodes });
        }
        Ok(Self {
            floating: floating(plan.drive.control(), &schedule.moments),
            engines,
            compliance,
            schedule,
            plan,
            interrupt: None,
        })
    }

    /// The same, with the flag handed to [`Simulation::run`] known to the engine too, so that it is heard within an instant.
    #[must_use]
    pub fn interrupted_by(mut self, flag: Arc<AtomicBool>) -> Self {
        self.interrupt = Some(flag);
        self
    }

    /// The plan.
    pub fn plan(&self) -> &ScenarioPlan {
        &self.plan
    }

    /// Memory (bytes) that the history takes while it runs, a checkpoint included, which one that ends within seconds does not
    /// write. Within 20 % of what was measured on 1024 x 1024 and 2048 x 2048 cells, for a contact that stays inside its domain.
    pub fn predicted_memory_bytes(&self) -> u64 {
        /// What the program takes whatever it computes.
        const PROGRAM_BYTES: u64 = 15_000_000;
        /// Fields of a checkpoint besides the memory variables; and what a number of it takes, as it is and in the file being
        /// written, as measured.
        const KEPT_FIELDS: usize = 3;
        const KEPT_BYTES: usize = 19;
        let variables = match &self.compliance {
            Compliance::Series(creep) => {
                creep.branches().len() + usize::from(creep.viscosity_pa_s().is_some())
            }
            // The sum over the past needs every pressure of it.
            Compliance::Samples(_) => self.schedule.moments.len(),
        };
        let kept = self.engines.nodes() * (variables + KEPT_FIELDS);
        PROGRAM_BYTES + self.engines.predicted_memory_bytes(variables) + (kept * KEPT_BYTES) as u64
    }

    /// The time steps.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// Runs the history, on larger domains where the contact reaches the edge. An instant that cannot be solved ends it, as
    /// does `interrupt`; what came before is in the outcome either way.
    ///
    /// Where the pressure comes out negative, either the contact is no disc or time steps far longer than the body's shortest
    /// relaxation time have made newly met springs ring ([`crate::history::StepWeights::settling`]). To tell the two apart,
    /// the history is run once more with damped steps throughout, which do not ring but are less exact.
    pub fn run(&self, interrupt: &AtomicBool, progress: &Progress<'_>) -> SimulationOutcome {
        self.run_from(None, &HistoryCheckpoint::none(), interrupt, progress)
    }

    /// As [`Simulation::run`], from where an earlier run of the same scenario stood; the outcome is the same, bit for bit. An
    /// interruption leaves a new checkpoint.
    pub fn run_from(
        &self,
        stand: Option<Stand<'_>>,
        checkpoint: &HistoryCheckpoint,
        interrupt: &AtomicBool,
        progress: &Progress<'_>,
    ) -> SimulationOutcome {
        let mut outcome = SimulationOutcome {
            rows: Vec::new(),
            profiles: Vec::new(),
            fields: Vec::new(),
            domain_half_width_m: self.engines.half_width_m(),
            domain_enlarged: 0,
            iterations: 0,
            damped_throughout: stand.as_ref().is_some_and(|stand| stand.damped_throughout),
            ended: SimulationEnd::Done,
        };
        let mut first_growths = stand.as_ref().map_or(0, |stand| stand.growths);
        let stand = Cell::new(stand);
        let domain = Cell::new((outcome.domain_half_width_m, first_growths));
        let mut marched = |outcome: &mut SimulationOutcome| {
            self.engines.on_a_large_enough_domain(
                std::mem::take(&mut first_growths),
                |half_width_m, growths| domain.set((half_width_m, growths)),
                |engine| {
                    let growths = domain.get().1;
                    if let Some(flag) = &self.interrupt {
                        engine.interrupted_by(Arc::clone(flag));
                    }
                    let following = Following {
                        plan: &self.plan,
                        schedule: &self.schedule,
                        floating: &self.floating,
                        field_grid: &self
                            .engines
                            .field_grid(self.plan.output.field_cells, growths)?,
                        growths,
                        checkpoint,
                        interrupt,
                        progress,
                    };
                    self.march(engine, &following, stand.take(), outcome)
                },
            )
        };
        let mut ended = marched(&mut outcome);
        if !outcome.damped_throughout && ended.as_ref().is_err_and(MarchError::is_of_a_disc) {
            outcome.damped_throughout = true;
            ended = marched(&mut outcome);
        }
        (outcome.domain_half_width_m, outcome.domain_enlarged) = domain.get();
        match ended {
            Ok(()) => {
                let approach_m = self.plan.drive.maximum();
                if self.plan.drive.control() == Control::Approach
                    && approach_m > 0.0
                    && outcome.rows.iter().all(|row| row.load_n == 0.0)
                {
                    outcome.ended = SimulationEnd::Failed(missed_contact(approach_m));
                }
            }
            Err(MarchError::Interrupted) => outcome.ended = SimulationEnd::Interrupted,
            Err(error) => outcome.ended = SimulationEnd::Failed(self.place(&outcome, &error)),
        }
        outcome
    }

    /// An error with the time and segment at which it arose: those of the first moment without a row.
    fn place(&self, outcome: &SimulationOutcome, error: &MarchError) -> String {
        match self.schedule.moments.get(outcome.rows.len()) {
            Some(moment) => format!(
                "at {}, in segment {} of the drive: {error}",
                format_human(moment.time_s, Dimension::Time, 6),
                moment.segment + 1
            ),
            None => error.to_string(),
        }
    }

    fn march(
        &self,
        engine: &mut dyn Engine,
        following: &Following<'_>,
        stand: Option<Stand<'_>>,
        outcome: &mut SimulationOutcome,
    ) -> Result<(), MarchError> {
        let rule = self.plan.solver.time_rule;
        match &self.compliance {
            Compliance::Series(creep) => {
                let march = March::new(engine, creep.clone(), rule);
                following.run(march, stand, outcome)
            }
            Compliance::Samples(curve) => {
                let steps = self.schedule.moments.len();
                let memory = DirectMemory::with_room_for(curve.clone(), engine.nodes(), steps);
                let march = March::with_memory(engine, memory, rule);
                following.run(march, stand, outcome)
            }
        }
    }
}

impl HistoryRow {
    /// Contact area (m^2).
    pub fn contact_area_m2(&self) -> f64 {
        std::f64::consts::PI * self.contact_radius_m * self.contact_radius_m
    }
}

/// Per moment, whether the indenter is clear of the surface at a place that the drive does not say.
fn floating(control: Control, moments: &[Moment]) -> Vec<bool> {
    if control == Control::Approach {
        return vec![false; moments.len()];
    }
    let is_loaded = |moment: &Moment| moment.value > 0.0;
    let is_touch = |index: usize| {
        let before = index.checked_sub(1).and_then(|i| moments.get(i));
        let after = moments.get(index + 1);
        let jumps = (index > 0 && moments[index].is_jump()) || after.is_some_and(Moment::is_jump);
        let neighbours = [before, after];
        !jumps && neighbours.into_iter().flatten().all(is_loaded)
    };
    moments
        .iter()
        .enumerate()
        .map(|(index, moment)| !is_loaded(moment) && !is_touch(index))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;
    use std::time::Duration;

    use super::*;
    use crate::drive::{Segment, SegmentedDrive};
    use crate::indenter::{Axisymmetric, Indenter, Parameter, Sphere};
    use crate::material::library;
    use crate::sweep::figure_plan::FigurePlan;
    use crate::sweep::history_checkpoint::Found;
    use crate::sweep::plan::SolverPlan;
    use crate::sweep::resolved;
    use crate::sweep::scenario::OutputPlan;
    use crate::sweep::store::Store;

    /// (time, whether the approach is undefined) at every unloaded moment.
    fn unloaded(segments: Vec<Segment>) -> Vec<(f64, bool)> {
        let drive = SegmentedDrive::new(Control::Load, segments).unwrap();
        let schedule = Schedule::new(&drive, Steps::Given { step_s: 1.0 }, &[]).unwrap();
        let floating = floating(Control::Load, &schedule.moments);
        let moments = schedule.moments.iter().zip(floating);
        moments
            .filter(|(m, _)| m.value == 0.0)
            .map(|(m, floating)| (m.time_s, floating))
            .collect()
    }

    fn ramp(to: f64, duration_s: f64) -> Segment {
        Segment::Ramp { to, duration_s }
    }

    #[test]
    fn a_single_touch_of_a_continuous_drive_has_an_approach_and_a_rest_out_of_contact_has_none() {
        let up_and_down = [ramp(1.0, 2.0), ramp(0.0, 2.0)];
        let twice = [up_and_down.to_vec(), up_and_down.to_vec()].concat();
        assert_eq!(unloaded(twice), [(0.0, false), (4.0, false), (8.0, false)]);
        let rest = [up_and_down.to_vec(), vec![ramp(0.0, 2.0), ramp(1.0, 1.0)]].concat();
        assert_eq!(
            unloaded(rest),
            [(0.0, false), (4.0, true), (5.0, true), (6.0, true)]
        );
    }

    #[test]
    fn a_load_that_jumps_to_or_from_zero_leaves_the_indenter_anywhere() {
        let step = |to| Segment::Step {
            to,
            duration_s: 1.0,
        };
        assert_eq!(
            unloaded(vec![step(1.0), ramp(0.0, 1.0), step(1.0)]),
            [(2.0, true)]
        );
        assert_eq!(
            unloaded(vec![step(1.0), step(0.0), ramp(1.0, 1.0)]),
            [(1.0, true), (2.0, true)]
        );
        let table = Segment::Table {
            times_s: vec![0.0, 1.0, 1.0, 2.0],
            values: vec![1.0, 1.0, 0.0, 1.0],
        };
        assert_eq!(unloaded(vec![table]), [(1.0, true)]);
    }

    /// Hollow at its axis: springs some way out are met first, which is no disc.
    #[derive(Debug)]
    struct Bowl;

    impl Indenter for Bowl {
        fn shape(&self) -> &'static str {
            "bowl"
        }
        fn parameters(&self) -> Vec<Parameter> {
            Vec::new()
        }
        fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
            50.0 * (x_m.hypot(y_m) - 5e-4).powi(2)
        }
        fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
            Some(self)
        }
        fn elastic_half_width_m(&self, _: f64, _: f64) -> f64 {
            1e-3
        }
    }

    impl Axisymmetric for Bowl {
        fn transformed_gap_m(&self, x_m: f64) -> f64 {
            50.0 * (x_m - 5e-4).powi(2)
        }
        fn contact_limit_m(&self) -> Option<f64> {
            None
        }
        fn has_bounded_pressure(&self) -> bool {
            false
        }
    }

    /// A sphere of 10 mm whose contact is foretold far too small.
    #[derive(Debug)]
    struct Underrated(Sphere);

    impl Indenter for Underrated {
        fn shape(&self) -> &'static str {
            self.0.shape()
        }
        fn parameters(&self) -> Vec<Parameter> {
            self.0.parameters()
        }
        fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
            self.0.gap_m(x_m, y_m)
        }
        fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
            self.0.axisymmetric()
        }
        fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
            0.2 * self.0.elastic_half_width_m(load_n, compliance_per_pa)
        }
    }

    #[test]
    fn a_history_interrupted_every_third_step_ends_as_if_undisturbed_on_domains_that_grow_too() {
        let segments = vec![ramp(10.0, 6.0), ramp(2.0, 6.0)];
        let plan = ScenarioPlan {
            title: "underrated".to_owned(),
            material: library::find("pmma").unwrap().material().unwrap().into(),
            indenter: Arc::new(Underrated(Sphere::new(0.01).unwrap())),
            drive: SegmentedDrive::new(Control::Load, segments).unwrap(),
            step_s: Some(0.5),
            output: OutputPlan {
                profiles_at_s: vec![9.0, 1.0],
                fields_at_s: vec![2.0],
                field_cells: 8,
            },
            solver: SolverPlan::default(),
            figures: FigurePlan::default(),
        };
        let simulation = Simulation::new(plan).unwrap();
        let whole = simulation.run(&AtomicBool::new(false), &|_, _| {});
        assert_eq!(whole.ended, SimulationEnd::Done);
        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), "", &resolved::hash(""), false).unwrap();
        let (mut runs, mut grown) = (0, 0);
        let outcome = loop {
            let checkpoint = HistoryCheckpoint::of(&store, Duration::ZERO);
            let stand = match checkpoint.find() {
                Found::Stand(stand) => Some(*stand),
                Found::Nothing => None,
                Found::Unusable { path, reason } => panic!("{}: {reason}", path.display()),
            };
            grown = stand.as_ref().map_or(0, |stand| stand.growths).max(grown);
            let (interrupt, steps) = (AtomicBool::new(false), Cell::new(0));
            let outcome = simulation.run_from(stand, &checkpoint, &interrupt, &|_, _| {
                steps.set(steps.get() + 1);
                interrupt.store(steps.get() == 3, Ordering::Relaxed);
            });
            runs += 1;
            if outcome.ended != SimulationEnd::Interrupted {
                break outcome;
            }
        };
        assert_eq!(outcome, whole);
        assert_eq!(grown, whole.domain_enlarged);
        assert!(runs > 8 && grown > 0, "{runs} runs, {grown} times enlarged");
    }

    #[test]
    fn a_history_that_cannot_go_on_keeps_what_came_before_and_says_where_it_stopped() {
        let segments = vec![
            Segment::Step {
                to: 0.0,
                duration_s: 3.0,
            },
            ramp(1e-3, 2.0),
        ];
        let plan = ScenarioPlan {
            title: "bowl".to_owned(),
            material: library::find("pmma").unwrap().material().unwrap().into(),
            indenter: Arc::new(Bowl),
            drive: SegmentedDrive::new(Control::Load, segments).unwrap(),
            step_s: Some(1.0),
            output: OutputPlan::default(),
            solver: SolverPlan::default(),
            figures: FigurePlan::default(),
        };
        let simulation = Simulation::new(plan).unwrap();
        let outcome = simulation.run(&AtomicBool::new(false), &|_, _| {});
        let SimulationEnd::Failed(message) = &outcome.ended else {
            panic!("{outcome:?}")
        };
        for part in ["at 4.00000 s", "segment 2", "ring", "half-space"] {
            assert!(message.contains(part), "{message}");
        }
        let times: Vec<f64> = outcome.rows.iter().map(|row| row.time_s).collect();
        assert_eq!(times, [0.0, 1.0, 2.0, 3.0]);
        // An interruption keeps what came before too: here nothing.
        let outcome = simulation.run(&AtomicBool::new(true), &|_, _| {});
        assert_eq!(
            (outcome.ended, outcome.rows.len()),
            (SimulationEnd::Interrupted, 0)
        );
    }
}
