//! What moves a signal besides its oscillation: thermal drift, creep towards a mean. A polynomial or an exponential, whichever the
//! data speak for.

use serde::{Deserialize, Serialize};

use super::Signal;
use super::least_squares::{Design, Normal, harmonic_columns};
use super::noise::correlation;

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

/// Samples at these times (s) as a linear model: mean and harmonics, then the columns of the drifts one after another.
pub(super) fn design(
    times_s: &[f64],
    span: &Span,
    (angular, harmonics): (f64, usize),
    drifts: &[DriftModel],
) -> Design {
    let sizes = drifts.iter().map(|drift| drift.size());
    let mut design = Design::new(1 + 2 * harmonics + sizes.sum::<usize>(), times_s.len());
    for time_s in times_s {
        design.push(|row| {
            let mut from = harmonic_columns(row, angular * (time_s - span.first_s), harmonics);
            for drift in drifts {
                let to = from + drift.size();
                drift.fill(&mut row[from..to], span, *time_s);
                from = to;
            }
        });
    }
    design
}

/// Candidates side by side: all their columns in one design.
struct Candidates {
    design: Design,
    gram: nalgebra::DMatrix<f64>,
    /// Columns that all have: mean and harmonics.
    common: usize,
    times_s: Vec<f64>,
}

impl Candidates {
    fn new(
        signal: &Signal,
        span: &Span,
        angular: f64,
        harmonics: usize,
        times_s: Vec<f64>,
    ) -> Self {
        let mut all = vec![DriftModel::Polynomial { degree: DEGREE }];
        all.extend(
            times_s
                .iter()
                .map(|&time_s| DriftModel::Exponential { time_s }),
        );
        let design = design(&signal.time_s, span, (angular, harmonics), &all);
        Self {
            gram: design.gram(),
            design,
            common: 1 + 2 * harmonics,
            times_s,
        }
    }

    /// Exponentials of all time constants, then those with a line.
    fn exponentials(&self) -> impl Iterator<Item = DriftModel> + '_ {
        let times = || self.times_s.iter().copied();
        let alone = times().map(|time_s| DriftModel::Exponential { time_s });
        alone.chain(times().map(|time_s| DriftModel::ExponentialAndLine { time_s }))
    }

    /// Columns of a model; `None` for a time constant that is not among those tried.
    fn columns(&self, model: DriftModel) -> Option<Vec<usize>> {
        let first = self.common;
        let exponential = |time_s: f64| {
            let found = self.times_s.iter().position(|time| *time == time_s);
            found.map(|k| first + DEGREE + k)
        };
        let own: Vec<usize> = match model {
            DriftModel::None => Vec::new(),
            DriftModel::Polynomial { degree } => (first..first + degree).collect(),
            DriftModel::Exponential { time_s } => vec![exponential(time_s)?],
            DriftModel::ExponentialAndLine { time_s } => vec![exponential(time_s)?, first],
        };
        Some((0..first).chain(own).collect())
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
    let cycles = span.duration_s() / period_s;
    let degree = DEGREE
        .min((cycles.round() as usize).saturating_sub(1))
        .max(1);
    let (shortest_s, longest_s) = (0.5 * period_s, 3.0 * span.duration_s());
    let times_s = logarithmic(shortest_s, longest_s, TIMES);
    let candidates = Candidates::new(signal, span, angular, harmonics, times_s);
    [&signal.load_n, &signal.approach_m].map(|values| {
        let Some(search) = Search::new(&candidates, values, degree) else {
            return DriftModel::None;
        };
        let polynomials = (1..=degree).map(|degree| DriftModel::Polynomial { degree });
        let polynomial = search.best(&candidates, polynomials);
        if matches!(polynomial.1, DriftModel::None) {
            return DriftModel::None;
        }
        // Between two of the time constants lies one that may be better than any polynomial.
        let coarse = search.best(&candidates, candidates.exponentials());
        let finer = coarse.1.time_s().and_then(|time_s| {
            let about = (time_s, longest_s);
            finer(signal, span, (angular, harmonics), about, (values, &search))
        });
        match finer {
            Some((criterion, model)) if criterion < polynomial.0 => model,
            _ => polynomial.1,
        }
    })
}

fn logarithmic(from: f64, to: f64, points: usize) -> Vec<f64> {
    let ratio = (to / from).ln() / (points.max(2) - 1) as f64;
    (0..points)
        .map(|k| from * (ratio * k as f64).exp())
        .collect()
}

/// The time constant of an exponential between the neighbours of one that is about right, and its criterion.
fn finer(
    signal: &Signal,
    span: &Span,
    (angular, harmonics): (f64, usize),
    (about_s, longest_s): (f64, f64),
    (values, search): (&[f64], &Search),
) -> Option<(f64, DriftModel)> {
    let mut about_s = about_s;
    let mut best = None;
    for width in [1.6, 1.1] {
        let (from, to) = (about_s / width, (about_s * width).min(longest_s));
        let times_s = logarithmic(from, to, TIMES);
        let candidates = Candidates::new(signal, span, angular, harmonics, times_s);
        let search = Search {
            independent: search.independent,
            ..Search::new(&candidates, values, 1)?
        };
        let found = search.best(&candidates, candidates.exponentials());
        about_s = found.1.time_s()?;
        best = Some(found);
    }
    best
}

/// What is needed to compare candidates on one signal.
struct Search {
    right: nalgebra::DVector<f64>,
    /// Sum of the squares of the signal without its mean.
    squares: f64,
    /// Samples that count as independent.
    independent: f64,
}

impl Search {
    fn new(candidates: &Candidates, values: &[f64], degree: usize) -> Option<Self> {
        // Without the mean, so that nothing is lost to cancellation.
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let centered = || values.iter().map(|value| value - mean);
        let right = candidates.design.with(centered());
        let squares = centered().map(|value| value * value).sum();
        let richest = candidates.columns(DriftModel::Polynomial { degree })?;
        let normal = Normal::new(&candidates.gram, richest)?;
        let coefficients = normal.solve(&right);
        let model = candidates.design.model(&coefficients);
        let residual: Vec<f64> = centered().zip(model).map(|(y, m)| y - m).collect();
        let phi = correlation(&residual);
        Some(Self {
            right,
            squares,
            independent: (residual.len() as f64 * (1.0 - phi) / (1.0 + phi)).max(4.0),
        })
    }

    /// The best of these, or no drift; with its criterion. A later one must be better by strong evidence, but among those of one
    /// size.
    fn best(
        &self,
        candidates: &Candidates,
        models: impl Iterator<Item = DriftModel>,
    ) -> (f64, DriftModel) {
        let none = DriftModel::None;
        let mut best = (self.criterion(candidates, none), none);
        for model in models {
            let criterion = self.criterion(candidates, model);
            let is_larger = model.size() != best.1.size();
            let needed = if is_larger { EVIDENCE } else { 0.0 };
            if criterion < best.0 - needed {
                best = (criterion, model);
            }
        }
        best
    }

    /// Smaller is better.
    fn criterion(&self, candidates: &Candidates, model: DriftModel) -> f64 {
        let normal = candidates
            .columns(model)
            .and_then(|c| Normal::new(&candidates.gram, c));
        let Some(normal) = normal else {
            return f64::INFINITY;
        };
        // What rounding leaves of an exact record.
        let left = (self.squares - normal.explained(&self.right)).max(1e-13 * self.squares);
        // A time constant is a coefficient too.
        let size = model.size() + usize::from(model.time_s().is_some());
        self.independent * left.ln() + size as f64 * self.independent.ln()
    }
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
