//! Anderson acceleration of a fixed-point iteration, with bounded depth.

use nalgebra::{DMatrix, DVector};

/// Relative to the largest.
const SMALLEST_SINGULAR_VALUE: f64 = 1e-10;

/// Past updates that it looks back on.
const DEPTH: usize = 8;

/// Rows of the least squares that are taken together, which stay in cache.
const BLOCK: usize = 1 << 14;

/// Differences of the last iterates and updates.
#[derive(Debug, Default)]
pub struct Anderson {
    iterate: Vec<f64>,
    update: Vec<f64>,
    /// Oldest first: change of the iterate, change of the update.
    changes: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Anderson {
    /// Forgets everything: the next step is plain.
    pub(super) fn reset(&mut self) {
        *self = Self::default();
    }

    /// Moves `x` by the accelerated step, given its plain update `f`; `weights` are those of the entries in the least squares.
    pub fn advance(&mut self, x: &mut [f64], f: &[f64], weights: &[f64]) {
        if self.iterate.is_empty() {
            self.iterate.extend_from_slice(x);
            self.update.extend_from_slice(f);
        } else {
            // The oldest gives way.
            match self.changes.len() == DEPTH {
                true => self.changes.rotate_left(1),
                false => self.changes.push((vec![0.0; x.len()], vec![0.0; f.len()])),
            }
            if let Some((moved, changed)) = self.changes.last_mut() {
                replace(x, &mut self.iterate, moved);
                replace(f, &mut self.update, changed);
            }
        }
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
        let norm = |changed: &[f64]| {
            let squares = changed.iter().zip(weights).map(|(f, w)| (w * f).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let norms: Vec<f64> = self.changes.iter().map(|(_, c)| norm(c)).collect();
        if norms.iter().any(|n| *n <= 0.0 || !n.is_finite()) {
            return vec![0.0; count];
        }
        // Few columns: their triangle has the same singular values, at far less cost. Rows enter it block by block, below the
        // triangle of those before, so that no copy of the whole matrix is made; a matrix of products of columns would be as small,
        // but has the squares of the singular values, of which rounding spares half the digits.
        let (mut triangle, mut right) = (DMatrix::zeros(0, count), DVector::zeros(0));
        for start in (0..f.len()).step_by(BLOCK) {
            let end = f.len().min(start + BLOCK);
            let (above, rows) = (triangle.nrows(), end - start);
            let column = |k: usize, row: usize| self.changes[k].1[row] * weights[row] / norms[k];
            let entry = |i: usize, k: usize| match i < above {
                true => triangle[(i, k)],
                false => column(k, start + i - above),
            };
            let block = DMatrix::from_fn(above + rows, count, entry);
            let of_right = |i: usize, _| match i < above {
                true => right[i],
                false => f[start + i - above] * weights[start + i - above],
            };
            let mut product = DVector::from_fn(above + rows, of_right);
            let qr = block.qr();
            qr.q_tr_mul(&mut product);
            right = product.rows(0, product.len().min(count)).into_owned();
            triangle = qr.unpack_r();
        }
        let svd = triangle.svd(true, true);
        match svd.solve(&right, SMALLEST_SINGULAR_VALUE * svd.singular_values.max()) {
            Ok(solution) => solution.iter().zip(&norms).map(|(g, n)| g / n).collect(),
            Err(_) => vec![0.0; count],
        }
    }
}

/// Puts `new` in the place of `old`, and what that changes into `change`.
fn replace(new: &[f64], old: &mut [f64], change: &mut [f64]) {
    for ((new, old), change) in new.iter().zip(old).zip(change) {
        *change = new - *old;
        *old = *new;
    }
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
    fn any_number_of_entries_is_taken_as_one_matrix_of_them() {
        // Modes of a diagonal map, each repeated over so many entries that they make several blocks: whatever their number, the
        // steps are those of the few.
        let factors = [0.3, -2.0, 0.9, 1.7];
        let mut few = (Anderson::default(), vec![0.0; 4]);
        let copies = BLOCK + 7;
        let mut many = (Anderson::default(), vec![0.0; 4 * copies]);
        let step = |(anderson, x): &mut (Anderson, Vec<f64>)| {
            let copies = x.len() / 4;
            let update = |(i, x): (usize, &f64)| 1.0 + (factors[i / copies] - 1.0) * x;
            let f: Vec<f64> = x.iter().enumerate().map(update).collect();
            let weights = vec![1.0; x.len()];
            anderson.advance(x, &f, &weights);
            largest(&f)
        };
        for cycle in 0..6 {
            let distances = [step(&mut few), step(&mut many)];
            for (i, x) in many.1.iter().enumerate() {
                let expected = few.1[i / copies];
                assert!(
                    (x - expected).abs() < 1e-9 * (1.0 + expected.abs()),
                    "{cycle} {i}"
                );
            }
            assert!(
                cycle < 5 || distances.iter().all(|d| *d < 1e-9),
                "{distances:?}"
            );
        }
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
