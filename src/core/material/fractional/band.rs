//! A model over a band of frequencies: how far a series is from it there, and branches joined as long as that is little.

use num_complex::Complex;

use super::Fractional;
use crate::material::relaxation::RelaxationBranch;

/// Frequencies per decade at which the error is looked for.
const PER_DECADE: f64 = 40.0;

/// The model over a band.
pub(super) struct Band {
    angular_frequencies: Vec<f64>,
    equilibrium_pa: f64,
    /// E*, equilibrium included.
    pub(super) exact: Vec<Complex<f64>>,
}

impl Band {
    pub(super) fn new(model: &Fractional, (low, high): (f64, f64)) -> Self {
        let logs = (low.ln(), high.ln());
        let decades = (logs.1 - logs.0) / std::f64::consts::LN_10;
        let count = (PER_DECADE * decades).ceil().clamp(8.0, 4000.0);
        let omega = |k: usize| (logs.0 + (logs.1 - logs.0) * k as f64 / count).exp();
        let angular_frequencies: Vec<f64> = (0..=count as usize).map(omega).collect();
        let values = angular_frequencies.iter();
        Self {
            exact: values.map(|omega| model.complex_modulus(*omega)).collect(),
            equilibrium_pa: model.equilibrium_pa,
            angular_frequencies,
        }
    }

    /// A branch at every frequency.
    fn branch(&self, branch: &RelaxationBranch) -> impl Iterator<Item = Complex<f64>> {
        let (modulus, time) = (branch.modulus_pa, branch.time_s);
        let omegas = self.angular_frequencies.iter();
        omegas.map(move |omega| {
            let x = Complex::new(0.0, omega * time);
            modulus * (1.0 - (1.0 + x).inv())
        })
    }

    pub(super) fn residuals(&self, branches: &[RelaxationBranch]) -> Vec<Complex<f64>> {
        let exact = self.exact.iter();
        let mut residuals: Vec<_> = exact.map(|value| self.equilibrium_pa - value).collect();
        for branch in branches {
            for (residual, value) in residuals.iter_mut().zip(self.branch(branch)) {
                *residual += value;
            }
        }
        residuals
    }

    /// Largest over the band of what is made of the relative differences of E*, E'' and D''.
    pub(super) fn largest(&self, residuals: &[Complex<f64>], of: fn([f64; 3]) -> f64) -> f64 {
        let differences = residuals.iter().zip(&self.exact).map(|(residual, exact)| {
            let series = exact + residual;
            let loss = residual.im / exact.im;
            // D'' = E''/|E*|^2.
            let compliance = (1.0 + loss) * (exact.norm_sqr() / series.norm_sqr()) - 1.0;
            let whole = residual.norm() / exact.norm();
            of([whole, loss.abs(), compliance.abs()])
        });
        differences.fold(0.0, f64::max)
    }

    pub(super) fn error(&self, residuals: &[Complex<f64>]) -> f64 {
        self.largest(residuals, |[whole, loss, compliance]| {
            whole.max(loss).max(compliance)
        })
    }

    /// Neighbours joined in one branch where the error allows it, passing over them until none are.
    pub(super) fn joined(
        &self,
        mut branches: Vec<RelaxationBranch>,
        mut residuals: Vec<Complex<f64>>,
        accuracy: f64,
    ) -> Vec<RelaxationBranch> {
        loop {
            let before = branches.len();
            let mut kept: Vec<RelaxationBranch> = Vec::with_capacity(before);
            // A branch is joined once in a pass, so that the error allowed is spent evenly.
            let mut is_new = false;
            for next in branches {
                let joined = kept.last().filter(|_| is_new).and_then(|last| {
                    let one = joint(last, &next);
                    let change = self.branch(&one).zip(self.branch(last));
                    let change = change.zip(self.branch(&next));
                    let changed = residuals.iter().zip(change);
                    let changed: Vec<_> = changed.map(|(r, ((j, a), b))| r + j - a - b).collect();
                    (self.error(&changed) < accuracy).then_some((one, changed))
                });
                match (joined, kept.last_mut()) {
                    (Some((one, changed)), Some(last)) => {
                        *last = one;
                        residuals = changed;
                        is_new = false;
                    }
                    _ => {
                        kept.push(next);
                        is_new = true;
                    }
                }
            }
            branches = kept;
            if branches.len() == before {
                return branches;
            }
        }
    }
}

/// Both moduli at the mean of the logarithms of the times.
fn joint(one: &RelaxationBranch, other: &RelaxationBranch) -> RelaxationBranch {
    let modulus_pa = one.modulus_pa + other.modulus_pa;
    let share = other.modulus_pa / modulus_pa;
    RelaxationBranch {
        modulus_pa,
        time_s: one.time_s * (other.time_s / one.time_s).powf(share),
    }
}
