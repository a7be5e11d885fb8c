//! What the instrument adds to load and approach, taken out of the harmonics: there it is exact.
//!
//! The transducer gives the force F on its moving part and that part's displacement x, from where its suspension is at rest:
//!
//! ```text
//! W = F - m x'' - c x' - k x        load on the contact
//! delta = x - C_f W                 approach, the frame giving way by its compliance
//! ```
//!
//! with the channel of x late by the lag, times the gain and behind by the phase that it has at a frequency beside that of F, and x moved at
//! a steady rate by temperature.

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::Signal;
use super::response::ChannelResponse;
use crate::block_with_defaults;
use crate::cycle::Harmonics;
use crate::quantity::Dimension;
use crate::quantity::block::Conflict;
use crate::quantity::key::{Entries, Kind, number, quantity};

block_with_defaults! {
    /// Contributions of the instrument to load and approach, removed from every harmonic.
    #[derive(Serialize, Deserialize)]
    pub struct Corrections in "instrument" unless in_conflict {
        /// Compliance of frame and mount: the approach is the displacement minus compliance times load.
        frame_compliance_m_per_n: f64 = 0.0 => "frame_compliance", Kind::Number(quantity(Dimension::FrameCompliance).not_negative());
        /// Moving mass between force sensor and contact.
        mass_kg: f64 = 0.0 => "mass", Kind::Number(quantity(Dimension::Mass).not_negative());
        /// Damping of the suspension of the moving part.
        damping_n_s_per_m: f64 = 0.0 => "damping", Kind::Number(quantity(Dimension::Damping).not_negative());
        /// Stiffness of the suspension; displacements are measured from its rest position.
        stiffness_n_per_m: f64 = 0.0 => "stiffness", Kind::Number(quantity(Dimension::Stiffness).not_negative());
        /// Delay of the approach channel relative to the load channel; negative if it is earlier.
        time_lag_s: f64 = 0.0 => "time_lag", Kind::Number(quantity(Dimension::Time));
        /// Frequencies at which gain and phase of the approach channel were measured against a stiff specimen or another sensor, ascending. Between
        /// them both are linear in the logarithm of the frequency, outside they are those at the ends; but the phase of slower motion is that of a
        /// delay, proportional to the frequency.
        response_frequency_hz: Vec<f64> = Vec::new() => "response_frequency", Kind::Numbers(quantity(Dimension::Frequency).above_zero(), Entries::ANY);
        /// Gain of the approach channel over that of the load channel at these frequencies.
        response_gain: Vec<f64> = Vec::new() => "response_gain", Kind::Numbers(number("1.02").above_zero(), Entries::ANY);
        /// Phase by which the approach channel is behind the load channel at these frequencies.
        response_phase_rad: Vec<f64> = Vec::new() => "response_phase", Kind::Numbers(quantity(Dimension::Angle), Entries::ANY);
        /// Thermal drift rate of the approach, if it was measured.
        thermal_drift_m_per_s: f64 = 0.0 => "thermal_drift", Kind::Number(quantity(Dimension::Speed));
        /// Reading of the approach at first touch.
        approach_at_touch_m: f64 = 0.0 => "approach_at_touch", Kind::Number(quantity(Dimension::Length));
    }
}

impl Corrections {
    fn in_conflict(&self) -> Option<Conflict> {
        self.response().in_conflict()
    }

    fn response(&self) -> ChannelResponse<'_> {
        ChannelResponse {
            time_lag_s: self.time_lag_s,
            frequency_hz: &self.response_frequency_hz,
            gain: &self.response_gain,
            phase_rad: &self.response_phase_rad,
        }
    }

    /// Takes off the drift that is known.
    pub(super) fn before(&self, signal: &mut Signal) {
        let (rate, touch) = (self.thermal_drift_m_per_s, self.approach_at_touch_m);
        let Some(first) = signal.time_s.first().copied() else {
            return;
        };
        if rate != 0.0 || touch != 0.0 {
            for (approach, time) in signal.approach_m.iter_mut().zip(&signal.time_s) {
                *approach -= touch + rate * (time - first);
            }
        }
    }

    /// A cycle without what the instrument adds.
    pub fn applied(&self, angular_rad_per_s: f64, raw: &Harmonics) -> Harmonics {
        let load_mean_n = raw.load_mean_n - self.stiffness_n_per_m * raw.approach_mean_m;
        let mut corrected = Harmonics {
            load_mean_n,
            approach_mean_m: raw.approach_mean_m - self.frame_compliance_m_per_n * load_mean_n,
            load_n: Vec::with_capacity(raw.load_n.len()),
            approach_m: Vec::with_capacity(raw.approach_m.len()),
        };
        for (n, (force, displacement)) in raw.load_n.iter().zip(&raw.approach_m).enumerate() {
            let angular = (n + 1) as f64 * angular_rad_per_s;
            let displacement = displacement / self.response().at(angular);
            let load = force - self.dynamic_stiffness(angular) * displacement;
            corrected.load_n.push(load);
            corrected
                .approach_m
                .push(displacement - self.frame_compliance_m_per_n * load);
        }
        corrected
    }

    /// k - m omega^2 + i c omega.
    fn dynamic_stiffness(&self, angular: f64) -> Complex<f64> {
        Complex::new(
            self.stiffness_n_per_m - self.mass_kg * angular * angular,
            self.damping_n_s_per_m * angular,
        )
    }

    /// Load that the instrument takes over that of the contact, first harmonic.
    pub(super) fn share(
        &self,
        angular: f64,
        raw: &Harmonics,
        corrected: &Harmonics,
    ) -> Option<f64> {
        let own = self.dynamic_stiffness(angular) * raw.approach_m.first()?;
        let load = corrected.load_n.first()?.norm();
        (load > 0.0).then(|| own.norm() / load)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_instrument_adds_is_taken_out_again() {
        let corrections = Corrections {
            frame_compliance_m_per_n: 2e-7,
            mass_kg: 2e-4,
            damping_n_s_per_m: 0.02,
            stiffness_n_per_m: 150.0,
            time_lag_s: 2e-5,
            response_frequency_hz: vec![10.0, 100.0],
            response_gain: vec![1.0, 1.2],
            response_phase_rad: vec![0.02, 0.1],
            ..Corrections::default()
        };
        let contact = Harmonics {
            load_mean_n: 3e-3,
            approach_mean_m: 4e-7,
            load_n: vec![
                Complex::from_polar(1e-3, 0.3),
                Complex::from_polar(1e-5, 1.0),
            ],
            approach_m: vec![
                Complex::from_polar(5e-8, 0.1),
                Complex::from_polar(2e-9, -2.0),
            ],
        };
        for hz in [1.0, 40.0, 200.0] {
            let angular = std::f64::consts::TAU * hz;
            // The instrument, written out: displacement of the moving part, then force on it, then the late channel.
            let mut raw = contact.clone();
            raw.approach_mean_m += 2e-7 * contact.load_mean_n;
            raw.load_mean_n += 150.0 * raw.approach_mean_m;
            for n in 0..2 {
                let omega = angular * (n + 1) as f64;
                let x = contact.approach_m[n] + 2e-7 * contact.load_n[n];
                let i = Complex::i();
                let inertia = 2e-4 * (i * omega) * (i * omega) * x;
                raw.load_n[n] = contact.load_n[n] + inertia + 0.02 * i * omega * x + 150.0 * x;
                // The channel at this frequency: at the ends as it was measured there, and of slower motion as late as at the lower one.
                let own_hz = omega / std::f64::consts::TAU;
                let part = (own_hz.log10() - 1.0).clamp(0.0, 1.0);
                let behind = (0.02 + 0.08 * part) * (own_hz / 10.0).min(1.0);
                let channel = Complex::from_polar(1.0 + 0.2 * part, -behind);
                raw.approach_m[n] = x * Complex::cis(-omega * 2e-5) * channel;
            }
            let found = corrections.applied(angular, &raw);
            assert!((found.load_mean_n / contact.load_mean_n - 1.0).abs() < 1e-12);
            assert!((found.approach_mean_m / contact.approach_mean_m - 1.0).abs() < 1e-12);
            for n in 0..2 {
                let near = |a: Complex<f64>, b: Complex<f64>| (a - b).norm() < 1e-10 * b.norm();
                assert!(near(found.load_n[n], contact.load_n[n]), "{hz} {n}");
                assert!(near(found.approach_m[n], contact.approach_m[n]), "{hz} {n}");
            }
        }
    }
}
