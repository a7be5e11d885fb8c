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

    /// Its means over parts of a way that the edge moves straight, between these fractions of it. Of the root of (c - x) (c + x) the
    /// second factor, which hardly changes, is taken at the middle of each part.
    pub(super) fn mean_forces(
        &self,
        x_m: f64,
        (from_m, to_m): (f64, f64),
        ends: &[f64],
    ) -> impl Iterator<Item = f64> {
        let beside_m = 0.5 * (from_m + to_m) + x_m;
        let scale = -4.0 / 3.0 * self.stress_pa * beside_m.sqrt();
        let at = move |end: &f64| from_m - x_m + (to_m - from_m) * end;
        let first = ends.first().map_or(0.0, at);
        let mut last = (first, first.max(0.0).sqrt());
        ends.iter().skip(1).map(move |end| {
            let here = at(end);
            let here = (here, here.max(0.0).sqrt());
            let (low, high) = if here.0 > last.0 {
                (last, here)
            } else {
                (here, last)
            };
            let mean = match (low.0 >= 0.0, high.0 > 0.0) {
                (_, false) => 0.0,
                (true, true) => (low.0 + low.1 * high.1 + high.0) / (low.1 + high.1),
                (false, true) => high.0 * high.1 / (high.0 - low.0),
            };
            // The root of 1 + 2 u, as far as it is seen.
            let u = (0.5 * (last.0 + here.0) + 2.0 * x_m - beside_m) / (2.0 * beside_m);
            last = here;
            scale * mean * (1.0 + u * (1.0 - 0.5 * u * (1.0 - u)))
        })
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
