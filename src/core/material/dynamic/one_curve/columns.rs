//! The linear problem of one curve: a column for the equilibrium modulus and one for every time of a logarithmic grid.

use std::f64::consts::LN_10;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::material::harmonic::Debye;
use crate::numerics::nnls::{self, nnls_from};

/// Distance of the logarithms of the times. Eight per decade: a branch between two is represented to a few tenths of a per cent.
pub(super) const STEP: f64 = LN_10 / 8.0;

/// In the place of a time: the equilibrium modulus.
const EQUILIBRIUM: i64 = i64::MIN;

/// A column is taken in where its gradient exceeds this, in standard deviations of the data.
const GRADIENT_TOLERANCE: f64 = 1e-5;

/// Columns of the equilibrium modulus and of the times of the grid, and the best moduli of them.
pub(super) struct Columns {
    /// Steps of the first time.
    first_time: i64,
    pub(super) matrix: DMatrix<f64>,
    /// Of the columns with one another.
    products: DMatrix<f64>,
    /// Pa.
    pub(super) moduli: DVector<f64>,
}

impl Columns {
    /// The best moduli for these values, found from the times on that are in use in a similar problem.
    pub(super) fn solved(
        first_time: i64,
        matrix: DMatrix<f64>,
        values: &DVector<f64>,
        times: &[i64],
    ) -> Self {
        let column = |&time: &i64| match time {
            EQUILIBRIUM => Some(0),
            _ => usize::try_from(time - first_time + 1)
                .ok()
                .filter(|&column| column > 0),
        };
        let start = times.iter().filter_map(column).collect();
        // By blocks, which `tr_mul` does not take.
        let products = matrix.transpose() * &matrix;
        let right = matrix.tr_mul(values);
        // Of what is no number nothing is represented.
        let moduli = nnls_from(&products, &right, start, GRADIENT_TOLERANCE)
            .unwrap_or_else(|_| DVector::zeros(matrix.ncols()));
        Self {
            first_time,
            matrix,
            products,
            moduli,
        }
    }

    /// Columns whose modulus is not zero.
    pub(super) fn used(&self) -> Vec<usize> {
        let all = 0..self.moduli.len();
        all.filter(|&column| self.moduli[column] > 0.0).collect()
    }

    /// Their times, in steps.
    pub(super) fn times(&self) -> Vec<i64> {
        let time = |column: usize| match column {
            0 => EQUILIBRIUM,
            _ => self.first_time + column as i64 - 1,
        };
        self.used().into_iter().map(time).collect()
    }

    /// Columns in use, and those of the times next to theirs.
    pub(super) fn used_and_neighbours(&self) -> Vec<usize> {
        let is_used = |column: usize| {
            self.moduli
                .get(column)
                .is_some_and(|modulus| *modulus > 0.0)
        };
        let near = |column: usize| (column > 1 && is_used(column - 1)) || is_used(column + 1);
        let all = 0..self.moduli.len();
        all.filter(|&column| is_used(column) || (column > 0 && near(column)))
            .collect()
    }

    /// Cholesky factor of the products of these columns.
    pub(super) fn factor(&self, columns: &[usize]) -> Option<Cholesky<f64, Dyn>> {
        nnls::factor(&self.products, columns)
    }

    /// Storage and loss modulus (Pa) at a reduced angular frequency (natural logarithm), and their derivatives by it.
    pub(super) fn modulus(&self, used: &[usize], reduced: f64) -> [(f64, f64); 2] {
        let mut modulus = [(0.0, 0.0); 2];
        for &column in used {
            let value = self.moduli[column];
            let Some(k) = column.checked_sub(1) else {
                modulus[0].0 += value;
                continue;
            };
            let debye = Debye::at((reduced + STEP * (self.first_time + k as i64) as f64).exp());
            modulus[0].0 += value * debye.frozen;
            modulus[0].1 += value * debye.frozen_slope();
            modulus[1].0 += value * debye.loss;
            modulus[1].1 += value * debye.loss_slope();
        }
        modulus
    }
}
