//! Master curves: isotherms shifted along the frequencies until they lie on one another.
//!
//! Neighbours are shifted onto one another in closed form (`neighbours`), then all factors together are refined against
//! one non-negative series through storage and loss modulus (`one_curve`), each value weighted by its noise
//! ([`super::noise`]). The standard errors are those of the joint problem, scaled by its misfit. Where moduli may be shifted too,
//! the tangent of the phase angle gives the first horizontal shifts, and the vertical ones come with the series.

mod work;

use super::interpolation::{self, monotone};
use super::neighbours;
use super::shift_law::{Arrhenius, ShiftLaw, Wlf};
use super::{Choices, DynamicData, DynamicPoint};
use crate::quantity::block::Field;
use crate::quantity::celsius;
use crate::quantity::key::{Key, Kind, Presence, words_of};
use crate::quantity::rows::{Rows, table};
use crate::quantity::setting::Value;
use work::Work;

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
    /// Temperatures (K) and log10 a_T, as a file gives them, in any order. An isotherm between two of them is interpolated; one
    /// outside takes the last, if that is no more than [`GIVEN_TOLERANCE_K`] away.
    Given(Vec<(f64, f64)>),
}

impl ShiftChoice {
    /// What a word chooses, as files and flags write it.
    pub const WORDS: &[(&str, Self)] = &[
        ("free", Self::Free),
        (Wlf::NAME, Self::Wlf),
        (Arrhenius::NAME, Self::Arrhenius),
        ("none", Self::None),
    ];

    /// One of the words, or a table that names a file.
    pub const KIND: Kind = Kind::Either(
        &Kind::Word(&words_of::<Self, 4>(Self::WORDS)),
        &Kind::Table(&FILE_OF_FACTORS),
        " with a file",
    );
}

impl Field for ShiftChoice {
    fn written(&self, _: &Kind) -> Option<Value> {
        let mut words = Self::WORDS.iter();
        let (word, _) = words.find(|(_, choice)| choice == self)?;
        Some((*word).into())
    }

    fn of(value: Value) -> Option<Self> {
        let word = String::of(value)?;
        let found = Self::WORDS.iter().find(|(known, _)| *known == word);
        found.map(|(_, choice)| choice.clone())
    }
}

/// CSV file with the columns `temperature_c` and `log10_a_t`.
pub const FACTORS: Key = Key {
    name: "file",
    means: " CSV file with the columns `temperature_c` and `log10_a_t`.",
    kind: Kind::Text,
    presence: Presence::Required,
};

static FILE_OF_FACTORS: Rows = table(" Shift factors of a file.", &[&[FACTORS]]);

/// How far outside of the given factors a temperature may be (K).
pub const GIVEN_TOLERANCE_K: f64 = 0.5;

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
    /// Laws through the factors, where there are enough of them (three for WLF, two for Arrhenius), and they bend as WLF does.
    pub wlf: Option<Wlf>,
    pub arrhenius: Option<Arrhenius>,
    /// The law that was chosen, or that the data prefer (criterion of Schwarz: Arrhenius is a WLF law with `c2 = Tr`).
    pub preferred: Option<ShiftLaw>,
    /// Points at their reduced frequencies (and moduli), with the temperature at which they were measured, ascending in frequency.
    pub points: Vec<DynamicPoint>,
    /// Root mean square of the distance of the isotherms, each shifted freely, from one series through all of them, in units of
    /// the noise of the data, which is the scatter of each isotherm about a smooth curve of its own (or what the file says). About
    /// one where the data are thermorheologically simple. With free shifts this is what the plane of van Gurp and Palmen shows,
    /// said with both moduli, so that it holds on plateaus, where the phase angle over the magnitude is all but vertical.
    pub simplicity: Option<f64>,
    pub warnings: Vec<MasterCurveWarning>,
}

/// Something to know about a master curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MasterCurveWarning {
    /// The isotherms lie on no single curve, by this many times the noise; relative root mean square misfits of one curve.
    #[error(
        "the isotherms are not thermorheologically simple: one curve misses the storage modulus by {:.2} % and the loss modulus by \
         {:.2} % (root mean square), {simplicity:.1} times the noise",
        100.0 * storage_rms, 100.0 * loss_rms
    )]
    NotSimple {
        simplicity: f64,
        storage_rms: f64,
        loss_rms: f64,
    },
    /// Two neighbouring isotherms share no range of moduli; the shift between them is an extrapolation.
    #[error(
        "the isotherms at {} and {} share no range of moduli: the shift between them is an extrapolation",
        celsius(*lower_k), celsius(*upper_k)
    )]
    NoOverlap { lower_k: f64, upper_k: f64 },
    /// The data do not determine the shift factor of an isotherm: its standard error (decades) is larger than a useful factor allows, or
    /// there is none.
    #[error(
        "the shift factor at {} is not determined: {}",
        celsius(*temperature_k),
        match error {
            Some(error) => format!("its standard error is {error:.1} decades"),
            None => "the least squares problem has no single solution".to_owned(),
        }
    )]
    Undetermined {
        temperature_k: f64,
        error: Option<f64>,
    },
    /// Neither law describes the factors: the preferred one leaves this many times their errors (root mean square).
    #[error(
        "neither WLF nor Arrhenius describes the shift factors: the better one leaves {deviation:.1} times their errors"
    )]
    NoLaw { deviation: f64 },
}

/// Above this [`MasterCurve::simplicity`] the data are not simple.
pub const SIMPLE: f64 = 1.5;

/// Standard error (decades) from which a shift factor counts as not determined: a factor of three in time or frequency.
pub const UNDETERMINED: f64 = 0.5;

/// Why there is no master curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MasterCurveError {
    #[error("the isotherms have no temperatures")]
    NoTemperatures,
    #[error("the file of shift factors has none for {}", celsius(*temperature_k))]
    NoFactor { temperature_k: f64 },
    #[error("the shift factors of these isotherms follow no {law} law; choose free shift factors")]
    NoLaw { law: &'static str },
    #[error(
        "no law goes on from the isotherms to a reference temperature of {}; choose one between {} and {}",
        celsius(*temperature_k), celsius(*lowest_k), celsius(*highest_k)
    )]
    NoReference {
        temperature_k: f64,
        lowest_k: f64,
        highest_k: f64,
    },
}

/// Shifts the isotherms.
///
/// # Errors
/// [`MasterCurveError`].
pub fn shift(data: &DynamicData, choices: &Choices) -> Result<MasterCurve, MasterCurveError> {
    let work = Work::new(data, choices)?;
    match &choices.shift {
        ShiftChoice::None => work.given(vec![0.0; work.temperatures_k.len()], false),
        ShiftChoice::Given(given) => work.given(given_factors(given, &work.temperatures_k)?, true),
        ShiftChoice::Free | ShiftChoice::Wlf | ShiftChoice::Arrhenius => {
            let chain = |vertical| neighbours::chain(data.isotherms(), &work.noise, vertical);
            work.found(&chain(false), choices.vertical_shift.then(|| chain(true)))
        }
    }
}

/// Shifts isotherms that differ from those of `start` by noise alone, as replicas of a measurement do: refined from its factors
/// on, without a search, at its reference temperature; some ten milliseconds for 200 points. `choices` as those of `start`.
///
/// # Errors
/// [`MasterCurveError`].
pub fn refined_from(
    data: &DynamicData,
    start: &MasterCurve,
    choices: &Choices,
) -> Result<MasterCurve, MasterCurveError> {
    let choices = Choices {
        reference_temperature_k: Some(start.reference_temperature_k),
        ..choices.clone()
    };
    let searched = !matches!(choices.shift, ShiftChoice::None | ShiftChoice::Given(_));
    if searched && start.shifts.len() == data.isotherms().len() {
        let factors: Vec<f64> = start.shifts.iter().map(|s| s.log10_a_t).collect();
        return Work::new(data, &choices)?.found(&factors, None);
    }
    shift(data, &choices)
}

impl MasterCurve {
    /// Neighbouring isotherms (K) that share no range of moduli, or of reduced frequencies.
    pub(super) fn apart(&self) -> Vec<(f64, f64)> {
        let pairs = self.warnings.iter().filter_map(|warning| match *warning {
            MasterCurveWarning::NoOverlap { lower_k, upper_k } => Some((lower_k, upper_k)),
            _ => None,
        });
        pairs.collect()
    }

    /// Shift factor at any temperature (log10 a_T): between isotherms by interpolation, outside the preferred law goes on from the
    /// last of them. `None` where neither says anything.
    pub fn log10_a_t(&self, temperature_k: f64) -> Option<f64> {
        let factors = self.shifts.iter().map(|s| (s.temperature_k, s.log10_a_t));
        let factors: Vec<(f64, f64)> = factors.collect();
        let law = |t: f64| self.preferred?.log10_a_t(t);
        interpolation::log10_a_t(&factors, &law, temperature_k)
    }
}

fn ascending(given: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let finite = given
        .iter()
        .filter(|pair| pair.0.is_finite() && pair.1.is_finite());
    let mut pairs: Vec<(f64, f64)> = finite.copied().collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    pairs.dedup_by(|a, b| a.0 == b.0);
    pairs
}

/// The temperature at which given factors are zero.
fn zero_of(given: &[(f64, f64)]) -> Option<f64> {
    let pairs = ascending(given);
    let exact = pairs.iter().find(|pair| pair.1 == 0.0).map(|pair| pair.0);
    let crossing = || {
        let pair = pairs.windows(2).find(|pair| pair[0].1 * pair[1].1 < 0.0)?;
        let (left, right) = (pair[0], pair[1]);
        Some(left.0 + (right.0 - left.0) * left.1 / (left.1 - right.1))
    };
    exact.or_else(crossing)
}

fn given_factors(
    given: &[(f64, f64)],
    temperatures_k: &[f64],
) -> Result<Vec<f64>, MasterCurveError> {
    let pairs = ascending(given);
    let ends = pairs.first().zip(pairs.last()).map(|(a, b)| (a.0, b.0));
    let factor = |&temperature_k: &f64| {
        let within = ends.and_then(|(first, last)| {
            let within = temperature_k.clamp(first, last);
            let near = (within - temperature_k).abs() <= GIVEN_TOLERANCE_K;
            near.then(|| monotone(&pairs, within)).flatten()
        });
        within.ok_or(MasterCurveError::NoFactor { temperature_k })
    };
    temperatures_k.iter().map(factor).collect()
}

#[cfg(test)]
mod tests;
