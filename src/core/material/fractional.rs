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

mod band;
mod trapezoid;

use std::f64::consts::{FRAC_PI_2, PI};

use num_complex::Complex;

use self::band::Band;
use self::trapezoid::trapezoidal;
use super::error::{MaterialError, non_negative, positive, refused};
use super::relaxation::{Relaxation, RelaxationBranch};
use super::{Compressibility, Material, ModulusKind, Origin, branches_in_words};

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
    "The {model} as a series of {}: from {:e} to {:e} rad/s its complex modulus is within {error:.1e} of the model's, and its loss modulus and loss compliance are within {loss_error:.1e} of those of the model",
    branches_in_words(*branches), band_rad_per_s.0, band_rad_per_s.1
)]
pub struct Approximation {
    /// The model.
    pub model: &'static str,
    /// Branches of the series.
    pub branches: usize,
    /// Lowest and highest angular frequency (rad/s).
    pub band_rad_per_s: (f64, f64),
    /// Largest relative difference of E* over the band, |dE*|/|E*|.
    pub error: f64,
    /// Largest relative difference of the loss modulus E'' and the loss compliance D'' over the band, |dE''|/E'' and |dD''|/D''.
    pub loss_error: f64,
}

/// A model as a series.
#[derive(Debug, Clone, PartialEq)]
pub struct Represented {
    pub relaxation: Relaxation,
    pub approximation: Approximation,
    /// A series that is a hundred times closer to the model, or at least ten times where that takes too many branches: what a result with
    /// it differs by is the error of the result that the series makes. `None` where the series is the model.
    pub closer: Option<Relaxation>,
}

impl Represented {
    /// The material of the series, whose moduli are of this kind: with the band as the times of its
    /// [window](Origin::measured_window_s), the quality of the series, and the closer series as its
    /// [alternative](Origin::alternatives).
    ///
    /// # Errors
    /// As [`Material::from_relaxation`].
    pub fn material(
        self,
        kind: ModulusKind,
        compressibility: impl Into<Compressibility>,
    ) -> Result<Material, MaterialError> {
        let compressibility = compressibility.into();
        let made = |series| Material::from_relaxation(series, kind, compressibility.clone());
        let closer = self.closer.map(made).transpose()?;
        let (low, high) = self.approximation.band_rad_per_s;
        let mut material = made(self.relaxation)?;
        material.origin = Origin {
            measured_window_s: Some((high.recip(), low.recip())),
            alternatives: closer.into_iter().collect(),
            approximation: Some(self.approximation),
            ..Origin::default()
        };
        Ok(material)
    }
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
/// By how much closer the series is that tells the error of another, the first that can be had, and its most branches, as many as a file
/// may hold: it is solved on coarse levels alone.
const CLOSER: [f64; 3] = [0.01, 0.03, 0.1];
const MOST_BRANCHES_OF_CLOSER: usize = 1000;
/// By which factor the model is followed beyond either end of the band: a cycle of a growing contact has harmonics.
const BEYOND_BAND: f64 = 3.0;
/// Most nodes of the trapezoidal rule: reached where an exponent is so near to one that the classical model is meant.
const MOST_NODES: f64 = 4000.0;
/// Widest spacing tried, of ln theta: the error of the kernel's strip of pi/2 is then 2 exp(-pi^2/h), 0.2 %.
const WIDEST_SPACING: f64 = 1.6;
/// Factor from one spacing to the next.
const FINER: f64 = 0.85;

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

    /// A spring beside a springpot: the fractional model of Kelvin and Voigt.
    ///
    /// # Errors
    /// A modulus or time that is not positive (the equilibrium modulus: negative); an exponent outside `0 < alpha < 1`.
    pub fn kelvin_voigt(
        equilibrium_pa: f64,
        stiffness_pa: f64,
        time_s: f64,
        exponent: f64,
    ) -> Result<Self, MaterialError> {
        Ok(Self {
            name: "fractional Kelvin-Voigt model",
            equilibrium_pa: non_negative("equilibrium modulus (Pa)", equilibrium_pa)?,
            ..Self::springpot(stiffness_pa, time_s, exponent)?
        })
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

    /// A Prony series with positive moduli whose E* is within `accuracy` of the model's over a band (rad/s), and three times beyond
    /// either end; its loss modulus and loss compliance too. All relative, each part to itself: a loss goes with the imaginary parts,
    /// which may be a thousandth of the whole.
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
        let beyond = (low / BEYOND_BAND, high * BEYOND_BAND);
        let whole_band = Band::new(self, beyond);
        let series = |accuracy: f64, most: usize| {
            let branches = match self.is_classical() {
                true => Some(vec![RelaxationBranch {
                    modulus_pa: self.stiffness_pa,
                    time_s: self.time_s,
                }]),
                false => self.branches(&whole_band, beyond, accuracy),
            };
            let too_many = FractionalError::TooManyBranches {
                model: self.name,
                most: MOST_BRANCHES,
                accuracy,
            };
            let branches = branches.filter(|branches| branches.len() <= most);
            Ok::<_, FractionalError>(Relaxation::new(
                self.equilibrium_pa,
                branches.ok_or(too_many)?,
            )?)
        };
        let relaxation = series(accuracy, MOST_BRANCHES)?;
        let closer = match self.is_classical() {
            true => None,
            // A spectrum that is all but one line takes more nodes than there are for the closest.
            false => {
                let closer = |factor: &f64| series(factor * accuracy, MOST_BRANCHES_OF_CLOSER);
                let found = CLOSER.iter().find_map(|factor| closer(factor).ok());
                Some(found.map_or_else(|| closer(&CLOSER[2]), Ok)?)
            }
        };
        let within = Band::new(self, band_rad_per_s);
        let residuals = within.residuals(relaxation.branches());
        let approximation = Approximation {
            model: self.name,
            branches: relaxation.branches().len(),
            band_rad_per_s,
            error: within.largest(&residuals, |[whole, ..]| whole),
            loss_error: within.largest(&residuals, |[_, modulus, compliance]| {
                modulus.max(compliance)
            }),
        };
        Ok(Represented {
            relaxation,
            approximation,
            closer,
        })
    }

    /// A series for responses from the shortest to the longest time (s), to a few parts in ten thousand of E*, at once: the trapezoidal
    /// rule at a fixed spacing. What relaxes later than that stands in a slow branch, which is a spring there.
    ///
    /// # Errors
    /// A sum that overflows.
    pub fn within(&self, (shortest_s, longest_s): (f64, f64)) -> Result<Relaxation, MaterialError> {
        let branches = match self.is_classical() {
            true => vec![RelaxationBranch {
                modulus_pa: self.stiffness_pa,
                time_s: self.time_s,
            }],
            false => {
                let (ends, spring) = ((shortest_s / 8.0, longest_s * 8.0), 1e6 * longest_s);
                let size = self.complex_modulus(1.0 / longest_s).norm();
                trapezoidal(|log| self.spectrum(log), 1.0, ends, size / spring)
            }
        };
        Relaxation::new(self.equilibrium_pa, branches)
    }

    /// The coarsest rule of half the error allowed, neighbours then joined as long as the error is kept. `None` where too many
    /// nodes are needed.
    fn branches(
        &self,
        band: &Band,
        (low, high): (f64, f64),
        accuracy: f64,
    ) -> Option<Vec<RelaxationBranch>> {
        // Its loss modulus, which falls with the frequency, is a twentieth of the error allowed at the lowest.
        let slowest = 0.05 * accuracy * band.exact.first()?.im;
        // What is beyond the ends is represented but for the third power of omega theta, or of its reciprocal. The spectrum falls
        // towards long times; towards short ones it may rise, by no more than the first power. Farther out where that is not enough.
        [1.0, 0.1].into_iter().find_map(|part| {
            let [shorter, longer] = [2.0, 3.0].map(|power| (-(part * accuracy).ln() / power).exp());
            let ends = (1.0 / (high * shorter), longer / low);
            let mut spacing = WIDEST_SPACING;
            while (ends.1 / ends.0).ln() < MOST_NODES * spacing {
                let branches = trapezoidal(|log| self.spectrum(log), spacing, ends, slowest * low);
                let residuals = band.residuals(&branches);
                if band.error(&residuals) < 0.5 * accuracy {
                    return Some(band.joined(branches, residuals, accuracy));
                }
                spacing *= FINER;
            }
            None
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::classical;
    use crate::material::synthetic::Noise;

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

    /// A random model, its band and accuracy.
    fn random_model(seed: u64) -> (Fractional, (f64, f64), f64) {
        let mut random = Noise(seed);
        let exponent = 0.05 + 0.9 * random.uniform();
        let (stiffness_pa, time_s) = (1e9, random.log_uniform(1e-3, 1e3));
        let equilibrium_pa = stiffness_pa / random.log_uniform(0.1, 1e4);
        let second = exponent * random.uniform();
        let model = match seed % 3 {
            0 => Fractional::zener(equilibrium_pa, stiffness_pa, time_s, exponent),
            1 => Fractional::maxwell(stiffness_pa, time_s, exponent, second),
            _ => Fractional::springpot(stiffness_pa, time_s, exponent),
        };
        let decades = 2.0 + 8.0 * random.uniform();
        let low = 10_f64.powf(-decades * random.uniform()) / time_s;
        let band = (low, low * 10_f64.powf(decades));
        (model.unwrap(), band, random.log_uniform(1e-6, 1e-2))
    }

    /// `FRACTIONAL_CASES=300 cargo test --lib fractional -- --nocapture` tries and prints as many as asked for.
    #[test]
    fn both_parts_of_random_models_are_within_the_accuracy_all_over_the_band() {
        let cases = std::env::var("FRACTIONAL_CASES").map_or(12, |text| text.parse().unwrap());
        for seed in 0..cases {
            let (model, band, accuracy) = random_model(seed);
            let start = std::time::Instant::now();
            let made = model.represent(band, accuracy).unwrap();
            let seconds = start.elapsed().as_secs_f64();
            let closer = made.closer.unwrap();
            // Powers of complex numbers know a phase to their rounding, and from it a small loss.
            let (mut largest, mut missed) = (0.0_f64, 0.0_f64);
            for k in 0..=101 {
                let omega = band.0 * (band.1 / band.0).powf(f64::from(k) / 101.0);
                let exact = model.complex_modulus(omega);
                let loss = |modulus: Complex<f64>| [modulus.im, -modulus.inv().im];
                let [own, close] =
                    [&made.relaxation, &closer].map(|series| loss(series.complex_modulus(omega)));
                for (part, exact) in loss(exact).into_iter().enumerate() {
                    largest = largest.max((own[part] / exact - 1.0).abs());
                    // What the closer series tells of the error, and what it does not.
                    missed = missed.max((close[part] / exact - 1.0).abs());
                }
                let whole = made.relaxation.complex_modulus(omega) - exact;
                assert!(whole.norm() < accuracy * exact.norm(), "{seed}: {omega}");
            }
            println!(
                "{seed}: {model:?} {:.1} decades, {accuracy:.0e}: {} branches, closer {}; {largest:.1e}, {missed:.1e}; {seconds:.3} s",
                (band.1 / band.0).log10(),
                made.relaxation.branches().len(),
                closer.branches().len()
            );
            assert!(largest < accuracy, "{seed}: {largest:e}");
            assert!(missed < 0.012 * accuracy, "{seed}: {missed:e}");
            // Forty frequencies a decade find the largest error to a few percent.
            assert!((made.approximation.loss_error / largest - 1.0).abs() < 0.15);
        }
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
        assert_eq!(made.relaxation, classical::maxwell(1e6, 2.0).unwrap());
        // The springs of the classical solid in series: 1/(1/4e6), and the Kelvin unit that leaves 1e6 at rest.
        let solid = classical::zener(4e6, 4e6 / 3.0, 8.0).unwrap();
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
