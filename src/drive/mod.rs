//! What drives the contact: a load (N) or an approach (m) against time. Knows nothing of contact.
//!
//! Under load control the drive says how hard the indenter is pressed, and never pulls: a contact without adhesion cannot.
//! Under approach control it says where the indenter stands, and may well stand clear of the surface. A number whose unit
//! depends on the [`Control`] carries no unit in its name: it is in newtons or in metres.

mod harmonic;
mod piece;
mod schedule;
mod segments;

pub use harmonic::HarmonicDrive;
pub use schedule::{Fineness, MAX_MOMENTS, Moment, Schedule, ScheduleError, Steps};
pub use segments::{HistoryError, Joint, Segment, SegmentProblem, SegmentedDrive};

/// What the drive prescribes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Control {
    /// The normal load W, in N.
    #[default]
    Load,
    /// The approach delta, in m.
    Approach,
}

impl Control {
    /// The name as written in a file, which is also that of the quantity.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Load => "load",
            Self::Approach => "approach",
        }
    }

    /// The SI unit of the drive's values.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Load => "N",
            Self::Approach => "m",
        }
    }
}

/// Why a drive is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DriveError {
    #[error("the mean load is {mean_n} N; a contact needs a positive, finite mean load")]
    Mean { mean_n: f64 },
    #[error("the load amplitude is {amplitude_n} N; it must be positive and finite")]
    Amplitude { amplitude_n: f64 },
    #[error(
        "the load amplitude {amplitude_n} N exceeds the mean load {mean_n} N: the load would become a pull for part of the \
         cycle, which a contact without adhesion cannot carry"
    )]
    Pull { mean_n: f64, amplitude_n: f64 },
    #[error("the mean approach is {mean_m} m; it must be finite")]
    MeanApproach { mean_m: f64 },
    #[error("the approach amplitude is {amplitude_m} m; it must be positive and finite")]
    ApproachAmplitude { amplitude_m: f64 },
    #[error(
        "the approach {mean_m} m with an amplitude of {amplitude_m} m is never above zero: the indenter never touches the surface"
    )]
    NoTouch { mean_m: f64, amplitude_m: f64 },
    #[error("the phase {phase_rad} rad is not a finite angle")]
    Phase { phase_rad: f64 },
    #[error("the hold of {hold_s} s must be zero or a positive, finite time")]
    Hold { hold_s: f64 },
}

/// A load held at its mean W_0 from first touch, then W_0 + W_A sin(omega t + phase): equation (29) of S. Spinu,
/// Advances in Tribology 2018, 9432894. The angular frequency belongs to the sweep, not to the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HarmonicLoad {
    mean_n: f64,
    amplitude_n: f64,
    phase_rad: f64,
    hold_s: f64,
}

impl HarmonicLoad {
    /// Mean and amplitude in newtons, `0 < amplitude <= mean`; phase in radians; hold (s) at the mean before the oscillation.
    pub fn new(
        mean_n: f64,
        amplitude_n: f64,
        phase_rad: f64,
        hold_s: f64,
    ) -> Result<Self, DriveError> {
        if !(mean_n.is_finite() && mean_n > 0.0) {
            return Err(DriveError::Mean { mean_n });
        }
        if !(amplitude_n.is_finite() && amplitude_n > 0.0) {
            return Err(DriveError::Amplitude { amplitude_n });
        }
        if amplitude_n > mean_n {
            return Err(DriveError::Pull {
                mean_n,
                amplitude_n,
            });
        }
        check_phase_and_hold(phase_rad, hold_s)?;
        Ok(Self {
            mean_n,
            amplitude_n,
            phase_rad,
            hold_s,
        })
    }

    /// Mean load W_0 (N).
    pub fn mean_n(&self) -> f64 {
        self.mean_n
    }

    /// Load amplitude W_A (N).
    pub fn amplitude_n(&self) -> f64 {
        self.amplitude_n
    }

    /// Phase at the start of the oscillation (rad).
    pub fn phase_rad(&self) -> f64 {
        self.phase_rad
    }

    /// Time at the mean load before the oscillation (s).
    pub fn hold_s(&self) -> f64 {
        self.hold_s
    }

    /// The largest load of the cycle (N).
    pub fn maximum_n(&self) -> f64 {
        self.mean_n + self.amplitude_n
    }

    /// Load (N) at this fraction of a cycle since the oscillation began.
    ///
    /// Where the amplitude equals the mean the load touches zero; rounding must not leave a pull of 1e-16 of it there.
    pub fn load_n(&self, cycle_fraction: f64) -> f64 {
        let angle = std::f64::consts::TAU * cycle_fraction + self.phase_rad;
        let load_n = self.mean_n + self.amplitude_n * angle.sin();
        if load_n > 1e-14 * self.maximum_n() {
            load_n
        } else {
            0.0
        }
    }
}

/// What mean and amplitude do not decide.
fn check_phase_and_hold(phase_rad: f64, hold_s: f64) -> Result<(), DriveError> {
    if !phase_rad.is_finite() {
        return Err(DriveError::Phase { phase_rad });
    }
    if !(hold_s.is_finite() && hold_s >= 0.0) {
        return Err(DriveError::Hold { hold_s });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_load_swings_about_its_mean_and_never_becomes_a_pull() {
        let drive = HarmonicLoad::new(10.0, 10.0, 1.5 * std::f64::consts::PI, 0.0).unwrap();
        assert_eq!(drive.load_n(0.0), 0.0);
        assert!((drive.load_n(0.5) - 20.0).abs() < 1e-13);
        assert!((0..1000).all(|k| drive.load_n(k as f64 / 1000.0) >= 0.0));
    }

    #[test]
    fn an_amplitude_above_the_mean_is_a_pull_and_is_refused() {
        assert!(matches!(
            HarmonicLoad::new(1.0, 1.1, 0.0, 0.0),
            Err(DriveError::Pull { .. })
        ));
        for nonsense in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(HarmonicLoad::new(nonsense, 0.5, 0.0, 0.0).is_err());
            assert!(HarmonicLoad::new(1.0, nonsense, 0.0, 0.0).is_err());
        }
    }
}
