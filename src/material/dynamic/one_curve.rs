//! One non-negative series through shifted isotherms.
//!
//! The moduli of all isotherms are to be those of `E*(w) = E_0 + sum_k E_k i w t_k / (1 + i w t_k)`, `E_k >= 0`, at the angular
//! frequencies `a_T w`, times `1/b_T`. For given shifts the moduli `E_k` on a fixed logarithmic grid of times (and the vertical
//! factors) are a non-negative linear problem; the shifts are found by variable projection (G. H. Golub and V. Pereyra 1973, in the
//! form of L. Kaufman 1975) with the damping of Levenberg and Marquardt. Rows are divided by the noise of each value, so that the
//! sum of squares is that of standard deviations.

use std::f64::consts::LN_10;

use nalgebra::{DMatrix, DVector};

use super::Isotherm;
use super::noise::Noise;
use super::normal_equations::{NormalEquations, Solution};

/// Times per decade: a branch between two of the grid is represented to a few tenths of a per cent.
const TIMES_PER_DECADE: f64 = 8.0;

/// How far the times go beyond the reciprocals of the angular frequencies (decades).
const BEYOND: f64 = 0.5;

/// Largest step of a shift in one iteration (decades).
const LARGEST_STEP: f64 = 0.7;

/// Both moduli of a point.
struct Value {
    isotherm: usize,
    ln_omega: f64,
    /// Storage and loss modulus over their standard errors.
    scaled: [f64; 2],
    /// One over the standard errors (1/Pa).
    weights: [f64; 2],
}

/// Isotherms that are to lie on one curve.
pub(super) struct OneCurve {
    values: Vec<Value>,
    isotherms: usize,
    /// The isotherm that stays where it is.
    fixed: usize,
    vertical: bool,
}

/// The curve for given shifts.
#[derive(Debug, Clone)]
pub(super) struct State {
    /// log10 a_T of every isotherm.
    pub(super) shifts: Vec<f64>,
    /// b_T of every isotherm.
    pub(super) vertical: Vec<f64>,
    /// Sum of squares of the residuals, in standard deviations.
    pub(super) squares: f64,
    /// Root mean square of the relative residuals of storage and loss modulus.
    pub(super) relative: [f64; 2],
    /// How much more the mean of neighbouring residuals varies than that of independent ones, `(1 + r) / (1 - r)` with the
    /// correlation r of one with the next; one where they are noise.
    pub(super) correlated: f64,
    /// Linear unknowns in use.
    pub(super) linear: usize,
    /// Steps of the times in use, for the next solution.
    times: Vec<i64>,
    /// Half the gradient and the curvature of the sum of squares by the shifts, the fixed one left out of neither.
    gradient: DVector<f64>,
    curvature: DMatrix<f64>,
}

/// Columns of the linear problem: the equilibrium modulus, the moduli of the times, the vertical factors.
struct Columns {
    first_time: i64,
    times: usize,
    lengths: Vec<f64>,
    matrix: DMatrix<f64>,
}

impl OneCurve {
    pub(super) fn new(
        isotherms: &[&Isotherm],
        noise: &Noise,
        fixed: usize,
        vertical: bool,
    ) -> Self {
        let points = isotherms
            .iter()
            .enumerate()
            .flat_map(|(isotherm, i)| i.points.iter().map(move |point| (isotherm, point)));
        let values = points.map(|(isotherm, point)| {
            let (storage, loss) = noise.of_point(point);
            Value {
                isotherm,
                ln_omega: point.angular_frequency_rad_per_s.ln(),
                scaled: [1.0 / storage, 1.0 / loss],
                weights: [
                    1.0 / (storage * point.storage_modulus_pa),
                    1.0 / (loss * point.loss_modulus_pa),
                ],
            }
        });
        Self {
            values: values.collect(),
            isotherms: isotherms.len(),
            fixed,
            vertical,
        }
    }

    /// Numbers that are compared.
    pub(super) fn count(&self) -> usize {
        2 * self.values.len()
    }

    /// Numbers less the unknowns of a state whose shifts have so many.
    pub(super) fn freedom(&self, state: &State, unknowns: usize) -> f64 {
        (self.count() as f64 - (state.linear + unknowns) as f64).max(1.0)
    }

    /// The best curve for these shifts.
    pub(super) fn at(&self, shifts: &[f64], start: &[i64]) -> State {
        let columns = self.columns(shifts);
        let right = self.right();
        let products = columns.matrix.tr_mul(&columns.matrix);
        let projected = columns.matrix.tr_mul(&right);
        let equations = NormalEquations {
            products: &products,
            right: &projected,
        };
        let solution = equations.solve(&columns.start(start, self.vertical));
        let mut residual = right;
        for (&column, &value) in solution.columns.iter().zip(&solution.values) {
            residual.axpy(-value, &columns.matrix.column(column), 1.0);
        }
        let (gradient, curvature) =
            self.derivatives(shifts, &columns, &equations, &solution, &residual);
        State {
            shifts: shifts.to_vec(),
            vertical: self.vertical_factors(&columns, &solution),
            squares: residual.norm_squared(),
            relative: self.relative(&residual),
            correlated: self.correlated(&residual),
            linear: solution.columns.len(),
            times: columns.times_of(&solution),
            gradient,
            curvature,
        }
    }

    /// The curve and the shifts that make the sum of squares least, from these shifts on.
    pub(super) fn refine(&self, start: &[f64]) -> State {
        let free: Vec<usize> = (0..self.isotherms).filter(|i| *i != self.fixed).collect();
        let directions = |_: &[f64]| {
            DMatrix::from_fn(self.isotherms, free.len(), |i, j| {
                f64::from(u8::from(i == free[j]))
            })
        };
        let shifts = |unknowns: &[f64]| {
            let mut shifts = start.to_vec();
            free.iter().zip(unknowns).for_each(|(&i, &u)| shifts[i] = u);
            Some(shifts)
        };
        let unknowns: Vec<f64> = free.iter().map(|&i| start[i]).collect();
        self.refine_by(&unknowns, shifts, directions)
            .map_or_else(|| self.at(start, &[]), |found| found.1)
    }

    /// Unknowns that make the sum of squares least, and the state there; `shifts` gives the shifts of unknowns, where there are
    /// some, and `directions` their derivatives (a row for each isotherm, a column for each unknown).
    pub(super) fn refine_by(
        &self,
        start: &[f64],
        shifts: impl Fn(&[f64]) -> Option<Vec<f64>>,
        directions: impl Fn(&[f64]) -> DMatrix<f64>,
    ) -> Option<(Vec<f64>, State)> {
        let mut unknowns = start.to_vec();
        let mut state = self.at(&shifts(&unknowns)?, &[]);
        let mut damping = 1e-3;
        for _ in 0..ITERATIONS {
            let by = directions(&unknowns);
            let curvature = by.tr_mul(&(&state.curvature * &by));
            let gradient = by.tr_mul(&state.gradient);
            let Some((step, largest)) = damped(&curvature, &gradient, &by, damping) else {
                damping *= 10.0;
                continue;
            };
            let next: Vec<f64> = unknowns
                .iter()
                .zip(step.iter())
                .map(|(u, s)| u + s)
                .collect();
            let tried = shifts(&next).map(|shifts| self.at(&shifts, &state.times));
            match tried.filter(|tried| tried.squares < state.squares) {
                Some(tried) => {
                    let gained = state.squares - tried.squares;
                    (unknowns, state) = (next, tried);
                    damping = f64::max(damping / 10.0, 1e-9);
                    if largest < CLOSE || gained < GAIN {
                        break;
                    }
                }
                None if largest < CLOSE || damping > 1e6 => break,
                None => damping *= 10.0,
            }
        }
        Some((unknowns, state))
    }

    fn right(&self) -> DVector<f64> {
        let free = |value: &Value| self.vertical && value.isotherm != self.fixed;
        let of = |value: &Value| {
            if free(value) {
                [0.0, 0.0]
            } else {
                value.scaled
            }
        };
        DVector::from_iterator(self.count(), self.values.iter().flat_map(of))
    }

    fn columns(&self, shifts: &[f64]) -> Columns {
        let reduced: Vec<f64> = self
            .values
            .iter()
            .map(|v| v.ln_omega + LN_10 * shifts[v.isotherm])
            .collect();
        let lowest = reduced.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = reduced.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let step = LN_10 / TIMES_PER_DECADE;
        let first_time = ((-highest - BEYOND * LN_10) / step).floor() as i64;
        let last_time = ((-lowest + BEYOND * LN_10) / step).ceil() as i64;
        let times = (last_time - first_time + 1).max(1) as usize;
        let vertical = if self.vertical { self.isotherms } else { 0 };
        let mut matrix = DMatrix::zeros(self.count(), 1 + times + vertical);
        for (index, value) in self.values.iter().enumerate() {
            let [storage, loss] = value.weights;
            matrix[(2 * index, 0)] = storage;
            for k in 0..times {
                let x = (reduced[index] + step * (first_time + k as i64) as f64).exp();
                let share = x / (1.0 + x * x);
                matrix[(2 * index, 1 + k)] = storage * x * share;
                matrix[(2 * index + 1, 1 + k)] = loss * share;
            }
            if self.vertical && value.isotherm != self.fixed {
                matrix[(2 * index, 1 + times + value.isotherm)] = -value.scaled[0];
                matrix[(2 * index + 1, 1 + times + value.isotherm)] = -value.scaled[1];
            }
        }
        let lengths: Vec<f64> = matrix.column_iter().map(|c| c.norm()).collect();
        for (mut column, &length) in matrix.column_iter_mut().zip(&lengths) {
            if length > 0.0 {
                column /= length;
            }
        }
        Columns {
            first_time,
            times,
            lengths,
            matrix,
        }
    }

    fn vertical_factors(&self, columns: &Columns, solution: &Solution) -> Vec<f64> {
        let factor = |isotherm: usize| {
            let column = 1 + columns.times + isotherm;
            let place = solution.columns.binary_search(&column).ok()?;
            Some(solution.values[place] / columns.lengths[column])
        };
        (0..self.isotherms)
            .map(|isotherm| factor(isotherm).unwrap_or(1.0))
            .collect()
    }

    fn relative(&self, residual: &DVector<f64>) -> [f64; 2] {
        let mean_square = |which: usize| {
            let squares = self.values.iter().enumerate().map(|(index, value)| {
                let relative = residual[2 * index + which] / value.scaled[which];
                relative * relative
            });
            (squares.sum::<f64>() / self.values.len() as f64).sqrt()
        };
        [mean_square(0), mean_square(1)]
    }

    fn correlated(&self, residual: &DVector<f64>) -> f64 {
        let next = self.values.windows(2).enumerate();
        let pairs = next.filter(|(_, pair)| pair[0].isotherm == pair[1].isotherm);
        let products = pairs.flat_map(|(index, _)| {
            [0, 1].map(|part| {
                let (one, next) = (residual[2 * index + part], residual[2 * index + 2 + part]);
                (one * next, 0.5 * (one * one + next * next))
            })
        });
        let (products, squares) =
            products.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
        let correlation = if squares > 0.0 {
            (products / squares).clamp(0.0, 0.9)
        } else {
            0.0
        };
        (1.0 + correlation) / (1.0 - correlation)
    }

    /// Half the gradient, and the curvature after Gauss, Newton and Kaufman, of the sum of squares by the shifts.
    fn derivatives(
        &self,
        shifts: &[f64],
        columns: &Columns,
        equations: &NormalEquations,
        solution: &Solution,
        residual: &DVector<f64>,
    ) -> (DVector<f64>, DMatrix<f64>) {
        let step = LN_10 / TIMES_PER_DECADE;
        let used = solution.columns.len();
        let mut gradient = DVector::zeros(self.isotherms);
        let mut own = DVector::zeros(self.isotherms);
        let mut cross = DMatrix::zeros(used, self.isotherms);
        for (index, value) in self.values.iter().enumerate() {
            let reduced = value.ln_omega + LN_10 * shifts[value.isotherm];
            let mut by = [0.0, 0.0];
            for (&column, &unit) in solution.columns.iter().zip(&solution.values) {
                if column == 0 || column > columns.times {
                    continue;
                }
                let modulus = unit / columns.lengths[column];
                let x = (reduced + step * (columns.first_time + column as i64 - 1) as f64).exp();
                let share = x / (1.0 + x * x);
                by[0] += modulus * 2.0 * share * share;
                by[1] += modulus * share * (1.0 - x * x) / (1.0 + x * x);
            }
            for (part, slope) in by.into_iter().enumerate() {
                let row = 2 * index + part;
                let slope = LN_10 * value.weights[part] * slope;
                gradient[value.isotherm] += slope * residual[row];
                own[value.isotherm] += slope * slope;
                for (k, &column) in solution.columns.iter().enumerate() {
                    cross[(k, value.isotherm)] += columns.matrix[(row, column)] * slope;
                }
            }
        }
        let projected = match equations.factor(&solution.columns) {
            Some(factor) => cross.tr_mul(&factor.solve(&cross)),
            None => DMatrix::zeros(self.isotherms, self.isotherms),
        };
        (gradient, DMatrix::from_diagonal(&own) - projected)
    }
}

impl State {
    /// Covariance of the unknowns (of which the shifts depend by `directions`) where the data have unit variance.
    pub(super) fn covariance(&self, directions: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let curvature = directions.tr_mul(&(&self.curvature * directions));
        // A shift that the data say nothing about is unknown to ten decades rather than without bound.
        let weak = directions.tr_mul(directions) * 1e-2;
        (curvature + weak).cholesky().map(|factor| factor.inverse())
    }
}

impl Columns {
    fn start(&self, times: &[i64], vertical: bool) -> Vec<usize> {
        let known = times.iter().filter_map(|&time| match time {
            EQUILIBRIUM => Some(0),
            _ => {
                let k = time - self.first_time;
                (0..self.times as i64).contains(&k).then(|| 1 + k as usize)
            }
        });
        let mut start: Vec<usize> = known.collect();
        if vertical && !start.is_empty() {
            start.extend((1 + self.times..self.lengths.len()).filter(|&j| self.lengths[j] > 0.0));
        }
        start
    }

    fn times_of(&self, solution: &Solution) -> Vec<i64> {
        let times = solution
            .columns
            .iter()
            .filter(|&&column| column <= self.times);
        times
            .map(|&column| match column {
                0 => EQUILIBRIUM,
                _ => self.first_time + column as i64 - 1,
            })
            .collect()
    }
}

/// In the place of a time: the equilibrium modulus.
const EQUILIBRIUM: i64 = i64::MIN;

const ITERATIONS: usize = 40;

/// Steps below this (decades), and gains below this (of the sum of squares), end the refinement.
const CLOSE: f64 = 1e-4;
const GAIN: f64 = 1e-3;

/// The damped step of the unknowns, and the largest step of a shift that comes with it, held to [`LARGEST_STEP`].
fn damped(
    curvature: &DMatrix<f64>,
    gradient: &DVector<f64>,
    directions: &DMatrix<f64>,
    damping: f64,
) -> Option<(DVector<f64>, f64)> {
    let mut damped = curvature.clone();
    let largest = curvature.diagonal().max();
    for i in 0..damped.nrows() {
        damped[(i, i)] += damping * curvature[(i, i)].abs() + 1e-12 * largest + f64::MIN_POSITIVE;
    }
    let step = damped.cholesky()?.solve(gradient);
    let size = (directions * &step).amax();
    let share = (LARGEST_STEP / size).min(1.0);
    step.iter()
        .all(|s| s.is_finite())
        .then(|| (step * share, size * share))
}
