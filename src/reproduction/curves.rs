//! How the figures tell closed forms from computed points: lines against symbols, one symbol per engine, one colour and line
//! style per member of a family; and where curves have their extrema.

use super::{ReproductionError, Result};
use crate::report::chart::{Color, LineStyle, Marker, Series};
use crate::sweep::search::peak::vertex;

/// A place in a family of curves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member {
    pub(super) step: usize,
    pub(super) of: usize,
}

impl Member {
    fn color(self) -> Color {
        Color::Ramp {
            step: self.step,
            of: self.of,
        }
    }

    /// A closed form, or the exact solution in its place.
    pub(super) fn line<P: Into<Option<(f64, f64)>>>(self, points: Vec<P>) -> Series {
        Series::line(points)
            .color(self.color())
            .style(LineStyle::nth(self.step))
    }

    /// Points computed by the axisymmetric engine, which is named in the legend where this is the last of the family.
    pub(super) fn springs<P: Into<Option<(f64, f64)>>>(self, points: Vec<P>) -> Series {
        self.symbols(points, Marker::Cross, SPRINGS.to_owned())
    }

    /// Points computed by the half-space engine with so many cells per side, likewise.
    pub(super) fn cells<P: Into<Option<(f64, f64)>>>(self, points: Vec<P>, side: usize) -> Series {
        self.symbols(points, Marker::Ring, cells_label(side))
    }

    fn symbols<P: Into<Option<(f64, f64)>>>(
        self,
        points: Vec<P>,
        marker: Marker,
        label: String,
    ) -> Series {
        let symbols = Series::scatter(points).color(self.color()).marker(marker);
        match self.step + 1 == self.of {
            true => symbols.label(label),
            false => symbols,
        }
    }
}

pub(super) const SPRINGS: &str = "axisymmetric engine";

/// The half-space engine with so many cells per side.
pub(super) fn cells_label(side: usize) -> String {
    format!("half-space engine, {side} × {side} cells")
}

/// About so many of the points, evenly spread, the first and the last among them.
pub(super) fn spread<T: Copy>(points: &[T], count: usize) -> Vec<T> {
    let last = points.len().saturating_sub(1);
    if points.len() <= count {
        return points.to_vec();
    }
    let parts = count.saturating_sub(1).max(1);
    (0..=parts)
        .filter_map(|k| points.get(k * last / parts).copied())
        .collect()
}

/// A function at `parts + 1` places from `from` to `to`.
pub(super) fn curve<Y>(from: f64, to: f64, parts: usize, y: impl Fn(f64) -> Y) -> Vec<(f64, Y)> {
    let places = (0..=parts).map(|k| from + (to - from) * k as f64 / parts as f64);
    places.map(|x| (x, y(x))).collect()
}

/// The largest or smallest sample of a signal within its part that is `meant`: when, from a parabola through samples `reach`
/// apart, and its value.
pub(super) fn extremum(
    signal: &[(f64, f64)],
    meant: impl Fn(f64) -> bool,
    is_largest: bool,
    reach: usize,
) -> Option<(f64, f64)> {
    let sign = if is_largest { 1.0 } else { -1.0 };
    let places = (0..signal.len()).filter(|&k| meant(signal[k].0));
    let height = |k: usize| sign * signal[k].1;
    let best = places.max_by(|&a, &b| height(a).total_cmp(&height(b)))?;
    let (before, after) = (best.checked_sub(reach)?, best + reach);
    (after < signal.len()).then_some(())?;
    let about = [before, best, after];
    let (time, _) = vertex(&about.map(|k| signal[k].0), &about.map(height))?;
    Some((time, signal[best].1))
}

/// The point of a curve at this x and its neighbours.
pub(super) fn about(points: &[(f64, f64)], x: f64) -> Result<[(f64, f64); 3]> {
    let near = |three: &&[(f64, f64)]| (three[1].0 / x - 1.0).abs() < 1e-9;
    let found = points.windows(3).find(near);
    let unfit = || ReproductionError::Unfit(format!("{x} and its neighbours were not computed"));
    found
        .map(|three| [three[0], three[1], three[2]])
        .ok_or_else(unfit)
}

/// Maximum of the parabola in ln x through three points that are equally spaced there: (x, y).
pub(super) fn peak(points: [(f64, f64); 3]) -> Result<(f64, f64)> {
    let [(low, _), (middle, _), (high, _)] = points;
    let width = 0.5 * (high / low).ln();
    let found = vertex(&[-width, 0.0, width], &points.map(|p| p.1));
    let unfit = || ReproductionError::Unfit(format!("no maximum at {middle}"));
    let (shift, y) = found.ok_or_else(unfit)?;
    Ok((middle * shift.exp(), y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_in_the_logarithm_has_its_maximum_found() {
        let y = |x: f64| 3.0 - 2.0 * (x / 0.7).ln().powi(2);
        let found = peak([0.5, 0.6, 0.72].map(|x: f64| (x, y(x)))).unwrap();
        assert!((found.0 - 0.7).abs() < 1e-12 && (found.1 - 3.0).abs() < 1e-12);
    }

    #[test]
    fn an_extremum_lies_between_samples_and_within_its_part() {
        let wave = |k: i32| (f64::from(k), (0.5 * f64::from(k) - 0.1).sin());
        let signal: Vec<(f64, f64)> = (0..20).map(wave).collect();
        let found = |is_largest| extremum(&signal, |t| t > 5.0 && t < 17.0, is_largest, 1);
        let (largest, smallest) = (found(true).unwrap(), found(false).unwrap());
        let turn = std::f64::consts::TAU + std::f64::consts::FRAC_PI_2;
        assert!((largest.0 - 2.0 * (turn + 0.1)).abs() < 0.02, "{largest:?}");
        assert_eq!(largest.1, signal[16].1);
        assert!(smallest.0 > 9.0 && smallest.0 < 10.0 && smallest.1 < -0.9);
        assert_eq!(extremum(&signal, |t| t > 17.5, true, 5), None);
    }
}
