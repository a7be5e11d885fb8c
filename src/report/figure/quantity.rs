//! What is along the axes of figures: the quantities that are drawn, each with its words, its column in tables and the scale of its axis.

use std::borrow::Cow;

use super::units::{Measure, Units};
use crate::drive::Control;
use crate::quantity::{Dimension, FrequencyUnit};
use crate::report::chart::Scale;
use crate::report::number::range;
use crate::sweep::plan::Varied;

/// What is along an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Its column in tables, with the SI unit as its last part.
    pub column: Cow<'static, str>,
    /// In words, with its symbol: `load W`.
    pub words: Cow<'static, str>,
    pub measure: Measure,
    pub spread: Spread,
}

/// When an axis is logarithmic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spread {
    Linear,
    /// Linear, of what is counted.
    Whole,
    Log,
    /// Where values, all above zero, are more than eight times apart and not evenly spaced.
    OfValues,
    /// Where the highest points of the curves are: on a linear axis the lowest curve would lie on the axis.
    OfCurves,
}

/// Values more than so many times apart are not seen together on a linear axis.
pub(super) const WIDE: f64 = 8.0;
/// The same of the highest points of curves.
pub(super) const WIDE_CURVES: f64 = 20.0;

impl Spread {
    /// The scale on which values are seen together.
    pub fn of_values(values: Vec<f64>) -> Scale {
        match is_even(&values) {
            true => Scale::Linear,
            false => scale(range(values), WIDE),
        }
    }
}

impl Quantity {
    pub const fn new(column: &'static str, words: &'static str, measure: Measure) -> Self {
        Self {
            column: Cow::Borrowed(column),
            words: Cow::Borrowed(words),
            measure,
            spread: Spread::Linear,
        }
    }

    /// The same, on an axis that is logarithmic under this condition.
    #[must_use]
    pub const fn spread(mut self, spread: Spread) -> Self {
        self.spread = spread;
        self
    }

    /// The same in other words.
    #[must_use]
    pub fn called(mut self, words: impl Into<Cow<'static, str>>) -> Self {
        self.words = words.into();
        self
    }

    /// The frequency, in the words of its unit.
    pub fn frequency(units: &Units) -> Self {
        Self::new(
            FrequencyUnit::RadPerS.column(),
            "",
            Measure::AngularFrequency,
        )
        .spread(Spread::Log)
        .called(units.frequency_words())
    }

    /// What an axis of a sweep varies.
    pub fn varied(varied: &Varied, control: Control) -> Self {
        let words = match varied.has_own_column() {
            true => varied.words(),
            false => format!("{} {}", control.name(), varied.name()),
        };
        Self {
            column: varied.column().into(),
            ..Self::new("", "", Units::measure_of(varied))
                .spread(Spread::OfValues)
                .called(words)
        }
    }

    /// The column of something that belongs to a value, such as its error: `energy_loss_error_j`.
    pub(super) fn column_of(&self, what: &str) -> String {
        let unit = self.measure.suffix();
        let stem = match unit.is_empty() {
            true => &*self.column,
            false => self
                .column
                .strip_suffix(&*unit)
                .and_then(|stem| stem.strip_suffix('_'))
                .unwrap_or(&self.column),
        };
        match unit.is_empty() || stem == self.column {
            true => format!("{stem}_{what}"),
            false => format!("{stem}_{what}_{unit}"),
        }
    }
}

/// Logarithmic where values between these two are positive and more than `wide` times apart.
pub(super) fn scale((least, largest): (f64, f64), wide: f64) -> Scale {
    match least > 0.0 && largest > wide * least {
        true => Scale::Log,
        false => Scale::Linear,
    }
}

/// Whether values, as those of an axis that was asked for with linear spacing, have equal distances: three of them or more.
pub(super) fn is_even(values: &[f64]) -> bool {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return false;
    };
    let steps = (values.len() - 1) as f64;
    let even = |k: usize| first + (last - first) * k as f64 / steps;
    let off = |(k, value): (usize, &f64)| (value - even(k)).abs() <= 1e-3 * (last - first) / steps;
    values.len() > 2 && values.iter().enumerate().all(off)
}

pub const ENERGY_LOSS: Quantity =
    Quantity::new("energy_loss_j", "energy loss per cycle", Measure::Energy)
        .spread(Spread::OfCurves);
pub const LOAD: Quantity = Quantity::new("load_n", "load W", Measure::Load);
pub const APPROACH: Quantity = Quantity::new("approach_m", "approach δ", Measure::Approach);
pub const CONTACT_RADIUS: Quantity =
    Quantity::new("contact_radius_m", "contact radius a", Measure::Length);
pub const PRESSURE: Quantity = Quantity::new("pressure_pa", "pressure p", Measure::Pressure);
pub const DISPLACEMENT: Quantity =
    Quantity::new("displacement_m", "displacement u", Measure::Approach);
pub const WORK_PER_AREA: Quantity = Quantity::new(
    "work_j_per_m2",
    "work per cycle and area w",
    Measure::EnergyPerArea,
);
pub const TIME: Quantity = Quantity::new("time_s", "time t", Measure::Time);
pub const MODULUS: Quantity =
    Quantity::new("modulus_pa", "modulus", Measure::Modulus).spread(Spread::Log);
pub const STORAGE_MODULUS: Quantity =
    Quantity::new("storage_modulus_pa", "storage modulus E′", Measure::Modulus);
pub const LOSS_MODULUS: Quantity =
    Quantity::new("loss_modulus_pa", "loss modulus E″", Measure::Modulus);
pub const COMPLEX_MODULUS: Quantity = Quantity::new(
    "complex_modulus_pa",
    "magnitude of the complex modulus |E*|",
    Measure::Modulus,
)
.spread(Spread::OfValues);
/// δ is the approach, and so the angle is φ.
pub const PHASE_ANGLE: Quantity = Quantity::new(
    "phase_angle_rad",
    "phase angle φ",
    Measure::Of(Dimension::Angle),
);
pub const LOSS_TANGENT: Quantity = Quantity::new(
    "loss_tangent",
    "loss tangent tan φ = E″/E′",
    Measure::Number,
);
pub const TEMPERATURE: Quantity = Quantity::new(
    "temperature_k",
    "temperature T",
    Measure::Of(Dimension::Temperature),
);
pub const CYCLE: Quantity =
    Quantity::new("cycle", "number of the cycle", Measure::Number).spread(Spread::Whole);
pub const RESIDUAL: Quantity = Quantity::new(
    "relative_difference",
    "difference of model and data, over the data",
    Measure::Percent,
);
