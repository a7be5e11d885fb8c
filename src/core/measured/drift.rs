//! What moves a signal besides its oscillation: thermal drift, creep towards a mean. A polynomial or an exponential, whichever the
//! data speak for.

use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use super::Signal;
use super::frequency::{Fit, RecordModel};
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
    pub(super) fn fill(self, row: &mut [f64], span: &Span, time_s: f64) {
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

/// The drift of a signal at a known frequency: of none, polynomials and exponentials that with the largest evidence (Bayesian
/// information criterion), where correlated noise counts as fewer samples.
pub(super) fn select(model: &RecordModel, times_s: &[f64], values: &[f64]) -> DriftModel {
    let duration_s = model.span.duration_s();
    let period_s = std::f64::consts::TAU / model.angular;
    let cycles = (duration_s / period_s).round() as usize;
    let degree = cycles.saturating_sub(1).clamp(1, DEGREE);
    let polynomials = (0..=degree).map(|degree| match degree {
        0 => DriftModel::None,
        degree => DriftModel::Polynomial { degree },
    });
    let fitted = polynomials.map(|drift| (drift, model.fit(times_s, values, drift)));
    let fitted: Vec<(DriftModel, Option<Fit>)> = fitted.collect();
    let Some((_, Some(richest))) = fitted.last() else {
        return DriftModel::None;
    };
    let phi = correlation(richest.residual.as_slice());
    let independent = (times_s.len() as f64 * (1.0 - phi) / (1.0 + phi)).max(4.0);
    // Less is better. A time constant is a coefficient too; of an exact record rounding is left.
    let criterion = |drift: DriftModel, unexplained: f64| {
        let size = drift.size() + usize::from(drift.time_s().is_some());
        independent * unexplained.max(1e-13).ln() + size as f64 * independent.ln()
    };
    let of_fit = |(drift, fit): &(DriftModel, Option<Fit>)| {
        Some((criterion(*drift, fit.as_ref()?.unexplained), *drift))
    };
    let Some(polynomial) = evident(fitted.iter().filter_map(of_fit)) else {
        return DriftModel::None;
    };
    if polynomial.1 == DriftModel::None {
        return DriftModel::None;
    }
    let function = |time_s: f64| {
        let since_s = times_s.iter().map(|time| time - model.span.first_s);
        DVector::from_iterator(times_s.len(), since_s.map(|since| (-since / time_s).exp()))
    };
    let longest_s = 3.0 * duration_s;
    // Beside nothing or beside a line: the best time constant of a grid, then of finer ones about it.
    let kinds: [fn(f64) -> DriftModel; 2] = [
        |time_s| DriftModel::Exponential { time_s },
        |time_s| DriftModel::ExponentialAndLine { time_s },
    ];
    let exponentials = fitted.iter().zip(kinds).filter_map(|((_, beside), kind)| {
        let beside = beside.as_ref()?;
        let of_time = |time_s: f64| {
            let function = function(time_s);
            Some((
                criterion(kind(time_s), beside.unexplained_with(&function)?),
                time_s,
            ))
        };
        let best = |from_s: f64, to_s: f64| {
            let times_s = grid::in_steps(from_s, to_s.min(longest_s), TIMES - 1);
            let tried = times_s.into_iter().filter_map(of_time);
            tried.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let found = best(0.5 * period_s, longest_s)?;
        let found = best(found.1 / 1.6, found.1 * 1.6)?;
        let (criterion, time_s) = best(found.1 / 1.1, found.1 * 1.1)?;
        Some((criterion, kind(time_s)))
    });
    let none = fitted.first().and_then(of_fit);
    match evident(none.into_iter().chain(exponentials)) {
        Some((criterion, drift)) if drift.time_s().is_some() && criterion < polynomial.0 => drift,
        _ => polynomial.1,
    }
}

/// The best of these drifts, of which a later one must be better by strong evidence.
fn evident(drifts: impl Iterator<Item = (f64, DriftModel)>) -> Option<(f64, DriftModel)> {
    drifts.reduce(|best, next| {
        if next.0 < best.0 - EVIDENCE {
            next
        } else {
            best
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
        let model = RecordModel::with_parabolas(signal, TAU, 5);
        select(&model, &signal.time_s, &signal.approach_m)
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
