//! One non-negative series through shifted isotherms.
//!
//! The moduli of all isotherms are to be those of `E*(w) = E_0 + sum_k E_k i w t_k / (1 + i w t_k)`, `E_k >= 0`, at the angular
//! frequencies `a_T w`, times `1/b_T`. For given shifts the moduli `E_k` on a fixed logarithmic grid of times (and the vertical
//! factors) are a non-negative linear problem; the shifts are found by variable projection (G. H. Golub and V. Pereyra 1973, in the
//! form of L. Kaufman 1975) with the damping of Levenberg and Marquardt. Rows are divided by the noise of each value, so that the
//! sum of squares is that of standard deviations.

mod columns;

use std::f64::consts::LN_10;

use nalgebra::{DMatrix, DVector};

use super::Isotherm;
use super::noise::Noise;
use crate::material::harmonic::Debye;
use columns::Columns;

/// How far the times go beyond the reciprocals of the angular frequencies (decades): so far that the flank of a branch outside is
/// represented. What this says of the equilibrium modulus does not matter for shifts.
const BEYOND: f64 = 1.5;

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
    /// What is expected of the places before any data: curvature of the sum of squares, and where it is least.
    expected: (DMatrix<f64>, DVector<f64>),
}

/// The curve for given places.
#[derive(Debug, Clone)]
pub(super) struct State {
    /// log10 a_T of every isotherm, and log10 b_T where moduli are shifted too.
    pub(super) places: Vec<f64>,
    /// Sum of squares of the residuals, in standard deviations.
    pub(super) squares: f64,
    /// The same with what was expected of the places.
    pub(super) objective: f64,
    /// Root mean square of the relative residuals of storage and loss modulus.
    pub(super) relative: [f64; 2],
    /// How much more the mean of neighbouring residuals varies than that of independent ones, `(1 + r) / (1 - r)` with the
    /// correlation r of one with the next; one where they are noise.
    pub(super) correlated: f64,
    /// Degrees of freedom that the curve takes from storage and loss moduli: traces of the projection onto the columns in use.
    pub(super) taken: [f64; 2],
    /// Linear unknowns in use.
    pub(super) linear: usize,
    /// Steps of the times in use, for the next solution.
    pub(super) times: Vec<i64>,
    /// Half the gradient and the curvature of the sum of squares by the shifts, the fixed one left out of neither.
    gradient: DVector<f64>,
    curvature: DMatrix<f64>,
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
        let count = isotherms.len();
        let places = if vertical { 2 * count } else { count };
        let mut expected = DMatrix::zeros(places, places);
        if vertical {
            neighbours(&mut expected, count, count, VERTICAL.powi(-2));
        }
        Self {
            values: values.collect(),
            isotherms: count,
            fixed,
            vertical,
            expected: (expected, DVector::zeros(places)),
        }
    }

    /// The same, where the shift between neighbours is expected to be about that of `shifts`, with the weight of the data divided by
    /// `variance`: for data that no one curve describes, which would be described best where they are far apart.
    pub(super) fn expecting(mut self, shifts: &[f64], variance: f64) -> Self {
        let (curvature, least) = &mut self.expected;
        *curvature *= variance;
        neighbours(curvature, 0, self.isotherms, variance * NEIGHBOURS.powi(-2));
        least
            .iter_mut()
            .zip(shifts)
            .for_each(|(least, shift)| *least = *shift);
        self
    }

    /// Places of isotherms that are shifted like this, and not along the moduli.
    pub(super) fn places(&self, shifts: &[f64]) -> Vec<f64> {
        let mut places = shifts.to_vec();
        places.resize(self.expected.1.len(), 0.0);
        places
    }

    /// How the places depend on those that are free: all but those of the fixed isotherm. `shifts` gives the columns for log10 a_T.
    pub(super) fn directions(&self, shifts: &DMatrix<f64>) -> DMatrix<f64> {
        let moved: Vec<usize> = match self.vertical {
            true => (0..self.isotherms).filter(|i| *i != self.fixed).collect(),
            false => Vec::new(),
        };
        let (rows, columns) = (self.expected.1.len(), shifts.ncols());
        DMatrix::from_fn(rows, columns + moved.len(), |i, j| {
            match j.checked_sub(columns) {
                None if i < self.isotherms => shifts[(i, j)],
                Some(j) if i >= self.isotherms => {
                    f64::from(u8::from(i - self.isotherms == moved[j]))
                }
                _ => 0.0,
            }
        })
    }

    /// Free shifts: a column for every isotherm but the fixed one.
    pub(super) fn free(&self) -> DMatrix<f64> {
        let column = |j: usize| if j < self.fixed { j } else { j + 1 };
        let columns = self.isotherms.saturating_sub(1);
        DMatrix::from_fn(self.isotherms, columns, |i, j| {
            f64::from(u8::from(i == column(j)))
        })
    }

    /// Numbers that are compared.
    pub(super) fn count(&self) -> usize {
        2 * self.values.len()
    }

    /// Numbers less the unknowns of a state whose places have this many.
    pub(super) fn freedom(&self, state: &State, unknowns: usize) -> f64 {
        (self.count() as f64 - (state.linear + unknowns) as f64).max(1.0)
    }

    /// The best curve for these places.
    pub(super) fn at(&self, places: &[f64], start: &[i64]) -> State {
        let columns = self.columns(places, start);
        let residual = self.right() - &columns.matrix * &columns.moduli;
        let used = columns.used();
        let (gradient, curvature) = self.derivatives(places, &columns, &used, &residual);
        let from_expected = DVector::from_row_slice(places) - &self.expected.1;
        let pull = &self.expected.0 * &from_expected;
        State {
            places: places.to_vec(),
            squares: residual.norm_squared(),
            objective: residual.norm_squared() + pull.dot(&from_expected),
            relative: self.relative(&residual),
            correlated: self.correlated(&residual),
            taken: self.taken(&columns, &used),
            linear: used.len(),
            times: columns.times(),
            gradient: gradient - pull,
            curvature: curvature + &self.expected.0,
        }
    }

    /// The curve and the places that make the sum of squares least, from these shifts on.
    pub(super) fn refine(&self, shifts: &[f64]) -> State {
        self.refine_along(&self.places(shifts), &self.directions(&self.free()))
    }

    /// The same from these places on, in these directions alone.
    pub(super) fn refine_along(&self, start: &[f64], by: &DMatrix<f64>) -> State {
        let start = DVector::from_row_slice(start);
        let places = |unknowns: &[f64]| {
            let moved = &start + by * DVector::from_row_slice(unknowns);
            Some(moved.iter().copied().collect())
        };
        let unknowns = vec![0.0; by.ncols()];
        self.refine_by(&unknowns, places, |_| by.clone())
            .map_or_else(|| self.at(start.as_slice(), &[]), |found| found.1)
    }

    /// Unknowns that make the sum of squares least, and the state there; `places` gives the places of unknowns, where there are
    /// some, and `directions` their derivatives (a row for each place, a column for each unknown).
    pub(super) fn refine_by(
        &self,
        start: &[f64],
        places: impl Fn(&[f64]) -> Option<Vec<f64>>,
        directions: impl Fn(&[f64]) -> DMatrix<f64>,
    ) -> Option<(Vec<f64>, State)> {
        let mut unknowns = start.to_vec();
        let mut state = self.at(&places(&unknowns)?, &[]);
        if unknowns.is_empty() {
            return Some((unknowns, state));
        }
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
            let tried = places(&next).map(|places| self.at(&places, &state.times));
            match tried.filter(|tried| tried.objective < state.objective) {
                Some(tried) => {
                    let gained = state.objective - tried.objective;
                    (unknowns, state) = (next, tried);
                    damping = f64::max(damping / 10.0, 1e-9);
                    let noise = (state.objective / self.count() as f64).max(1.0);
                    if largest < CLOSE || gained < GAIN * noise {
                        break;
                    }
                }
                None if largest < CLOSE || damping > 1e6 => break,
                None => damping *= 10.0,
            }
        }
        Some((unknowns, state))
    }

    /// Covariance of the unknowns (of which the shifts depend by `directions`) where the data have unit variance.
    ///
    /// The curve is free to change not by the columns in use alone, but by their neighbours on the grid too: which of them are in
    /// use is an accident of the noise.
    pub(super) fn covariance(
        &self,
        state: &State,
        directions: &DMatrix<f64>,
    ) -> Option<DMatrix<f64>> {
        let columns = self.columns(&state.places, &state.times);
        let free = columns.used_and_neighbours();
        let right = self.right();
        let (_, curvature) = self.derivatives(&state.places, &columns, &free, &right);
        let curvature = directions.tr_mul(&((curvature + &self.expected.0) * directions));
        // A shift that the data say nothing about is unknown to ten decades rather than without bound.
        let weak = directions.tr_mul(directions) * 1e-2;
        (curvature + weak).cholesky().map(|factor| factor.inverse())
    }

    fn right(&self) -> DVector<f64> {
        DVector::from_iterator(
            self.count(),
            self.values.iter().flat_map(|value| value.scaled),
        )
    }

    /// log10 b_T of an isotherm.
    fn log10_b_t(&self, places: &[f64], isotherm: usize) -> f64 {
        places
            .get(self.isotherms + isotherm)
            .copied()
            .unwrap_or_default()
    }

    /// Weights of a value where the curve is compared with data that are not shifted along the moduli.
    fn weights(&self, places: &[f64], value: &Value) -> [f64; 2] {
        let unshifted = 10_f64.powf(-self.log10_b_t(places, value.isotherm));
        value.weights.map(|weight| weight * unshifted)
    }

    fn columns(&self, places: &[f64], start: &[i64]) -> Columns {
        let reduced: Vec<f64> = self
            .values
            .iter()
            .map(|v| v.ln_omega + LN_10 * places[v.isotherm])
            .collect();
        let lowest = reduced.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = reduced.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let step = columns::STEP;
        let first_time = ((-highest - BEYOND * LN_10) / step).floor() as i64;
        let last_time = ((-lowest + BEYOND * LN_10) / step).ceil() as i64;
        let times = (last_time - first_time + 1).max(1) as usize;
        let mut matrix = DMatrix::zeros(self.count(), 1 + times);
        for (index, value) in self.values.iter().enumerate() {
            let [storage, loss] = self.weights(places, value);
            matrix[(2 * index, 0)] = storage;
            for k in 0..times {
                let x = (reduced[index] + step * (first_time + k as i64) as f64).exp();
                let debye = Debye::at(x);
                matrix[(2 * index, 1 + k)] = storage * debye.frozen;
                matrix[(2 * index + 1, 1 + k)] = loss * debye.loss;
            }
        }
        Columns::solved(first_time, matrix, &self.right(), start)
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

    fn taken(&self, columns: &Columns, used: &[usize]) -> [f64; 2] {
        let Some(factor) = columns.factor(used) else {
            return [0.0, 0.0];
        };
        let used = columns.matrix.select_columns(used);
        let mut taken = [0.0, 0.0];
        // A trace of A (A' A)^-1 A' over some rows is that of (A' A)^-1 with the products of these rows.
        for (part, trace) in taken.iter_mut().enumerate() {
            let rows = used.rows_with_step(part, self.values.len(), 1).into_owned();
            *trace = factor.solve(&rows.tr_mul(&rows)).trace();
        }
        taken
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

    /// Half the gradient, and the curvature after Gauss, Newton and Kaufman, of the sum of squares by the places, where the curve is
    /// free to follow by the columns `free`.
    fn derivatives(
        &self,
        places: &[f64],
        columns: &Columns,
        free: &[usize],
        residual: &DVector<f64>,
    ) -> (DVector<f64>, DMatrix<f64>) {
        let mut gradient = DVector::zeros(places.len());
        let mut own = DMatrix::zeros(places.len(), places.len());
        let mut cross = DMatrix::zeros(free.len(), places.len());
        let used = columns.used();
        for (index, value) in self.values.iter().enumerate() {
            let reduced = value.ln_omega + LN_10 * places[value.isotherm];
            let modulus = columns.modulus(&used, reduced);
            let weights = self.weights(places, value);
            for part in 0..2 {
                let row = 2 * index + part;
                let (level, slope) = modulus[part];
                let mut by = vec![(value.isotherm, LN_10 * weights[part] * slope)];
                if self.vertical {
                    by.push((
                        self.isotherms + value.isotherm,
                        -LN_10 * weights[part] * level,
                    ));
                }
                for &(place, change) in &by {
                    gradient[place] += change * residual[row];
                    by.iter()
                        .for_each(|&(other, by)| own[(place, other)] += change * by);
                    for (k, &column) in free.iter().enumerate() {
                        cross[(k, place)] += columns.matrix[(row, column)] * change;
                    }
                }
            }
        }
        match columns.factor(free) {
            Some(factor) => (gradient, own - cross.tr_mul(&factor.solve(&cross))),
            None => (gradient, own),
        }
    }
}

/// Vertical shifts of neighbours are expected to differ by some of these (decades): what holds them where nothing else does. Density
/// and temperature, which rubber elasticity goes by, make a tenth of it in five kelvin.
const VERTICAL: f64 = 0.03;

/// Of data that no one curve describes: shifts between neighbours are expected to be within some of these of what the pair says.
const NEIGHBOURS: f64 = 0.3;

const ITERATIONS: usize = 40;

/// Steps below this (decades), and gains below this (of the sum of squares), end the refinement.
const CLOSE: f64 = 1e-4;
const GAIN: f64 = 1e-3;

/// Adds the curvature of this weight times the square of what each of `count` places from `first` on differs from the next.
fn neighbours(curvature: &mut DMatrix<f64>, first: usize, count: usize, weight: f64) {
    for i in first + 1..first + count {
        curvature[(i, i)] += weight;
        curvature[(i - 1, i - 1)] += weight;
        curvature[(i, i - 1)] -= weight;
        curvature[(i - 1, i)] -= weight;
    }
}

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
