//! The stabilised cycle of one case on one engine, in one number of steps: searched directly or marched, then recorded.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

use crate::contact::surface::Surface;
use crate::contact::{ContactError, Engine, Prescribed, Solution, sums};
use crate::cycle::{self, ContactDuty, Extrema, Loop, LoopError};
use crate::drive::Control;
use crate::history::{Dissipation, March, Memory, Stage, StepWeights, TimeRule, Work};
use crate::material::Creep;
use crate::steady::{self, Begin, MeanPressure, Remaining, SteadySettings};
use crate::sweep::case::SetupError;
use crate::sweep::case::checkpoint::{Checkpoints, Level, LevelState};
use crate::sweep::case::pressure::Pressures;
use crate::sweep::case::solid::Solid;
use crate::sweep::case::tangent_radius::TangentRadius;
use crate::sweep::engine::{AsContactError, EngineError, missed_contact, prescribed};
use crate::sweep::plan::check::PlanError;
use crate::sweep::plan::{Condition, CyclePlan, Method};
use crate::sweep::record::{BranchLoss, CaseResult, CellLoss, RecordedCycle, SurfaceLoss};

/// Cycles after which a direct search is given up for marching, which takes many more where a search takes long: cells that
/// come and go at the edge of a strongly relaxing contact may take 140.
const SEARCH_CYCLES: usize = 200;

/// Where rounding of load and approach is more than this part of the area of a loop, far above and below the spectrum, the loss is
/// what the branches dissipate, which no rounding touches.
const LARGEST_ROUNDING: f64 = 1e-6;

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
    pub checkpoints: &'a Checkpoints,
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
    Contact(ContactError),
    #[error(transparent)]
    Loop(#[from] LoopError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Plan(#[from] PlanError),
    #[error("interrupted")]
    Interrupted,
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

impl AsContactError for CaseError {
    fn as_contact_error(&self) -> Option<&ContactError> {
        match self {
            Self::Contact(error) => Some(error),
            _ => None,
        }
    }
}

impl From<ContactError> for CaseError {
    fn from(error: ContactError) -> Self {
        match error {
            ContactError::Interrupted => Self::Interrupted,
            other => Self::Contact(other),
        }
    }
}

impl Contact<'_> {
    fn period_s(&self) -> f64 {
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

    fn interrupted(&self) -> bool {
        self.interrupt.load(Ordering::Relaxed)
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
        let level = self.checkpoints.begin(engine.nodes(), steps);
        if let Some(finished) = self.checkpoints.finished(&level) {
            if let Some(last) = &finished.last {
                engine.resume_from(last);
            }
            return Ok(finished);
        }
        let ended = self.on_level(&level, engine, steps, start)?;
        self.checkpoints.finish(&level, &ended);
        Ok(ended)
    }

    fn on_level(
        &self,
        level: &Level,
        engine: &mut dyn Engine,
        steps: usize,
        start: Option<Vec<f64>>,
    ) -> Result<Stabilised, CaseError> {
        let begin = match self.checkpoints.state(level) {
            Some(marching @ LevelState::Marching { .. }) => {
                return self.march(level, engine, steps, marching);
            }
            Some(LevelState::Searching(state)) => Begin::State(state),
            None => Begin::Memory(start),
        };
        if self.cycle.method == Method::March {
            return self.march(level, engine, steps, LevelState::unmarched(None));
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
        let unmarched = LevelState::unmarched(Some((direct, why)));
        self.march(level, engine, steps, unmarched)
    }

    fn search(
        &self,
        level: &Level,
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
            stop: &|| self.interrupted(),
            between_cycles: &|state| {
                if self.checkpoints.is_wanted() {
                    let state = LevelState::Searching(Box::new(state()));
                    self.checkpoints.keep(level, state);
                }
            },
        };
        let found = steady::find_from(&mut march, &cycle, begin, settings, &watch)?;
        if self.interrupted() {
            return Err(CaseError::Interrupted);
        }
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
        level: &Level,
        engine: &mut dyn Engine,
        steps: usize,
        state: LevelState,
    ) -> Result<Stabilised, CaseError> {
        let mut march = March::new(engine, self.compliance.clone(), self.time_rule);
        let mut cycles = Cycles::new(self, &march, steps);
        let after_search = match state {
            LevelState::Marching {
                after_search,
                cycles: count,
                distance,
                march: state,
            } => {
                let under_way = 1..self.most_cycles();
                if under_way.contains(&count) && march.restore(&state) {
                    (cycles.count, cycles.distance) = (count, distance);
                }
                after_search
            }
            LevelState::Searching(_) => None,
        };
        if cycles.count == 0 {
            march.jump(self.mean())?;
            let hold_s = self.condition.drive.hold_s();
            march.hold_in(self.hold_steps(steps), hold_s, self.mean())?;
            march.jump(self.prescribed(0.0))?;
        }
        let mut result = None;
        while result.is_none() && cycles.count < self.most_cycles() {
            if cycles.count > 0 && self.checkpoints.is_wanted() {
                let marching = LevelState::Marching {
                    after_search: after_search.clone(),
                    cycles: cycles.count,
                    distance: cycles.distance,
                    march: march.state(),
                };
                self.checkpoints.keep(level, marching);
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

/// What a recorded cycle is watched for, as far as it is wanted.
struct Recording {
    samples: Loop,
    dissipation: Dissipation,
    pressures: Option<Pressures>,
    tangent_radius: Option<TangentRadius>,
}

impl Recording {
    /// Takes in the instant at the end of a step.
    fn see(&mut self, march: &mut March<'_>, step: usize, time_s: f64) -> Result<(), ContactError> {
        self.sample(march, time_s)?;
        if let Some(pressures) = &mut self.pressures {
            pressures.see(march, step, time_s)?;
        }
        if let Some(tangent_radius) = &mut self.tangent_radius {
            tangent_radius.see(march, step)?;
        }
        Ok(())
    }

    /// Appends the present instant to the loop.
    fn sample(&mut self, march: &mut March<'_>, time_s: f64) -> Result<(), ContactError> {
        let with_numbers = self.tangent_radius.is_some();
        sample(march, &mut self.samples, time_s, with_numbers)
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
            if self.contact.interrupted() {
                return Err(CaseError::Interrupted);
            }
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
        let step_s = contact.period_s() / self.steps as f64;
        let nodes = march.pressure().len();
        let mut recording = Recording {
            samples: Loop::default(),
            dissipation: Dissipation::new(contact.compliance, nodes, step_s, contact.time_rule),
            pressures: (contact.wanted >= Wanted::Everything)
                .then(|| Pressures::new(&contact.condition.drive, self.steps)),
            tangent_radius: (contact.wanted >= Wanted::Numbers)
                .then(|| TangentRadius::new(self.steps)),
        };
        self.run(march, Some(&mut recording))?;
        if contact.cycle.at_cycle.is_none() && !self.is_within_tolerance() {
            return Ok(None);
        }
        contact.result(march, recording).map(Some)
    }

    /// Why there was no contact.
    fn without_pressure(&self) -> String {
        let drive = &self.contact.condition.drive;
        match drive.control() == Control::Approach && drive.maximum() > 0.0 {
            true => missed_contact(drive.maximum()),
            false => format!("no pressure arose in {} cycles", self.count),
        }
    }

    fn ended(self, method: Method, march: &March<'_>, result: Option<CaseResult>) -> Stabilised {
        let message = match (&result, self.distance) {
            (Some(_), _) => None,
            (None, Some(distance)) => {
                let instead = match self.contact.cycle.method {
                    Method::March => "; method = \"direct\" in [cycle] needs a few cycles alone",
                    Method::Direct => "",
                };
                Some(format!(
                    "after {} cycles the estimated distance to the stabilised cycle is {distance:.1e}, above the tolerance {:.1e}{instead}",
                    self.count, self.contact.cycle.tolerance
                ))
            }
            (None, None) => Some(self.without_pressure()),
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

impl Contact<'_> {
    fn result(&self, march: &mut March<'_>, recording: Recording) -> Result<CaseResult, CaseError> {
        let Recording {
            mut samples,
            dissipation,
            pressures,
            tangent_radius,
        } = recording;
        // The contact carries the attraction too.
        let pull_off_n = self.condition.drive.pull_off_n();
        let mut pressures = pressures.map_or_else(Vec::new, Pressures::finished);
        if pull_off_n > 0.0 {
            samples
                .load_n
                .iter_mut()
                .for_each(|load| *load -= pull_off_n);
            pressures.iter_mut().for_each(|p| p.load_n -= pull_off_n);
        }
        let is_transient = self.cycle.at_cycle.is_some();
        let mut analysis = match is_transient {
            true => cycle::analyse_open(&samples.load_n, &samples.approach_m)?,
            false => cycle::analyse(&samples.load_n, &samples.approach_m)?,
        };
        // What an open cycle dissipates is not the area of a loop: the body stores another part of the work.
        let compliance = self.compliance.branches();
        let branches = if is_transient { &[] } else { compliance };
        let energies = dissipation.branch_energies_j();
        // A body without branches is elastic and loses nothing: what its loop encloses is rounding.
        let is_rounding = analysis.rounding_j() > LARGEST_ROUNDING * analysis.energy_loss_j.abs();
        if energies.is_empty() || (is_rounding && !is_transient) {
            // The sum of nothing would be -0.
            analysis = analysis.of_energy_loss(energies.iter().fold(0.0, |sum, e| sum + e));
        }
        let radii = &samples.contact_radius_m;
        // The mean over the period counts the seam once.
        let mean_radius_m =
            radii.iter().skip(1).sum::<f64>() / radii.len().saturating_sub(1).max(1) as f64;
        let drive = &self.condition.drive;
        let contact_duty = match drive.loaded_part() {
            Some(part) => Some(ContactDuty { part, error: 0.0 }),
            None => ContactDuty::of(&samples.load_n),
        };
        let contact_duty = contact_duty.unwrap_or(ContactDuty::WHOLE);
        // A loop that holds time out of contact is read as no modulus.
        let moduli = tangent_radius
            .filter(|_| contact_duty == ContactDuty::WHOLE)
            .and_then(|tangent_radius| tangent_radius.mean_m(mean_radius_m))
            .and_then(|radius_m| {
                let nu = self.condition.material.poisson_ratio().unwrap_or(0.0);
                analysis.equivalent_moduli_pa(radius_m, nu)
            })
            .map(|moduli| {
                let omega = self.angular_frequency_rad_per_s;
                self.condition.material.of_loop(moduli, omega)
            });
        let peaks: Option<Vec<f64>> = samples.peak_pressure_pa.iter().copied().collect();
        let extrema = |signal: &[f64]| {
            Extrema::of(signal).ok_or(LoopError::TooFewSamples {
                samples: 0,
                needed: 1,
            })
        };
        let largest_radius_m = radii.iter().copied().fold(0.0, f64::max);
        let work = dissipation.nodal_work();
        let surface_loss = match self.wanted {
            Wanted::Everything if !is_transient => {
                surface_loss(march.surface_density(work, largest_radius_m)?)
            }
            _ => SurfaceLoss::default(),
        };
        let branches = branches.iter().zip(&self.solid.shares_of_indenter);
        let branches = branches.zip(energies);
        Ok(CaseResult {
            storage_modulus_pa: moduli.map(|m| m.0),
            loss_modulus_pa: moduli.map(|m| m.1),
            approach_m: extrema(&samples.approach_m)?,
            contact_radius_m: not_negative(extrema(&samples.contact_radius_m)?),
            contact_duty,
            tabor_parameter: None,
            peak_pressure_pa: peaks.as_deref().and_then(Extrema::of).map(not_negative),
            errors: None,
            replica_losses_j: Vec::new(),
            branches: branches
                .map(|((branch, indenter_share), energy_loss_j)| BranchLoss {
                    retardation_time_s: branch.time_s,
                    energy_loss_j,
                    indenter_share: *indenter_share,
                })
                .collect(),
            analysis,
            cycle: RecordedCycle {
                samples,
                pressures,
                surface_loss,
            },
        })
    }
}

/// Extrema of what cannot be negative: where a contact opens or closes, a parabola through samples may go below zero.
fn not_negative(extrema: Extrema) -> Extrema {
    Extrema {
        minimum: extrema.minimum.max(0.0),
        ..extrema
    }
}

/// The surface's "pressure" is the density; beyond the contact there is nothing, and nothing is stored.
fn surface_loss(surface: Surface) -> SurfaceLoss {
    match surface {
        Surface::Radial(mut radial) => {
            let inside = radial.pressure_pa.iter().rposition(|d| *d != Some(0.0));
            let kept = inside.map_or(0, |last| last + 2);
            radial.radius_m.truncate(kept);
            radial.pressure_pa.truncate(kept);
            SurfaceLoss::Radial {
                radius_m: radial.radius_m,
                density_j_per_m2: radial.pressure_pa,
            }
        }
        Surface::Cells(cells) => {
            let grid = cells.grid;
            let (nx, ny) = (grid.cells_x(), grid.cells_y());
            let (mut x, mut y) = ((nx, 0), (ny, 0));
            for (cell, _) in cells
                .pressure_pa
                .iter()
                .enumerate()
                .filter(|(_, density)| **density != 0.0)
            {
                x = (x.0.min(cell % nx), x.1.max(cell % nx + 1));
                y = (y.0.min(cell / nx), y.1.max(cell / nx + 1));
            }
            let rows = (y.0..y.1).flat_map(|row| {
                let start = row * nx;
                &cells.pressure_pa[start + x.0..start + x.1]
            });
            SurfaceLoss::Cells(CellLoss {
                first_x_m: grid.x_m(x.0.min(nx - 1)),
                first_y_m: grid.y_m(y.0.min(ny - 1)),
                spacing_x_m: grid.spacing_x_m(),
                spacing_y_m: grid.spacing_y_m(),
                cells_x: x.1.saturating_sub(x.0),
                density_j_per_m2: rows.map(|density| *density as f32).collect(),
            })
        }
    }
}

/// Appends the present instant to a loop, with its peak pressure or without.
pub(crate) fn sample(
    march: &mut March<'_>,
    samples: &mut Loop,
    time_s: f64,
    with_peak: bool,
) -> Result<(), ContactError> {
    march.observe(&mut |engine, pressure, solution| {
        samples.time_s.push(time_s);
        samples.load_n.push(solution.load_n);
        samples.approach_m.push(solution.approach_m);
        samples.contact_radius_m.push(solution.contact_radius_m);
        samples.peak_pressure_pa.push(match with_peak {
            true => engine.peak_pressure_pa(pressure, solution)?,
            false => None,
        });
        Ok(())
    })
}
