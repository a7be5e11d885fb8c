//! The oscillation of a sweep, under either control: a mean, and a sine about it.

use super::{Control, DriveError};

/// A load or an approach held at its mean from first touch, then mean + amplitude sin(omega t + phase): equation (29) of S. Spinu,
/// Advances in Tribology 2018, 9432894. The angular frequency belongs to the sweep, not to the drive.
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

impl HarmonicDrive {
    /// Mean and amplitude in newtons or metres, phase in radians, hold (s) at the mean before the oscillation.
    ///
    /// # Errors
    /// [`DriveError`]: an amplitude that is not positive and finite, a phase that is not finite, a negative hold. A load: a mean
    /// that is not positive and finite, an amplitude above it. An approach: a mean that is not finite, an indenter that never
    /// goes below the undisturbed surface.
    pub fn new(
        control: Control,
        mean: f64,
        amplitude: f64,
        phase_rad: f64,
        hold_s: f64,
    ) -> Result<Self, DriveError> {
        match control {
            Control::Load => check_load(mean, amplitude)?,
            Control::Approach => check_approach(mean, amplitude)?,
        }
        if !phase_rad.is_finite() {
            return Err(DriveError::Phase { phase_rad });
        }
        if !(hold_s.is_finite() && hold_s >= 0.0) {
            return Err(DriveError::Hold { hold_s });
        }
        Ok(Self {
            control,
            mean,
            amplitude,
            phase_rad,
            hold_s,
        })
    }

    /// A load (N) that oscillates from its mean on, without a hold.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn load(mean_n: f64, amplitude_n: f64) -> Result<Self, DriveError> {
        Self::new(Control::Load, mean_n, amplitude_n, 0.0, 0.0)
    }

    /// An approach (m) that oscillates from its mean on, without a hold.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn approach(mean_m: f64, amplitude_m: f64) -> Result<Self, DriveError> {
        Self::new(Control::Approach, mean_m, amplitude_m, 0.0, 0.0)
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

fn check_load(mean_n: f64, amplitude_n: f64) -> Result<(), DriveError> {
    if !(mean_n.is_finite() && mean_n > 0.0) {
        return Err(DriveError::Mean { mean_n });
    }
    if !(amplitude_n.is_finite() && amplitude_n > 0.0) {
        return Err(DriveError::Amplitude { amplitude_n });
    }
    match amplitude_n > mean_n {
        true => Err(DriveError::Pull {
            mean_n,
            amplitude_n,
        }),
        false => Ok(()),
    }
}

fn check_approach(mean_m: f64, amplitude_m: f64) -> Result<(), DriveError> {
    if !mean_m.is_finite() {
        return Err(DriveError::MeanApproach { mean_m });
    }
    if !(amplitude_m.is_finite() && amplitude_m > 0.0) {
        return Err(DriveError::ApproachAmplitude { amplitude_m });
    }
    match mean_m + amplitude_m <= 0.0 {
        true => Err(DriveError::NoTouch {
            mean_m,
            amplitude_m,
        }),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_load_swings_about_its_mean_and_never_becomes_a_pull() {
        let phase_rad = 1.5 * std::f64::consts::PI;
        let drive = HarmonicDrive::new(Control::Load, 10.0, 10.0, phase_rad, 0.0).unwrap();
        assert_eq!(drive.value(0.0), 0.0);
        assert!((drive.value(0.5) - 20.0).abs() < 1e-13);
        assert!((0..1000).all(|k| drive.value(f64::from(k) / 1000.0) >= 0.0));
    }

    #[test]
    fn an_amplitude_above_the_mean_is_a_pull_and_is_refused() {
        assert!(matches!(
            HarmonicDrive::load(1.0, 1.1),
            Err(DriveError::Pull { .. })
        ));
        for nonsense in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(HarmonicDrive::load(nonsense, 0.5).is_err());
            assert!(HarmonicDrive::load(1.0, nonsense).is_err());
        }
        assert!(HarmonicDrive::new(Control::Load, 1.0, 0.5, f64::NAN, 0.0).is_err());
        assert!(HarmonicDrive::new(Control::Load, 1.0, 0.5, 0.0, -1.0).is_err());
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
