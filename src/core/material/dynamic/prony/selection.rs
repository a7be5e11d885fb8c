//! Few branches in place of a spectrum: neighbours merged, times and moduli refined together, and branches taken away as long
//! as the criterion falls.

use nalgebra::{DMatrix, DVector};

use super::rows::{Rows, SPECTRUM, Series};
use crate::material::branches::{MANY, TRIED, fewer, halved, merge_runs};
use crate::material::harmonic::Debye;

/// Iterations of a refinement, and the decrease of chi squared at which it ends: while branches are counted, and at the end.
const ROUGHLY: (usize, f64) = (15, 0.05);
const CLOSELY: (usize, f64) = (100, 1e-6);

/// Ridge of the quick comparison of candidates, beside columns of unit length.
const RIDGE: f64 = 1e-12;

/// What is fitted, and within which limits of the times (s).
pub(super) struct Selection<'a> {
    pub(super) rows: &'a Rows,
    pub(super) limits_s: (f64, f64),
}

impl Selection<'_> {
    /// From a spectrum to the series of the lowest score that is met while branches are taken away.
    pub(super) fn fewest(&self, spectrum: &Series) -> Series {
        let mut best = self.refined(&runs_merged(spectrum), ROUGHLY);
        while best.branches.len() >= MANY {
            let half = self.refined(&best.with(halved(&best.branches)), ROUGHLY);
            if self.score(&half) > self.score(&best) {
                break;
            }
            best = half;
        }
        while let Some(simpler) = self.simpler(&best) {
            if self.score(&simpler) > self.score(&best) {
                break;
            }
            best = simpler;
        }
        self.refined(&best, CLOSELY)
    }

    /// A series of at most so many branches: those of the spectrum taken away one by one, or evenly spaced times, whichever
    /// fits better.
    pub(super) fn at_most(&self, spectrum: &Series, even: &Series, branches: usize) -> Series {
        let mut reduced = self.refined(&runs_merged(spectrum), ROUGHLY);
        while reduced.branches.len() > branches {
            match self.simpler(&reduced) {
                Some(simpler) => reduced = simpler,
                None => break,
            }
        }
        let reduced = self.refined(&reduced, CLOSELY);
        let even = self.refined(even, CLOSELY);
        match self.rows.chi_squared(&even) < self.rows.chi_squared(&reduced) {
            true => even,
            false => reduced,
        }
    }

    /// The criterion of H. Akaike with the correction for few data (C. M. Hurvich and C.-L. Tsai, Biometrika 76 (1989) 297),
    /// the noise being known: lower is better.
    fn score(&self, series: &Series) -> f64 {
        let (count, parameters) = (self.rows.count() as f64, series.parameters() as f64);
        let free = count - parameters - 1.0;
        if free <= 0.0 {
            return f64::INFINITY;
        }
        self.rows.chi_squared(series) + 2.0 * parameters * (1.0 + (parameters + 1.0) / free)
    }

    /// The best series with a branch less.
    fn simpler(&self, series: &Series) -> Option<Series> {
        let mut candidates: Vec<(f64, Series)> = fewer(&series.branches)
            .map(|branches| series.with(branches))
            .filter(|candidate| candidate.strengths() > 0)
            .map(|candidate| (self.quick_squares(&candidate), candidate))
            .collect();
        candidates.sort_by(|left, right| left.0.total_cmp(&right.0));
        let tried = candidates.into_iter().take(TRIED);
        tried
            .map(|(_, candidate)| self.refined(&candidate, ROUGHLY))
            .min_by(|left, right| {
                let squares = |series: &Series| self.rows.chi_squared(series);
                squares(left).total_cmp(&squares(right))
            })
    }

    /// Chi squared with the best moduli of either sign at these times.
    fn quick_squares(&self, series: &Series) -> f64 {
        let linear = Linear::new(self.rows, series, false);
        let right = linear.matrix.tr_mul(&linear.values);
        let mut normal = linear.matrix.tr_mul(&linear.matrix);
        for place in 0..normal.ncols() {
            normal[(place, place)] *= 1.0 + RIDGE;
        }
        normal.cholesky().map_or(f64::INFINITY, |factors| {
            linear.values.norm_squared() - right.dot(&factors.solve(&right))
        })
    }

    /// Times and moduli improved together (K. Levenberg 1944, D. W. Marquardt 1963), in their logarithms.
    fn refined(&self, series: &Series, (iterations, enough): (usize, f64)) -> Series {
        let mut best = series.clone();
        let mut squares = self.rows.chi_squared(&best);
        let mut damping = 1e-2;
        for _ in 0..iterations {
            let linear = Linear::new(self.rows, &best, true);
            let gradient = linear.matrix.tr_mul(&linear.residuals);
            let normal = linear.matrix.tr_mul(&linear.matrix);
            let mut settled = true;
            while damping < 1e8 {
                let trial = step(&normal, &gradient, damping).map(|step| self.moved(&best, &step));
                let trial = trial.map(|trial| (self.rows.chi_squared(&trial), trial));
                match trial {
                    Some((lower, trial)) if lower < squares => {
                        settled = squares - lower < enough;
                        (best, squares) = (trial, lower);
                        damping = (0.1 * damping).max(1e-9);
                        break;
                    }
                    _ => damping *= 10.0,
                }
            }
            if settled {
                break;
            }
        }
        best.branches
            .sort_by(|left, right| left.time_s.total_cmp(&right.time_s));
        best
    }

    fn moved(&self, series: &Series, step: &DVector<f64>) -> Series {
        // A factor of e at a time: the linearisation means nothing farther out.
        let factor = |step: f64| step.clamp(-1.0, 1.0).exp();
        let mut moved = series.clone();
        let first = usize::from(series.constant > 0.0);
        if first == 1 {
            moved.constant *= factor(step[0]);
        }
        let count = series.branches.len();
        for (number, branch) in moved.branches.iter_mut().enumerate() {
            branch.strength *= factor(step[first + number]);
            let time_s = branch.time_s * factor(step[first + count + number]);
            branch.time_s = time_s.clamp(self.limits_s.0, self.limits_s.1);
        }
        moved
    }
}

/// The damped step.
fn step(normal: &DMatrix<f64>, gradient: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
    let mut damped = normal.clone();
    for place in 0..damped.ncols() {
        damped[(place, place)] = (1.0 + damping) * normal[(place, place)].max(f64::MIN_POSITIVE);
    }
    Some(damped.cholesky()?.solve(gradient))
}

/// The problem linearised in the logarithms of the constant (where there is one), the moduli and, where asked for, the times.
struct Linear {
    matrix: DMatrix<f64>,
    values: DVector<f64>,
    residuals: DVector<f64>,
}

impl Linear {
    fn new(rows: &Rows, series: &Series, with_times: bool) -> Self {
        let (points, count) = (rows.omegas.len(), series.branches.len());
        let first = usize::from(series.constant > 0.0);
        let columns = first + count * if with_times { 2 } else { 1 };
        let mut matrix = DMatrix::zeros(2 * points, columns);
        let mut values = DVector::zeros(2 * points);
        let mut residuals = DVector::zeros(2 * points);
        for (point, &omega) in rows.omegas.iter().enumerate() {
            let (deviations, loss_row) = (rows.deviations[point], points + point);
            let mut model = [series.constant, 0.0];
            if first == 1 {
                matrix[(point, 0)] = series.constant / deviations[0];
            }
            for (number, branch) in series.branches.iter().enumerate() {
                let (modulus, time_s) = (branch.strength, branch.time_s);
                let debye = Debye::at(omega * time_s);
                let place = first + number;
                matrix[(point, place)] = modulus * debye.frozen / deviations[0];
                matrix[(loss_row, place)] = modulus * debye.loss / deviations[1];
                model[0] += modulus * debye.frozen;
                model[1] += modulus * debye.loss;
                if with_times {
                    let place = place + count;
                    matrix[(point, place)] = modulus * debye.frozen_slope() / deviations[0];
                    matrix[(loss_row, place)] = modulus * debye.loss_slope() / deviations[1];
                }
            }
            for (part, row) in [point, loss_row].into_iter().enumerate() {
                let measured = rows.values[point][part];
                values[row] = measured / deviations[part];
                residuals[row] = (measured - model[part]) / deviations[part];
            }
        }
        Self {
            matrix,
            values,
            residuals,
        }
    }
}

/// The spectrum with its runs of neighbouring times as one branch each.
fn runs_merged(spectrum: &Series) -> Series {
    spectrum.with(merge_runs(&spectrum.branches, SPECTRUM))
}
