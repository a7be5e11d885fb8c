//! One scenario by either engine, the axisymmetric one with shorter time steps because it can afford them.

use std::sync::atomic::AtomicBool;

use super::ReproductionError;
use crate::sweep::history::{Simulation, SimulationEnd, SimulationOutcome};
use crate::sweep::plan::EngineKind;
use crate::sweep::plan::scenario::ScenarioPlan;

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

/// A scenario as it is computed so.
pub(super) fn plan(plan: &ScenarioPlan, by: By) -> ScenarioPlan {
    let mut plan = plan.clone();
    // The other engine and a refined run say more.
    plan.output.error_bars = false;
    let shorter = |step_s: Option<f64>, factor: f64| step_s.map(|step_s| step_s / factor);
    match by {
        By::Springs => {
            plan.solver.engine = EngineKind::Axisymmetric;
            plan.step_s = shorter(plan.step_s, 10.0);
        }
        By::RefinedSprings => {
            plan.solver.engine = EngineKind::Axisymmetric;
            plan.solver.springs *= 2;
            plan.step_s = shorter(plan.step_s, 20.0);
        }
        By::Cells => plan.solver.engine = EngineKind::HalfSpace,
    }
    plan
}

/// Runs a scenario to its end.
///
/// # Errors
/// [`ReproductionError`] where it cannot be set up, fails or is interrupted.
pub(super) fn simulate(
    scenario: &ScenarioPlan,
    by: By,
    interrupt: &AtomicBool,
) -> Result<SimulationOutcome, ReproductionError> {
    let simulation = Simulation::new(plan(scenario, by))?;
    run(&simulation, interrupt)
}

/// The same of a simulation at hand.
pub(super) fn run(
    simulation: &Simulation,
    interrupt: &AtomicBool,
) -> Result<SimulationOutcome, ReproductionError> {
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

/// Side of a cell of the half-space engine (m).
pub(super) fn cell_m(outcome: &SimulationOutcome, cells: usize) -> f64 {
    2.0 * outcome.domain_half_width_m / cells as f64
}
