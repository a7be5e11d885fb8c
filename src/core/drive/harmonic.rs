//! The oscillation of a sweep, under either control: a mean, and a sine about it.

use super::{Control, DriveError, PHASE, PRESCRIBED, PRESCRIBES};
use crate::keys;
use crate::quantity::Dimension;
use crate::quantity::key::{Key, Kind, quantity};
use crate::quantity::rows::{Rows, table};
use crate::quantity::setting::Table;

keys! {
    /// Mean; the sum of mean and amplitude must be above zero.
    MEAN = "mean", Kind::Number(PRESCRIBED);
    /// Amplitude; a load is held at zero where the sine would be negative.
    AMPLITUDE = "amplitude", Kind::Number(PRESCRIBED.above_zero());
    /// Hold at the mean before the oscillation.
    HOLD = "hold", Kind::Number(quantity(Dimension::Time).not_negative()), or 0.0;
}

/// The keys of a file, but for what is prescribed.
pub const KEYS: &[Key] = &[MEAN, AMPLITUDE, PHASE, HOLD];

/// The `[drive]` block of a sweep file.
pub static HARMONIC: Rows = table(
    " mean + amplitude sin(omega t + phase), after a hold at the mean.",
    &[&[PRESCRIBES], KEYS],
);

/// A load or an approach held at its mean from first touch, then mean + amplitude sin(omega t + phase): equation (29) of S. Spinu,
/// Advances in Tribology 2018, 9432894. The angular frequency belongs to the sweep, not to the drive.
///
/// The indenter may leave the surface for part of the cycle: an approach may swing below the surface's rest position, and a
/// load whose amplitude exceeds its mean is held at zero where the sine is below it, since a contact without adhesion carries no
/// pull. An indenter that is attracted may be pulled as far as the attraction goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HarmonicDrive {
    control: Control,
    mean: f64,
    amplitude: f64,
    phase_rad: f64,
    hold_s: f64,
    /// How far a load may be a pull (N): zero without adhesion, without end where the contact itself says when it comes off.
    pull_off_n: f64,
}

impl HarmonicDrive {
    /// The block of a file that gives the same drive again.
    pub fn table(&self) -> Table {
        let dimension = self.control.dimension();
        Table::new("drive")
            .and(PRESCRIBES.setting(self.control))
            .and(MEAN.of(dimension).setting(self.mean))
            .and(AMPLITUDE.of(dimension).setting(self.amplitude))
            .and(PHASE.setting(self.phase_rad))
            .and(HOLD.setting(self.hold_s))
    }

    /// Mean and amplitude in newtons or metres, phase in radians, hold (s) at the mean before the oscillation.
    ///
    /// # Errors
    /// [`DriveError`]: a mean that is not finite, an amplitude that is not positive and finite, the two of them never above zero, so
    /// that the indenter never touches the surface; a phase that is not finite, a negative hold.
    pub fn new(
        control: Control,
        mean: f64,
        amplitude: f64,
        phase_rad: f64,
        hold_s: f64,
    ) -> Result<Self, DriveError> {
        Self::unattracted(control, mean, amplitude, phase_rad, hold_s)?.attracted_by(0.0)
    }

    /// The same, that may never touch without an attraction: see [`Self::attracted_by`].
    ///
    /// # Errors
    /// As [`Self::new`], but for an indenter that never touches.
    pub fn unattracted(
        control: Control,
        mean: f64,
        amplitude: f64,
        phase_rad: f64,
        hold_s: f64,
    ) -> Result<Self, DriveError> {
        if !mean.is_finite() {
            return Err(DriveError::Mean { control, mean });
        }
        if !(amplitude.is_finite() && amplitude > 0.0) {
            return Err(DriveError::Amplitude { control, amplitude });
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
            pull_off_n: 0.0,
        })
    }

    /// The same control and attraction with these numbers.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with(
        &self,
        mean: f64,
        amplitude: f64,
        phase_rad: f64,
        hold_s: f64,
    ) -> Result<Self, DriveError> {
        Self::unattracted(self.control, mean, amplitude, phase_rad, hold_s)?
            .attracted_by(self.pull_off_n)
    }

    /// The same drive of an indenter that is attracted by this much (N), so that a load may be a pull; the indenter does not come off.
    /// An infinite attraction is one of which the contact says how much it carries. Without one a load below zero is held at zero.
    ///
    /// # Errors
    /// [`DriveError`]: an indenter that never touches, a load that falls below the pull-off load.
    pub fn attracted_by(self, pull_off_n: f64) -> Result<Self, DriveError> {
        let Self {
            control,
            mean,
            amplitude,
            ..
        } = self;
        if self.maximum() + pull_off_n <= 0.0 {
            return Err(DriveError::NoTouch {
                control,
                mean,
                amplitude,
            });
        }
        let least_n = mean - amplitude;
        match pull_off_n == 0.0 || least_n >= -pull_off_n {
            true => Ok(Self { pull_off_n, ..self }),
            false => Err(DriveError::PullOff {
                least_n,
                pull_off_n,
            }),
        }
    }

    /// The constant attraction (N) that the contact carries beside the load: zero without one.
    pub fn pull_off_n(&self) -> f64 {
        super::constant_n(self.pull_off_n)
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

    /// The value during the hold before the oscillation, in the unit of the control: the mean, or no load where that is a pull that the
    /// indenter does not carry from its first touch on.
    pub fn held(&self) -> f64 {
        match self.control == Control::Load && self.pull_off_n.is_infinite() {
            true => self.mean.max(0.0),
            false => self.pressing(self.mean),
        }
    }

    /// The value at this fraction of a cycle since the oscillation began, in the unit of the control.
    pub fn value(&self, cycle_fraction: f64) -> f64 {
        let angle = std::f64::consts::TAU * cycle_fraction + self.phase_rad;
        self.pressing(self.mean + self.amplitude * angle.sin())
    }

    /// Zero in place of a pull; where the amplitude of a load equals its mean, rounding must not leave 1e-16 of it.
    fn pressing(&self, value: f64) -> f64 {
        // Not -0 without adhesion.
        let least = 0.0 - self.pull_off_n;
        let reaches = || value - least <= 1e-14 * (self.maximum() - least);
        match self.control == Control::Load && least.is_finite() && reaches() {
            true => least,
            false => value,
        }
    }

    /// The part of the cycle in which a load is above zero; `None` under approach control, where it depends on the material.
    pub fn loaded_part(&self) -> Option<f64> {
        let crossing_rad = ((self.mean + self.pull_off_n) / self.amplitude)
            .clamp(-1.0, 1.0)
            .asin();
        (self.control == Control::Load).then_some(0.5 + crossing_rad / std::f64::consts::PI)
    }

    /// The mean over the cycle (N) of a load, which is above [`Self::mean`] where the load is held at zero for a part of it; the mean
    /// of an approach (m).
    pub fn true_mean(&self) -> f64 {
        match self.loaded_part() {
            Some(part) if part < 1.0 => {
                let below = self.amplitude * self.amplitude - self.mean * self.mean;
                self.mean * part + below.max(0.0).sqrt() / std::f64::consts::PI
            }
            _ => self.mean,
        }
    }

    /// How far the maximum is above [`Self::true_mean`].
    pub fn above_true_mean(&self) -> f64 {
        match self.loaded_part() {
            Some(part) if part < 1.0 => self.maximum() - self.true_mean(),
            _ => self.amplitude,
        }
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
    fn a_load_is_held_at_zero_where_the_sine_is_below() {
        let drive = HarmonicDrive::load(1.0, 2.0).unwrap();
        assert_eq!(
            (drive.value(0.25), drive.value(0.75), drive.held()),
            (3.0, 0.0, 1.0)
        );
        // sin = -1/2 at 7/12 and 11/12 of the cycle.
        assert!((drive.loaded_part().unwrap() - 2.0 / 3.0).abs() < 1e-15);
        assert!(drive.value(7.0 / 12.0 - 1e-9) > 0.0 && drive.value(7.0 / 12.0 + 1e-9) == 0.0);
        for (mean_n, amplitude_n) in [(1.0, 2.0), (-1.0, 2.0), (0.0, 3.0), (2.0, 2.0), (5.0, 2.0)] {
            let drive = HarmonicDrive::load(mean_n, amplitude_n).unwrap();
            let samples = 100_000;
            let values = (0..samples).map(|k| drive.value(f64::from(k) / f64::from(samples)));
            let mean = values.clone().sum::<f64>() / f64::from(samples);
            let part = values.filter(|load| *load > 0.0).count() as f64 / f64::from(samples);
            assert!((mean - drive.true_mean()).abs() < 1e-8 * drive.maximum());
            // Where the load crosses zero a sample lies on the one side or the other.
            assert!((part - drive.loaded_part().unwrap()).abs() <= 2.0 / f64::from(samples));
        }
        assert_eq!(HarmonicDrive::load(-1.0, 2.0).unwrap().held(), 0.0);
        // Nothing is carried before the first touch, whatever is afterwards.
        let attracted = HarmonicDrive::load(-1.0, 2.0).unwrap();
        let attracted = attracted.attracted_by(f64::INFINITY).unwrap();
        assert_eq!((attracted.held(), attracted.value(0.75)), (0.0, -3.0));
        assert!(matches!(
            HarmonicDrive::load(-2.0, 2.0),
            Err(DriveError::NoTouch { .. })
        ));
        for nonsense in [f64::NAN, f64::INFINITY] {
            assert!(HarmonicDrive::load(nonsense, 0.5).is_err());
        }
        for nonsense in [0.0, -1.0, f64::NAN, f64::INFINITY] {
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
