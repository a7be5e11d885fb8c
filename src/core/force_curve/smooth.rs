//! A signal without its noise: straight between knots, which are as many as it takes that nothing but noise is left. What is prescribed moves
//! in ramps and holds, and its noise would move the contact, which answers the more stiffly the faster that is.

use std::ops::Range;

use super::record::deviation;

/// A change of the speed that is a corner, as a part of the largest.
const CORNER: f64 = 0.1;

/// Knots that are no farther apart than this many samples may be one corner.
const NEIGHBOURS: usize = 3;

/// By how much the sum of squares may rise for a corner with one unknown less.
const NO_MORE: f64 = 9.0;

/// Samples of a piece that tell its line.
const FEWEST_OF_PIECE: usize = 4;

/// The signal, linear between its knots.
#[derive(Debug, Clone)]
pub(super) struct Smooth {
    knots_s: Vec<f64>,
    values: Vec<f64>,
    pub(super) at_samples: Vec<f64>,
}

/// Where the signal turns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub(super) time_s: f64,
    pub(super) value: f64,
    /// The first sample at or behind it.
    pub(super) sample: usize,
}

/// A signal of which the knots are sought.
#[derive(Clone, Copy)]
struct Noisy<'a> {
    time_s: &'a [f64],
    signal: &'a [f64],
    noise: f64,
}

impl Smooth {
    pub(super) fn new(time_s: &[f64], signal: &[f64]) -> Self {
        let noisy = Noisy {
            time_s,
            signal,
            noise: deviation(signal).max(f64::MIN_POSITIVE),
        };
        let last = signal.len() - 1;
        let mut knots = vec![0, last];
        loop {
            let off = noisy.off(&noisy.times(&knots));
            let is_bent =
                |ends: &&[usize]| ends[1] - ends[0] > 1 && !is_noise(&off[ends[0]..ends[1]]);
            let bent = knots.windows(2).filter(is_bent);
            let more: Vec<usize> = bent.map(|ends| usize::midpoint(ends[0], ends[1])).collect();
            if more.is_empty() {
                break;
            }
            knots.extend(more);
            knots.sort_unstable();
        }
        noisy.leave_out(&mut knots);
        noisy.shift(&mut knots);
        let knots_s = noisy.between_samples(&knots);
        let (values, at_samples) = noisy.through(&knots_s);
        Self {
            knots_s,
            values,
            at_samples,
        }
    }

    /// Where the slope changes by more than a part of the steepest.
    pub(super) fn corners(&self, time_s: &[f64]) -> Vec<Corner> {
        let pieces = self.knots_s.windows(2).zip(self.values.windows(2));
        let slopes: Vec<f64> = pieces.map(|(t, v)| (v[1] - v[0]) / (t[1] - t[0])).collect();
        let steepest = slopes.iter().fold(0.0_f64, |a, slope| a.max(slope.abs()));
        let turns = slopes.windows(2).enumerate();
        let turns = turns.filter(|(_, s)| (s[1] - s[0]).abs() > CORNER * steepest);
        let corner = |(piece, _)| {
            let (time, value) = (self.knots_s[piece + 1], self.values[piece + 1]);
            Corner {
                time_s: time,
                value,
                sample: time_s.partition_point(|t| *t < time),
            }
        };
        turns.map(corner).collect()
    }
}

impl Noisy<'_> {
    fn times(&self, knots: &[usize]) -> Vec<f64> {
        knots.iter().map(|knot| self.time_s[*knot]).collect()
    }

    /// The samples from the first to the last of some knots.
    fn samples(&self, knots_s: &[f64]) -> Range<usize> {
        let (first, last) = (knots_s[0], knots_s[knots_s.len() - 1]);
        let from = self.time_s.partition_point(|t| *t < first);
        from..self.time_s.partition_point(|t| *t <= last)
    }

    /// What the signal that is linear between these knots leaves of their samples, in standard deviations of the noise.
    fn off(&self, knots_s: &[f64]) -> Vec<f64> {
        let own = &self.signal[self.samples(knots_s)];
        let (_, fitted) = self.through(knots_s);
        let both = own.iter().zip(fitted);
        both.map(|(own, fitted)| (own - fitted) / self.noise)
            .collect()
    }

    fn squares(&self, knots_s: &[f64]) -> f64 {
        self.off(knots_s).iter().map(|off| off * off).sum()
    }

    /// The continuous signal that is linear between knots and nearest to their samples: at the knots, and at the samples.
    fn through(&self, knots_s: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let count = knots_s.len();
        let (mut diagonal, mut beside, mut right) =
            (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        let mut piece = 0;
        let shares = self.samples(knots_s).map(|k| {
            while piece + 2 < count && self.time_s[k] >= knots_s[piece + 1] {
                piece += 1;
            }
            let (from, to) = (knots_s[piece], knots_s[piece + 1]);
            let late = if to > from {
                (self.time_s[k] - from) / (to - from)
            } else {
                0.0
            };
            (piece, late, self.signal[k])
        });
        let shares: Vec<(usize, f64, f64)> = shares.collect();
        for &(piece, late, value) in &shares {
            let early = 1.0 - late;
            diagonal[piece] += early * early;
            diagonal[piece + 1] += late * late;
            beside[piece] += early * late;
            right[piece] += early * value;
            right[piece + 1] += late * value;
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
        let at = |&(piece, late, _): &(usize, f64, f64)| {
            values[piece] + late * (values[piece + 1] - values[piece])
        };
        let at_samples = shares.iter().map(at).collect();
        (values, at_samples)
    }

    /// Leaves out the knots that it goes without.
    fn leave_out(&self, knots: &mut Vec<usize>) {
        let mut at = 1;
        while at + 1 < knots.len() {
            let around = around(knots, at);
            let mut without = knots[around.clone()].to_vec();
            without.remove(at - around.start);
            let left = self.off(&self.times(&without));
            let mut pieces = without.windows(2);
            let all_noise =
                pieces.all(|ends| is_noise(&left[ends[0] - without[0]..ends[1] - without[0]]));
            match all_noise {
                true => {
                    knots.remove(at);
                    at = at.saturating_sub(1).max(1);
                }
                false => at += 1,
            }
        }
    }

    /// Puts each knot on the sample where it leaves least.
    fn shift(&self, knots: &mut [usize]) {
        for at in 1..knots.len().saturating_sub(1) {
            let around = around(knots, at);
            let mut own = knots[around.clone()].to_vec();
            let at = at - around.start;
            let mut least = self.squares(&self.times(&own));
            let mut step = (own[at + 1] - own[at - 1]) / 4;
            while step > 0 {
                let here = own[at];
                let (low, high) = (own[at - 1] + 1, own[at + 1] - 1);
                let mut is_better = false;
                for next in [here.saturating_sub(step).max(low), (here + step).min(high)] {
                    let before = std::mem::replace(&mut own[at], next);
                    let left = self.squares(&self.times(&own));
                    match left < least {
                        true => (least, is_better) = (left, true),
                        false => own[at] = before,
                    }
                }
                if !is_better {
                    step /= 2;
                }
            }
            knots[around.start + at] = own[at];
        }
    }

    /// The times of the knots, each where the lines of its two pieces meet, if that is beside its sample and leaves no more: a corner is
    /// between two samples, and a path through these alone would cut it off. Two knots on neighbouring samples are one such corner.
    fn between_samples(&self, knots: &[usize]) -> Vec<f64> {
        let mut knots_s = self.times(&knots[..1]);
        let mut at = 1;
        while at + 1 < knots.len() {
            let next = match at + 2 < knots.len() && knots[at + 1] - knots[at] <= NEIGHBOURS {
                true => at + 1,
                false => at,
            };
            match self.meeting_s(knots, at..next) {
                Some(meeting_s) if knots_s.last().is_some_and(|last| meeting_s > *last) => {
                    knots_s.push(meeting_s);
                }
                _ => knots_s.extend(self.times(&knots[at..=next])),
            }
            at = next + 1;
        }
        knots_s.extend(self.times(&knots[knots.len() - 1..]));
        knots_s
    }

    /// Where the lines before and after these knots meet, one or two.
    fn meeting_s(&self, knots: &[usize], at: Range<usize>) -> Option<f64> {
        let (first, last) = (knots[at.start], knots[at.end]);
        let (before, after) = (knots[at.start - 1] + 1..first, last + 1..knots[at.end + 1]);
        if before.len().min(after.len()) < FEWEST_OF_PIECE {
            return None;
        }
        let line =
            |samples: Range<usize>| Line::of(&self.time_s[samples.clone()], &self.signal[samples]);
        let meeting_s = line(before).meets(&line(after))?;
        if !(self.time_s[first - 1]..self.time_s[last + 1]).contains(&meeting_s) {
            return None;
        }
        let around = at.start - 1..at.end + 2;
        let least = self.squares(&self.times(&knots[around]));
        let ends = self.times(&[knots[at.start - 1], knots[at.end + 1]]);
        let left = self.squares(&[ends[0], meeting_s, ends[1]]);
        (left <= least + NO_MORE).then_some(meeting_s)
    }
}

/// Two pieces on either side of a knot: what is farther away hardly changes with it.
fn around(knots: &[usize], at: usize) -> Range<usize> {
    at.saturating_sub(2)..(at + 3).min(knots.len())
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

/// A line through samples.
pub(super) struct Line {
    pub(super) slope: f64,
    /// Where it is at the mean of the times.
    middle: (f64, f64),
    /// Root mean square distance, per degree of freedom.
    pub(super) scatter: f64,
}

impl Line {
    pub(super) fn of(time_s: &[f64], signal: &[f64]) -> Self {
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
            middle: (mean_t, mean_y),
            scatter: (off / (n - 2.0).max(1.0)).sqrt(),
        }
    }

    /// The value at a time.
    pub(super) fn at(&self, time_s: f64) -> f64 {
        self.middle.1 + self.slope * (time_s - self.middle.0)
    }

    /// The time at which another line is met; `None` of lines that are parallel.
    fn meets(&self, other: &Self) -> Option<f64> {
        let at = |line: &Self| line.middle.1 - line.slope * line.middle.0;
        let meeting_s = (at(other) - at(self)) / (self.slope - other.slope);
        meeting_s.is_finite().then_some(meeting_s)
    }
}
