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

mod abel;
pub mod layer;

use multiversion::multiversion;

use super::half_space::grid::Grid;
use super::surface::{PressureLine, Response, Surface};
use super::{ContactError, Engine, Instant, Prescribed, Solution, sums};
use abel::Roots;

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
    /// For the inverse Abel transform.
    roots: Roots,
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
            roots: Roots::new(springs),
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

    /// Approach under a load, the load that the forces then carry, and the passes that took: the root of
    /// W(delta) = (2/A) * sum of dx max(0, delta - offset), which is convex and piecewise linear, so that Newton's method ends
    /// exactly after finitely many passes from any start: where the springs in contact stay the same.
    fn press_by(
        &self,
        load_n: f64,
        compliance_per_pa: f64,
        force: &mut [f64],
    ) -> Result<(f64, f64, usize), ContactError> {
        let target = 0.5 * load_n * compliance_per_pa;
        if target <= 0.0 {
            let lowest_m = sums::least(&self.offset_m);
            let (load_n, _) = self.press_to(lowest_m, compliance_per_pa, force);
            return Ok((lowest_m, load_n, 0));
        }
        let most = self.offset_m.len() + 2;
        let mut approach_m = self.approach_m;
        let mut pass = 1;
        loop {
            let [width_m, sum] = of_springs_below(&self.offset_m, &self.width_m, approach_m);
            let next_m = match width_m > 0.0 {
                true => (target + sum) / width_m,
                false => sums::least(&self.offset_m) + target / self.end_m(),
            };
            let is_same = next_m == approach_m;
            // The first pass mostly finds that other springs are in contact than an instant ago.
            if is_same || pass > 1 {
                let (carried_n, pressed_m) = self.press_to(next_m, compliance_per_pa, force);
                let residual = (carried_n / load_n - 1.0).abs();
                // A spring at the very edge may count as in contact in every other pass, by rounding.
                let ends = pressed_m == width_m && next_m.is_finite();
                if ends || (pass >= most && residual <= ROUNDING) {
                    return Ok((next_m, carried_n, pass + usize::from(!is_same)));
                }
                if pass >= most {
                    return Err(ContactError::NotConverged {
                        iterations: pass,
                        residual,
                        tolerance: ROUNDING,
                    });
                }
            }
            approach_m = next_m;
            pass += 1;
        }
    }

    /// Writes the forces at an approach; the load they carry, and the width of the springs in contact.
    fn press_to(&self, approach_m: f64, compliance_per_pa: f64, force: &mut [f64]) -> (f64, f64) {
        let pressed = (approach_m, compliance_per_pa.recip());
        let [sum, width_m] = press(&self.offset_m, &self.width_m, pressed, force);
        (2.0 * sum, width_m)
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

/// What rounding leaves of a load in a sum over springs, relative.
const ROUNDING: f64 = 1e-10;

impl Engine for Axisymmetric {
    fn gap_m(&self) -> &[f64] {
        &self.gap_m
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
        let (approach_m, load_n, iterations) = match instant.prescribed.check()? {
            Prescribed::LoadN(load_n) => self.press_by(load_n, compliance, force)?,
            Prescribed::ApproachM(approach_m) => {
                let (load_n, _) = self.press_to(approach_m, compliance, force);
                (approach_m, load_n, 1)
            }
        };
        self.approach_m = approach_m;
        Ok(Solution {
            load_n,
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
        let largest_pa = self.largest_pressure_pa(&force[..contact], solution.contact_radius_m);
        Ok(Some(largest_pa))
    }

    fn pressure_lines(&self, force: &[f64], solution: &Solution) -> Vec<PressureLine> {
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

    fn work(&self, force: &[f64], displacement: &[f64]) -> f64 {
        2.0 * sum_of_products(&self.width_m, force, displacement)
    }

    fn surface_density(&mut self, nodal: &[f64], radius_m: f64) -> Result<Surface, ContactError> {
        Ok(Surface::Radial(self.radial_density(nodal, radius_m)))
    }

    fn surface(&mut self, response: &Response<'_>) -> Result<Surface, ContactError> {
        Ok(Surface::Radial(self.radial_surface(response)))
    }

    fn field(&mut self, response: &Response<'_>, grid: &Grid) -> Result<Surface, ContactError> {
        Ok(Surface::Cells(self.revolved_surface(response, grid)))
    }
}

/// Number of springs up to the last in contact.
fn in_contact(force: &[f64]) -> usize {
    force.iter().rposition(|&f| f > 0.0).map_or(0, |i| i + 1)
}

/// The width of the springs whose offset lies below an approach, and the sum of their widths times their offsets.
#[multiversion(targets("x86_64+avx2"))]
fn of_springs_below(offset: &[f64], width: &[f64], approach: f64) -> [f64; 2] {
    // One sum at a time: of two in one pass the compiler takes the lanes one by one.
    [
        sum_below(offset, width, approach, |_, width| width),
        sum_below(offset, width, approach, |offset, width| width * offset),
    ]
}

/// The sum of a term, of offset and width, over the springs whose offset lies below an approach.
#[inline(always)]
fn sum_below(offset: &[f64], width: &[f64], approach: f64, term: impl Fn(f64, f64) -> f64) -> f64 {
    let [sum] = sums::sums(offset, width, |offset, width| {
        let term = term(offset, width);
        [if offset < approach { term } else { 0.0 }]
    });
    sum
}

/// Writes (approach - offset) times the stiffness of springs whose offset lies below an approach, and 0 of the others; the sum of
/// these times the widths, and of the widths of those below.
#[multiversion(targets("x86_64+avx2"))]
fn press(
    offset: &[f64],
    width: &[f64],
    (approach, stiffness): (f64, f64),
    force: &mut [f64],
) -> [f64; 2] {
    for (force, offset) in force.iter_mut().zip(offset) {
        let elastic = (approach - offset) * stiffness;
        *force = if *offset < approach { elastic } else { 0.0 };
    }
    let [load] = sums::sums(force, width, |force, width| [force * width]);
    [load, sum_below(offset, width, approach, |_, width| width)]
}

/// The sum of a b c.
#[multiversion(targets("x86_64+avx2"))]
fn sum_of_products(a: &[f64], b: &[f64], c: &[f64]) -> f64 {
    sums::sum_over_triples(a, b, c, |a, b, c| a * b * c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_that_no_approach_carries_is_an_error_and_no_value() {
        let mut engine = Axisymmetric::new(1e-6, vec![0.0, 1e-6, 2e-6, 3e-6], Edge::Rim, true);
        let instant = Instant {
            history: &[f64::NAN; 4],
            compliance_per_pa: 1e-9,
            prescribed: Prescribed::LoadN(1.0),
        };
        let ended = engine.solve(&instant, &mut [0.0; 4]);
        assert!(
            matches!(ended, Err(ContactError::NotConverged { .. })),
            "{ended:?}"
        );
    }

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
