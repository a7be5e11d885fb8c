//! Master curves: isotherms shifted along the frequencies until they lie on one another.
//!
//! Neighbours are shifted onto one another in closed form ([`super::neighbours`]), then all factors together are refined against
//! one non-negative series through storage and loss modulus ([`super::one_curve`]), each value weighted by its noise
//! ([`super::noise`]). The standard errors are those of the joint problem, scaled by its misfit. Where moduli may be shifted too,
//! the tangent of the phase angle gives the first horizontal shifts, and the vertical ones come with the series.

use std::fmt;

use nalgebra::{DMatrix, DVector};

use super::interpolation::{Interpolation, monotone};
use super::neighbours;
use super::noise::Noise;
use super::one_curve::{OneCurve, State};
use super::shift_law::{Arrhenius, Factors, Form, LawFit, ShiftLaw, Wlf, prefers_wlf};
use super::{Choices, DynamicData, DynamicPoint};
use crate::quantity::celsius;

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
}

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
#[derive(Debug, Clone, PartialEq)]
pub enum MasterCurveWarning {
    /// The isotherms lie on no single curve, by this many times the noise; relative root mean square misfits of one curve.
    NotSimple {
        simplicity: f64,
        storage_rms: f64,
        loss_rms: f64,
    },
    /// Two neighbouring isotherms share no range of moduli; the shift between them is an extrapolation.
    NoOverlap { lower_k: f64, upper_k: f64 },
    /// Neither law describes the factors: the preferred one leaves so many times their errors (root mean square).
    NoLaw { deviation: f64 },
}

/// Above this [`MasterCurve::simplicity`] the data are not simple.
pub const SIMPLE: f64 = 1.5;

impl fmt::Display for MasterCurveWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotSimple {
                simplicity,
                storage_rms,
                loss_rms,
            } => write!(
                f,
                "the isotherms are not thermorheologically simple: one curve misses the storage modulus by {:.2} % and the loss \
                 modulus by {:.2} % (root mean square), {simplicity:.1} times the noise",
                100.0 * storage_rms,
                100.0 * loss_rms
            ),
            Self::NoOverlap { lower_k, upper_k } => write!(
                f,
                "the isotherms at {} and {} share no range of moduli: the shift between them is an extrapolation",
                celsius(*lower_k),
                celsius(*upper_k)
            ),
            Self::NoLaw { deviation } => write!(
                f,
                "neither WLF nor Arrhenius describes the shift factors: the better one leaves {deviation:.1} times their errors"
            ),
        }
    }
}

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
            let mut starts = vec![chain(false)];
            if choices.vertical_shift {
                starts.push(chain(true));
            }
            work.found(&starts)
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
        return Work::new(data, &choices)?.found(&[factors]);
    }
    shift(data, &choices)
}

impl MasterCurve {
    /// Shift factor at any temperature (log10 a_T): between isotherms by interpolation, outside the preferred law goes on from the
    /// last of them. `None` where neither says anything.
    pub fn log10_a_t(&self, temperature_k: f64) -> Option<f64> {
        let temperatures_k: Vec<f64> = self.shifts.iter().map(|s| s.temperature_k).collect();
        let log10_a_t: Vec<f64> = self.shifts.iter().map(|s| s.log10_a_t).collect();
        let law = self.preferred;
        let interpolation = Interpolation {
            temperatures_k: &temperatures_k,
            log10_a_t: &log10_a_t,
            law: law.map(|law| move |t: f64| law.log10_a_t(t)),
        };
        interpolation.at(temperature_k)
    }
}

/// What every choice works with.
struct Work<'a> {
    data: &'a DynamicData,
    choices: &'a Choices,
    temperatures_k: Vec<f64>,
    noise: Noise,
    reference_temperature_k: f64,
    /// The isotherm nearest to the reference temperature: factors are relative to it until all is found.
    fixed: usize,
    curve: OneCurve,
}

/// Factors relative to the fixed isotherm, and what is known of them.
struct Found {
    state: State,
    /// Of the factors, where they have errors.
    covariance: Option<DMatrix<f64>>,
    wlf: Option<LawFit>,
    arrhenius: Option<LawFit>,
    preferred: Option<Form>,
    simplicity: Option<f64>,
    warnings: Vec<MasterCurveWarning>,
}

impl<'a> Work<'a> {
    fn new(data: &'a DynamicData, choices: &'a Choices) -> Result<Self, MasterCurveError> {
        let isotherms = data.isotherms();
        let temperatures_k: Option<Vec<f64>> = isotherms.iter().map(|i| i.temperature_k).collect();
        let temperatures_k = temperatures_k.ok_or(MasterCurveError::NoTemperatures)?;
        let middle = temperatures_k.get(temperatures_k.len() / 2).copied();
        let reference = choices
            .reference_temperature_k
            .or_else(|| match &choices.shift {
                ShiftChoice::Given(given) => zero_of(given),
                _ => None,
            });
        let reference_temperature_k = reference
            .or(middle)
            .ok_or(MasterCurveError::NoTemperatures)?;
        let distance = |i: &usize| (temperatures_k[*i] - reference_temperature_k).abs();
        let nearest = (0..temperatures_k.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)));
        let fixed = nearest.unwrap_or_default();
        let noise = Noise::of(data);
        Ok(Self {
            data,
            choices,
            curve: one_curve(data, choices, &noise, fixed),
            temperatures_k,
            noise,
            reference_temperature_k,
            fixed,
        })
    }

    fn relative_to_fixed(&self, shifts: &[f64]) -> Vec<f64> {
        let zero = shifts.get(self.fixed).copied().unwrap_or_default();
        shifts.iter().map(|s| s - zero).collect()
    }

    /// Variance of the data in units of their noise, as the misfit of a state says.
    fn variance(&self, state: &State, unknowns: usize) -> f64 {
        state.squares / self.curve.freedom(state, unknowns)
    }

    /// By what the covariance for data of unit variance is multiplied: the variance, and what neighbouring residuals have in
    /// common where they are no noise.
    fn scale(&self, state: &State, unknowns: usize) -> f64 {
        let variance = self.variance(state, unknowns);
        let told = self.data.points().all(|point| point.errors_pa.is_some());
        let variance = if told { variance.max(1.0) } else { variance };
        variance * state.correlated
    }

    /// The state that is best of those that these lead to, and the covariance of its unknowns for data of unit variance. Data that no
    /// one curve describes are described best where they are far apart: there neighbours are held to what they say as a pair.
    fn refined(&self, starts: &[Vec<f64>], by: &DMatrix<f64>) -> (State, Option<DMatrix<f64>>) {
        let refined = starts.iter().map(|start| {
            let start = self.relative_to_fixed(start);
            (self.curve.refine(&start), start)
        });
        let best = refined.min_by(|a, b| a.0.objective.total_cmp(&b.0.objective));
        let none = || {
            let start = vec![0.0; self.temperatures_k.len()];
            (self.curve.refine(&start), start)
        };
        let (state, start) = best.unwrap_or_else(none);
        if self.variance(&state, by.ncols()) <= SIMPLE * SIMPLE {
            let covariance = self.curve.covariance(&state, by);
            return (state, covariance);
        }
        let start = self.relative_to_fixed(starts.first().unwrap_or(&start));
        let held = one_curve(self.data, self.choices, &self.noise, self.fixed);
        let held = held.expecting(&start, self.scale(&state, by.ncols()));
        let state = held.refine(&start);
        let covariance = held.covariance(&state, by);
        (state, covariance)
    }

    /// Factors from the data, by what is chosen, from the best of these on.
    fn found(&self, starts: &[Vec<f64>]) -> Result<MasterCurve, MasterCurveError> {
        let free = self.curve.free();
        let by = self.curve.directions(&free);
        let (state, own) = self.refined(starts, &by);
        let scale = self.scale(&state, by.ncols());
        let count = free.ncols();
        let own = own.map(|own| own.view((0, 0), (count, count)) * scale + self.gaps(&state));
        let (wlf, arrhenius) = match &own {
            Some(own) => self.laws(&state.places[..self.temperatures_k.len()], own),
            None => (None, None),
        };
        let mut found = Found {
            simplicity: Some(self.variance(&state, by.ncols()).sqrt()),
            covariance: own.map(|own| &free * own * free.transpose()),
            preferred: preferred(&wlf, &arrhenius, self.curve.count()),
            warnings: self.warnings(&state, by.ncols()),
            state,
            wlf,
            arrhenius,
        };
        let form = match self.choices.shift {
            ShiftChoice::Wlf => Some((Form::Wlf, "WLF")),
            ShiftChoice::Arrhenius => Some((Form::Arrhenius, "Arrhenius")),
            _ => None,
        };
        found.warn_of_law(form.map(|form| form.0));
        if let Some((form, law)) = form {
            self.held_to(form, &mut found)
                .ok_or(MasterCurveError::NoLaw { law })?;
        }
        self.assembled(found)
    }

    /// The factors of a law, its constants refined together with the curve.
    fn held_to(&self, form: Form, found: &mut Found) -> Option<()> {
        let fit = match form {
            Form::Wlf => &mut found.wlf,
            Form::Arrhenius => &mut found.arrhenius,
        };
        let fit = fit.as_mut()?;
        let law = fit.hyperbola;
        let constants = law.unknowns();
        let by = |constants: &[f64]| law.with(constants).derivatives(&self.temperatures_k);
        let directions = |unknowns: &[f64]| self.curve.directions(&by(unknowns));
        let count = self.temperatures_k.len();
        let places = |unknowns: &[f64]| {
            let law = law.with(unknowns);
            let factors = self.temperatures_k.iter().map(|&t| law.log10_a_t(t));
            let mut places = self.curve.places(&factors.collect::<Option<Vec<f64>>>()?);
            // Vertical shifts are unknowns of their own, after the constants of the law.
            let moved = unknowns.get(constants.len()..).unwrap_or_default();
            let isotherms = (0..count).filter(|i| *i != self.fixed);
            for (isotherm, &b_t) in isotherms.zip(moved) {
                places[count + isotherm] = b_t;
            }
            Some(places)
        };
        let mut start = constants.clone();
        start.resize(directions(&constants).ncols(), 0.0);
        let (unknowns, state) = self.curve.refine_by(&start, places, directions)?;
        fit.hyperbola = law.with(&unknowns);
        let scale = self.scale(&state, unknowns.len());
        let covariance = self.curve.covariance(&state, &directions(&unknowns))?;
        let own = (constants.len(), constants.len());
        fit.covariance = covariance.view((0, 0), own) * scale;
        let by = by(&unknowns);
        found.covariance = Some(&by * &fit.covariance * by.transpose());
        found.state = state;
        found.preferred = Some(form);
        Some(())
    }

    /// Factors as they are given; relative to one another, if `referred`.
    fn given(&self, factors: Vec<f64>, referred: bool) -> Result<MasterCurve, MasterCurveError> {
        let mut state = self
            .curve
            .at(&self.curve.places(&self.relative_to_fixed(&factors)), &[]);
        let free = self.curve.refine(&state.places[..factors.len()]);
        let unknowns = self.curve.directions(&self.curve.free()).ncols();
        if self.choices.vertical_shift {
            state = self.vertical_only(&state);
        }
        let count = factors.len().saturating_sub(1);
        let unknown = DMatrix::from_diagonal_element(count, count, GIVEN_ERROR * GIVEN_ERROR);
        let (wlf, arrhenius) = match referred {
            true => self.laws(&state.places[..self.temperatures_k.len()], &unknown),
            false => (None, None),
        };
        self.assembled(Found {
            simplicity: Some(self.variance(&free, unknowns).sqrt()),
            covariance: None,
            preferred: preferred(&wlf, &arrhenius, factors.len()),
            warnings: self.warnings(&free, unknowns),
            state,
            wlf,
            arrhenius,
        })
    }

    /// The moduli shifted, and the frequencies as they are.
    fn vertical_only(&self, state: &State) -> State {
        let start = DVector::from_row_slice(&state.places);
        let by = self
            .curve
            .directions(&DMatrix::zeros(self.temperatures_k.len(), 0));
        let places = |unknowns: &[f64]| {
            let moved = &start + &by * DVector::from_row_slice(unknowns);
            Some(moved.iter().copied().collect())
        };
        let none = vec![0.0; by.ncols()];
        let refined = self.curve.refine_by(&none, places, |_| by.clone());
        refined.map_or_else(|| state.clone(), |found| found.1)
    }

    /// Laws through the factors of all isotherms but the fixed one.
    fn laws(&self, shifts: &[f64], covariance: &DMatrix<f64>) -> (Option<LawFit>, Option<LawFit>) {
        if shifts.len() < 2 {
            return (None, None);
        }
        let others = |values: &[f64]| -> Vec<f64> {
            let all = values.iter().enumerate().filter(|(i, _)| *i != self.fixed);
            all.map(|(_, &value)| value).collect()
        };
        let factors = Factors {
            origin_k: self.temperatures_k[self.fixed],
            temperatures_k: &others(&self.temperatures_k),
            log10_a_t: &others(shifts),
            covariance,
        };
        factors.laws()
    }

    /// Reduced angular frequencies (log10) of the first and last point of an isotherm.
    fn window(&self, state: &State, isotherm: usize) -> (f64, f64) {
        let points = &self.data.isotherms()[isotherm].points;
        let reduced = points
            .iter()
            .map(|p| p.angular_frequency_rad_per_s.log10() + state.places[isotherm]);
        (
            reduced.clone().fold(f64::INFINITY, f64::min),
            reduced.fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// Decades between an isotherm and the next hotter one, if they do not meet.
    fn gap(&self, state: &State, colder: usize) -> Option<f64> {
        let gap = self.window(state, colder).0 - self.window(state, colder + 1).1;
        (gap > 0.0).then_some(gap)
    }

    /// Covariance of the free factors that comes from gaps: how the curve runs in them, no one knows.
    fn gaps(&self, state: &State) -> DMatrix<f64> {
        let count = self.temperatures_k.len();
        let mut all = DMatrix::zeros(count, count);
        for (colder, gap) in (0..count - 1).filter_map(|i| Some((i, self.gap(state, i)?))) {
            let beyond: Vec<usize> = match colder < self.fixed {
                true => (0..=colder).collect(),
                false => (colder + 1..count).collect(),
            };
            for (&i, &j) in beyond
                .iter()
                .flat_map(|i| beyond.iter().map(move |j| (i, j)))
            {
                all[(i, j)] += gap * gap;
            }
        }
        let by = self.curve.free();
        by.tr_mul(&(all * &by))
    }

    fn warnings(&self, state: &State, unknowns: usize) -> Vec<MasterCurveWarning> {
        let mut warnings = Vec::new();
        let simplicity = self.variance(state, unknowns).sqrt();
        if simplicity > SIMPLE {
            let [storage_rms, loss_rms] = state.relative;
            warnings.push(MasterCurveWarning::NotSimple {
                simplicity,
                storage_rms,
                loss_rms,
            });
        }
        for (colder, pair) in self.data.isotherms().windows(2).enumerate() {
            let storage = |i: usize| pair[i].points.iter().map(|p| p.storage_modulus_pa);
            let least = storage(0).fold(f64::INFINITY, f64::min);
            let most = storage(1).fold(0.0, f64::max);
            let apart =
                !self.choices.vertical_shift && most * (1.0 + 3.0 * self.noise.storage) < least;
            if apart || self.gap(state, colder).is_some() {
                warnings.push(MasterCurveWarning::NoOverlap {
                    lower_k: self.temperatures_k[colder],
                    upper_k: self.temperatures_k[colder + 1],
                });
            }
        }
        warnings
    }

    /// The master curve, referred to the reference temperature.
    fn assembled(&self, found: Found) -> Result<MasterCurve, MasterCurveError> {
        let fit = match found.preferred {
            Some(Form::Wlf) => found.wlf.as_ref(),
            Some(Form::Arrhenius) => found.arrhenius.as_ref(),
            None => None,
        };
        let reference = self.reference_temperature_k;
        let interpolation = Interpolation {
            temperatures_k: &self.temperatures_k,
            log10_a_t: &found.state.places[..self.temperatures_k.len()],
            law: fit.map(|fit| move |t: f64| fit.hyperbola.log10_a_t(t)),
        };
        let zero = match self.choices.shift {
            ShiftChoice::None => Some(0.0),
            _ => interpolation.at(reference),
        };
        let zero = zero.ok_or_else(|| self.no_reference())?;
        let errors = found
            .covariance
            .as_ref()
            .map(|c| referred(c, &interpolation.weights(reference)));
        let law = |fit: &Option<LawFit>| {
            let fit = fit.as_ref()?;
            fit.hyperbola.law(&fit.covariance, reference)
        };
        let (wlf, arrhenius) = (law(&found.wlf), law(&found.arrhenius));
        let preferred = match found.preferred {
            Some(Form::Wlf) => wlf,
            Some(Form::Arrhenius) => arrhenius,
            None => None,
        };
        let only_wlf = |law: ShiftLaw| match law {
            ShiftLaw::Wlf(law) => Some(law),
            ShiftLaw::Arrhenius(_) => None,
        };
        let only_arrhenius = |law: ShiftLaw| match law {
            ShiftLaw::Arrhenius(law) => Some(law),
            ShiftLaw::Wlf(_) => None,
        };
        let shifts = self.factors(&found.state, zero, errors.as_deref());
        Ok(MasterCurve {
            reference_temperature_k: reference,
            points: self.reduced(&shifts),
            shifts,
            wlf: wlf.and_then(only_wlf),
            arrhenius: arrhenius.and_then(only_arrhenius),
            preferred,
            simplicity: found.simplicity,
            warnings: found.warnings,
        })
    }

    fn no_reference(&self) -> MasterCurveError {
        MasterCurveError::NoReference {
            temperature_k: self.reference_temperature_k,
            lowest_k: self.temperatures_k.first().copied().unwrap_or_default(),
            highest_k: self.temperatures_k.last().copied().unwrap_or_default(),
        }
    }

    fn factors(&self, state: &State, zero: f64, errors: Option<&[f64]>) -> Vec<ShiftFactor> {
        let count = self.temperatures_k.len();
        let vertical = |isotherm: usize| {
            state
                .places
                .get(count + isotherm)
                .copied()
                .unwrap_or_default()
        };
        let logarithms =
            (0..count).map(|isotherm| (self.temperatures_k[isotherm], vertical(isotherm)));
        let logarithms: Vec<(f64, f64)> = logarithms.collect();
        let lowest = self.temperatures_k.first().copied().unwrap_or_default();
        let highest = self.temperatures_k.last().copied().unwrap_or_default();
        let within = self.reference_temperature_k.clamp(lowest, highest);
        let one = monotone(&logarithms, within).unwrap_or_default();
        let factor = |isotherm: usize| ShiftFactor {
            temperature_k: self.temperatures_k[isotherm],
            log10_a_t: state.places[isotherm] - zero,
            log10_a_t_error: errors.and_then(|errors| errors.get(isotherm).copied()),
            b_t: 10_f64.powf(logarithms[isotherm].1 - one),
        };
        (0..self.temperatures_k.len()).map(factor).collect()
    }

    fn reduced(&self, shifts: &[ShiftFactor]) -> Vec<DynamicPoint> {
        let isotherms = self.data.isotherms().iter().zip(shifts);
        let points = isotherms.flat_map(|(isotherm, shift)| {
            let a_t = 10_f64.powf(shift.log10_a_t);
            let b_t = shift.b_t;
            isotherm.points.iter().map(move |point| DynamicPoint {
                temperature_k: point.temperature_k,
                angular_frequency_rad_per_s: a_t * point.angular_frequency_rad_per_s,
                storage_modulus_pa: b_t * point.storage_modulus_pa,
                loss_modulus_pa: b_t * point.loss_modulus_pa,
                errors_pa: point
                    .errors_pa
                    .map(|(storage, loss)| (b_t * storage, b_t * loss)),
            })
        });
        let mut points: Vec<DynamicPoint> = points.collect();
        points.sort_by(|a, b| {
            a.angular_frequency_rad_per_s
                .total_cmp(&b.angular_frequency_rad_per_s)
        });
        points
    }
}

impl Found {
    /// Says so where the law that is to be used does not describe the free factors.
    fn warn_of_law(&mut self, chosen: Option<Form>) {
        let fit = match chosen.or(self.preferred) {
            Some(Form::Wlf) => self.wlf.as_ref(),
            Some(Form::Arrhenius) => self.arrhenius.as_ref(),
            None => None,
        };
        if let Some(fit) = fit.filter(|fit| fit.fails()) {
            let deviation = (fit.squares / fit.freedom.max(1) as f64).sqrt();
            self.warnings.push(MasterCurveWarning::NoLaw { deviation });
        }
    }
}

fn one_curve(data: &DynamicData, choices: &Choices, noise: &Noise, fixed: usize) -> OneCurve {
    let isotherms: Vec<_> = data.isotherms().iter().collect();
    OneCurve::new(&isotherms, noise, fixed, choices.vertical_shift)
}

/// Given factors are taken to be rounded to this (decades) when a law is fitted to them.
const GIVEN_ERROR: f64 = 1e-3;

fn preferred(wlf: &Option<LawFit>, arrhenius: &Option<LawFit>, values: usize) -> Option<Form> {
    match (wlf, arrhenius) {
        (Some(wlf), Some(arrhenius)) if !prefers_wlf(wlf, arrhenius, values) => {
            Some(Form::Arrhenius)
        }
        (Some(_), _) => Some(Form::Wlf),
        (None, Some(_)) => Some(Form::Arrhenius),
        (None, None) => None,
    }
}

/// Standard errors of the factors less their weighted mean.
fn referred(covariance: &DMatrix<f64>, weights: &[f64]) -> Vec<f64> {
    let count = covariance.nrows();
    let by = DMatrix::from_fn(count, count, |i, j| {
        f64::from(u8::from(i == j)) - weights[j]
    });
    let referred = &by * covariance * by.transpose();
    referred
        .diagonal()
        .iter()
        .map(|variance| variance.max(0.0).sqrt())
        .collect()
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
