//! A sweep as it will be run: every default filled in, every value checked.

use std::sync::Arc;

use crate::drive::HarmonicDrive;
use crate::history::TimeRule;
use crate::indenter::Indenter;
use crate::material::Material;

/// Everything a sweep needs to know. Two equal plans give equal results, bit for bit.
#[derive(Debug, Clone)]
pub struct SweepPlan {
    pub title: String,
    pub material: Material,
    pub indenter: Arc<dyn Indenter>,
    pub drive: HarmonicDrive,
    /// Ascending, in rad/s.
    pub angular_frequencies_rad_per_s: Vec<f64>,
    pub cycle: CyclePlan,
    pub solver: SolverPlan,
}

/// How a cycle is resolved and when it counts as stabilised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclePlan {
    /// Time steps per cycle.
    pub steps: usize,
    /// Largest allowed estimated distance to the stabilised cycle, relative to the largest pressure.
    pub tolerance: f64,
    /// Cycles after which a frequency counts as not converged.
    pub max_cycles: usize,
}

/// Which engine, and how fine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverPlan {
    pub engine: EngineKind,
    pub time_rule: TimeRule,
    /// Axisymmetric engine: springs over the domain.
    pub springs: usize,
    /// Half-space engine: cells along the longer side of the domain; an indenter that is a map brings its own.
    pub cells: usize,
    /// Half-space engine: tolerance of one instant, see [`crate::contact::half_space::SolverSettings`].
    pub tolerance: f64,
}

/// The two contact engines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EngineKind {
    Axisymmetric,
    HalfSpace,
}

impl EngineKind {
    /// The name as written in a sweep file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Axisymmetric => "axisymmetric",
            Self::HalfSpace => "half-space",
        }
    }

    /// Whether the engine knows the surface as a field, not just along a radius.
    pub fn has_fields(self) -> bool {
        self == Self::HalfSpace
    }
}

impl Default for CyclePlan {
    fn default() -> Self {
        Self {
            steps: 200,
            tolerance: 1e-4,
            max_cycles: 1000,
        }
    }
}

impl Default for SolverPlan {
    fn default() -> Self {
        Self {
            engine: EngineKind::Axisymmetric,
            time_rule: TimeRule::Linear,
            springs: 400,
            cells: 128,
            // Tight enough that rounding, which leads the solver another way in other units, stays below 1e-9.
            tolerance: 1e-10,
        }
    }
}
