//! The shift between two neighbouring isotherms, in closed form where they share a range of moduli.
//!
//! Closed form: the area between the two curves over the ordinates that they share, over the height of that range, in logarithms
//! (M. Gergesova, B. Zupancic, I. Saprunov, I. Emri, J. Rheol. 55 (2011) 1), on storage and loss modulus, each by what its noise
//! leaves of it; on the tangent of the phase angle where the moduli may be shifted too. Where no property says anything, or one
//! series through both isotherms says otherwise, the shift is searched for.

use std::f64::consts::LN_10;

use super::noise::Noise;
use super::one_curve::OneCurve;
use super::{DynamicPoint, Isotherm};

/// Step of the search (decades), less than what one series finds its way from.
const SEARCH_STEP: f64 = 0.25;

/// Sums of squares that are alike: what a shift may be worse than another one and still be as good.
const ALIKE: f64 = 6.0;

/// How much more one series for both isotherms may leave than one for each, before the shift is searched for: some ten unknowns
/// less, and four standard deviations of what they take up.
const ACCEPTED: f64 = 30.0;

/// log10 a_T of each isotherm, neighbour after neighbour from the coldest, which has zero.
pub(super) fn chain(isotherms: &[Isotherm], noise: &Noise, vertical: bool) -> Vec<f64> {
    let mut shifts = vec![0.0; isotherms.len().min(1)];
    for pair in isotherms.windows(2) {
        let last = shifts.last().copied().unwrap_or_default();
        shifts.push(last - between(&pair[0], &pair[1], noise, vertical));
    }
    shifts
}

/// log10 a_T of the colder less that of the hotter.
fn between(colder: &Isotherm, hotter: &Isotherm, noise: &Noise, vertical: bool) -> f64 {
    let curve = OneCurve::new(&[colder, hotter], noise, 1, vertical);
    let alone = |isotherm| {
        OneCurve::new(&[isotherm], noise, 0, false)
            .at(&[0.0], &[])
            .squares
    };
    let best = alone(colder) + alone(hotter);
    // Where not even a curve for each comes near the noise, what is accepted grows with what they leave.
    let values = 2 * (colder.points.len() + hotter.points.len());
    let accepted = best + ACCEPTED * (2.0 * best / values as f64).max(1.0);
    let closed =
        closed_form(colder, hotter, noise, vertical).map(|shift| curve.refine(&[shift, 0.0]));
    if let Some(state) = closed.filter(|state| state.squares < accepted) {
        return state.places[0];
    }
    searched(&curve, colder, hotter)
}

/// The smallest shift that is as good as any, from where the isotherms lie the wrong way round to where they do not meet.
fn searched(curve: &OneCurve, colder: &Isotherm, hotter: &Isotherm) -> f64 {
    let (lowest, highest) = (colder.window_rad_per_s().0, hotter.window_rad_per_s().1);
    // The colder isotherm's frequencies end up a decade above the hotter's at most.
    let most = highest.log10() - lowest.log10() + 1.0;
    let steps = ((most + 1.0) / SEARCH_STEP).ceil().max(1.0) as usize;
    let tried = (0..=steps).map(|i| -1.0 + SEARCH_STEP * i as f64);
    let mut times = Vec::new();
    let tried = tried.map(|shift| {
        let state = curve.at(&curve.places(&[shift, 0.0]), &times);
        times = state.times;
        (shift, state.squares)
    });
    let tried: Vec<(f64, f64)> = tried.collect();
    let least = tried.iter().map(|t| t.1).fold(f64::INFINITY, f64::min);
    let valleys = (0..tried.len()).filter(|&i| {
        let no_less = |other: Option<&(f64, f64)>| other.is_none_or(|o| o.1 >= tried[i].1);
        no_less(i.checked_sub(1).and_then(|j| tried.get(j))) && no_less(tried.get(i + 1))
    });
    let refined = valleys
        .filter(|&i| tried[i].1 < 4.0 * least + 100.0)
        .map(|i| curve.refine(&[tried[i].0, 0.0]));
    let refined: Vec<_> = refined.collect();
    let least = refined
        .iter()
        .map(|s| s.squares)
        .fold(f64::INFINITY, f64::min);
    let noise = (least / curve.count() as f64).max(1.0);
    let alike = refined
        .iter()
        .filter(|s| s.squares < least + ALIKE * noise)
        .map(|s| s.places[0]);
    alike
        .min_by(|a, b| a.abs().total_cmp(&b.abs()))
        .unwrap_or_default()
}

/// Mean of the closed forms of the properties, each weighted by its own error; `None` where none applies.
pub(super) fn closed_form(
    colder: &Isotherm,
    hotter: &Isotherm,
    noise: &Noise,
    vertical: bool,
) -> Option<f64> {
    let storage = |p: &DynamicPoint| p.storage_modulus_pa.ln();
    let loss = |p: &DynamicPoint| p.loss_modulus_pa.ln();
    let tangent = |p: &DynamicPoint| (p.loss_modulus_pa / p.storage_modulus_pa).ln();
    let of_both = noise.storage.hypot(noise.loss);
    let found = match vertical {
        true => [area(colder, hotter, tangent, of_both), None],
        false => [
            area(colder, hotter, storage, noise.storage),
            area(colder, hotter, loss, noise.loss),
        ],
    };
    let mut sums = (0.0, 0.0);
    for (shift, variance) in found.into_iter().flatten() {
        sums = (sums.0 + shift / variance, sums.1 + 1.0 / variance);
    }
    (sums.1 > 0.0).then(|| sums.0 / sums.1 / LN_10)
}

/// Shift (natural logarithm) and its variance from one property, where both isotherms rise or both fall through a range that they
/// share by more than the noise.
fn area(
    colder: &Isotherm,
    hotter: &Isotherm,
    property: impl Fn(&DynamicPoint) -> f64,
    noise: f64,
) -> Option<(f64, f64)> {
    let path = |isotherm: &Isotherm| -> Vec<(f64, f64)> {
        let points = isotherm.points.iter();
        points
            .map(|p| (p.angular_frequency_rad_per_s.ln(), property(p)))
            .collect()
    };
    let (colder, hotter) = (path(colder), path(hotter));
    let ends = |path: &[(f64, f64)]| Some((path.first()?.1, path.last()?.1));
    let (mut c, mut h) = (ends(&colder)?, ends(&hotter)?);
    let rising = c.1 > c.0;
    if rising != (h.1 > h.0) {
        return None;
    }
    if !rising {
        (c, h) = ((c.1, c.0), (h.1, h.0));
    }
    let (lowest, highest) = (c.0.max(h.0), c.1.min(h.1));
    let height = highest - lowest;
    if height < 3.0 * noise {
        return None;
    }
    let (cold_area, cold_slope, cold_points) = under(&colder, lowest, highest);
    let (hot_area, hot_slope, hot_points) = under(&hotter, lowest, highest);
    let shift = (hot_area - cold_area) / height;
    let variance = |slope: f64, points: usize| (noise / slope).powi(2) / points.max(1) as f64;
    Some((
        shift,
        variance(cold_slope, cold_points) + variance(hot_slope, hot_points),
    ))
}

/// Integral of the logarithm of the frequency over the ordinates from `lowest` to `highest` along a path that crosses them; mean
/// slope there, and the points in the range.
fn under(path: &[(f64, f64)], lowest: f64, highest: f64) -> (f64, f64, usize) {
    let mut area = 0.0;
    let mut crossed = 0.0;
    let mut length = 0.0;
    for ends in path.windows(2) {
        let ((x0, y0), (x1, y1)) = (ends[0], ends[1]);
        let (from, to) = (y0.clamp(lowest, highest), y1.clamp(lowest, highest));
        if from == to {
            continue;
        }
        let at = |y: f64| x0 + (x1 - x0) * (y - y0) / (y1 - y0);
        area += 0.5 * (at(from) + at(to)) * (to - from);
        crossed += to - from;
        length += (at(to) - at(from)).abs();
    }
    let points = path
        .iter()
        .filter(|p| (lowest..=highest).contains(&p.1))
        .count();
    let slope = (highest - lowest) / length.max(f64::MIN_POSITIVE);
    (area * (highest - lowest) / crossed, slope, points)
}
