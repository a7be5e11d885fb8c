//! Laws of a few parameters, between which measurements choose: their parameters, their complex modulus, and the series that stands for
//! them over the times of a measurement.
//!
//! ```text
//! power-law             E* = E (i omega 1 s)^a
//! standard-solid        E* = E_inf + E_1 i omega tau/(1 + i omega tau)
//! fractional-zener      E* = E_inf + E_1 (i omega tau)^a/(1 + (i omega tau)^a)
//! fractional-maxwell    E* = E_1 (i omega tau)^a/(1 + (i omega tau)^(a - b))
//! kelvin-voigt          E* = E_inf + E (i omega 1 s)^a
//! kww                   E(t) = E_inf + E_1 exp(-(t/tau)^a)
//! series                E(t) = E_inf + sum of E_i exp(-t/tau_i)
//! ```
//!
//! The fractional ones are those of [`super::fractional`]; the stretched exponential is that of R. Kohlrausch (Ann. Phys. 167 (1854) 179)
//! and of G. Williams, D. C. Watts (Trans. Faraday Soc. 66 (1970) 80).

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use super::fractional::Fractional;
use super::relaxation::{Relaxation, RelaxationBranch};
use crate::numerics::nnls::nnls_from;
use crate::quantity::Dimension;
use crate::words;

words! {
    /// A law.
    pub enum Law {
        PowerLaw = "power-law",
        StandardSolid = "standard-solid",
        FractionalZener = "fractional-zener",
        FractionalMaxwell = "fractional-maxwell",
        KelvinVoigt = "kelvin-voigt",
        Kww = "kww",
        Series = "series",
    }
}

/// A law with its number of branches, which is one but for a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Form {
    pub law: Law,
    pub branches: usize,
}

/// A parameter of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// With its unit: `modulus_pa`, `time_s`, `exponent`.
    pub name: String,
    pub scale: Scale,
}

/// What a fit takes for a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Its logarithm.
    Logarithm(Dimension),
    /// The logarithm of its odds p/(1 - p).
    Odds,
}

const STRESS: Scale = Scale::Logarithm(Dimension::Stress);
const TIME: Scale = Scale::Logarithm(Dimension::Time);

impl Scale {
    /// The parameter of an unknown.
    pub fn value(self, unknown: f64) -> f64 {
        match self {
            Self::Logarithm(_) => unknown.exp(),
            Self::Odds => 1.0 / (1.0 + (-unknown).exp()),
        }
    }

    /// The unknown of a parameter.
    pub fn unknown(self, value: f64) -> f64 {
        match self {
            Self::Logarithm(_) => value.ln(),
            Self::Odds => (value / (1.0 - value)).ln(),
        }
    }
}

/// A law with values for its parameters.
#[derive(Debug, Clone)]
pub enum Solid {
    Fractional(Fractional),
    Series(Relaxation),
}

impl Solid {
    /// E* (Pa).
    pub fn complex_modulus_pa(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        match self {
            Self::Fractional(fractional) => fractional.complex_modulus(angular_frequency_rad_per_s),
            Self::Series(series) => series.complex_modulus(angular_frequency_rad_per_s),
        }
    }

    /// The Prony series that stands for it from the shortest to the longest time (s).
    pub fn series_within(self, times_s: (f64, f64)) -> Option<Relaxation> {
        match self {
            Self::Fractional(fractional) => fractional.within(times_s).ok(),
            Self::Series(series) => Some(series),
        }
    }
}

/// By which factor the times of a series go beyond those of a measurement.
const BEYOND: f64 = 10.0;

impl Form {
    /// All that are tried where the data are to choose: a series of one branch is the standard solid.
    pub fn all(most_branches: usize) -> Vec<Self> {
        let one = Law::NAMES.iter().map(|(_, law)| Self {
            law: *law,
            branches: 1,
        });
        let own = one.filter(|form| form.law != Law::Series);
        own.chain(Self::series(2, most_branches)).collect()
    }

    /// Series of these numbers of branches.
    pub fn series(fewest: usize, most: usize) -> impl Iterator<Item = Self> {
        (fewest..=most).map(|branches| Self {
            law: Law::Series,
            branches,
        })
    }

    /// Names and scales of its parameters, but those of the branches of a series.
    fn own(self) -> &'static [(&'static str, Scale)] {
        const EQUILIBRIUM: (&str, Scale) = ("equilibrium_modulus_pa", STRESS);
        const MODULUS_PA: (&str, Scale) = ("modulus_pa", STRESS);
        const TIME_S: (&str, Scale) = ("time_s", TIME);
        const EXPONENT: (&str, Scale) = ("exponent", Scale::Odds);
        // The second exponent is a part of the first.
        const RATIO: (&str, Scale) = ("exponent_ratio", Scale::Odds);
        match self.law {
            Law::PowerLaw => &[MODULUS_PA, EXPONENT],
            Law::StandardSolid => &[EQUILIBRIUM, MODULUS_PA, TIME_S],
            Law::FractionalZener | Law::Kww => &[EQUILIBRIUM, MODULUS_PA, TIME_S, EXPONENT],
            Law::FractionalMaxwell => &[MODULUS_PA, TIME_S, EXPONENT, RATIO],
            Law::KelvinVoigt => &[EQUILIBRIUM, MODULUS_PA, EXPONENT],
            Law::Series => &[EQUILIBRIUM],
        }
    }

    /// Whether it keeps a modulus at rest.
    pub fn is_solid(self) -> bool {
        !matches!(self.law, Law::PowerLaw | Law::FractionalMaxwell)
    }

    fn branches_of_series(self) -> usize {
        match self.law {
            Law::Series => self.branches,
            _ => 0,
        }
    }

    /// In the order of its unknowns: moduli first, but those of a series, of which each has its time behind it.
    pub fn parameters(self) -> Vec<Parameter> {
        let own = self.own().iter().map(|(name, _)| (*name).to_owned());
        let branches = 1..=self.branches_of_series();
        let branches = branches.flat_map(|k| [format!("modulus_{k}_pa"), format!("time_{k}_s")]);
        let all = own.chain(branches).zip(self.scales());
        all.map(|(name, scale)| Parameter { name, scale }).collect()
    }

    /// Of the parameters, in their order.
    pub fn scales(self) -> impl Iterator<Item = Scale> {
        let own = self.own().iter().map(|(_, scale)| *scale);
        own.chain((0..self.branches_of_series()).flat_map(|_| [STRESS, TIME]))
    }

    /// The parameters of unknowns.
    pub fn values(self, unknowns: &[f64]) -> Vec<f64> {
        let all = self.scales().zip(unknowns);
        all.map(|(scale, unknown)| scale.value(*unknown)).collect()
    }

    fn fractional(self, values: &[f64]) -> Option<Fractional> {
        let made = match (self.law, values) {
            (Law::PowerLaw, &[modulus_pa, exponent]) => {
                Fractional::springpot(modulus_pa, 1.0, exponent)
            }
            (Law::FractionalZener, &[equilibrium_pa, modulus_pa, time_s, exponent]) => {
                Fractional::zener(equilibrium_pa, modulus_pa, time_s, exponent)
            }
            (Law::FractionalMaxwell, &[modulus_pa, time_s, exponent, ratio]) => {
                Fractional::maxwell(modulus_pa, time_s, exponent, ratio * exponent)
            }
            (Law::KelvinVoigt, &[equilibrium_pa, modulus_pa, exponent]) => {
                Fractional::kelvin_voigt(equilibrium_pa, modulus_pa, 1.0, exponent)
            }
            _ => return None,
        };
        made.ok()
    }

    /// The law with these values of its parameters, where times between the shortest and the longest (s) matter; `None` of parameters that
    /// are none.
    pub fn solid(self, values: &[f64], times_s: (f64, f64)) -> Option<Solid> {
        if let Some(fractional) = self.fractional(values) {
            return Some(Solid::Fractional(fractional));
        }
        let branch = |modulus_pa, time_s| RelaxationBranch { modulus_pa, time_s };
        let equilibrium_pa = *values.first()?;
        let branches = match (self.law, values) {
            (Law::Kww, &[_, modulus_pa, time_s, exponent]) => {
                stretched(modulus_pa, time_s, exponent, times_s)?
            }
            _ => {
                let pairs = values.get(1..)?.chunks_exact(2);
                pairs.map(|pair| branch(pair[0], pair[1])).collect()
            }
        };
        let series = Relaxation::new(equilibrium_pa, branches);
        series.ok().map(Solid::Series)
    }

    /// E* (Pa) in closed form, of a stretched exponential that of its series; `None` of parameters that are none.
    pub fn complex_modulus_pa(
        self,
        values: &[f64],
        angular_frequency_rad_per_s: f64,
    ) -> Option<Complex<f64>> {
        let omega = angular_frequency_rad_per_s;
        let solid = self.solid(values, (1e-2 / omega, 1e2 / omega))?;
        Some(solid.complex_modulus_pa(omega))
    }

    /// The Prony series that stands for the law from the shortest to the longest time (s): what relaxes later is a spring in it, or all
    /// but one. `None` of parameters that are none.
    pub fn series_within(self, values: &[f64], times_s: (f64, f64)) -> Option<Relaxation> {
        self.solid(values, times_s)?.series_within(times_s)
    }

    /// Unknowns to begin a fit with, of a body of about this modulus (Pa) over these times (s).
    pub fn starts(self, modulus_pa: f64, (shortest_s, longest_s): (f64, f64)) -> Vec<Vec<f64>> {
        let part = |share: f64| shortest_s * (longest_s / shortest_s).powf(share);
        let (early, middle, late) = (part(0.2), part(0.5), part(0.8));
        let half = 0.5 * modulus_pa;
        // A springpot that has this modulus in the middle.
        let springpot = |exponent: f64| modulus_pa * middle.powf(exponent);
        let values: Vec<Vec<f64>> = match self.law {
            Law::PowerLaw => [0.05, 0.2, 0.5].map(|a| vec![springpot(a), a]).to_vec(),
            Law::StandardSolid => [early, middle, late]
                .map(|time| vec![half, modulus_pa, time])
                .to_vec(),
            Law::FractionalZener => [(early, 0.5), (middle, 0.5), (late, 0.5), (middle, 0.85)]
                .map(|(time, a)| vec![half, modulus_pa, time, a])
                .to_vec(),
            Law::Kww => [(early, 0.5), (middle, 0.5), (late, 0.5), (middle, 0.85)]
                .map(|(time, a)| vec![half, modulus_pa, time, a])
                .to_vec(),
            Law::FractionalMaxwell => [(early, 0.3), (middle, 0.3), (late, 0.3), (late, 0.8)]
                .map(|(time, a)| vec![modulus_pa, time, a, 0.2])
                .to_vec(),
            Law::KelvinVoigt => [0.1, 0.3, 0.6]
                .map(|a| vec![half, 0.5 * springpot(a), a])
                .to_vec(),
            Law::Series => {
                let count = self.branches as f64;
                [(0.1, 0.9), (0.3, 0.9), (0.5, 1.1)]
                    .map(|(from, to)| {
                        let branches = (0..self.branches).flat_map(|k| {
                            let share = (k as f64 + 0.5) / count;
                            [modulus_pa / count, part(from + (to - from) * share)]
                        });
                        [half].into_iter().chain(branches).collect()
                    })
                    .to_vec()
            }
        };
        let unknowns = |values: Vec<f64>| {
            let all = values.iter().zip(self.scales());
            all.map(|(value, scale)| scale.unknown(*value)).collect()
        };
        values.into_iter().map(unknowns).collect()
    }

    /// In words: `series of 2 branches`.
    pub fn in_words(self) -> String {
        match self.law {
            Law::Series => format!("series of {}", super::branches_in_words(self.branches)),
            law => law.name().to_owned(),
        }
    }
}

/// The gradient of the squares of the misfit at which no more branches are taken in: from 1e-10 on down the moduli are those of a QR
/// factorisation to six digits in a third of its time, at 1e-9 some differ by a percent.
const NEGLIGIBLE: f64 = 1e-11;

/// Branches with a stretched exponential from a decade before the shortest to a decade after the longest time: a non-negative least squares
/// fit on fixed times. What has relaxed before is left out, not put into the fastest branch, whose loss it would be.
fn stretched(
    modulus_pa: f64,
    time_s: f64,
    exponent: f64,
    (shortest_s, longest_s): (f64, f64),
) -> Option<Vec<RelaxationBranch>> {
    // The narrower the spectrum, the closer the times.
    let grid = if exponent < 0.45 { 0.7 } else { 0.5 };
    let (first_s, last_s) = (shortest_s / BEYOND, longest_s * BEYOND);
    let (from, to) = ((first_s / BEYOND).ln(), (last_s * BEYOND).ln());
    let count = ((to - from) / grid).ceil() as usize;
    let times = (0..=count).map(|k| (from + grid * k as f64).exp());
    let times: Vec<f64> = times.collect();
    let samples = (0..2 * count).map(|k| (from + 0.5 * grid * k as f64).exp());
    let samples: Vec<f64> = samples.filter(|t| (first_s..=last_s).contains(t)).collect();
    let exact = |t: f64| (-(t / time_s).powf(exponent)).exp();
    let matrix = DMatrix::from_fn(samples.len(), times.len(), |row, column| {
        (-samples[row] / times[column]).exp()
    });
    let right = DVector::from_iterator(samples.len(), samples.iter().map(|t| exact(*t)));
    let (products, right) = (matrix.tr_mul(&matrix), matrix.tr_mul(&right));
    let parts = nnls_from(&products, &right, Vec::new(), NEGLIGIBLE).ok()?;
    let branches = parts.iter().zip(times).filter(|(part, _)| **part > 0.0);
    Some(
        branches
            .map(|(part, time_s)| RelaxationBranch {
                modulus_pa: modulus_pa * part,
                time_s,
            })
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A value for each parameter.
    fn values(form: Form) -> Vec<f64> {
        let parameters = form.parameters();
        let value = |(k, p): (usize, &Parameter)| match p.scale {
            Scale::Logarithm(Dimension::Time) => 0.3 * 10_f64.powi(k as i32 / 2),
            Scale::Logarithm(_) => 1e3 * (k + 1) as f64,
            Scale::Odds => 0.4,
        };
        parameters.iter().enumerate().map(value).collect()
    }

    #[test]
    fn the_series_of_a_law_has_its_complex_modulus_where_it_stands_for_it() {
        for form in Form::all(3) {
            let values = values(form);
            let series = form.series_within(&values, (1e-3, 1e2)).unwrap();
            for omega in [0.03, 0.3, 3.0, 30.0, 300.0] {
                let exact = form.complex_modulus_pa(&values, omega).unwrap();
                let off = (series.complex_modulus(omega) - exact).norm() / exact.norm();
                assert!(off < 5e-3, "{form:?} at {omega}: {off:.1e}");
            }
        }
    }

    #[test]
    fn a_stretched_exponential_is_met_at_every_time_of_the_window() {
        for exponent in [0.2, 0.5, 0.9] {
            let form = Form {
                law: Law::Kww,
                branches: 1,
            };
            let series = form
                .series_within(&[10.0, 100.0, 0.5, exponent], (1e-2, 1e1))
                .unwrap();
            for t in [0.01_f64, 0.05, 0.3, 2.0, 10.0] {
                let exact = 10.0 + 100.0 * (-(t / 0.5).powf(exponent)).exp();
                let branches = series.branches().iter();
                let own: f64 = branches.map(|b| b.modulus_pa * (-t / b.time_s).exp()).sum();
                let off = (series.equilibrium_modulus() + own - exact).abs() / 110.0;
                assert!(off < 2e-3, "{exponent} at {t}: {off:.1e}");
            }
        }
    }

    #[test]
    fn an_unknown_gives_its_parameter_back() {
        for scale in [Scale::Odds, Scale::Logarithm(Dimension::Time)] {
            for value in [1e-3, 0.3, 0.99] {
                assert!((scale.value(scale.unknown(value)) / value - 1.0).abs() < 1e-12);
            }
        }
    }
}
