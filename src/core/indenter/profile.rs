//! The body of revolution whose profile is a table of radius and gap, between whose points a smooth curve is laid.
//!
//! The curve is the quadratic spline of L. L. Schumaker, SIAM J. Numer. Anal. 20 (1983) 853: its slope is continuous and linear
//! between knots, it passes through every point, and between two points it takes one more knot, which leaves it convex
//! where the points are convex and monotone elsewhere. Three points in line are joined by a line, two such lines meet in an
//! edge. Tables of a paraboloid and of a cone are met exactly. As the slope of every piece is g' = alpha + beta r, the
//! transformed gap of the method of dimensionality reduction and the load of an elastic contact are closed forms, sums over
//! the pieces of
//!
//! ```text
//! integral of g' / sqrt(x^2 - r^2) dr     = -alpha acos(r/x) - beta s,                       s = sqrt(x^2 - r^2)
//! integral of r^2 g' / sqrt(x^2 - r^2) dr = -alpha (x^2 acos(r/x) + r s) / 2 - beta s (2 x^2 + r^2) / 3
//! ```

use super::{
    Axisymmetric, Domain, Indenter, IndenterError, Setting, radius_under_approach_m, reach,
};
use crate::numerics::roots::{ALL_DIGITS, bisect};

/// A slope that falls by no more than this share of the largest one is rounding of the table, not a profile that is not convex.
const CONVEXITY_TOLERANCE: f64 = 1e-4;

/// Slopes of neighbouring intervals that differ by no more than this share of the largest one are in line.
const STRAIGHT_TOLERANCE: f64 = 1e-9;

/// A slope on the axis below this share of the first interval's is that of a rounded tip.
const TIP_TOLERANCE: f64 = 1e-2;

/// A quadratic piece of the profile, up to where the next one begins.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    start_m: f64,
    gap_m: f64,
    slope: f64,
    curvature_per_m: f64,
}

impl Piece {
    fn gap_at_m(&self, r_m: f64) -> f64 {
        let along = r_m - self.start_m;
        self.gap_m + along * (self.slope + 0.5 * self.curvature_per_m * along)
    }

    /// (alpha, beta) of the slope alpha + beta r.
    fn slope_line(&self) -> (f64, f64) {
        (
            self.slope - self.curvature_per_m * self.start_m,
            self.curvature_per_m,
        )
    }
}

/// A rigid body of revolution with a tabulated profile. The least gap counts as 0. Beyond its last point nothing is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    pieces: Vec<Piece>,
    end_m: f64,
    /// Radius at which the table ceases to be convex and rising, where it does.
    not_convex_at_m: Option<f64>,
    /// Radii (m) of an apex (0) and of edges that run around the body.
    singular_m: Vec<f64>,
    parameters: Vec<Setting>,
}

impl Profile {
    /// The profile through these points (radius, gap), in metres, from the axis outwards.
    ///
    /// # Errors
    /// [`IndenterError`] for fewer than two points, a first one off the axis, radii that do not increase, values that are
    /// not finite.
    pub fn new(points: &[(f64, f64)]) -> Result<Self, IndenterError> {
        check(points)?;
        let secants: Vec<f64> = points
            .windows(2)
            .map(|p| (p[1].1 - p[0].1) / (p[1].0 - p[0].0))
            .collect();
        let not_convex = not_convex_after(&secants);
        let ends = end_slopes(points, &secants, not_convex.is_none());
        let lowest_m = points.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
        let mut pieces = Vec::with_capacity(2 * secants.len());
        for ((pair, &secant), &slopes) in points.windows(2).zip(&secants).zip(&ends) {
            let start = (pair[0].0, pair[0].1 - lowest_m);
            pieces.extend(interval(start, pair[1].0 - pair[0].0, secant, slopes));
        }
        let rounding = STRAIGHT_TOLERANCE * largest(&secants);
        let apex = ends.first().filter(|tip| tip.0 != 0.0).map(|_| 0.0);
        let joints = ends.windows(2).zip(points.iter().skip(1));
        let edges = joints
            .filter(|(e, _)| (e[1].0 - e[0].1).abs() > rounding)
            .map(|(_, point)| point.0);
        Ok(Self {
            singular_m: apex.into_iter().chain(edges).collect(),
            pieces,
            end_m: points.last().map_or(0.0, |p| p.0),
            not_convex_at_m: not_convex.and_then(|i| points.get(i)).map(|p| p.0),
            parameters: Vec::new(),
        })
    }

    /// The same profile under the settings from which it was made: its file.
    pub fn made_from(self, parameters: Vec<Setting>) -> Self {
        Self { parameters, ..self }
    }

    /// Radius of the last point (m).
    pub fn end_m(&self) -> f64 {
        self.end_m
    }

    /// Sum over the pieces inside `x_m` of a primitive, given (alpha, beta, r).
    fn sum_inside(&self, x_m: f64, primitive: impl Fn(f64, f64, f64) -> f64) -> f64 {
        let ends = self.pieces.iter().skip(1).map(|p| p.start_m);
        let mut sum = 0.0;
        for (piece, end_m) in self.pieces.iter().zip(ends.chain([self.end_m])) {
            if piece.start_m >= x_m {
                break;
            }
            let (alpha, beta) = piece.slope_line();
            sum += primitive(alpha, beta, end_m.min(x_m)) - primitive(alpha, beta, piece.start_m);
        }
        sum
    }

    /// Load times contact compliance (m^2) of an elastic contact of this radius (m), for a convex profile:
    /// W C = 2 * integral from 0 to a of r^2 g' / sqrt(a^2 - r^2) dr (Sneddon, Int. J. Engng Sci. 3 (1965) 47).
    fn elastic_load_m2(&self, a_m: f64) -> f64 {
        2.0 * self.sum_inside(a_m, |alpha, beta, r| {
            let s = root(a_m, r);
            -0.5 * alpha * (a_m * a_m * s.atan2(r) + r * s)
                - beta * s * (2.0 * a_m * a_m + r * r) / 3.0
        })
    }

    /// Elastic contact radius (m) of a convex profile, by bisection; the end of the table where that is too short.
    fn convex_contact_radius_m(&self, load_times_compliance_m2: f64) -> f64 {
        if self.elastic_load_m2(self.end_m) <= load_times_compliance_m2 {
            return self.end_m;
        }
        let is_inside = |a_m| self.elastic_load_m2(a_m) <= load_times_compliance_m2;
        bisect(0.0, self.end_m, ALL_DIGITS, is_inside).1
    }

    /// A radius that holds the elastic contact of any profile.
    ///
    /// A flat punch of radius r, sunk to the largest gap within r, is nowhere below the body, so that it would approach
    /// further; the least of these bounds the approach, and no contact is where the gap is larger than that.
    fn bound_m(&self, load_times_compliance_m2: f64) -> f64 {
        let (mut largest_gap_m, mut approach_m) = (0.0_f64, f64::INFINITY);
        let ends = self.pieces.iter().skip(1).map(|p| (p.start_m, p.gap_m));
        let last = self
            .pieces
            .last()
            .map(|p| (self.end_m, p.gap_at_m(self.end_m)));
        for (r_m, gap_m) in ends.clone().chain(last) {
            largest_gap_m = largest_gap_m.max(gap_m);
            approach_m = approach_m.min(largest_gap_m + load_times_compliance_m2 / (2.0 * r_m));
        }
        // A piece may reach below the approach between its ends: it is in, up to its end, if either end is.
        let mut bound_m = 0.0_f64;
        for (piece, (end_m, gap_m)) in self.pieces.iter().zip(ends.chain(last)) {
            if piece.gap_m.min(gap_m) < approach_m {
                bound_m = end_m;
            }
        }
        bound_m
    }

    /// The radius (m) from which on no gap is below this one (m); a piece is monotone, or too short to matter.
    fn radius_below_m(&self, gap_m: f64) -> f64 {
        let mut end_m = self.end_m;
        for piece in self.pieces.iter().rev() {
            if piece.gap_at_m(end_m) < gap_m {
                return end_m;
            }
            if piece.gap_m < gap_m {
                return reach::halved_m(piece.start_m, end_m, &|r_m| piece.gap_at_m(r_m) >= gap_m);
            }
            end_m = piece.start_m;
        }
        end_m
    }
}

/// sqrt(x^2 - r^2), 0 at r = x and beyond.
fn root(x_m: f64, r_m: f64) -> f64 {
    ((x_m - r_m) * (x_m + r_m)).max(0.0).sqrt()
}

fn check(points: &[(f64, f64)]) -> Result<(), IndenterError> {
    let [(first_m, _), _, ..] = points else {
        return Err(IndenterError::TooFewPoints {
            points: points.len(),
        });
    };
    let mut previous_m = f64::NEG_INFINITY;
    for (index, &(radius_m, gap_m)) in points.iter().enumerate() {
        if !(radius_m.is_finite() && gap_m.is_finite() && radius_m > previous_m) {
            return Err(IndenterError::ProfilePoint {
                point: index + 1,
                radius_m,
                gap_m,
            });
        }
        previous_m = radius_m;
    }
    if *first_m != 0.0 {
        return Err(IndenterError::ProfileStart { radius_m: *first_m });
    }
    Ok(())
}

fn largest(secants: &[f64]) -> f64 {
    secants.iter().fold(0.0, |s, d| s.max(d.abs()))
}

/// The point after which the profile falls or its slope does.
fn not_convex_after(secants: &[f64]) -> Option<usize> {
    let rounding = CONVEXITY_TOLERANCE * largest(secants);
    if secants.first().is_some_and(|&first| first < -rounding) {
        return Some(0);
    }
    let falls = secants.windows(2).position(|d| d[1] < d[0] - rounding);
    falls.map(|i| i + 1)
}

/// Slopes at the beginning and at the end of every interval.
fn end_slopes(points: &[(f64, f64)], secants: &[f64], convex: bool) -> Vec<(f64, f64)> {
    let rounding = STRAIGHT_TOLERANCE * largest(secants);
    let in_line = |a: f64, b: f64| (a - b).abs() <= rounding;
    let count = secants.len();
    let straight: Vec<bool> = (0..count)
        .map(|i| {
            let before = i > 0 && in_line(secants[i - 1], secants[i]);
            before || (i + 1 < count && in_line(secants[i], secants[i + 1]))
        })
        .collect();
    let mut ends: Vec<(f64, f64)> = secants.iter().map(|&d| (d, d)).collect();
    for i in 1..count {
        let slope = match (straight[i - 1], straight[i]) {
            (true, true) => continue,
            (true, false) if convex => secants[i - 1],
            (false, true) if convex => secants[i],
            _ => inner_slope(points, secants, i, convex),
        };
        if !straight[i - 1] {
            ends[i - 1].1 = slope;
        }
        if !straight[i] {
            ends[i].0 = slope;
        }
    }
    // The end intervals go on as parabolas; the tip of a body that is not an apex is round.
    let limit = |slope: f64, secant: f64| match convex {
        true => slope,
        false => slope.clamp(-2.0 * secant.abs(), 2.0 * secant.abs()),
    };
    let last = count - 1;
    if !straight[last] {
        ends[last].1 = limit(2.0 * secants[last] - ends[last].0, secants[last]);
    }
    if !straight[0] && count > 1 {
        ends[0].0 = limit(2.0 * secants[0] - ends[0].1, secants[0]);
    }
    if ends[0].0 < TIP_TOLERANCE * secants[0].abs() {
        ends[0].0 = 0.0;
    }
    ends
}

/// Slope at point `i`: that of the parabola through it and its neighbours.
///
/// It lies between the slopes of the intervals to both sides, which is what a convex curve needs. Where the points are not
/// convex it is kept within twice the smaller of them, and 0 at a summit or in a valley, so that the curve does not overshoot.
fn inner_slope(points: &[(f64, f64)], secants: &[f64], i: usize, convex: bool) -> f64 {
    let (before, after) = (secants[i - 1], secants[i]);
    let (left_m, right_m) = (points[i].0 - points[i - 1].0, points[i + 1].0 - points[i].0);
    let parabola = (before * right_m + after * left_m) / (left_m + right_m);
    if convex {
        parabola
    } else if before * after <= 0.0 {
        0.0
    } else {
        let most = 2.0 * before.abs().min(after.abs());
        parabola.clamp(-most, most)
    }
}

/// The two pieces of one interval: slopes `left` and `right` at its ends, `secant` on average, and between them a knot at a
/// share t of the width, where the slope is 2 secant - t left - (1 - t) right.
///
/// For left <= secant <= right that lies between left and right, and the curve is convex, if t lies between
/// 1 - 2 (secant - left) / (right - left) and 2 (right - secant) / (right - left); the middle of that range is taken.
fn interval(start: (f64, f64), width_m: f64, secant: f64, (left, right): (f64, f64)) -> [Piece; 2] {
    let rise = right - left;
    let share = if rise > 0.0 && left <= secant && secant <= right {
        let least = (1.0 - 2.0 * (secant - left) / rise).max(0.0);
        let most = (2.0 * (right - secant) / rise).min(1.0);
        (0.5 * (least + most)).clamp(1e-6, 1.0 - 1e-6)
    } else {
        0.5
    };
    let middle = 2.0 * secant - share * left - (1.0 - share) * right;
    let (first_m, second_m) = (share * width_m, (1.0 - share) * width_m);
    let first = Piece {
        start_m: start.0,
        gap_m: start.1,
        slope: left,
        curvature_per_m: (middle - left) / first_m,
    };
    let knot_m = start.0 + first_m;
    let second = Piece {
        start_m: knot_m,
        gap_m: first.gap_at_m(knot_m),
        slope: middle,
        curvature_per_m: (right - middle) / second_m,
    };
    [first, second]
}

impl Indenter for Profile {
    fn shape(&self) -> &'static str {
        "profile"
    }

    /// The file, where there is one: a profile made of points in memory has no settings.
    fn parameters(&self) -> Vec<Setting> {
        self.parameters.clone()
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        let r_m = x_m.hypot(y_m);
        let after = self.pieces.partition_point(|p| p.start_m <= r_m);
        match self.pieces.get(after.saturating_sub(1)) {
            Some(piece) if r_m <= self.end_m => piece.gap_at_m(r_m),
            _ => f64::INFINITY,
        }
    }

    fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
        self.not_convex_at_m.is_none().then_some(self as _)
    }

    fn not_axisymmetric_because(&self) -> String {
        let at_m = self.not_convex_at_m.unwrap_or(0.0);
        format!("is not convex from r = {at_m:e} m on, so that its contact need not be a disc")
    }

    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
        let product = load_n * compliance_per_pa;
        match self.not_convex_at_m {
            None => self.convex_contact_radius_m(product),
            Some(_) => self.bound_m(product),
        }
    }

    /// Of a profile that is not convex, how far out its gap is below the approach.
    fn half_widths_under_approach_m(&self, approach_m: f64) -> (f64, f64) {
        let half_width_m = match self.not_convex_at_m {
            None => radius_under_approach_m(self, approach_m),
            Some(_) => self.radius_below_m(approach_m),
        };
        (half_width_m, half_width_m)
    }

    fn domain(&self, load_n: f64, compliance_per_pa: f64) -> Domain {
        let half_width_m = self.elastic_half_width_m(load_n, compliance_per_pa);
        Domain::Around {
            half_widths_m: (half_width_m, half_width_m),
            cell_aspect_ratio: 1.0,
            limit_m: Some((self.end_m, self.end_m)),
        }
    }

    fn ends_in_data(&self) -> bool {
        true
    }

    fn pressure_is_bounded(&self) -> bool {
        self.has_bounded_pressure()
    }
}

impl Axisymmetric for Profile {
    fn transformed_gap_m(&self, x_m: f64) -> f64 {
        if x_m > self.end_m {
            return f64::INFINITY;
        }
        x_m * self.sum_inside(x_m, |alpha, beta, r| {
            let s = root(x_m, r);
            // acos(r/x) without the loss of digits near r = x.
            -alpha * s.atan2(r) - beta * s
        })
    }

    fn known_radius_m(&self) -> Option<f64> {
        Some(self.end_m)
    }

    fn singular_radii_m(&self) -> Vec<f64> {
        self.singular_m.clone()
    }

    fn has_bounded_pressure(&self) -> bool {
        self.singular_m.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Cone, PowerLaw, Sphere};
    use super::*;

    /// A table of a shape's gap at radii that grow unevenly up to `end_m`.
    fn table(shape: &dyn Indenter, end_m: f64, count: u32) -> Vec<(f64, f64)> {
        let radius = |i: u32| end_m * (f64::from(i) / f64::from(count)).powf(1.3);
        let radii = (0..=count).map(radius);
        radii.map(|r| (r, shape.gap_m(r, 0.0))).collect()
    }

    #[test]
    fn tables_of_a_sphere_and_of_a_cone_are_the_shapes_themselves() {
        let sphere = Sphere::new(0.01).unwrap();
        let cone = Cone::new(1.2).unwrap();
        for shape in [&sphere as &dyn Indenter, &cone] {
            let profile = Profile::new(&table(shape, 1e-3, 17)).unwrap();
            let (body, its) = (
                profile.axisymmetric().unwrap(),
                shape.axisymmetric().unwrap(),
            );
            let largest_m = its.transformed_gap_m(1e-3);
            for i in 0..=400 {
                let x = 1e-3 * f64::from(i) / 400.0;
                // 34 pieces, each with roundings of its size.
                let gap = profile.gap_m(0.6 * x, 0.8 * x) - shape.gap_m(0.6 * x, 0.8 * x);
                assert!(gap.abs() < 1e-14 * largest_m, "{x} {gap}");
                let transformed = body.transformed_gap_m(x) - its.transformed_gap_m(x);
                assert!(transformed.abs() < 1e-14 * largest_m, "{x} {transformed}");
            }
            let (own, known) = (
                profile.elastic_half_width_m(1.0, 4e-10),
                shape.elastic_half_width_m(1.0, 4e-10),
            );
            assert!((own / known - 1.0).abs() < 1e-13, "{own} {known}");
            assert_eq!(body.has_bounded_pressure(), its.has_bounded_pressure());
        }
    }

    #[test]
    fn the_curve_between_the_points_converges_and_stays_convex() {
        // r^4 is flatter at its tip than the first parabola, which is where convexity needs its knot.
        let law = PowerLaw::new(4.0, 1e-3, 1e-4).unwrap();
        let error = |count: u32| {
            let points: Vec<_> = (0..=count)
                .map(|i| 1e-3 * f64::from(i) / f64::from(count))
                .map(|r| (r, law.gap_m(r, 0.0)))
                .collect();
            let profile = Profile::new(&points).unwrap();
            let slopes: Vec<f64> = profile.pieces.iter().map(|p| p.slope).collect();
            assert!(
                slopes.windows(2).all(|s| s[0] <= s[1] + 1e-12),
                "{slopes:?}"
            );
            let body = profile.axisymmetric().unwrap();
            (0..=1000)
                .map(|i| 1e-6 * f64::from(i))
                .map(|x| (body.transformed_gap_m(x) - law.transformed_gap_m(x)).abs())
                .fold(0.0, f64::max)
        };
        // The slope is right to h^2, and the last interval weighs sqrt(h) in the integral.
        let order = (error(16) / error(32)).log2();
        assert!((order - 2.5).abs() < 0.1, "{order}");
        assert!(error(64) < 1e-4 * law.transformed_gap_m(1e-3));
    }

    #[test]
    fn the_transformed_gap_is_the_integral_that_defines_it() {
        let points = [(0.0, 3e-6), (1e-4, 4e-6), (2e-4, 7e-6), (5e-4, 3e-5)];
        let profile = Profile::new(&points).unwrap();
        let body = profile.axisymmetric().unwrap();
        assert_eq!(profile.gap_m(0.0, 0.0), 0.0);
        for x in [2e-5, 1.3e-4, 3.7e-4, 5e-4] {
            // r = x sin(theta) makes the integrand g'(r) alone, whose kinks the midpoint rule meets to second order.
            let count = 20_000;
            let sum: f64 = (0..count)
                .map(|i| (f64::from(i) + 0.5) / f64::from(count) * std::f64::consts::FRAC_PI_2)
                .map(|theta| {
                    let r = x * theta.sin();
                    let step = 1e-9;
                    (profile.gap_m(r + step, 0.0).min(1.0) - profile.gap_m(r - step, 0.0)) / step
                })
                .sum();
            let expected = x * 0.5 * sum * std::f64::consts::FRAC_PI_2 / f64::from(count);
            // The difference quotient straddles a kink of the slope at a few of the points.
            let found = body.transformed_gap_m(x);
            if x < 5e-4 {
                assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
            }
        }
        assert_eq!(body.transformed_gap_m(5.001e-4), f64::INFINITY);
        assert_eq!(profile.gap_m(5.001e-4, 0.0), f64::INFINITY);
    }

    #[test]
    fn a_profile_that_is_not_convex_passes_through_its_points_without_overshoot() {
        let points = [
            (0.0, 5e-6),
            (1e-4, 2e-6),
            (2e-4, 2e-6),
            (3e-4, 9e-6),
            (4e-4, 9.5e-6),
        ];
        let profile = Profile::new(&points).unwrap();
        assert!(profile.axisymmetric().is_none());
        assert!(profile.not_axisymmetric_because().contains("r = 0e0 m"));
        for (r, gap) in points {
            assert!((profile.gap_m(r, 0.0) - (gap - 2e-6)).abs() < 1e-19);
        }
        for i in 0..=4000 {
            let gap = profile.gap_m(1e-7 * f64::from(i), 0.0);
            assert!((-1e-20..=7.5e-6 + 1e-20).contains(&gap), "{i} {gap}");
        }
        // Rises, then becomes flatter.
        let bent = Profile::new(&[(0.0, 0.0), (1e-4, 1e-6), (2e-4, 3e-6), (3e-4, 4e-6)]).unwrap();
        assert!(bent.not_axisymmetric_because().contains("r = 2e-4 m"));
    }

    #[test]
    fn the_bound_for_any_profile_holds_the_contact_of_a_convex_one() {
        let sphere = Sphere::new(0.01).unwrap();
        let profile = Profile::new(&table(&sphere, 2e-3, 100)).unwrap();
        for load in [1e-3, 0.1, 10.0] {
            let contact_m = sphere.elastic_half_width_m(load, 4e-10);
            let bound_m = profile.bound_m(load * 4e-10);
            // For a sphere the bound is 1.51 contact radii, to within the widest interval of the table.
            let ratio = bound_m / contact_m;
            let interval = 2.6e-5 / contact_m;
            assert!(ratio > 1.5 && ratio < 1.53 + 2.0 * interval, "{ratio}");
        }
    }

    #[test]
    fn rounded_digits_do_not_make_a_cone_concave() {
        let cone = |digits: f64| {
            let round = |value: f64| (value * digits).round() / digits;
            let points: Vec<_> = (0..200)
                .map(|i| 1e-6 * f64::from(i))
                .map(|r| (r, round(r * 0.123_456_789)))
                .collect();
            Profile::new(&points).unwrap()
        };
        // Gaps to 1e-12 m at steps of 1e-6 m: slopes to 1e-6 of 0.12. To 1e-9 m the steps show.
        assert!(cone(1e12).axisymmetric().is_some());
        assert!(cone(1e9).axisymmetric().is_none());
    }

    #[test]
    fn points_in_line_are_joined_by_lines_that_meet_in_an_edge() {
        let line = |slope: f64, r: f64| (r, slope * (r - 2e-4).max(0.0));
        let points: Vec<_> = (0..=5).map(|i| line(0.3, 1e-4 * f64::from(i))).collect();
        let frustum = Profile::new(&points).unwrap();
        for i in 0..=500 {
            let r = 1e-6 * f64::from(i);
            assert!((frustum.gap_m(r, 0.0) - line(0.3, r).1).abs() < 1e-18);
        }
        let body = frustum.axisymmetric().unwrap();
        assert!(!body.has_bounded_pressure());
        // G(x) = x * integral from 2e-4 to x of 0.3 / sqrt(x^2 - r^2) dr = 0.3 x acos(2e-4 / x).
        let x = 3.3e-4_f64;
        let expected = 0.3 * x * (2e-4 / x).acos();
        assert!((body.transformed_gap_m(x) / expected - 1.0).abs() < 1e-13);
    }

    #[test]
    fn points_that_are_no_profile_are_refused() {
        let refused = |points: &[(f64, f64)]| Profile::new(points).unwrap_err().to_string();
        assert!(refused(&[(0.0, 0.0)]).contains("at least 2"));
        assert!(refused(&[(1e-6, 0.0), (2e-6, 1e-6)]).contains("r = 0"));
        assert!(refused(&[(0.0, 0.0), (2e-6, 1e-6), (2e-6, 2e-6)]).contains("point 3"));
        assert!(refused(&[(0.0, 0.0), (2e-6, f64::NAN)]).contains("point 2"));
    }
}
