//! The stabilised cycle of one case on one engine, in one number of steps: searched directly or marched, then recorded.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

use crate::contact::{ContactError, Engine, Prescribed, Solution};
use crate::cycle::LoopError;
use crate::engine::{EngineError, prescribed};
use crate::history::{March, Memory, TimeRule, Work};
use crate::material::Creep;
use crate::steady::{self, Record, Steady, SteadySettings};
use crate::sweep::case::SetupError;
use crate::sweep::case::checkpoint::Checkpoints;
use crate::sweep::case::cycles::Cycles;
use crate::sweep::case::recording::Recorder;
use crate::sweep::case::solid::Solid;
use crate::sweep::plan::{Condition, CyclePlan, Method};
use crate::sweep::record::CaseResult;

/// Cycles after which a direct search is given up for marching, which takes many more where a search takes long: cells that
/// come and go at the edge of a strongly relaxing contact may take 140.
const SEARCH_CYCLES: usize = 200;

/// Parts of the oscillation whose cycles lead to that of the whole where it is not found at once, and the cycles that each may take.
const SMALLER_OSCILLATIONS: [f64; 3] = [0.25, 0.5, 0.75];
const PART_CYCLES: usize = 50;

/// What a stabilised cycle is recorded for, least first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Wanted {
    /// The energy loss.
    Loss,
    /// All numbers that have error bars.
    Numbers,
    /// Fields over the surface too.
    Everything,
}

/// What has to be known of a case, whatever its resolution.
#[derive(Clone, Copy)]
pub(crate) struct Contact<'a> {
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
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Stabilised {
    pub method: Method,
    pub cycles: usize,
    pub work: Work,
    pub distance: Option<f64>,
    /// What a reader should know of how it came about, or of why there is no result.
    pub message: Option<String>,
    /// Memory at one end of the recorded cycle, to start a finer one from.
    pub memory: Vec<f64>,
    /// The last instant, which the engine goes on from.
    pub last: Option<Solution>,
    pub result: Option<CaseResult>,
}

impl Stabilised {
    /// No cycle: none was solved by this method.
    pub fn none(method: Method) -> Self {
        Self {
            method,
            cycles: 0,
            work: Work::default(),
            distance: None,
            message: None,
            memory: Vec::new(),
            last: None,
            result: None,
        }
    }
}

/// Why there is neither a result nor the finding that the cycle does not stabilise.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum CaseError {
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
    pub(crate) fn may_be_of_the_resolution(&self) -> bool {
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
    pub(super) fn prescribed(&self, cycle_fraction: f64) -> Prescribed {
        let drive = &self.condition.drive;
        let value = drive.value(cycle_fraction) + drive.pull_off_n();
        prescribed(drive.control(), value)
    }

    /// What the drive asks for before the oscillation.
    fn held(&self) -> Prescribed {
        let drive = &self.condition.drive;
        prescribed(drive.control(), drive.held() + drive.pull_off_n())
    }

    /// What it asks for on average over a cycle.
    fn mean(&self) -> Prescribed {
        let drive = &self.condition.drive;
        prescribed(drive.control(), drive.true_mean() + drive.pull_off_n())
    }

    /// The drive with this part of its oscillation about the average.
    fn in_part(&self, part: f64, cycle_fraction: f64) -> Prescribed {
        if part == 1.0 {
            return self.prescribed(cycle_fraction);
        }
        let between = |mean: f64, value: f64| mean + part * (value - mean);
        match (self.mean(), self.prescribed(cycle_fraction)) {
            (Prescribed::LoadN(mean), Prescribed::LoadN(value)) => {
                Prescribed::LoadN(between(mean, value))
            }
            (Prescribed::ApproachM(mean), Prescribed::ApproachM(value)) => {
                Prescribed::ApproachM(between(mean, value))
            }
            (_, whole) => whole,
        }
    }

    /// That of an attracted indenter, at the modulus of the body at this frequency.
    pub(super) fn tabor_parameter(&self) -> Option<f64> {
        let contact = &self.condition.contact;
        let omega = self.angular_frequency_rad_per_s;
        let modulus_pa = (self.solid.compliance)
            .complex_compliance(omega)
            .norm()
            .recip();
        (contact.adhesion?).tabor_parameter(contact.indenter.as_ref(), modulus_pa)
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

    pub(super) fn check_interrupted(&self) -> Result<(), ContactError> {
        match self.interrupt.load(Ordering::Relaxed) {
            true => Err(ContactError::Interrupted),
            false => Ok(()),
        }
    }

    /// The stabilised cycle in each of these numbers of steps, every one searched from the memory of the last, the first from one found before,
    /// if any was. They serve the error bars of the one in more steps; what fails in fewer steps may succeed in more.
    pub fn in_fewer_steps(
        &self,
        engine: &mut dyn Engine,
        steps: &[usize],
        before: Option<&[f64]>,
    ) -> Result<Vec<(usize, Stabilised)>, CaseError> {
        let contact = Contact {
            wanted: self.wanted.min(Wanted::Numbers),
            ..*self
        };
        let mut solved: Vec<(usize, Stabilised)> = Vec::with_capacity(steps.len());
        for &count in steps {
            let cycle = match contact.stabilise(engine, count, start_of(&solved, before)) {
                Err(error) if error.may_be_of_the_resolution() => continue,
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

    /// The stabilised cycle in the most steps, and those in fewer before it, by searches that no march follows; `None` where one of them
    /// does not find it.
    pub fn by_search_alone(
        &self,
        engine: &mut dyn Engine,
        (fewer, steps): (&[usize], usize),
        before: Option<&[f64]>,
    ) -> Result<Option<InSteps>, CaseError> {
        let contact = Contact {
            marches_at_last: self.cycle.method == Method::March,
            ..*self
        };
        let coarser = contact.in_fewer_steps(engine, fewer, before)?;
        let is_found = |(_, cycle): &(usize, Stabilised)| cycle.result.is_some();
        if !contact.marches_at_last && coarser.last().is_some_and(|cycle| !is_found(cycle)) {
            return Ok(None);
        }
        let finest = contact.stabilise(engine, steps, start_of(&coarser, before))?;
        let all_found = coarser.len() == fewer.len() && coarser.iter().all(is_found);
        Ok((all_found && finest.result.is_some()).then_some((coarser, finest)))
    }

    /// The stabilised cycle in `steps` steps, searched from `start` where one is given.
    pub(crate) fn stabilise(
        &self,
        engine: &mut dyn Engine,
        steps: usize,
        start: Option<Vec<f64>>,
    ) -> Result<Stabilised, CaseError> {
        let Some(checkpoints) = self.checkpoints else {
            return self.solve(engine, steps, start);
        };
        let level = checkpoints.next_level(engine.nodes(), steps);
        // What cannot be used is found again.
        if let Ok(Some(finished)) = level.read::<Stabilised>() {
            if let Some(last) = &finished.last {
                engine.resume_from(last);
            }
            return Ok(finished);
        }
        let ended = self.solve(engine, steps, start)?;
        checkpoints.finished(level, &ended);
        Ok(ended)
    }

    fn solve(
        &self,
        engine: &mut dyn Engine,
        steps: usize,
        start: Option<Vec<f64>>,
    ) -> Result<Stabilised, CaseError> {
        if self.cycle.method == Method::March {
            return self.march(engine, steps, None);
        }
        let mut searched = self.search(engine, steps, start, &[]);
        if let Ok(failed) = &searched
            && failed.result.is_none()
            && self.marches_at_last
        {
            let before = failed.cycles;
            searched = self.search(engine, steps, None, &SMALLER_OSCILLATIONS);
            if let Ok(searched) = &mut searched {
                searched.cycles += before;
            }
        }
        let (direct, why) = match searched {
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
        self.march(engine, steps, Some((direct, why)))
    }

    /// The cycle searched for, after those with these parts of the oscillation about the same mean, each of which starts the next.
    /// That of none is the body relaxed under the mean. After such parts, what the acceleration does not find Newton's method may.
    fn search(
        &self,
        engine: &mut dyn Engine,
        steps: usize,
        mut start: Option<Vec<f64>>,
        parts: &[f64],
    ) -> Result<Stabilised, CaseError> {
        let mut march = March::new(engine, self.compliance.clone(), self.time_rule);
        let stop = || self.interrupt.load(Ordering::Relaxed);
        let most = SEARCH_CYCLES.min(self.cycle.max_cycles);
        let mut recorder = Recorder {
            contact: self,
            steps,
            recording: None,
        };
        let mut find = |march: &mut March<'_>, part: f64, start: Option<Vec<f64>>, max_cycles| {
            let drive = |fraction| self.in_part(part, fraction);
            let cycle = steady::Cycle {
                drive: &drive,
                mean: self.mean(),
                period_s: self.period_s(),
                steps,
            };
            let settings = SteadySettings {
                tolerance: self.cycle.tolerance,
                max_cycles,
                // What is not found at once is looked for with all care.
                is_quick: parts.is_empty(),
            };
            let record: Option<&mut dyn Record> = match part == 1.0 {
                true => Some(&mut recorder),
                false => None,
            };
            let ended = steady::find_recorded(march, (&cycle, &stop), start, settings, record)?;
            self.check_interrupted()?;
            Ok::<_, CaseError>(ended)
        };
        let mut before = 0;
        for &part in parts {
            let (found, _) = find(&mut march, part, start, most.min(PART_CYCLES))?;
            before += found.cycles;
            start = (found.converged).then(|| march.memory().variables().to_vec());
        }
        let (mut found, is_recorded) = find(&mut march, 1.0, start, most)?;
        if !found.converged && !parts.is_empty() {
            before += found.cycles;
            found = self.search_by_newton(&mut march, steps)?;
        }
        let mut cycles = Cycles::new(self, &march, steps);
        cycles.count = before + found.cycles;
        cycles.distance = found.distance.is_finite().then_some(found.distance);
        if !found.converged {
            return Ok(cycles.ended(Method::Direct, &march, None));
        }
        let recorded = match recorder.recording.take_if(|_| is_recorded) {
            Some(recording) => Some(cycles.recorded(recording, &mut march)?),
            // The recorded cycle starts from where the search ended, and is nearer still.
            None => cycles.record(&mut march)?,
        };
        Ok(cycles.ended(Method::Direct, &march, recorded))
    }

    /// Searches on from where a search without success ended.
    fn search_by_newton(&self, march: &mut March<'_>, steps: usize) -> Result<Steady, CaseError> {
        let cycle = steady::Cycle {
            drive: &|fraction| self.prescribed(fraction),
            mean: self.mean(),
            period_s: self.period_s(),
            steps,
        };
        let settings = SteadySettings {
            tolerance: self.cycle.tolerance,
            max_cycles: self.cycle.max_cycles,
            is_quick: false,
        };
        let stop = || self.interrupt.load(Ordering::Relaxed);
        let found = steady::find_by_newton(march, &cycle, settings, &stop)?;
        self.check_interrupted()?;
        Ok(found)
    }

    /// Marches until a cycle is within the tolerance, after a direct search that failed in this many cycles for a reason, if any did.
    fn march(
        &self,
        engine: &mut dyn Engine,
        steps: usize,
        after_search: Option<(usize, String)>,
    ) -> Result<Stabilised, CaseError> {
        let mut march = March::new(engine, self.compliance.clone(), self.time_rule);
        let mut cycles = Cycles::new(self, &march, steps);
        match after_search {
            // The stabilised cycle has forgotten the hold, and this is nearer to it.
            Some(_) => {
                march.relax(self.mean())?;
            }
            None => {
                march.jump(self.held())?;
                let hold_s = self.condition.drive.hold_s();
                march.hold_in(self.hold_steps(steps), hold_s, self.held())?;
            }
        }
        march.jump(self.prescribed(0.0))?;
        let mut result = None;
        while result.is_none() && cycles.count < self.most_cycles() {
            result = cycles.next(&mut march)?;
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

/// The stabilised cycles in fewer steps, and the one in the most.
pub(super) type InSteps = (Vec<(usize, Stabilised)>, Stabilised);

/// Where the search in more steps begins: the memory of the last cycle found in fewer, or that of one found before on the same nodes.
pub(super) fn start_of(
    coarser: &[(usize, Stabilised)],
    before: Option<&[f64]>,
) -> Option<Vec<f64>> {
    match coarser.last() {
        Some((_, last)) => last.result.as_ref().map(|_| last.memory.clone()),
        None => before.map(<[f64]>::to_vec),
    }
}
