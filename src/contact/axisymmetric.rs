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
//! A spring stands where the transformed gap is its mean over the spring's width, so that springs that are in contact add up to
//! the integral above. What is left is the spring that holds the contact edge, at most slope dx^2 / 8: about 1e-6 of the load for
//! 400 springs. Widths may differ along the row: finer where the edge moves.

mod monotone;
mod profile;

use super::half_space::grid::Grid;
use super::surface::{PressureLine, Response, Surface};
use super::{ContactError, Engine, Instant, Prescribed, Solution};
use monotone::Monotone;

/// The row of springs of one indenter.
#[derive(Debug, Clone)]
pub struct Axisymmetric {
    /// Middle and width of every spring.
    position_m: Vec<f64>,
    width_m: Vec<f64>,
    gap_m: Vec<f64>,
    edge: Edge,
    bounded_pressure: bool,
    /// Radii (m) inside the contact at which the pressure is unbounded: an apex (0), sharp edges.
    singular_radii_m: Vec<f64>,
    /// G + H per spring.
    offset_m: Vec<f64>,
    /// Active force differences per x^2, for the inverse Abel transform.
    slope: Vec<f64>,
    /// sqrt(x_i^2 - r^2): see [`root_table`].
    roots_m: Vec<f64>,
    reported: Monotone,
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

impl Axisymmetric {
    /// A row of springs of this width (m) at x_i = (i + 1/2) width, with transformed gaps G(x_i) in metres.
    pub fn new(width_m: f64, gap_m: Vec<f64>, edge: Edge, bounded_pressure: bool) -> Self {
        let springs = gap_m.len();
        let position_m = (0..springs).map(|i| (i as f64 + 0.5) * width_m).collect();
        Self::at(
            position_m,
            vec![width_m; springs],
            gap_m,
            edge,
            bounded_pressure,
        )
    }

    /// A row of springs between these ascending places (m), the first of which is the axis, with the transformed gap G (m).
    pub fn between(
        places_m: &[f64],
        transformed_gap_m: impl Fn(f64) -> f64,
        edge: Edge,
        bounded_pressure: bool,
    ) -> Self {
        let ends = places_m.windows(2);
        let width_m = ends.clone().map(|ends| ends[1] - ends[0]).collect();
        let means = ends.map(|ends| place_of_mean(ends[0], ends[1], &transformed_gap_m));
        let (position_m, gap_m) = means.unzip();
        Self::at(position_m, width_m, gap_m, edge, bounded_pressure)
    }

    fn at(
        position_m: Vec<f64>,
        width_m: Vec<f64>,
        gap_m: Vec<f64>,
        edge: Edge,
        bounded_pressure: bool,
    ) -> Self {
        let springs = gap_m.len();
        Self {
            edge,
            bounded_pressure,
            singular_radii_m: match bounded_pressure || edge == Edge::Rim {
                true => Vec::new(),
                false => vec![0.0],
            },
            offset_m: vec![0.0; springs],
            slope: vec![0.0; springs + 1],
            roots_m: match bounded_pressure {
                true => root_table(&position_m),
                false => Vec::new(),
            },
            reported: Monotone::default(),
            approach_m: 0.0,
            position_m,
            width_m,
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
        self.position_m[spring]
    }

    /// The end of the row (m).
    fn end_m(&self) -> f64 {
        let last = self.position_m.last().zip(self.width_m.last());
        last.map_or(0.0, |(x_m, width_m)| x_m + 0.5 * width_m)
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
        let contact = in_contact(force);
        if contact == 0 || self.roots_m.is_empty() {
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
        let last = contact - 1;
        let first = row.saturating_sub(1);
        let radius_m = if row == 0 {
            0.0
        } else {
            self.position_m[first]
        };
        // roots(row, i) = sqrt(x_i^2 - r^2).
        let roots_m = &self.roots_m[row_start(row, self.gap_m.len())..];
        let mut sum = 0.0;
        let mut inner = if row == 0 { 0.0 } else { roots_m[0] };
        let slopes = &self.slope[if row == 0 { 0 } else { first + 1 }..=last];
        let outer = &roots_m[if row == 0 { 0 } else { 1 }..];
        for (slope, &root) in slopes.iter().zip(outer) {
            sum += slope * (root - inner);
            inner = root;
        }
        let beyond = (contact_radius_m - radius_m).max(0.0) * (contact_radius_m + radius_m);
        sum += self.slope[last + 1] * (beyond.sqrt() - inner).max(0.0);
        -std::f64::consts::FRAC_2_PI * sum
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

    /// Slopes df/d(x^2): entry i lies between spring i - 1 and spring i, the last one ends at the edge.
    fn fill_slopes(&mut self, force: &[f64], contact: usize, contact_radius_m: f64) {
        let force = self.reported.of(&force[..contact], &self.width_m);
        let between = |inner_m: f64, outer_m: f64| (outer_m - inner_m) * (outer_m + inner_m);
        for i in 1..contact {
            let (inner_m, outer_m) = (self.position_m[i - 1], self.position_m[i]);
            self.slope[i] = (force[i] - force[i - 1]) / between(inner_m, outer_m);
        }
        let last = contact - 1;
        let span = between(self.position_m[last], contact_radius_m);
        self.slope[contact] = if span > 0.0 { -force[last] / span } else { 0.0 };
        // Inside the first spring the force goes on as the parabola of its neighbours.
        self.slope[0] = self.slope[1];
    }

    /// Approach under a load: the root of W(delta) = (2/A) * sum of dx max(0, delta - offset), which is convex and
    /// piecewise linear, so that Newton's method ends exactly after finitely many passes from any start.
    fn approach_under_load(&self, load_n: f64, compliance_per_pa: f64) -> (f64, usize) {
        let lowest_m = self.offset_m.iter().copied().fold(f64::INFINITY, f64::min);
        let target = 0.5 * load_n * compliance_per_pa;
        if target <= 0.0 {
            return (lowest_m, 0);
        }
        let mut approach_m = self.approach_m.max(lowest_m);
        for pass in 1..=self.offset_m.len() + 2 {
            let (sum, width_m) = sum_below(&self.offset_m, &self.width_m, approach_m);
            let next = match width_m > 0.0 {
                true => (target + sum) / width_m,
                false => lowest_m + target / self.end_m(),
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
                let (inner_m, outer_m) = (self.position_m[last], self.position_m[last + 1]);
                Ok(inner_m + share * (outer_m - inner_m))
            }
            (None, Edge::Rim) => Ok(self.end_m()),
            (None, Edge::Open) => Err(ContactError::ReachedEdge {
                half_width_m: self.end_m(),
            }),
        }
    }
}

/// Where (m) between two places a gap equals its mean over them, and that mean (m): the mean by Gauss' rule of three points, the place
/// by the secant method. Where the gap does not rise, the middle.
fn place_of_mean(from_m: f64, to_m: f64, gap_m: impl Fn(f64) -> f64) -> (f64, f64) {
    /// Of which one or two are enough but beside an apex.
    const STEPS: usize = 8;
    let (middle_m, half_m) = (0.5 * (from_m + to_m), 0.5 * (to_m - from_m));
    let beside_m = half_m * 0.6_f64.sqrt();
    let at_middle_m = gap_m(middle_m);
    let beside = gap_m(middle_m - beside_m) + gap_m(middle_m + beside_m);
    let mean_m = (5.0 * beside + 8.0 * at_middle_m) / 18.0;
    let rise_m = gap_m(to_m) - gap_m(from_m);
    let (mut place_m, mut off_m) = (middle_m, at_middle_m - mean_m);
    let mut slope = rise_m / (2.0 * half_m);
    for _ in 0..STEPS {
        if slope.is_nan() || slope <= 0.0 || off_m.abs() <= 1e-14 * rise_m {
            break;
        }
        let next_m = (place_m - off_m / slope).clamp(from_m, to_m);
        let next_off_m = gap_m(next_m) - mean_m;
        slope = (next_off_m - off_m) / (next_m - place_m);
        (place_m, off_m) = (next_m, next_off_m);
    }
    (place_m, mean_m)
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
        let springs = self.offset_m.iter().zip(&self.width_m);
        for (force, (offset, width_m)) in force.iter_mut().zip(springs) {
            *force = ((approach_m - offset) / compliance).max(0.0);
            sum += *force * width_m;
        }
        self.approach_m = approach_m;
        Ok(Solution {
            load_n: 2.0 * sum,
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
        let contact = in_contact(force);
        if contact == 0 {
            return Ok(Some(0.0));
        }
        self.fill_slopes(force, contact, solution.contact_radius_m);
        Ok(Some(
            self.largest_pressure(contact, solution.contact_radius_m),
        ))
    }

    fn pressure_lines(&self, force: &[f64], solution: &Solution) -> Vec<PressureLine> {
        let mut reported = Monotone::default();
        let force = reported.of(force, &self.width_m);
        vec![self.pressure_line(force, solution.contact_radius_m)]
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

    fn load_per_nodal_pressure(&self, node: usize) -> f64 {
        2.0 * self.width_m[node]
    }

    fn surface_density(&mut self, nodal: &[f64], radius_m: f64) -> Result<Surface, ContactError> {
        Ok(Surface::Radial(self.radial_density(nodal, radius_m)))
    }

    fn surface(&mut self, response: &Response<'_>) -> Result<Surface, ContactError> {
        let mut reported = Monotone::default();
        let response = Response {
            pressure: reported.of(response.pressure, &self.width_m),
            ..*response
        };
        Ok(Surface::Radial(self.radial_surface(&response)))
    }

    fn field(&mut self, response: &Response<'_>, grid: &Grid) -> Result<Surface, ContactError> {
        let mut reported = Monotone::default();
        let response = Response {
            pressure: reported.of(response.pressure, &self.width_m),
            ..*response
        };
        Ok(Surface::Cells(self.revolved_surface(&response, grid)))
    }
}

/// Number of springs up to the last in contact.
fn in_contact(force: &[f64]) -> usize {
    force.iter().rposition(|&f| f > 0.0).map_or(0, |i| i + 1)
}

/// Over the values below a bound, the sum of value times weight, and that of the weights. In lanes, without branches: this is
/// the engine's innermost loop.
fn sum_below(values: &[f64], weights: &[f64], bound: f64) -> (f64, f64) {
    const LANES: usize = 8;
    let (mut sums, mut totals) = ([0.0; LANES], [0.0; LANES]);
    let (values, values_left) = values.as_chunks::<LANES>();
    let (weights, weights_left) = weights.as_chunks::<LANES>();
    for (values, weights) in values.iter().zip(weights) {
        for lane in 0..LANES {
            let weight = if values[lane] < bound {
                weights[lane]
            } else {
                0.0
            };
            sums[lane] += weight * values[lane];
            totals[lane] += weight;
        }
    }
    let left = values_left.iter().zip(weights_left);
    let below = left.filter(|(value, _)| **value < bound);
    let start = (sums.iter().sum::<f64>(), totals.iter().sum::<f64>());
    below.fold(start, |(sum, total), (value, weight)| {
        (sum + weight * value, total + weight)
    })
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

/// sqrt(x_i^2 - r^2) for r = 0, x_0, x_1, ... and i from the spring at r on.
fn root_table(position_m: &[f64]) -> Vec<f64> {
    let springs = position_m.len();
    let mut table = Vec::with_capacity(springs + springs * (springs + 1) / 2);
    table.extend(position_m);
    for (k, r_m) in position_m.iter().enumerate() {
        // No digits lost.
        table.extend(
            position_m[k..]
                .iter()
                .map(|x_m| ((x_m - r_m) * (x_m + r_m)).sqrt()),
        );
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn springs_in_contact_carry_the_integral_of_their_forces_however_few_they_are() {
        // A paraboloid, G = x^2 / R, in contact up to the end of a spring: W = 2/C (delta a - a^3 / (3 R)), delta = a^2 / R.
        let (radius_m, half_width_m, compliance_per_pa) = (0.01, 1e-3, 1e-9);
        let exact_n =
            4.0 / 3.0 * half_width_m * half_width_m * half_width_m / radius_m / compliance_per_pa;
        for (first, second) in [(1, 1), (3, 5), (40, 7)] {
            let evenly = |from: f64, to: f64, count: usize| {
                (0..count).map(move |i| from + (to - from) * i as f64 / count as f64)
            };
            let places_m: Vec<f64> = evenly(0.0, 0.7, first)
                .chain(evenly(0.7, 1.0, second))
                .chain([1.0, 1.2])
                .map(|place| half_width_m * place)
                .collect();
            let gap_m = |x_m: f64| x_m * x_m / radius_m;
            let mut springs = Axisymmetric::between(&places_m, gap_m, Edge::Open, true);
            let nodes = springs.nodes();
            let mut force = vec![0.0; nodes];
            let instant = Instant {
                prescribed: Prescribed::ApproachM(half_width_m * half_width_m / radius_m),
                compliance_per_pa,
                history: &vec![0.0; nodes],
            };
            let found = springs.solve(&instant, &mut force).unwrap();
            // Rounding.
            assert!(
                (found.load_n / exact_n - 1.0).abs() < 1e-13,
                "{first} {second}"
            );
        }
    }

    #[test]
    fn a_spring_stands_where_the_gap_is_its_mean() {
        for exponent in [1, 2, 5] {
            let gap_m = |x: f64| x.powi(exponent);
            let (place_m, mean_m) = place_of_mean(1.0, 1.1, gap_m);
            let whole = 1.1_f64.powi(exponent + 1) - 1.0;
            // Gauss' rule of three points is exact up to the fifth power.
            assert!((mean_m / (whole / (0.1 * f64::from(exponent + 1))) - 1.0).abs() < 1e-13);
            assert!((gap_m(place_m) / mean_m - 1.0).abs() < 1e-13, "{exponent}");
        }
        // From the axis on, where a paraboloid is flat.
        let (place_m, _) = place_of_mean(0.0, 1.0, |x| x * x);
        assert!((place_m - 1.0 / 3.0_f64.sqrt()).abs() < 1e-13);
        assert_eq!(place_of_mean(0.0, 1.0, |_| 0.0), (0.5, 0.0));
    }
}
