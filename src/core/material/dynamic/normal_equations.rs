//! Non-negative least squares from the normal equations, for problems that are solved again and again with little change: the
//! method of [`crate::numerics::nnls`] (Lawson and Hanson 1974, chapter 23; on the normal equations R. Bro and S. de Jong,
//! J. Chemometrics 11 (1997) 393), started from the columns that were in use the last time.
//!
//! The normal equations square the condition of the columns. What is lost by that is far below the noise of a measurement, and
//! what is gained is that an exchange of columns costs nothing beside the products.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Added to the diagonal, which is one: keeps columns that are equal to rounding apart.
const RIDGE: f64 = 1e-11;

/// A column is taken in where its gradient exceeds this, in standard deviations of the data.
const GRADIENT_TOLERANCE: f64 = 1e-5;

/// Which columns are in use, ascending, and their values.
#[derive(Debug, Clone, Default)]
pub(super) struct Solution {
    pub(super) columns: Vec<usize>,
    pub(super) values: Vec<f64>,
}

/// The products `A' A` and `A' b` of columns of unit length; `b` in standard deviations.
pub(super) struct NormalEquations {
    pub(super) products: DMatrix<f64>,
    pub(super) right: DVector<f64>,
}

impl NormalEquations {
    /// The x that minimises |A x - b| with no component negative, from the columns of a similar problem on.
    pub(super) fn solve(&self, start: &[usize]) -> Solution {
        let mut solution = self.feasible(start.to_vec());
        let mut barred = vec![false; self.right.len()];
        // The method is finite but for rounding; beyond this, what is there is as good as rounding lets it be.
        for _ in 0..5 * self.right.len() + 50 {
            let Some(entering) = self.steepest(&solution, &barred) else {
                break;
            };
            match self.exchange(&solution, entering) {
                Some(next) => {
                    solution = next;
                    barred.fill(false);
                }
                None => barred[entering] = true,
            }
        }
        solution
    }

    /// Cholesky factor of the products of these columns.
    pub(super) fn factor(&self, columns: &[usize]) -> Option<Cholesky<f64, Dyn>> {
        let count = columns.len();
        let chosen = DMatrix::from_fn(count, count, |i, j| {
            self.products[(columns[i], columns[j])] + if i == j { RIDGE } else { 0.0 }
        });
        Cholesky::new(chosen)
    }

    fn least_squares(&self, columns: &[usize]) -> Option<Vec<f64>> {
        let right = DVector::from_fn(columns.len(), |i, _| self.right[columns[i]]);
        let solved = self.factor(columns)?.solve(&right);
        Some(solved.iter().copied().collect())
    }

    /// The largest part of these columns whose least squares solution is positive, found by leaving out what is not.
    fn feasible(&self, mut columns: Vec<usize>) -> Solution {
        columns.retain(|&column| column < self.right.len());
        while !columns.is_empty() {
            let Some(values) = self.least_squares(&columns) else {
                break;
            };
            if values.iter().all(|&value| value > 0.0) {
                return Solution { columns, values };
            }
            let mut positive = values.iter().map(|&value| value > 0.0);
            columns.retain(|_| positive.next().unwrap_or(false));
        }
        Solution::default()
    }

    fn steepest(&self, solution: &Solution, barred: &[bool]) -> Option<usize> {
        let mut gradient = self.right.clone();
        for (&column, &value) in solution.columns.iter().zip(&solution.values) {
            gradient.axpy(-value, &self.products.column(column), 1.0);
        }
        (0..gradient.len())
            .filter(|j| !barred[*j] && gradient[*j] > GRADIENT_TOLERANCE)
            .filter(|j| solution.columns.binary_search(j).is_err())
            .max_by(|&i, &j| gradient[i].total_cmp(&gradient[j]))
    }

    /// The solution with this column in use, and without those that it makes negative; `None` where it cannot take part.
    fn exchange(&self, solution: &Solution, entering: usize) -> Option<Solution> {
        let place = solution.columns.binary_search(&entering).err()?;
        let mut next = solution.clone();
        next.columns.insert(place, entering);
        next.values.insert(place, 0.0);
        let mut first = true;
        loop {
            let target = self.least_squares(&next.columns)?;
            if first && target[place] <= 0.0 {
                return None;
            }
            first = false;
            // How far towards the target before a component reaches zero.
            let limit = |(x, z): (&f64, &f64)| if *z > 0.0 { 1.0 } else { x / (x - z) };
            let limits = next.values.iter().zip(&target).map(limit);
            let share = limits.fold(1.0, f64::min);
            if share >= 1.0 {
                next.values = target;
                return Some(next);
            }
            let all = next.columns.iter().zip(next.values.iter().zip(&target));
            let is_out = |x: &f64, z: &f64| *z <= 0.0 && limit((x, z)) <= share;
            let kept = all.filter(|(_, (x, z))| !is_out(x, z));
            let (columns, values) = kept
                .map(|(&column, (x, z))| (column, x + share * (z - x)))
                .unzip();
            next = Solution { columns, values };
            if next.columns.is_empty() {
                return None;
            }
        }
    }
}
