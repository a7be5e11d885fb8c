//! The contact pressure at the springs, and the largest of it, by the inverse Abel transform of the line force f.
//!
//! The force is taken linear in x^2 between springs, with slopes s = df/d(x^2), which makes the Hertz pressure of a paraboloid exact:
//!
//! ```text
//! p(r) = -(2/pi) * sum over the intervals of x beyond r of s * [sqrt(x^2 - r^2)]
//! ```
//!
//! A row is the pressure at one r: row 0 at the axis, row k + 1 at spring k.

use std::f64::consts::FRAC_2_PI;

use super::{Axisymmetric, in_contact};
use crate::contact::sums;

/// Of the largest pressure, rows from one that is looked at first to the next: what they hide would be finer than the row of springs
/// resolves. A power of two.
const STRIDE: usize = 8;

/// What is known of the springs of a row, and of the force that was last asked about.
#[derive(Debug, Clone)]
pub(super) struct Slopes {
    /// 1/(x^2 - x'^2) of each spring x and its inner neighbour x' (1/m2); 0 for the first.
    per_span_per_m2: Vec<f64>,
    /// s: entry i lies between spring i - 1 and spring i, the last one ends at the edge of contact.
    slope: Vec<f64>,
    /// Largest -s of every [`STRIDE`] entries and all beyond them.
    steepest: Vec<f64>,
    edge_m: f64,
}

impl Slopes {
    /// Of springs at these positions (m).
    pub(super) fn new(position_m: &[f64]) -> Self {
        let neighbours = position_m.windows(2);
        let per_span = neighbours.map(|x_m| difference_of_squares(x_m[0], x_m[1]).recip());
        Self {
            per_span_per_m2: std::iter::once(0.0).chain(per_span).collect(),
            slope: Vec::with_capacity(position_m.len() + 1),
            steepest: Vec::with_capacity(position_m.len() / STRIDE + 1),
            edge_m: 0.0,
        }
    }

    /// Takes in the force of the springs in contact, one at least, the last of which stands at `last_m`.
    fn fill(&mut self, force: &[f64], last_m: f64, edge_m: f64) {
        self.edge_m = edge_m;
        self.slope.clear();
        self.slope.push(0.0);
        let between = force.windows(2).zip(&self.per_span_per_m2[1..]);
        (self.slope).extend(between.map(|(f, per_span_per_m2)| (f[1] - f[0]) * per_span_per_m2));
        let span_m2 = difference_of_squares(last_m, edge_m);
        let last = force.last().copied().unwrap_or(0.0);
        self.slope
            .push(if span_m2 > 0.0 { -last / span_m2 } else { 0.0 });
        // Inside the first spring the force goes on as the parabola of its neighbours.
        self.slope[0] = self.slope[1];
        self.steepest.clear();
        self.steepest.resize(self.slope.len().div_ceil(STRIDE), 0.0);
        let mut beyond = f64::NEG_INFINITY;
        let parts = self.slope.chunks(STRIDE).zip(&mut self.steepest);
        for (part, steepest) in parts.rev() {
            beyond = beyond.max(-sums::least(part));
            *steepest = beyond;
        }
    }

    /// The pressure (Pa) of a row at `r_m`, with the roots of the springs from its own place on.
    fn pressure_pa(&self, (row, r_m): (usize, f64), roots_m: &[f64]) -> f64 {
        let last = self.slope.len() - 1;
        let inner = &self.slope[row..last];
        let ends_m = (&roots_m[..inner.len()], &roots_m[1..=inner.len()]);
        let inner = sums::sum_of_spans(inner, ends_m.0, ends_m.1);
        let outer = (self.root_of_edge_m(r_m) - roots_m[last - row]).max(0.0);
        -FRAC_2_PI * (inner + self.slope[last] * outer)
    }

    /// A pressure (Pa) that the row at `r_m` does not exceed: that of the steepest slope beyond everywhere beyond.
    fn bound_pa(&self, (row, r_m): (usize, f64)) -> f64 {
        /// Of the bound, for what rounding takes from it.
        const ROUNDING: f64 = 1e-12;
        let bound_pa = FRAC_2_PI * self.steepest[row / STRIDE] * self.root_of_edge_m(r_m);
        bound_pa + ROUNDING * bound_pa.abs()
    }

    fn root_of_edge_m(&self, r_m: f64) -> f64 {
        ((self.edge_m - r_m).max(0.0) * (self.edge_m + r_m)).sqrt()
    }
}

impl Axisymmetric {
    /// Pressure (Pa) at the axis, then at every spring inside the contact, from the line forces (N/m).
    ///
    /// Returns the number of springs in contact; `pressure` needs room for one value more than there are springs.
    pub fn pressure_profile_pa(
        &mut self,
        force: &[f64],
        contact_radius_m: f64,
        pressure: &mut [f64],
    ) -> usize {
        let contact = in_contact(force);
        if contact == 0 || !self.bounded_pressure {
            return 0;
        }
        self.fill_slopes(&force[..contact], contact_radius_m);
        for (row, value) in pressure.iter_mut().enumerate().take(contact + 1) {
            *value = self.pressure_of_row(row);
        }
        contact
    }

    /// The largest pressure (Pa) of these line forces (N/m): sought among every eighth row, then uphill from the best of them in steps
    /// that halve. Rows that cannot be larger are passed over.
    pub(super) fn largest_pressure_pa(&mut self, force: &[f64], contact_radius_m: f64) -> f64 {
        self.fill_slopes(force, contact_radius_m);
        let mut best = (0, f64::NEG_INFINITY);
        let mut look = |row: usize, best: &mut (usize, f64)| {
            let place = (row, self.roots.radius_m(row));
            if self.slopes.bound_pa(place) > best.1 {
                let value = self.pressure_of_row(row);
                if value > best.1 {
                    *best = (row, value);
                }
            }
        };
        for row in (0..=force.len()).step_by(STRIDE) {
            look(row, &mut best);
        }
        let mut step = STRIDE / 2;
        while step > 0 {
            let middle = best.0;
            for row in [middle.checked_sub(step), Some(middle + step)] {
                if let Some(row) = row.filter(|row| *row <= force.len()) {
                    look(row, &mut best);
                }
            }
            step /= 2;
        }
        best.1
    }

    /// The pressure (Pa) of a row, from slopes filled in before.
    fn pressure_of_row(&mut self, row: usize) -> f64 {
        let place = (row, self.roots.radius_m(row));
        self.slopes.pressure_pa(place, self.roots.of_node(row))
    }

    fn fill_slopes(&mut self, force: &[f64], contact_radius_m: f64) {
        let force = self.reported.of(force, &self.width_m);
        let last_m = self.position_m[force.len() - 1];
        self.slopes.fill(force, last_m, contact_radius_m);
    }
}

fn difference_of_squares(inner: f64, outer: f64) -> f64 {
    (outer - inner) * (outer + inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::axisymmetric::Edge;

    #[test]
    fn rows_that_are_passed_over_have_no_larger_pressure() {
        let springs = 150;
        let width_m = 1e-6;
        let mut engine = Axisymmetric::new(width_m, vec![0.0; springs], Edge::Open, true);
        let edge_m = 120.3 * width_m;
        // Steps in a force that falls outwards: the pressure has its peak on the axis, inside, or near the edge.
        for (place, height) in [(0.0, 0.0), (0.3, 3.0), (0.7, 3.0), (0.95, 5.0), (0.95, 0.3)] {
            let fall = |x: f64| 1.0 - x * x + height * ((place - x) / 0.02).tanh();
            let force_at = |i| fall(engine.position_m(i) / edge_m) - fall(1.0);
            let force: Vec<f64> = (0..120).map(force_at).collect();
            let mut profile = vec![0.0; 121];
            assert_eq!(
                engine.pressure_profile_pa(&force, edge_m, &mut profile),
                120
            );
            let better = |best: usize, row: usize| match profile[row] > profile[best] {
                true => row,
                false => best,
            };
            let first = (0..=120).step_by(STRIDE).fold(0, better);
            let best = (first.saturating_sub(7)..=(first + 7).min(120)).fold(first, better);
            let found = engine.largest_pressure_pa(&force, edge_m);
            assert_eq!(found, profile[best], "{place} {height}");
        }
    }
}
