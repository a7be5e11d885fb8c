//! One thing by three routes, exactly and by each engine; and scenarios computed by either, on the axisymmetric one with
//! shorter time steps because it can afford them.

use std::sync::atomic::AtomicBool;

use super::{ReproductionError, Result};
use crate::drive::{Segment, SegmentedDrive};
use crate::engine::EngineKind;
use crate::simulation::scenario::ScenarioPlan;
use crate::simulation::{Simulation, SimulationEnd, SimulationOutcome};

/// One thing exactly and by both engines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ByEngine<T> {
    /// In closed form; where there is none, by the axisymmetric engine at a finer resolution.
    pub exact: T,
    pub axisymmetric: T,
    pub half_space: T,
}

impl<T> ByEngine<T> {
    /// The exact one, and those of the axisymmetric and of the half-space engine.
    pub fn of(exact: T, [axisymmetric, half_space]: [T; 2]) -> Self {
        Self {
            exact,
            axisymmetric,
            half_space,
        }
    }

    /// The same of each.
    pub fn map<U>(self, mut to: impl FnMut(T) -> U) -> ByEngine<U> {
        ByEngine::of(to(self.exact), [self.axisymmetric, self.half_space].map(to))
    }

    /// Each beside that of another.
    pub fn zip<U>(self, other: ByEngine<U>) -> ByEngine<(T, U)> {
        let axisymmetric = (self.axisymmetric, other.axisymmetric);
        let half_space = (self.half_space, other.half_space);
        ByEngine::of((self.exact, other.exact), [axisymmetric, half_space])
    }

    pub fn as_ref(&self) -> ByEngine<&T> {
        ByEngine::of(&self.exact, [&self.axisymmetric, &self.half_space])
    }
}

impl<T, E> ByEngine<Result<T, E>> {
    /// All three, or the first error.
    pub fn all(self) -> Result<ByEngine<T>, E> {
        let exact = self.exact?;
        Ok(ByEngine::of(exact, [self.axisymmetric?, self.half_space?]))
    }
}

/// How a scenario is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum By {
    /// Springs, with time steps a tenth of those the scenario gives.
    Springs,
    /// Twice as many springs, and time steps half as long again.
    RefinedSprings,
    /// Cells, as the scenario gives them.
    Cells,
}

/// Runs a scenario to its end.
///
/// # Errors
/// [`ReproductionError`] where it cannot be set up, fails or is interrupted.
pub(super) fn simulate(
    scenario: &ScenarioPlan,
    by: By,
    interrupt: &AtomicBool,
) -> Result<SimulationOutcome> {
    let mut plan = scenario.clone();
    let (engine, springs, steps) = match by {
        By::Springs => (EngineKind::Axisymmetric, 1, 10.0),
        By::RefinedSprings => (EngineKind::Axisymmetric, 2, 20.0),
        By::Cells => (EngineKind::HalfSpace, 1, 1.0),
    };
    plan.solver.engine = engine;
    plan.solver.springs *= springs;
    plan.step_s = plan.step_s.map(|step_s| step_s / steps);
    run(plan, interrupt)
}

/// Runs a scenario by both engines: springs, then cells.
///
/// # Errors
/// As [`simulate`].
pub(super) fn both(
    scenario: &ScenarioPlan,
    interrupt: &AtomicBool,
) -> Result<[SimulationOutcome; 2]> {
    let by = |by| simulate(scenario, by, interrupt);
    Ok([by(By::Springs)?, by(By::Cells)?])
}

/// Runs a scenario as it stands, without error bars: the other engine and a refined run say more.
///
/// # Errors
/// As [`simulate`].
pub(super) fn run(mut plan: ScenarioPlan, interrupt: &AtomicBool) -> Result<SimulationOutcome> {
    plan.output.error_bars = false;
    let simulation = Simulation::new(plan)?;
    let outcome = simulation.run(interrupt, &|_, _| {});
    match &outcome.ended {
        SimulationEnd::Done => Ok(outcome),
        SimulationEnd::Interrupted => Err(ReproductionError::Interrupted),
        SimulationEnd::Failed(message) => Err(ReproductionError::Unfit(format!(
            "{}: {message}",
            simulation.plan().title
        ))),
    }
}

/// The scenario with another angular frequency (rad/s) in its sine, and for another number of cycles where one is given.
///
/// # Errors
/// [`ReproductionError::Drive`] where that is no history.
pub(super) fn at_frequency(
    scenario: &ScenarioPlan,
    omega: f64,
    number_of_cycles: Option<usize>,
) -> Result<ScenarioPlan> {
    let mut segments = scenario.drive.segments().to_vec();
    for segment in &mut segments {
        if let Segment::Sine {
            angular_frequency_rad_per_s,
            cycles,
            ..
        } = segment
        {
            *angular_frequency_rad_per_s = omega;
            *cycles = number_of_cycles.map_or(*cycles, |count| count as f64);
        }
    }
    Ok(ScenarioPlan {
        drive: SegmentedDrive::new(scenario.drive.control(), segments)?,
        ..scenario.clone()
    })
}
