//! What an instant on cells is given, and when it counts as solved: shared by the engines of this module.

use crate::contact::sums;

/// When the iteration stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverSettings {
    /// Largest allowed pressure-weighted mean |gap| inside the contact, and largest penetration outside, both relative to
    /// the pressure-weighted mean displacement that the instant's own pressure causes (or to a lower bound of it). Where that
    /// displacement is tiny beside what earlier pressures have left (a load about to vanish), rounding of the latter is allowed
    /// on top.
    pub tolerance: f64,
    /// Iterations after which an instant counts as not converged.
    pub max_iterations: usize,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: 2000,
        }
    }
}

/// What the drive imposes, in the engine's terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Imposed {
    /// Sum of the cells' pressures (Pa).
    PressureSum(f64),
    ApproachM(f64),
}

impl Imposed {
    pub(super) fn target_sum(self) -> Option<f64> {
        match self {
            Self::PressureSum(sum) => Some(sum),
            Self::ApproachM(_) => None,
        }
    }

    pub(super) fn approach_m(self) -> Option<f64> {
        match self {
            Self::PressureSum(_) => None,
            Self::ApproachM(approach_m) => Some(approach_m),
        }
    }
}

/// Rounding of a convolution and of the gaps made from it, as a part of the largest displacement: some units in the last
/// place.
pub(super) const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A cell under pressure may stand off by this many times what the tolerance allows on average, no more: a tiny pressure hardly
/// weighs in the average, wherever it is, but it says that there is contact. Cells at the edge settle last and are that far off.
pub(super) const STANDING_OFF: f64 = 30.0;

/// The starting pressure: the guess made non-negative and scaled to the load, or, without a guess, the load spread evenly
/// over the indenter.
pub(super) fn start(target_sum: Option<f64>, gap_m: &[f64], pressure: &mut [f64]) {
    for (p, gap) in pressure.iter_mut().zip(gap_m) {
        *p = if gap.is_finite() { p.max(0.0) } else { 0.0 };
    }
    let Some(target) = target_sum else { return };
    let sum = sums::sum(pressure);
    if sum > 0.0 {
        let scale = target / sum;
        pressure.iter_mut().for_each(|p| *p *= scale);
        return;
    }
    let count = gap_m.iter().filter(|g| g.is_finite()).count().max(1);
    let value = target / count as f64;
    for (p, gap) in pressure.iter_mut().zip(gap_m) {
        *p = if gap.is_finite() { value } else { 0.0 };
    }
}
