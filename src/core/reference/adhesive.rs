//! The elastic sphere that attracts what it touches: D. Maugis, J. Colloid Interface Sci. 150 (1992) 243, and the limits on either side
//! of him (K. L. Johnson, K. Kendall and A. D. Roberts, Proc. R. Soc. Lond. A 324 (1971) 301; B. V. Derjaguin, V. M. Muller and
//! Yu. P. Toporov, J. Colloid Interface Sci. 53 (1975) 314).

use std::f64::consts::{FRAC_2_PI, PI};

use crate::numerics::roots::{ALL_DIGITS, bisect};

/// A sphere on an elastic body, attracted by a constant stress within a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Maugis {
    pub radius_m: f64,
    pub compliance_per_pa: f64,
    /// Work of adhesion (J/m^2): stress times range.
    pub work_j_per_m2: f64,
    pub stress_pa: f64,
}

/// One of his contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaugisContact {
    pub contact_radius_m: f64,
    /// Radius of the attracted zone.
    pub zone_radius_m: f64,
    pub approach_m: f64,
    pub load_n: f64,
}

impl Maugis {
    /// The sphere of this Tabor number mu, of which Maugis' parameter is 1.16 mu (K. L. Johnson and J. A. Greenwood, J. Colloid
    /// Interface Sci. 192 (1997) 326).
    pub fn of_tabor_number(
        tabor_number: f64,
        radius_m: f64,
        compliance_per_pa: f64,
        work_j_per_m2: f64,
    ) -> Self {
        // lambda = 2 s (R / (pi w K^2))^(1/3), K = 4/3 E*.
        let modulus_pa = 4.0 / (3.0 * compliance_per_pa);
        let length = (radius_m / (PI * work_j_per_m2 * modulus_pa * modulus_pa)).cbrt();
        Self {
            radius_m,
            compliance_per_pa,
            work_j_per_m2,
            stress_pa: 1.16 * tabor_number / (2.0 * length),
        }
    }

    /// The contact of this radius (m).
    pub fn contact(&self, contact_radius_m: f64) -> MaugisContact {
        let (a, s) = (contact_radius_m, self.stress_pa);
        let approach_m = |m: f64| {
            let pull = 2.0 * s * a * ((m - 1.0) * (m + 1.0)).sqrt();
            a * a / self.radius_m - self.compliance_per_pa * pull
        };
        let is_within_range = |m: f64| {
            let (root, angle) = (((m - 1.0) * (m + 1.0)).sqrt(), m.recip().acos());
            let parabola_m = 0.5 * a * a / self.radius_m * (m * m * angle + root);
            let drawn_m = 2.0 * self.compliance_per_pa * s * a * (m - 1.0);
            FRAC_2_PI * (parabola_m - approach_m(m) * angle - drawn_m) < self.work_j_per_m2 / s
        };
        let mut above = 2.0;
        while is_within_range(above) {
            above *= 2.0;
        }
        let (below, above) = bisect(1.0, above, ALL_DIGITS, is_within_range);
        let m = 0.5 * (below + above);
        let (root, angle) = (((m - 1.0) * (m + 1.0)).sqrt(), m.recip().acos());
        let hertz_n = 4.0 / 3.0 * a.powi(3) / (self.radius_m * self.compliance_per_pa);
        MaugisContact {
            contact_radius_m,
            zone_radius_m: m * a,
            approach_m: approach_m(m),
            load_n: hertz_n - 2.0 * s * a * a * (m * m * angle + root),
        }
    }

    /// The pull-off load (N) of the theory of Johnson, Kendall and Roberts: 3/2 pi w R.
    pub fn pull_off_of_jkr_n(&self) -> f64 {
        1.5 * PI * self.work_j_per_m2 * self.radius_m
    }

    /// That of the theory of Derjaguin, Muller and Toporov: 2 pi w R.
    pub fn pull_off_of_dmt_n(&self) -> f64 {
        2.0 * PI * self.work_j_per_m2 * self.radius_m
    }
}

/// The contact of Johnson, Kendall and Roberts with this radius (m) on a sphere of which only work and modulus count: load (N) and
/// approach (m).
pub fn jkr(sphere: &Maugis, contact_radius_m: f64) -> (f64, f64) {
    let (a, per_pa) = (contact_radius_m, sphere.compliance_per_pa);
    let hertz_n = 4.0 / 3.0 * a.powi(3) / (sphere.radius_m * per_pa);
    let stretched_m = (2.0 * PI * a * sphere.work_j_per_m2 * per_pa).sqrt();
    let load_n = hertz_n - 2.0 * a * stretched_m / per_pa;
    (load_n, a * a / sphere.radius_m - stretched_m)
}
