//! A stretch of a drive history on which the drive is smooth: its value at any time, and where it is least and largest.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::numerics::roots::{ALL_DIGITS, bisect};

/// The form of the drive within a piece; times count from where the piece begins.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Form {
    Linear {
        from: f64,
        to: f64,
    },
    /// Coefficients of ascending powers of the time in seconds; one of a value that is held.
    Polynomial(Vec<f64>),
    Sine {
        mean: f64,
        amplitude: f64,
        angular_frequency_rad_per_s: f64,
        phase_rad: f64,
    },
}

impl Form {
    pub(super) fn held(value: f64) -> Self {
        Self::Polynomial(vec![value])
    }
}

/// A smooth piece of a drive history.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Piece {
    pub(super) form: Form,
    /// The segment it belongs to.
    pub(super) segment: usize,
    /// Time from the beginning of the history to that of the piece (s).
    pub(super) start_s: f64,
    /// Time from the beginning of the segment to that of the piece (s).
    pub(super) offset_s: f64,
    pub(super) duration_s: f64,
    /// The longest time step that resolves the piece (s); `None` where nothing happens in it.
    pub(super) longest_step_s: Option<f64>,
    /// Whether the piece goes on from the one before within a table, whose points are many and their kinks small.
    pub(super) is_continued_table: bool,
}

/// A value and the time since the beginning of the piece (s) at which it is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extreme {
    pub(super) value: f64,
    pub(super) time_s: f64,
}

impl Piece {
    /// The value this long after the piece began. The ends of a straight piece are exact.
    pub(super) fn value(&self, time_s: f64) -> f64 {
        match &self.form {
            Form::Linear { from, to } => {
                if time_s >= self.duration_s {
                    *to
                } else {
                    from + (to - from) * (time_s / self.duration_s)
                }
            }
            Form::Polynomial(coefficients) => horner(coefficients, time_s),
            Form::Sine {
                mean,
                amplitude,
                angular_frequency_rad_per_s,
                phase_rad,
            } => mean + amplitude * (angular_frequency_rad_per_s * time_s + phase_rad).sin(),
        }
    }

    /// The sum of the sizes of the terms that make the values of the piece: rounding is a small part of it.
    pub(super) fn scale(&self) -> f64 {
        match &self.form {
            Form::Linear { from, to } => from.abs().max(to.abs()),
            Form::Polynomial(coefficients) => {
                let sizes: Vec<f64> = coefficients.iter().map(|c| c.abs()).collect();
                horner(&sizes, self.duration_s)
            }
            Form::Sine {
                mean, amplitude, ..
            } => mean.abs() + amplitude.abs(),
        }
    }

    /// The least and the largest value within the piece, its ends included.
    pub(super) fn extremes(&self) -> (Extreme, Extreme) {
        let at = |time_s| Extreme {
            value: self.value(time_s),
            time_s,
        };
        let (mut least, mut largest) = (at(0.0), at(0.0));
        for time_s in self.turning_points().into_iter().chain([self.duration_s]) {
            let here = at(time_s);
            if here.value < least.value {
                least = here;
            }
            if here.value > largest.value {
                largest = here;
            }
        }
        (least, largest)
    }

    /// Times at which the value may stop rising or falling; more than needed does no harm.
    fn turning_points(&self) -> Vec<f64> {
        match &self.form {
            Form::Linear { .. } => Vec::new(),
            Form::Polynomial(coefficients) => {
                // In units of the duration, in which the powers are of one size.
                let mut power = 1.0;
                let mut scaled = Vec::with_capacity(coefficients.len());
                for coefficient in coefficients {
                    scaled.push(coefficient * power);
                    power *= self.duration_s;
                }
                let roots = sign_changes(&derivative(&scaled));
                roots.into_iter().map(|x| x * self.duration_s).collect()
            }
            Form::Sine {
                angular_frequency_rad_per_s: omega,
                phase_rad,
                ..
            } => {
                // The first crest and the first trough; all others are as high and as low.
                let first = |angle: f64| {
                    let turns = ((phase_rad - angle) / TAU).ceil();
                    (angle + TAU * turns - phase_rad) / omega
                };
                [first(FRAC_PI_2), first(-FRAC_PI_2)]
                    .into_iter()
                    .filter(|time_s| (0.0..=self.duration_s).contains(time_s))
                    .collect()
            }
        }
    }
}

fn horner(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

fn derivative(coefficients: &[f64]) -> Vec<f64> {
    let powers = coefficients.iter().enumerate().skip(1);
    powers.map(|(k, c)| k as f64 * c).collect()
}

/// Where a polynomial changes sign between 0 and 1: between two turning points, which are the sign changes of its
/// derivative, there is at most one.
fn sign_changes(coefficients: &[f64]) -> Vec<f64> {
    if coefficients.len() < 2 {
        return Vec::new();
    }
    let mut ends = vec![0.0];
    ends.extend(sign_changes(&derivative(coefficients)));
    ends.push(1.0);
    let value = |x| horner(coefficients, x);
    let mut found = Vec::new();
    for pair in ends.windows(2) {
        let (low, high) = (pair[0], pair[1]);
        let rises = value(high) > 0.0;
        if (value(low) > 0.0) == rises {
            continue;
        }
        let (low, high) = bisect(low, high, ALL_DIGITS, |x| (value(x) > 0.0) != rises);
        found.push(0.5 * (low + high));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(form: Form, duration_s: f64) -> Piece {
        Piece {
            form,
            segment: 0,
            start_s: 0.0,
            offset_s: 0.0,
            duration_s,
            longest_step_s: None,
            is_continued_table: false,
        }
    }

    #[test]
    fn a_polynomial_is_least_and_largest_where_calculus_says() {
        // (t - 1)(t - 2)(t - 4) turns at (7 -+ sqrt 7)/3.
        let cubic = piece(Form::Polynomial(vec![-8.0, 14.0, -7.0, 1.0]), 5.0);
        let (least, largest) = cubic.extremes();
        let turn = |sign: f64| (7.0 + sign * 7.0_f64.sqrt()) / 3.0;
        // The ends are at -8 and 12, beyond both turning points.
        assert_eq!((least.value, least.time_s), (-8.0, 0.0));
        assert_eq!((largest.value, largest.time_s), (12.0, 5.0));
        let inner = piece(Form::Polynomial(vec![-8.0, 14.0, -7.0, 1.0]), 3.5);
        let (least, largest) = inner.extremes();
        assert_eq!(least.value, -8.0);
        // A turning point is flat: its place is good to the root of the rounding of its value.
        assert!((largest.time_s - turn(-1.0)).abs() < 1e-7);
        let trough = piece(Form::Polynomial(vec![8.0, -14.0, 7.0, -1.0]), 3.5).extremes();
        assert!((trough.0.time_s - turn(-1.0)).abs() < 1e-7);
    }

    #[test]
    fn extremes_agree_with_a_fine_search_for_any_polynomial_and_any_sine() {
        let mut state = 1_u64;
        // A linear congruential generator (Knuth's MMIX constants): the same numbers in every run.
        let mut random = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for case in 0..200 {
            let duration_s = 0.1 + 3.0 * random().abs();
            let form = if case % 2 == 0 {
                Form::Polynomial((0..2 + case % 7).map(|_| random()).collect())
            } else {
                Form::Sine {
                    mean: random(),
                    amplitude: random().abs(),
                    angular_frequency_rad_per_s: 4.0 * random().abs() + 0.01,
                    phase_rad: 9.0 * random(),
                }
            };
            let piece = piece(form, duration_s);
            let (least, largest) = piece.extremes();
            let values = (0..=2000).map(|k| piece.value(f64::from(k) / 2000.0 * duration_s));
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
            // The search misses a smooth extreme by the square of its step, at most.
            assert!(
                least.value <= low + 1e-12 && least.value > low - 1e-4,
                "{piece:?}"
            );
            assert!(
                largest.value >= high - 1e-12 && largest.value < high + 1e-4,
                "{piece:?}"
            );
        }
    }

    #[test]
    fn a_straight_piece_ends_exactly_where_it_was_told_to() {
        let ramp = piece(Form::Linear { from: 0.1, to: 0.3 }, 0.7);
        assert_eq!((ramp.value(0.0), ramp.value(0.7)), (0.1, 0.3));
        assert!((ramp.value(0.35) - 0.2).abs() < 1e-16);
    }
}
