//! The linear problem of one curve: a column for the equilibrium modulus and one for every time of a logarithmic grid.

use std::f64::consts::LN_10;

use nalgebra::{DMatrix, DVector};

use crate::material::dynamic::normal_equations::{NormalEquations, Solution};

/// Distance of the logarithms of the times. Eight per decade: a branch between two is represented to a few tenths of a per cent.
pub(super) const STEP: f64 = LN_10 / 8.0;

/// In the place of a time: the equilibrium modulus.
const EQUILIBRIUM: i64 = i64::MIN;

/// Columns of the linear problem: the equilibrium modulus, and the moduli of the times.
pub(super) struct Columns {
    first_time: i64,
    times: usize,
    lengths: Vec<f64>,
    /// Of unit length.
    pub(super) matrix: DMatrix<f64>,
    pub(super) equations: NormalEquations,
}

impl Columns {
    /// Columns of the equilibrium modulus and of this many times, those of the grid from the first on.
    pub(super) fn new(
        first_time: i64,
        times: usize,
        mut matrix: DMatrix<f64>,
        right: &DVector<f64>,
    ) -> Self {
        let lengths: Vec<f64> = matrix.column_iter().map(|c| c.norm()).collect();
        for (mut column, &length) in matrix.column_iter_mut().zip(&lengths) {
            if length > 0.0 {
                column /= length;
            }
        }
        let count = matrix.ncols();
        let mut products = DMatrix::zeros(count, count);
        for i in 0..count {
            for j in 0..=i {
                let product = matrix.column(i).dot(&matrix.column(j));
                products[(i, j)] = product;
                products[(j, i)] = product;
            }
        }
        Self {
            first_time,
            times,
            lengths,
            equations: NormalEquations {
                products,
                right: matrix.tr_mul(right),
            },
            matrix,
        }
    }

    /// Storage and loss modulus of a solution (Pa) at a reduced angular frequency (natural logarithm), and their derivatives by it.
    pub(super) fn modulus(&self, solution: &Solution, reduced: f64) -> [(f64, f64); 2] {
        let mut modulus = [(0.0, 0.0); 2];
        for (&column, &unit) in solution.columns.iter().zip(&solution.values) {
            let value = unit / self.lengths[column];
            let Some(k) = column.checked_sub(1) else {
                modulus[0].0 += value;
                continue;
            };
            let x = (reduced + STEP * (self.first_time + k as i64) as f64).exp();
            let share = x / (1.0 + x * x);
            modulus[0].0 += value * x * share;
            modulus[0].1 += value * 2.0 * share * share;
            modulus[1].0 += value * share;
            modulus[1].1 += value * share * (1.0 - x * x) / (1.0 + x * x);
        }
        modulus
    }

    pub(super) fn start(&self, times: &[i64]) -> Vec<usize> {
        let known = times.iter().filter_map(|&time| match time {
            EQUILIBRIUM => Some(0),
            _ => {
                let k = time - self.first_time;
                (0..self.times as i64).contains(&k).then(|| 1 + k as usize)
            }
        });
        known.collect()
    }

    /// These columns, and those of the times next to theirs.
    pub(super) fn with_neighbours(&self, columns: &[usize]) -> Vec<usize> {
        let is_time = |column: usize| (1..=self.times).contains(&column);
        let near = |&column: &usize| {
            let next = [column.saturating_sub(1), column + 1];
            let next = next
                .into_iter()
                .filter(move |&other| is_time(column) && is_time(other));
            next.chain([column])
        };
        let mut all: Vec<usize> = columns.iter().flat_map(near).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    pub(super) fn times_of(&self, solution: &Solution) -> Vec<i64> {
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
