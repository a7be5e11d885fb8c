//! A record as an instrument gives it: samples of load and approach at times that need not be uniform, and how it was sampled.

use super::quality::Finding;
use super::{HARMONICS, MeasuredError};

/// Samples in any order; one that is not a finite number is missing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Signal {
    /// Time (s).
    pub time_s: Vec<f64>,
    /// Normal load W (N), pressure positive.
    pub load_n: Vec<f64>,
    /// Approach delta (m), into the body positive, from first touch.
    pub approach_m: Vec<f64>,
    /// Contact radius (m), where the instrument knows it.
    pub contact_radius_m: Option<Vec<f64>>,
}

/// How a record was sampled.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sampling {
    /// Samples that are used.
    pub samples: usize,
    /// Between the first and the last of them (s).
    pub duration_s: f64,
    /// Median of the intervals (s).
    pub interval_s: f64,
    /// Step between the values of the load (N) and of the approach (m), where all lie on a grid.
    pub load_step_n: Option<f64>,
    pub approach_step_m: Option<f64>,
}

/// Intervals that differ from the median by more than this part of it, as a standard deviation, are worth saying.
const JITTER: f64 = 0.01;
/// Beyond this the times are spread rather than jittering, and a long interval is no gap.
const SPREAD: f64 = 0.2;
/// An interval longer than this many median ones misses samples.
const GAP: f64 = 1.5;

impl Signal {
    /// The samples that are whole, in the order of time, and what was found on the way.
    ///
    /// # Errors
    /// Columns of different lengths, too few samples, no time between them, a signal without any change.
    pub fn prepared(&self) -> Result<(Self, Sampling, Vec<Finding>), MeasuredError> {
        let (times, loads, approaches) =
            (self.time_s.len(), self.load_n.len(), self.approach_m.len());
        if times != loads || times != approaches {
            return Err(MeasuredError::Lengths {
                times,
                loads,
                approaches,
            });
        }
        let is_whole = |i: &usize| {
            [&self.time_s, &self.load_n, &self.approach_m]
                .iter()
                .all(|column| column[*i].is_finite())
        };
        let mut order: Vec<usize> = (0..times).filter(is_whole).collect();
        let mut findings = Vec::new();
        let missing = times - order.len();
        if missing > 0 {
            findings.push(Finding::EmptyCells { rows: missing });
        }
        let later = |pair: &&[usize]| self.time_s[pair[1]] < self.time_s[pair[0]];
        let descending = order.windows(2).filter(later).count();
        if descending > 0 {
            findings.push(match descending + 1 == order.len() {
                true => Finding::DescendingTimes,
                false => Finding::UnorderedTimes { places: descending },
            });
            order.sort_by(|a, b| self.time_s[*a].total_cmp(&self.time_s[*b]));
        }
        let needed = 2 * HARMONICS;
        if order.len() < needed {
            return Err(MeasuredError::TooFewSamples {
                samples: order.len(),
                needed,
            });
        }
        let taken = |column: &[f64]| order.iter().map(|i| column[*i]).collect::<Vec<f64>>();
        // A radius column of another length says nothing of these samples.
        let radii = self.contact_radius_m.as_ref();
        let prepared = Self {
            time_s: taken(&self.time_s),
            load_n: taken(&self.load_n),
            approach_m: taken(&self.approach_m),
            contact_radius_m: radii.filter(|r| r.len() == times).map(|r| taken(r)),
        };
        for (signal, values) in prepared.signals() {
            if values.windows(2).all(|pair| pair[0] == pair[1]) {
                return Err(MeasuredError::Constant { signal });
            }
        }
        if let Some(place) = leap(&prepared.time_s) {
            return Err(MeasuredError::TimeLeaps {
                first: order[place] + 1,
                second: order[place + 1] + 1,
                leap_s: prepared.time_s[place + 1] - prepared.time_s[place],
            });
        }
        let sampling = prepared.sampling(&mut findings)?;
        Ok((prepared, sampling, findings))
    }

    /// Load and approach by name.
    fn signals(&self) -> [(&'static str, &[f64]); 2] {
        [("load", &self.load_n), ("approach", &self.approach_m)]
    }

    /// Intervals between samples: their median, gaps, jitter.
    fn sampling(&self, findings: &mut Vec<Finding>) -> Result<Sampling, MeasuredError> {
        let times = &self.time_s;
        let (first, last) = (times[0], times[times.len() - 1]);
        let duration_s = last - first;
        let mut intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let given = intervals.clone();
        intervals.sort_by(f64::total_cmp);
        let interval_s = intervals[intervals.len() / 2];
        if !(duration_s > 0.0 && interval_s > 0.0) {
            return Err(MeasuredError::NoDuration { time_s: first });
        }
        // Half of the distance between the quartiles, as the standard deviation of a normal distribution.
        let quartile = |part: f64| intervals[(part * (intervals.len() - 1) as f64) as usize];
        let spread = 0.7413 * (quartile(0.75) - quartile(0.25)) / interval_s;
        let is_gap = |interval: &&f64| **interval > GAP * interval_s;
        if spread > SPREAD {
            findings.push(Finding::NotUniform { spread });
        } else {
            let missed = |interval: &f64| (interval / interval_s).round() - 1.0;
            let gaps = given.iter().filter(is_gap);
            let samples: f64 = gaps.clone().map(missed).sum();
            let largest_s = gaps.fold(0.0_f64, |largest, gap| largest.max(*gap));
            if samples >= 1.0 {
                findings.push(Finding::MissingSamples {
                    samples: samples as usize,
                    largest_gap_s: largest_s,
                });
            }
            let regular = given.iter().filter(|interval| !is_gap(interval));
            let (count, squares) = regular.fold((0_usize, 0.0), |(count, sum), interval| {
                let deviation = interval / interval_s - 1.0;
                (count + 1, sum + deviation * deviation)
            });
            let jitter = (squares / count.max(1) as f64).sqrt();
            if jitter > JITTER {
                findings.push(Finding::Jitter { relative: jitter });
            }
        }
        Ok(Sampling {
            samples: times.len(),
            duration_s,
            interval_s,
            load_step_n: step(&self.load_n),
            approach_step_m: step(&self.approach_m),
        })
    }

    /// Looks for values at which a signal stops, over a noticeable part of every other cycle.
    pub(super) fn clipped(&self, period_s: f64, findings: &mut Vec<Finding>) {
        for (signal, values) in self.signals() {
            let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            for (end, limit) in [("largest", largest), ("smallest", least)] {
                let cycles = self.plateaus(values, limit, period_s);
                let all = (self.time_s[self.time_s.len() - 1] - self.time_s[0]) / period_s;
                if cycles > 0 && cycles as f64 >= 0.4 * all.floor() {
                    findings.push(Finding::Clipped {
                        signal: signal.to_owned(),
                        end: end.to_owned(),
                        cycles,
                    });
                }
            }
        }
    }

    /// How often the signal stays exactly at a value, longer than a sine stays within a hundredth of its amplitude of its peak.
    fn plateaus(&self, values: &[f64], limit: f64, period_s: f64) -> usize {
        const PART: f64 = 0.04;
        let places: Vec<usize> = (0..values.len()).collect();
        let stays = |place: usize| values[place] == limit;
        let runs = places.chunk_by(|a, b| stays(*a) == stays(*b));
        let is_plateau = |run: &&[usize]| match run {
            [first, .., last] if stays(*first) && run.len() >= 3 => {
                self.time_s[*last] - self.time_s[*first] > PART * period_s
            }
            _ => false,
        };
        runs.filter(is_plateau).count()
    }
}

/// The place of a sample behind which the time leaps by more than all the rest lasts, with next to nothing on one side: no pause of
/// a record, but a time that is wrong.
fn leap(times_s: &[f64]) -> Option<usize> {
    let last = times_s.len().checked_sub(2)?;
    let gap = |i: usize| times_s[i + 1] - times_s[i];
    let place = (0..=last).max_by(|a, b| gap(*a).total_cmp(&gap(*b)))?;
    let rest_s = times_s[last + 1] - times_s[0] - gap(place);
    let aside = (place + 1).min(last + 1 - place);
    (gap(place) > rest_s && aside <= (times_s.len() / 100).max(1)).then_some(place)
}

/// The step of a converter: the smallest distance between values, where all others are multiples of it.
fn step(values: &[f64]) -> Option<f64> {
    /// Of the range: closer values differ by rounding.
    const ROUNDING: f64 = 1e-9;
    /// Of a step.
    const TOLERANCE: f64 = 0.05;
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let range = sorted.last()? - sorted.first()?;
    let gaps = || {
        let gaps = sorted.windows(2).map(|pair| pair[1] - pair[0]);
        gaps.filter(|gap| *gap > ROUNDING * range)
    };
    let step = gaps().min_by(f64::total_cmp)?;
    let is_multiple = |gap: f64| (gap / step - (gap / step).round()).abs() < TOLERANCE;
    (gaps().count() > 3 && gaps().all(is_multiple)).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(samples: usize, interval_s: f64) -> Signal {
        let time_s: Vec<f64> = (0..samples).map(|i| interval_s * i as f64).collect();
        let wave = |lag: f64| {
            let times = time_s.iter();
            times
                .map(|t| 2.0 + (std::f64::consts::TAU * t - lag).sin())
                .collect::<Vec<f64>>()
        };
        Signal {
            load_n: wave(0.0),
            approach_m: wave(0.2),
            time_s,
            contact_radius_m: None,
        }
    }

    #[test]
    fn samples_are_ordered_and_those_without_a_number_left_out_and_counted() {
        let mut signal = sine(200, 0.02);
        signal.load_n[3] = f64::NAN;
        for column in [
            &mut signal.time_s,
            &mut signal.load_n,
            &mut signal.approach_m,
        ] {
            column.swap(10, 20);
        }
        let (prepared, sampling, findings) = signal.prepared().unwrap();
        assert_eq!(sampling.samples, 199);
        assert!(prepared.time_s.windows(2).all(|w| w[0] < w[1]));
        assert!(findings.contains(&Finding::EmptyCells { rows: 1 }));
        let unordered = |f: &Finding| matches!(f, Finding::UnorderedTimes { .. });
        assert!(findings.iter().any(unordered));
        let missing = |f: &Finding| matches!(f, Finding::MissingSamples { samples: 1, .. });
        assert!(findings.iter().any(missing), "{findings:?}");
    }

    #[test]
    fn a_uniform_record_is_found_to_be_one_and_jitter_is_measured() {
        let mut signal = sine(1000, 0.01);
        assert!(signal.prepared().unwrap().2.is_empty());
        for (i, time) in signal.time_s.iter_mut().enumerate() {
            *time += 5e-4 * (7.3 * i as f64).sin();
        }
        let findings = signal.prepared().unwrap().2;
        let [Finding::Jitter { relative }] = findings[..] else {
            panic!("{findings:?}")
        };
        // Two sines of 0.05 apart by a phase that varies little: between half and twice their root mean square.
        assert!((0.025..0.1).contains(&relative), "{relative}");
    }

    #[test]
    fn a_time_stamp_that_is_wrong_is_named_and_a_pause_is_none() {
        for (wrong, at, samples) in [(3e7, 199, [199, 200]), (-1e5, 120, [121, 1])] {
            let mut signal = sine(200, 0.02);
            signal.time_s[at] = wrong;
            let refused = signal.prepared().unwrap_err();
            let MeasuredError::TimeLeaps { first, second, .. } = refused else {
                panic!("{refused}")
            };
            assert_eq!([first, second], samples);
        }
        let mut paused = sine(200, 0.02);
        paused.time_s[100..].iter_mut().for_each(|t| *t += 60.0);
        assert!(paused.prepared().is_ok());
    }

    #[test]
    fn the_step_of_a_converter_is_found_and_a_smooth_signal_has_none() {
        let signal = sine(2000, 5e-3);
        assert_eq!(signal.prepared().unwrap().1.load_step_n, None);
        for size in [0.002, 0.02, 0.5] {
            // Written in another unit: the grid is no longer exact.
            let coarse: Vec<f64> = signal
                .load_n
                .iter()
                .map(|w| (w / size).round() * size * 1e-3)
                .collect();
            let found = step(&coarse).unwrap();
            assert!(
                (found / (1e-3 * size) - 1.0).abs() < 1e-6,
                "{size}: {found}"
            );
        }
    }

    #[test]
    fn a_signal_that_stops_at_a_value_is_clipped_and_a_coarse_one_is_not() {
        let clipped = |signal: &Signal| {
            let mut findings = Vec::new();
            signal.clipped(1.0, &mut findings);
            findings
        };
        let mut signal = sine(2000, 5e-3);
        assert!(clipped(&signal).is_empty());
        // Twelve bits over the range of the signal.
        for value in &mut signal.load_n {
            *value = (*value * 2048.0).round() / 2048.0;
        }
        assert!(clipped(&signal).is_empty());
        for value in &mut signal.load_n {
            *value = value.min(2.9);
        }
        let found = clipped(&signal);
        assert_eq!(found.len(), 1, "{found:?}");
        let Finding::Clipped { cycles, .. } = &found[0] else {
            panic!("{found:?}")
        };
        assert_eq!(*cycles, 10);
    }
}
