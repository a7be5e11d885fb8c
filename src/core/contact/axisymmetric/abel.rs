//! From springs back to the surface: pressure and displacement by the Abel transforms of the line force f and the shortening q of the
//! springs.
//!
//! ```text
//! p(r) = -(1/pi) * integral from r to a of f'(x) / sqrt(x^2 - r^2) dx  +  f(a) / (pi sqrt(a^2 - r^2))
//! u(r) =  (2/pi) * integral from 0 to r of q(x) / sqrt(r^2 - x^2) dx,       q = A f + H
//! ```
//!
//! The second is what makes a row of springs a half-space (V. L. Popov and M. Heß, Method of Dimensionality Reduction in
//! Contact Mechanics and Friction, 2015): inside the contact q = delta - G(x), which gives u = delta - g(r) back; outside it
//! the springs are free and q is what they have not yet recovered. Both hold for any history, since neither transform knows
//! of time. f(a) is above zero only at the rim of an indenter that ends there. Between springs f and q are linear in x^2,
//! which is exact for a paraboloid.
//!
//! From the second formula the gap outside the contact, g + u - delta, is the transform of G + q - delta, which is nowhere
//! negative there: no check of the gap is needed. None of the pressure either: see [`never_rising`].

use std::borrow::Cow;
use std::f64::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2};

use multiversion::multiversion;

use super::{Axisymmetric, Edge, in_contact};
use crate::contact::half_space::grid::Grid;
use crate::contact::sums;
use crate::contact::surface::{Along, CellSurface, PressureLine, RadialSurface, Response};
use crate::numerics::order::isotonic;

/// How far the profile reaches, in lengths of the row of springs.
const REACH: usize = 2;
/// Intervals of a line of pressure from the axis to the edge of the contact.
const LINE: usize = 64;
/// Below an apex the pressure goes with -ln(r), whose mean over a disc of radius R is its value at R exp(-1/2); the disc of the
/// area of a square has R = side / sqrt(pi).
const MEAN_RADIUS: f64 = 0.342_198_280_312_215_9;
const MEAN_DISTANCE: f64 = 0.183_939_720_585_721_16;
/// Springs from one to the next that the search for the largest pressure looks at first; a power of two. A peak between them would be
/// finer than the row of springs resolves.
const STRIDE: usize = 8;

/// Whether two radii are one but for rounding.
fn is_same(a_m: f64, b_m: f64) -> bool {
    /// Of the larger one.
    const ROUNDING: f64 = 1e-12;
    (a_m - b_m).abs() <= ROUNDING * a_m.max(b_m)
}

/// The line forces nearest to these, in the least squares, that do not rise outwards, for springs of these widths: those that are
/// reported. The load is that of the forces given.
///
/// Under any drive the springs of a body whose transformed gap G grows outwards carry forces that do not rise outwards, so that
/// the pressure is nowhere negative and the contact is a disc. With two springs x1 < x2, c = G(x2) - G(x1) > 0 and D the
/// difference of their shortenings: both in contact, D = c; only the inner one, D <= c; both free, D is a mean of its past and so
/// at most c. Were the inner spring the first to leave, D >= c would be at least its whole past, and
/// f1 - f2 = E(0) D + integral of E'(t-s) D(s) ds >= 0 (E >= 0 and E' <= 0 for any passive body): the outer one has left too.
///
/// Where steps are long beside the times in which the body relaxes, a spring that has just come into contact may be given a
/// force that is larger than that of its inner neighbour, by up to half of the largest force, since the rule of the time steps
/// does not know when within the step it was met. The next steps put it right, and the loss is not affected.
fn never_rising<'f>(force: &'f [f64], width_m: &[f64]) -> Cow<'f, [f64]> {
    match force.windows(2).all(|pair| pair[1] <= pair[0]) {
        true => Cow::Borrowed(force),
        false => Cow::Owned(isotonic(force, width_m, |inner, outer| inner < outer)),
    }
}

/// A function of x that is linear in x^2 between ascending places; inside the first one it goes on to the axis as the parabola of its
/// neighbours.
#[derive(Debug, Default)]
struct Segments {
    place_m: Vec<f64>,
    value: Vec<f64>,
    /// d/d(x^2) from each place to the next, in units of 1/m^2.
    slope_per_m2: Vec<f64>,
}

impl Segments {
    fn through(place_m: Vec<f64>, value: Vec<f64>) -> Self {
        fn pairs(all: &[f64]) -> impl Iterator<Item = (&f64, &f64)> {
            all.iter().zip(all.get(1..).unwrap_or_default())
        }
        let ends = pairs(&place_m).zip(pairs(&value));
        let slope = |((x0, x1), (f0, f1))| (f1 - f0) / ((x1 - x0) * (x1 + x0));
        Self {
            slope_per_m2: ends.map(slope).collect(),
            place_m,
            value,
        }
    }

    /// The value that a segment has at a place, were it continued so far.
    fn value_at(&self, segment: usize, x_m: f64) -> f64 {
        let from_m = self.place_m[segment];
        let squares_m2 = (x_m - from_m) * (x_m + from_m);
        self.value[segment] + self.slope_per_m2[segment] * squares_m2
    }

    /// Continues the last segment to a place beyond; a single value is the same everywhere.
    fn continue_to(&mut self, end_m: f64) {
        match self.slope_per_m2.len().checked_sub(1) {
            Some(last) => {
                self.value[last + 1] = self.value_at(last, end_m);
                self.place_m[last + 1] = end_m;
            }
            None => {
                self.place_m.extend(self.value.first().map(|_| end_m));
                self.slope_per_m2.extend(self.value.first().map(|_| 0.0));
                self.value.extend_from_within(..);
            }
        }
    }
}

/// sqrt(x^2 - r^2), without loss of digits; 0 inside r.
fn root_m(x_m: f64, r_m: f64) -> f64 {
    ((x_m - r_m).max(0.0) * (x_m + r_m)).sqrt()
}

/// What both transforms need at one instant.
struct Meridian<'a> {
    force: Segments,
    rim_force: f64,
    shortening: Segments,
    contact_radius_m: f64,
    singular_radii_m: &'a [f64],
}

impl Meridian<'_> {
    /// p(r) in Pa; `None` where it is unbounded.
    fn pressure_pa(&self, r_m: f64) -> Option<f64> {
        if r_m >= self.contact_radius_m {
            return Some(0.0);
        }
        if self.singular_radii_m.iter().any(|s_m| is_same(*s_m, r_m)) {
            return None;
        }
        let ends_m = self.force.place_m.get(1..).unwrap_or_default();
        let first = ends_m.partition_point(|end_m| *end_m <= r_m);
        let (mut smooth, mut inner) = (0.0, 0.0);
        let slopes = &self.force.slope_per_m2[first..];
        for (end_m, slope_per_m2) in ends_m[first..].iter().zip(slopes) {
            let outer = root_m(*end_m, r_m);
            smooth += slope_per_m2 * (outer - inner);
            inner = outer;
        }
        let rim = match self.rim_force > 0.0 {
            true => FRAC_1_PI * self.rim_force / root_m(self.contact_radius_m, r_m),
            false => 0.0,
        };
        // f'(x) = 2 x df/d(x^2), and the integral of x / sqrt(x^2 - r^2) is sqrt(x^2 - r^2).
        Some(rim - FRAC_2_PI * smooth)
    }

    /// u(r) in m.
    fn displacement_m(&self, r_m: f64) -> f64 {
        let shortening = &self.shortening;
        // Integrals of 1 / sqrt(r^2 - x^2) and x^2 / sqrt(r^2 - x^2) from 0 to x.
        let integrals = |x_m: f64| {
            let root = root_m(r_m, x_m);
            // As accurate near x = r as an arcsine is not.
            let angle = x_m.atan2(root);
            (angle, 0.5 * (r_m * r_m * angle - x_m * root))
        };
        let (mut sum, mut before) = (0.0, (0.0, 0.0));
        for (segment, slope_per_m2) in shortening.slope_per_m2.iter().enumerate() {
            let at_axis = shortening.value_at(segment, 0.0);
            if r_m == 0.0 {
                return at_axis;
            }
            let end_m = shortening.place_m[segment + 1];
            let after = integrals(end_m.min(r_m));
            sum += at_axis * (after.0 - before.0) + slope_per_m2 * (after.1 - before.1);
            before = after;
            if end_m >= r_m {
                break;
            }
        }
        FRAC_2_PI * sum
    }
}

/// The lengths sqrt(x^2 - r^2) for r at the axis and at every spring. They depend on the row of springs alone: those of one r are
/// computed when they are first asked for, and kept.
#[derive(Debug, Clone)]
pub(super) struct Roots(Vec<Vec<f64>>);

impl Roots {
    pub(super) fn new(springs: usize) -> Self {
        Self(vec![Vec::new(); springs + 1])
    }

    /// The radius (m) of a row, 0 at the axis and that of spring k in row k + 1; the segment that begins there; and the roots (m) at the
    /// ends of the segments from there on, the first of which is 0.
    fn of_row(&mut self, row: usize, position_m: &[f64]) -> (f64, usize, &[f64]) {
        let segment = row.saturating_sub(1);
        let r_m = if row == 0 { 0.0 } else { position_m[segment] };
        let roots_m = &mut self.0[row];
        if roots_m.is_empty() {
            let beyond = &position_m[segment + 1..];
            roots_m.push(0.0);
            roots_m.extend(beyond.iter().map(|x_m| root_m(*x_m, r_m)));
        }
        (r_m, segment, roots_m)
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
        let force = self.force_segments(&never_rising(force, &self.width_m), contact_radius_m);
        for (row, value) in pressure.iter_mut().enumerate().take(contact + 1) {
            *value = self.pressure_of_row(&force, row);
        }
        contact
    }

    /// The largest pressure (Pa) of these line forces (N/m), the last of which is not 0: sought among every eighth row, then uphill
    /// from the best of them in steps that halve.
    pub(super) fn largest_pressure_pa(&mut self, force: &[f64], contact_radius_m: f64) -> f64 {
        let last = force.len();
        let force = self.force_segments(&never_rising(force, &self.width_m), contact_radius_m);
        let steepest = -sums::least(&force.slope_per_m2);
        let mut best = (0, f64::NEG_INFINITY);
        let mut look = |row: usize, best: &mut (usize, f64)| {
            let r_m = if row == 0 {
                0.0
            } else {
                self.position_m[row - 1]
            };
            // No pressure exceeds that of the steepest slope everywhere.
            if FRAC_2_PI * steepest * root_m(contact_radius_m, r_m) < best.1 {
                return;
            }
            let value = self.pressure_of_row(&force, row);
            if value > best.1 {
                *best = (row, value);
            }
        };
        for row in (0..=last).step_by(STRIDE) {
            look(row, &mut best);
        }
        let mut step = STRIDE / 2;
        while step > 0 {
            let middle = best.0;
            for row in [middle.checked_sub(step), Some(middle + step)] {
                if let Some(row) = row.filter(|row| *row <= last) {
                    look(row, &mut best);
                }
            }
            step /= 2;
        }
        best.1
    }

    /// The bounded pressure (Pa) at the axis (row 0) or at a spring in contact (row k + 1).
    fn pressure_of_row(&mut self, force: &Segments, row: usize) -> f64 {
        let (r_m, first, roots_m) = self.roots.of_row(row, &self.position_m);
        let slopes = &force.slope_per_m2[first..];
        let Some((&slope_at_edge, inner)) = slopes.split_last() else {
            return 0.0;
        };
        let ends_m = (&roots_m[..inner.len()], &roots_m[1..=inner.len()]);
        let smooth = sum_of_spans(inner, ends_m.0, ends_m.1);
        let at_edge_m = force.place_m.last().map_or(0.0, |x_m| root_m(*x_m, r_m));
        -FRAC_2_PI * (smooth + slope_at_edge * (at_edge_m - roots_m[inner.len()]))
    }

    /// Pressure and displacement at the axis, at every spring, and as far again beyond the row.
    pub(super) fn radial_surface(&self, response: &Response<'_>) -> RadialSurface {
        let radius_m = self.radii_m();
        let meridian = self.meridian(response);
        RadialSurface {
            pressure_pa: radius_m.iter().map(|&r| meridian.pressure_pa(r)).collect(),
            displacement_m: (radius_m.iter())
                .map(|&r| meridian.displacement_m(r))
                .collect(),
            radius_m,
        }
    }

    /// What adds up over the springs like a line force (per metre), as it lies on the same radii: a pressure that moves nothing.
    pub(super) fn radial_density(&self, nodal: &[f64], radius_m: f64) -> RadialSurface {
        let radii_m = self.radii_m();
        let meridian = self.meridian_of_force(nodal, radius_m);
        RadialSurface {
            pressure_pa: radii_m.iter().map(|&r| meridian.pressure_pa(r)).collect(),
            displacement_m: vec![0.0; radii_m.len()],
            radius_m: radii_m,
        }
    }

    /// The axis, every spring, and as far again beyond the row (m).
    fn radii_m(&self) -> Vec<f64> {
        let (springs, end_m) = (self.gap_m.len(), self.end_m());
        let beyond =
            (0..(REACH - 1) * springs).map(|i| end_m * (1.0 + (i as f64 + 0.5) / springs as f64));
        std::iter::once(0.0)
            .chain(self.position_m.iter().copied())
            .chain(beyond)
            .collect()
    }

    /// The pressure from the axis to the edge of the contact, the axis alone out of contact. Places a sin(pi k / 2n), which are
    /// evenly spread along a pressure that falls to the edge as that of Hertz does; even ones where a rim bounds the contact, at
    /// which the pressure grows beyond all bounds.
    pub(super) fn pressure_line(&self, force: &[f64], contact_radius_m: f64) -> PressureLine {
        let force = &*never_rising(force, &self.width_m);
        let ends_at_a_rim = self.edge == Edge::Rim && force.last().is_some_and(|&f| f > 0.0);
        let meridian = self.meridian_of_force(force, contact_radius_m);
        let intervals = if contact_radius_m > 0.0 { LINE } else { 0 };
        let place_m = |k: usize| {
            let part = k as f64 / LINE as f64;
            contact_radius_m
                * match ends_at_a_rim {
                    true => part,
                    false => (FRAC_PI_2 * part).sin(),
                }
        };
        let position_m: Vec<f64> = (0..=intervals).map(place_m).collect();
        let pressure_pa = |&r_m: &f64| match ends_at_a_rim && r_m >= contact_radius_m {
            true => None,
            false => meridian.pressure_pa(r_m),
        };
        PressureLine {
            along: Along::Radius,
            pressure_pa: position_m.iter().map(pressure_pa).collect(),
            position_m,
        }
    }

    /// Pressure and displacement at the centres of cells. A cell about an apex has its mean pressure, the rest the pressure at
    /// the centre.
    pub(super) fn revolved_surface(&self, response: &Response<'_>, grid: &Grid) -> CellSurface {
        let meridian = self.meridian(response);
        let mean_radius_m = MEAN_RADIUS * grid.cell_area_m2().sqrt();
        let cells = 0..grid.cells();
        let mut places: Vec<(f64, usize)> = cells
            .map(|cell| {
                let (x_m, y_m) = grid.center(cell);
                (x_m.hypot(y_m), cell)
            })
            .collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut surface = CellSurface {
            grid: *grid,
            pressure_pa: vec![0.0; grid.cells()],
            displacement_m: vec![0.0; grid.cells()],
        };
        // Cells at equal distance from the axis, eight of them mostly, share one evaluation.
        for ring in places.chunk_by(|a, b| a.0 == b.0) {
            let Some(&(r_m, _)) = ring.first() else {
                continue;
            };
            let pressure_pa = meridian
                .pressure_pa(r_m)
                .or_else(|| match r_m > 0.0 {
                    // About an edge it goes with -ln of the distance, whose mean over a width h is that at h/(2 e).
                    true => meridian.pressure_pa(r_m + MEAN_DISTANCE * grid.cell_area_m2().sqrt()),
                    false => meridian.pressure_pa(mean_radius_m),
                })
                .unwrap_or(0.0);
            let displacement_m = meridian.displacement_m(r_m);
            for &(_, cell) in ring {
                surface.pressure_pa[cell] = pressure_pa;
                surface.displacement_m[cell] = displacement_m;
            }
        }
        surface
    }

    fn meridian(&self, response: &Response<'_>) -> Meridian<'_> {
        let response = Response {
            pressure: &never_rising(response.pressure, &self.width_m),
            ..*response
        };
        Meridian {
            shortening: self.shortening_segments(&response),
            ..self.meridian_of_force(response.pressure, response.contact_radius_m)
        }
    }

    /// The same for the pressure alone.
    fn meridian_of_force(&self, force: &[f64], contact_radius_m: f64) -> Meridian<'_> {
        let force = self.force_segments(force, contact_radius_m);
        Meridian {
            rim_force: match (self.edge, force.value.last()) {
                (Edge::Rim, Some(&at_edge)) => at_edge.max(0.0),
                _ => 0.0,
            },
            force,
            shortening: Segments::default(),
            contact_radius_m,
            singular_radii_m: &self.singular_radii_m,
        }
    }

    /// The line force from the axis to the edge of the contact, where it falls to zero; at a rim it goes on as before, to a force that
    /// is not zero.
    fn force_segments(&self, force: &[f64], contact_radius_m: f64) -> Segments {
        let Some(last) = in_contact(force).checked_sub(1) else {
            return Segments::default();
        };
        // With room for the edge.
        let up_to_last = |all: &[f64]| {
            let mut values = Vec::with_capacity(last + 2);
            values.extend_from_slice(&all[..=last]);
            values
        };
        let (mut place_m, mut value) = (up_to_last(&self.position_m), up_to_last(force));
        if self.edge == Edge::Rim && last + 1 == self.position_m.len() {
            let mut segments = Segments::through(place_m, value);
            segments.continue_to(contact_radius_m);
            return segments;
        }
        if contact_radius_m > self.position_m[last] {
            place_m.push(contact_radius_m);
            value.push(0.0);
        }
        Segments::through(place_m, value)
    }

    /// The shortening q = A f + H of the springs, from the axis to the end of the row, with a node at the edge of the
    /// contact, where it has a kink.
    fn shortening_segments(&self, response: &Response<'_>) -> Segments {
        let edge_m = response.contact_radius_m;
        let elastic = response.pressure.iter().zip(response.history);
        let elastic = elastic.map(|(f, history)| response.compliance_per_pa * f + history);
        let (mut place_m, mut value) = (self.position_m.clone(), elastic.collect::<Vec<f64>>());
        let beyond = place_m.partition_point(|x_m| *x_m < edge_m);
        if (1..place_m.len()).contains(&beyond)
            && edge_m < place_m[beyond]
            && response.pressure[beyond] == 0.0
        {
            let ends = beyond - 1..=beyond;
            let (ends_m, history) = (&place_m[ends.clone()], &response.history[ends]);
            let remembered = Segments::through(ends_m.to_vec(), history.to_vec());
            place_m.insert(beyond, edge_m);
            value.insert(beyond, remembered.value_at(0, edge_m));
        }
        // Below an apex the shortening has a kink: it goes on straight, not as a parabola.
        if self.singular_radii_m.contains(&0.0)
            && let ([inner_m, outer_m, ..], [inner, outer, ..]) = (&place_m[..], &value[..])
        {
            let at_axis = inner - (outer - inner) / (outer_m - inner_m) * inner_m;
            place_m.insert(0, 0.0);
            value.insert(0, at_axis);
        }
        let mut segments = Segments::through(place_m, value);
        if self.edge == Edge::Rim {
            segments.continue_to(self.end_m());
        }
        segments
    }
}

/// The sum of s (to - from).
#[multiversion(targets("x86_64+avx2"))]
fn sum_of_spans(s: &[f64], from: &[f64], to: &[f64]) -> f64 {
    sums::sum_over_triples(s, from, to, |s, from, to| s * (to - from))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::contact::surface::Surface;
    use crate::contact::{Engine, Instant, Prescribed, Solution};
    use crate::reference::elastic::Hertz;

    const HERTZ: Hertz = Hertz {
        radius_m: 0.01,
        load_n: 10.0,
        compliance_per_pa: 4e-10,
    };

    fn row(
        springs: usize,
        half_width_m: f64,
        gap: &dyn Fn(f64) -> f64,
        edge: Edge,
    ) -> Axisymmetric {
        let width_m = half_width_m / springs as f64;
        let gaps = (0..springs).map(|i| gap((i as f64 + 0.5) * width_m));
        let bounded = edge == Edge::Open && gap(1e-9) < 1e-12;
        Axisymmetric::new(width_m, gaps.collect(), edge, bounded)
    }

    /// The surface of an elastic contact, with its solution.
    fn elastic(engine: &mut Axisymmetric, load_n: f64) -> (RadialSurface, Solution) {
        let history = vec![0.0; engine.nodes()];
        let mut force = history.clone();
        let instant = Instant {
            history: &history,
            compliance_per_pa: HERTZ.compliance_per_pa,
            prescribed: Prescribed::LoadN(load_n),
        };
        let solution = engine.solve(&instant, &mut force).unwrap();
        let response = Response {
            pressure: &force,
            history: &history,
            compliance_per_pa: HERTZ.compliance_per_pa,
            contact_radius_m: solution.contact_radius_m,
        };
        match engine.surface(&response).unwrap() {
            Surface::Radial(surface) => (surface, solution),
            Surface::Cells(_) => panic!("not a radius"),
        }
    }

    #[test]
    fn a_sphere_displaces_the_surface_as_hertz_says_inside_and_outside_the_contact() {
        let a = HERTZ.contact_radius_m();
        let error = |springs: usize| {
            let mut engine = row(springs, 1.3 * a, &|x| x * x / 0.01, Edge::Open);
            let (surface, _) = elastic(&mut engine, HERTZ.load_n);
            let points = surface.radius_m.iter().zip(&surface.displacement_m);
            let off = points.map(|(&r, &u)| (u - HERTZ.displacement_m(r)).abs());
            assert!(*surface.radius_m.last().unwrap() > 2.5 * a);
            off.fold(0.0, f64::max) / HERTZ.approach_m()
        };
        // The contact edge is found to second order in the spring width; all else is exact for a paraboloid.
        assert!(error(100) < 2e-5, "{:e}", error(100));
        assert!(error(800) < 2e-5 / 30.0, "{:e}", error(800));
    }

    #[test]
    fn a_sphere_presses_as_hertz_says_and_not_outside() {
        let a = HERTZ.contact_radius_m();
        let mut engine = row(400, 1.3 * a, &|x| x * x / 0.01, Edge::Open);
        let (surface, solution) = elastic(&mut engine, HERTZ.load_n);
        for (&r, &p) in surface.radius_m.iter().zip(&surface.pressure_pa) {
            let off = p.unwrap() - HERTZ.pressure_pa(r);
            // At the edge the pressure falls like a root, so that its error is the root of that of the edge.
            assert!(off.abs() < 4e-3 * HERTZ.peak_pressure_pa(), "{r} {off}");
            assert!(r < solution.contact_radius_m || p == Some(0.0));
        }
    }

    #[test]
    fn a_flat_punch_presses_like_the_inverse_root_and_displaces_like_an_arcsine() {
        let a = 1e-3;
        let mut engine = row(300, a, &|_| 0.0, Edge::Rim);
        let (surface, solution) = elastic(&mut engine, 10.0);
        for ((&r, p), &u) in surface
            .radius_m
            .iter()
            .zip(&surface.pressure_pa)
            .zip(&surface.displacement_m)
        {
            // Johnson, Contact Mechanics, section 3.6. Nothing is discretised here but rounding.
            let (pressure, displacement) = if r < a {
                let root = ((a - r) * (a + r)).sqrt();
                (10.0 / (2.0 * PI * a * root), solution.approach_m)
            } else {
                (0.0, solution.approach_m * (a / r).asin() / FRAC_PI_2)
            };
            assert!((p.unwrap() - pressure).abs() <= 1e-10 * pressure);
            assert!((u / displacement - 1.0).abs() < 1e-10, "{r}: {u}");
        }
    }

    #[test]
    fn a_cone_presses_like_an_inverse_hyperbolic_cosine_unbounded_at_its_apex() {
        let slope = 0.1;
        let gap = |x: f64| FRAC_PI_2 * x * slope;
        let mut engine = row(400, 6e-4, &gap, Edge::Open);
        let (surface, solution) = elastic(&mut engine, 40.0);
        let a = solution.contact_radius_m;
        assert_eq!(surface.pressure_pa[0], None);
        // u = delta - g inside the contact; at the apex itself exactly.
        assert!((surface.displacement_m[0] / solution.approach_m - 1.0).abs() < 1e-12);
        for (&r, &u) in surface.radius_m.iter().zip(&surface.displacement_m) {
            let off = u - (solution.approach_m - slope * r);
            assert!(
                r > a || off.abs() < 1e-3 * solution.approach_m,
                "{r}: {off:e}"
            );
        }
        for (&r, p) in surface.radius_m.iter().zip(&surface.pressure_pa).skip(12) {
            if r < 0.95 * a {
                // Love and Sneddon: p = slope acosh(a/r) / (2 C).
                let exact = slope * (a / r).acosh() / (2.0 * HERTZ.compliance_per_pa);
                // A force straight in x is taken straight in x^2, beside a kernel unbounded at x = r: of order (dx/r)^(3/2).
                assert!((p.unwrap() / exact - 1.0).abs() < 2.5e-3, "{r}");
            }
        }
    }

    #[test]
    fn what_springs_have_not_recovered_is_displacement_without_pressure() {
        // q = q0 (1 - x^2/b^2) inside b, as a released body holds it: the same as under Hertz pressure.
        let (b, q0) = (1e-3, 1e-5);
        let engine = row(500, 1.2 * b, &|x| x * x / 0.01, Edge::Open);
        let history: Vec<f64> = (0..500)
            .map(|i| (q0 * (1.0 - (engine.position_m(i) / b).powi(2))).max(0.0))
            .collect();
        let response = Response {
            pressure: &vec![0.0; 500],
            history: &history,
            compliance_per_pa: 1e-9,
            contact_radius_m: 0.0,
        };
        let surface = engine.radial_surface(&response);
        assert!(surface.pressure_pa.iter().all(|p| *p == Some(0.0)));
        let hertz = |r: f64| {
            let ratio = r / b;
            if ratio <= 1.0 {
                return q0 * (1.0 - 0.5 * ratio * ratio);
            }
            let bracket =
                (2.0 - ratio * ratio) * ratio.recip().asin() + (ratio * ratio - 1.0).sqrt();
            q0 / PI * bracket
        };
        for (&r, &u) in surface.radius_m.iter().zip(&surface.displacement_m) {
            // The kink at b lies between two springs, beside a kernel that is unbounded at x = r: order 3/2 in their width.
            assert!((u - hertz(r)).abs() < 2e-5 * q0, "{r}: {u} {}", hertz(r));
        }
    }

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

    #[test]
    fn forces_that_fall_stay_and_a_rise_is_levelled_without_changing_the_load() {
        let falling = [5.0, 3.0, 3.0, 0.5, 0.0];
        assert_eq!(never_rising(&falling, &[1.0; 5]).as_ref(), falling);
        let rising = [5.0, 2.0, 4.0, 3.5, 0.0];
        let widths = [1.0, 1.0, 1.0, 2.0, 1.0];
        // 2 and 4 and twice 3.5: the mean of the three blocks is 3.25.
        assert_eq!(
            never_rising(&rising, &widths).as_ref(),
            [5.0, 3.25, 3.25, 3.25, 0.0]
        );
        let load = |force: &[f64]| -> f64 { force.iter().zip(&widths).map(|(f, w)| f * w).sum() };
        let found = load(&never_rising(&rising, &widths));
        assert!((found - load(&rising)).abs() < 1e-14);
    }
}
