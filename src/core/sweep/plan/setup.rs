//! Why neither a sweep nor a history can be set up.

use crate::drive::{DriveError, ScheduleError};
use crate::engine::EngineError;
use crate::material::MaterialError;
use crate::sweep::plan::check::PlanError;

/// Why a sweep or a history cannot be set up.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SetupError {
    #[error(transparent)]
    Plan(#[from] PlanError),
    #[error(transparent)]
    Drive(#[from] DriveError),
    #[error(transparent)]
    Schedule(#[from] ScheduleError),
    #[error(transparent)]
    Material(#[from] MaterialError),
    #[error(
        "the material is a fluid: under a mean load it creeps without end, and no stabilised cycle exists; give it an \
         equilibrium modulus above zero"
    )]
    Fluid,
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

/// Refuses a direct sum that takes too long, or too much memory.
pub(crate) fn check_direct_sum(steps: usize, nodes: usize) -> Result<(), SetupError> {
    let bytes = steps.saturating_mul(nodes).saturating_mul(size_of::<f64>());
    match steps <= MAX_DIRECT_STEPS && bytes <= MAX_DIRECT_BYTES {
        true => Ok(()),
        false => Err(SetupError::DirectSum { steps, nodes }),
    }
}
