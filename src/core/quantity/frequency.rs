//! Frequencies are computed with in rad/s, and given and reported in the unit asked for: ω in rad/s, or f in Hz.

use std::f64::consts::TAU;

use super::Dimension;
use crate::words;

words! {
    /// The unit in which frequencies are reported.
    #[derive(Default, serde::Serialize)]
    pub enum FrequencyUnit {
        #[default]
        #[serde(rename = "rad/s")]
        RadPerS = "rad/s",
        Hz = "Hz",
    }
}

impl FrequencyUnit {
    /// An angular frequency (rad/s) in this unit.
    pub fn of(self, angular_frequency_rad_per_s: f64) -> f64 {
        match self {
            Self::RadPerS => angular_frequency_rad_per_s,
            Self::Hz => angular_frequency_rad_per_s / TAU,
        }
    }

    /// The dimension that [`FrequencyUnit::of`] has.
    pub fn dimension(self) -> Dimension {
        match self {
            Self::RadPerS => Dimension::AngularFrequency,
            Self::Hz => Dimension::Frequency,
        }
    }

    /// The quantity in words.
    pub fn quantity(self) -> &'static str {
        match self {
            Self::RadPerS => "angular frequency",
            Self::Hz => "frequency",
        }
    }

    /// Its symbol.
    pub fn symbol(self) -> char {
        match self {
            Self::RadPerS => 'ω',
            Self::Hz => 'f',
        }
    }

    /// Its column in tables.
    pub fn column(self) -> &'static str {
        match self {
            Self::RadPerS => "angular_frequency_rad_per_s",
            Self::Hz => "frequency_hz",
        }
    }
}
