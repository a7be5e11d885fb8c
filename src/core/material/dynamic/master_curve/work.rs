//! The shift factors of isotherms and their errors: refined against one curve, held to a law where one is chosen, referred to the
//! reference temperature.

use nalgebra::DMatrix;

use super::{
    MasterCurve, MasterCurveError, MasterCurveWarning, SIMPLE, ShiftChoice, ShiftFactor,
    UNDETERMINED, zero_of,
};
use crate::material::dynamic::interpolation::{self, monotone};
use crate::material::dynamic::noise::Noise;
use crate::material::dynamic::one_curve::{OneCurve, State};
use crate::material::dynamic::shift_law::{Factors, Form, Laws, ShiftLaw};
use crate::material::dynamic::{Choices, DynamicData, DynamicPoint};

/// What every choice works with.
pub(super) struct Work<'a> {
    data: &'a DynamicData,
    choices: &'a Choices,
    pub(super) temperatures_k: Vec<f64>,
    pub(super) noise: Noise,
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
    laws: Laws,
    preferred: Option<Form>,
    simplicity: Option<f64>,
    warnings: Vec<MasterCurveWarning>,
}

impl<'a> Work<'a> {
    pub(super) fn new(
        data: &'a DynamicData,
        choices: &'a Choices,
    ) -> Result<Self, MasterCurveError> {
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

    /// The state that is best of those that these two lead to, and the covariance of its unknowns for data of unit variance. Data that
    /// no one curve describes are described best where they are far apart: there neighbours are held to what the first says as a pair.
    fn refined(
        &self,
        start: &[f64],
        other: Option<Vec<f64>>,
        by: &DMatrix<f64>,
    ) -> (State, Option<DMatrix<f64>>) {
        let start = self.relative_to_fixed(start);
        let mut state = self.curve.refine(&start);
        let other = other.map(|other| self.curve.refine(&self.relative_to_fixed(&other)));
        if let Some(other) =
            other.filter(|other| other.objective.total_cmp(&state.objective).is_lt())
        {
            state = other;
        }
        if self.variance(&state, by.ncols()) <= SIMPLE * SIMPLE {
            let covariance = self.curve.covariance(&state, by);
            return (state, covariance);
        }
        let held = one_curve(self.data, self.choices, &self.noise, self.fixed);
        let held = held.expecting(&start, self.scale(&state, by.ncols()));
        let state = held.refine(&start);
        let covariance = held.covariance(&state, by);
        (state, covariance)
    }

    /// Factors from the data, by what is chosen, from the better of these on.
    pub(super) fn found(
        &self,
        start: &[f64],
        other: Option<Vec<f64>>,
    ) -> Result<MasterCurve, MasterCurveError> {
        let free = self.curve.free();
        let by = self.curve.directions(&free);
        let (state, own) = self.refined(start, other, &by);
        let scale = self.scale(&state, by.ncols());
        let count = free.ncols();
        let own = own.map(|own| own.view((0, 0), (count, count)) * scale + self.gaps(&state));
        let laws = own.as_ref().map(|own| self.laws(&state, own));
        let laws = laws.unwrap_or_default();
        let mut found = Found {
            simplicity: Some(self.variance(&state, by.ncols()).sqrt()),
            covariance: own.map(|own| &free * own * free.transpose()),
            preferred: laws.preferred(self.curve.count()),
            warnings: self.warnings(&state, by.ncols()),
            state,
            laws,
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
            Form::Wlf => &mut found.laws.wlf,
            Form::Arrhenius => &mut found.laws.arrhenius,
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
    pub(super) fn given(
        &self,
        factors: Vec<f64>,
        referred: bool,
    ) -> Result<MasterCurve, MasterCurveError> {
        let mut state = self
            .curve
            .at(&self.curve.places(&self.relative_to_fixed(&factors)), &[]);
        let free = self.curve.refine(&state.places[..factors.len()]);
        let unknowns = self.curve.directions(&self.curve.free()).ncols();
        if self.choices.vertical_shift {
            // The moduli shifted, and the frequencies as they are.
            let by = self.curve.directions(&DMatrix::zeros(factors.len(), 0));
            state = self.curve.refine_along(&state.places, &by);
        }
        let count = factors.len().saturating_sub(1);
        let unknown = DMatrix::from_diagonal_element(count, count, GIVEN_ERROR * GIVEN_ERROR);
        let laws = referred.then(|| self.laws(&state, &unknown));
        let laws = laws.unwrap_or_default();
        self.assembled(Found {
            simplicity: Some(self.variance(&free, unknowns).sqrt()),
            covariance: None,
            preferred: laws.preferred(factors.len()),
            warnings: self.warnings(&free, unknowns),
            state,
            laws,
        })
    }

    /// Laws through the factors of all isotherms but the fixed one.
    fn laws(&self, state: &State, covariance: &DMatrix<f64>) -> Laws {
        let shifts = &state.places[..self.temperatures_k.len()];
        if shifts.len() < 2 {
            return Laws::default();
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
        let (lowest, highest) = self.data.isotherms()[isotherm].window_rad_per_s();
        let shift = state.places[isotherm];
        (lowest.log10() + shift, highest.log10() + shift)
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
        let fit = found.preferred.and_then(|form| found.laws.of(form));
        let reference = self.reference_temperature_k;
        let factors = self.temperatures_k.iter().copied();
        let factors: Vec<(f64, f64)> = factors.zip(found.state.places.iter().copied()).collect();
        let law = |t: f64| fit?.hyperbola.log10_a_t(t);
        let zero = match self.choices.shift {
            ShiftChoice::None => Some(0.0),
            _ => interpolation::log10_a_t(&factors, &law, reference),
        };
        let (lowest_k, highest_k) = self.range_k();
        let zero = zero.ok_or(MasterCurveError::NoReference {
            temperature_k: reference,
            lowest_k,
            highest_k,
        })?;
        let weights = interpolation::weights(&self.temperatures_k, reference);
        let errors = found.covariance.as_ref();
        let errors = errors.map(|covariance| referred(covariance, &weights));
        let wlf = found.laws.wlf.as_ref().and_then(|fit| fit.wlf(reference));
        let arrhenius = found.laws.arrhenius.as_ref();
        let arrhenius = arrhenius.map(|fit| fit.arrhenius(reference));
        let preferred = found.preferred.and_then(|form| match form {
            Form::Wlf => wlf.map(ShiftLaw::Wlf),
            Form::Arrhenius => arrhenius.map(ShiftLaw::Arrhenius),
        });
        let shifts = self.factors(&found.state, zero, errors.as_deref());
        let mut warnings = found.warnings;
        if self.is_searched() {
            warnings.extend(shifts.iter().filter_map(undetermined));
        }
        Ok(MasterCurve {
            reference_temperature_k: reference,
            points: self.reduced(&shifts),
            shifts,
            wlf,
            arrhenius,
            preferred,
            simplicity: found.simplicity,
            warnings,
        })
    }

    /// Whether the factors come from the data.
    fn is_searched(&self) -> bool {
        !matches!(
            self.choices.shift,
            ShiftChoice::None | ShiftChoice::Given(_)
        )
    }

    /// Lowest and highest temperature of an isotherm.
    fn range_k(&self) -> (f64, f64) {
        let ends = self.temperatures_k.first().zip(self.temperatures_k.last());
        ends.map_or_else(Default::default, |(lowest, highest)| (*lowest, *highest))
    }

    fn factors(&self, state: &State, zero: f64, errors: Option<&[f64]>) -> Vec<ShiftFactor> {
        let count = self.temperatures_k.len();
        let vertical = |isotherm: usize| state.places.get(count + isotherm).copied();
        let temperatures = self.temperatures_k.iter().enumerate();
        let logarithms: Vec<(f64, f64)> = temperatures
            .map(|(isotherm, &t)| (t, vertical(isotherm).unwrap_or_default()))
            .collect();
        let (lowest, highest) = self.range_k();
        let within = self.reference_temperature_k.clamp(lowest, highest);
        let one = monotone(&logarithms, within).unwrap_or_default();
        let factor = |isotherm: usize| ShiftFactor {
            temperature_k: self.temperatures_k[isotherm],
            log10_a_t: state.places[isotherm] - zero,
            log10_a_t_error: errors.and_then(|errors| errors.get(isotherm).copied()),
            b_t: 10_f64.powf(logarithms[isotherm].1 - one),
        };
        (0..count).map(factor).collect()
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
        let fit = chosen
            .or(self.preferred)
            .and_then(|form| self.laws.of(form));
        if let Some(fit) = fit.filter(|fit| fit.fails()) {
            let deviation = (fit.squares / fit.freedom.max(1) as f64).sqrt();
            self.warnings.push(MasterCurveWarning::NoLaw { deviation });
        }
    }
}

/// What is to be said of a factor that the data leave open.
fn undetermined(shift: &ShiftFactor) -> Option<MasterCurveWarning> {
    let error = shift.log10_a_t_error;
    let known = error.is_some_and(|error| error < UNDETERMINED);
    (!known).then_some(MasterCurveWarning::Undetermined {
        temperature_k: shift.temperature_k,
        error,
    })
}

fn one_curve(data: &DynamicData, choices: &Choices, noise: &Noise, fixed: usize) -> OneCurve {
    let isotherms: Vec<_> = data.isotherms().iter().collect();
    OneCurve::new(&isotherms, noise, fixed, choices.vertical_shift)
}

/// Given factors are taken to be rounded to this (decades) when a law is fitted to them.
const GIVEN_ERROR: f64 = 1e-3;

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
