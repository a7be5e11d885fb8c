//! What one case came to: the record that is stored, and from which tables and figures are made without solving again.

use serde::{Deserialize, Serialize};

use crate::cycle::{Extrema, Loop, LoopAnalysis};

/// How a case ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The stabilised cycle was reached within the tolerance.
    Converged,
    /// `max_cycles` passed before the cycle was stabilised: there is no result.
    NotConverged,
    /// An instant could not be solved: there is no result.
    Failed,
}

impl Status {
    /// The name used in every output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::NotConverged => "not-converged",
            Self::Failed => "failed",
        }
    }
}

/// One frequency's record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseRecord {
    /// Position in the sweep, from 0, in ascending frequency.
    pub index: usize,
    pub angular_frequency_rad_per_s: f64,
    pub status: Status,
    /// Why there is no result, or what else a reader should know.
    pub message: Option<String>,
    /// Cycles marched, the recorded one included.
    pub cycles: usize,
    /// Estimated distance of the last cycle to the stabilised one, relative to the largest pressure.
    pub steady_distance: Option<f64>,
    /// Half width of the computational domain (m) and how often it had to be enlarged.
    pub domain_half_width_m: f64,
    pub domain_enlarged: usize,
    /// Contact iterations over all instants.
    pub iterations: u64,
    /// Only for a converged case.
    pub result: Option<CaseResult>,
}

/// The stabilised cycle of one frequency.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseResult {
    pub analysis: LoopAnalysis,
    /// E' and E'' (Pa) that indentation reads from the loop; `None` where the contact radius vanishes.
    pub storage_modulus_pa: Option<f64>,
    pub loss_modulus_pa: Option<f64>,
    pub approach_m: Extrema,
    pub contact_radius_m: Extrema,
    /// `None` where the indenter's shape makes the pressure unbounded.
    pub peak_pressure_pa: Option<Extrema>,
    /// The cycle itself.
    pub samples: Loop,
}

impl CaseRecord {
    /// Energy loss per cycle (J) of a converged case.
    pub fn energy_loss_j(&self) -> Option<f64> {
        self.result.as_ref().map(|r| r.analysis.energy_loss_j)
    }

    /// Load frequency (Hz).
    pub fn frequency_hz(&self) -> f64 {
        self.angular_frequency_rad_per_s / std::f64::consts::TAU
    }
}
