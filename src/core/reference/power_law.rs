//! Elastic contact of a body of revolution with a power-law profile g = coefficient r^n, in closed form.
//!
//! Sources: L. A. Galin, Contact Problems (English translation 1961); I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47. With
//! kappa = n * integral from 0 to pi/2 of sin^(n-1) = sqrt(pi) Gamma(n/2 + 1) / Gamma(n/2 + 1/2):
//!
//! ```text
//! delta = kappa c a^n,    W C = 2 n kappa c a^(n+1) / (n + 1),    p(0) C = n kappa c a^(n-1) / (pi (n - 1))
//! ```

use std::f64::consts::{FRAC_PI_2, PI};

/// A power-law contact: gap = height (r / radius)^exponent, load (N), contact compliance (1/Pa).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLawContact {
    pub exponent: f64,
    pub radius_m: f64,
    pub height_m: f64,
    pub load_n: f64,
    pub compliance_per_pa: f64,
}

impl PowerLawContact {
    /// kappa, by double exponential quadrature (H. Takahasi and M. Mori, Publ. RIMS 9 (1974) 721) rather than by gamma
    /// functions, so that it checks those.
    pub fn kappa(&self) -> f64 {
        let n = self.exponent;
        const STEPS: i32 = 400;
        const WIDTH: f64 = 0.01;
        let term = |k: i32| {
            let t = f64::from(k) * WIDTH;
            let u = FRAC_PI_2 * t.sinh();
            // theta = (pi/2) e^u / (e^u + e^-u), with all its digits near 0.
            let theta = FRAC_PI_2 / (1.0 + (-2.0 * u).exp());
            let weight = FRAC_PI_2 * FRAC_PI_2 * t.cosh() / (2.0 * u.cosh() * u.cosh());
            theta.sin().powf(n - 1.0) * weight
        };
        n * WIDTH * (-STEPS..=STEPS).map(term).sum::<f64>()
    }

    /// Contact radius a.
    pub fn contact_radius_m(&self) -> f64 {
        let n = self.exponent;
        let product = self.load_n * self.compliance_per_pa;
        let share = product * (n + 1.0) / (2.0 * n * self.kappa() * self.height_m * self.radius_m);
        self.radius_m * share.powf(1.0 / (n + 1.0))
    }

    /// Approach delta.
    pub fn approach_m(&self) -> f64 {
        let ratio = self.contact_radius_m() / self.radius_m;
        self.kappa() * self.height_m * ratio.powf(self.exponent)
    }

    /// Pressure on the axis, the largest for exponents up to 2; `None` for the cone, where it is unbounded.
    pub fn axis_pressure_pa(&self) -> Option<f64> {
        let n = self.exponent;
        let slope = self.approach_m() / self.contact_radius_m();
        (n > 1.0).then(|| n * slope / (PI * (n - 1.0) * self.compliance_per_pa))
    }
}

#[cfg(test)]
mod tests {
    use super::super::elastic::{ConeContact, Hertz};
    use super::*;

    fn law(exponent: f64) -> PowerLawContact {
        PowerLawContact {
            exponent,
            radius_m: 1e-3,
            height_m: 5e-5,
            load_n: 7.0,
            compliance_per_pa: 4e-10,
        }
    }

    #[test]
    fn kappa_has_its_known_values() {
        // Wallis: n times the integral of sin^(n-1).
        for (n, known) in [
            (1.0, FRAC_PI_2),
            (2.0, 2.0),
            (3.0, 0.75 * PI),
            (4.0, 8.0 / 3.0),
            (6.0, 3.2),
        ] {
            assert!((law(n).kappa() / known - 1.0).abs() < 1e-13, "{n}");
        }
    }

    #[test]
    fn exponent_2_is_hertz_and_exponent_1_the_cone() {
        let hertz = Hertz {
            radius_m: 1e-6 / 1e-4,
            load_n: 7.0,
            compliance_per_pa: 4e-10,
        };
        let cone = ConeContact {
            half_angle_rad: 20.0_f64.atan(),
            load_n: 7.0,
            compliance_per_pa: 4e-10,
        };
        let pairs = [
            (law(2.0).contact_radius_m(), hertz.contact_radius_m()),
            (law(2.0).approach_m(), hertz.approach_m()),
            (
                law(2.0).axis_pressure_pa().unwrap(),
                hertz.peak_pressure_pa(),
            ),
            (law(1.0).contact_radius_m(), cone.contact_radius_m()),
            (law(1.0).approach_m(), cone.approach_m()),
        ];
        for (found, expected) in pairs {
            assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}");
        }
        assert_eq!(law(1.0).axis_pressure_pa(), None);
    }
}
