//! What a uniformly loaded rectangle does to the surface of an elastic half-space, by Love's formula.
//!
//! Convention: displacement is positive into the body, and everything here is per unit pressure and unit contact
//! compliance (`1/E*`, 1/Pa), so a value is a length in metres; multiply it by compliance and pressure to get the
//! displacement. A point load `P` gives `C P / (pi r)` (Boussinesq), and a rectangle of sides `2a`, `2b` the integral
//! of that over its area (Love, *Phil. Trans. R. Soc. A* 228 (1929) 377; Johnson, *Contact Mechanics* (1985), section 3.3):
//!
//! ```text
//! B(x, y) = (1/pi) [k(x+a, y+b) + k(x-a, y-b) - k(x+a, y-b) - k(x-a, y+b)]
//! k(x, y) = x asinh(y/|x|) + y asinh(x/|y|)
//! ```
//!
//! At `r` cells' distance the four terms cancel to `1/r^2` of their size, so at 1000 cells the closed form has lost six
//! digits. From a few cells on the integral is therefore taken by Gauss-Legendre quadrature, which is exact to rounding
//! there because the integrand is smooth. Long rectangles are halved until one of the two routes is accurate.

use std::f64::consts::PI;

/// Distance from the centre, in longer sides, from which [`GAUSS_8`] is exact to rounding (error below `(4 d)^-16`).
const FAR_8: f64 = 3.0;
/// The same for [`GAUSS_6`].
const FAR_6: f64 = 8.0;
/// The same for [`GAUSS_4`].
const FAR_4: f64 = 32.0;

/// Positive nodes and weights of the Gauss-Legendre rules on [-1, 1] (the rules are symmetric).
pub(super) type HalfRule = [(f64, f64)];
const GAUSS_4: [(f64, f64); 2] = [
    (0.33998104358485626, 0.6521451548625461),
    (0.8611363115940526, 0.34785484513745385),
];
const GAUSS_6: [(f64, f64); 3] = [
    (0.2386191860831969, 0.46791393457269104),
    (0.6612093864662645, 0.3607615730481386),
    (0.932469514203152, 0.17132449237917036),
];
pub(super) const GAUSS_8: [(f64, f64); 4] = [
    (0.1834346424956498, 0.362683783378362),
    (0.525532409916329, 0.31370664587788727),
    (0.7966664774136267, 0.22238103445337448),
    (0.9602898564975363, 0.10122853629037626),
];

/// Displacement at `(x_m, y_m)` by unit pressure on the rectangle `|x| <= half_x_m`, `|y| <= half_y_m`, in m (per Pa of
/// pressure and 1/Pa of contact compliance). Holds inside, on the edge and outside; a rectangle without area gives 0. All lengths
/// must be finite.
pub fn rectangle_displacement_m(x_m: f64, y_m: f64, half_x_m: f64, half_y_m: f64) -> f64 {
    potential(x_m.abs(), y_m.abs(), half_x_m, half_y_m) / PI
}

/// Integral of `1/r` over the rectangle with half sides `a`, `b`, seen from `(x, y)`.
fn potential(x: f64, y: f64, a: f64, b: f64) -> f64 {
    let distance = x.hypot(y) / (2.0 * a.max(b));
    if let Some(rule) = rule_at(distance) {
        quadrature((x, y), (a, b), rule, |squared| squared.sqrt().recip())
    } else if b > 0.0 && a > 2.0 * b && a.is_finite() {
        let half = 0.5 * a;
        potential(x - half, y, half, b) + potential(x + half, y, half, b)
    } else if a > 0.0 && b > 2.0 * a && b.is_finite() {
        let half = 0.5 * b;
        potential(x, y - half, a, half) + potential(x, y + half, a, half)
    } else {
        strip(x + a, y, b) - strip(x - a, y, b) + strip(y + b, x, a) - strip(y - b, x, a)
    }
}

/// `x [asinh((y+b)/|x|) - asinh((y-b)/|x|)]`, which tends to 0 at `x = 0`: two of Love's terms taken together.
fn strip(x: f64, y: f64, b: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    let width = x.abs();
    x * (((y + b) / width).asinh() - ((y - b) / width).asinh())
}

/// The rule that is exact to rounding over a rectangle from which the nearest singularity of the integrand is this many of its
/// longer sides away; `None` where none is.
pub(super) fn rule_at(distance: f64) -> Option<&'static HalfRule> {
    if distance >= FAR_4 {
        Some(&GAUSS_4)
    } else if distance >= FAR_6 {
        Some(&GAUSS_6)
    } else if distance >= FAR_8 {
        Some(&GAUSS_8)
    } else {
        None
    }
}

/// Integral of a function of the squared distance over the rectangle with half sides `a`, `b`, seen from `(x, y)`, by the product of
/// two Gauss-Legendre rules.
pub(super) fn quadrature(
    (x, y): (f64, f64),
    (a, b): (f64, f64),
    rule: &HalfRule,
    of_squared: impl Fn(f64) -> f64,
) -> f64 {
    let mut sum = 0.0;
    for &(node_x, weight_x) in rule {
        let left = (x - a * node_x).powi(2);
        let right = (x + a * node_x).powi(2);
        let mut row = 0.0;
        for &(node_y, weight_y) in rule {
            let below = (y - b * node_y).powi(2);
            let above = (y + b * node_y).powi(2);
            let values = of_squared(left + below)
                + of_squared(left + above)
                + of_squared(right + below)
                + of_squared(right + above);
            row += weight_y * values;
        }
        sum += weight_x * row;
    }
    a * b * sum
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::contact::half_space) fn assert_close(
        found: f64,
        expected: f64,
        relative: f64,
        what: &str,
    ) {
        assert!(
            (found - expected).abs() <= relative * expected.abs(),
            "{what}: {found:e} instead of {expected:e}, relative error {:e}",
            (found / expected - 1.0).abs()
        );
    }

    #[test]
    fn the_two_routes_agree_where_they_meet() {
        // Both sides of every switch, by the closed form; it loses (distance/side)^2 of its digits, hence the tolerance.
        for distance in [3.0_f64, 8.0, 32.0] {
            for angle in [0.0_f64, 0.3, 0.7] {
                for d in [distance * (1.0 - 1e-9), distance * (1.0 + 1e-9)] {
                    let (x, y, a, b) = (d * angle.cos(), d * angle.sin(), 0.5, 0.4);
                    let closed = (strip(x + a, y, b) - strip(x - a, y, b) + strip(y + b, x, a)
                        - strip(y - b, x, a))
                        / PI;
                    let tolerance = 8.0 * f64::EPSILON * d * d;
                    assert_close(
                        rectangle_displacement_m(x, y, a, b),
                        closed,
                        tolerance,
                        "switch",
                    );
                }
            }
        }
    }

    #[test]
    fn a_rectangle_is_the_sum_of_its_parts() {
        // 12 x 12 cells against one rectangle, seen from inside, the edge, a corner and outside. Positive terms: the sum
        // of 144 roundings stays below 144 units in the last place, and in practice far below.
        let (h_x, h_y) = (1.0e-5, 1.7e-5);
        for (x, y) in [
            (0.0, 0.0),
            (2.5 * h_x, 3.5 * h_y),
            (6.0 * h_x, 0.0),
            (6.0 * h_x, 6.0 * h_y),
            (9.0 * h_x, 30.0 * h_y),
        ] {
            let mut sum = 0.0;
            for i in 0..12 {
                for j in 0..12 {
                    let (cx, cy) = ((f64::from(i) - 5.5) * h_x, (f64::from(j) - 5.5) * h_y);
                    sum += rectangle_displacement_m(x - cx, y - cy, 0.5 * h_x, 0.5 * h_y);
                }
            }
            let whole = rectangle_displacement_m(x, y, 6.0 * h_x, 6.0 * h_y);
            assert_close(sum, whole, 1e-14, "sum of parts");
        }
    }

    #[test]
    fn a_rectangle_without_area_moves_nothing() {
        assert_eq!(rectangle_displacement_m(0.0, 0.0, 0.0, 1.0), 0.0);
        assert_eq!(rectangle_displacement_m(1.0, 0.5, 1.0, 0.0), 0.0);
        assert_eq!(rectangle_displacement_m(0.0, 0.0, 0.0, 0.0), 0.0);
    }

    #[test]
    fn extreme_rectangles_end_the_halving() {
        assert!(!rectangle_displacement_m(0.0, 0.0, f64::INFINITY, 1.0).is_finite());
        assert!(rectangle_displacement_m(f64::NAN, 0.0, 1.0, 1.0).is_nan());
        // A needle of half length 1: asymptotically (4/pi) b [1 + ln(2/b)] at its centre, with an error of order b^3.
        let b: f64 = 1e-5;
        let needle = 4.0 / PI * b * (1.0 + (2.0 / b).ln());
        assert_close(
            rectangle_displacement_m(0.0, 0.0, 1.0, b),
            needle,
            1e-10,
            "needle",
        );
    }
}
