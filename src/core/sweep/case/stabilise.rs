//! The stabilised cycle of one case on one engine, in one number of steps: searched directly or marched, then recorded.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

use crate::contact::{ContactError, Engine, Prescribed, Solution, sums};
use crate::cycle::{self, LoopError};
use crate::drive::Control;
use crate::history::{March, Memory, Stage, StepWeights, TimeRule, Work};
use crate::material::Creep;
use crate::steady::{self, Begin, MeanPressure, Remaining, SteadySettings};
use crate::sweep::case::SetupError;
use crate::sweep::case::checkpoint::{Checkpoints, Level, LevelState, Marching};
use crate::sweep::case::recording::Recording;
use crate::sweep::case::solid::Solid;
use crate::sweep::engine::{EngineError, missed_contact, prescribed};
use crate::sweep::plan::{Condition, CyclePlan, Method};
use crate::sweep::record::CaseResult;

/// Cycles after which a direct search is given up for marching, which takes many more where a search takes long: cells that
/// come and go at the edge of a strongly relaxing contact may take 140.
const SEARCH_CYCLES: usize = 200;

/// What a stabilised cycle is recorded for, least first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::sweep) enum Wanted {
    /// The energy loss.
    Loss,
    /// All numbers that have error bars.
    Numbers,
    /// Fields over the surface too.
    Everything,
}

/// What has to be known of a case, whatever its resolution.
#[derive(Clone, Copy)]
pub(in crate::sweep) struct Contact<'a> {
    /// The body of the case, for which engines are laid out.
    pub solid: &'a Solid,
    /// What is solved with: that of the body, or of another in its place.
    pub compliance: &'a Creep,
    /// Under which the cycle is sought.
    pub condition: &'a Condition,
    pub angular_frequency_rad_per_s: f64,
    pub time_rule: TimeRule,
    pub cycle: CyclePlan,
    pub interrupt: &'a AtomicBool,
    /// Where states are kept, if they are.
    pub checkpoints: Option<&'a Checkpoints>,
    /// Whether a cycle that a direct search does not find is marched to.
    pub marches_at_last: bool,
    /// Of the cycle in the most steps; those in fewer only serve its error bars.
    pub wanted: Wanted,
}

/// A cycle's end.
#[derive(Serialize, Deserialize)]
pub(in crate::sweep) struct Stabilised {
    pub method: Method,
    pub cycles: usize,
    pub work: Work,
    pub distance: Option<f64>,
    /// What a reader should know of how it came about, or of why there is no result.
    pub message: Option<String>,
    /// Memory at the start of the recorded cycle, to start a finer one from.
    pub memory: Vec<f64>,
    /// The last instant, which the engine goes on from.
    pub last: Option<Solution>,
    pub result: Option<CaseResult>,
}

/// Why there is neither a result nor the finding that the cycle does not stabilise.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(in crate::sweep) enum CaseError {
    #[error(transparent)]
    Contact(#[from] ContactError),
    #[error(transparent)]
    Loop(#[from] LoopError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    Setup(#[from] SetupError),
}

impl CaseError {
    /// Whether more steps or nodes may do what these could not.
    pub(in crate::sweep) fn may_be_of_the_resolution(&self) -> bool {
        matches!(
            self,
            Self::Contact(ContactError::NotConverged { .. }) | Self::Loop(_)
        )
    }
}

impl Contact<'_> {
    pub fn period_s(&self) -> f64 {
        std::f64::consts::TAU / self.angular_frequency_rad_per_s
    }

    /// What the drive asks for at this fraction of a cycle.
    fn prescribed(&self, cycle_fraction: f64) -> Prescribed {
        let drive = &self.condition.drive;
        let value = drive.value(cycle_fraction) + drive.pull_off_n();
        prescribed(drive.control(), value)
    }

    fn mean(&self) -> Prescribed {
        let drive = &self.condition.drive;
        prescribed(drive.control(), drive.held() + drive.pull_off_n())
    }

    /// Cycles of a march, at most.
    fn most_cycles(&self) -> usize {
        self.cycle.at_cycle.unwrap_or(self.cycle.max_cycles)
    }

    /// Steps per decade of a hold. A stabilised cycle has forgotten it; of a cycle by its number it is a part, which is
    /// refined with the steps of the cycle.
    fn hold_steps(&self, steps: usize) -> f64 {
        let usual = March::<Memory>::HOLD_STEPS_PER_DECADE;
        match self.cycle.at_cycle {
            Some(_) => usual * steps as f64 / CyclePlan::DEFAULT.steps as f64,
            None => usual,
        }
    }

    fn check_interrupted(&self) -> Result<(), ContactError> {
        match self.interrupt.load(Ordering::Relaxed) {
            true => Err(ContactError::Interrupted),
            false => Ok(()),
        }
    }

    /// The same, whose direct search is not followed by a march.
    pub(in crate::sweep) fn searching_alone(self) -> Self {
        Self {
            marches_at_last: self.cycle.method == Method::March,
            ..self
        }
    }

    /// The stabilised cycle in each of these numbers of steps, every one searched from the memory of the last. Only the last has to
    /// succeed.
    pub(in crate::sweep) fn in_steps(
        &self,
        engine: &mut dyn Engine,
        steps: &[usize],
    ) -> Result<Vec<(usize, Stabilised)>, CaseError> {
        let mut solved: Vec<(usize, Stabilised)> = Vec::with_capacity(steps.len());
        for &count in steps {
            let coarser = solved.last().filter(|(_, cycle)| cycle.result.is_some());
            let start = coarser.map(|(_, cycle)| cycle.memory.clone());
            let wanted = match Some(&count) == steps.last() {
                true => self.wanted,
                false => self.wanted.min(Wanted::Numbers),
            };
            let contact = Contact { wanted, ..*self };
            let cycle = match contact.stabilise(engine, count, start) {
                // What fails in fewer steps may succeed in more.
                Err(error) if error.may_be_of_the_resolution() && Some(&count) != steps.last() => {
                    continue;
                }
                ended => ended?,
            };
            let is_found = cycle.result.is_some();
            solved.push((count, cycle));
            if !is_found && !self.marches_at_last {
                break;
            }
        }
        Ok(solved)
    }

    /// The stabilised cycle in `steps` steps, searched from `start` where one is given.
    pub(in crate::sweep) fn stabilise(
        &self,
        engine: &mut dyn Engine,
        steps: usize,
        start: Option<Vec<f64>>,
    ) -> Result<Stabilised, CaseError> {
        let level = self.checkpoints.map(|all| all.begin(engine.nodes(), steps));
        let level = level.as_ref();
        if let Some(finished) = level.and_then(Level::finished) {
            if let Some(last) = &finished.last {
                engine.resume_from(last);
            }
            return Ok(finished);
        }
        let ended = self.on_level(level, engine, steps, start)?;
        if let Some(level) = level {
            level.finish(&ended);
        }
        Ok(ended)
    }

    fn on_level(
        &self,
        level: Option<&Level<'_>>,
        engine: &mut dyn Engine,
        steps: usize,
        start: Option<Vec<f64>>,
    ) -> Result<Stabilised, CaseError> {
        let begin = match level.and_then(Level::state) {
            Some(LevelState::Marching(state)) => return self.march(level, engine, steps, state),
            Some(LevelState::Searching(state)) => Begin::State(state),
            None => Begin::Memory(start),
        };
        if self.cycle.method == Method::March {
            return self.march(level, engine, steps, Marching::default());
        }
        let (direct, why) = match self.search(level, engine, steps, begin) {
            Ok(stabilised) if stabilised.result.is_some() || !self.marches_at_last => {
                return Ok(stabilised);
            }
            Ok(stabilised) => {
                let message = stabilised.message.unwrap_or_default();
                (stabilised.cycles, message)
            }
            Err(CaseError::Contact(error @ ContactError::NotConverged { .. }))
                if self.marches_at_last =>
            {
                (0, error.to_string())
            }
            Err(error) => return Err(error),
        };
        let after_search = Some((direct, why));
        let state = Marching {
            after_search,
            ..Marching::default()
        };
        self.march(level, engine, steps, state)
    }

    fn search(
        &self,
        level: Option<&Level<'_>>,
        engine: &mut dyn Engine,
        steps: usize,
        begin: Begin,
    ) -> Result<Stabilised, CaseError> {
        let mut march = March::new(engine, self.compliance.clone(), self.time_rule);
        let drive = |fraction| self.prescribed(fraction);
        let cycle = steady::Cycle {
            drive: &drive,
            mean: self.mean(),
            period_s: self.period_s(),
            steps,
        };
        let settings = SteadySettings {
            tolerance: self.cycle.tolerance,
            max_cycles: SEARCH_CYCLES.min(self.cycle.max_cycles),
        };
        let watch = steady::Watch {
            stop: &|| self.interrupt.load(Ordering::Relaxed),
            between_cycles: &|state| {
                if let Some(level) = level {
                    level.keep(|| LevelState::Searching(Box::new(state())));
                }
            },
        };
        let found = steady::find_from(&mut march, &cycle, begin, settings, &watch)?;
        self.check_interrupted()?;
        let mut cycles = Cycles::new(self, &march, steps);
        cycles.count = found.cycles;
        cycles.distance = found.distance.is_finite().then_some(found.distance);
        if !found.converged {
            return Ok(cycles.ended(Method::Direct, &march, None));
        }
        // The recorded cycle starts from where the search ended, and is nearer still.
        let recorded = cycles.record(&mut march)?;
        Ok(cycles.ended(Method::Direct, &march, recorded))
    }

    /// Marches on from where the level stands, until a cycle is within the tolerance.
    fn march(
        &self,
        level: Option<&Level<'_>>,
        engine: &mut dyn Engine,
        steps: usize,
        state: Marching,
    ) -> Result<Stabilised, CaseError> {
        let mut march = March::new(engine, self.compliance.clone(), self.time_rule);
        let mut cycles = Cycles::new(self, &march, steps);
        let under_way = 1..self.most_cycles();
        if under_way.contains(&state.cycles) && march.restore(&state.march) {
            (cycles.count, cycles.distance) = (state.cycles, state.distance);
        }
        let after_search = state.after_search;
        if cycles.count == 0 {
            march.jump(self.mean())?;
            let hold_s = self.condition.drive.hold_s();
            march.hold_in(self.hold_steps(steps), hold_s, self.mean())?;
            march.jump(self.prescribed(0.0))?;
        }
        let mut result = None;
        while result.is_none() && cycles.count < self.most_cycles() {
            if let Some(level) = level.filter(|_| cycles.count > 0) {
                level.keep(|| {
                    LevelState::Marching(Marching {
                        after_search: after_search.clone(),
                        cycles: cycles.count,
                        distance: cycles.distance,
                        march: march.state(),
                    })
                });
            }
            match self.cycle.at_cycle {
                Some(number) if cycles.count + 1 < number => cycles.run(&mut march, None)?,
                Some(_) => result = cycles.record(&mut march)?,
                None => {
                    cycles.run(&mut march, None)?;
                    if cycles.is_within_tolerance() {
                        result = cycles.record(&mut march)?;
                    }
                }
            }
        }
        let mut marched = cycles.ended(Method::March, &march, result);
        if let Some((direct, why)) = after_search {
            marched.cycles += direct;
            let also = marched.message.map(|m| format!("; {m}"));
            marched.message = Some(format!(
                "the direct search failed ({why}), so the cycle was marched{}",
                also.unwrap_or_default()
            ));
        }
        Ok(marched)
    }
}

/// Cycles of one case in one number of steps.
struct Cycles<'a> {
    contact: &'a Contact<'a>,
    stages: Vec<Stage<StepWeights>>,
    steps: usize,
    /// Memory variables at the start of the cycle, what it left to do, and its mean pressure.
    start: Vec<f64>,
    remaining: Remaining,
    change: Vec<f64>,
    mean: MeanPressure,
    load_n: Vec<f64>,
    approach_m: Vec<f64>,
    count: usize,
    distance: Option<f64>,
}

impl<'a> Cycles<'a> {
    fn new(contact: &'a Contact<'a>, march: &March<'_>, steps: usize) -> Self {
        let remaining = Remaining::new(contact.compliance, contact.period_s());
        Self {
            contact,
            stages: march.stages(contact.period_s() / steps as f64),
            steps,
            start: Vec::new(),
            change: vec![0.0; march.memory().variables().len()],
            mean: MeanPressure::new(&remaining, march.pressure().len(), steps),
            remaining,
            load_n: Vec::with_capacity(steps + 1),
            approach_m: Vec::with_capacity(steps + 1),
            count: 0,
            distance: None,
        }
    }

    fn is_within_tolerance(&self) -> bool {
        self.distance
            .is_some_and(|distance| distance <= self.contact.cycle.tolerance)
    }

    /// Solves one cycle, recorded where asked to, and estimates its distance to the stabilised one.
    fn run(
        &mut self,
        march: &mut March<'_>,
        mut recording: Option<&mut Recording>,
    ) -> Result<(), CaseError> {
        // A checkpoint may lie here.
        march.reset_predictor();
        self.start.clear();
        self.start.extend_from_slice(march.memory().variables());
        self.load_n.clear();
        self.approach_m.clear();
        self.see(march);
        self.mean.add(0, march.pressure());
        let mut scale = 0.0_f64;
        if let Some(recording) = recording.as_deref_mut() {
            recording.sample(march, 0.0)?;
        }
        for step in 1..=self.steps {
            self.contact.check_interrupted()?;
            let fraction = |end: f64| ((step - 1) as f64 + end) / self.steps as f64;
            let drive = |end| self.contact.prescribed(fraction(end));
            match recording.as_deref_mut() {
                None => march.step_in_stages(&self.stages, drive)?,
                Some(recording) => {
                    march.step_dissipating(&self.stages, drive, &mut recording.dissipation)?;
                    recording.see(march, step, fraction(1.0) * self.contact.period_s())?;
                }
            }
            self.see(march);
            self.mean.add(step, march.pressure());
            scale = scale.max(sums::dot(march.pressure(), march.pressure()));
        }
        self.count += 1;
        self.distance = self.estimate(march, scale.sqrt());
        Ok(())
    }

    fn see(&mut self, march: &March<'_>) {
        if let Some(solution) = march.solution() {
            self.load_n.push(solution.load_n);
            self.approach_m.push(solution.approach_m);
        }
    }

    /// The distance of the memory relative to the pressure, or that of the loop to a closed one; `None` without a pressure.
    fn estimate(&mut self, march: &March<'_>, scale: f64) -> Option<f64> {
        let end = march.memory().variables();
        let nodes = march.pressure().len();
        (self.remaining).change(&self.start, end, &self.mean, &mut self.change);
        let memory = self.remaining.distance(&self.change, nodes) / scale;
        let closure = cycle::closure_error(&self.load_n, &self.approach_m)?;
        (scale > 0.0 && memory.is_finite()).then_some(memory.max(closure))
    }

    /// Solves and records one more cycle; `None` where it turns out to be too far from the stabilised one after all.
    fn record(&mut self, march: &mut March<'_>) -> Result<Option<CaseResult>, CaseError> {
        let contact = self.contact;
        let mut recording = Recording::new(contact, march.pressure().len(), self.steps);
        self.run(march, Some(&mut recording))?;
        if contact.cycle.at_cycle.is_none() && !self.is_within_tolerance() {
            return Ok(None);
        }
        recording.result(contact, march).map(Some)
    }

    fn ended(self, method: Method, march: &March<'_>, result: Option<CaseResult>) -> Stabilised {
        let Contact {
            cycle, condition, ..
        } = self.contact;
        let drive = &condition.drive;
        let message = match (&result, self.distance) {
            (Some(_), _) => None,
            (None, Some(distance)) => {
                let instead = match cycle.method {
                    Method::March => "; method = \"direct\" in [cycle] needs a few cycles alone",
                    Method::Direct => "",
                };
                Some(format!(
                    "after {} cycles the estimated distance to the stabilised cycle is {distance:.1e}, above the tolerance {:.1e}{instead}",
                    self.count, cycle.tolerance
                ))
            }
            (None, None) if drive.control() == Control::Approach && drive.maximum() > 0.0 => {
                Some(missed_contact(drive.maximum()))
            }
            (None, None) => Some(format!("no pressure arose in {} cycles", self.count)),
        };
        Stabilised {
            method,
            cycles: self.count,
            work: march.work(),
            distance: self.distance,
            message,
            memory: self.start,
            last: march.solution(),
            result,
        }
    }
}
