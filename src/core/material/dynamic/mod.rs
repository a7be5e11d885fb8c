//! Dynamic data: storage and loss modulus over frequency at one or several temperatures, and what is made of them.
//!
//! [`DynamicData`] is what an instrument measured, checked; [`characterise`] makes a [`Characterisation`] of it: shift factors and
//! master curve ([`master_curve`], [`shift_law`]), a Prony series with its residuals ([`prony`]), and replicas of that series which
//! carry the noise of the measurement on ([`replicas`]).
//!
//! Temperatures are in K, frequencies in rad/s, moduli in Pa; `E* = E' + i E''`.

mod interpolation;
pub mod master_curve;
mod neighbours;
pub mod noise;
mod one_curve;
pub mod prony;
pub mod replicas;
pub mod shift_law;
#[cfg(test)]
mod synthetic;

use super::{Material, MaterialError, ModulusKind, Relaxation, RelaxationBranch};
use crate::block_with_defaults;
use crate::numerics::order::bracket;
use crate::quantity::Dimension::Temperature;
use crate::quantity::key::{Kind, quantity};
use master_curve::{MasterCurve, MasterCurveError, ShiftChoice, ShiftFactor};
use prony::{PronyError, PronyFit};
use replicas::Replica;
use shift_law::Wlf;

/// More branches than any fit resolves are a mistake in the file.
pub const MOST_BRANCHES: usize = 1000;
/// More tell no more of a spread.
pub const MOST_REPLICAS: usize = 1000;
const BRANCHES: Kind = Kind::Either(&Kind::AUTO, &Kind::Integer(1..=MOST_BRANCHES), "");

/// Storage and loss modulus at one frequency and temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DynamicPoint {
    /// `None` where the file names no temperature.
    pub temperature_k: Option<f64>,
    pub angular_frequency_rad_per_s: f64,
    pub storage_modulus_pa: f64,
    pub loss_modulus_pa: f64,
    /// Standard errors (Pa) of both, where the file gives them.
    pub errors_pa: Option<(f64, f64)>,
}

/// Points at one temperature, ascending in frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Isotherm {
    /// Mean of the temperatures of the points.
    pub temperature_k: Option<f64>,
    pub points: Vec<DynamicPoint>,
}

/// Isotherms of one specimen, ascending in temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct DynamicData {
    kind: ModulusKind,
    isotherms: Vec<Isotherm>,
}

/// Why points are no dynamic data. Points count from 0, in the order given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DynamicDataError {
    #[error("a series needs at least {needed} points, and there are {found}")]
    TooFew { needed: usize, found: usize },
    #[error("{what} must be a positive number, and is {value}")]
    NotPositive {
        point: usize,
        what: &'static str,
        value: f64,
    },
    #[error("some points have a temperature and others have none")]
    SomeTemperatures { point: usize },
    #[error(
        "the frequencies span {decades:.0} decades, from {lowest:e} to {highest:e} rad/s: more than {MOST_DECADES} are no measurement"
    )]
    Span {
        point: usize,
        decades: f64,
        lowest: f64,
        highest: f64,
    },
}

/// Fewest points that a series can be fitted to.
pub const FEWEST_POINTS: usize = 3;

impl DynamicData {
    /// Data from isotherms as the file holds them, in any order. Isotherms whose mean temperatures are the same to a hundredth of a
    /// kelvin are one.
    ///
    /// # Errors
    /// [`DynamicDataError`].
    pub fn new(kind: ModulusKind, sets: Vec<Vec<DynamicPoint>>) -> Result<Self, DynamicDataError> {
        let all: Vec<&DynamicPoint> = sets.iter().flatten().collect();
        if all.len() < FEWEST_POINTS {
            let (needed, found) = (FEWEST_POINTS, all.len());
            return Err(DynamicDataError::TooFew { needed, found });
        }
        let has_temperature = all.iter().any(|point| point.temperature_k.is_some());
        for (index, point) in all.iter().enumerate() {
            if let Some((what, value)) = point.not_positive() {
                let point = index;
                return Err(DynamicDataError::NotPositive { point, what, value });
            }
            if has_temperature && point.temperature_k.is_none() {
                return Err(DynamicDataError::SomeTemperatures { point: index });
            }
        }
        span(&all)?;
        let mut isotherms: Vec<Isotherm> = Vec::new();
        for points in sets.into_iter().filter(|points| !points.is_empty()) {
            let isotherm = Isotherm::new(points);
            let same = isotherms.iter_mut().find(|other| {
                match (other.temperature_k, isotherm.temperature_k) {
                    (Some(a), Some(b)) => (a - b).abs() < 0.01,
                    (a, b) => a == b,
                }
            });
            match same {
                Some(other) => {
                    let points = [other.points.clone(), isotherm.points].concat();
                    *other = Isotherm::new(points);
                }
                None => isotherms.push(isotherm),
            }
        }
        let key = |isotherm: &Isotherm| isotherm.temperature_k.unwrap_or_default();
        isotherms.sort_by(|a, b| key(a).total_cmp(&key(b)));
        Ok(Self { kind, isotherms })
    }

    /// Which modulus was measured.
    pub fn kind(&self) -> ModulusKind {
        self.kind
    }

    /// At least one, ascending in temperature.
    pub fn isotherms(&self) -> &[Isotherm] {
        &self.isotherms
    }

    /// Every point, isotherm after isotherm.
    pub fn points(&self) -> impl Iterator<Item = &DynamicPoint> {
        self.isotherms.iter().flat_map(|isotherm| &isotherm.points)
    }
}

/// Refuses frequencies that are too far apart for a grid of times over them.
fn span(points: &[&DynamicPoint]) -> Result<(), DynamicDataError> {
    let omega = |point: usize| points[point].angular_frequency_rad_per_s;
    let by_frequency = |a: &usize, b: &usize| omega(*a).total_cmp(&omega(*b));
    let ends = (0..points.len())
        .min_by(by_frequency)
        .zip((0..points.len()).max_by(by_frequency));
    let Some((point, last)) = ends else {
        return Ok(());
    };
    let (lowest, highest) = (omega(point), omega(last));
    let decades = highest.log10() - lowest.log10();
    match decades <= MOST_DECADES {
        true => Ok(()),
        false => Err(DynamicDataError::Span {
            point,
            decades,
            lowest,
            highest,
        }),
    }
}

impl DynamicPoint {
    /// What of it is no positive number, and its value.
    pub fn not_positive(&self) -> Option<(&'static str, f64)> {
        let values = [
            ("the frequency", self.angular_frequency_rad_per_s),
            ("the storage modulus", self.storage_modulus_pa),
            ("the loss modulus", self.loss_modulus_pa),
            (
                "the absolute temperature",
                self.temperature_k.unwrap_or(1.0),
            ),
        ];
        let is_positive = |value: f64| value.is_finite() && value > 0.0;
        values.into_iter().find(|(_, value)| !is_positive(*value))
    }
}

impl Isotherm {
    fn new(mut points: Vec<DynamicPoint>) -> Self {
        points.sort_by(|a, b| {
            a.angular_frequency_rad_per_s
                .total_cmp(&b.angular_frequency_rad_per_s)
        });
        let temperatures: Option<Vec<f64>> = points.iter().map(|p| p.temperature_k).collect();
        let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
        Self {
            temperature_k: temperatures.map(mean),
            points,
        }
    }

    /// Lowest and highest angular frequency.
    fn window_rad_per_s(&self) -> (f64, f64) {
        let ends = self.points.first().zip(self.points.last());
        let omega = |point: &DynamicPoint| point.angular_frequency_rad_per_s;
        ends.map_or_else(Default::default, |(a, b)| (omega(a), omega(b)))
    }
}

block_with_defaults! {
    /// What is made of dynamic data, and how.
    pub struct Choices in "dynamic" {
        /// Temperature of the master curve; left out: that of the middle isotherm.
        reference_temperature_k: Option<f64> = None => "reference_temperature", Kind::Number(quantity(Temperature).above_zero());
        /// How isotherms are shifted onto one curve: each individually (`free`, the default), by a law fitted to the data, not at all, or by
        /// factors from a file.
        shift: ShiftChoice = ShiftChoice::Free => "shift", ShiftChoice::KIND, chosen;
        /// Whether they are also shifted vertically, along the moduli.
        vertical_shift: bool = false => "vertical_shift", Kind::Flag;
        /// Branches of the series: a number, or `auto` (the default): as many as the data resolve.
        branches: Option<usize> = None => "branches", BRANCHES;
        /// Number of replicas of the material for the uncertainty of the results due to the noise of the data; 50 determine it to about
        /// 10 %.
        replicas: usize = 0 => "replicas", Kind::Integer(0..=MOST_REPLICAS);
        /// Seed of the random numbers for the replicas.
        seed: u64 = 1 => "seed", Kind::Integer(0..=i64::MAX as usize);
    }
}

/// Why nothing was made of dynamic data.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DynamicError {
    #[error("no master curve: {0}")]
    MasterCurve(#[from] MasterCurveError),
    #[error("no series: {0}")]
    Prony(#[from] PronyError),
    #[error(transparent)]
    Material(#[from] MaterialError),
    #[error("no replicas: {0}")]
    Replica(#[from] DynamicDataError),
    /// The series is none of the data.
    #[error(
        "the best series misses the data by {:.0} % of the storage modulus and {:.0} % of the loss modulus (root mean square): there is no \
         series of these data{}",
        100.0 * storage_rms, 100.0 * loss_rms, advice(apart)
    )]
    Misfit {
        storage_rms: f64,
        loss_rms: f64,
        /// Neighbouring isotherms (K) that share no moduli, or no reduced frequencies.
        apart: Vec<(f64, f64)>,
    },
    /// The data say nothing about this temperature.
    #[error("the data do not reach to {}{}", crate::quantity::celsius(*temperature_k), range(*range_k))]
    Temperature {
        temperature_k: f64,
        /// Of the isotherms, where they have temperatures.
        range_k: Option<(f64, f64)>,
    },
}

fn advice(apart: &[(f64, f64)]) -> String {
    let between = |(lower_k, upper_k): &(f64, f64)| {
        let [lower, upper] = [lower_k, upper_k].map(|k| crate::quantity::celsius(*k));
        format!("{lower} and {upper}")
    };
    let all: Vec<String> = apart.iter().map(between).collect();
    match all.as_slice() {
        [] => "; look for a wrong unit or column, or for points that do not belong to the others"
            .to_owned(),
        all => format!(
            ". The isotherms at {} have no moduli in common, so that nothing tells the shift between them: leave out those on the one \
             side of the gap, measure another between them, or give the shift factors in a file",
            all.join(", at ")
        ),
    }
}

fn range(range_k: Option<(f64, f64)>) -> String {
    match range_k {
        None => ": they name no temperature, so leave the temperature out".to_owned(),
        Some((lowest, highest)) if lowest == highest => format!(
            ": they were measured at {} alone",
            crate::quantity::celsius(lowest)
        ),
        Some((lowest, highest)) => format!(
            ": they were measured from {} to {}",
            crate::quantity::celsius(lowest),
            crate::quantity::celsius(highest)
        ),
    }
}

/// What the data say about the material.
#[derive(Debug, Clone, PartialEq)]
pub struct Characterisation {
    pub kind: ModulusKind,
    /// `None` where the data know no temperature or one alone.
    pub master: Option<MasterCurve>,
    /// Of the series: that of the master curve, or of the only isotherm; `None` where the data name none.
    pub temperature_k: Option<f64>,
    /// The series at this temperature.
    pub fit: PronyFit,
    /// Materials that the data allow as well, alike in probability.
    pub replicas: Vec<Replica>,
}

/// Difference of temperatures (K) that counts as none where the data have one temperature alone.
pub const SAME_TEMPERATURE_K: f64 = 0.5;

/// Misfit (root mean square, relative to the data) from which a series is none of the data.
pub const LARGEST_MISFIT: f64 = 0.5;

/// Most decades of frequency that data span: three times as many as the widest master curves have.
const MOST_DECADES: f64 = 60.0;

/// Makes master curve, series and replicas of the data.
///
/// # Errors
/// [`DynamicError`].
pub fn characterise(
    data: &DynamicData,
    choices: &Choices,
) -> Result<Characterisation, DynamicError> {
    let (master, temperature_k) = match data.isotherms() {
        [only] => (None, only.temperature_k),
        _ => {
            let master = master_curve::shift(data, choices)?;
            let temperature_k = master.reference_temperature_k;
            (Some(master), Some(temperature_k))
        }
    };
    let points = master_points(data, master.as_ref());
    let fit = prony::fit(&points, choices.branches)?;
    // A number of branches that is asked for may be too small on purpose.
    let is_free = choices.branches.is_none() || fit.relaxation.branches().is_empty();
    if is_free && fit.storage_rms.max(fit.loss_rms) >= LARGEST_MISFIT {
        return Err(DynamicError::Misfit {
            storage_rms: fit.storage_rms,
            loss_rms: fit.loss_rms,
            apart: master.as_ref().map(MasterCurve::apart).unwrap_or_default(),
        });
    }
    let replicas = replicas::draw(data, master.as_ref(), &fit, choices)?;
    let kind = data.kind();
    Ok(Characterisation {
        kind,
        master,
        temperature_k,
        fit,
        replicas,
    })
}

/// The points of a master curve, or of the data where there is none.
fn master_points(data: &DynamicData, master: Option<&MasterCurve>) -> Vec<DynamicPoint> {
    match master {
        Some(master) => master.points.clone(),
        None => data.points().copied().collect(),
    }
}

impl Characterisation {
    /// The material at a temperature (K), or at that of the series.
    ///
    /// Its [measured times](super::Origin::measured_window_s) are one over the angular frequencies of the data, shifted to this
    /// temperature: a frequency outside is an extrapolation.
    ///
    /// # Errors
    /// [`DynamicError::Temperature`]: there is no shift factor for the temperature; a Poisson ratio outside -1 < nu <= 1/2.
    pub fn material(
        &self,
        temperature_k: Option<f64>,
        poisson_ratio: f64,
    ) -> Result<Material, DynamicError> {
        let master = self.master.as_ref();
        self.at(temperature_k, &self.fit.relaxation, master, poisson_ratio)
    }

    /// The same with its replicas, its temperature where that is known, and the law by which it shifts to others, where the data prefer
    /// one.
    ///
    /// # Errors
    /// As [`material`](Self::material).
    pub fn whole_material(
        &self,
        temperature_k: Option<f64>,
        poisson_ratio: f64,
    ) -> Result<Material, DynamicError> {
        let mut material = self.material(temperature_k, poisson_ratio)?;
        let origin = &mut material.origin;
        origin.replicas = self.replica_materials(temperature_k, poisson_ratio)?;
        origin.temperature_k = temperature_k.or(self.temperature_k);
        if let (Some(master), Some(own_k)) = (&self.master, origin.temperature_k) {
            if let [first, .., last] = master.shifts.as_slice() {
                origin.isotherms_k = Some((first.temperature_k, last.temperature_k));
            }
            let law = master.preferred.map(Wlf::from);
            origin.shift = law.and_then(|law| law.referred_to(own_k));
        }
        Ok(material)
    }

    /// The replicas at a temperature, each by its own shift factors, as [`material`](Self::material).
    ///
    /// # Errors
    /// As there.
    pub fn replica_materials(
        &self,
        temperature_k: Option<f64>,
        poisson_ratio: f64,
    ) -> Result<Vec<Material>, DynamicError> {
        let material = |replica: &replicas::Replica| {
            let (series, master) = (&replica.relaxation, replica.master.as_ref());
            let mut material = self.at(temperature_k, series, master, poisson_ratio)?;
            material.origin.measured_window_s = None;
            Ok(material)
        };
        self.replicas.iter().map(material).collect()
    }

    fn at(
        &self,
        temperature_k: Option<f64>,
        relaxation: &Relaxation,
        master: Option<&MasterCurve>,
        poisson_ratio: f64,
    ) -> Result<Material, DynamicError> {
        let (a_t, b_t) = match temperature_k {
            None => (1.0, 1.0),
            Some(temperature_k) => self.shift_to(temperature_k, master)?,
        };
        let branches = relaxation.branches().iter().map(|branch| RelaxationBranch {
            modulus_pa: branch.modulus_pa / b_t,
            time_s: branch.time_s * a_t,
        });
        let shifted = Relaxation::new(relaxation.equilibrium_modulus() / b_t, branches.collect())?;
        let (lowest, highest) = self.fit.window_rad_per_s;
        let mut material = Material::from_relaxation(shifted, self.kind, poisson_ratio)?;
        material.origin.measured_window_s = Some((a_t / highest, a_t / lowest));
        Ok(material)
    }

    /// Shift factors, horizontal and vertical, to a temperature.
    fn shift_to(
        &self,
        temperature_k: f64,
        master: Option<&MasterCurve>,
    ) -> Result<(f64, f64), DynamicError> {
        let own = |own: f64| (own - temperature_k).abs() < SAME_TEMPERATURE_K;
        let range_k = match master.map(|master| master.shifts.as_slice()) {
            Some([first, .., last]) => Some((first.temperature_k, last.temperature_k)),
            _ => self.temperature_k.map(|own| (own, own)),
        };
        match master {
            None if self.temperature_k.is_some_and(own) => Some((1.0, 1.0)),
            None => None,
            Some(master) => master
                .log10_a_t(temperature_k)
                .map(|log10_a_t| (10_f64.powf(log10_a_t), b_t(&master.shifts, temperature_k))),
        }
        .ok_or(DynamicError::Temperature {
            temperature_k,
            range_k,
        })
    }
}

/// Vertical shift at a temperature: between isotherms its logarithm is interpolated, outside it stays what it was at the last.
fn b_t(shifts: &[ShiftFactor], temperature_k: f64) -> f64 {
    let temperatures_k: Vec<f64> = shifts.iter().map(|shift| shift.temperature_k).collect();
    let (below, above, share) = bracket(&temperatures_k, temperature_k);
    let b_t = |place: usize| shifts.get(place).map_or(1.0, |shift| shift.b_t);
    b_t(below) * (b_t(above) / b_t(below)).powf(share)
}
