//! Hertz contact of a body with two principal radii of curvature, in closed form with complete elliptic integrals.
//!
//! Source: K. L. Johnson, Contact Mechanics, 1985, section 4.2, equations (4.26) to (4.28). With the semi-axes a >= b, the
//! eccentricity e^2 = 1 - b^2/a^2 as modulus of K and E, the curvatures A <= B (halves of 1/R), p_0 = 3 W / (2 pi a b):
//!
//! ```text
//! A = p_0 C b (K - E) / (e^2 a^2),    B = p_0 C b ((a/b)^2 E - K) / (e^2 a^2),    delta = p_0 C b K
//! ```

use std::f64::consts::{FRAC_PI_2, PI};

use crate::numerics::roots::bisect;

/// Complete elliptic integrals of one modulus k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticIntegrals {
    /// K(k), of the first kind.
    pub first: f64,
    /// E(k), of the second kind.
    pub second: f64,
    /// K - E, with all its digits even where both are pi/2.
    pub difference: f64,
}

impl EllipticIntegrals {
    /// The integrals by the complementary modulus k' = sqrt(1 - k^2), 0 < k' <= 1, with the arithmetic-geometric mean
    /// (M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, 1964, 17.6).
    pub fn of_complementary_modulus(k_prime: f64) -> Self {
        let (mut a, mut b) = (1.0_f64, k_prime);
        // The sum of 2^(n-1) c_n^2 is 1 - E/K.
        let (mut weight, mut sum) = (0.5, 0.5 * (1.0 - k_prime) * (1.0 + k_prime));
        // The digits double at every step: 40 are more than any k' above 1e-300 needs.
        for _ in 0..40 {
            let c = 0.5 * (a - b);
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
            weight *= 2.0;
            sum += weight * c * c;
            if c <= f64::EPSILON * a {
                break;
            }
        }
        let first = FRAC_PI_2 / a;
        Self {
            first,
            second: first * (1.0 - sum),
            difference: first * sum,
        }
    }
}

/// An elliptic Hertz contact: radii along x and y (m), load (N), contact compliance (1/Pa).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticHertz {
    pub radius_x_m: f64,
    pub radius_y_m: f64,
    pub load_n: f64,
    pub compliance_per_pa: f64,
}

/// What the contact comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticContact {
    pub semi_axis_x_m: f64,
    pub semi_axis_y_m: f64,
    pub approach_m: f64,
    pub peak_pressure_pa: f64,
}

impl EllipticHertz {
    /// The contact in closed form, but for the axis ratio, which is the root of B/A = R_long / R_short.
    pub fn contact(&self) -> EllipticContact {
        let (long_m, short_m) = (
            self.radius_x_m.max(self.radius_y_m),
            self.radius_x_m.min(self.radius_y_m),
        );
        // b/a; the ratio of the curvatures grows as it falls.
        let k_prime = axis_ratio(long_m / short_m);
        let integrals = EllipticIntegrals::of_complementary_modulus(k_prime);
        // (A + B) = p_0 C E / b, hence a b^2 = 3 W C E / (2 pi (A + B)).
        let curvatures = 0.5 / long_m + 0.5 / short_m;
        let scale = 1.5 * self.load_n * self.compliance_per_pa / PI;
        let a = (scale * integrals.second / (curvatures * k_prime * k_prime)).cbrt();
        let b = k_prime * a;
        let peak_pressure_pa = 1.5 * self.load_n / (PI * a * b);
        let (semi_axis_x_m, semi_axis_y_m) = if self.radius_x_m >= self.radius_y_m {
            (a, b)
        } else {
            (b, a)
        };
        EllipticContact {
            semi_axis_x_m,
            semi_axis_y_m,
            approach_m: peak_pressure_pa * self.compliance_per_pa * b * integrals.first,
            peak_pressure_pa,
        }
    }
}

/// B/A of an ellipse with the axis ratio b/a = k'.
fn curvature_ratio(k_prime: f64) -> f64 {
    let integrals = EllipticIntegrals::of_complementary_modulus(k_prime);
    if integrals.difference <= 0.0 {
        return 1.0;
    }
    // (a/b)^2 E - K = ((a/b)^2 - 1) E - (K - E).
    let surplus = (1.0 - k_prime) * (1.0 + k_prime) / (k_prime * k_prime);
    (surplus * integrals.second - integrals.difference) / integrals.difference
}

/// b/a of the contact of curvatures with this ratio, at least 1, by bisection.
fn axis_ratio(curvature_ratio_wanted: f64) -> f64 {
    // The logarithm is halved, of which 70 times exhaust the digits.
    let is_longer = |ln_k: f64| curvature_ratio(ln_k.exp()) > curvature_ratio_wanted;
    bisect(1e-9_f64.ln(), 0.0, 70, is_longer).1.exp()
}

impl EllipticContact {
    /// p = p_0 sqrt(1 - (x/a)^2 - (y/b)^2), 0 outside.
    pub fn pressure_pa(&self, x_m: f64, y_m: f64) -> f64 {
        let (x, y) = (x_m / self.semi_axis_x_m, y_m / self.semi_axis_y_m);
        self.peak_pressure_pa * (1.0 - x * x - y * y).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::super::elastic::Hertz;
    use super::*;

    fn contact(radius_x_m: f64, radius_y_m: f64) -> EllipticContact {
        EllipticHertz {
            radius_x_m,
            radius_y_m,
            load_n: 7.0,
            compliance_per_pa: 4e-10,
        }
        .contact()
    }

    #[test]
    fn the_integrals_have_their_tabulated_values() {
        // Abramowitz and Stegun, tables 17.1 and 17.2, by m = k^2.
        for (m, first, second) in [
            (0.0, FRAC_PI_2, FRAC_PI_2),
            (0.5, 1.854_074_677_301_371_9, 1.350_643_881_047_675_5),
            (0.81, 2.280_549_138_422_770_2, 1.171_697_052_781_614),
        ] {
            let found = EllipticIntegrals::of_complementary_modulus((1.0_f64 - m).sqrt());
            assert!((found.first / first - 1.0).abs() < 1e-15, "{found:?}");
            assert!((found.second / second - 1.0).abs() < 1e-15, "{found:?}");
        }
        // Near k' = 0: K = ln(4 / k').
        let needle = EllipticIntegrals::of_complementary_modulus(1e-9);
        assert!((needle.first - 4e9_f64.ln()).abs() < 1e-14 * needle.first);
        assert!((needle.second - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_integrals_obey_the_relation_of_legendre() {
        for i in 1..100 {
            let angle = f64::from(i) / 100.0 * FRAC_PI_2;
            let one = EllipticIntegrals::of_complementary_modulus(angle.sin());
            let other = EllipticIntegrals::of_complementary_modulus(angle.cos());
            let left =
                one.second * other.first + other.second * one.first - one.first * other.first;
            // A few roundings of terms of up to 6.
            assert!((left - FRAC_PI_2).abs() < 1e-14, "{i} {left}");
        }
    }

    #[test]
    fn the_difference_keeps_its_digits_in_the_circular_limit() {
        // K - E = (pi/4) k^2 (1 + 3 k^2 / 8 + ...).
        for k in [1e-2_f64, 1e-4, 1e-6] {
            let k_prime = ((1.0 - k) * (1.0 + k)).sqrt();
            let found = EllipticIntegrals::of_complementary_modulus(k_prime).difference;
            let expected = 0.25 * PI * k * k * (1.0 + 0.375 * k * k);
            // k' itself is rounded, which k^2 feels.
            assert!(
                (found / expected - 1.0).abs() < 1e-8 + 4e-16 / (k * k),
                "{k}"
            );
        }
    }

    #[test]
    fn equal_radii_are_the_circular_contact() {
        let hertz = Hertz {
            radius_m: 0.02,
            load_n: 7.0,
            compliance_per_pa: 4e-10,
        };
        for ratio in [1.0, 1.0 + 1e-9] {
            let found = contact(0.02, 0.02 * ratio);
            for (found, expected) in [
                (found.semi_axis_x_m, hertz.contact_radius_m()),
                (found.semi_axis_y_m, hertz.contact_radius_m()),
                (found.approach_m, hertz.approach_m()),
                (found.peak_pressure_pa, hertz.peak_pressure_pa()),
            ] {
                assert!((found / expected - 1.0).abs() < 2e-8, "{found} {expected}");
            }
        }
    }

    #[test]
    fn the_semi_axes_are_those_of_the_classical_table() {
        // a = m s and b = n s, s^3 = 3 W C / (4 (A + B)); m and n against theta with cos(theta) = (B - A) / (B + A)
        // from S. Timoshenko and J. N. Goodier, Theory of Elasticity, section 141, to the four digits printed.
        for (theta_deg, m, n) in [(30.0_f64, 2.731, 0.493), (60.0, 1.486, 0.717)] {
            let cosine = theta_deg.to_radians().cos();
            let (smaller, larger) = (1.0 - cosine, 1.0 + cosine);
            let found = contact(0.5 / smaller, 0.5 / larger);
            let s = (0.75 * 7.0 * 4e-10 / (smaller + larger)).cbrt();
            assert!((found.semi_axis_x_m / s - m).abs() < 1e-3, "{theta_deg}");
            assert!((found.semi_axis_y_m / s - n).abs() < 1e-3, "{theta_deg}");
        }
    }

    #[test]
    fn the_curvatures_come_back_from_the_pressure() {
        for (radius_x, radius_y) in [(0.03, 0.01), (0.01, 0.03), (1.0, 1e-3)] {
            let found = contact(radius_x, radius_y);
            let (a, b) = (
                found.semi_axis_x_m.max(found.semi_axis_y_m),
                found.semi_axis_x_m.min(found.semi_axis_y_m),
            );
            let integrals = EllipticIntegrals::of_complementary_modulus(b / a);
            let flattest =
                found.peak_pressure_pa * 4e-10 * b * integrals.difference / (a * a - b * b);
            let radius = 0.5 / flattest;
            assert!((radius / f64::max(radius_x, radius_y) - 1.0).abs() < 1e-12);
        }
    }
}
