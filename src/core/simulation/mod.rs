//! One drive history from its beginning to its end: what is asked for ([`scenario`]), the march, and what is kept of it.
//!
//! # Out of contact
//!
//! Under a load of zero, or with the indenter retracted beyond the surface, there is no contact: no pressure, contact radius
//! 0, and the surface recovers freely until it is met again, where it may still be deformed. Under load control the indenter
//! may then be anywhere clear of the surface, and its approach is undefined (`None`). One case is different: where a drive
//! that does not jump touches zero load at a single instant, the approach has a limit there, that at which the indenter just
//! touches the surface. Both engines return it, and it is reported for exactly these instants; those at which the history
//! begins or ends count, provided that the load is above zero on the other side.

mod attracted;
pub mod between;
pub mod body_material;
pub mod checkpoint;
pub mod cycles;
pub mod errors;
mod follow;
pub mod outside_model;
pub mod scenario;
pub mod work;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use crate::contact::ContactError;
use crate::contact::surface::Surface;
use crate::drive::{Control, Fineness, MAX_MOMENTS, Schedule, Steps};
use crate::engine::{EngineBuilder, EngineError, LargestContact, MAX_GROWTHS, missed_contact};
use crate::quantity::{Dimension, format_human};
use crate::simulation::body_material::Compliance;
use crate::simulation::checkpoint::{HistoryCheckpoint, HistoryState};
use crate::simulation::cycles::HistoryCycle;
use crate::simulation::errors::{Followed, Plan, RowErrors};
use crate::simulation::follow::{MarchError, Run, Trajectory};
use crate::simulation::scenario::{OutputPlan, ScenarioPlan};
use crate::simulation::work::Separation;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::plan::setup::{SetupError, check_direct_sum};
use crate::sweep::record::attracted::Jump;

/// A scenario, ready to run.
pub struct Simulation {
    plan: ScenarioPlan,
    compliance: Compliance,
    /// The history itself, and the coarser ones that tell its errors.
    levels: Vec<Level>,
    errors: Option<Plan>,
    /// Why there are no errors, where they were asked for.
    without_errors: Option<String>,
    /// How often the domain of the largest contact is halved for the first.
    halvings: usize,
    /// Ends an instant under way, where the engine's instants are long.
    interrupt: Option<Arc<AtomicBool>>,
}

/// One resolution of the history.
struct Level {
    schedule: Schedule,
    /// On the domain of the largest contact.
    engines: EngineBuilder,
}

/// One row of the history.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct HistoryRow {
    pub time_s: f64,
    pub load_n: f64,
    /// `None` where the indenter is clear of the surface under load control.
    pub approach_m: Option<f64>,
    pub contact_radius_m: f64,
    /// `None` where the indenter's shape makes the pressure unbounded.
    pub peak_pressure_pa: Option<f64>,
    /// Work (J) of the indenter on the body up to here; `None` where rows of an earlier version of the program do not tell it.
    pub work_j: Option<f64>,
}

/// The surface at a requested time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceRecord {
    pub row: HistoryRow,
    pub surface: Surface,
    /// Gap between indenter and surface per point, infinite where there is no indenter; `None` where the approach is
    /// undefined.
    pub gap_m: Option<Vec<f64>>,
}

/// What a simulation came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulationOutcome {
    /// One row per moment; two with the same time at a jump.
    pub rows: Vec<HistoryRow>,
    /// At the requested times, in the order in which they were requested, as far as the march came.
    pub profiles: Vec<SurfaceRecord>,
    pub fields: Vec<SurfaceRecord>,
    /// The cycles of sine segments, as far as the march came.
    pub cycles: Vec<HistoryCycle>,
    /// Errors of the rows, where they were asked for and the history is whole.
    pub errors: Vec<RowErrors>,
    /// Why errors are missing although they were asked for.
    pub errors_missing: Option<String>,
    /// Half width of the computational domain (m) at the end, and how often it had to be enlarged beyond the largest contact
    /// predicted.
    pub domain_half_width_m: f64,
    pub domain_enlarged: usize,
    /// Contact iterations over all moments.
    pub iterations: u64,
    /// Jumps of a contact whose edge an attraction moves, in order.
    pub jumps: Vec<Jump>,
    /// The pull of such a contact.
    pub separation: Option<Separation>,
    pub ended: SimulationEnd,
}

/// How a simulation ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// [`SetupError`] where the material cannot make a contact, a requested time lies outside the history, or the engine
    /// cannot treat the indenter or give what is asked for.
    pub fn new(plan: ScenarioPlan) -> Result<Self, SetupError> {
        Self::with_fineness(plan, Fineness::FULL)
    }

    /// The same with fewer or more time steps, to see what they do; nothing but the full history is given errors, profiles and
    /// fields.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_fineness(mut plan: ScenarioPlan, fineness: Fineness) -> Result<Self, SetupError> {
        plan.check()?;
        plan.solver = (plan.solver).on_own_cells(plan.contact.indenter.as_ref());
        let compliance = plan.contact.material.compliance()?;
        let steps = match plan.step_s {
            Some(step_s) => Steps::Given { step_s },
            None => Steps::Chosen {
                shortest_time_s: plan.contact.material.shortest_time_s(),
            },
        };
        plan.contact.check_attraction(plan.solver.engine)?;
        if plan.contact.is_attracted() {
            check_attracted(&plan.output, &compliance)?;
        }
        let largest = LargestContact {
            control: plan.drive.control(),
            maximum: plan.drive.maximum() + plan.drive.pull_off_n(),
            // A solid or fluid meets no more than its compliance at the end, and no more than the largest load.
            compliance_per_pa: compliance.largest_per_pa(plan.drive.duration_s()),
        };
        let poisson_ratio = plan.contact.material.poisson_ratio();
        let layer = LayerPlan::for_body(plan.contact.layer, poisson_ratio)?;
        let output = &plan.output;
        let requested_s = [&output.profiles_at_s[..], &output.fields_at_s[..]].concat();
        let level = |fineness, nodes| -> Result<Level, SetupError> {
            let schedule = Schedule::of_fineness(&plan.drive, steps, &requested_s, fineness)?;
            let solver = plan.solver.with_nodes(nodes);
            Ok(Level {
                schedule,
                engines: EngineBuilder::on(layer, plan.contact.indenter.clone(), solver, largest)?,
            })
        };
        let full = level(fineness, plan.solver.nodes())?;
        let (moments, nodes) = (full.schedule.moments.len(), full.engines.nodes());
        if let Compliance::Samples(_) = compliance {
            check_direct_sum(moments, nodes)?;
        }
        let wanted = plan.output.error_bars && fineness == Fineness::FULL;
        let errors = wanted.then(|| error_plan(&plan, &compliance, &full));
        let (errors, without_errors) = match errors.transpose() {
            Ok(errors) => (errors, None),
            Err(why) => (None, Some(why)),
        };
        let halvings = halvings(&full, largest, &compliance);
        let mut levels = vec![full];
        let coarser = errors
            .iter()
            .flat_map(|plan| plan.resolutions.iter().skip(1));
        for (fineness, nodes) in coarser {
            levels.push(level(*fineness, *nodes)?);
        }
        Ok(Self {
            levels,
            errors,
            without_errors,
            halvings,
            compliance,
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

    /// Memory (bytes) that the history takes while it runs. Within 20 % of what was measured on 1024 x 1024 and 2048 x 2048 cells, for a contact that stays inside its domain.
    pub fn predicted_memory_bytes(&self) -> u64 {
        /// What the program takes whatever it computes.
        const PROGRAM_BYTES: u64 = 15_000_000;
        let variables = match &self.compliance {
            Compliance::Series(creep) => {
                creep.branches().len() + usize::from(creep.viscosity_pa_s().is_some())
            }
            // The sum over the past needs every pressure of it.
            Compliance::Samples(_) => self.schedule().moments.len(),
        };
        // Coarser levels take less, one after another.
        let engines = &self.levels[0].engines;
        // Beside those of the march, the pressure that was foreseen; and pressure, displacement and gap of surfaces to be written.
        let fields = self.plan.output.fields_at_s.len();
        let kept = engines.nodes() + 3 * fields * engines.surface_cells();
        PROGRAM_BYTES + engines.predicted_memory_bytes(variables) + (size_of::<f64>() * kept) as u64
    }

    /// The time steps.
    pub fn schedule(&self) -> &Schedule {
        &self.levels[0].schedule
    }

    /// Moments at all resolutions together.
    pub fn moments(&self) -> usize {
        let moments = self.levels.iter().map(|level| level.schedule.moments.len());
        moments.sum()
    }

    /// Runs the history, on domains that grow with the contact, and then at the coarser resolutions that tell its errors. An
    /// instant that cannot be solved ends it, as does `interrupt`; what came before is in the outcome either way.
    pub fn run(&self, interrupt: &AtomicBool, progress: &Progress<'_>) -> SimulationOutcome {
        self.run_from(None, None, interrupt, progress)
    }

    /// As [`Simulation::run`], from where an earlier run of the same scenario was; the outcome is the same, bit for bit. An
    /// interruption leaves a new checkpoint.
    pub fn run_from(
        &self,
        state: Option<HistoryState<'_>>,
        checkpoint: Option<&HistoryCheckpoint>,
        interrupt: &AtomicBool,
        progress: &Progress<'_>,
    ) -> SimulationOutcome {
        let (mut finished, mut begun) = match state {
            Some(state) if self.fits(&state) => {
                let begun = (state.trajectory.into_owned(), state.step);
                (state.finished.into_owned(), Some(begun))
            }
            _ => (Vec::new(), None),
        };
        let all = self.moments();
        let mut ended = SimulationEnd::Done;
        while let Some(level) = self.levels.get(finished.len()) {
            let before: usize = finished
                .iter()
                .map(|trajectory| trajectory.rows.len())
                .sum();
            let (trajectory, result) = self.follow(
                level,
                begun.take(),
                &Run {
                    finished: &finished,
                    checkpoint,
                    interrupt,
                    progress: &|done, _| progress(before + done, all),
                },
            );
            finished.push(trajectory);
            match (result, finished.len()) {
                (Ok(()), 1) if self.misses(&finished[0]) => {
                    let approach_m = self.plan.drive.maximum();
                    ended = SimulationEnd::Failed(missed_contact(approach_m));
                }
                (Ok(()), _) => {}
                (Err(MarchError::Contact(ContactError::Interrupted)), _) => {
                    ended = SimulationEnd::Interrupted;
                }
                (Err(error), 1) => {
                    ended = SimulationEnd::Failed(place(level, &finished[0], &error));
                }
                // A coarser resolution that fails takes its part of the errors with it, and nothing else.
                (Err(error), last) => {
                    finished[last - 1].failed = Some(place(level, &finished[last - 1], &error));
                }
            }
            if ended != SimulationEnd::Done {
                break;
            }
        }
        self.outcome(finished, ended)
    }

    /// Whether contact is prescribed but never made.
    fn misses(&self, trajectory: &Trajectory) -> bool {
        let drive = &self.plan.drive;
        drive.control() == Control::Approach
            && drive.maximum() > 0.0
            && trajectory.rows.iter().all(|row| row.load_n == 0.0)
    }

    /// Whether the state can be one of this history.
    fn fits(&self, state: &HistoryState<'_>) -> bool {
        let mut trajectories = state.finished.iter().chain([&*state.trajectory]);
        state.finished.len() < self.levels.len()
            && trajectories.all(|trajectory| trajectory.growths <= self.halvings + MAX_GROWTHS)
    }

    fn outcome(
        &self,
        mut trajectories: Vec<Trajectory>,
        ended: SimulationEnd,
    ) -> SimulationOutcome {
        self.take_attraction_off(&mut trajectories);
        let mut cycles = cycles::in_rows(&self.plan, &trajectories[0].rows);
        let mut separation = Separation::of(&self.plan, &trajectories[0].rows);
        let mut errors = Vec::new();
        let mut errors_missing = self.without_errors.clone();
        if let (SimulationEnd::Done, Some(plan)) = (&ended, &self.errors) {
            let followed = trajectories.iter().zip(&self.levels);
            let followed = followed.map(|(trajectory, level)| Followed {
                rows: &trajectory.rows,
                in_full: &level.schedule.in_full,
            });
            errors = plan.errors(&followed.collect::<Vec<_>>());
            let coarser = trajectories.iter().skip(1);
            let coarser = coarser.map(|trajectory| cycles::in_rows(&self.plan, &trajectory.rows));
            cycles::add_errors(&mut cycles, &coarser.collect::<Vec<_>>(), plan);
            let all: Vec<_> = trajectories
                .iter()
                .map(|trajectory| Separation::of(&self.plan, &trajectory.rows))
                .collect();
            separation = separation.map(|own| own.with_errors(&all, plan));
            let failed = trajectories
                .iter()
                .find_map(|trajectory| trajectory.failed.as_ref());
            errors_missing = errors_missing.or(failed.map(|why| {
                format!("the coarser history that tells the errors could not be followed: {why}")
            }));
        }
        let iterations = trajectories
            .iter()
            .map(|trajectory| trajectory.iterations)
            .sum();
        let Trajectory {
            rows,
            surfaces,
            growths,
            jumps,
            ..
        } = trajectories.swap_remove(0);
        let [profiles, fields] = surfaces.map(|s| s.into_iter().flatten().collect());
        SimulationOutcome {
            rows,
            profiles,
            fields,
            cycles,
            errors,
            errors_missing,
            // What a domain came to be is a domain that could be built.
            domain_half_width_m: (self.domain(&self.levels[0], growths))
                .map_or(0.0, |engines| engines.half_width_m()),
            domain_enlarged: growths.saturating_sub(self.halvings),
            iterations,
            jumps,
            separation,
            ended,
        }
    }

    /// Takes the attraction, which the contact carries too, off all loads.
    fn take_attraction_off(&self, trajectories: &mut [Trajectory]) {
        let pull_off_n = self.plan.drive.pull_off_n();
        if pull_off_n == 0.0 {
            return;
        }
        for Trajectory { rows, surfaces, .. } in trajectories {
            let of_surfaces = surfaces.iter_mut().flatten().flatten();
            let rows = rows.iter_mut().chain(of_surfaces.map(|s| &mut s.row));
            rows.for_each(|row| row.load_n -= pull_off_n);
        }
    }
}

/// Refuses what is not computed where an attraction moves the edge.
fn check_attracted(output: &OutputPlan, compliance: &Compliance) -> Result<(), SetupError> {
    if matches!(compliance, Compliance::Samples(_)) {
        return Err(EngineError::AttractedSamples.into());
    }
    match output.profiles_at_s.is_empty() && output.fields_at_s.is_empty() {
        true => Ok(()),
        false => Err(EngineError::AttractedSurface.into()),
    }
}

/// The resolutions that tell the errors; otherwise why there are none.
fn error_plan(plan: &ScenarioPlan, compliance: &Compliance, full: &Level) -> Result<Plan, String> {
    if full.engines.has_cells_of_its_own() {
        return Err("the cells are those of the map, of which there are no fewer".to_owned());
    }
    let solver = &plan.solver;
    let nodes = errors::coarser_nodes(solver)
        .ok_or_else(|| "there are too few nodes to leave any out".to_owned())?;
    let can_be_coarser = full.schedule.can_be_coarser;
    let doubled = 2 * full.schedule.moments.len();
    let fits = match compliance {
        Compliance::Series(_) => doubled <= MAX_MOMENTS,
        Compliance::Samples(_) => check_direct_sum(doubled, full.engines.nodes()).is_ok(),
    };
    if !can_be_coarser && !fits {
        return Err("there are no steps to leave out, and too many to be halved".to_owned());
    }
    Ok(Plan::new(can_be_coarser, solver.engine, nodes))
}

/// How often the domain of the largest contact can be halved for the first.
fn halvings(full: &Level, largest: LargestContact, compliance: &Compliance) -> usize {
    let first = full.schedule.moments.iter().find(|m| m.value > 0.0);
    first.map_or(0, |moment| {
        full.engines.halvings_to(LargestContact {
            maximum: moment.value,
            compliance_per_pa: compliance.largest_per_pa(moment.time_s),
            ..largest
        })
    })
}

/// An error with the time and segment at which it arose: those of the first moment without a row.
fn place(level: &Level, trajectory: &Trajectory, error: &MarchError) -> String {
    match level.schedule.moments.get(trajectory.rows.len()) {
        Some(moment) => format!(
            "at {}, in segment {} of the drive: {error}",
            format_human(moment.time_s, Dimension::Time, 6),
            moment.segment + 1
        ),
        None => error.to_string(),
    }
}

impl HistoryRow {
    /// Contact area (m^2).
    pub fn contact_area_m2(&self) -> f64 {
        std::f64::consts::PI * self.contact_radius_m * self.contact_radius_m
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::sync::atomic::Ordering;
    use std::time::Duration;

    use super::*;
    use crate::drive::{Segment, SegmentedDrive};
    use crate::indenter::{Axisymmetric, Indenter, Setting, Sphere};
    use crate::material::library;

    use crate::simulation::follow::is_floating;
    use crate::simulation::scenario::OutputPlan;
    use crate::sweep::store::Store;

    /// (time, whether the approach is undefined) at every unloaded moment.
    fn unloaded(segments: Vec<Segment>) -> Vec<(f64, bool)> {
        let drive = SegmentedDrive::new(Control::Load, segments).unwrap();
        let schedule = Schedule::new(&drive, Steps::Given { step_s: 1.0 }, &[]).unwrap();
        let moments = schedule.moments.iter().enumerate();
        let unloaded = moments.filter(|(_, moment)| moment.value == 0.0);
        let floating = |index| is_floating(Control::Load, &schedule.moments, index);
        unloaded
            .map(|(index, moment)| (moment.time_s, floating(index)))
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

    /// A sphere of 10 mm of which no more is known than 0.1 mm around its apex.
    #[derive(Debug)]
    struct Cap(Sphere);

    impl Indenter for Cap {
        fn shape(&self) -> &'static str {
            "cap"
        }
        fn parameters(&self) -> Vec<Setting> {
            Vec::new()
        }
        fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
            self.0.gap_m(x_m, y_m)
        }
        fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
            Some(self)
        }
        fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
            self.0.elastic_half_width_m(load_n, compliance_per_pa)
        }
    }

    impl Axisymmetric for Cap {
        fn transformed_gap_m(&self, x_m: f64) -> f64 {
            100.0 * x_m * x_m
        }
        fn contact_limit_m(&self) -> Option<f64> {
            None
        }
        fn known_radius_m(&self) -> Option<f64> {
            Some(1e-4)
        }
        fn has_bounded_pressure(&self) -> bool {
            true
        }
    }

    /// A sphere of 10 mm whose contact is predicted far too small.
    #[derive(Debug)]
    struct Underrated(Sphere);

    impl Indenter for Underrated {
        fn shape(&self) -> &'static str {
            self.0.shape()
        }
        fn parameters(&self) -> Vec<Setting> {
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
            step_s: Some(0.5),
            output: OutputPlan {
                profiles_at_s: vec![9.0, 1.0],
                fields_at_s: vec![2.0],
                field_cells: 8,
                error_bars: true,
            },
            ..ScenarioPlan::new(
                library::find("pmma").unwrap().material().unwrap(),
                Arc::new(Underrated(Sphere::new(0.01).unwrap())),
                SegmentedDrive::new(Control::Load, segments).unwrap(),
            )
        };
        let simulation = Simulation::new(plan).unwrap();
        let whole = simulation.run(&AtomicBool::new(false), &|_, _| {});
        assert_eq!(whole.ended, SimulationEnd::Done);
        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), "", false).unwrap();
        let (mut runs, mut grown) = (0, 0);
        let outcome = loop {
            let checkpoint = HistoryCheckpoint::of(&store, Duration::ZERO);
            let state = checkpoint.find().unwrap();
            grown = state
                .as_ref()
                .map_or(0, |state| state.trajectory.growths)
                .max(grown);
            let (interrupt, steps) = (AtomicBool::new(false), Cell::new(0));
            let outcome = simulation.run_from(state, Some(&checkpoint), &interrupt, &|_, _| {
                steps.set(steps.get() + 1);
                interrupt.store(steps.get() == 3, Ordering::Relaxed);
            });
            runs += 1;
            if outcome.ended != SimulationEnd::Interrupted {
                break outcome;
            }
        };
        assert_eq!(outcome, whole);
        assert_eq!(grown, whole.domain_enlarged + simulation.halvings);
        assert!(runs > 8 && grown > 0, "{runs} runs, {grown} times enlarged");
    }

    #[test]
    fn a_history_that_cannot_go_on_keeps_what_came_before_and_says_where_it_stopped() {
        let segments = vec![
            Segment::Step {
                to: 0.0,
                duration_s: 3.0,
            },
            ramp(10.0, 2.0),
        ];
        let plan = ScenarioPlan {
            title: "cap".to_owned(),
            step_s: Some(1.0),
            output: OutputPlan::default(),
            ..ScenarioPlan::new(
                library::find("pmma").unwrap().material().unwrap(),
                Arc::new(Cap(Sphere::new(0.01).unwrap())),
                SegmentedDrive::new(Control::Load, segments).unwrap(),
            )
        };
        let simulation = Simulation::new(plan).unwrap();
        let outcome = simulation.run(&AtomicBool::new(false), &|_, _| {});
        let SimulationEnd::Failed(message) = &outcome.ended else {
            panic!("{outcome:?}")
        };
        for part in ["at 4.00000 s", "segment 2", "not known"] {
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
