//! The axisymmetric engine: the contact as a row of independent springs.
//!
//! For a convex body of revolution in circular contact, the method of dimensionality reduction (V. L. Popov and M. Heß,
//! 2015; for linear viscoelasticity the same Abel transform commutes with the hereditary integral, and the result agrees
//! with T. C. T. Ting, J. Appl. Mech. 33 (1966) 845, branch by branch) is exact under any load history:
//!
//! ```text
//! integral of C(t-s) df(x,s) = delta(t) - G(x)   where f > 0,        W = 2 * integral from 0 to infinity of f dx
//! p(r) = -(1/pi) * integral from r to infinity of f'(x) / sqrt(x^2 - r^2) dx,     a = last x with f > 0
//! ```
//!
//! Springs stand at the midpoints x_i = (i + 1/2) dx. The midpoint rule is off by at most slope dx^2 / 8 in the spring
//! that holds the contact edge: about 1e-6 of the load for 400 springs.

mod profile;

use super::half_space::grid::Grid;
use super::surface::{PressureLine, Response, Surface};
use super::{ContactError, Engine, Instant, Prescribed, Solution};

/// The row of springs of one indenter.
#[derive(Debug, Clone)]
pub struct Axisymmetric {
    width_m: f64,
    gap_m: Vec<f64>,
    edge: Edge,
    bounded_pressure: bool,
    /// Radii (m) inside the contact at which the pressure is unbounded: an apex (0), sharp edges.
    singular_radii_m: Vec<f64>,
    /// G + H per spring.
    offset_m: Vec<f64>,
    /// Active force differences per x^2, for the inverse Abel transform.
    slope: Vec<f64>,
    /// sqrt((j+1)^2 - k(k+1)...) in units of the spring width: see [`root_table`].
    roots: Vec<f64>,
    approach_m: f64,
}

/// What stands at the end of the row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// The indenter goes on: contact at the last spring means that the row is too short.
    Open,
    /// The indenter ends here: contact at the last spring is contact over the whole face.
    Rim,
}

/// The share of the peak pressure by which rounding and the discrete inverse transform may make a pressure negative.
const DISC_TOLERANCE: f64 = 1e-3;

impl Axisymmetric {
    /// A row of springs of this width (m) at x_i = (i + 1/2) width, with transformed gaps G(x_i) in metres.
    pub fn new(width_m: f64, gap_m: Vec<f64>, edge: Edge, bounded_pressure: bool) -> Self {
        let springs = gap_m.len();
        Self {
            width_m,
            edge,
            bounded_pressure,
            singular_radii_m: match bounded_pressure || edge == Edge::Rim {
                true => Vec::new(),
                false => vec![0.0],
            },
            offset_m: vec![0.0; springs],
            slope: vec![0.0; springs + 1],
            roots: if bounded_pressure {
                root_table(springs)
            } else {
                Vec::new()
            },
            approach_m: 0.0,
            gap_m,
        }
    }

    /// The same row for a shape with an apex (0) or sharp edges at these radii (m), where the pressure is unbounded: not at the
    /// axis alone, as is assumed of a shape without a rim whose pressure is not bounded.
    pub fn singular_at(mut self, radii_m: Vec<f64>) -> Self {
        self.singular_radii_m = radii_m;
        self
    }

    /// Position of a spring (m).
    pub fn position_m(&self, spring: usize) -> f64 {
        (spring as f64 + 0.5) * self.width_m
    }

    /// Width of a spring (m).
    pub fn width_m(&self) -> f64 {
        self.width_m
    }

    /// Pressure (Pa) at the axis, then at every spring inside the contact, from the line forces (N/m).
    ///
    /// The force is taken linear in x^2 between springs, which makes the Hertz pressure of a paraboloid exact.
    /// Returns the number of springs in contact; `pressure` needs room for one value more than there are springs.
    pub fn pressure_profile_pa(
        &mut self,
        force: &[f64],
        contact_radius_m: f64,
        pressure: &mut [f64],
    ) -> usize {
        let contact = force.iter().rposition(|&f| f > 0.0).map_or(0, |i| i + 1);
        if contact == 0 || self.roots.is_empty() {
            return 0;
        }
        self.fill_slopes(force, contact, contact_radius_m);
        for (row, value) in pressure.iter_mut().enumerate().take(contact + 1) {
            *value = self.pressure_of_row(row, contact, contact_radius_m);
        }
        contact
    }

    /// Pressure (Pa) at the axis for row 0, at spring k for row k + 1, from slopes filled in before.
    fn pressure_of_row(&self, row: usize, contact: usize, contact_radius_m: f64) -> f64 {
        let edge_squared = (contact_radius_m / self.width_m).powi(2);
        let last = contact - 1;
        let first = row.saturating_sub(1);
        let squared_radius = if row == 0 {
            0.0
        } else {
            (first as f64 + 0.5).powi(2)
        };
        // roots(row, i) = sqrt(x_i^2 - r^2) / width.
        let roots = &self.roots[row_start(row, self.gap_m.len())..];
        let mut sum = 0.0;
        let mut inner = if row == 0 { 0.0 } else { roots[0] };
        let slopes = &self.slope[if row == 0 { 0 } else { first + 1 }..=last];
        let outer = &roots[if row == 0 { 0 } else { 1 }..];
        for (slope, &root) in slopes.iter().zip(outer) {
            sum += slope * (root - inner);
            inner = root;
        }
        let rim = (edge_squared - squared_radius).max(0.0).sqrt();
        sum += self.slope[last + 1] * (rim - inner).max(0.0);
        -std::f64::consts::FRAC_2_PI * sum / self.width_m
    }

    /// The largest pressure (Pa) and the row where it is: sought among every eighth row, then around the best of them. A
    /// pressure that a whole row of eight springs hides would be finer than the row of springs resolves.
    fn largest_pressure(&self, contact: usize, contact_radius_m: f64) -> f64 {
        const STRIDE: usize = 8;
        let at = |row: usize| self.pressure_of_row(row, contact, contact_radius_m);
        let larger = |best: (usize, f64), row: usize| {
            let value = at(row);
            if value > best.1 { (row, value) } else { best }
        };
        let coarse = (0..=contact).step_by(STRIDE);
        let best = coarse.fold((0, f64::NEG_INFINITY), larger);
        let around = best.0.saturating_sub(STRIDE - 1)..=(best.0 + STRIDE - 1).min(contact);
        around.fold(best, larger).1
    }

    /// Slopes df/d(x^2) in units of the width: entry i lies between spring i - 1 and spring i, the last one ends at the edge.
    fn fill_slopes(&mut self, force: &[f64], contact: usize, contact_radius_m: f64) {
        for i in 1..contact {
            self.slope[i] = (force[i] - force[i - 1]) / (2 * i) as f64;
        }
        // Inside the first spring the force goes on as the parabola of its neighbours.
        self.slope[0] = if contact > 1 { self.slope[1] } else { 0.0 };
        let last = contact - 1;
        let position = last as f64 + 0.5;
        let edge = contact_radius_m / self.width_m;
        let span = edge * edge - position * position;
        self.slope[contact] = if span > 0.0 { -force[last] / span } else { 0.0 };
        if contact == 1 {
            self.slope[0] = self.slope[1];
        }
    }

    /// Approach under a load: the root of W(delta) = (2 dx / A) * sum of max(0, delta - offset), which is convex and
    /// piecewise linear, so that Newton's method ends exactly after finitely many passes from any start.
    fn approach_under_load(&self, load_n: f64, compliance_per_pa: f64) -> (f64, usize) {
        let lowest_m = self.offset_m.iter().copied().fold(f64::INFINITY, f64::min);
        let target = load_n * compliance_per_pa / (2.0 * self.width_m);
        if target <= 0.0 {
            return (lowest_m, 0);
        }
        let mut approach_m = self.approach_m.max(lowest_m);
        for pass in 1..=self.offset_m.len() + 2 {
            let (sum, count) = sum_below(&self.offset_m, approach_m);
            let next = if count == 0.0 {
                lowest_m + target
            } else {
                (target + sum) / count
            };
            if next == approach_m {
                return (approach_m, pass);
            }
            approach_m = next;
        }
        (approach_m, self.offset_m.len() + 2)
    }

    /// Contact radius: where delta - G - H, linear between springs, passes through zero.
    fn contact_radius(&self, approach_m: f64) -> Result<f64, ContactError> {
        let Some(last) = self.offset_m.iter().rposition(|&o| o < approach_m) else {
            return Ok(0.0);
        };
        match (self.offset_m.get(last + 1), self.edge) {
            (Some(&beyond), _) => {
                let inside = approach_m - self.offset_m[last];
                let share = inside / (inside + (beyond - approach_m));
                Ok(self.position_m(last) + share * self.width_m)
            }
            (None, Edge::Rim) => Ok((last + 1) as f64 * self.width_m),
            (None, Edge::Open) => Err(ContactError::ReachedEdge {
                half_width_m: self.offset_m.len() as f64 * self.width_m,
            }),
        }
    }
}

impl Engine for Axisymmetric {
    fn nodes(&self) -> usize {
        self.gap_m.len()
    }

    fn solve(
        &mut self,
        instant: &Instant<'_>,
        force: &mut [f64],
    ) -> Result<Solution, ContactError> {
        let offsets = self.offset_m.iter_mut();
        for ((offset, gap), history) in offsets.zip(&self.gap_m).zip(instant.history) {
            *offset = gap + history;
        }
        let compliance = instant.compliance_per_pa;
        let (approach_m, iterations) = match instant.prescribed.check()? {
            Prescribed::LoadN(load_n) => self.approach_under_load(load_n, compliance),
            Prescribed::ApproachM(approach_m) => (approach_m, 1),
        };
        let mut sum = 0.0;
        for (force, offset) in force.iter_mut().zip(&self.offset_m) {
            *force = ((approach_m - offset) / compliance).max(0.0);
            sum += *force;
        }
        self.approach_m = approach_m;
        Ok(Solution {
            load_n: 2.0 * self.width_m * sum,
            approach_m,
            contact_radius_m: self.contact_radius(approach_m)?,
            iterations,
            convolutions: 0,
        })
    }

    fn peak_pressure_pa(
        &mut self,
        force: &[f64],
        solution: &Solution,
    ) -> Result<Option<f64>, ContactError> {
        if !self.bounded_pressure {
            return Ok(None);
        }
        let contact = force.iter().rposition(|&f| f > 0.0).map_or(0, |i| i + 1);
        if contact == 0 {
            return Ok(Some(0.0));
        }
        self.fill_slopes(force, contact, solution.contact_radius_m);
        Ok(Some(
            self.largest_pressure(contact, solution.contact_radius_m),
        ))
    }

    fn pressure_lines(&self, force: &[f64], solution: &Solution) -> Vec<PressureLine> {
        vec![self.pressure_line(force, solution.contact_radius_m)]
    }

    fn check_assumptions(
        &mut self,
        force: &[f64],
        solution: &Solution,
    ) -> Result<(), ContactError> {
        self.check_disc(force, solution.approach_m, solution.contact_radius_m)
    }

    fn resume_from(&mut self, last: &Solution) {
        self.approach_m = last.approach_m;
    }

    fn elastic_displacement(
        &mut self,
        force: &[f64],
        displacement: &mut [f64],
    ) -> Result<usize, ContactError> {
        if force.len() != displacement.len() {
            return Err(ContactError::Operator {
                reason: format!("{} forces for {} springs", force.len(), displacement.len()),
            });
        }
        displacement.copy_from_slice(force);
        Ok(0)
    }

    fn load_per_nodal_pressure(&self) -> f64 {
        2.0 * self.width_m
    }

    fn surface(&mut self, response: &Response<'_>) -> Result<Surface, ContactError> {
        Ok(Surface::Radial(self.radial_surface(response)))
    }

    fn field(&mut self, response: &Response<'_>, grid: &Grid) -> Result<Surface, ContactError> {
        Ok(Surface::Cells(self.revolved_surface(response, grid)))
    }
}

/// Sum and number of the values below a bound. In lanes, without branches: this is the engine's innermost loop.
fn sum_below(values: &[f64], bound: f64) -> (f64, f64) {
    const LANES: usize = 8;
    let (mut sums, mut counts) = ([0.0; LANES], [0.0; LANES]);
    let chunks = values.chunks_exact(LANES);
    let rest = chunks.remainder();
    for chunk in chunks {
        for ((value, sum), count) in chunk.iter().zip(&mut sums).zip(&mut counts) {
            let below = *value < bound;
            *sum += if below { *value } else { 0.0 };
            *count += if below { 1.0 } else { 0.0 };
        }
    }
    let below = rest.iter().filter(|value| **value < bound);
    let (sum, count) = below.fold((0.0, 0.0), |(s, c), value| (s + value, c + 1.0));
    (
        sum + sums.iter().sum::<f64>(),
        count + counts.iter().sum::<f64>(),
    )
}

/// Where row `row` of the root table starts: row 0 (the axis) holds `springs` entries, row k + 1 those from spring k on.
fn row_start(row: usize, springs: usize) -> usize {
    match row {
        0 => 0,
        _ => {
            let k = row - 1;
            springs + k * springs - k * k.saturating_sub(1) / 2
        }
    }
}

/// sqrt(x_i^2 - r^2) in units of the spring width for r = 0, x_0, x_1, ... and i from the spring at r on.
fn root_table(springs: usize) -> Vec<f64> {
    let mut table = Vec::with_capacity(springs + springs * (springs + 1) / 2);
    table.extend((0..springs).map(|i| i as f64 + 0.5));
    for k in 0..springs {
        // (i + 1/2)^2 - (k + 1/2)^2 = (i - k)(i + k + 1): no digits lost.
        table.extend((k..springs).map(|i| (((i - k) * (i + k + 1)) as f64).sqrt()));
    }
    table
}
