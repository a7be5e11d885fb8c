//! Fractional models: springpot, fractional Zener, fractional Maxwell, and their representation by a Prony series over a band.
//!
//! A springpot has `E* = E (i omega tau)^alpha`, between a spring (`alpha = 0`) and a dashpot (`alpha = 1`). Two in series are the
//! fractional Maxwell model, a spring beside a spring and a springpot in series the fractional Zener model:
//!
//! ```text
//! springpot  E* = E (i omega tau)^alpha                                             0 < alpha < 1
//! Zener      E* = E_inf + E_1 (i omega tau)^alpha / (1 + (i omega tau)^alpha)       0 < alpha <= 1
//! Maxwell    E* = E (i omega tau)^alpha / (1 + (i omega tau)^(alpha - beta))        0 <= beta < alpha <= 1
//! ```
//!
//! H. Schiessel, R. Metzler, A. Blumen, T. F. Nonnenmacher, "Generalized viscoelastic models: their fractional equations with
//! solutions", J. Phys. A 28 (1995) 6567; A. Jaishankar, G. H. McKinley, "Power-law rheology in the bulk and at the interface",
//! Proc. R. Soc. A 469 (2013) 20120284, whose quasi-properties are `V = E tau^alpha` and `G = E tau^beta`; F. Mainardi,
//! *Fractional Calculus and Waves in Linear Viscoelasticity*, Imperial College Press 2010, chapter 3.
//!
//! With `alpha = 1` (and `beta = 0`) they are the classical models. Else their relaxation spectrum is the imaginary part of E* on
//! the negative axis, `H(theta) = Im E*(s = exp(i pi)/theta) / pi`, nowhere negative, and E* is the integral of
//! `H(theta) i omega theta/(1 + i omega theta)` over `ln theta`. The trapezoidal rule makes a Prony series of it, and its error falls
//! exponentially with the spacing, because the integrand is analytic in a strip (L. N. Trefethen, J. A. C. Weideman, SIAM Review 56
//! (2014) 385).

use std::f64::consts::{FRAC_PI_2, PI};

use num_complex::Complex;

use super::error::{MaterialError, non_negative, positive, refused};
use super::relaxation::{Relaxation, RelaxationBranch};

/// A fractional model: `E_inf + E (i omega tau)^a / (1 + (i omega tau)^c)`, the springpot without denominator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fractional {
    name: &'static str,
    equilibrium_pa: f64,
    stiffness_pa: f64,
    time_s: f64,
    exponent: f64,
    /// Exponent of the denominator.
    denominator: Option<f64>,
}

/// How well a series stands for a model.
#[derive(Debug, Clone, PartialEq, serde::Serialize, thiserror::Error)]
#[error(
    "The {model} as a series of {branches} branches: its complex modulus is within {error:.1e} of the model's from {:e} to {:e} rad/s",
    band_rad_per_s.0, band_rad_per_s.1
)]
pub struct Approximation {
    /// The model.
    pub model: &'static str,
    /// Branches of the series.
    pub branches: usize,
    /// Lowest and highest angular frequency (rad/s).
    pub band_rad_per_s: (f64, f64),
    /// Largest relative difference of E* over the band.
    pub error: f64,
}

/// A model as a series.
#[derive(Debug, Clone, PartialEq)]
pub struct Represented {
    pub relaxation: Relaxation,
    pub approximation: Approximation,
}

/// Why a model is not represented.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FractionalError {
    #[error(transparent)]
    Material(#[from] MaterialError),
    #[error("the band from {low:e} to {high:e} rad/s is empty")]
    Band { low: f64, high: f64 },
    #[error("the accuracy {0:e} is not between 1e-8 and 0.1")]
    Accuracy(f64),
    #[error(
        "a series of {most} branches, the most that are taken, does not represent the {model} to {accuracy:e} over this band"
    )]
    TooManyBranches {
        model: &'static str,
        most: usize,
        accuracy: f64,
    },
}

/// Most branches of a series; every one costs time in every step of a computation.
pub const MOST_BRANCHES: usize = 200;
/// Accuracies that are asked for.
pub const ACCURACY: (f64, f64) = (1e-8, 0.1);
/// Most nodes of the trapezoidal rule: reached where an exponent is so near to one that the classical model is meant.
const MOST_NODES: f64 = 4000.0;
/// Widest spacing tried, of ln theta: the error of the kernel's strip of pi/2 is then 2 exp(-pi^2/h), 0.2 %.
const WIDEST_SPACING: f64 = 1.6;
/// Factor from one spacing to the next.
const FINER: f64 = 0.85;
/// Frequencies per decade at which the error is looked for.
const PER_DECADE: f64 = 40.0;

impl Fractional {
    /// A springpot of modulus E (Pa) at `omega tau = 1`, time tau (s) and exponent alpha.
    ///
    /// # Errors
    /// A modulus or time that is not positive; an exponent outside `0 < alpha < 1`.
    pub fn springpot(stiffness_pa: f64, time_s: f64, exponent: f64) -> Result<Self, MaterialError> {
        let requirement = "between 0, a spring, and 1, a dashpot, and neither of them";
        if exponent >= 1.0 {
            return Err(refused("exponent of the springpot", exponent, requirement));
        }
        Self::new("springpot", 0.0, (stiffness_pa, time_s), exponent, None)
    }

    /// The fractional Zener model with the equilibrium modulus `E_inf`, the modulus `E_1` that relaxes (Pa), time tau (s), exponent.
    ///
    /// # Errors
    /// A modulus or time that is not positive (the equilibrium modulus: negative); an exponent outside `0 < alpha <= 1`.
    pub fn zener(
        equilibrium_pa: f64,
        stiffness_pa: f64,
        time_s: f64,
        exponent: f64,
    ) -> Result<Self, MaterialError> {
        let equilibrium_pa = non_negative("equilibrium modulus (Pa)", equilibrium_pa)?;
        let of = (stiffness_pa, time_s);
        Self::new(
            "fractional Zener model",
            equilibrium_pa,
            of,
            exponent,
            Some(exponent),
        )
    }

    /// Two springpots in series, of exponents alpha (that of low frequencies) and beta; a spring and a springpot where beta is zero.
    ///
    /// # Errors
    /// A modulus or time that is not positive; exponents that are not `0 <= beta < alpha <= 1`.
    pub fn maxwell(
        stiffness_pa: f64,
        time_s: f64,
        exponent: f64,
        second_exponent: f64,
    ) -> Result<Self, MaterialError> {
        if !(0.0..exponent).contains(&second_exponent) {
            let requirement = "zero or positive, and below the other exponent";
            return Err(refused("second exponent", second_exponent, requirement));
        }
        let denominator = Some(exponent - second_exponent);
        let of = (stiffness_pa, time_s);
        Self::new("fractional Maxwell model", 0.0, of, exponent, denominator)
    }

    fn new(
        name: &'static str,
        equilibrium_pa: f64,
        (stiffness_pa, time_s): (f64, f64),
        exponent: f64,
        denominator: Option<f64>,
    ) -> Result<Self, MaterialError> {
        if !(exponent > 0.0 && exponent <= 1.0) {
            return Err(refused("exponent", exponent, "above 0 and at most 1"));
        }
        Ok(Self {
            name,
            equilibrium_pa,
            stiffness_pa: positive("stiffness of the fractional model (Pa)", stiffness_pa)?,
            time_s: positive("time of the fractional model (s)", time_s)?,
            exponent,
            denominator,
        })
    }

    /// Complex modulus (Pa) in closed form.
    pub fn complex_modulus(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        let log = angular_frequency_rad_per_s.ln() + self.time_s.ln();
        self.equilibrium_pa + self.element(log, FRAC_PI_2)
    }

    /// The fractional element at `s tau = exp(log + i angle)`.
    fn element(&self, log: f64, angle: f64) -> Complex<f64> {
        let power = |exponent: f64| Complex::from_polar((exponent * log).exp(), exponent * angle);
        let fraction = match self.denominator {
            None => power(self.exponent),
            // Divided by its larger part, so that nothing overflows.
            Some(c) if log > 0.0 => power(self.exponent - c) / (1.0 + power(-c)),
            Some(c) => power(self.exponent) / (1.0 + power(c)),
        };
        fraction * self.stiffness_pa
    }

    /// Relaxation spectrum H (Pa) over `ln theta`.
    fn spectrum(&self, log_time: f64) -> f64 {
        let log = self.time_s.ln() - log_time;
        // What rounding leaves of the sine of pi is none.
        (self.element(log, PI).im / PI).max(0.0)
    }

    /// A single branch.
    fn is_classical(&self) -> bool {
        self.exponent == 1.0 && self.denominator == Some(1.0)
    }

    /// A Prony series with positive moduli whose E* is within `accuracy` of the model's over a band (rad/s), relative.
    ///
    /// The equilibrium modulus is that of the model, which is zero for springpot and Maxwell: what relaxes too slowly to show in the
    /// band stands in a branch beyond it, and not in a modulus at rest that the model does not have.
    ///
    /// # Errors
    /// [`FractionalError`].
    pub fn represent(
        &self,
        band_rad_per_s: (f64, f64),
        accuracy: f64,
    ) -> Result<Represented, FractionalError> {
        let (low, high) = band_rad_per_s;
        if !(low > 0.0 && high > low && (high / low).is_finite()) {
            return Err(FractionalError::Band { low, high });
        }
        if !(ACCURACY.0..=ACCURACY.1).contains(&accuracy) {
            return Err(FractionalError::Accuracy(accuracy));
        }
        let goal = Goal::new(self, band_rad_per_s);
        let branches = match self.is_classical() {
            true => Some(vec![RelaxationBranch {
                modulus_pa: self.stiffness_pa,
                time_s: self.time_s,
            }]),
            false => self.branches(&goal, band_rad_per_s, accuracy),
        };
        let too_many = FractionalError::TooManyBranches {
            model: self.name,
            most: MOST_BRANCHES,
            accuracy,
        };
        let branches = branches.filter(|branches| branches.len() <= MOST_BRANCHES);
        let branches = branches.ok_or(too_many)?;
        let relaxation = Relaxation::new(self.equilibrium_pa, branches)?;
        let approximation = Approximation {
            model: self.name,
            branches: relaxation.branches().len(),
            band_rad_per_s,
            error: goal.error(&goal.residuals(relaxation.branches())),
        };
        Ok(Represented {
            relaxation,
            approximation,
        })
    }

    /// The coarsest rule of half the error allowed, neighbours then joined as long as the error is kept. `None` where too many
    /// nodes are needed.
    fn branches(
        &self,
        goal: &Goal,
        (low, high): (f64, f64),
        accuracy: f64,
    ) -> Option<Vec<RelaxationBranch>> {
        // What is beyond the ends is represented to the third order of omega theta.
        let beyond = (-accuracy.ln() / 3.0).exp();
        let ends = (1.0 / (high * beyond), beyond / low);
        let slowest = 0.05 * accuracy * goal.magnitudes.first()?;
        let mut spacing = WIDEST_SPACING;
        while (ends.1 / ends.0).ln() < MOST_NODES * spacing {
            let branches = self.trapezoidal(spacing, ends, slowest * low);
            let residuals = goal.residuals(&branches);
            if goal.error(&residuals) < 0.5 * accuracy {
                return Some(goal.joined(branches, residuals, accuracy));
            }
            spacing *= FINER;
        }
        None
    }

    /// The trapezoidal rule with nodes at this spacing of ln theta, those outside of the ends (s) together in one branch at the
    /// short end and two at the long one. `unseen` (Pa/s): modulus times frequency that does
    /// not show.
    fn trapezoidal(&self, spacing: f64, ends: (f64, f64), unseen: f64) -> Vec<RelaxationBranch> {
        let centre = 0.5 * (ends.0.ln() + ends.1.ln());
        let count = ((ends.1.ln() - centre) / spacing).floor();
        let node = |k: f64| {
            let log_time = centre + k * spacing;
            (spacing * self.spectrum(log_time), log_time)
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

/// The model over the band.
struct Goal {
    angular_frequencies: Vec<f64>,
    exact: Vec<Complex<f64>>,
    /// |E*|, equilibrium included.
    magnitudes: Vec<f64>,
}

impl Goal {
    fn new(model: &Fractional, (low, high): (f64, f64)) -> Self {
        let logs = (low.ln(), high.ln());
        let decades = (logs.1 - logs.0) / std::f64::consts::LN_10;
        let count = (PER_DECADE * decades).ceil().clamp(8.0, 4000.0);
        let omega = |k: usize| (logs.0 + (logs.1 - logs.0) * k as f64 / count).exp();
        let angular_frequencies: Vec<f64> = (0..=count as usize).map(omega).collect();
        let values = angular_frequencies.iter();
        let exact: Vec<_> = values.map(|omega| model.complex_modulus(*omega)).collect();
        Self {
            magnitudes: exact.iter().map(|value| value.norm()).collect(),
            exact: exact.iter().map(|e| e - model.equilibrium_pa).collect(),
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

    fn residuals(&self, branches: &[RelaxationBranch]) -> Vec<Complex<f64>> {
        let mut residuals: Vec<_> = self.exact.iter().map(|value| -value).collect();
        for branch in branches {
            for (residual, value) in residuals.iter_mut().zip(self.branch(branch)) {
                *residual += value;
            }
        }
        residuals
    }

    fn error(&self, residuals: &[Complex<f64>]) -> f64 {
        let relative = residuals.iter().zip(&self.magnitudes);
        relative.map(|(r, e)| r.norm() / e).fold(0.0, f64::max)
    }

    /// Neighbours joined in one branch where the error allows it, passing over them until none are.
    fn joined(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::classical;

    const BAND: (f64, f64) = (1e-3, 1e5);

    /// Largest relative difference over the band at frequencies of its own.
    fn difference(relaxation: &Relaxation, exact: impl Fn(f64) -> Complex<f64>) -> f64 {
        let count = 777;
        let differences = (0..=count).map(|k| {
            let part = f64::from(k) / f64::from(count);
            let omega = BAND.0 * (BAND.1 / BAND.0).powf(part);
            let exact = exact(omega);
            (relaxation.complex_modulus(omega) - exact).norm() / exact.norm()
        });
        differences.fold(0.0, f64::max)
    }

    /// The formulas of the literature, with powers of complex numbers.
    fn power(omega: f64, time: f64, exponent: f64) -> Complex<f64> {
        Complex::new(0.0, omega * time).powf(exponent)
    }

    #[test]
    fn a_springpot_is_a_power_law_over_its_band() {
        for (exponent, accuracy) in [(0.05, 1e-3), (0.3, 1e-3), (0.5, 1e-5), (0.9, 1e-3)] {
            let model = Fractional::springpot(2e6, 0.1, exponent).unwrap();
            let made = model.represent(BAND, accuracy).unwrap();
            let error = difference(&made.relaxation, |omega| 2e6 * power(omega, 0.1, exponent));
            assert!(error < accuracy, "{exponent}: {error:e}");
            // Forty frequencies a decade find the largest error to a few percent.
            assert!((made.approximation.error / error - 1.0).abs() < 0.1);
            assert!(made.relaxation.is_fluid());
        }
    }

    #[test]
    fn the_fractional_zener_model_keeps_its_equilibrium() {
        for exponent in [0.1, 0.4, 0.7, 0.95, 0.99] {
            for time in [1e-9, 1.0, 1e6] {
                let model = Fractional::zener(1e6, 1e9, time, exponent).unwrap();
                let made = model.represent(BAND, 1e-3).unwrap();
                let error = difference(&made.relaxation, |omega| {
                    let x = power(omega, time, exponent);
                    1e6 + 1e9 * x / (1.0 + x)
                });
                assert!(error < 1e-3, "{exponent}, {time}: {error:e}");
                assert_eq!(made.relaxation.equilibrium_modulus(), 1e6);
            }
        }
    }

    #[test]
    fn the_fractional_maxwell_model_has_two_slopes() {
        for (alpha, beta) in [(0.8, 0.2), (0.5, 0.0), (1.0, 0.3), (0.6, 0.55)] {
            let model = Fractional::maxwell(1e6, 0.3, alpha, beta).unwrap();
            let made = model.represent(BAND, 1e-4).unwrap();
            let error = difference(&made.relaxation, |omega| {
                // Jaishankar and McKinley (2013), equation (2.9): V G (i omega)^(alpha + beta) over the sum.
                let v = 1e6 * power(omega, 0.3, alpha);
                let g = 1e6 * power(omega, 0.3, beta);
                v * g / (v + g)
            });
            assert!(error < 1e-4, "{alpha}, {beta}: {error:e}");
        }
    }

    #[test]
    fn with_exponent_one_they_are_the_classical_models() {
        let zener = Fractional::zener(1e6, 3e6, 2.0, 1.0).unwrap();
        let made = zener.represent(BAND, 1e-8).unwrap();
        let branch = RelaxationBranch {
            modulus_pa: 3e6,
            time_s: 2.0,
        };
        assert_eq!(made.relaxation, Relaxation::new(1e6, vec![branch]).unwrap());
        // A few roundings.
        assert!(made.approximation.error < 1e-14);
        let maxwell = Fractional::maxwell(1e6, 2.0, 1.0, 0.0).unwrap();
        let made = maxwell.represent(BAND, 1e-8).unwrap();
        let classical = classical::Maxwell::new(1e6, 2.0).unwrap();
        assert_eq!(made.relaxation, classical.relaxation().unwrap());
        // The springs of the classical solid in series: 1/(1/4e6), and the Kelvin unit that leaves 1e6 at rest.
        let solid = classical::Zener::new(4e6, 4e6 / 3.0, 8.0).unwrap();
        let solid = solid.relaxation().unwrap();
        for exponent in [-3, 0, 2] {
            let omega = 10_f64.powi(exponent);
            let ratio = zener.complex_modulus(omega) / solid.complex_modulus(omega);
            assert!((ratio - 1.0).norm() < 1e-14, "{ratio}");
        }
    }

    #[test]
    fn a_looser_accuracy_or_a_narrower_band_takes_fewer_branches() {
        let model = Fractional::zener(1e6, 1e9, 1.0, 0.5).unwrap();
        let count = |band, accuracy| {
            let made: Represented = model.represent(band, accuracy).unwrap();
            made.relaxation.branches().len()
        };
        let all = [1e-2, 1e-3, 1e-5, 1e-8].map(|accuracy| count(BAND, accuracy));
        assert!(all.is_sorted(), "{all:?}");
        // Eight decades and the margins, at no more than three branches a decade.
        assert!(all[1] <= 3 * 8 + 6, "{all:?}");
        assert!(count((0.1, 10.0), 1e-3) < count(BAND, 1e-3));
    }

    #[test]
    fn what_is_no_model_or_no_band_is_refused() {
        for exponent in [0.0, -0.1, 1.0, f64::NAN] {
            assert!(Fractional::springpot(1e6, 1.0, exponent).is_err());
        }
        for (alpha, beta) in [
            (0.5, 0.5),
            (0.5, -0.1),
            (0.5, 0.6),
            (1.1, 0.0),
            (0.5, f64::NAN),
        ] {
            assert!(Fractional::maxwell(1e6, 1.0, alpha, beta).is_err());
        }
        assert!(Fractional::zener(-1.0, 1e6, 1.0, 0.5).is_err());
        assert!(Fractional::zener(0.0, 0.0, 1.0, 0.5).is_err());
        let model = Fractional::springpot(1e6, 1.0, 0.5).unwrap();
        for band in [
            (1.0, 1.0),
            (2.0, 1.0),
            (0.0, 1.0),
            (1e-300, 1e300),
            (f64::NAN, 1.0),
        ] {
            let refused = model.represent(band, 1e-3).unwrap_err();
            assert!(matches!(refused, FractionalError::Band { .. }), "{band:?}");
        }
        for accuracy in [0.0, 1e-9, 0.2, f64::NAN] {
            assert!(model.represent(BAND, accuracy).is_err());
        }
        let wide = model.represent((1e-150, 1e150), 1e-3).unwrap_err();
        assert!(wide.to_string().contains("200 branches"), "{wide}");
        let sharp = Fractional::zener(1e6, 1e9, 1.0, 0.999_999).unwrap();
        assert!(sharp.represent(BAND, 1e-3).is_err());
    }
}
