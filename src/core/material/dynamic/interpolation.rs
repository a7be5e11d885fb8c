//! Shift factors between isotherms: monotone cubics, in a coordinate in which the law of the factors is a straight line.

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

/// Factors at temperatures, ascending, and the law that goes on where they end.
pub(super) struct Interpolation<'a, L> {
    pub(super) temperatures_k: &'a [f64],
    pub(super) log10_a_t: &'a [f64],
    pub(super) law: Option<L>,
}

impl<L: Fn(f64) -> Option<f64>> Interpolation<'_, L> {
    /// Between the temperatures by [`monotone`]; outside the law goes on from the last factor.
    pub(super) fn at(&self, temperature_k: f64) -> Option<f64> {
        let (&first, &last) = (self.temperatures_k.first()?, self.temperatures_k.last()?);
        if (first..=last).contains(&temperature_k) {
            return self.between(temperature_k);
        }
        let end = if temperature_k < first {
            0
        } else {
            self.temperatures_k.len() - 1
        };
        let law = self.law.as_ref()?;
        let change = law(temperature_k)? - law(*self.temperatures_k.get(end)?)?;
        Some(self.log10_a_t.get(end)? + change)
    }

    fn between(&self, temperature_k: f64) -> Option<f64> {
        // The law where it falls with the temperature, as it does for all but odd data; turned round to rise.
        let straight = |t: f64| Some(-self.law.as_ref()?(t)?);
        let coordinates: Option<Vec<f64>> =
            self.temperatures_k.iter().map(|&t| straight(t)).collect();
        let ascending = |c: &Vec<f64>| c.windows(2).all(|pair| pair[0] < pair[1]);
        let (coordinates, x) = match (coordinates.filter(ascending), straight(temperature_k)) {
            (Some(coordinates), Some(x)) => (coordinates, x),
            _ => (self.temperatures_k.to_vec(), temperature_k),
        };
        let pairs: Vec<(f64, f64)> = coordinates
            .into_iter()
            .zip(self.log10_a_t.iter().copied())
            .collect();
        monotone(&pairs, x)
    }

    /// How the factor at a temperature depends on those given, in first order: between two, by the share of the way from one to
    /// the other; outside, on the last one.
    pub(super) fn weights(&self, temperature_k: f64) -> Vec<f64> {
        let count = self.temperatures_k.len();
        let mut weights = vec![0.0; count];
        let next = self.temperatures_k.iter().position(|&t| t >= temperature_k);
        match next {
            Some(0) => weights[0] = 1.0,
            Some(next) => {
                let (left, right) = (self.temperatures_k[next - 1], self.temperatures_k[next]);
                let share = (temperature_k - left) / (right - left);
                weights[next - 1] = 1.0 - share;
                weights[next] = share;
            }
            None => weights.iter_mut().rev().take(1).for_each(|w| *w = 1.0),
        }
        weights
    }
}
