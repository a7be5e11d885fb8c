//! The body of revolution with a power-law profile: g = height (r / radius)^exponent, from the cone to the flat punch.
//!
//! Its contact is that of L. A. Galin (1946) and I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47.

use super::{Axisymmetric, Indenter, IndenterError, LENGTH, Setting, in_range};
use crate::block;
use crate::quantity::block::Block as _;
use crate::quantity::key::{Kind, number};

/// Largest exponent. Beyond it the shape is a flat punch for every purpose, and powers leave the range of numbers.
pub(super) const MAX_EXPONENT: f64 = 100.0;

block! {
    /// gap = height (r / radius)^exponent.
    #[derive(Copy)]
    pub struct PowerLawKeys in "power-law" {
        /// Exponent of the gap; 2 is a paraboloid.
        exponent: f64 => "exponent", Kind::Number(number("4.0"));
        /// Radius at which the gap is `height`.
        radius_m: f64 => "radius", LENGTH;
        /// Gap at `radius`.
        height_m: f64 => "height", LENGTH;
    }
}

/// A rigid power-law indenter. Exponent 2 is the sphere with R = radius^2 / (2 height), exponent 1 the cone with the slope
/// height / radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLaw {
    keys: PowerLawKeys,
    /// G(x) / g(x), the same at every x.
    transformed_ratio: f64,
}

impl PowerLaw {
    /// The profile of this exponent that rises to `height_m` at `radius_m`.
    ///
    /// # Errors
    /// [`IndenterError::Exponent`] for an exponent below 1 or above 100, [`IndenterError::Length`] for the lengths.
    pub fn new(exponent: f64, radius_m: f64, height_m: f64) -> Result<Self, IndenterError> {
        Self::of(PowerLawKeys {
            exponent,
            radius_m,
            height_m,
        })
    }

    /// The same of its keys.
    ///
    /// # Errors
    /// As [`PowerLaw::new`].
    pub fn of(keys: PowerLawKeys) -> Result<Self, IndenterError> {
        let exponent = keys.exponent;
        if !(1.0..=MAX_EXPONENT).contains(&exponent) {
            return Err(IndenterError::Exponent { exponent });
        }
        Ok(Self {
            keys: in_range(keys)?,
            transformed_ratio: std::f64::consts::PI.sqrt() * gamma(0.5 * exponent + 1.0)
                / gamma(0.5 * exponent + 0.5),
        })
    }

    fn profile_m(&self, r_m: f64) -> f64 {
        let keys = &self.keys;
        keys.height_m * (r_m / keys.radius_m).powf(keys.exponent)
    }
}

impl Indenter for PowerLaw {
    fn shape(&self) -> &'static str {
        PowerLawKeys::NAME
    }

    fn parameters(&self) -> Vec<Setting> {
        self.keys.settings().collect()
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.profile_m(x_m.hypot(y_m))
    }

    fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
        Some(self)
    }

    /// W = 2 n G(a) a / ((n + 1) C).
    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
        let PowerLawKeys {
            exponent: n,
            radius_m,
            height_m,
        } = self.keys;
        let full = self.transformed_ratio * height_m * radius_m;
        let share = load_n * compliance_per_pa * (n + 1.0) / (2.0 * n * full);
        radius_m * share.powf((n + 1.0).recip())
    }
}

impl Axisymmetric for PowerLaw {
    /// G(x) = g(x) sqrt(pi) Gamma(n/2 + 1) / Gamma(n/2 + 1/2).
    fn transformed_gap_m(&self, x_m: f64) -> f64 {
        self.transformed_ratio * self.profile_m(x_m)
    }

    /// The pressure on the axis is proportional to the integral of x^(n-2), which diverges for the cone alone.
    fn has_bounded_pressure(&self) -> bool {
        self.keys.exponent > 1.0
    }
}

/// The gamma function for arguments of at least 1, by the series of C. Lanczos, J. SIAM Numer. Anal. B 1 (1964) 86, with the
/// coefficients of P. Godfrey for g = 7 and nine terms: a few units in the last place.
fn gamma(x: f64) -> f64 {
    const G: f64 = 7.0;
    const COEFFICIENTS: [f64; 8] = [
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    let mut sum = 0.999_999_999_999_809_9;
    for (k, coefficient) in COEFFICIENTS.iter().enumerate() {
        sum += coefficient / (x + k as f64);
    }
    let shifted = x - 0.5 + G;
    std::f64::consts::TAU.sqrt() * shifted.powf(x - 0.5) * (-shifted).exp() * sum
}

#[cfg(test)]
mod tests {
    use super::super::{Cone, Sphere};
    use super::*;

    #[test]
    fn exponent_2_is_the_sphere_and_exponent_1_the_cone() {
        let law = PowerLaw::new(2.0, 1e-3, 5e-5).unwrap();
        let sphere = Sphere::new(1e-6 / (2.0 * 5e-5)).unwrap();
        let sharp = PowerLaw::new(1.0, 1e-3, 2e-4).unwrap();
        let cone = Cone::new(5.0_f64.atan()).unwrap();
        let pairs: [(&dyn Indenter, &dyn Indenter); 2] = [(&law, &sphere), (&sharp, &cone)];
        for (one, other) in pairs {
            let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-14, "{a:e} {b:e}");
            let (body, its) = (one.axisymmetric().unwrap(), other.axisymmetric().unwrap());
            // The roundings of the gamma function and of a power.
            for r in [1e-7, 3e-5, 1e-3, 0.2] {
                close(one.gap_m(0.6 * r, 0.8 * r), other.gap_m(0.6 * r, 0.8 * r));
                close(body.transformed_gap_m(r), its.transformed_gap_m(r));
            }
            close(
                one.elastic_half_width_m(3.0, 4e-10),
                other.elastic_half_width_m(3.0, 4e-10),
            );
            assert_eq!(body.has_bounded_pressure(), its.has_bounded_pressure());
        }
    }

    #[test]
    fn the_gamma_function_has_its_known_values() {
        let mut factorial = 1.0;
        for n in 1..=51 {
            // A power of up to 51 amplifies the rounding of its base.
            assert!((gamma(f64::from(n)) / factorial - 1.0).abs() < 3e-14, "{n}");
            factorial *= f64::from(n);
        }
        let root = std::f64::consts::PI.sqrt();
        for (x, known) in [(1.5, 0.5 * root), (2.5, 0.75 * root), (3.5, 1.875 * root)] {
            assert!((gamma(x) / known - 1.0).abs() < 2e-15, "{x}");
        }
    }

    #[test]
    fn the_transformed_gap_of_every_exponent_is_the_integral_that_defines_it() {
        for exponent in [1.0, 1.5, 2.0, 3.7, 10.0] {
            let law = PowerLaw::new(exponent, 1e-3, 1e-4).unwrap();
            let x = 4e-4;
            // r = x (1 - t^2) leaves a smooth integrand but for r^(n-1) at t = 1, where it vanishes: the midpoint rule
            // converges at least like N^-(exponent), N^-2 at most.
            let count = 20_000;
            let sum: f64 = (0..count)
                .map(|i| (f64::from(i) + 0.5) / f64::from(count))
                .map(|t| {
                    let s = 1.0 - t * t;
                    exponent * s.powf(exponent - 1.0) * 2.0 / (1.0 + s).sqrt()
                })
                .sum();
            let expected = law.profile_m(x) * sum / f64::from(count);
            assert!(
                (law.transformed_gap_m(x) / expected - 1.0).abs() < 1e-6,
                "{exponent}"
            );
        }
    }

    #[test]
    fn an_exponent_below_a_cone_or_no_number_is_refused() {
        for bad in [0.999, 0.0, -2.0, 100.1, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                PowerLaw::new(bad, 1.0, 1.0),
                Err(IndenterError::Exponent { .. })
            ));
        }
        assert!(PowerLaw::new(2.0, 0.0, 1.0).is_err());
        assert!(PowerLaw::new(2.0, 1.0, -1.0).is_err());
    }
}
