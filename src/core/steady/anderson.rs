//! Anderson acceleration of a fixed-point iteration, with bounded depth.

use nalgebra::{DMatrix, DVector};

/// Relative to the largest.
const SMALLEST_SINGULAR_VALUE: f64 = 1e-10;

/// Past updates that it looks back on.
const DEPTH: usize = 8;

/// Differences of the last iterates and updates.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Anderson {
    iterate: Vec<f64>,
    update: Vec<f64>,
    /// Oldest first: change of the iterate, change of the update.
    changes: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Anderson {
    /// Whether it can look back on this number of variables.
    pub(super) fn fits(&self, variables: usize) -> bool {
        let changes = self.changes.iter().flat_map(|(a, b)| [a, b]);
        let mut all = changes.chain([&self.iterate, &self.update]);
        all.all(|vector| [0, variables].contains(&vector.len()))
    }

    /// Forgets everything: the next step is plain.
    pub(super) fn reset(&mut self) {
        *self = Self::default();
    }

    /// Moves `x` by the accelerated step, given its plain update `f`; `weights` are those of the entries in the least squares.
    pub fn advance(&mut self, x: &mut [f64], f: &[f64], weights: &[f64]) {
        if !self.iterate.is_empty() {
            let moved = difference(x, &self.iterate);
            let changed = difference(f, &self.update);
            if self.changes.len() == DEPTH {
                self.changes.remove(0);
            }
            self.changes.push((moved, changed));
        }
        self.iterate.clear();
        self.iterate.extend_from_slice(x);
        self.update.clear();
        self.update.extend_from_slice(f);
        let gamma = self.coefficients(f, weights);
        for (x, f) in x.iter_mut().zip(f) {
            *x += f;
        }
        for ((moved, changed), gamma) in self.changes.iter().zip(&gamma) {
            for ((x, m), c) in x.iter_mut().zip(moved).zip(changed) {
                *x -= gamma * (m + c);
            }
        }
    }

    /// Least squares: min |W (f - F gamma)| over normalised columns by singular values, the smallest of which are left out:
    /// nearly dependent columns would send the step far away.
    fn coefficients(&self, f: &[f64], weights: &[f64]) -> Vec<f64> {
        let count = self.changes.len();
        if count == 0 {
            return Vec::new();
        }
        let rows = f.len();
        let changes = self.changes.iter();
        let weighted = changes.flat_map(|(_, changed)| changed.iter().zip(weights));
        let mut matrix = DMatrix::from_iterator(rows, count, weighted.map(|(f, w)| w * f));
        let mut right = DVector::from_iterator(rows, f.iter().zip(weights).map(|(f, w)| w * f));
        let norms: Vec<f64> = matrix.column_iter().map(|c| c.norm()).collect();
        if norms.iter().any(|n| *n <= 0.0 || !n.is_finite()) {
            return vec![0.0; count];
        }
        for (mut column, norm) in matrix.column_iter_mut().zip(&norms) {
            column /= *norm;
        }
        // Few columns: their triangle has the same singular values, at far less cost.
        let qr = matrix.qr();
        qr.q_tr_mul(&mut right);
        let right = right.rows(0, rows.min(count));
        let svd = qr.unpack_r().svd(true, true);
        match svd.solve(&right, SMALLEST_SINGULAR_VALUE * svd.singular_values.max()) {
            Ok(solution) => solution.iter().zip(&norms).map(|(g, n)| g / n).collect(),
            Err(_) => vec![0.0; count],
        }
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x <- A x + b with a spectral radius of 3: the plain iteration diverges.
    fn update(x: &[f64]) -> Vec<f64> {
        let a = [[0.2, 1.0, 0.0], [0.5, -3.0, 0.3], [0.0, 0.4, 0.9]];
        let b = [1.0, -2.0, 0.5];
        (0..3)
            .map(|i| a[i].iter().zip(x).map(|(a, x)| a * x).sum::<f64>() + b[i] - x[i])
            .collect()
    }

    fn largest(values: &[f64]) -> f64 {
        values.iter().fold(0.0, |l: f64, v| l.max(v.abs()))
    }

    #[test]
    fn a_linear_map_of_dimension_three_is_solved_in_five_steps_although_it_diverges() {
        let mut anderson = Anderson::default();
        let mut x = vec![0.0; 3];
        for _ in 0..5 {
            let f = update(&x);
            anderson.advance(&mut x, &f, &[1.0; 3]);
        }
        // Like GMRES it ends after as many differences as there are dimensions; the rest is rounding, amplified by 3 a step.
        assert!(largest(&update(&x)) < 1e-10);
    }

    #[test]
    fn after_a_reset_the_next_step_is_plain() {
        let mut anderson = Anderson::default();
        let mut x = vec![1.0, 2.0, 3.0];
        for _ in 0..3 {
            let f = update(&x);
            anderson.advance(&mut x, &f, &[1.0; 3]);
        }
        anderson.reset();
        let (before, f) = (x.clone(), update(&x));
        anderson.advance(&mut x, &f, &[1.0; 3]);
        for ((x, before), f) in x.iter().zip(&before).zip(&f) {
            assert_eq!(*x, before + f);
        }
    }

    #[test]
    fn an_update_that_repeats_itself_does_not_break_the_step() {
        let mut anderson = Anderson::default();
        let mut x = vec![0.0; 3];
        for _ in 0..4 {
            anderson.advance(&mut x, &[1.0, 0.0, 0.0], &[1.0; 3]);
        }
        assert!(x.iter().all(|v| v.is_finite()));
    }
}
