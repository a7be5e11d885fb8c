//! What drives the contact: a load (N) or an approach (m) against time. Knows nothing of contact.
//!
//! Under load control the drive says how hard the indenter is pressed, and never pulls: a contact without adhesion cannot, and
//! where the sine of a sweep would, the load is held at zero.
//! Under approach control it says where the indenter stands, and may well stand clear of the surface. A number whose unit
//! depends on the [`Control`] carries no unit in its name: it is in newtons or in metres.
//!
//! ```
//! # extern crate contact_dma_core as contact_dma;
//! use contact_dma::drive::{Control, DriveError, HarmonicDrive, Segment, SegmentedDrive};
//!
//! let drive = HarmonicDrive::load(10.0, 5.0)?; // mean and amplitude, N
//! assert_eq!(drive.value(0.25), 15.0);
//! // A contact without adhesion carries no pull.
//! assert_eq!(HarmonicDrive::load(10.0, 11.0)?.value(0.75), 0.0);
//! let ramp = Segment::Ramp { to: 10.0, duration_s: 2.0 };
//! let history = SegmentedDrive::new(Control::Load, vec![ramp]);
//! assert!(history.is_ok_and(|history| history.maximum() == 10.0));
//! # Ok::<(), DriveError>(())
//! ```

pub mod harmonic;
mod piece;
mod schedule;
pub mod segment;
pub mod segments;

use crate::quantity::key::{Kind, Number, quantity};
use crate::quantity::{Dimension, format_human};
use crate::{keys, words};

pub use harmonic::HarmonicDrive;
pub use schedule::{Fineness, MAX_MOMENTS, Moment, Schedule, ScheduleError, Steps};
pub use segment::{Segment, SegmentProblem};
pub use segments::{HistoryError, Joint, SegmentedDrive};

words! {
    /// What the drive prescribes.
    #[derive(Default)]
    pub enum Control {
        /// The normal load W, in N.
        #[default]
        Load = "load",
        /// The approach delta, in m.
        Approach = "approach",
    }
}

words! {
    /// What a file may prescribe: a load, also as a mean pressure, or an approach.
    pub enum Prescribed {
        Load = "load",
        Pressure = "pressure",
        Approach = "approach",
    }
}

impl Prescribed {
    /// What is controlled, a pressure by its load.
    pub fn control(self) -> Control {
        match self {
            Self::Load | Self::Pressure => Control::Load,
            Self::Approach => Control::Approach,
        }
    }

    /// What kind of quantity the values are.
    pub fn dimension(self) -> Dimension {
        match self {
            Self::Pressure => Dimension::Stress,
            Self::Load | Self::Approach => self.control().dimension(),
        }
    }
}

/// A load, a mean pressure where that is prescribed, or an approach.
pub const PRESCRIBED: Number =
    quantity(Dimension::Force).or_of(&[Dimension::Length, Dimension::Stress]);

keys! {
    /// What is prescribed: the load; the mean pressure on a periodic surface (load over the area of one period); or the approach. The
    /// values below are then forces, stresses or lengths.
    PRESCRIBES = "control", Kind::Word(Prescribed::WORDS), or Prescribed::Load;
    /// Phase at the start of the oscillation.
    PHASE = "phase", Kind::Number(quantity(Dimension::Angle)), or 0.0;
}

impl Control {
    /// What kind of quantity the drive's values are.
    pub fn dimension(self) -> Dimension {
        match self {
            Self::Load => Dimension::Force,
            Self::Approach => Dimension::Length,
        }
    }

    /// The SI unit of the drive's values.
    pub fn unit(self) -> &'static str {
        self.dimension().si_unit()
    }
}

/// Why a drive is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DriveError {
    #[error("the mean {} is {mean} {}; it must be finite", .control.name(), .control.unit())]
    Mean { control: Control, mean: f64 },
    #[error("the {} amplitude is {amplitude} {}; it must be positive and finite", .control.name(), .control.unit())]
    Amplitude { control: Control, amplitude: f64 },
    #[error(
        "the {} {mean} {unit} with an amplitude of {amplitude} {unit} is never above zero: the indenter never touches the surface",
        .control.name(), unit = .control.unit()
    )]
    NoTouch {
        control: Control,
        mean: f64,
        amplitude: f64,
    },
    #[error(
        "the load falls to {}, below the pull-off load of {}: the indenter comes off the surface",
        format_human(*least_n, Dimension::Force, 4),
        format_human(-pull_off_n, Dimension::Force, 4)
    )]
    PullOff { least_n: f64, pull_off_n: f64 },
    #[error("the phase {phase_rad} rad is not a finite angle")]
    Phase { phase_rad: f64 },
    #[error("the hold of {hold_s} s must be zero or a positive, finite time")]
    Hold { hold_s: f64 },
}

/// The constant pull (N) beside a load: an infinite one is that of a contact which says itself how much it carries.
fn constant_n(pull_off_n: f64) -> f64 {
    match pull_off_n.is_finite() {
        true => pull_off_n,
        false => 0.0,
    }
}
