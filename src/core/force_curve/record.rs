//! A measured force curve, and the fewer points that a fit takes of it.

use crate::numerics::order::median;

/// Force over indentation over time, of one approach, hold and retraction or several.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ForceCurve {
    /// How messages and tables call it.
    pub name: String,
    pub time_s: Vec<f64>,
    pub force_n: Vec<f64>,
    /// From any zero: where the contact begins is sought.
    pub indentation_m: Vec<f64>,
    /// What moves the instrument, which a drag goes with, where that is not the indentation.
    pub travel_m: Option<Vec<f64>>,
    /// Where on the specimen it was taken, of a map.
    pub place_m: Option<(f64, f64)>,
}

/// About how many points are left of a curve.
const POINTS: usize = 240;

/// By how many standard deviations samples may scatter about a line (root mean square) to be one point.
const STRAIGHT: f64 = 2.0;

/// The least noise, as a part of the range of a signal: below it the model is not exact.
const LEAST_NOISE: f64 = 2e-5;

/// Longest point after a corner of the indentation, as a part of the time since then: on that scale a body relaxes.
const SINCE_CORNER: f64 = 0.15;

/// A change of the speed that is a corner, as a part of the largest.
const CORNER: f64 = 0.1;

/// How far the indentation may be off a line within a point, as a part of its range.
const BENT: f64 = 1e-4;

/// Means over samples that lie on a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    pub time_s: Vec<f64>,
    pub force_n: Vec<f64>,
    /// Without its noise.
    pub indentation_m: Vec<f64>,
    /// How fast the instrument moves.
    pub speed_m_per_s: Vec<f64>,
    /// Of how many samples each is the mean.
    pub samples: Vec<f64>,
    /// Standard deviation of the force of a sample, as its neighbours tell it.
    pub noise_n: f64,
}

impl Points {
    /// Leaves out all from one on.
    pub(super) fn truncate(&mut self, count: usize) {
        for column in [
            &mut self.time_s,
            &mut self.force_n,
            &mut self.indentation_m,
            &mut self.speed_m_per_s,
            &mut self.samples,
        ] {
            column.truncate(count);
        }
    }
}

impl ForceCurve {
    /// The points of a fit.
    pub fn points(&self) -> Points {
        let count = self.time_s.len();
        let noise_n = deviation(&self.force_n);
        let (indentation_m, corners) = smooth(&self.time_s, &self.indentation_m);
        let travel_m = self.travel_m.as_ref();
        let travel_m = travel_m.map(|travel_m| smooth(&self.time_s, travel_m).0);
        let travel_m = travel_m.as_ref().unwrap_or(&indentation_m);
        let bent_m = BENT * span(&indentation_m);
        let mut points = Points {
            time_s: Vec::new(),
            force_n: Vec::new(),
            indentation_m: Vec::new(),
            speed_m_per_s: Vec::new(),
            samples: Vec::new(),
            noise_n,
        };
        let size = count.div_ceil(POINTS);
        let mut left: Vec<(usize, usize)> = Vec::new();
        let (mut from, mut corner) = (0, 0);
        let mut corners = corners.into_iter().chain([count]).peekable();
        while from < count {
            while let Some(next) = corners.next_if(|next| *next <= from) {
                corner = next;
            }
            let most = SINCE_CORNER * (self.time_s[from] - self.time_s[corner]);
            let is_short =
                |to: &usize| corner == 0 || self.time_s[to - 1] - self.time_s[from] <= most;
            let end = (from + size).min(corners.peek().copied().unwrap_or(count));
            let to = (from + 1..=end).take_while(is_short).last();
            let to = to.unwrap_or(from + 1);
            left.push((from, to));
            from = to;
        }
        left.reverse();
        while let Some((from, to)) = left.pop() {
            let is_line = |signal: &[f64], allowed: f64| {
                Line::of(&self.time_s[from..to], &signal[from..to]).scatter <= allowed
            };
            let is_point =
                is_line(&self.force_n, STRAIGHT * noise_n) && is_line(&indentation_m, bent_m);
            if to - from > 2 && !is_point {
                let middle = usize::midpoint(from, to);
                left.extend([(middle, to), (from, middle)]);
                continue;
            }
            let mean = |signal: &[f64]| signal[from..to].iter().sum::<f64>() / (to - from) as f64;
            points.time_s.push(mean(&self.time_s));
            points.force_n.push(mean(&self.force_n));
            points.indentation_m.push(mean(&indentation_m));
            let around = from.saturating_sub(1)..(to + 1).min(count);
            let line = Line::of(&self.time_s[around.clone()], &travel_m[around]);
            points.speed_m_per_s.push(line.slope);
            points.samples.push((to - from) as f64);
        }
        points
    }
}

fn span(signal: &[f64]) -> f64 {
    let most = signal.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
    let least = signal.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    most - least
}

/// Standard deviation of white noise on a smooth signal: the median of its third differences, of which a corner of the signal makes few
/// large.
fn deviation(signal: &[f64]) -> f64 {
    let third = |w: &[f64]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs();
    let differences: Vec<f64> = signal.windows(4).map(third).collect();
    // The median of a normal variable's size is 0.6745 of its deviation; the weights squared sum to 20.
    let found = median(&differences) / (0.674_490 * 20_f64.sqrt());
    found.max(LEAST_NOISE * span(signal))
}

/// A signal without its noise: straight between knots, which are as many as it takes that nothing but noise is left. What is prescribed
/// moves in ramps and holds, and its noise would move the contact, which answers the more stiffly the faster that is.
/// Behind it where its corners are.
fn smooth(time_s: &[f64], signal: &[f64]) -> (Vec<f64>, Vec<usize>) {
    let noise = deviation(signal);
    let last = signal.len() - 1;
    let mut knots = vec![0, last];
    loop {
        let fitted = through_knots(time_s, signal, &knots);
        let more: Vec<usize> = (knots.windows(2))
            .filter(|ends| ends[1] - ends[0] > 1)
            .filter(|ends| {
                let off = signal[ends[0]..ends[1]]
                    .iter()
                    .zip(&fitted[ends[0]..ends[1]]);
                let off: Vec<f64> = off.map(|(own, fitted)| (own - fitted) / noise).collect();
                !is_noise(&off)
            })
            .map(|ends| usize::midpoint(ends[0], ends[1]))
            .collect();
        if more.is_empty() {
            settle(time_s, signal, noise, &mut knots);
            let fitted = through_knots(time_s, signal, &knots);
            let slope = |ends: &[usize]| {
                (fitted[ends[1]] - fitted[ends[0]]) / (time_s[ends[1]] - time_s[ends[0]])
            };
            let slopes: Vec<f64> = knots.windows(2).map(slope).collect();
            let steepest = slopes.iter().fold(0.0_f64, |a, slope| a.max(slope.abs()));
            let turns = slopes.windows(2).zip(&knots[1..]);
            let turns = turns.filter(|(s, _)| (s[1] - s[0]).abs() > CORNER * steepest);
            let corners = turns.map(|(_, knot)| *knot).collect();
            return (fitted, corners);
        }
        knots.extend(more);
        knots.sort_unstable();
    }
}

/// Leaves out the knots that it goes without, and puts each of the others where it leaves least.
fn settle(time_s: &[f64], signal: &[f64], noise: f64, knots: &mut Vec<usize>) {
    // Two pieces on either side: what is farther away hardly changes.
    let off = |around: &[usize]| -> Vec<f64> {
        let fitted = through_knots(time_s, signal, around);
        let own = &signal[around[0]..=around[around.len() - 1]];
        own.iter()
            .zip(&fitted)
            .map(|(own, fitted)| (own - fitted) / noise)
            .collect()
    };
    let around = |knots: &[usize], at: usize| (at.saturating_sub(2), (at + 3).min(knots.len()));
    let mut at = 1;
    while at + 1 < knots.len() {
        let (from, to) = around(knots, at);
        let mut without = knots[from..to].to_vec();
        without.remove(at - from);
        let left = off(&without);
        let all_noise = without
            .windows(2)
            .all(|ends| is_noise(&left[ends[0] - without[0]..ends[1] - without[0]]));
        match all_noise {
            true => {
                knots.remove(at);
                at = at.saturating_sub(1).max(1);
            }
            false => at += 1,
        }
    }
    for at in 1..knots.len().saturating_sub(1) {
        let (from, to) = around(knots, at);
        let mut own = knots[from..to].to_vec();
        let squares = |own: &[usize]| off(own).iter().map(|off| off * off).sum::<f64>();
        let mut least = squares(&own);
        let mut step = (own[at - from + 1] - own[at - from - 1]) / 4;
        while step > 0 {
            let here = own[at - from];
            let (low, high) = (own[at - from - 1] + 1, own[at - from + 1] - 1);
            let mut is_better = false;
            for next in [here.saturating_sub(step).max(low), (here + step).min(high)] {
                let before = std::mem::replace(&mut own[at - from], next);
                let left = squares(&own);
                match left < least {
                    true => (least, is_better) = (left, true),
                    false => own[at - from] = before,
                }
            }
            if !is_better {
                step /= 2;
            }
        }
        knots[at] = own[at - from];
    }
}

/// Whether nothing but white noise of deviation one is left: means over quarters show what is slower.
fn is_noise(off: &[f64]) -> bool {
    let part = off.len().div_ceil(4);
    let parts = off.chunks(part);
    let squares: f64 = parts
        .clone()
        .map(|part| part.iter().sum::<f64>().powi(2) / part.len() as f64)
        .sum();
    let freedom = parts.len() as f64;
    squares <= freedom + 3.0 * (2.0 * freedom).sqrt()
}

/// The continuous signal that is linear between knots and nearest to the samples, at the samples.
fn through_knots(time_s: &[f64], signal: &[f64], knots: &[usize]) -> Vec<f64> {
    let count = knots.len();
    let (mut diagonal, mut beside, mut right) =
        (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
    let share = |piece: usize, k: usize| {
        let (from, to) = (time_s[knots[piece]], time_s[knots[piece + 1]]);
        if to > from {
            (time_s[k] - from) / (to - from)
        } else {
            0.0
        }
    };
    // Every sample is of the piece that begins at or before it.
    let pieces = || {
        (0..count - 1).flat_map(|piece| {
            let end = knots[piece + 1] + usize::from(piece + 2 == count);
            (knots[piece]..end).map(move |k| (piece, k))
        })
    };
    for (piece, k) in pieces() {
        let late = share(piece, k);
        let early = 1.0 - late;
        diagonal[piece] += early * early;
        diagonal[piece + 1] += late * late;
        beside[piece] += early * late;
        right[piece] += early * signal[k];
        right[piece + 1] += late * signal[k];
    }
    // Tridiagonal, by elimination.
    for k in 1..count {
        let factor = beside[k - 1] / diagonal[k - 1];
        diagonal[k] -= factor * beside[k - 1];
        right[k] -= factor * right[k - 1];
    }
    let mut values = right;
    values[count - 1] /= diagonal[count - 1];
    for k in (0..count - 1).rev() {
        values[k] = (values[k] - beside[k] * values[k + 1]) / diagonal[k];
    }
    let at = |(piece, k): (usize, usize)| {
        values[piece] + share(piece, k) * (values[piece + 1] - values[piece])
    };
    pieces().map(at).collect()
}

/// A line through samples.
struct Line {
    slope: f64,
    /// Root mean square distance, per degree of freedom.
    scatter: f64,
}

impl Line {
    fn of(time_s: &[f64], signal: &[f64]) -> Self {
        let n = signal.len() as f64;
        let (mean_t, mean_y) = (
            time_s.iter().sum::<f64>() / n,
            signal.iter().sum::<f64>() / n,
        );
        let pairs = || {
            let pairs = time_s.iter().zip(signal);
            pairs.map(|(t, y)| (t - mean_t, y - mean_y))
        };
        let squares: f64 = pairs().map(|(t, _)| t * t).sum();
        let slope = match squares > 0.0 {
            true => pairs().map(|(t, y)| t * y).sum::<f64>() / squares,
            false => 0.0,
        };
        let off: f64 = pairs().map(|(t, y)| (y - slope * t).powi(2)).sum();
        Self {
            slope,
            scatter: (off / (n - 2.0).max(1.0)).sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::random;

    #[test]
    fn a_ramp_and_its_corner_are_found_in_noise_and_the_points_have_all_samples() {
        let mut random = random::Noise(3);
        let count = 4000;
        let mut curve = ForceCurve::default();
        for k in 0..count {
            let t = k as f64 / count as f64;
            let ramp = 1.0 - (2.0 * t - 1.0).abs();
            curve.time_s.push(t);
            curve
                .force_n
                .push(1e-6 * (ramp.powf(1.5) + 0.01 * random.normal()));
            curve
                .indentation_m
                .push(1e-6 * (ramp + 0.02 * random.normal()));
        }
        let points = curve.points();
        assert!((points.noise_n / 1e-8 - 1.0).abs() < 0.06);
        assert!((POINTS..POINTS + 20).contains(&points.time_s.len()));
        assert_eq!(points.samples.iter().sum::<f64>(), count as f64);
        for (t, depth) in points.time_s.iter().zip(&points.indentation_m) {
            let ramp = 1.0 - (2.0 * t - 1.0).abs();
            assert!((depth / 1e-6 - ramp).abs() < 0.01, "{t}: {depth}");
        }
    }
}
