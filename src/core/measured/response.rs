//! What the channel of the approach does to a displacement beside what the channel of the load does to a force: it is late, has a gain, and
//! is behind by a phase. Of a sinusoid that is a factor ([`ChannelResponse::at`]); of a record it is taken back by a Fourier transform
//! ([`ChannelResponse::take_back`]).

use contact_dma_transforms::Precision as _;
use std::f64::consts::TAU;

use num_complex::Complex;

use crate::numerics::order::bracket;
use crate::quantity::block::Conflict;

/// A channel as keys of an instrument tell it: lists empty, or of as many values as frequencies.
#[derive(Debug, Clone, Copy)]
pub struct ChannelResponse<'a> {
    pub time_lag_s: f64,
    /// Ascending.
    pub frequency_hz: &'a [f64],
    pub gain: &'a [f64],
    pub phase_rad: &'a [f64],
}

/// The finest grid that times which are not uniform are laid on, in points for a sample.
const FINEST: usize = 16;

impl ChannelResponse<'_> {
    /// What is wrong with the lists together.
    pub(crate) fn in_conflict(&self) -> Option<Conflict> {
        let conflict = |key, what: &str, help| {
            Some(Conflict {
                key,
                what: what.to_owned(),
                because: None,
                help,
            })
        };
        let is_other = |list: &[f64]| !list.is_empty() && list.len() != self.frequency_hz.len();
        if !self.frequency_hz.is_sorted_by(|a, b| a < b) {
            return conflict(
                "response_frequency",
                "frequencies that do not ascend",
                "sort them, with their gains and phases",
            );
        }
        let each = "give one for each of `response_frequency`, or none";
        match (is_other(self.gain), is_other(self.phase_rad)) {
            (true, _) => conflict(
                "response_gain",
                "other than as many gains as frequencies",
                each,
            ),
            (_, true) => conflict(
                "response_phase",
                "other than as many phases as frequencies",
                each,
            ),
            _ => None,
        }
    }

    /// By what the channel multiplies a displacement at an angular frequency (rad/s).
    #[must_use]
    pub fn at(&self, angular_rad_per_s: f64) -> Complex<f64> {
        let hz = angular_rad_per_s / TAU;
        let between = |list: &[f64]| {
            let (left, right, _) = bracket(self.frequency_hz, hz);
            let (first, last) = (list.get(left)?, list.get(right)?);
            let (low_hz, high_hz) = (self.frequency_hz[left], self.frequency_hz[right]);
            let part = match left == right {
                true => 0.0,
                false => (hz / low_hz).ln() / (high_hz / low_hz).ln(),
            };
            Some(first + part * (last - first))
        };
        // A channel follows what is at rest: below the lowest frequency its phase is that of a delay.
        let lowest_hz = self.frequency_hz.first().copied().unwrap_or(f64::INFINITY);
        let phase = between(self.phase_rad).unwrap_or(0.0) * (hz / lowest_hz).min(1.0);
        let lag = angular_rad_per_s * self.time_lag_s;
        Complex::from_polar(between(self.gain).unwrap_or(1.0), -(phase + lag))
    }

    /// Gain of what hardly moves, and by how much (s) that is late.
    fn at_rest(&self) -> (f64, f64) {
        let first = self.phase_rad.first().zip(self.frequency_hz.first());
        let behind_s = first.map_or(0.0, |(phase, hz)| phase / (TAU * hz));
        let gain = self.gain.first().copied().unwrap_or(1.0);
        (gain, self.time_lag_s + behind_s)
    }

    /// The displacement of a channel that gave `signal` at ascending times (s); of a channel that does nothing, `signal` itself.
    ///
    /// The line through both ends is taken off, of which the answer is known; what is left vanishes there, and continued as an odd function
    /// it is periodic without a step and without a corner at the ends.
    #[must_use]
    pub fn take_back(&self, time_s: &[f64], signal: &[f64]) -> Vec<f64> {
        let mut displacement = signal.to_vec();
        let is_nothing =
            self.time_lag_s == 0.0 && self.gain.is_empty() && self.phase_rad.is_empty();
        let (Some(first_s), Some(last_s)) = (time_s.first(), time_s.last()) else {
            return displacement;
        };
        let duration_s = last_s - first_s;
        if is_nothing || !(duration_s > 0.0 && duration_s.is_finite()) {
            return displacement;
        }
        let shortest_s = time_s.windows(2).map(|t| t[1] - t[0]);
        let shortest_s = shortest_s.fold(f64::INFINITY, f64::min);
        // To the nearest: times that are uniform but for rounding make a grid of as many points.
        let intervals = (duration_s / shortest_s).round();
        let intervals = (intervals as usize).clamp(2, FINEST * time_s.len());
        let interval_s = duration_s / intervals as f64;
        let (start, end) = (signal[0], signal[signal.len() - 1]);
        let line = |t: f64| start + (end - start) * (t - first_s) / duration_s;

        let grid_s: Vec<f64> = (0..=intervals)
            .map(|point| first_s + point as f64 * interval_s)
            .collect();
        let recorded: Vec<f64> =
            (grid_s.iter().map(|t| interpolated(time_s, signal, *t))).collect();
        let rest: Vec<f64> =
            (grid_s.iter().zip(&recorded).map(|(t, own)| own - line(*t))).collect();
        let Some(rest) = self.take_back_odd(&rest, interval_s) else {
            return displacement;
        };
        let (gain, late_s) = self.at_rest();
        let added: Vec<f64> = (grid_s.iter().zip(rest).zip(recorded))
            .map(|((t, rest), recorded)| rest + line(t + late_s) / gain - recorded)
            .collect();
        for (t, own) in time_s.iter().zip(&mut displacement) {
            *own += interpolated(&grid_s, &added, *t);
        }
        displacement
    }

    /// The same of uniform samples that vanish at both ends, continued as an odd function.
    fn take_back_odd(&self, signal: &[f64], interval_s: f64) -> Option<Vec<f64>> {
        let intervals = signal.len() - 1;
        let inner = &signal[1..intervals];
        let mirrored = inner.iter().rev().map(|own| -own);
        let mut odd: Vec<f64> = [0.0]
            .into_iter()
            .chain(inner.iter().copied())
            .chain([0.0])
            .chain(mirrored)
            .collect();
        let forward = f64::real_forward(odd.len());
        let mut lines = forward.make_output_vec();
        forward.process(&mut odd, &mut lines).ok()?;
        let length = odd.len() as f64;
        for (k, line) in lines.iter_mut().enumerate() {
            *line /= self.at(TAU * k as f64 / (length * interval_s)) * length;
        }
        // The first and the last line of a real signal are real.
        for end in [0, intervals] {
            lines[end].im = 0.0;
        }
        let inverse = f64::real_inverse(odd.len());
        inverse.process(&mut lines, &mut odd).ok()?;
        odd.truncate(signal.len());
        Some(odd)
    }
}

/// Between samples at ascending times, linear; beyond them as at the ends.
fn interpolated(time_s: &[f64], values: &[f64], t: f64) -> f64 {
    let (left, right, part) = bracket(time_s, t);
    values[left] + part * (values[right] - values[left])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A low-pass of first order, as a calibration up to 2 kHz tells it.
    struct LowPass {
        time_constant_s: f64,
        table: [Vec<f64>; 3],
    }

    impl LowPass {
        fn new(time_constant_s: f64) -> Self {
            let hz: Vec<f64> = (0..50).map(|n| 0.1 * 1.22_f64.powi(n)).collect();
            let over = |hz: &f64| TAU * hz * time_constant_s;
            let gain = hz.iter().map(|hz| over(hz).hypot(1.0).recip()).collect();
            let phase = hz.iter().map(|hz| over(hz).atan()).collect();
            Self {
                time_constant_s,
                table: [hz, gain, phase],
            }
        }

        fn response(&self) -> ChannelResponse<'_> {
            ChannelResponse {
                time_lag_s: 0.0,
                frequency_hz: &self.table[0],
                gain: &self.table[1],
                phase_rad: &self.table[2],
            }
        }

        /// What it makes of a ramp that begins at a time, t seconds after that.
        fn of_ramp(&self, t: f64) -> f64 {
            match t > 0.0 {
                true => t + self.time_constant_s * (-t / self.time_constant_s).exp_m1(),
                false => 0.0,
            }
        }
    }

    #[test]
    fn a_ramp_up_a_hold_and_a_ramp_down_come_out_of_a_low_pass() {
        let channel = LowPass::new(0.02);
        // From 0.3 s to 0.8 s up, from 1.1 s to 1.6 s down.
        let corners = [(0.3, 1.0), (0.8, -1.0), (1.1, -1.0), (1.6, 1.0)];
        let sum = |of: &dyn Fn(f64) -> f64, t: f64| -> f64 {
            corners.iter().map(|(at, turn)| turn * of(t - at)).sum()
        };
        for jitter in [0.0, 0.3] {
            let mut random = crate::numerics::random::Noise(5);
            let time_s: Vec<f64> = (0..2000)
                .map(|n| 1e-3 * (f64::from(n) + jitter * random.normal().clamp(-1.0, 1.0)))
                .collect();
            let signal: Vec<f64> = (time_s.iter())
                .map(|t| sum(&|t| channel.of_ramp(t), *t))
                .collect();
            let found = channel.response().take_back(&time_s, &signal);
            let off = |values: &[f64]| {
                let both = time_s.iter().zip(values);
                let off = both.map(|(t, own)| (own - sum(&|t| t.max(0.0), *t)).abs());
                off.fold(0.0, f64::max)
            };
            assert!(off(&signal) > 0.019);
            assert!(off(&found) < 5e-4, "jitter {jitter}: {:.2e}", off(&found));
        }
    }

    #[test]
    fn a_lag_and_a_gain_are_taken_out_of_a_line_to_the_last_digits() {
        let response = ChannelResponse {
            time_lag_s: 3e-3,
            frequency_hz: &[10.0],
            gain: &[1.25],
            phase_rad: &[0.1],
        };
        let late_s = 3e-3 + 0.1 / (TAU * 10.0);
        let time_s: Vec<f64> = (0..300).map(|n| 0.01 * f64::from(n)).collect();
        let signal: Vec<f64> = (time_s.iter().map(|t| 1.25 * (2.0 - 7.0 * (t - late_s)))).collect();
        let found = response.take_back(&time_s, &signal);
        for (t, own) in time_s.iter().zip(found) {
            assert!((own - (2.0 - 7.0 * t)).abs() < 1e-12, "{t}: {own}");
        }
    }

    #[test]
    fn a_sinusoid_is_that_of_the_harmonics_between_two_frequencies_and_beyond_them() {
        let response = ChannelResponse {
            time_lag_s: 1e-3,
            frequency_hz: &[2.0, 40.0],
            gain: &[1.0, 0.7],
            phase_rad: &[0.05, 0.6],
        };
        let time_s: Vec<f64> = (0..4001).map(|n| 0.5e-3 * f64::from(n)).collect();
        for hz in [0.5, 2.0, 12.0, 40.0, 90.0] {
            let omega = TAU * hz;
            let factor = response.at(omega);
            let at = |amplitude: Complex<f64>, t: f64| (amplitude * Complex::cis(omega * t)).im;
            let signal: Vec<f64> = time_s.iter().map(|t| at(factor, *t)).collect();
            let found = response.take_back(&time_s, &signal);
            // Away from the ends, of which a channel knows nothing before and after.
            for place in 1000..3000 {
                let off = found[place] - at(1.0.into(), time_s[place]);
                assert!(off.abs() < 0.01, "{hz} Hz, {place}: {off:.2e}");
            }
        }
    }

    #[test]
    fn a_channel_that_does_nothing_changes_no_digit() {
        let nothing = ChannelResponse {
            time_lag_s: 0.0,
            frequency_hz: &[],
            gain: &[],
            phase_rad: &[],
        };
        let signal = [1.0, 4.0, 2.0, 8.0];
        let found = nothing.take_back(&[0.0, 0.1, 0.3, 0.35], &signal);
        assert_eq!(found, signal);
        let late = ChannelResponse {
            time_lag_s: 1.0,
            ..nothing
        };
        assert!(late.take_back(&[], &[]).is_empty());
        assert_eq!(late.take_back(&[2.0], &[3.0]), [3.0]);
    }
}
