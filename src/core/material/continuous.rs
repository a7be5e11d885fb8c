//! The continuous relaxation spectrum H(tau) of measured moduli, relaxation or creep, with its band.
//!
//! ```text
//! E(t) = E_inf + integral of H(tau) exp(-t/tau) d ln tau
//! ```
//!
//! Unknown are the logarithms of H on an even grid of ln tau, and that of E_inf. Sought is the maximum of the posterior: data with normal
//! noise, and a prior by which the curvature of ln H is normal too, with a strength lambda. Lambda itself is weighed by the evidence, the
//! probability of the data given lambda, in the approximation of P. S. Laplace (D. J. C. MacKay, Neural Computation 4 (1992) 415; for
//! relaxation spectra J. Honerkamp and J. Weese, Rheologica Acta 32 (1993) 65). The band holds the covariance of the posterior, and what
//! other lambdas make of the spectrum, each by its evidence. A prior of smoothness makes the lines of a body of a few branches into bumps.
//!
//! The grid has five points per decade: with h between neighbours in ln tau, sums over it ripple by 2 exp(-pi^2/h), which is 1e-9, while
//! one branch per decade ripples by 3 %.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::dynamic::DynamicPoint;
use super::dynamic::prony::PronyFit;
use super::fit::Fit;
use super::relaxation::{Relaxation, RelaxationBranch};
use super::tabulated::Tabulated;
use super::{MaterialError, MaterialFunction};
use crate::numerics::levenberg_marquardt::{
    Ending, Problem, Solution, central_difference, minimise,
};

/// Points of the grid per decade of the relaxation time, and how many decades it goes beyond the data at both ends.
const PER_DECADE: f64 = 5.0;
const BEYOND: f64 = 1.0;

/// Strengths of the prior that are tried: powers of ten in these steps.
const STRENGTHS: (f64, f64) = (-2.0, 0.5);
const COUNT: usize = 15;

const ENDING: Ending = Ending {
    iterations: 60,
    enough: 1e-6,
};

/// Half the width of a band of 95 %, in standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// How far logarithms of moduli (Pa) may go.
const LIMITS: (f64, f64) = (-40.0, 60.0);

/// Less noise than this is not believed.
const LEAST_NOISE: f64 = 2e-4;

/// A modulus at a time, of the times per unit of ln tau.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectrumPoint {
    pub time_s: f64,
    /// H, and the ends of its 95 % band at this time alone (Pa).
    pub spectrum_pa: f64,
    pub low_pa: f64,
    pub high_pa: f64,
}

/// A continuous spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    pub points: Vec<SpectrumPoint>,
    pub equilibrium_pa: f64,
    /// The shortest and longest time (s) of the data: outside, the spectrum is an extrapolation.
    pub window_s: (f64, f64),
    /// The strength of the prior that is most likely.
    pub strength: f64,
    /// Sum of squared residuals in their standard deviations, over the number of data.
    pub mean_square: f64,
}

impl Spectrum {
    /// As a series, a branch for every point.
    ///
    /// # Errors
    /// As [`Relaxation::new`].
    pub fn series(&self) -> Result<Relaxation, MaterialError> {
        let step = step();
        let branches = self.points.iter().map(|point| RelaxationBranch {
            modulus_pa: step * point.spectrum_pa,
            time_s: point.time_s,
        });
        let largest = self
            .points
            .iter()
            .map(|p| p.spectrum_pa)
            .fold(0.0, f64::max);
        let counts = |b: &RelaxationBranch| b.modulus_pa > 1e-9 * step * largest;
        let equilibrium_pa = match self.equilibrium_pa > 1e-9 * largest {
            true => self.equilibrium_pa,
            false => 0.0,
        };
        Relaxation::new(equilibrium_pa, branches.filter(counts).collect())
    }
}

/// Between neighbours, in ln tau.
fn step() -> f64 {
    std::f64::consts::LN_10 / PER_DECADE
}

/// The spectrum of points to which a series was fitted; `None` where none could be fitted.
pub fn of_moduli(points: &[DynamicPoint], fit: &PronyFit) -> Option<Spectrum> {
    let (lowest, highest) = fit.window_rad_per_s;
    let times_s = grid((1.0 / highest, 1.0 / lowest));
    let step = step();
    let mut rows = Vec::with_capacity(2 * points.len());
    for point in points {
        let omega = point.angular_frequency_rad_per_s;
        let deviations_pa = fit.deviations_pa(point, LEAST_NOISE);
        let values = [point.storage_modulus_pa, point.loss_modulus_pa];
        for (part, (value, deviation_pa)) in values.into_iter().zip(deviations_pa).enumerate() {
            let is_loss = part == 1;
            let kernel = times_s.iter().map(|time_s| {
                let x = omega * time_s;
                let loss = 1.0 / (x + 1.0 / x);
                step * if is_loss { loss } else { x * loss }
            });
            let constant = if is_loss { 0.0 } else { 1.0 };
            rows.push((kernel.chain([constant]).collect(), value, deviation_pa));
        }
    }
    found(
        &Data::linear(&rows),
        &times_s,
        fit.window_rad_per_s,
        &fit.relaxation,
    )
}

/// The spectrum of a table to which a series was fitted; `None` where none could be fitted.
pub fn of_table(table: &Tabulated, fit: &Fit) -> Option<Spectrum> {
    let (first_s, last_s) = table.window_s();
    let times_s = grid((first_s, last_s));
    let free = 1.0 - 2.0 * fit.report().branches as f64 / fit.report().samples.max(1) as f64;
    let noise = fit.report().misfit.rms / free.max(0.1).sqrt();
    let noise = noise.max(LEAST_NOISE);
    let samples = table.times_s().iter().zip(table.values());
    let samples: Vec<(f64, f64)> = samples.map(|(t, v)| (*t, *v)).collect();
    let own = fit.relaxation()?;
    let window_rad_per_s = (1.0 / last_s, 1.0 / first_s);
    let data = match table.function() {
        MaterialFunction::Relaxation => {
            let row = |(t, value): &(f64, f64)| {
                let kernel = times_s.iter().map(|time_s| step() * (-t / time_s).exp());
                (kernel.chain([1.0]).collect(), *value, noise * value)
            };
            Data::linear(&samples.iter().map(row).collect::<Vec<_>>())
        }
        MaterialFunction::Creep => Data::Creep {
            samples,
            noise,
            times_s: times_s.clone(),
        },
    };
    found(&data, &times_s, window_rad_per_s, &own)
}

/// Relaxation times (s) over those of the data and beyond.
fn grid((shortest_s, longest_s): (f64, f64)) -> Vec<f64> {
    let (from, to) = (shortest_s.log10() - BEYOND, longest_s.log10() + BEYOND);
    let count = ((to - from) * PER_DECADE).ceil() as i32;
    (0..=count)
        .map(|k| 10_f64.powf(from + f64::from(k) / PER_DECADE))
        .collect()
}

/// What is measured, as a function of H on the grid and of E_inf behind it.
enum Data {
    /// A matrix, each row over the standard deviation of its number, and the numbers over theirs.
    Linear(DMatrix<f64>, DVector<f64>),
    /// Compliances (1/Pa) at times (s), with relative noise, on a grid of times.
    Creep {
        samples: Vec<(f64, f64)>,
        noise: f64,
        times_s: Vec<f64>,
    },
}

impl Data {
    /// Of rows of a kernel, each with its number and its standard deviation.
    fn linear(rows: &[(Vec<f64>, f64, f64)]) -> Self {
        let columns = rows.first().map_or(0, |(kernel, ..)| kernel.len());
        let matrix = DMatrix::from_fn(rows.len(), columns, |i, j| rows[i].0[j] / rows[i].2);
        let right = rows.iter().map(|(_, value, sigma)| value / sigma);
        Self::Linear(matrix, DVector::from_iterator(rows.len(), right))
    }

    fn count(&self) -> usize {
        match self {
            Self::Linear(_, right) => right.len(),
            Self::Creep { samples, .. } => samples.len(),
        }
    }

    /// Residuals in their standard deviations.
    fn residuals(&self, unknowns: &[f64]) -> Option<DVector<f64>> {
        match self {
            Self::Linear(matrix, right) => {
                let moduli =
                    DVector::from_iterator(unknowns.len(), unknowns.iter().map(|u| u.exp()));
                Some(matrix * moduli - right)
            }
            Self::Creep {
                samples,
                noise,
                times_s,
            } => {
                let (equilibrium, moduli) = unknowns.split_last()?;
                let branches = moduli.iter().zip(times_s);
                let branches = branches.map(|(ln, time_s)| RelaxationBranch {
                    modulus_pa: step() * ln.exp(),
                    time_s: *time_s,
                });
                let series = Relaxation::new(equilibrium.exp(), branches.collect()).ok()?;
                let creep = series.to_creep().ok()?;
                let off = samples
                    .iter()
                    .map(|(t, value)| (creep.compliance(*t) / value).ln() / noise);
                Some(DVector::from_iterator(samples.len(), off))
            }
        }
    }

    /// Derivatives of the residuals.
    fn derivatives(&self, unknowns: &[f64]) -> Option<DMatrix<f64>> {
        const STEP: f64 = 1e-4;
        if let Self::Linear(matrix, _) = self {
            let mut derivatives = matrix.clone();
            for (mut column, unknown) in derivatives.column_iter_mut().zip(unknowns) {
                column *= unknown.exp();
            }
            return Some(derivatives);
        }
        let residuals = |moved: Vec<f64>| self.residuals(&moved);
        let column = |place: usize| central_difference(unknowns, place, STEP, &residuals);
        let columns: Option<Vec<DVector<f64>>> =
            (0..unknowns.len()).into_par_iter().map(column).collect();
        Some(DMatrix::from_columns(&columns?))
    }
}

/// The posterior of one strength of the prior, as a least squares problem.
struct Posterior<'a> {
    data: &'a Data,
    strength: f64,
}

/// The curvature of ln H at an inner point of the grid.
fn curvature(unknowns: &[f64], place: usize) -> f64 {
    (unknowns[place] - 2.0 * unknowns[place + 1] + unknowns[place + 2]) / step().powi(2)
}

/// How many curvatures so many unknowns have, of which the last is E_inf.
fn curvatures(unknowns: usize) -> usize {
    unknowns.saturating_sub(3)
}

impl Problem for Posterior<'_> {
    type Unknowns = Vec<f64>;

    fn residuals(&self, unknowns: &Vec<f64>) -> Option<DVector<f64>> {
        let of_data = self.data.residuals(unknowns)?;
        let (scale, count) = (self.strength.sqrt(), curvatures(unknowns.len()));
        let of_prior = (0..count).map(|place| scale * curvature(unknowns, place));
        let all: Vec<f64> = of_data.iter().copied().chain(of_prior).collect();
        let is_finite = all.iter().all(|r| r.is_finite());
        is_finite.then(|| DVector::from_vec(all))
    }

    fn derivatives(&self, unknowns: &Vec<f64>) -> Option<DMatrix<f64>> {
        let of_data = self.data.derivatives(unknowns)?;
        let (rows, count) = (of_data.nrows(), curvatures(unknowns.len()));
        let mut all = of_data.resize_vertically(rows + count, 0.0);
        let scale = self.strength.sqrt() / step().powi(2);
        for place in 0..count {
            for (column, weight) in [(0, 1.0), (1, -2.0), (2, 1.0)] {
                all[(rows + place, place + column)] = weight * scale;
            }
        }
        Some(all)
    }

    fn clamp(&self, _: usize, value: f64) -> f64 {
        value.clamp(LIMITS.0, LIMITS.1)
    }
}

/// The maximum of a posterior, with the variances of its unknowns and the logarithm of its evidence.
struct Maximum {
    strength: f64,
    unknowns: Vec<f64>,
    variances: Vec<f64>,
    ln_evidence: f64,
    mean_square: f64,
}

impl Posterior<'_> {
    fn maximum(&self, solution: Solution<Vec<f64>>) -> Option<Maximum> {
        let derivatives = self.derivatives(&solution.unknowns)?;
        let unknowns = solution.unknowns.len();
        // An equilibrium modulus of nothing has no curvature.
        let curvature =
            derivatives.tr_mul(&derivatives) + DMatrix::identity(unknowns, unknowns) * 1e-8;
        let factor = curvature.cholesky()?;
        let ln_determinant: f64 = factor
            .l_dirty()
            .diagonal()
            .iter()
            .map(|d| 2.0 * d.ln())
            .sum();
        let rank = curvatures(unknowns) as f64;
        let count = self.data.count();
        Some(Maximum {
            strength: self.strength,
            variances: factor.inverse().diagonal().iter().copied().collect(),
            ln_evidence: 0.5 * (rank * self.strength.ln() - ln_determinant - solution.squares()),
            mean_square: solution.residuals.rows(0, count).norm_squared() / count as f64,
            unknowns: solution.unknowns,
        })
    }
}

fn found(
    data: &Data,
    times_s: &[f64],
    window_rad_per_s: (f64, f64),
    own: &Relaxation,
) -> Option<Spectrum> {
    let mut start = started(times_s, own);
    let mut all: Vec<Maximum> = Vec::new();
    for power in (0..COUNT).rev() {
        let strength = 10_f64.powf(STRENGTHS.0 + STRENGTHS.1 * power as f64);
        let posterior = Posterior { data, strength };
        let Some(solution) = minimise(&posterior, &start, ENDING) else {
            continue;
        };
        start.clone_from(&solution.unknowns);
        all.extend(posterior.maximum(solution));
    }
    let best = all
        .iter()
        .max_by(|a, b| a.ln_evidence.total_cmp(&b.ln_evidence))?;
    let weight = |of: &Maximum| (of.ln_evidence - best.ln_evidence).exp();
    let sum: f64 = all.iter().map(weight).sum();
    // Where even the most likely spectrum misses the data, the noise is what it leaves.
    let wider = best.mean_square.max(1.0);
    let points = times_s.iter().enumerate().map(|(k, time_s)| {
        let spread = all.iter().map(|of| {
            let apart = of.unknowns[k] - best.unknowns[k];
            weight(of) / sum * (wider * of.variances[k] + apart * apart)
        });
        let half = (HALF_WIDTH * spread.sum::<f64>().sqrt()).min(LIMITS.1);
        let ln = best.unknowns[k];
        SpectrumPoint {
            time_s: *time_s,
            spectrum_pa: ln.exp(),
            low_pa: (ln - half).exp(),
            high_pa: (ln + half).exp(),
        }
    });
    Some(Spectrum {
        points: points.collect(),
        equilibrium_pa: best.unknowns.last()?.exp(),
        window_s: (1.0 / window_rad_per_s.1, 1.0 / window_rad_per_s.0),
        strength: best.strength,
        mean_square: best.mean_square,
    })
}

/// Where a search begins: a spectrum as high as the moduli of the branches of a series, smoothed.
fn started(times_s: &[f64], own: &Relaxation) -> Vec<f64> {
    let scale = own.complex_modulus(1.0 / times_s[times_s.len() / 2]).norm();
    // The slope of E' over ln omega is H to first order.
    let height = |time_s: &f64| {
        let storage = |factor: f64| own.complex_modulus(factor / time_s).re;
        let slope = (storage(2.0) - storage(0.5)) / 4_f64.ln();
        slope.max(1e-4 * scale).ln()
    };
    let equilibrium = own.equilibrium_modulus().max(1e-6 * scale).ln();
    times_s.iter().map(height).chain([equilibrium]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::ModulusKind;
    use crate::material::dynamic::prony;
    use crate::material::fit::fit;
    use crate::material::synthetic::{Noise, log_spaced};

    /// A broad spectrum of two bumps, and its series on a grid far finer than the one that is sought.
    struct Truth {
        bumps: [(f64, f64, f64); 2],
        equilibrium_pa: f64,
    }

    impl Truth {
        fn random(noise: &mut Noise) -> Self {
            let mut bump = |low: f64, high: f64| {
                let place = low + (high - low) * noise.uniform();
                let width = 0.7 + 1.0 * noise.uniform();
                (place, width, 1e7 * 10_f64.powf(noise.uniform()))
            };
            Self {
                bumps: [bump(-3.0, -0.5), bump(-0.5, 2.0)],
                equilibrium_pa: 1e6 * 10_f64.powf(noise.uniform()),
            }
        }

        fn spectrum_pa(&self, time_s: f64) -> f64 {
            let bump = |(place, width, height): &(f64, f64, f64)| {
                height * (-((time_s.log10() - place) / width).powi(2)).exp()
            };
            self.bumps.iter().map(bump).sum()
        }

        fn series(&self) -> Relaxation {
            let branches = log_spaced(1e-9, 1e8, 8)
                .into_iter()
                .map(|time_s| RelaxationBranch {
                    modulus_pa: std::f64::consts::LN_10 / 8.0 * self.spectrum_pa(time_s),
                    time_s,
                });
            Relaxation::new(
                self.equilibrium_pa,
                branches.filter(|b| b.modulus_pa > 0.0).collect(),
            )
            .unwrap()
        }
    }

    /// Points of the window inside the band, and of how many.
    fn inside(found: &Spectrum, truth: &Truth) -> (usize, usize) {
        let (first, last) = found.window_s;
        let points = found.points.iter();
        let within = points.filter(|p| p.time_s > first && p.time_s < last);
        let is_inside =
            |p: &&SpectrumPoint| (p.low_pa..=p.high_pa).contains(&truth.spectrum_pa(p.time_s));
        (within.clone().filter(is_inside).count(), within.count())
    }

    #[test]
    fn spectra_of_moduli_relaxation_and_creep_lie_in_their_bands() {
        let (mut counts, mut creeps) = ((0, 0), (0, 0));
        for seed in 0..8 {
            let mut noise = Noise::stream(3, seed);
            let truth = Truth::random(&mut noise);
            let series = truth.series();
            let points = log_spaced(1e-2, 1e3, 8).into_iter().map(|omega| {
                let modulus = series.complex_modulus(omega);
                DynamicPoint {
                    temperature_k: None,
                    angular_frequency_rad_per_s: omega,
                    storage_modulus_pa: modulus.re * (1.0 + 0.02 * noise.normal()),
                    loss_modulus_pa: modulus.im * (1.0 + 0.02 * noise.normal()),
                    errors_pa: None,
                }
            });
            let points: Vec<DynamicPoint> = points.collect();
            let made = prony::fit(&points, None).unwrap();
            let found = of_moduli(&points, &made).unwrap();
            let (within, of) = inside(&found, &truth);
            counts = (counts.0 + within, counts.1 + of);
            // The material of it has neither ripple nor more error than the noise allows.
            for omega in log_spaced(2e-2, 5e2, 16) {
                let own = found.series().unwrap().complex_modulus(omega);
                let exact = series.complex_modulus(omega);
                assert!(
                    (own.im / exact.im - 1.0).abs() < 0.06,
                    "{seed} {omega}: {}",
                    own.im / exact.im
                );
                assert!(
                    (own.re / exact.re - 1.0).abs() < 0.04,
                    "{seed} {omega}: {}",
                    own.re / exact.re
                );
            }
            if seed >= 3 {
                continue;
            }
            let creep = series.to_creep().unwrap();
            for function in [MaterialFunction::Relaxation, MaterialFunction::Creep] {
                let times = log_spaced(1e-3, 1e2, 12);
                let values = times.iter().map(|t| {
                    let exact = match function {
                        MaterialFunction::Relaxation => series.modulus(*t),
                        MaterialFunction::Creep => creep.compliance(*t),
                    };
                    exact * (1.0 + 0.005 * noise.normal())
                });
                let values = values.collect();
                let table = Tabulated::new(function, ModulusKind::Shear, times, values).unwrap();
                let found = of_table(&table, &fit(&table, None).unwrap()).unwrap();
                let (within, of) = inside(&found, &truth);
                creeps = (creeps.0 + within, creeps.1 + of);
            }
        }
        assert!(counts.0 as f64 > 0.9 * counts.1 as f64, "{counts:?}");
        assert!(creeps.0 as f64 > 0.9 * creeps.1 as f64, "{creeps:?}");
    }
}
