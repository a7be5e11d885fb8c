//! How far from the origin a contact under a prescribed approach can reach.
//!
//! Since the surface never rises above its rest position, a contact lies where the gap is below the approach; that of a convex
//! body of revolution where the transformed gap is, since all its springs are shortened or at rest.

use super::{Axisymmetric, Indenter};

/// Lengths between which a contact is looked for: a picometre and a hundred thousand kilometres.
const SHORTEST_M: f64 = 1e-12;
const LONGEST_M: f64 = 1e8;
/// Lengths tried per factor of two.
const PER_OCTAVE: i32 = 8;

/// The contact radius (m) of a convex body of revolution under this approach (m), held for ever.
pub fn radius_under_approach_m(body: &dyn Axisymmetric, approach_m: f64) -> f64 {
    body.contact_limit_m()
        .unwrap_or_else(|| first_length_m(&|x_m| body.transformed_gap_m(x_m) >= approach_m))
}

/// Half the side (m) of the square about the origin beyond which the gap of a shape is nowhere below the approach (m).
pub(super) fn square_below_m(indenter: &(impl Indenter + ?Sized), approach_m: f64) -> f64 {
    let is_below = |half_m: f64| lowest_gap_on_square_m(indenter, half_m) < approach_m;
    let factor = |k: i32| (f64::from(k) / f64::from(PER_OCTAVE)).exp2();
    let octaves = (LONGEST_M / SHORTEST_M).log2().ceil() as i32;
    // From outside: the lowest point may lie anywhere, and another one beyond it.
    let outermost = (0..=octaves * PER_OCTAVE)
        .rev()
        .find(|&k| is_below(SHORTEST_M * factor(k)));
    let Some(outermost) = outermost else {
        return SHORTEST_M;
    };
    let inside_m = SHORTEST_M * factor(outermost);
    halved_m(inside_m, inside_m * factor(1), &|half_m| !is_below(half_m))
}

/// The least gap on the border of a square about the origin.
fn lowest_gap_on_square_m(indenter: &(impl Indenter + ?Sized), half_m: f64) -> f64 {
    const POINTS: usize = 64;
    let at = |k: usize| half_m * (2.0 * k as f64 / POINTS as f64 - 1.0);
    let sides = |k: usize| {
        let along = at(k);
        let corners = [
            (along, half_m),
            (along, -half_m),
            (half_m, along),
            (-half_m, along),
        ];
        corners.into_iter()
    };
    (0..=POINTS)
        .flat_map(sides)
        .map(|(x_m, y_m)| indenter.gap_m(x_m, y_m))
        .fold(f64::INFINITY, f64::min)
}

/// The least length (m) from which on `far` holds.
fn first_length_m(far: &dyn Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (SHORTEST_M, SHORTEST_M);
    while !far(high) && high < LONGEST_M {
        (low, high) = (high, 2.0 * high);
    }
    halved_m(low, high, far)
}

/// Where between these lengths (m) `far` begins to hold, to 1e-6 of it.
pub(super) fn halved_m(mut low_m: f64, mut high_m: f64, far: &dyn Fn(f64) -> bool) -> f64 {
    while high_m - low_m > 1e-6 * high_m {
        let middle_m = 0.5 * (low_m + high_m);
        if far(middle_m) {
            high_m = middle_m;
        } else {
            low_m = middle_m;
        }
    }
    high_m
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::{
        Asperities, Asperity, Cone, Ellipsoid, FlatPunch, Profile, Setting, Shifted, Sphere,
    };
    use super::*;

    #[test]
    fn an_approach_bounds_the_contact_by_the_transformed_gap() {
        let width = |indenter: &dyn Indenter, approach_m| {
            let (x_m, y_m) = indenter.half_widths_under_approach_m(approach_m);
            assert_eq!(x_m, y_m);
            x_m
        };
        // a^2/R and (pi/2) a cot(alpha) equal the approach; bisection to 1e-6.
        let sphere = Sphere::new(0.01).unwrap();
        assert!((width(&sphere, 1e-6) / 1e-4 - 1.0).abs() < 2e-6);
        let cone = Cone::new(1.2).unwrap();
        let expected = 1e-6 * 1.2_f64.tan() / std::f64::consts::FRAC_PI_2;
        assert!((width(&cone, 1e-6) / expected - 1.0).abs() < 2e-6);
        let punch = FlatPunch::new(0.003).unwrap();
        assert_eq!(width(&punch, 1e-6), 0.003);
    }

    /// A sphere of 10 mm about a point at x = 1 mm, of a type that says no more than its gap.
    #[derive(Debug)]
    struct Offset;

    impl Indenter for Offset {
        fn shape(&self) -> &'static str {
            "offset"
        }
        fn parameters(&self) -> Vec<Setting> {
            Vec::new()
        }
        fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
            50.0 * ((x_m - 1e-3).powi(2) + y_m * y_m)
        }
        fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
            None
        }
        fn elastic_half_width_m(&self, _: f64, _: f64) -> f64 {
            1.0
        }
    }

    #[test]
    fn whatever_touches_off_the_axis_is_held_too() {
        let holds = |indenter: &dyn Indenter, approach_m, (x, y): (f64, f64)| {
            let (x_m, y_m) = indenter.half_widths_under_approach_m(approach_m);
            let off = (x_m / x - 1.0, y_m / y - 1.0);
            assert!(
                off.0.abs() < 2e-6 && off.1.abs() < 2e-6,
                "{indenter:?} {off:?}"
            );
        };
        // The gap of a sphere of 10 mm is below 1 um within sqrt(2 R delta), its contact within sqrt(R delta) = 0.1 mm.
        let below_m = 2.0_f64.sqrt() * 1e-4;
        holds(&Offset, 1e-6, (1e-3 + below_m, 1e-3 + below_m));
        let sphere: Arc<dyn Indenter> = Arc::new(Sphere::new(0.01).unwrap());
        let shifted = Shifted::new(sphere, -1e-3, 2e-3).unwrap();
        holds(&shifted, 1e-6, (1.1e-3, 2.1e-3));
        let bump = |center_x_m, height_m| Asperity {
            center_x_m,
            center_y_m: 0.0,
            radius_m: 0.01,
            height_m,
        };
        let bumps = vec![bump(-1e-3, 0.0), bump(1e-3, 0.0), bump(5e-3, -2e-6)];
        let bumps = Asperities::new(bumps).unwrap();
        holds(&bumps, 1e-6, (1.1e-3, 1e-4));
        // From 2 um on the low one is met as well.
        holds(&bumps, 3e-6, (5.1e-3, 3.0_f64.sqrt() * 1e-4));
        // A ring at 1 mm, straight up to both sides.
        let ring = [
            (0.0, 1e-5),
            (0.5e-3, 1e-5),
            (1e-3, 0.0),
            (1.5e-3, 1e-5),
            (2e-3, 2e-5),
        ];
        let (x_m, _) = Profile::new(&ring)
            .unwrap()
            .half_widths_under_approach_m(1e-6);
        assert!(x_m > 1e-3 && x_m < 1.2e-3, "{x_m}");
    }

    #[test]
    fn an_ellipse_is_held_with_its_own_axes() {
        for (x, y) in [(0.1, 0.01), (0.01, 0.1), (1.0, 0.01), (0.011, 0.01)] {
            let ellipsoid = Ellipsoid::new(x, y).unwrap();
            let exact = crate::reference::elliptic::EllipticHertz {
                radius_x_m: x,
                radius_y_m: y,
                load_n: 10.0,
                compliance_per_pa: 4e-10,
            }
            .contact();
            let found = ellipsoid.half_widths_under_approach_m(exact.approach_m);
            for (found, exact) in [
                (found.0, exact.semi_axis_x_m),
                (found.1, exact.semi_axis_y_m),
            ] {
                // The approximations for the axis ratio and the integrals, worst where the radii are nearly equal.
                assert!(
                    (found / exact - 1.02).abs() < 0.06,
                    "{x} {y}: {}",
                    found / exact
                );
            }
        }
    }
}
