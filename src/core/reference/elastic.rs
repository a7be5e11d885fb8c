//! Elastic contacts in closed form. `compliance_per_pa` is C = 1/E* = (1 - nu^2)/E.
//!
//! Sources: K. L. Johnson, Contact Mechanics, 1985, chapters 3 to 5; I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47.

use std::f64::consts::PI;

/// Hertz contact of a rigid sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    pub radius_m: f64,
    pub load_n: f64,
    pub compliance_per_pa: f64,
}

impl Hertz {
    /// a^3 = (3/4) W R C.
    pub fn contact_radius_m(&self) -> f64 {
        (0.75 * self.load_n * self.radius_m * self.compliance_per_pa).cbrt()
    }

    /// delta = a^2 / R.
    pub fn approach_m(&self) -> f64 {
        self.contact_radius_m().powi(2) / self.radius_m
    }

    /// p_0 = 3 W / (2 pi a^2).
    pub fn peak_pressure_pa(&self) -> f64 {
        1.5 * self.load_n / (PI * self.contact_radius_m().powi(2))
    }

    /// p(r) = p_0 sqrt(1 - r^2/a^2), 0 outside.
    pub fn pressure_pa(&self, r_m: f64) -> f64 {
        let ratio = r_m / self.contact_radius_m();
        self.peak_pressure_pa() * (1.0 - ratio * ratio).max(0.0).sqrt()
    }

    /// Surface displacement inside and outside the contact.
    pub fn displacement_m(&self, r_m: f64) -> f64 {
        let a = self.contact_radius_m();
        let ratio = r_m / a;
        if ratio <= 1.0 {
            return self.approach_m() - r_m * r_m / (2.0 * self.radius_m);
        }
        let bracket = (2.0 - ratio * ratio) * ratio.recip().asin() + (ratio * ratio - 1.0).sqrt();
        a * a / (PI * self.radius_m) * bracket
    }
}

/// Contact of a rigid cone of this half angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConeContact {
    pub half_angle_rad: f64,
    pub load_n: f64,
    pub compliance_per_pa: f64,
}

impl ConeContact {
    /// W = (pi/2) a^2 cot(alpha) / C.
    pub fn contact_radius_m(&self) -> f64 {
        (2.0 * self.load_n * self.compliance_per_pa * self.half_angle_rad.tan() / PI).sqrt()
    }

    /// delta = (pi/2) a cot(alpha).
    pub fn approach_m(&self) -> f64 {
        0.5 * PI * self.contact_radius_m() / self.half_angle_rad.tan()
    }
}

/// Approach of a rigid flat punch: W = 2 a delta / C.
pub fn flat_punch_approach_m(radius_m: f64, load_n: f64, compliance_per_pa: f64) -> f64 {
    load_n * compliance_per_pa / (2.0 * radius_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hertz_pressure_carries_the_load_and_its_displacement_is_continuous() {
        let hertz = Hertz {
            radius_m: 0.01,
            load_n: 10.0,
            compliance_per_pa: 4e-10,
        };
        let a = hertz.contact_radius_m();
        let n = 100_000;
        let load: f64 = (0..n)
            .map(|i| (f64::from(i) + 0.5) * a / f64::from(n))
            .map(|r| 2.0 * PI * r * hertz.pressure_pa(r) * a / f64::from(n))
            .sum();
        // The midpoint rule at the square-root edge converges like n^(-3/2).
        assert!((load / hertz.load_n - 1.0).abs() < 1e-6);
        let jump = hertz.displacement_m(a * (1.0 + 1e-9)) - hertz.displacement_m(a);
        assert!(jump.abs() < 1e-8 * hertz.approach_m());
        // Far away the load is a point load: u -> C W / (pi r).
        let r = 1e3 * a;
        let point = hertz.compliance_per_pa * hertz.load_n / (PI * r);
        assert!((hertz.displacement_m(r) / point - 1.0).abs() < 1e-5);
    }
}
