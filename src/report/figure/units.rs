//! What the axes of figures are in: SI units with a fitting prefix, or units of the elastic contact. An axis is titled with a
//! quantity over its unit, so that both are told apart there: `load W / N` and `load W / W₀`.

use crate::drive::Control;
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

/// How what a second axis varies is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct VariedUnit {
    factor: f64,
    offset: f64,
    unit: String,
}

impl VariedUnit {
    /// A value (SI units) in this unit.
    pub fn of(&self, value: f64) -> f64 {
        self.factor * value + self.offset
    }

    /// The title of an axis: `load amplitude / N`, `temperature of the material / °C`.
    pub fn title(&self, varied: &Varied, control: Control) -> String {
        let words = match varied.has_own_column() {
            true => varied.words(),
            false => format!("{} {}", control.name(), varied.name()),
        };
        match self.unit.as_str() {
            "" => words,
            unit => format!("{words} / {unit}"),
        }
    }
}

/// What a number is multiplied by to be drawn, and the unit it is then in.
pub type Unit = (f64, String);

/// The SI unit with the prefix that fits values up to `largest`.
fn in_si(largest: f64, si: &str) -> Unit {
    let (factor, prefix) = prefix(largest);
    (factor, format!("{prefix}{si}"))
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

    /// The unit of values up to `largest` (SI).
    fn unit(&self, largest: f64, si: &str, normal: (fn(&ElasticScale) -> f64, &str)) -> Unit {
        match &self.scale {
            Some(scale) => (normal.0(&scale.elastic).recip(), normal.1.to_owned()),
            None => in_si(largest, si),
        }
    }

    /// Energies (J).
    pub fn energy(&self, largest: f64) -> Unit {
        self.unit(largest, "J", (ElasticScale::energy_j, "W₀δ₀"))
    }

    /// Loads (N).
    pub fn load(&self, largest: f64) -> Unit {
        self.unit(largest, "N", (|scale| scale.load_n, "W₀"))
    }

    /// Approaches and displacements (m).
    pub fn approach(&self, largest: f64) -> Unit {
        self.unit(largest, "m", (|scale| scale.approach_m, "δ₀"))
    }

    /// Lengths along the surface (m).
    pub fn length(&self, largest: f64) -> Unit {
        self.unit(largest, "m", (|scale| scale.contact_radius_m, "a₀"))
    }

    /// Pressures (Pa).
    pub fn pressure(&self, largest: f64) -> Unit {
        self.unit(largest, "Pa", (ElasticScale::pressure_pa, "p₀"))
    }

    /// Moduli (Pa).
    pub fn modulus(&self, largest: f64) -> Unit {
        self.unit(largest, "Pa", (|scale| scale.modulus_pa, "E₀"))
    }

    /// Energies per area (J/m²).
    pub fn density(&self, largest: f64) -> Unit {
        let density = |scale: &ElasticScale| scale.energy_j() / scale.contact_radius_m.powi(2);
        self.unit(largest, "J·m⁻²", (density, "W₀δ₀a₀⁻²"))
    }

    /// What a second axis varies, up to `largest` (SI) in size.
    pub fn varied(&self, varied: &Varied, largest: f64) -> VariedUnit {
        let of_drive = !varied.has_own_column();
        let (factor, unit) = match varied.dimension {
            Some(Dimension::Force) if of_drive => self.load(largest),
            Some(Dimension::Length) if of_drive => self.approach(largest),
            Some(Dimension::Temperature) => (1.0, "°C".to_owned()),
            Some(Dimension::Angle) => (180.0 / std::f64::consts::PI, "°".to_owned()),
            Some(dimension) => in_si(largest, dimension.si_unit()),
            None => (1.0, String::new()),
        };
        let offset = match varied.dimension {
            Some(Dimension::Temperature) => -ZERO_CELSIUS_K,
            _ => 0.0,
        };
        VariedUnit {
            factor,
            offset,
            unit,
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
        let unit = self.varied(varied, value.abs());
        let number = scientific(unit.of(value), 3);
        let blank = if unit.unit == "°" { "" } else { " " };
        format!("{number}{blank}{}", unit.unit)
            .trim_end()
            .to_owned()
    }

    fn time_s(&self) -> Option<f64> {
        self.scale.as_ref()?.elastic.time_s
    }

    /// Angular frequencies (rad/s). An elastic body has no time to take them in units of.
    pub fn frequency(&self) -> Unit {
        match (self.time_s(), self.frequency_unit) {
            (Some(time_s), _) => (time_s, "τ⁻¹".to_owned()),
            (None, FrequencyUnit::RadPerS) => (1.0, "rad·s⁻¹".to_owned()),
            (None, unit) => (unit.of(1.0), unit.name().to_owned()),
        }
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

    /// Times (s); long ones stay in seconds.
    pub fn time(&self, largest: f64) -> Unit {
        match self.time_s() {
            Some(time_s) => (time_s.recip(), "τ".to_owned()),
            None if largest < 1.0 => in_si(largest, "s"),
            None => (1.0, "s".to_owned()),
        }
    }

    /// The title of an axis of frequencies.
    pub fn frequency_title(&self) -> String {
        format!("{} / {}", self.frequency_words(), self.frequency().1)
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
        assert_eq!(si.energy(3e-6), (1e6, "µJ".to_owned()));
        let (factor, unit) = normalised.energy(3e-6);
        assert!((factor * 2e-5 - 1.0).abs() < 1e-12 && unit == "W₀δ₀");
        assert_eq!(si.frequency_label(0.12), "ω = 0.12 rad/s");
        assert_eq!(normalised.frequency_label(0.12), "ω = 12 τ⁻¹");
        let hz = Units::in_si(FrequencyUnit::Hz);
        let omega = std::f64::consts::TAU * 0.2;
        assert_eq!(hz.frequency_label(omega), "f = 0.2 Hz");
        assert_eq!(hz.at(omega / 1e3), "f = 2 × 10⁻⁴ Hz");
        assert_eq!(hz.frequency_title(), "frequency f / Hz");
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
        let unit = si.varied(&temperature, 300.0);
        let title = unit.title(&temperature, Control::Load);
        assert_eq!(title, "temperature of the material / °C");
        let angle = of(Block::Indenter, "half_angle", Some(Dimension::Angle));
        assert_eq!(
            si.varied_value(&angle, Number(0.5 * std::f64::consts::PI)),
            "90°"
        );
        assert_eq!(angle.column(), "indenter_half_angle_rad");
        let ratio = of(Block::Material, "poisson_ratio", None);
        assert_eq!(si.varied_value(&ratio, Number(0.4)), "0.4");
        assert_eq!(ratio.words(), "Poisson ratio of the material");
        assert_eq!(si.frequency_title(), "angular frequency ω / rad·s⁻¹");
        assert_eq!(normalised.frequency_title(), "angular frequency ω / τ⁻¹");
        assert_eq!(si.time(500.0).1, "s");
        assert_eq!(si.time(0.5).1, "ms");
        assert_eq!(si.sentence(), None);
        let sentence = normalised.sentence().unwrap();
        for part in ["mean load", "W₀ = 10.00 N", "δ₀ = 2.000 µm", "τ = 100.0 s"] {
            assert!(sentence.contains(part), "{sentence}");
        }
    }
}
