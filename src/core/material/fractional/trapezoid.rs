//! A relaxation spectrum as branches: the trapezoidal rule over the logarithm of the relaxation time, and what is beyond its ends.

use super::MOST_NODES;
use crate::material::relaxation::RelaxationBranch;

/// Branches of a spectrum (Pa over ln theta) by the trapezoidal rule with nodes at this spacing, those outside of the ends (s) together
/// in one branch at the short end and two at the long one. `unseen` (Pa/s): modulus times frequency that does not show.
pub(super) fn trapezoidal(
    spectrum: impl Fn(f64) -> f64,
    spacing: f64,
    ends: (f64, f64),
    unseen: f64,
) -> Vec<RelaxationBranch> {
    let centre = 0.5 * (ends.0.ln() + ends.1.ln());
    let count = ((ends.1.ln() - centre) / spacing).floor();
    let node = |k: f64| {
        let log_time = centre + k * spacing;
        (spacing * spectrum(log_time), log_time)
    };
    let inside = (0..=(2.0 * count) as usize).map(|k| node(k as f64 - count));
    let mut branches: Vec<RelaxationBranch> = inside
        .filter(|(modulus_pa, _)| *modulus_pa > 0.0)
        .map(|(modulus_pa, log_time)| RelaxationBranch {
            modulus_pa,
            time_s: log_time.exp(),
        })
        .collect();
    // Shorter times act as E* = i omega m1 + omega^2 m2, which one branch has too.
    let fast = Tail::of(|k| node(-count - k), ends.0.ln(), 1.0);
    branches.extend(fast.branch(ends.0, |ratio| ratio));
    // Longer ones as E* = m0 - m1/(i omega) - m2/omega^2.
    let slow = Tail::of(|k| node(count + k), ends.1.ln(), -1.0);
    let branch = slow.branch(ends.1, f64::recip);
    let rest = slow.zeroth - branch.map_or(0.0, |branch| branch.modulus_pa);
    branches.extend(branch);
    // So slow that it is elastic in the band to a twentieth of the accuracy.
    let time_s = rest / unseen;
    if rest > 0.0 && time_s > ends.1 && time_s.is_finite() {
        branches.push(RelaxationBranch {
            modulus_pa: rest,
            time_s,
        });
    }
    branches.retain(|b| b.modulus_pa > 0.0 && b.time_s > 0.0 && b.time_s.is_finite());
    branches.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    branches
}

/// Sums over the nodes beyond an end: of their moduli, and these times the first and second power of time over end (or its reciprocal).
#[derive(Debug, Clone, Copy, Default)]
struct Tail {
    zeroth: f64,
    first: f64,
    second: f64,
}

impl Tail {
    /// Over `k = 1, 2, ...`, until nothing comes any more.
    fn of(node: impl Fn(f64) -> (f64, f64), log_end: f64, power: f64) -> Self {
        let mut sum = Self::default();
        for k in 1..MOST_NODES as usize {
            let (modulus, log_time) = node(k as f64);
            let ratio = (power * (log_time - log_end)).exp();
            // The zeroth of short times, which may have no limit, is not asked for.
            let compared = if power > 0.0 {
                modulus * ratio
            } else {
                modulus
            };
            let before = if power > 0.0 { sum.first } else { sum.zeroth };
            if compared <= 1e-12 * before || !modulus.is_finite() {
                break;
            }
            sum.zeroth += modulus;
            sum.first += modulus * ratio;
            sum.second += modulus * ratio * ratio;
        }
        sum
    }

    /// The branch of the same first and second sum.
    fn branch(&self, end_s: f64, power: impl Fn(f64) -> f64) -> Option<RelaxationBranch> {
        (self.second > 0.0).then(|| RelaxationBranch {
            modulus_pa: self.first * self.first / self.second,
            time_s: end_s * power(self.second / self.first),
        })
    }
}
