//! Measured contact loops: from the record of an instrument, load and approach against time, to what the cycle dissipates and
//! how certain that is.
//!
//! Knows signals, and the exact model of `sweep` where the bias of a formula is computed with it; nothing of files or flags.
//! A record is read once ([`Signal`]), its frequency found ([`frequency`]), a drift told apart from the oscillation ([`drift`]), every
//! cycle fitted by itself with harmonics up to the fifth ([`cycles`]); what the instrument adds is taken out of the harmonics
//! ([`corrections`]), where that is exact. Means are over the cycles from which on nothing changes any more, without those that stand
//! apart ([`stabilisation`]). Everything that is to be known of a record is a [`Finding`].
//!
//! Harmonic n of a signal is |a_n| sin(n omega t + arg a_n), as in [`crate::cycle`]; t counts from the first sample.
//!
//! ```
//! # extern crate contact_dma_core as contact_dma;
//! use contact_dma::measured::{Options, Signal, analyse};
//! use std::f64::consts::{PI, TAU};
//!
//! let time_s: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
//! let load_n = time_s.iter().map(|t| 10.0 + 5.0 * (TAU * t).sin()).collect();
//! let approach_m = time_s.iter().map(|t| 1e-5 + 1e-7 * t + 2e-6 * (TAU * t - 0.1).sin()).collect();
//! let signal = Signal { time_s, load_n, approach_m, contact_radius_m: None };
//! let measured = analyse(&signal, &Options::default())?;
//! assert!((measured.frequency.hz - 1.0).abs() < 1e-6);
//! let loss = measured.energy_loss_j().ok_or("not stabilised")?;
//! assert!((loss.value / (PI * 5.0 * 2e-6 * 0.1_f64.sin()) - 1.0).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bias;
pub mod corrections;
pub mod cycles;
pub mod drift;
pub mod frequency;
mod least_squares;
mod lines;
mod mean;
pub mod moduli;
mod noise;
pub mod quality;
pub mod quantities;
mod record;
pub mod response;
pub mod signal;
pub mod stabilisation;
pub mod statistics;

pub use corrections::Corrections;
pub use quality::Finding;
pub use quantities::Quantity;
pub use record::{MeasuredLoop, Options, analyse};
pub use signal::Signal;
pub use statistics::Estimate;

/// Largest number of harmonics that are fitted.
pub const HARMONICS: usize = 5;

/// Why there is nothing to be said of a record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeasuredError {
    #[error(
        "the columns have {times} times, {loads} loads and {approaches} approaches; every sample needs all three"
    )]
    Lengths {
        times: usize,
        loads: usize,
        approaches: usize,
    },
    #[error("{samples} samples are too few for a cycle; at least {needed} are needed")]
    TooFewSamples { samples: usize, needed: usize },
    #[error("the times do not go on: all samples are at {time_s} s")]
    NoDuration { time_s: f64 },
    #[error("the {signal} is the same in all samples")]
    Constant { signal: &'static str },
    #[error(
        "between samples {first} and {second} the time leaps by {leap_s} s, more than all the rest of the record lasts: correct their \
         times, or leave out what stands alone"
    )]
    TimeLeaps {
        first: usize,
        second: usize,
        leap_s: f64,
    },
    #[error(
        "no oscillation{} is found in the {signal}: what repeats in it is no larger than the noise; {}",
        .given_hz.map_or(String::new(), |hz| format!(" of {hz} Hz")),
        if .given_hz.is_some() { "leave the frequency out, for it to be looked for" } else { "give the frequency if it is known" }
    )]
    NoOscillation {
        signal: &'static str,
        /// The frequency, where it was given.
        given_hz: Option<f64>,
    },
    #[error(
        "{samples} samples over {cycles:.0} cycles of {hz} Hz are fewer than one a cycle; are times and frequency in their units?"
    )]
    FewerThanCycles {
        samples: usize,
        cycles: f64,
        hz: f64,
    },
    #[error(
        "{points:.2} samples in a cycle of {hz} Hz do not resolve it: what is seen of it may be another frequency (aliasing); at least 3 \
         are needed"
    )]
    Aliased { hz: f64, points: f64 },
    #[error("the record holds {cycles:.2} cycles of {hz} Hz; at least one whole cycle is needed")]
    NoWholeCycle { hz: f64, cycles: f64 },
    #[error("the frequency is {hz} Hz; it must be above zero")]
    Frequency { hz: f64 },
}
