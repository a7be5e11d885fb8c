//! Extra frequencies where the samples do not resolve the curve of the loss.
//!
//! Every inner point of the curve is predicted from its neighbours, by the cubic through the two on either side, in the
//! logarithms of frequency and loss. Where the computed value differs, the curve has a detail that the samples around it
//! only just show, and the two intervals beside the point are halved.

use crate::numerics::polynomial::lagrange;
use crate::sweep::search::peak::Point;

/// Error of the curve between its points, relative, above which a neighbourhood is refined: well above the error of a loss,
/// and below what a reader sees in a figure.
const TOLERANCE: f64 = 5e-3;

/// How much larger the error of a point predicted without itself is than that of the curve between points: the ratio of
/// h h 2h 2h to (h/2)(h/2)(3h/2)(3h/2), the products in the error of the cubic.
const WITHOUT_ITSELF: f64 = 64.0 / 9.0;

/// Intervals narrower than this (in the logarithm of the frequency) are never halved: no relaxation is that sharp.
const NARROWEST: f64 = 0.02;

/// Angular frequencies (rad/s), ascending, that would resolve the curve better; none where it is resolved.
pub fn candidates(curve: &[Point]) -> Vec<f64> {
    let logarithms: Vec<Point> = curve
        .iter()
        .filter(|(_, loss)| *loss > 0.0)
        .map(|(omega, loss)| (omega.ln(), loss.ln()))
        .collect();
    let mut halved = vec![false; logarithms.len()];
    for middle in 1..logarithms.len().saturating_sub(1) {
        let from = middle.saturating_sub(2);
        let around = logarithms.iter().enumerate().skip(from);
        let around = around.take(middle + 3 - from);
        let neighbours = around
            .filter(|(i, _)| *i != middle)
            .map(|(_, point)| *point);
        let (places, values): (Vec<f64>, Vec<f64>) = neighbours.unzip();
        let (x, y) = logarithms[middle];
        if (lagrange(&places, &values, x) - y).abs() > WITHOUT_ITSELF * TOLERANCE {
            halved[middle - 1] = true;
            halved[middle] = true;
        }
    }
    let intervals = logarithms.windows(2).zip(&halved);
    intervals
        .filter(|(ends, halved)| **halved && ends[1].0 - ends[0].0 > NARROWEST)
        .map(|(ends, _)| (0.5 * (ends[0].0 + ends[1].0)).exp())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn debye(omega: f64) -> f64 {
        2.0 * omega / (1.0 + omega * omega)
    }

    fn curve(loss: impl Fn(f64) -> f64, ratio: f64) -> Vec<Point> {
        let points = (1e6_f64.ln() / ratio.ln()).ceil() as i32;
        (0..=points)
            .map(|i| 1e-3 * ratio.powi(i))
            .map(|omega| (omega, loss(omega)))
            .collect()
    }

    #[test]
    fn a_resolved_curve_asks_for_nothing_and_a_coarse_one_for_points_about_its_peak() {
        // Ten points per decade resolve a relaxation.
        assert!(candidates(&curve(debye, 10_f64.powf(0.1))).is_empty());
        let asked = candidates(&curve(debye, 4.0));
        assert!(!asked.is_empty());
        assert!(
            asked.iter().all(|omega| (0.02..50.0).contains(omega)),
            "{asked:?}"
        );
    }

    #[test]
    fn refining_ends_with_a_resolved_curve() {
        let loss = |omega: f64| debye(omega) + 0.3 * debye(40.0 * omega);
        let mut points = curve(loss, 8.0);
        for _ in 0..8 {
            let asked = candidates(&points);
            points.extend(asked.iter().map(|omega| (*omega, loss(*omega))));
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        assert!(candidates(&points).is_empty());
        // Far fewer than the same resolution everywhere would take.
        assert!(points.len() < 40, "{}", points.len());
    }

    #[test]
    fn a_power_law_is_resolved_by_any_samples() {
        assert!(candidates(&curve(|omega| omega.powf(-0.7), 30.0)).is_empty());
        assert!(candidates(&[(1.0, 2.0)]).is_empty());
    }
}
