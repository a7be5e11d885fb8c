//! What the axes of figures are in: SI units with a fitting prefix, or units of the elastic contact. An axis is titled with a
//! quantity over its unit, so that both are told apart there: `load W / N` and `load W / W₀`.

use crate::figures::elastic::ElasticScale;
use crate::quantity::{Dimension, FrequencyUnit, ZERO_CELSIUS_K, format_human};
use crate::report::ReportError;
use crate::report::number::{self, at_frequency, plain, prefix, scientific};
use crate::simulation::scenario::ScenarioPlan;
use crate::sweep::plan::figures::AxisUnits;
use crate::sweep::plan::{AxisValue, SweepPlan, Varied};

/// The units of a result's figures.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Units {
    /// `None`: SI units.
    scale: Option<Scale>,
    /// Of axes in SI units, of text and of tables.
    frequency_unit: FrequencyUnit,
}

#[derive(Debug, Clone, PartialEq)]
struct Scale {
    elastic: ElasticScale,
    /// Under which load or approach: `mean load`.
    under: String,
}

/// What numbers measure, and so in which units they are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    Energy,
    Load,
    /// Approaches and displacements.
    Approach,
    /// Lengths along the surface.
    Length,
    Pressure,
    Modulus,
    /// Per Pa; per GPa where the moduli are in GPa.
    Compliance,
    EnergyPerArea,
    AngularFrequency,
    Time,
    /// Never normalised: temperatures in °C, angles in degrees, others in SI units with a prefix.
    Of(Dimension),
    /// A ratio that is shown in per cent.
    Percent,
    /// A ratio or a count.
    Number,
}

/// A unit of normalised axes: its size (SI) and its symbol.
type Normal = (fn(&ElasticScale) -> f64, &'static str);

impl Measure {
    /// The SI unit, and that of normalised axes with its size (SI); `None` where these are the same.
    fn units(self) -> (&'static str, Option<Normal>) {
        match self {
            Self::Energy => ("J", Some((ElasticScale::energy_j, "W₀δ₀"))),
            Self::Load => ("N", Some((|scale| scale.load_n, "W₀"))),
            Self::Approach => ("m", Some((|scale| scale.approach_m, "δ₀"))),
            Self::Length => ("m", Some((|scale| scale.contact_radius_m, "a₀"))),
            Self::Pressure => ("Pa", Some((ElasticScale::pressure_pa, "p₀"))),
            Self::Modulus => ("Pa", Some((|scale| scale.modulus_pa, "E₀"))),
            Self::EnergyPerArea => {
                let density =
                    |scale: &ElasticScale| scale.energy_j() / scale.contact_radius_m.powi(2);
                ("J·m⁻²", Some((density, "W₀δ₀a₀⁻²")))
            }
            Self::Compliance => ("Pa⁻¹", None),
            Self::AngularFrequency => ("rad·s⁻¹", None),
            Self::Time => ("s", None),
            Self::Of(dimension) => (dimension.si_unit(), None),
            Self::Percent | Self::Number => ("", None),
        }
    }

    /// The unit as columns of tables have it at their end.
    pub fn suffix(self) -> String {
        match self {
            Self::EnergyPerArea => "j_per_m2".to_owned(),
            Self::AngularFrequency => "rad_per_s".to_owned(),
            Self::Compliance => "per_pa".to_owned(),
            _ => self.units().0.to_lowercase().replace('/', "_per_"),
        }
    }
}

/// How values in SI units are shown: what they are multiplied by, what is added, and the unit that they are in then.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    factor: f64,
    offset: f64,
    pub unit: String,
}

impl Shown {
    fn times(factor: f64, unit: impl Into<String>) -> Self {
        Self {
            factor,
            offset: 0.0,
            unit: unit.into(),
        }
    }

    /// In the SI unit with the prefix that fits values up to `largest`.
    fn in_si(largest: f64, si: &str) -> Self {
        let (factor, prefix) = prefix(largest);
        Self::times(factor, format!("{prefix}{si}"))
    }

    /// A value (SI units) in this unit.
    pub fn of(&self, value: f64) -> f64 {
        self.factor * value + self.offset
    }

    /// A difference of two values in this unit.
    pub fn of_difference(&self, difference: f64) -> f64 {
        self.factor * difference
    }

    /// The title of an axis of a quantity: `load W / N`.
    pub fn title(&self, quantity: &str) -> String {
        match self.unit.as_str() {
            "" => quantity.to_owned(),
            unit => format!("{quantity} / {unit}"),
        }
    }
}

impl Units {
    /// SI units, with this one for frequencies.
    pub fn in_si(frequency_unit: FrequencyUnit) -> Self {
        Self {
            scale: None,
            frequency_unit,
        }
    }

    /// As a sweep asks for.
    ///
    /// # Errors
    /// [`ReportError::Scale`] where normalised axes are asked for and there is no elastic contact.
    pub fn of_sweep(plan: &SweepPlan) -> Result<Self, ReportError> {
        let under = || format!("mean {}", plan.base.drive.control().name());
        let mut units = Self::new(plan.figures.axes, under, || ElasticScale::of_sweep(plan))?;
        units.frequency_unit = plan.figures.frequency_unit;
        Ok(units)
    }

    /// As a scenario asks for.
    ///
    /// # Errors
    /// As [`Units::of_sweep`].
    pub fn of_scenario(plan: &ScenarioPlan) -> Result<Self, ReportError> {
        let under = || format!("largest {}", plan.drive.control().name());
        Self::new(plan.figures.axes, under, || ElasticScale::of_scenario(plan))
    }

    fn new<E: Into<ReportError>>(
        axes: AxisUnits,
        under: impl Fn() -> String,
        elastic: impl Fn() -> Result<ElasticScale, E>,
    ) -> Result<Self, ReportError> {
        let scale = match axes {
            AxisUnits::Si => None,
            AxisUnits::Normalised => Some(Scale {
                elastic: elastic().map_err(Into::into)?,
                under: under(),
            }),
        };
        Ok(Self {
            scale,
            ..Self::default()
        })
    }

    /// How values up to `largest` (SI) in size are shown.
    pub fn shown(&self, measure: Measure, largest: f64) -> Shown {
        let (si, normal) = measure.units();
        match (measure, &self.scale, normal) {
            (_, Some(scale), Some((size, unit))) => {
                Shown::times(size(&scale.elastic).recip(), unit)
            }
            (Measure::AngularFrequency, ..) => match (self.time_s(), self.frequency_unit) {
                (Some(time_s), _) => Shown::times(time_s, "τ⁻¹"),
                (None, FrequencyUnit::RadPerS) => Shown::times(1.0, si),
                (None, unit) => Shown::times(unit.of(1.0), unit.name()),
            },
            // Long times stay in seconds.
            (Measure::Time, ..) => match self.time_s() {
                Some(time_s) => Shown::times(time_s.recip(), "τ"),
                None if largest < 1.0 => Shown::in_si(largest, si),
                None => Shown::times(1.0, si),
            },
            (Measure::Of(Dimension::Temperature), ..) => Shown {
                offset: -ZERO_CELSIUS_K,
                ..Shown::times(1.0, "°C")
            },
            (Measure::Of(Dimension::Angle), ..) => Shown::times(180.0 / std::f64::consts::PI, "°"),
            (Measure::Compliance, ..) => {
                // The unit is what is below the line: the largest one by which values are not all below one.
                const BELOW_1000: f64 = 1000.0 * (1.0 - 1e-12);
                let (factor, prefix) = prefix(BELOW_1000 / largest);
                Shown::times(factor.recip(), format!("{prefix}{si}"))
            }
            (Measure::Percent, ..) => Shown::times(100.0, "%"),
            (Measure::Number, ..) => Shown::times(1.0, ""),
            _ => Shown::in_si(largest, si),
        }
    }

    /// A value (SI units) with its unit, to be read: `5 N`, `25 °C`.
    pub fn value(&self, measure: Measure, value: f64, significant: usize) -> String {
        let shown = self.shown(measure, value.abs());
        let blank = if shown.unit == "°" { "" } else { " " };
        let number = scientific(shown.of(value), significant);
        format!("{number}{blank}{}", shown.unit)
            .trim_end()
            .to_owned()
    }

    /// What a second axis varies, measured.
    pub fn measure_of(varied: &Varied) -> Measure {
        let of_drive = !varied.has_own_column();
        match varied.dimension {
            Some(Dimension::Force) if of_drive => Measure::Load,
            Some(Dimension::Length) if of_drive => Measure::Approach,
            Some(dimension) => Measure::Of(dimension),
            None => Measure::Number,
        }
    }

    /// A value of what a second axis varies, to be read: `5 N`, `25 °C`.
    pub fn varied_value(&self, varied: &Varied, value: AxisValue) -> String {
        let AxisValue::Number(value) = value else {
            return number::varied(varied, value);
        };
        if varied.dimension == Some(Dimension::Temperature) {
            return number::varied_number(varied, value);
        }
        self.value(Self::measure_of(varied), value, 3)
    }

    fn time_s(&self) -> Option<f64> {
        self.scale.as_ref()?.elastic.time_s
    }

    /// The unit in which text and tables have frequencies.
    pub fn frequency_unit(&self) -> FrequencyUnit {
        self.frequency_unit
    }

    /// The unit of frequencies on the axes, where they are not normalised.
    fn axis_unit(&self) -> FrequencyUnit {
        match self.time_s() {
            Some(_) => FrequencyUnit::RadPerS,
            None => self.frequency_unit,
        }
    }

    /// What figures over frequency are drawn over: `angular frequency ω`.
    pub fn frequency_words(&self) -> String {
        let unit = self.axis_unit();
        format!("{} {}", unit.quantity(), unit.symbol())
    }

    /// An angular frequency (rad/s) as it stands in legends: `ω = 0.12 rad/s`, `f = 0.2 Hz`, `ω = 1.6 τ⁻¹`.
    pub fn frequency_label(&self, angular_frequency_rad_per_s: f64) -> String {
        match self.time_s() {
            Some(time_s) => {
                let value = scientific(time_s * angular_frequency_rad_per_s, 3);
                format!("ω = {value} τ⁻¹")
            }
            None => at_frequency(self.frequency_unit, angular_frequency_rad_per_s, 3),
        }
    }

    /// The same without its symbol.
    pub fn value_of(&self, angular_frequency_rad_per_s: f64) -> String {
        let unit = self.frequency_unit;
        plain(unit.of(angular_frequency_rad_per_s), unit.dimension(), 4)
    }

    /// The same as it stands in captions, never normalised.
    pub fn at(&self, angular_frequency_rad_per_s: f64) -> String {
        at_frequency(self.frequency_unit, angular_frequency_rad_per_s, 4)
    }

    /// What the units are, for a caption; nothing for SI units.
    pub fn sentence(&self) -> Option<String> {
        let Scale { elastic, under } = self.scale.as_ref()?;
        let human = |value, dimension| format_human(value, dimension, 4);
        let time = elastic.time_s.map_or(String::new(), |time_s| {
            format!(
                "; τ = {}, the retardation time of the branch of largest creep compliance",
                human(time_s, Dimension::Time)
            )
        });
        Some(format!(
            "Normalised by the elastic contact of the same indenter at the instantaneous compliance under the {under}: load \
             W₀ = {}, approach δ₀ = {}, contact radius a₀ = {}, pressure p₀ = 3W₀/(2πa₀²) = {}, instantaneous modulus \
             E₀ = {}{time}.",
            human(elastic.load_n, Dimension::Force),
            human(elastic.approach_m, Dimension::Length),
            human(elastic.contact_radius_m, Dimension::Length),
            human(elastic.pressure_pa(), Dimension::Stress),
            human(elastic.modulus_pa, Dimension::Stress),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::Control;
    use crate::sweep::plan::AxisValue::Number;
    use crate::sweep::plan::Block;

    fn normalised() -> Units {
        Units {
            frequency_unit: FrequencyUnit::RadPerS,
            scale: Some(Scale {
                elastic: ElasticScale {
                    load_n: 10.0,
                    approach_m: 2e-6,
                    contact_radius_m: 1e-4,
                    modulus_pa: 2e9,
                    time_s: Some(100.0),
                },
                under: "mean load".to_owned(),
            }),
        }
    }

    #[test]
    fn the_same_number_is_told_in_both_units() {
        let (si, normalised) = (Units::default(), normalised());
        assert_eq!(si.shown(Measure::Energy, 3e-6), Shown::times(1e6, "µJ"));
        let energy = normalised.shown(Measure::Energy, 3e-6);
        assert!((energy.of(2e-5) - 1.0).abs() < 1e-12 && energy.unit == "W₀δ₀");
        assert_eq!(si.frequency_label(0.12), "ω = 0.12 rad/s");
        assert_eq!(normalised.frequency_label(0.12), "ω = 12 τ⁻¹");
        let hz = Units::in_si(FrequencyUnit::Hz);
        let omega = std::f64::consts::TAU * 0.2;
        assert_eq!(hz.frequency_label(omega), "f = 0.2 Hz");
        assert_eq!(hz.at(omega / 1e3), "f = 2 × 10⁻⁴ Hz");
        let title = |units: &Units| {
            let unit = units.shown(Measure::AngularFrequency, 1.0);
            unit.title(&units.frequency_words())
        };
        assert_eq!(title(&hz), "frequency f / Hz");
        let [load, approach] = [Control::Load, Control::Approach].map(Varied::amplitude);
        assert_eq!(si.varied_value(&load, Number(5.0)), "5 N");
        assert_eq!(si.varied_value(&load, Number(0.25)), "250 mN");
        assert_eq!(si.varied_value(&approach, Number(1.5e-6)), "1.5 µm");
        assert_eq!(si.varied_value(&approach, Number(0.0)), "0 m");
        assert_eq!(normalised.varied_value(&load, Number(5.0)), "0.5 W₀");
        let of = |block, key: &'static str, dimension| Varied::number(block, key, dimension);
        let temperature = of(Block::Material, "temperature", Some(Dimension::Temperature));
        assert_eq!(
            normalised.varied_value(&temperature, Number(298.15)),
            "25 °C"
        );
        let angle = of(Block::Indenter, "half_angle", Some(Dimension::Angle));
        assert_eq!(
            si.varied_value(&angle, Number(0.5 * std::f64::consts::PI)),
            "90°"
        );
        assert_eq!(angle.column(), "indenter_half_angle_rad");
        let ratio = of(Block::Material, "poisson_ratio", None);
        assert_eq!(si.varied_value(&ratio, Number(0.4)), "0.4");
        assert_eq!(ratio.words(), "Poisson ratio of the material");
        assert_eq!(title(&si), "angular frequency ω / rad·s⁻¹");
        assert_eq!(title(&normalised), "angular frequency ω / τ⁻¹");
        assert_eq!(si.shown(Measure::Time, 500.0).unit, "s");
        assert_eq!(si.shown(Measure::Time, 0.5).unit, "ms");
        for (largest, unit) in [(1.9e-6, "MPa⁻¹"), (1e-6, "MPa⁻¹"), (0.9e-6, "GPa⁻¹")] {
            let shown = si.shown(Measure::Compliance, largest);
            assert_eq!(shown.unit, unit);
            assert!((1.0 - 1e-12..1000.0).contains(&shown.of(largest)));
        }
        assert_eq!(si.sentence(), None);
        let sentence = normalised.sentence().unwrap();
        for part in ["mean load", "W₀ = 10.00 N", "δ₀ = 2.000 µm", "τ = 100.0 s"] {
            assert!(sentence.contains(part), "{sentence}");
        }
    }
}
