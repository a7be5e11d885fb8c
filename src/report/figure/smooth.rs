//! Smooth curves through samples, where the samples resolve one: monotone cubic interpolation (F. N. Fritsch and R. E. Carlson, SIAM
//! J. Numer. Anal. 17 (1980) 238), which has no maximum that the samples do not have.

/// `(x, y)` on the scales of the axes.
type Point = (f64, f64);

/// Pieces of a drawn curve, about, and most of them between two samples.
const PIECES: usize = 400;
const MOST_BETWEEN: usize = 16;

/// How far the curve through every second sample may be from the samples that it leaves out, relative to the range of all. With
/// all samples, which are twice as dense, the error of the third order is an eighth of that: less than a line is wide.
const TOLERANCE: f64 = 0.03;
/// Fewer samples tell nothing of what is between them.
const FEWEST: usize = 5;

/// A curve through samples at ascending x.
struct Smooth<'a> {
    points: &'a [Point],
    slopes: Vec<f64>,
}

impl<'a> Smooth<'a> {
    fn through(points: &'a [Point]) -> Self {
        let secant = |k: usize| {
            let [(x0, y0), (x1, y1)] = [points[k], points[k + 1]];
            (y1 - y0) / (x1 - x0)
        };
        let width = |k: usize| points[k + 1].0 - points[k].0;
        let last = points.len().saturating_sub(1);
        let slope = |k: usize| match k {
            _ if last == 0 => 0.0,
            _ if last == 1 => secant(0),
            0 => at_end([width(0), width(1)], [secant(0), secant(1)]),
            k if k == last => {
                let (near, far) = (last - 1, last - 2);
                at_end([width(near), width(far)], [secant(near), secant(far)])
            }
            k => inside([width(k - 1), width(k)], [secant(k - 1), secant(k)]),
        };
        Self {
            points,
            slopes: (0..points.len()).map(slope).collect(),
        }
    }

    /// The value between the sample `k` and the next one, at this part of the way.
    fn between(&self, k: usize, part: f64) -> Point {
        let [(x0, y0), (x1, y1)] = [self.points[k], self.points[k + 1]];
        let (width, t) = (x1 - x0, part);
        let (m0, m1) = (width * self.slopes[k], width * self.slopes[k + 1]);
        let (square, cube) = (t * t, t * t * t);
        let y = (2.0 * cube - 3.0 * square + 1.0) * y0
            + (cube - 2.0 * square + t) * m0
            + (3.0 * square - 2.0 * cube) * y1
            + (cube - square) * m1;
        (x0 + t * width, y)
    }

    fn value(&self, x: f64) -> f64 {
        let after = self.points.partition_point(|point| point.0 < x);
        let k = after.clamp(1, self.points.len() - 1) - 1;
        let (from, to) = (self.points[k].0, self.points[k + 1].0);
        self.between(k, (x - from) / (to - from)).1
    }
}

/// The slope of the parabola through three samples at the middle one, limited so that the curve stays monotone; level at an extreme.
fn inside([before, after]: [f64; 2], [left, right]: [f64; 2]) -> f64 {
    if left * right <= 0.0 {
        return 0.0;
    }
    let parabola = (after * left + before * right) / (before + after);
    let most = 3.0 * left.abs().min(right.abs());
    parabola.clamp(-most, most)
}

/// The slope of the parabola through the first three samples at the first one, limited likewise.
fn at_end([own, next]: [f64; 2], [near, far]: [f64; 2]) -> f64 {
    let parabola = ((2.0 * own + next) * near - own * far) / (own + next);
    match parabola * near <= 0.0 {
        true => 0.0,
        false => parabola.clamp(-3.0 * near.abs(), 3.0 * near.abs()),
    }
}

/// A line through samples at ascending x and through extremes that were located between them.
#[derive(Debug, PartialEq)]
pub(super) enum Line {
    /// Straight from point to point: the samples do not resolve a curve.
    Straight(Vec<Point>),
    Smooth(Vec<Point>),
}

/// The line.
pub(super) fn line(samples: &[Point], located: &[Point]) -> Line {
    let all = merged(samples, located);
    if samples.len() < FEWEST || !is_resolved(samples, located) {
        return Line::Straight(all);
    }
    let smooth = Smooth::through(&all);
    let between = (PIECES / all.len()).clamp(1, MOST_BETWEEN);
    let pieces = (0..all.len() - 1).flat_map(|k| {
        let smooth = &smooth;
        (0..between).map(move |piece| smooth.between(k, piece as f64 / between as f64))
    });
    Line::Smooth(pieces.chain(all.last().copied()).collect())
}

/// Both in ascending x; of two at the same place the sample.
fn merged(samples: &[Point], located: &[Point]) -> Vec<Point> {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
        return Vec::new();
    };
    let is_new = |point: &&Point| {
        (first.0..=last.0).contains(&point.0) && samples.iter().all(|sample| sample.0 != point.0)
    };
    let new = located.iter().filter(is_new);
    let mut all: Vec<Point> = samples.iter().chain(new).copied().collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// Whether curves through every second sample, the even ones or the odd ones, tell where the others are.
fn is_resolved(samples: &[Point], located: &[Point]) -> bool {
    let (low, high) = crate::report::number::range(samples.iter().map(|point| point.1));
    let last = samples.len().saturating_sub(1);
    [0, 1].into_iter().all(|parity| {
        let is_kept = |k: &usize| k % 2 == parity || *k == 0 || *k == last;
        let kept = (0..samples.len()).filter(is_kept).map(|k| samples[k]);
        let kept = merged(&kept.collect::<Vec<_>>(), located);
        let smooth = Smooth::through(&kept);
        let mut left_out = (0..samples.len())
            .filter(|k| !is_kept(k))
            .map(|k| samples[k]);
        left_out.all(|(x, y)| (smooth.value(x) - y).abs() <= TOLERANCE * (high - low))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A relaxation over the logarithm of the frequency, its maximum at 0.
    fn debye(x: f64) -> f64 {
        2.0 / (10_f64.powf(x) + 10_f64.powf(-x))
    }

    /// So many samples a decade over four decades, begun at random places between two.
    fn samples(per_decade: usize, shift: f64) -> Vec<Point> {
        let at = |k: usize| (k as f64 + shift) / per_decade as f64 - 2.0;
        (0..=4 * per_decade)
            .map(|k| (at(k), debye(at(k))))
            .collect()
    }

    #[test]
    fn a_drawn_curve_is_less_than_a_line_off_the_true_one_and_goes_through_the_located_peak() {
        for per_decade in 1..=20 {
            for shift in [0.0, 0.2, 0.37, 0.5, 0.71] {
                let samples = samples(per_decade, shift);
                let curve = match line(&samples, &[(0.0, 1.0)]) {
                    Line::Smooth(curve) => curve,
                    Line::Straight(points) => {
                        assert!(per_decade < 5, "{per_decade} samples a decade resolve it");
                        assert!(points.contains(&(0.0, 1.0)));
                        continue;
                    }
                };
                let off = curve.iter().map(|(x, y)| (y - debye(*x)).abs());
                let off = off.fold(0.0, f64::max);
                // A line of 0.5 pt in a frame of 60 mm.
                assert!(off < 0.01, "{per_decade} a decade, {shift}: {off}");
                assert!(curve.contains(&(0.0, 1.0)));
                // No maximum but the located one.
                let highest = curve.iter().map(|point| point.1).fold(0.0, f64::max);
                assert!(highest <= 1.0);
            }
        }
    }

    #[test]
    fn the_error_falls_with_the_third_power_of_the_distance_of_samples() {
        let off = |per_decade: usize| {
            let samples = samples(per_decade, 0.3);
            let Line::Smooth(curve) = line(&samples, &[(0.0, 1.0)]) else {
                panic!("{per_decade} samples a decade resolve it");
            };
            let off = curve.iter().map(|(x, y)| (y - debye(*x)).abs());
            off.fold(0.0, f64::max)
        };
        let order = (off(8) / off(32)).log2() / 2.0;
        assert!(order > 1.8, "{order}");
    }

    #[test]
    fn samples_that_do_not_resolve_a_curve_are_joined_by_straight_lines() {
        assert_eq!(line(&[], &[]), Line::Straight(Vec::new()));
        let two = [(0.0, 1.0), (1.0, 2.0)];
        assert_eq!(line(&two, &[]), Line::Straight(two.to_vec()));
        let between = vec![two[0], (0.5, 3.0), two[1]];
        assert_eq!(line(&two, &[(0.5, 3.0)]), Line::Straight(between));
        let saw: Vec<Point> = (0..9).map(|k| (f64::from(k), f64::from(k % 2))).collect();
        assert_eq!(line(&saw, &[]), Line::Straight(saw.clone()));
        // A straight line stays one.
        let straight: Vec<Point> = (0..5).map(|k| (f64::from(k), 2.0 * f64::from(k))).collect();
        let Line::Smooth(drawn) = line(&straight, &[]) else {
            panic!("five points on a line resolve it");
        };
        assert!(drawn.iter().all(|(x, y)| (y - 2.0 * x).abs() < 1e-12));
        assert_eq!(drawn.len(), 4 * MOST_BETWEEN + 1);
    }
}
