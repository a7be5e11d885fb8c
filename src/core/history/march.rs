//! Time marching: one engine, its memory, and the last pressure, moved from instant to instant.

mod series;

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::contact::half_space::grid::Grid;
use crate::contact::surface::{Response, Surface};
use crate::contact::{ContactError, Engine, Instant, Prescribed, Solution};
use crate::history::extrapolation::Extrapolation;
use crate::history::last_cycle::{LastCycle, kept_bytes};
use crate::history::{Hereditary, Memory, PastState, Stage, Step, TimeRule, Work};
use crate::material::Creep;

/// A contact moving through time, its past kept as memory variables or, as [`DirectMemory`](super::DirectMemory), in full.
pub struct March<'a, M = Memory> {
    engine: &'a mut dyn Engine,
    memory: M,
    rule: TimeRule,
    pressure: Vec<f64>,
    /// The pressure before an instant is solved is only a guess; `None` for an engine that does not ask for one.
    extrapolation: Option<Extrapolation>,
    /// Where one cycle is marched after another.
    last_cycle: Option<LastCycle>,
    history: Vec<f64>,
    /// A of the instant last solved (1/Pa).
    compliance_per_pa: f64,
    solution: Option<Solution>,
    work: Work,
}

/// A march between the halves of a step, where a long instant may be given up: enough to go on from there, bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StepState<'a> {
    /// The stage of the step, from 0.
    pub stage: usize,
    /// As [`Hereditary::state`].
    pub memory: PastState<'a>,
    /// The pressure from which the instant is solved.
    pub guess: Cow<'a, [f64]>,
    /// The hereditary part of the instant.
    pub history: Cow<'a, [f64]>,
    /// What the guesses look back on, of an engine that asks for one.
    pub course: Option<Cow<'a, Extrapolation>>,
    /// The instant before.
    pub solution: Option<Solution>,
    pub work: Work,
}

/// Sees every instant of a march: the engine, the nodal pressure and the solution.
pub type Observer<'o> =
    dyn FnMut(&mut dyn Engine, &[f64], &Solution) -> Result<(), ContactError> + 'o;

impl<'a> March<'a> {
    /// A contact at rest on an undisturbed body of contact compliance C(t) (1/Pa).
    pub fn new(engine: &'a mut dyn Engine, compliance: Creep, rule: TimeRule) -> Self {
        let nodes = engine.nodes();
        Self::with_memory(engine, Memory::new(compliance, nodes), rule)
    }
}

impl<'a, M: Hereditary> March<'a, M> {
    /// A contact at rest on an undisturbed body, whose past `memory` (of the engine's number of nodes) will keep.
    pub fn with_memory(engine: &'a mut dyn Engine, memory: M, rule: TimeRule) -> Self {
        let nodes = engine.nodes();
        Self {
            extrapolation: engine.starts_from_guess().then(Extrapolation::default),
            last_cycle: None,
            engine,
            memory,
            rule,
            pressure: vec![0.0; nodes],
            history: vec![0.0; nodes],
            compliance_per_pa: 0.0,
            solution: None,
            work: Work::default(),
        }
    }

    /// Weights of a step of this length, to be used for as many equal steps as there are.
    pub fn weights(&self, step_s: f64) -> Step<M::Weights> {
        self.memory.weights(step_s, self.rule)
    }

    /// The stages of a step of this length, to be used for as many equal steps as there are: one, or, for a body in which that
    /// would ring, two ([`StepWeights::damped_stages`](super::StepWeights::damped_stages)).
    pub fn stages(&self, step_s: f64) -> Vec<Stage<M::Weights>> {
        self.memory.stages(step_s, self.rule)
    }

    /// Moves on by one step in its stages; `drive` tells what is prescribed at a fraction of the step.
    ///
    /// # Errors
    /// As [`March::step`].
    pub fn step_in_stages(
        &mut self,
        stages: &[Stage<M::Weights>],
        drive: impl Fn(f64) -> Prescribed,
    ) -> Result<(), ContactError> {
        for stage in stages {
            self.step(&stage.weights, stage.prescribed(&drive))?;
        }
        Ok(())
    }

    /// Moves on by one step to the instant at which the drive prescribes this value.
    ///
    /// # Errors
    /// [`ContactError`]; the march cannot go on after it.
    pub fn step(
        &mut self,
        weights: &Step<M::Weights>,
        prescribed: Prescribed,
    ) -> Result<Solution, ContactError> {
        self.begin_step(weights);
        self.end_step(weights, prescribed)
    }

    /// First half of a step: everything that is known before the instant at its end is solved. [`March::pressure`] is then the
    /// guess of the pressure there.
    pub fn begin_step(&mut self, weights: &Step<M::Weights>) {
        self.memory
            .predict(weights, &self.pressure, &mut self.history);
        let is_known =
            (self.last_cycle.as_ref()).is_some_and(|cycle| cycle.guess(&mut self.pressure));
        match &mut self.extrapolation {
            Some(extrapolation) if is_known => extrapolation.forget(),
            Some(extrapolation) => extrapolation.guess(weights.step_s, &mut self.pressure),
            None => {}
        }
    }

    /// Second half of a step, with the same weights: its instant.
    ///
    /// # Errors
    /// As [`March::step`]. After [`ContactError::Interrupted`] all is as it was but the pressure: the guess is lost.
    pub fn end_step(
        &mut self,
        weights: &Step<M::Weights>,
        prescribed: Prescribed,
    ) -> Result<Solution, ContactError> {
        let instant = Instant {
            history: &self.history,
            compliance_per_pa: weights.compliance_per_pa,
            prescribed,
        };
        let solution = self.engine.solve(&instant, &mut self.pressure)?;
        self.memory.commit(weights, &self.pressure);
        if let Some(cycle) = &mut self.last_cycle {
            cycle.see(&self.pressure);
        }
        self.compliance_per_pa = weights.compliance_per_pa;
        Ok(self.count(solution))
    }

    /// Begins a cycle of so many steps before its first instant, whose pressures are guessed from those of the cycle before. Of more than fit
    /// into memory, and of an engine that asks for no guess, none are kept.
    pub(crate) fn begin_like_the_last(&mut self, steps: usize) {
        let nodes = self.pressure.len();
        if self.extrapolation.is_some() && kept_bytes(steps, nodes) > 0 {
            self.last_cycle.get_or_insert_default().begin(nodes, 0);
        }
    }

    /// Guesses from the instants before alone.
    pub(crate) fn forget_last_cycle(&mut self) {
        self.last_cycle = None;
    }

    /// The same behind its first instant, which was the last of the cycle before; where that was begun so.
    pub(crate) fn go_on_like_the_last(&mut self) {
        if let Some(cycle) = &mut self.last_cycle {
            cycle.begin(self.pressure.len(), 1);
        }
    }

    /// Whether guesses come from the cycle before.
    pub(crate) fn knows_last_cycle(&self) -> bool {
        self.last_cycle.is_some()
    }

    fn count(&mut self, solution: Solution) -> Solution {
        self.work += Work {
            instants: 1,
            iterations: solution.iterations as u64,
            convolutions: solution.convolutions as u64,
        };
        self.solution = Some(solution);
        solution
    }

    /// A jump of the drive: two states at one instant.
    ///
    /// # Errors
    /// As [`March::step`].
    pub fn jump(&mut self, prescribed: Prescribed) -> Result<Solution, ContactError> {
        self.step(&self.weights(0.0), prescribed)
    }

    /// Steps per decade of a hold that is to be forgotten.
    pub const HOLD_STEPS_PER_DECADE: f64 = 20.0;

    /// As [`March::hold_in`] the usual number of steps.
    ///
    /// # Errors
    /// As [`March::step`].
    pub fn hold(&mut self, duration_s: f64, prescribed: Prescribed) -> Result<(), ContactError> {
        self.hold_in(Self::HOLD_STEPS_PER_DECADE, duration_s, prescribed)
    }

    /// Holds one value for `duration_s`, in steps that grow in proportion to the time since the hold began: this many per
    /// decade, from a small part of the shortest retardation time on, the smaller the more there are.
    ///
    /// # Errors
    /// As [`March::step`].
    pub fn hold_in(
        &mut self,
        steps_per_decade: f64,
        duration_s: f64,
        prescribed: Prescribed,
    ) -> Result<(), ContactError> {
        const FIRST_STEP_PER_RETARDATION_TIME: f64 = 1e-2;
        if duration_s <= 0.0 {
            return Ok(());
        }
        let shortest_s = self
            .memory
            .shortest_time_s()
            .map_or(duration_s, |time_s| time_s.min(duration_s));
        let finer = Self::HOLD_STEPS_PER_DECADE / steps_per_decade;
        let first_s = finer * FIRST_STEP_PER_RETARDATION_TIME * shortest_s;
        let steps = ((duration_s / first_s).log10() * steps_per_decade).ceil() as i32;
        let growth = (duration_s / first_s).powf(1.0 / f64::from(steps));
        let mut time_s = 0.0;
        for k in 0..=steps {
            let end_s = if k == steps {
                duration_s
            } else {
                first_s * growth.powi(k)
            };
            let stages = self.stages(end_s - time_s);
            self.step_in_stages(&stages, |_| prescribed)?;
            time_s = end_s;
        }
        Ok(())
    }

    /// Shows the present instant to an observer.
    ///
    /// # Errors
    /// What the observer finds.
    pub fn observe(&mut self, observer: &mut Observer<'_>) -> Result<(), ContactError> {
        match &self.solution {
            Some(solution) => observer(&mut *self.engine, &self.pressure, solution),
            None => Ok(()),
        }
    }

    /// As [`Engine::tangent_radius_m`], of the present instant; `None` before the first.
    ///
    /// # Errors
    /// As [`Engine::tangent_radius_m`].
    pub fn tangent_radius_m(&mut self) -> Result<Option<f64>, ContactError> {
        let Some(solution) = &self.solution else {
            return Ok(None);
        };
        let found = self.engine.tangent_radius_m(&self.pressure, solution)?;
        self.work.convolutions += found.1 as u64;
        Ok(Some(found.0))
    }

    /// The surface at the present instant; `None` before the first.
    ///
    /// # Errors
    /// As [`Engine::surface`].
    pub fn surface(&mut self) -> Result<Option<Surface>, ContactError> {
        self.responded(|engine, response| engine.surface(response))
    }

    /// The surface at the present instant over cells, those of `grid` where the engine has none; `None` before the first.
    ///
    /// # Errors
    /// As [`Engine::field`].
    pub fn field(&mut self, grid: &Grid) -> Result<Option<Surface>, ContactError> {
        self.responded(|engine, response| engine.field(response, grid))
    }

    fn responded<T>(
        &mut self,
        ask: impl FnOnce(&mut dyn Engine, &Response<'_>) -> Result<T, ContactError>,
    ) -> Result<Option<T>, ContactError> {
        let Some(solution) = &self.solution else {
            return Ok(None);
        };
        let response = Response {
            pressure: &self.pressure,
            history: &self.history,
            compliance_per_pa: self.compliance_per_pa,
            contact_radius_m: solution.contact_radius_m,
        };
        ask(&mut *self.engine, &response).map(Some)
    }

    /// The hereditary integral q of the present instant per node: what the operator turns into displacement.
    pub fn hereditary(&self) -> impl Iterator<Item = f64> + '_ {
        let nodes = self.pressure.iter().zip(&self.history);
        nodes.map(|(p, h)| self.compliance_per_pa * p + h)
    }

    /// A of the instant last solved (1/Pa): at a jump the compliance at which the body answers at once.
    pub fn compliance_per_pa(&self) -> f64 {
        self.compliance_per_pa
    }

    /// <p, B p> of the instant last solved: twice the elastic energy (J) of its pressure in a body of the compliance 1.
    ///
    /// # Errors
    /// As [`Engine::elastic_displacement`].
    pub fn pressed(&mut self) -> Result<f64, ContactError> {
        let mut displacement = vec![0.0; self.pressure.len()];
        let engine = &mut *self.engine;
        let convolutions = engine.elastic_displacement(&self.pressure, &mut displacement)?;
        self.work.convolutions += convolutions as u64;
        Ok(self.engine.work(&self.pressure, &displacement))
    }

    /// The instant last solved.
    pub fn solution(&self) -> Option<Solution> {
        self.solution
    }

    /// Nodal pressure of the instant last solved, in the engine's unit.
    pub fn pressure(&self) -> &[f64] {
        &self.pressure
    }

    /// Where the march stands between the halves of a stage of a step whose guess this is, for [`March::restore_step`].
    pub fn step_state<'s>(&'s self, stage: usize, guess: &'s [f64]) -> StepState<'s> {
        StepState {
            stage,
            memory: self.memory.state(),
            guess: Cow::Borrowed(guess),
            history: Cow::Borrowed(&self.history),
            course: self.extrapolation.as_ref().map(Cow::Borrowed),
            solution: self.solution,
            work: self.work,
        }
    }

    /// Goes back to between the halves of a step, where a march of the same engine and compliance stood. False, and a march
    /// that has not begun is as it was, where the state is one of others.
    pub fn restore_step(&mut self, state: StepState<'_>) -> bool {
        let nodes = self.pressure.len();
        let fits = state.course.is_some() == self.extrapolation.is_some()
            && state.course.iter().all(|course| course.fits(nodes))
            && [&state.guess, &state.history]
                .iter()
                .all(|f| f.len() == nodes)
            && self.memory.restore(state.memory);
        if fits {
            self.extrapolation = state.course.map(Cow::into_owned);
            self.history = state.history.into_owned();
            self.pressure = state.guess.into_owned();
            if let Some(last) = &state.solution {
                self.engine.resume_from(last);
            }
            (self.solution, self.work) = (state.solution, state.work);
        }
        fits
    }

    /// What the nodal pressure of each node is multiplied by to give its part of the load.
    pub fn loads_per_nodal_pressure(&self) -> Vec<f64> {
        let nodes = 0..self.engine.nodes();
        nodes
            .map(|node| self.engine.load_per_nodal_pressure(node))
            .collect()
    }

    /// The memory of the body.
    pub fn memory(&self) -> &M {
        &self.memory
    }

    /// What the march has cost so far.
    pub fn work(&self) -> Work {
        self.work
    }
}
