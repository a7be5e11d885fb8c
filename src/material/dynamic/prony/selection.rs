//! Few branches in place of a spectrum: neighbours merged, times and moduli refined together, and branches taken away as long
//! as the criterion falls.

use nalgebra::{DMatrix, DVector};

use super::rows::{Rows, SPECTRUM, Series};
use crate::material::harmonic::Debye;

/// Iterations of a refinement, and the decrease of chi squared at which it ends: while branches are counted, and at the end.
const ROUGHLY: (usize, f64) = (15, 0.05);
const CLOSELY: (usize, f64) = (100, 1e-6);

/// Branches are taken away one by one; this many ways are tried to the end, the likeliest first.
const TRIED: usize = 3;

/// Number of branches from which on it is worth merging pair by pair, all at once.
const MANY: usize = 8;

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
        let mut best = self.refined(&merge_runs(spectrum), ROUGHLY);
        while best.branches.len() >= MANY {
            let half = self.refined(&halved(&best), ROUGHLY);
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
        let mut reduced = self.refined(&merge_runs(spectrum), ROUGHLY);
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
        let mut candidates: Vec<(f64, Series)> = fewer(series)
            .into_iter()
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
            .sort_by(|left, right| left.1.total_cmp(&right.1));
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
            branch.0 *= factor(step[first + number]);
            let time_s = branch.1 * factor(step[first + count + number]);
            branch.1 = time_s.clamp(self.limits_s.0, self.limits_s.1);
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
            let mut model = (series.constant, 0.0);
            if first == 1 {
                matrix[(point, 0)] = series.constant / deviations.0;
            }
            for (number, (modulus, time_s)) in series.branches.iter().enumerate() {
                let debye = Debye::at(omega * time_s);
                let place = first + number;
                matrix[(point, place)] = modulus * debye.frozen / deviations.0;
                matrix[(loss_row, place)] = modulus * debye.loss / deviations.1;
                model.0 += modulus * debye.frozen;
                model.1 += modulus * debye.loss;
                if with_times {
                    let place = place + count;
                    matrix[(point, place)] = modulus * debye.frozen_slope() / deviations.0;
                    matrix[(loss_row, place)] = modulus * debye.loss_slope() / deviations.1;
                }
            }
            let measured = rows.values[point];
            values[point] = measured.0 / deviations.0;
            values[loss_row] = measured.1 / deviations.1;
            residuals[point] = (measured.0 - model.0) / deviations.0;
            residuals[loss_row] = (measured.1 - model.1) / deviations.1;
        }
        Self {
            matrix,
            values,
            residuals,
        }
    }
}

/// Two branches as one: moduli added, times averaged as logarithms with the moduli as weights.
fn merged(left: (f64, f64), right: (f64, f64)) -> (f64, f64) {
    let modulus = left.0 + right.0;
    let share = right.0 / modulus;
    (modulus, left.1 * (right.1 / left.1).powf(share))
}

/// Branches on neighbouring times of the grid as one: a time between two grid times shows as both.
fn merge_runs(series: &Series) -> Series {
    let adjacent = 10_f64.powf(1.01 / SPECTRUM);
    let mut branches: Vec<(f64, f64)> = Vec::new();
    let mut last_s = 0.0;
    for &branch in &series.branches {
        match branches.last_mut() {
            Some(run) if branch.1 <= last_s * adjacent => *run = merged(*run, branch),
            _ => branches.push(branch),
        }
        last_s = branch.1;
    }
    Series {
        branches,
        ..series.clone()
    }
}

/// Every two neighbours as one.
fn halved(series: &Series) -> Series {
    let pairs = series.branches.chunks(2);
    Series {
        branches: pairs
            .filter_map(|pair| pair.iter().copied().reduce(merged))
            .collect(),
        ..series.clone()
    }
}

/// Every series with one branch less: two neighbours merged, or one left out.
fn fewer(series: &Series) -> Vec<Series> {
    let branches = &series.branches;
    let with = |branches: Vec<(f64, f64)>| Series {
        branches,
        ..series.clone()
    };
    let joined = (1..branches.len()).map(|right| {
        let mut rest = branches.clone();
        let branch = rest.remove(right);
        rest[right - 1] = merged(rest[right - 1], branch);
        with(rest)
    });
    let without = (0..branches.len()).map(|left_out| {
        let mut rest = branches.clone();
        rest.remove(left_out);
        with(rest)
    });
    let nothing = |series: &Series| series.constant == 0.0 && series.branches.is_empty();
    joined
        .chain(without)
        .filter(|series| !nothing(series))
        .collect()
}
