//! A positive function of time through given samples, with exact means over any interval.
//!
//! Between two samples at positive times it is a power law, `v (t/t_i)^m`: straight in a double logarithmic plot, and so
//! monotone wherever the samples are. Between a sample at time zero and the next it is linear in time. Before the first
//! sample it keeps the first value, beyond the last sample the last one.

use super::error::{MaterialError, positive};

/// Samples joined by power laws; see the head of this file.
#[derive(Debug, Clone, PartialEq)]
pub struct Interpolant {
    times_s: Vec<f64>,
    values: Vec<f64>,
    /// Exponent of the power law that begins at each sample but the last; unused where that sample is at time zero.
    exponents: Vec<f64>,
    /// Integral from the first sample to each sample.
    integrals: Vec<f64>,
}

impl Interpolant {
    /// Through these samples. The caller has checked that there are some, that times are finite, not negative and strictly
    /// increasing, and that values are finite and positive.
    pub(super) fn through(times_s: Vec<f64>, values: Vec<f64>) -> Self {
        let exponents = times_s
            .windows(2)
            .zip(values.windows(2))
            .map(|(t, v)| (v[1] / v[0]).ln() / (t[1] / t[0]).ln())
            .collect();
        let mut interpolant = Self {
            integrals: Vec::with_capacity(times_s.len()),
            times_s,
            values,
            exponents,
        };
        let mut integral = 0.0;
        interpolant.integrals.push(integral);
        for segment in 0..interpolant.exponents.len() {
            let (from, to) = (
                interpolant.times_s[segment],
                interpolant.times_s[segment + 1],
            );
            integral += interpolant.piece(Some(segment), from, to);
            interpolant.integrals.push(integral);
        }
        interpolant
    }

    /// Times of the samples, in s, strictly increasing.
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Values at the samples.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The shortest positive time of a sample, in s, if there is one.
    pub fn shortest_time_s(&self) -> Option<f64> {
        self.times_s.iter().copied().find(|&t| t > 0.0)
    }

    /// The last time of a sample, in s; what is said about later times is an assumption.
    pub fn last_time_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or(0.0)
    }

    /// The value at `time_s`; zero before time zero.
    pub fn value(&self, time_s: f64) -> f64 {
        if time_s < 0.0 {
            return 0.0;
        }
        self.in_segment(self.segment(time_s), time_s)
    }

    /// The mean over `from_s <= t <= to_s`, both not negative; the value itself where the two are equal. Exact for the
    /// interpolant, and accurate to rounding however short the interval is.
    pub fn mean(&self, from_s: f64, to_s: f64) -> f64 {
        let length = to_s - from_s;
        if length <= 0.0 {
            return self.value(from_s);
        }
        let (first, last) = (self.segment(from_s), self.segment(to_s));
        if first == last {
            return self.piece(first, from_s, to_s) / length;
        }
        // Segment i ends at sample i + 1; what lies before the first sample ends at sample 0.
        let entered = first.map_or(0, |segment| segment + 1);
        let left = last.unwrap_or(0);
        let whole = self.integrals[left] - self.integrals[entered];
        let head = self.piece(first, from_s, self.times_s[entered]);
        let tail = self.piece(last, self.times_s[left], to_s);
        (head + whole + tail) / length
    }

    /// The same function with every value multiplied by `factor`.
    ///
    /// # Errors
    /// A factor that is not positive and finite, or takes a value out of range.
    pub fn scaled(&self, factor: f64) -> Result<Self, MaterialError> {
        positive("factor on the tabulated function", factor)?;
        let values: Vec<f64> = self.values.iter().map(|value| value * factor).collect();
        for &value in &values {
            positive("tabulated value times its factor", value)?;
        }
        Ok(Self::through(self.times_s.clone(), values))
    }

    /// The sample at or before `time_s`; `None` before the first.
    fn segment(&self, time_s: f64) -> Option<usize> {
        self.times_s
            .partition_point(|&t| t <= time_s)
            .checked_sub(1)
    }

    fn in_segment(&self, segment: Option<usize>, time_s: f64) -> f64 {
        let Some(segment) = segment else {
            return self.values[0];
        };
        let (time, value) = (self.times_s[segment], self.values[segment]);
        let Some(&exponent) = self.exponents.get(segment) else {
            return value;
        };
        if time > 0.0 {
            value * (time_s / time).powf(exponent)
        } else {
            value + (self.values[segment + 1] - value) * (time_s / self.times_s[segment + 1])
        }
    }

    /// Integral from `a` to `b`, both in this segment (or at its ends).
    fn piece(&self, segment: Option<usize>, a: f64, b: f64) -> f64 {
        let exponent = segment.and_then(|s| self.exponents.get(s).copied());
        let starts_at_zero = segment.is_some_and(|s| self.times_s[s] == 0.0);
        match exponent {
            Some(exponent) if !starts_at_zero => {
                // a C(a) L expm1(x)/x with L = ln(b/a), x = (m + 1) L: the power law, without a difference of powers.
                let logarithm = ((b - a) / a).ln_1p();
                let x = (exponent + 1.0) * logarithm;
                let growth = if x == 0.0 { 1.0 } else { x.exp_m1() / x };
                a * self.in_segment(segment, a) * logarithm * growth
            }
            _ => 0.5 * (b - a) * (self.in_segment(segment, a) + self.in_segment(segment, b)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn power_law() -> Interpolant {
        let times = vec![0.5, 1.0, 3.0, 20.0];
        let values = times.iter().map(|t: &f64| 2.0 * t.powf(0.3)).collect();
        Interpolant::through(times, values)
    }

    #[test]
    fn a_power_law_is_met_exactly_between_the_samples_and_held_outside() {
        let function = power_law();
        for t in [0.5, 0.7, 1.0, 2.9, 3.0, 19.0, 20.0] {
            // A logarithm and two powers.
            assert!((function.value(t) / (2.0 * t.powf(0.3)) - 1.0).abs() < 4e-15);
        }
        assert_eq!(function.value(0.0), function.value(0.5));
        assert_eq!(function.value(1e9), function.value(20.0));
        assert_eq!(function.value(-1.0), 0.0);
    }

    #[test]
    fn means_are_exact_over_any_interval_however_short() {
        let function = power_law();
        let integral = |t: f64| 2.0 * t.powf(1.3) / 1.3;
        let exact = |a: f64, b: f64| (integral(b) - integral(a)) / (b - a);
        for (a, b) in [(0.5, 20.0), (0.6, 0.9), (0.6, 4.0), (1.0, 3.0), (2.0, 3.0)] {
            assert!((function.mean(a, b) / exact(a, b) - 1.0).abs() < 1e-14);
        }
        // Before the first and beyond the last sample.
        let held = (0.4 * function.value(0.5) + integral(1.0) - integral(0.5)) / 0.9;
        assert!((function.mean(0.1, 1.0) / held - 1.0).abs() < 1e-14);
        let held = (integral(20.0) - integral(10.0) + 80.0 * function.value(20.0)) / 90.0;
        assert!((function.mean(10.0, 100.0) / held - 1.0).abs() < 1e-14);
        assert_eq!(function.mean(30.0, 40.0), function.value(20.0));
        assert_eq!(function.mean(2.0, 2.0), function.value(2.0));
        // Over 1e-12 of its time the power law is linear to 1e-24; a difference of integrals would keep four digits.
        let (a, b) = (7.0, 7.0 + 7e-12);
        assert!((function.mean(a, b) / function.value(0.5 * (a + b)) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_sample_at_time_zero_is_joined_by_a_straight_line() {
        let function = Interpolant::through(vec![0.0, 2.0, 4.0], vec![1.0, 3.0, 3.0]);
        assert_eq!(function.value(0.0), 1.0);
        assert_eq!(function.value(1.0), 2.0);
        assert_eq!(function.mean(0.0, 2.0), 2.0);
        assert_eq!(function.mean(0.0, 4.0), 2.5);
        assert_eq!(function.shortest_time_s(), Some(2.0));
        assert_eq!(function.last_time_s(), 4.0);
    }

    #[test]
    fn a_function_that_falls_like_one_over_time_integrates_to_a_logarithm() {
        let function = Interpolant::through(vec![1.0, 10.0, 100.0], vec![1.0, 0.1, 0.01]);
        let exact = 50_f64.ln() / 49.0;
        assert!((function.mean(1.0, 50.0) / exact - 1.0).abs() < 1e-14);
    }

    #[test]
    fn scaling_multiplies_every_value() {
        let doubled = power_law().scaled(2.0).unwrap();
        assert_eq!(doubled.value(3.0), 2.0 * power_law().value(3.0));
        assert!(power_law().scaled(0.0).is_err());
        assert!(power_law().scaled(f64::MAX).is_err());
    }
}
