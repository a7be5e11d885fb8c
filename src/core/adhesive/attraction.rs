//! Attraction by a constant stress within a range, and what it is on the springs.

use std::f64::consts::FRAC_PI_2;

/// Attraction by a constant stress within a range: D. Maugis, J. Colloid Interface Sci. 150 (1992) 243.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attraction {
    /// Stress by which the surfaces attract one another (Pa).
    pub stress_pa: f64,
    /// Gap from which on they do not (m).
    pub range_m: f64,
}

impl Attraction {
    /// The force (N/m) of a spring at `x_m`, attracted while the edge is at `zone_m`.
    pub(super) fn force(&self, x_m: f64, zone_m: f64) -> f64 {
        -2.0 * self.stress_pa * root(zone_m, x_m)
    }

    /// Its mean while the edge moves straight from one place to another. Of the root of (c - x) (c + x) the second factor, which
    /// hardly changes, is taken at the middle.
    pub(super) fn mean_force(&self, x_m: f64, (from_m, to_m): (f64, f64)) -> f64 {
        let (from, to) = (from_m - x_m, to_m - x_m);
        let (low, high) = (from.min(to), from.max(to));
        if high <= 0.0 {
            return 0.0;
        }
        let mean = match low >= 0.0 {
            true => (low + (low * high).sqrt() + high) / (low.sqrt() + high.sqrt()),
            false => high * high.sqrt() / (high - low),
        };
        let beside = (0.5 * (from_m + to_m) + x_m).sqrt();
        -2.0 * self.stress_pa * beside * (2.0 / 3.0) * mean
    }

    /// Twice the integral (N) of the force over the springs from `contact_m` to `zone_m`.
    pub(super) fn pull_n(&self, contact_m: f64, zone_m: f64) -> f64 {
        if zone_m <= 0.0 {
            return 0.0;
        }
        let angle = FRAC_PI_2 - (contact_m / zone_m).min(1.0).asin();
        -2.0 * self.stress_pa * (zone_m * zone_m * angle - contact_m * root(zone_m, contact_m))
    }
}

/// The root of c^2 - x^2, or 0 beyond c.
pub(super) fn root(c: f64, x: f64) -> f64 {
    ((c - x) * (c + x)).max(0.0).sqrt()
}
