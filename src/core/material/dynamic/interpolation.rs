//! Shift factors between isotherms: monotone cubics, in a coordinate in which the law of the factors is a straight line.

use crate::numerics::order::bracket;

/// Pairs ascending in the first, joined by cubics that are monotone wherever the pairs are (F. N. Fritsch and J. Butland, SIAM
/// J. Sci. Stat. Comput. 5 (1984) 300). `None` outside, and where there is none.
pub(super) fn monotone(pairs: &[(f64, f64)], x: f64) -> Option<f64> {
    let next = pairs.iter().position(|pair| pair.0 >= x)?;
    let right = pairs.get(next)?;
    if right.0 == x {
        return Some(right.1);
    }
    let left = pairs.get(next.checked_sub(1)?)?;
    let step = right.0 - left.0;
    let slopes = (slope(pairs, next - 1)?, slope(pairs, next)?);
    let t = (x - left.0) / step;
    let (t2, t3) = (t * t, t * t * t);
    Some(
        left.1 * (2.0 * t3 - 3.0 * t2 + 1.0)
            + right.1 * (3.0 * t2 - 2.0 * t3)
            + step * (slopes.0 * (t3 - 2.0 * t2 + t) + slopes.1 * (t3 - t2)),
    )
}

/// Slope at a pair: at an end that of the last piece, between pieces their weighted harmonic mean, zero where they rise and fall.
fn slope(pairs: &[(f64, f64)], at: usize) -> Option<f64> {
    let piece = |from: usize| {
        let (left, right) = (pairs.get(from)?, pairs.get(from + 1)?);
        Some((right.0 - left.0, (right.1 - left.1) / (right.0 - left.0)))
    };
    match (at.checked_sub(1).and_then(piece), piece(at)) {
        (Some((h0, d0)), Some((h1, d1))) => {
            let weight = (h0 + 2.0 * h1) / (3.0 * (h0 + h1));
            let harmonic = d0 * d1 / (weight * d1 + (1.0 - weight) * d0);
            Some(if d0 * d1 > 0.0 { harmonic } else { 0.0 })
        }
        (Some(one), None) | (None, Some(one)) => Some(one.1),
        (None, None) => None,
    }
}

/// The factor (log10 a_T) at a temperature, of factors at ascending temperatures and the law of them, where it has one: between two of them by
/// [`monotone`], outside the law goes on from the last one.
pub(super) fn log10_a_t(
    factors: &[(f64, f64)],
    law: &dyn Fn(f64) -> Option<f64>,
    temperature_k: f64,
) -> Option<f64> {
    let (first, last) = (factors.first()?, factors.last()?);
    if !(first.0..=last.0).contains(&temperature_k) {
        let end = if temperature_k < first.0 { first } else { last };
        return Some(end.1 + (law(temperature_k)? - law(end.0)?));
    }
    // Over the law where it falls with the temperature, as it does for all but odd data; turned round to rise.
    let straight = |t: f64| Some(-law(t)?);
    let over_law = factors.iter().map(|pair| Some((straight(pair.0)?, pair.1)));
    let over_law: Option<Vec<(f64, f64)>> = over_law.collect();
    let ascending = |pairs: &Vec<(f64, f64)>| pairs.windows(2).all(|pair| pair[0].0 < pair[1].0);
    match (over_law.filter(ascending), straight(temperature_k)) {
        (Some(over_law), Some(x)) => monotone(&over_law, x),
        _ => monotone(factors, temperature_k),
    }
}

/// How the factor at a temperature depends on those at others, in first order: between two, by the share of the way from one to the
/// other; outside, on the last one.
pub(super) fn weights(temperatures_k: &[f64], temperature_k: f64) -> Vec<f64> {
    let (left, right, share) = bracket(temperatures_k, temperature_k);
    let mut weights = vec![0.0; temperatures_k.len()];
    weights[left] = 1.0 - share;
    weights[right] += share;
    weights
}
