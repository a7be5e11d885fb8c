//! The oscillation of a sweep, under either control: a mean, and a sine about it.

use super::{Control, DriveError, HarmonicLoad, check_phase_and_hold};

/// A load or an approach held at its mean from first touch, then mean + amplitude sin(omega t + phase). The angular
/// frequency belongs to the sweep, not to the drive.
///
/// An approach may swing below the surface's rest position and the indenter leave the surface for part of the cycle; a load
/// may fall to zero but not below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HarmonicDrive {
    control: Control,
    mean: f64,
    amplitude: f64,
    phase_rad: f64,
    hold_s: f64,
}

impl From<HarmonicLoad> for HarmonicDrive {
    fn from(load: HarmonicLoad) -> Self {
        Self {
            control: Control::Load,
            mean: load.mean_n(),
            amplitude: load.amplitude_n(),
            phase_rad: load.phase_rad(),
            hold_s: load.hold_s(),
        }
    }
}

impl HarmonicDrive {
    /// Mean and amplitude in newtons or metres, phase in radians, hold (s) at the mean before the oscillation.
    ///
    /// # Errors
    /// A load: as [`HarmonicLoad::new`]. An approach: a mean that is not finite, an amplitude that is not positive and
    /// finite, an indenter that never goes below the undisturbed surface.
    pub fn new(
        control: Control,
        mean: f64,
        amplitude: f64,
        phase_rad: f64,
        hold_s: f64,
    ) -> Result<Self, DriveError> {
        match control {
            Control::Load => {
                HarmonicLoad::new(mean, amplitude, phase_rad, hold_s).map(HarmonicDrive::from)
            }
            Control::Approach => Self::approach(mean, amplitude, phase_rad, hold_s),
        }
    }

    fn approach(
        mean_m: f64,
        amplitude_m: f64,
        phase_rad: f64,
        hold_s: f64,
    ) -> Result<Self, DriveError> {
        if !mean_m.is_finite() {
            return Err(DriveError::MeanApproach { mean_m });
        }
        if !(amplitude_m.is_finite() && amplitude_m > 0.0) {
            return Err(DriveError::ApproachAmplitude { amplitude_m });
        }
        if mean_m + amplitude_m <= 0.0 {
            return Err(DriveError::NoTouch {
                mean_m,
                amplitude_m,
            });
        }
        check_phase_and_hold(phase_rad, hold_s)?;
        Ok(Self {
            control: Control::Approach,
            mean: mean_m,
            amplitude: amplitude_m,
            phase_rad,
            hold_s,
        })
    }

    /// What is prescribed.
    pub fn control(&self) -> Control {
        self.control
    }

    /// Mean, in the unit of the control.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Amplitude, in the unit of the control.
    pub fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// Phase at the start of the oscillation (rad).
    pub fn phase_rad(&self) -> f64 {
        self.phase_rad
    }

    /// Time at the mean before the oscillation (s).
    pub fn hold_s(&self) -> f64 {
        self.hold_s
    }

    /// The largest value of the cycle, in the unit of the control.
    pub fn maximum(&self) -> f64 {
        self.mean + self.amplitude
    }

    /// The value at this fraction of a cycle since the oscillation began, in the unit of the control.
    ///
    /// Where the amplitude of a load equals its mean, the load touches zero; rounding must not leave a pull of 1e-16 of it.
    pub fn value(&self, cycle_fraction: f64) -> f64 {
        let angle = std::f64::consts::TAU * cycle_fraction + self.phase_rad;
        let value = self.mean + self.amplitude * angle.sin();
        if self.control == Control::Load && value <= 1e-14 * self.maximum() {
            0.0
        } else {
            value
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_is_what_the_harmonic_load_says() {
        let load = HarmonicLoad::new(10.0, 10.0, 0.3, 2.0).unwrap();
        let drive = HarmonicDrive::new(Control::Load, 10.0, 10.0, 0.3, 2.0).unwrap();
        assert_eq!(drive, load.into());
        for k in 0..1000 {
            let fraction = f64::from(k) / 1000.0;
            assert_eq!(drive.value(fraction), load.load_n(fraction));
        }
        assert!(matches!(
            HarmonicDrive::new(Control::Load, 1.0, 1.1, 0.0, 0.0),
            Err(DriveError::Pull { .. })
        ));
    }

    #[test]
    fn an_approach_may_swing_clear_of_the_surface_but_must_touch_it() {
        let drive = HarmonicDrive::new(Control::Approach, 1e-6, 3e-6, 0.0, 0.0).unwrap();
        assert!((drive.value(0.75) - -2e-6).abs() < 1e-20);
        assert!((drive.maximum() - 4e-6).abs() < 1e-20);
        assert!(HarmonicDrive::new(Control::Approach, -1e-6, 3e-6, 0.0, 0.0).is_ok());
        assert!(matches!(
            HarmonicDrive::new(Control::Approach, -3e-6, 3e-6, 0.0, 0.0),
            Err(DriveError::NoTouch { .. })
        ));
        for nonsense in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(HarmonicDrive::new(Control::Approach, 1.0, nonsense, 0.0, 0.0).is_err());
        }
        assert!(HarmonicDrive::new(Control::Approach, f64::NAN, 1.0, 0.0, 0.0).is_err());
        assert!(HarmonicDrive::new(Control::Approach, 1.0, 1.0, f64::NAN, 0.0).is_err());
    }
}
