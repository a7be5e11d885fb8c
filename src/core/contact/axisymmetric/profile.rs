//! From springs back to the surface: pressure and displacement along a radius, and whether the contact is a disc at all.
//!
//! ```text
//! p(r) = -(1/pi) * integral from r to a of f'(x) / sqrt(x^2 - r^2) dx  +  f(a) / (pi sqrt(a^2 - r^2))
//! u(r) =  (2/pi) * integral from 0 to r of q(x) / sqrt(r^2 - x^2) dx,       q = A f + H
//! ```
//!
//! The second is what makes a row of springs a half-space (V. L. Popov and M. Heß, Method of Dimensionality Reduction in
//! Contact Mechanics and Friction, 2015): inside the contact q = delta - G(x), which gives u = delta - g(r) back; outside it
//! the springs are free and q is what they have not yet recovered. Both hold for any history, since neither transform knows
//! of time. f(a) is above zero only at the rim of an indenter that ends there. Between nodes f and q are linear in x^2,
//! which is exact for a paraboloid.
//!
//! From the second formula the gap outside the contact, g + u - delta, is the transform of G + q - delta, which is nowhere
//! negative there: no check of the gap is needed. None of the pressure either: see [`super::monotone`].

use std::f64::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2};

use super::{Axisymmetric, Edge, Monotone};
use crate::contact::half_space::grid::Grid;
use crate::contact::surface::{Along, CellSurface, PressureLine, RadialSurface, Response};

/// How far the profile reaches, in lengths of the row of springs.
const REACH: usize = 2;
/// Intervals of a line of pressure from the axis to the edge of the contact.
const LINE: usize = 64;
/// Below an apex the pressure goes with -ln(r), whose mean over a disc of radius R is its value at R exp(-1/2); the disc of the
/// area of a square has R = side / sqrt(pi).
const MEAN_RADIUS: f64 = 0.342_198_280_312_215_9;
const MEAN_DISTANCE: f64 = 0.183_939_720_585_721_16;
/// Differences of lengths below this part of them are rounding.
const ROUNDING: f64 = 1e-12;

/// Whether two radii are one but for rounding.
fn is_same(a_m: f64, b_m: f64) -> bool {
    (a_m - b_m).abs() <= ROUNDING * a_m.max(b_m)
}

/// A function linear in x^2 between x_k and x_k+1: the slope d/d(x^2), in units of 1/m^2.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    from_m: f64,
    to_m: f64,
    /// Value at the axis, were the stretch continued so far.
    at_axis: f64,
    slope_per_m2: f64,
}

impl Stretch {
    fn between((from_m, from): (f64, f64), (to_m, to): (f64, f64)) -> Self {
        let slope_per_m2 = (to - from) / ((to_m - from_m) * (to_m + from_m));
        Self {
            from_m,
            to_m,
            at_axis: from - slope_per_m2 * from_m * from_m,
            slope_per_m2,
        }
    }

    fn value(&self, x_m: f64) -> f64 {
        self.at_axis + self.slope_per_m2 * x_m * x_m
    }
}

/// What both transforms need at one instant.
struct Meridian {
    force: Vec<Stretch>,
    rim_force: f64,
    shortening: Vec<Stretch>,
    contact_radius_m: f64,
    singular_radii_m: Vec<f64>,
}

impl Meridian {
    /// p(r) in Pa; `None` where it is unbounded.
    fn pressure_pa(&self, r_m: f64) -> Option<f64> {
        if r_m >= self.contact_radius_m {
            Some(0.0)
        } else if self.singular_radii_m.iter().any(|s_m| is_same(*s_m, r_m)) {
            None
        } else {
            Some(pressure_pa(
                &self.force,
                self.rim_force,
                self.contact_radius_m,
                r_m,
            ))
        }
    }
}

impl Axisymmetric {
    /// Pressure and displacement at the axis, at every spring, and as far again beyond the row.
    pub(super) fn radial_surface(&self, response: &Response<'_>) -> RadialSurface {
        let radius_m = self.radii_m();
        let meridian = self.meridian(response);
        RadialSurface {
            pressure_pa: radius_m.iter().map(|&r| meridian.pressure_pa(r)).collect(),
            displacement_m: radius_m
                .iter()
                .map(|&r| displacement_m(&meridian.shortening, r))
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
        let mut reported = Monotone::default();
        let force = reported.of(force, &self.width_m);
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
            let displacement_m = displacement_m(&meridian.shortening, r_m);
            for &(_, cell) in ring {
                surface.pressure_pa[cell] = pressure_pa;
                surface.displacement_m[cell] = displacement_m;
            }
        }
        surface
    }

    fn meridian(&self, response: &Response<'_>) -> Meridian {
        let mut reported = Monotone::default();
        let response = Response {
            pressure: reported.of(response.pressure, &self.width_m),
            ..*response
        };
        Meridian {
            shortening: self.shortening_stretches(&response),
            ..self.meridian_of_force(response.pressure, response.contact_radius_m)
        }
    }

    /// The same for the pressure alone.
    fn meridian_of_force(&self, force: &[f64], contact_radius_m: f64) -> Meridian {
        let force = self.force_stretches(force, contact_radius_m);
        Meridian {
            rim_force: self.rim_force(&force, contact_radius_m),
            force,
            shortening: Vec::new(),
            contact_radius_m,
            singular_radii_m: self.singular_radii_m.clone(),
        }
    }

    /// An apex makes the pressure unbounded at the axis.
    fn is_singular_at_the_axis(&self) -> bool {
        self.singular_radii_m.contains(&0.0)
    }

    /// The line force from the axis to the edge of the contact.
    fn force_stretches(&self, force: &[f64], contact_radius_m: f64) -> Vec<Stretch> {
        let Some(last) = force.iter().rposition(|&f| f > 0.0) else {
            return Vec::new();
        };
        let node = |i: usize| (self.position_m(i), force[i]);
        let mut stretches = Vec::with_capacity(last + 2);
        stretches.extend((0..last).map(|i| Stretch::between(node(i), node(i + 1))));
        // The last stretch falls to zero at the edge; at a rim it goes on as before, to a force that is not zero.
        let full_face = self.edge == Edge::Rim && last + 1 == force.len();
        let (x_m, f) = node(last);
        if full_face {
            let before = stretches.last().copied();
            stretches.push(before.map_or(
                Stretch {
                    from_m: x_m,
                    to_m: contact_radius_m,
                    at_axis: f,
                    slope_per_m2: 0.0,
                },
                |before| Stretch {
                    from_m: x_m,
                    to_m: contact_radius_m,
                    ..before
                },
            ));
        } else if contact_radius_m > x_m {
            stretches.push(Stretch::between((x_m, f), (contact_radius_m, 0.0)));
        }
        continued_to_the_axis(&mut stretches);
        stretches
    }

    /// The force at the edge of the contact (N/m), above zero only at a rim.
    fn rim_force(&self, force: &[Stretch], contact_radius_m: f64) -> f64 {
        match (self.edge, force.last()) {
            (Edge::Rim, Some(last)) => last.value(contact_radius_m).max(0.0),
            _ => 0.0,
        }
    }

    /// The shortening q = A f + H of the springs, from the axis to the end of the row, with a node at the edge of the
    /// contact, where it has a kink.
    fn shortening_stretches(&self, response: &Response<'_>) -> Vec<Stretch> {
        let springs = self.gap_m.len();
        let edge_m = response.contact_radius_m;
        let mut nodes = Vec::with_capacity(springs + 2);
        for spring in 0..springs {
            let elastic = response.compliance_per_pa * response.pressure[spring];
            let node = (self.position_m(spring), elastic + response.history[spring]);
            if let Some(&(before_m, _)) = nodes.last()
                && before_m < edge_m
                && edge_m < node.0
                && response.pressure[spring] == 0.0
            {
                let remembered = Stretch::between(
                    (before_m, response.history[spring - 1]),
                    (node.0, response.history[spring]),
                );
                nodes.push((edge_m, remembered.value(edge_m)));
            }
            nodes.push(node);
        }
        if self.is_singular_at_the_axis()
            && let [(inner_m, inner), (outer_m, outer), ..] = nodes[..]
        {
            // Below an apex the shortening has a kink: it goes on straight, not as a parabola.
            let slope = (outer - inner) / (outer_m - inner_m);
            nodes.insert(0, (0.0, inner - slope * inner_m));
        }
        let mut stretches: Vec<Stretch> = nodes
            .windows(2)
            .map(|pair| Stretch::between(pair[0], pair[1]))
            .collect();
        if let (Edge::Rim, Some(&last)) = (self.edge, stretches.last()) {
            stretches.push(Stretch {
                from_m: last.to_m,
                to_m: self.end_m(),
                ..last
            });
        }
        continued_to_the_axis(&mut stretches);
        stretches
    }
}

/// Inside the first spring the function goes on as the parabola of its neighbours.
fn continued_to_the_axis(stretches: &mut Vec<Stretch>) {
    if let Some(&first) = stretches.first()
        && first.from_m > 0.0
    {
        let inner = Stretch {
            from_m: 0.0,
            to_m: first.from_m,
            ..first
        };
        stretches.insert(0, inner);
    }
}

/// p(r) in Pa inside a contact of this radius, from the line force in N/m.
fn pressure_pa(force: &[Stretch], rim_force: f64, contact_radius_m: f64, r_m: f64) -> f64 {
    let root = |x_m: f64| ((x_m - r_m).max(0.0) * (x_m + r_m)).sqrt();
    let (mut smooth, mut inner) = (0.0, 0.0);
    // One stretch begins where the last ended, the first of these before r.
    for stretch in &force[force.partition_point(|stretch| stretch.to_m <= r_m)..] {
        let outer = root(stretch.to_m);
        smooth += stretch.slope_per_m2 * (outer - inner);
        inner = outer;
    }
    let rim = if rim_force > 0.0 {
        FRAC_1_PI * rim_force / root(contact_radius_m)
    } else {
        0.0
    };
    // f'(x) = 2 x df/d(x^2), and the integral of x / sqrt(x^2 - r^2) is sqrt(x^2 - r^2).
    rim - FRAC_2_PI * smooth
}

/// u(r) in m, from the shortening in m.
fn displacement_m(shortening: &[Stretch], r_m: f64) -> f64 {
    if r_m == 0.0 {
        return shortening.first().map_or(0.0, |stretch| stretch.at_axis);
    }
    // Integrals of 1 / sqrt(r^2 - x^2) and x^2 / sqrt(r^2 - x^2) from 0 to x.
    let integrals = |x_m: f64| {
        let root = ((r_m - x_m).max(0.0) * (r_m + x_m)).sqrt();
        // As accurate near x = r as an arcsine is not.
        let angle = x_m.atan2(root);
        (angle, 0.5 * (r_m * r_m * angle - x_m * root))
    };
    let mut sum = 0.0;
    let mut before = (0.0, 0.0);
    for stretch in shortening {
        if stretch.from_m >= r_m {
            break;
        }
        let after = integrals(stretch.to_m.min(r_m));
        sum += stretch.at_axis * (after.0 - before.0) + stretch.slope_per_m2 * (after.1 - before.1);
        before = after;
    }
    FRAC_2_PI * sum
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
}
