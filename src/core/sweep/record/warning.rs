//! What is said of a case or of a history that lies outside the model, or has no error bars: the kinds, and their words.
//! The limits themselves are those of the guide on validity.

use std::f64::consts::PI;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::indenter::{Domain, Indenter};
use crate::material::Material;
use crate::material::dynamic::SAME_TEMPERATURE_K;
use crate::quantity::{Dimension, FrequencyUnit, celsius, format_prose};
use crate::sweep::plan::adhesion::AdhesionModel;
use crate::sweep::plan::layer::LayerPlan;
use crate::sweep::record::CaseResult;
use crate::sweep::record::error_bars::Quantity;

/// Slope of an indenter up to which slopes are small: a/R of a sphere, 11 degrees of a cone.
pub const LARGEST_SLOPE: f64 = 0.2;
/// Strain up to which a glassy polymer is linear, and the modulus |E*| (Pa) from which a material counts as glassy. Softer ones
/// are linear further than slopes are small: [`LARGEST_SLOPE`] is a strain of 4 %.
pub const LARGEST_GLASSY_STRAIN: f64 = 0.01;
pub const GLASSY_MODULUS_PA: f64 = 1e9;
/// Approach over the thickness of a layer up to which its compression is small.
pub const LARGEST_DEPTH: f64 = 0.1;
/// Tabor's parameter up to which attraction leaves the shape of the contact alone, and from which it decides it.
pub const LARGEST_TABOR_PARAMETER: f64 = 0.1;
pub const JKR_TABOR_PARAMETER: f64 = 5.0;
/// Cells of a map in contact below which they are too few for a shape between them.
pub const FEWEST_CELLS_IN_CONTACT: f64 = 20.0;
/// A loss below zero by less than this part of load times approach is rounding, and what the instants' tolerance leaves.
const NO_LOSS: f64 = 1e-9;
/// Difference between the dissipation and the loop's area, relative, from which the time steps or nodes are too few; and that from
/// which they are whatever the error bar is.
pub const LARGEST_IMBALANCE: f64 = 0.01;
pub const LARGEST_IMBALANCE_IN_BAR: f64 = 0.1;
/// Time steps in contact below which they are too few.
pub const FEWEST_STEPS_IN_CONTACT: f64 = 10.0;
/// Representative strain over slope.
pub const STRAIN_PER_SLOPE: f64 = 0.2;

/// One thing to be said of a case or of a history.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Warning {
    /// The frequency is below one over the longest time in which the material was measured.
    BelowMeasured {
        angular_frequency_rad_per_s: f64,
        last_measured_s: f64,
    },
    /// The frequency is above one over the shortest.
    AboveMeasured {
        angular_frequency_rad_per_s: f64,
        first_measured_s: f64,
    },
    /// Something in a history takes no longer than this time (s), 0 for a jump, and the material was measured later only.
    ShorterThanMeasured { time_s: f64, first_measured_s: f64 },
    /// A history lasts longer than the material was measured.
    LongerThanMeasured { time_s: f64, last_measured_s: f64 },
    /// The material is taken at a temperature outside those of its isotherms.
    OutsideIsotherms {
        temperature_k: f64,
        lowest_k: f64,
        highest_k: f64,
    },
    /// The representative strain is beyond what a glassy material takes linearly.
    LargeStrain { strain: f64 },
    /// The indenter's slope within the contact is not small.
    SteepSlope { slope: f64, contact_radius_m: f64 },
    /// The approach is no small part of the thickness of a layer.
    DeepInLayer { part: f64 },
    /// The attraction deforms the surfaces, which the theory of Derjaguin, Muller and Toporov neglects.
    TaborParameter { parameter: f64 },
    /// The largest contact on a map has this many of its cells.
    FewCells { cells: f64 },
    /// The energy loss (J) of a passive body is below zero.
    NegativeLoss { energy_loss_j: f64 },
    /// The contact lasts a few of the cycle's time steps alone.
    ShortContact { steps: f64 },
    /// What the branches dissipate is not the area of the loop, by this part of it.
    EnergyImbalance { part: f64 },
    /// Error bars were wanted, and there are none.
    NoErrorBars { because: NoErrorBars },
    /// A history has error bars, and its material is not known exactly: it may be any of this many others, or, of none, comes from noisy
    /// samples.
    NoMaterialError { others: usize },
}

/// Why there are no error bars.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoErrorBars {
    /// The indenter is a map, with one cell on every point.
    OwnCells,
    /// There is no coarser resolution, or it has no result.
    NoCoarserResult,
    /// What the time steps see of the contact is chance.
    ShortContact,
}

impl NoErrorBars {
    fn words(self) -> &'static str {
        match self {
            Self::OwnCells => {
                "a map is solved on its own cells, and there are no coarser ones to compare with"
            }
            Self::NoCoarserResult => "there is no coarser result to compare with",
            Self::ShortContact => "the contact is shorter than two time steps",
        }
    }
}

impl Warning {
    /// What is to be said of the temperature of a material.
    pub(crate) fn of_temperature(material: &Material) -> Option<Self> {
        let (temperature_k, (lowest_k, highest_k)) = material
            .origin
            .temperature_k
            .zip(material.origin.isotherms_k)?;
        let within = lowest_k - SAME_TEMPERATURE_K..=highest_k + SAME_TEMPERATURE_K;
        (!within.contains(&temperature_k)).then_some(Self::OutsideIsotherms {
            temperature_k,
            lowest_k,
            highest_k,
        })
    }

    /// What is to be said of an approach (m) into a layer on a rigid base, where the body is one: a base that yields takes its part of
    /// the approach.
    pub(crate) fn of_depth(layer: Option<LayerPlan>, approach_m: f64) -> Option<Self> {
        let layer = layer.filter(|layer| layer.yielding().is_none())?;
        let part = approach_m / layer.thickness_m;
        (part > LARGEST_DEPTH && part.is_finite()).then_some(Self::DeepInLayer { part })
    }

    /// What is to be said of Tabor's parameter.
    pub(crate) fn of_tabor_parameter(model: AdhesionModel, parameter: f64) -> Option<Self> {
        let is_outside = match model {
            AdhesionModel::Maugis => false,
            AdhesionModel::Dmt => parameter > LARGEST_TABOR_PARAMETER,
            AdhesionModel::Jkr => parameter < JKR_TABOR_PARAMETER,
        };
        is_outside.then_some(Self::TaborParameter { parameter })
    }

    /// What is to be said of the largest contact (m, its radius) under a map.
    pub(crate) fn of_cells(indenter: &dyn Indenter, radius_m: f64) -> Option<Self> {
        indenter.own_cells()?;
        // Where a map has its cells does not depend on the load.
        let Domain::Cells { spacing_m, .. } = indenter.domain(1.0, 1.0) else {
            return None;
        };
        let cells = PI * radius_m * radius_m / (spacing_m.0 * spacing_m.1);
        (cells > 0.0 && cells < FEWEST_CELLS_IN_CONTACT).then_some(Self::FewCells { cells })
    }

    /// What is to be said of the loss of a body that dissipates.
    pub(crate) fn of_loss(result: &CaseResult) -> Option<Self> {
        let energy_loss_j = result.analysis.energy_loss_j;
        let bar_j = (result.errors.as_ref()).and_then(|errors| errors.of(Quantity::EnergyLoss));
        let approach_m = result.approach_m.maximum - result.approach_m.minimum;
        let rounding_j = NO_LOSS * result.analysis.load_mean_n.abs() * approach_m;
        let is_negative = -energy_loss_j > bar_j.unwrap_or(0.0).max(rounding_j);
        (is_negative && !result.branches.is_empty()).then_some(Self::NegativeLoss { energy_loss_j })
    }

    /// What is to be said of a contact that lasts this many time steps.
    pub(crate) fn of_steps_in_contact(steps: f64) -> Option<Self> {
        (steps < FEWEST_STEPS_IN_CONTACT).then_some(Self::ShortContact { steps })
    }

    /// What is to be said of an energy imbalance, with the error bar of the loss relative to it, where there is one.
    pub(crate) fn of_energy_imbalance(part: f64, bar: Option<f64>) -> Option<Self> {
        let allowed = bar.map_or(LARGEST_IMBALANCE, |bar| {
            bar.clamp(LARGEST_IMBALANCE, LARGEST_IMBALANCE_IN_BAR)
        });
        (part.abs() > allowed).then_some(Self::EnergyImbalance { part })
    }

    /// A short name, for tables and programs.
    pub fn code(&self) -> &'static str {
        match self {
            Self::BelowMeasured { .. } => "below-measured",
            Self::AboveMeasured { .. } => "above-measured",
            Self::ShorterThanMeasured { .. } => "shorter-than-measured",
            Self::LongerThanMeasured { .. } => "longer-than-measured",
            Self::OutsideIsotherms { .. } => "outside-isotherms",
            Self::LargeStrain { .. } => "large-strain",
            Self::SteepSlope { .. } => "steep-slope",
            Self::DeepInLayer { .. } => "deep-in-layer",
            Self::TaborParameter { .. } => "tabor-parameter",
            Self::FewCells { .. } => "few-cells",
            Self::NegativeLoss { .. } => "negative-loss",
            Self::ShortContact { .. } => "short-contact",
            Self::EnergyImbalance { .. } => "energy-imbalance",
            Self::NoErrorBars { .. } => "no-error-bars",
            Self::NoMaterialError { .. } => "no-material-error",
        }
    }

    /// The end of the measured times (s) that it is of.
    pub fn measured_s(&self) -> Option<f64> {
        match *self {
            Self::BelowMeasured {
                last_measured_s: end_s,
                ..
            }
            | Self::AboveMeasured {
                first_measured_s: end_s,
                ..
            } => Some(end_s),
            _ => None,
        }
    }

    /// Among warnings of one kind, the one that says it for all of them has most of this.
    pub fn extent(&self) -> f64 {
        match *self {
            // How far outside, since each temperature has a window of its own.
            Self::BelowMeasured {
                angular_frequency_rad_per_s,
                last_measured_s,
            } => -angular_frequency_rad_per_s * last_measured_s,
            Self::AboveMeasured {
                angular_frequency_rad_per_s,
                first_measured_s,
            } => angular_frequency_rad_per_s * first_measured_s,
            Self::ShorterThanMeasured { time_s, .. } => -time_s,
            Self::LongerThanMeasured { time_s, .. } => time_s,
            Self::OutsideIsotherms {
                temperature_k,
                lowest_k,
                highest_k,
            } => (lowest_k - temperature_k).max(temperature_k - highest_k),
            Self::LargeStrain { strain } => strain,
            Self::SteepSlope { slope, .. } => slope,
            Self::DeepInLayer { part } => part,
            Self::TaborParameter { parameter } => parameter,
            Self::FewCells { cells } => -cells,
            Self::NegativeLoss { energy_loss_j } => -energy_loss_j,
            Self::ShortContact { steps } => -steps,
            Self::EnergyImbalance { part } => part.abs(),
            Self::NoErrorBars { .. } => 0.0,
            Self::NoMaterialError { others } => others as f64,
        }
    }
}

/// One line, with frequencies in rad/s.
impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message(FrequencyUnit::RadPerS))
    }
}

impl Warning {
    /// One line, with frequencies in a unit.
    pub fn message(&self, unit: FrequencyUnit) -> String {
        let time = |time_s| format_prose(time_s, Dimension::Time, 3);
        let frequency = |time_s: f64| format_prose(unit.of(time_s.recip()), unit.dimension(), 3);
        match *self {
            Self::BelowMeasured {
                last_measured_s: last_s,
                ..
            } => {
                let (last, limit) = (time(last_s), frequency(last_s));
                format!(
                    "the material was measured up to {last}: below {limit} it is an extrapolation"
                )
            }
            Self::AboveMeasured {
                first_measured_s: first_s,
                ..
            } => {
                let (first, limit) = (time(first_s), frequency(first_s));
                format!(
                    "the material was measured from {first} on: above {limit} it is an extrapolation"
                )
            }
            Self::ShorterThanMeasured {
                time_s,
                first_measured_s,
            } => {
                let when = match time_s {
                    0.0 => ": up to then after a jump of the drive".to_owned(),
                    _ => format!(", and the drive changes within {}: there", time(time_s)),
                };
                let first = time(first_measured_s);
                format!("the material was measured from {first} on{when} it is an extrapolation")
            }
            Self::LongerThanMeasured {
                time_s,
                last_measured_s,
            } => format!(
                "the material was measured up to {}, and the history lasts {}: beyond, it is an extrapolation",
                time(last_measured_s),
                time(time_s)
            ),
            Self::OutsideIsotherms {
                temperature_k,
                lowest_k,
                highest_k,
            } => format!(
                "the material was measured from {} to {}: at {} its shift is an extrapolation",
                celsius(lowest_k),
                celsius(highest_k),
                celsius(temperature_k)
            ),
            Self::LargeStrain { strain } => format!(
                "strains up to {} %: a glassy material is linear up to about {} %",
                two_digits(100.0 * strain),
                100.0 * LARGEST_GLASSY_STRAIN
            ),
            Self::SteepSlope {
                slope,
                contact_radius_m,
            } => format!(
                "slopes of the indenter in the contact (a/R of a sphere) up to {} at a contact radius of {}: the model takes them \
                 as small, up to about {LARGEST_SLOPE}",
                two_digits(slope),
                format_prose(contact_radius_m, Dimension::Length, 3)
            ),
            Self::DeepInLayer { part } => format!(
                "the approach is up to {} of the layer's thickness: the model takes strains as small, up to about {LARGEST_DEPTH} of it",
                two_digits(part)
            ),
            Self::TaborParameter { parameter } => format!(
                "Tabor's parameter is up to {}: model = \"dmt\" holds up to about {LARGEST_TABOR_PARAMETER}, \"jkr\" from about \
                 {JKR_TABOR_PARAMETER} on, and \"maugis\", the default, throughout",
                two_digits(parameter)
            ),
            Self::FewCells { cells } => format!(
                "the largest contact has {cells:.0} of the map's cells, too few for a shape (at least {FEWEST_CELLS_IN_CONTACT}): the map \
                 needs more points there, or has a spike"
            ),
            Self::NegativeLoss { energy_loss_j } => format!(
                "the energy loss, {}, is below zero, which it cannot be: more time steps, springs or cells are needed",
                format_prose(energy_loss_j, Dimension::Energy, 3)
            ),
            Self::ShortContact { steps } => format!(
                "the indenter touches for only {} of the time steps of a cycle: at least {FEWEST_STEPS_IN_CONTACT} are needed, so cycle.steps \
                 must be {} times as many",
                two_digits(steps),
                two_digits(FEWEST_STEPS_IN_CONTACT / steps)
            ),
            Self::EnergyImbalance { part } => format!(
                "the branches dissipate {} % {} than the area of the loop: more time steps or nodes are needed",
                two_digits(100.0 * part.abs()),
                if part > 0.0 { "more" } else { "less" }
            ),
            Self::NoErrorBars { because } => format!("no error bars: {}", because.words()),
            Self::NoMaterialError { others } => {
                let why = match others {
                    0 => "comes from noisy samples".to_owned(),
                    1 => "may as well be another".to_owned(),
                    _ => format!("may as well be any of {others} others"),
                };
                format!(
                    "the error bars of a history are of steps, springs or cells alone: they leave out the error of the material, which \
                     {why}; those of a sweep hold it"
                )
            }
        }
    }
}

/// Two significant digits of a positive number, all of a large one before its point.
fn two_digits(value: f64) -> String {
    let decimals = (1.0 - value.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVERY: [Warning; 13] = [
        Warning::BelowMeasured {
            angular_frequency_rad_per_s: 1e-4,
            last_measured_s: 1000.0,
        },
        Warning::AboveMeasured {
            angular_frequency_rad_per_s: 628.3,
            first_measured_s: 0.1,
        },
        Warning::ShorterThanMeasured {
            time_s: 0.0,
            first_measured_s: 0.1,
        },
        Warning::LongerThanMeasured {
            time_s: 2e3,
            last_measured_s: 1e3,
        },
        Warning::LargeStrain { strain: 0.0728 },
        Warning::SteepSlope {
            slope: 361.3,
            contact_radius_m: 3.613e-6,
        },
        Warning::TaborParameter { parameter: 12.3 },
        Warning::FewCells { cells: 1.0 },
        Warning::NegativeLoss {
            energy_loss_j: -4.9e-12,
        },
        Warning::ShortContact { steps: 2.85 },
        Warning::EnergyImbalance { part: -0.47 },
        Warning::NoErrorBars {
            because: NoErrorBars::OwnCells,
        },
        Warning::NoErrorBars {
            because: NoErrorBars::NoCoarserResult,
        },
    ];

    #[test]
    fn a_warning_comes_back_from_a_record_and_has_a_code_of_its_own() {
        for warning in EVERY {
            let bytes = postcard::to_stdvec(&warning).unwrap();
            assert_eq!(postcard::from_bytes::<Warning>(&bytes).unwrap(), warning);
        }
        let codes: std::collections::BTreeSet<_> = EVERY.iter().map(Warning::code).collect();
        let kinds: std::collections::HashSet<_> =
            EVERY.iter().map(std::mem::discriminant).collect();
        assert_eq!(codes.len(), kinds.len());
    }

    #[test]
    fn a_warning_is_one_line_with_its_numbers() {
        let lines = EVERY.map(|warning| warning.to_string());
        assert!(
            lines
                .iter()
                .all(|line| !line.contains('\n') && line.len() < 200)
        );
        for (line, part) in lines.iter().zip([
            "measured up to 1000 s: below 1.00 × 10⁻³ rad/s",
            "measured from 100 ms on: above 10.0 rad/s",
            "up to then after a jump",
            "lasts 2000 s",
            "strains up to 7.3 %: a glassy material is linear up to about 1 %",
            "up to 361 at a contact radius of 3.61 µm: the model takes them as small, up to about 0.2",
            "is up to 12: model = \"dmt\" holds up to about 0.1, \"jkr\" from about 5 on",
            "has 1 of the map's cells, too few for a shape (at least 20)",
            "the energy loss, -4.90 pJ, is below zero",
            "only 2.9 of the time steps of a cycle: at least 10 are needed, so cycle.steps must be 3.5 times as many",
            "dissipate 47 % less than the area",
            "own cells",
            "no coarser result",
        ]) {
            assert!(line.contains(part), "{part:?} is missing in {line}");
        }
    }

    #[test]
    fn an_energy_imbalance_is_told_above_the_error_bar_and_never_where_it_is_small() {
        for (part, bar, told) in [
            (0.009, None, false),
            (-0.47, None, true),
            (0.009, Some(1e-4), false),
            (0.02, Some(1e-4), true),
            (0.02, Some(0.03), false),
            (-0.47, Some(0.5), true),
        ] {
            let warning = Warning::of_energy_imbalance(part, bar);
            assert_eq!(warning.is_some(), told, "{part} {bar:?}");
        }
    }

    #[test]
    fn the_limits_are_those_of_the_guide() {
        let guide = include_str!("../../../guide/validity.md");
        for limit in [
            format!("≲ {} %", 100.0 * LARGEST_GLASSY_STRAIN),
            format!("≲ {LARGEST_SLOPE}"),
            format!("≥ {} GPa", GLASSY_MODULUS_PA / 1e9),
            format!("ε ≈ {STRAIN_PER_SLOPE} a/R"),
        ] {
            assert!(guide.contains(&limit), "{limit}");
        }
        for warning in EVERY {
            assert!(
                guide.contains(&format!("`{}`", warning.code())),
                "{warning}"
            );
        }
    }
}
