//! What moves a signal besides its oscillation: thermal drift, creep towards a mean. A polynomial or an exponential, whichever the
//! data speak for.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::Signal;
use super::least_squares::{Normal, harmonic_columns};
use super::noise::correlation;
use crate::numerics::grid;

/// A drift without its size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum DriftModel {
    None,
    /// Zero at the first sample.
    Polynomial {
        degree: usize,
    },
    /// Decays to zero.
    Exponential {
        time_s: f64,
    },
    /// With a line that is zero at the first sample.
    ExponentialAndLine {
        time_s: f64,
    },
}

/// A drift of a signal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    pub model: DriftModel,
    /// Of the columns of the model, in the unit of the signal.
    coefficients: Vec<f64>,
    span: Span,
    /// Last value less the first one, in the unit of the signal.
    pub change: f64,
}

/// The time of a record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Span {
    pub(super) first_s: f64,
    pub(super) last_s: f64,
}

/// Largest degree of a polynomial.
const DEGREE: usize = 4;
/// Time constants that are tried at once.
const TIMES: usize = 12;
/// By how much twice the logarithm of the likelihood must grow beyond what a further coefficient costs: strong evidence (R. E. Kass
/// and A. E. Raftery, J. Am. Stat. Assoc. 90, 1995, 773).
const EVIDENCE: f64 = 6.0;

impl Span {
    pub(super) fn of(signal: &Signal) -> Self {
        let times = &signal.time_s;
        Self {
            first_s: times.first().copied().unwrap_or(0.0),
            last_s: times.last().copied().unwrap_or(0.0),
        }
    }

    pub(super) fn duration_s(&self) -> f64 {
        self.last_s - self.first_s
    }
}

/// Legendre polynomials of degree 1 to 4, less their values at -1.
fn polynomials(u: f64) -> [f64; DEGREE] {
    let u2 = u * u;
    [
        u + 1.0,
        1.5 * (u2 - 1.0),
        0.5 * u * (5.0 * u2 - 3.0) + 1.0,
        0.125 * ((35.0 * u2 - 30.0) * u2 + 3.0) - 1.0,
    ]
}

impl DriftModel {
    /// Number of its coefficients.
    pub fn size(self) -> usize {
        match self {
            Self::None => 0,
            Self::Polynomial { degree } => degree,
            Self::Exponential { .. } => 1,
            Self::ExponentialAndLine { .. } => 2,
        }
    }

    /// The time constant (s) of an exponential.
    fn time_s(self) -> Option<f64> {
        match self {
            Self::None | Self::Polynomial { .. } => None,
            Self::Exponential { time_s } | Self::ExponentialAndLine { time_s } => Some(time_s),
        }
    }

    /// Its columns at a time.
    fn fill(self, row: &mut [f64], span: &Span, time_s: f64) {
        let since_s = time_s - span.first_s;
        let u = 2.0 * since_s / span.duration_s() - 1.0;
        match self {
            Self::None => {}
            Self::Polynomial { degree } => row.copy_from_slice(&polynomials(u)[..degree]),
            Self::Exponential { time_s } => row[0] = (-since_s / time_s).exp(),
            Self::ExponentialAndLine { time_s } => {
                row[0] = (-since_s / time_s).exp();
                row[1] = u + 1.0;
            }
        }
    }
}

impl Drift {
    /// The drift of a model with these coefficients.
    pub(super) fn new(model: DriftModel, coefficients: &[f64], span: Span) -> Self {
        let mut drift = Self {
            model,
            coefficients: coefficients.to_vec(),
            span,
            change: 0.0,
        };
        drift.change = drift.at(span.last_s) - drift.at(span.first_s);
        drift
    }

    /// Its value at a time.
    pub fn at(&self, time_s: f64) -> f64 {
        let mut row = [0.0; DEGREE];
        let size = self.model.size();
        self.model.fill(&mut row[..size], &self.span, time_s);
        row.iter().zip(&self.coefficients).map(|(x, c)| x * c).sum()
    }
}

/// Samples at these times (s) as a linear model: mean and harmonics, then the functions of the drifts one after another.
pub(super) fn design(
    times_s: &[f64],
    span: &Span,
    (angular, harmonics): (f64, usize),
    drifts: &[DriftModel],
) -> DMatrix<f64> {
    let sizes = drifts.iter().map(|drift| drift.size());
    let mut design = DMatrix::zeros(1 + 2 * harmonics + sizes.sum::<usize>(), times_s.len());
    for (mut sample, time_s) in design.column_iter_mut().zip(times_s) {
        let row = sample.as_mut_slice();
        let mut from = harmonic_columns(row, angular * (time_s - span.first_s), harmonics);
        for drift in drifts {
            let to = from + drift.size();
            drift.fill(&mut row[from..to], span, *time_s);
            from = to;
        }
    }
    design
}

/// Drifts that are compared, all their functions in one linear model.
struct Candidates {
    design: DMatrix<f64>,
    gram: DMatrix<f64>,
    /// Functions that all have: mean and harmonics. Those of the polynomials follow, then the exponentials.
    common: usize,
    times_s: Vec<f64>,
}

/// A drift, and the places of its functions among those of all candidates.
type Candidate = (DriftModel, Vec<usize>);

impl Candidates {
    fn new(signal: &Signal, span: &Span, oscillation: (f64, usize), times_s: Vec<f64>) -> Self {
        let exponentials = times_s
            .iter()
            .map(|&time_s| DriftModel::Exponential { time_s });
        let polynomial = DriftModel::Polynomial { degree: DEGREE };
        let all: Vec<DriftModel> = [polynomial].into_iter().chain(exponentials).collect();
        let design = design(&signal.time_s, span, oscillation, &all);
        Self {
            gram: &design * design.transpose(),
            design,
            common: 1 + 2 * oscillation.1,
            times_s,
        }
    }

    fn polynomial(&self, degree: usize) -> Candidate {
        let own = self.common..self.common + degree;
        (DriftModel::Polynomial { degree }, own.collect())
    }

    /// Exponentials of all time constants, then those with a line.
    fn exponentials(&self) -> impl Iterator<Item = Candidate> + '_ {
        let times = || (self.common + DEGREE..).zip(&self.times_s);
        let alone =
            times().map(|(place, &time_s)| (DriftModel::Exponential { time_s }, vec![place]));
        let line = self.common;
        let and_line = times().map(move |(place, &time_s)| {
            (DriftModel::ExponentialAndLine { time_s }, vec![place, line])
        });
        alone.chain(and_line)
    }

    fn normal(&self, own: &[usize]) -> Option<Normal> {
        let all = (0..self.common).chain(own.iter().copied());
        Normal::new(&self.gram, all.collect())
    }

    /// How many samples of a signal count as independent beside the richest polynomial.
    fn independent(&self, signal: &DVector<f64>, degree: usize) -> Option<f64> {
        let normal = self.normal(&self.polynomial(degree).1)?;
        let coefficients = normal.solve(&(&self.design * signal));
        let residual = signal - self.design.tr_mul(&coefficients);
        let phi = correlation(residual.as_slice());
        Some((residual.len() as f64 * (1.0 - phi) / (1.0 + phi)).max(4.0))
    }

    /// The best of these for a signal without its mean, or no drift; with its criterion, of which less is better. A later one must be
    /// better by strong evidence, but among those of one size.
    fn best(
        &self,
        signal: &DVector<f64>,
        independent: f64,
        candidates: impl Iterator<Item = Candidate>,
    ) -> (f64, DriftModel) {
        let right = &self.design * signal;
        let squares = signal.norm_squared();
        let criterion = |model: DriftModel, own: &[usize]| {
            let explained = self.normal(own).map(|normal| normal.explained(&right));
            // What rounding leaves of an exact record.
            let left = explained.map(|explained| (squares - explained).max(1e-13 * squares));
            // A time constant is a coefficient too.
            let size = model.size() + usize::from(model.time_s().is_some());
            left.map_or(f64::INFINITY, |left| {
                independent * left.ln() + size as f64 * independent.ln()
            })
        };
        let none = DriftModel::None;
        let mut best = (criterion(none, &[]), none);
        for (model, own) in candidates {
            let criterion = criterion(model, &own);
            let is_larger = model.size() != best.1.size();
            let needed = if is_larger { EVIDENCE } else { 0.0 };
            if criterion < best.0 - needed {
                best = (criterion, model);
            }
        }
        best
    }
}

/// The drift of every signal at a known frequency: of the candidates that with the largest evidence (Bayesian information
/// criterion), where correlated noise counts as fewer samples.
pub(super) fn select(
    signal: &Signal,
    span: &Span,
    angular: f64,
    harmonics: usize,
) -> [DriftModel; 2] {
    let period_s = std::f64::consts::TAU / angular;
    let cycles = (span.duration_s() / period_s).round() as usize;
    let degree = cycles.saturating_sub(1).clamp(1, DEGREE);
    let longest_s = 3.0 * span.duration_s();
    let about = |from_s: f64, to_s: f64| {
        let times_s = grid::in_steps(from_s, to_s.min(longest_s), TIMES - 1);
        Candidates::new(signal, span, (angular, harmonics), times_s)
    };
    let candidates = about(0.5 * period_s, longest_s);
    [&signal.load_n, &signal.approach_m].map(|values| {
        // Without the mean, so that nothing is lost to cancellation.
        let values = DVector::from_column_slice(values);
        let values = values.add_scalar(-values.mean());
        let Some(independent) = candidates.independent(&values, degree) else {
            return DriftModel::None;
        };
        let polynomials = (1..=degree).map(|degree| candidates.polynomial(degree));
        let polynomial = candidates.best(&values, independent, polynomials);
        if matches!(polynomial.1, DriftModel::None) {
            return DriftModel::None;
        }
        // Between two of the time constants lies one that may be better than any polynomial.
        let mut exponential = candidates.best(&values, independent, candidates.exponentials());
        for width in [1.6, 1.1] {
            let Some(time_s) = exponential.1.time_s() else {
                break;
            };
            let finer = about(time_s / width, time_s * width);
            exponential = finer.best(&values, independent, finer.exponentials());
        }
        match exponential {
            (criterion, model) if model.time_s().is_some() && criterion < polynomial.0 => model,
            _ => polynomial.1,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn with_drift(drift: impl Fn(f64) -> f64) -> Signal {
        let time_s: Vec<f64> = (0..600).map(|i| 0.02 * f64::from(i)).collect();
        let noise = |i: usize| 2e-3 * (12.9 * (i as f64 + 1.0).powf(1.7)).sin();
        let approach = |(i, t): (usize, &f64)| 3.0 + (TAU * t).sin() + drift(*t) + noise(i);
        Signal {
            load_n: time_s.iter().map(|t| 1.0 + (TAU * t).cos()).collect(),
            approach_m: time_s.iter().enumerate().map(approach).collect(),
            time_s,
            contact_radius_m: None,
        }
    }

    fn found(signal: &Signal) -> DriftModel {
        select(signal, &Span::of(signal), TAU, 5)[1]
    }

    #[test]
    fn the_drift_that_is_there_is_the_one_that_is_found() {
        assert_eq!(found(&with_drift(|_| 0.0)), DriftModel::None);
        let line = with_drift(|t| 0.01 * t);
        assert_eq!(found(&line), DriftModel::Polynomial { degree: 1 });
        let bent = with_drift(|t| 0.01 * t - 1e-3 * t * t);
        assert_eq!(found(&bent), DriftModel::Polynomial { degree: 2 });
        let decaying = found(&with_drift(|t| 0.3 * (-t / 2.0).exp()));
        let DriftModel::Exponential { time_s } = decaying else {
            panic!("{decaying:?}")
        };
        // The grid of time constants ends at 2 %.
        assert!((time_s / 2.0 - 1.0).abs() < 0.05, "{time_s}");
    }

    #[test]
    fn polynomials_begin_at_zero() {
        assert_eq!(polynomials(-1.0), [0.0; DEGREE]);
        let span = Span {
            first_s: 1.0,
            last_s: 3.0,
        };
        let drift = Drift::new(DriftModel::Polynomial { degree: 2 }, &[0.5, 0.0], span);
        assert_eq!(
            (drift.at(1.0), drift.at(3.0), drift.change),
            (0.0, 1.0, 1.0)
        );
    }
}
