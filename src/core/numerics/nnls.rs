//! Non-negative least squares: the active set method of C. L. Lawson and R. J. Hanson, *Solving Least Squares Problems*,
//! Prentice-Hall 1974 (SIAM 1995), chapter 23, with a QR factorisation of the columns in use.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Why no solution was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NnlsError {
    /// Numbers that cannot be computed with.
    #[error("a non-negative least squares problem holds a number that is not finite")]
    NotFinite,
    /// The method is finite; only rounding can keep it from ending.
    #[error("non-negative least squares did not end within {iterations} exchanges of columns")]
    NotConverged {
        /// Columns taken in and put out.
        iterations: usize,
    },
}

/// A column is taken in only where the gradient exceeds this share of |column| |b|: what rounding leaves is below it.
const GRADIENT_TOLERANCE: f64 = 1e-13;

/// A column that its predecessors represent to this share of its length is no column of its own.
const RANK_TOLERANCE: f64 = 1e-13;

/// What is added to the diagonal of products of columns, as a share of it: keeps columns apart that are equal to rounding.
const RIDGE: f64 = 1e-11;

/// The x that minimises |A x - b| with no component negative.
///
/// # Errors
/// [`NnlsError`].
pub fn nnls(matrix: &DMatrix<f64>, b: &DVector<f64>) -> Result<DVector<f64>, NnlsError> {
    let (unit, lengths) = unit_columns(matrix, b)?;
    let tolerance = GRADIENT_TOLERANCE * b.norm();
    active_set(&Rows { unit, b }, &lengths, Vec::new(), tolerance)
}

/// The same from the products `A' A` and `A' b` (R. Bro and S. de Jong, J. Chemometrics 11 (1997) 393), for a problem that is solved again
/// and again with little change: from those columns on that the last solution has in use. A column is taken in where the gradient of it at
/// unit length exceeds the tolerance, in the units of b. The products square the condition of the columns: what is lost is far below the
/// noise of a measurement, and an exchange of columns costs nothing beside the products.
///
/// # Errors
/// [`NnlsError`].
pub fn nnls_from(
    products: &DMatrix<f64>,
    right: &DVector<f64>,
    start: Vec<usize>,
    tolerance: f64,
) -> Result<DVector<f64>, NnlsError> {
    if !products
        .iter()
        .chain(right.iter())
        .all(|value| value.is_finite())
    {
        return Err(NnlsError::NotFinite);
    }
    let lengths = products.diagonal().map(f64::sqrt);
    // A column of no length takes no part.
    let unit = |value: f64, length: f64| if length > 0.0 { value / length } else { 0.0 };
    let problem = Products {
        products: products
            .map_with_location(|i, j, product| unit(unit(product, lengths[i]), lengths[j])),
        right: right.zip_map(&lengths, unit),
    };
    active_set(&problem, lengths.as_slice(), start, tolerance)
}

/// The Cholesky factor of some of the products of columns.
pub fn factor(products: &DMatrix<f64>, columns: &[usize]) -> Option<Cholesky<f64, Dyn>> {
    let ridge = |i: usize, j: usize| if i == j { 1.0 + RIDGE } else { 1.0 };
    let count = columns.len();
    let chosen = |i: usize, j: usize| ridge(i, j) * products[(columns[i], columns[j])];
    Cholesky::new(DMatrix::from_fn(count, count, chosen))
}

/// Columns of unit length, which make the answer independent of their units, and their lengths.
fn unit_columns(
    matrix: &DMatrix<f64>,
    b: &DVector<f64>,
) -> Result<(DMatrix<f64>, Vec<f64>), NnlsError> {
    if !matrix.iter().chain(b.iter()).all(|value| value.is_finite()) {
        return Err(NnlsError::NotFinite);
    }
    let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
    let mut unit = matrix.clone();
    for (mut column, &length) in unit.column_iter_mut().zip(&lengths) {
        if length > 0.0 {
            column /= length;
        }
    }
    Ok((unit, lengths))
}

/// A least squares problem on columns of unit length.
trait Problem {
    /// A' (b - A x).
    fn gradient(&self, x: &DVector<f64>) -> DVector<f64>;

    /// The unconstrained solution on these columns; `None` where they do not determine one.
    fn least_squares(&self, columns: &[usize]) -> Option<DVector<f64>>;
}

/// Solved by a QR factorisation of the columns.
struct Rows<'a> {
    unit: DMatrix<f64>,
    b: &'a DVector<f64>,
}

impl Problem for Rows<'_> {
    fn gradient(&self, x: &DVector<f64>) -> DVector<f64> {
        self.unit.tr_mul(&(self.b - &self.unit * x))
    }

    fn least_squares(&self, columns: &[usize]) -> Option<DVector<f64>> {
        least_squares(&self.unit.select_columns(columns), self.b)
    }
}

/// Solved by a Cholesky factorisation of the products of the columns.
struct Products {
    products: DMatrix<f64>,
    right: DVector<f64>,
}

impl Problem for Products {
    fn gradient(&self, x: &DVector<f64>) -> DVector<f64> {
        let mut gradient = self.right.clone();
        for (column, &value) in self.products.column_iter().zip(x.iter()) {
            if value > 0.0 {
                gradient.axpy(-value, &column, 1.0);
            }
        }
        gradient
    }

    fn least_squares(&self, columns: &[usize]) -> Option<DVector<f64>> {
        let right = DVector::from_fn(columns.len(), |i, _| self.right[columns[i]]);
        Some(factor(&self.products, columns)?.solve(&right))
    }
}

fn active_set(
    problem: &impl Problem,
    lengths: &[f64],
    mut passive: Vec<usize>,
    tolerance: f64,
) -> Result<DVector<f64>, NnlsError> {
    let columns = lengths.len();
    let mut x = DVector::zeros(columns);
    passive.retain(|&column| column < columns && lengths[column] > 0.0);
    // The largest part of the first columns whose least squares solution is positive, found by leaving out what is not.
    while !passive.is_empty() {
        let Some(z) = problem.least_squares(&passive) else {
            passive.clear();
            break;
        };
        let mut positive = z.iter().map(|&z| z > 0.0);
        if positive.clone().all(|positive| positive) {
            passive.iter().zip(z.iter()).for_each(|(&j, &z)| x[j] = z);
            break;
        }
        passive.retain(|_| positive.next().unwrap_or(false));
    }
    // Columns that rounding alone would bring in, until something else has moved.
    let without_length = || lengths.iter().map(|&length| length == 0.0).collect();
    let mut barred: Vec<bool> = without_length();
    let most = 10 * columns + 100;
    for _ in 0..most {
        let gradient = problem.gradient(&x);
        // What is in use is above zero.
        let free = (0..columns).filter(|&j| !barred[j] && x[j] == 0.0);
        let steepest = free.max_by(|&i, &j| gradient[i].total_cmp(&gradient[j]));
        let Some(entering) = steepest.filter(|&j| gradient[j] > tolerance) else {
            let used = x.iter_mut().zip(lengths).filter(|(x, _)| **x > 0.0);
            used.for_each(|(x, length)| *x /= length);
            return Ok(x);
        };
        passive.push(entering);
        if exchange(problem, &mut x, &mut passive) {
            barred = without_length();
        } else {
            passive.pop();
            barred[entering] = true;
        }
    }
    Err(NnlsError::NotConverged { iterations: most })
}

/// Moves x to the least squares solution on the passive columns, putting out those that would become negative. False,
/// with nothing changed, where the column that came in last cannot take part.
fn exchange(problem: &impl Problem, x: &mut DVector<f64>, passive: &mut Vec<usize>) -> bool {
    let mut entering = passive.last().copied();
    while !passive.is_empty() {
        let Some(z) = problem.least_squares(passive) else {
            return false;
        };
        if entering.take().is_some() && z[z.len() - 1] <= 0.0 {
            return false;
        }
        // How far towards z before a component reaches zero.
        let limits = passive.iter().zip(z.iter()).filter(|(_, z)| **z <= 0.0);
        let Some(share) = limits.map(|(&j, z)| x[j] / (x[j] - z)).reduce(f64::min) else {
            passive.iter().zip(z.iter()).for_each(|(&j, &z)| x[j] = z);
            return true;
        };
        for (&j, &z) in passive.iter().zip(z.iter()) {
            let limit = if z <= 0.0 { x[j] / (x[j] - z) } else { 1.0 };
            // The component that set the limit becomes exactly zero.
            x[j] = if z <= 0.0 && limit <= share {
                0.0
            } else {
                x[j] + share * (z - x[j])
            };
        }
        passive.retain(|&j| x[j] > 0.0);
    }
    true
}

/// The unconstrained least squares solution; `None` where the columns do not determine one.
pub fn least_squares(matrix: &DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
    if matrix.ncols() == 0 || matrix.ncols() > matrix.nrows() {
        return None;
    }
    let lengths = matrix.column_iter().map(|column| column.norm());
    let lengths: Vec<f64> = lengths.collect();
    let qr = matrix.clone().qr();
    let upper = qr.r();
    let determined = |j: usize| upper[(j, j)].abs() > RANK_TOLERANCE * lengths[j];
    if !(0..matrix.ncols()).all(determined) {
        return None;
    }
    let mut right = b.clone();
    qr.q_tr_mul(&mut right);
    upper.solve_upper_triangular(&right.rows(0, matrix.ncols()).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn problem(rows: usize, columns: usize, numbers: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let matrix = DMatrix::from_fn(rows, columns, |i, j| numbers[i * columns + j]);
        let b = DVector::from_fn(rows, |i, _| numbers[rows * columns + i]);
        (matrix, b)
    }

    /// The conditions of Karush, Kuhn and Tucker, which are necessary and sufficient here; the largest violation, relative.
    fn violation(matrix: &DMatrix<f64>, b: &DVector<f64>, x: &DVector<f64>) -> f64 {
        let gradient = matrix.tr_mul(&(b - matrix * x));
        let mut worst = 0.0_f64;
        for (j, column) in matrix.column_iter().enumerate() {
            assert!(x[j] >= 0.0);
            let relative = gradient[j] / (column.norm() * b.norm()).max(f64::MIN_POSITIVE);
            worst = worst.max(if x[j] > 0.0 { relative.abs() } else { relative });
        }
        worst
    }

    /// The smallest residual over every choice of columns whose unconstrained solution is not negative.
    fn exhaustive(matrix: &DMatrix<f64>, b: &DVector<f64>) -> f64 {
        let mut smallest = b.norm();
        for choice in 1_usize..1 << matrix.ncols() {
            let columns: Vec<usize> = (0..matrix.ncols())
                .filter(|j| choice >> j & 1 == 1)
                .collect();
            let chosen = matrix.select_columns(columns.iter());
            if let Some(z) = least_squares(&chosen, b)
                && z.iter().all(|&z| z >= 0.0)
            {
                smallest = smallest.min((b - chosen * z).norm());
            }
        }
        smallest
    }

    #[test]
    fn an_unconstrained_optimum_inside_is_found_and_one_outside_is_cut_off() {
        let matrix = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
        let inside = nnls(&matrix, &DVector::from_vec(vec![1.0, 2.0, 3.0])).unwrap();
        // A factorisation of three rows: a few roundings.
        assert!((inside - DVector::from_vec(vec![1.0, 2.0])).norm() < 1e-14);
        // Unconstrained: (-1, 2). With the first held at zero: (-0 + 2 + 1)/2.
        let outside = nnls(&matrix, &DVector::from_vec(vec![-1.0, 2.0, 1.0])).unwrap();
        assert!((outside - DVector::from_vec(vec![0.0, 1.5])).norm() < 1e-14);
        let nothing = nnls(&matrix, &DVector::from_vec(vec![-1.0, -2.0, -3.0])).unwrap();
        assert_eq!(nothing, DVector::zeros(2));
    }

    #[test]
    fn equal_and_empty_columns_do_no_harm() {
        let matrix = DMatrix::from_row_slice(2, 4, &[1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0]);
        let b = DVector::from_vec(vec![1.0, 3.0]);
        let x = nnls(&matrix, &b).unwrap();
        assert!((&b - &matrix * &x).norm() < 1e-14);
        assert_eq!(x[2], 0.0);
    }

    #[test]
    fn exponentials_packed_far_beyond_resolution_still_give_a_kkt_point() {
        // Forty retardation times per decade: the columns are equal to many digits.
        let times = DVector::from_fn(60, |i, _| 10_f64.powf(-1.0 + i as f64 / 15.0));
        let matrix = DMatrix::from_fn(60, 120, |i, j| {
            -(-times[i] / 10_f64.powf(-1.0 + j as f64 / 40.0)).exp_m1()
        });
        let b = times.map(|t| 1.0 - (-t / 2.345_f64).exp() + 0.1 * t.powf(0.2));
        let x = nnls(&matrix, &b).unwrap();
        // The tolerance of the method itself, and rounding of sums of 60.
        assert!(violation(&matrix, &b, &x) < 1e-12);
        assert!(x.iter().filter(|&&x| x > 0.0).count() < 30);
    }

    #[test]
    fn units_of_the_columns_do_not_matter() {
        let numbers: Vec<f64> = (0..40).map(|i| ((i * i) as f64 * 0.618).fract()).collect();
        let (matrix, b) = problem(8, 4, &numbers);
        let x = nnls(&matrix, &b).unwrap();
        let factors = [1e-9, 1.0, 1e12, 3.0];
        let scaled = DMatrix::from_fn(8, 4, |i, j| matrix[(i, j)] * factors[j]);
        let y = nnls(&scaled, &b).unwrap();
        for j in 0..4 {
            assert!((y[j] * factors[j] - x[j]).abs() <= 1e-12 * x.norm());
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused() {
        let matrix = DMatrix::from_row_slice(1, 1, &[f64::NAN]);
        let b = DVector::from_vec(vec![1.0]);
        assert_eq!(nnls(&matrix, &b), Err(NnlsError::NotFinite));
    }

    proptest! {
        #[test]
        fn the_answer_satisfies_the_optimality_conditions_and_beats_every_choice_of_columns(
            rows in 1_usize..9,
            columns in 1_usize..7,
            numbers in prop::collection::vec(-1.0_f64..1.0, 9 * 7 + 9),
        ) {
            let (matrix, b) = problem(rows, columns, &numbers);
            let x = nnls(&matrix, &b).unwrap();
            // Random columns can be nearly parallel: then rounding is amplified by the condition of the choice.
            prop_assert!(violation(&matrix, &b, &x) < 1e-9);
            prop_assert!((&b - &matrix * &x).norm() <= exhaustive(&matrix, &b) + 1e-9 * b.norm());
        }

        #[test]
        fn products_of_columns_give_the_same_from_wherever_they_start(
            columns in 1_usize..7,
            start in prop::collection::vec(0_usize..9, 0..7),
            numbers in prop::collection::vec(-1.0_f64..1.0, 40 * 7 + 40),
        ) {
            let (matrix, b) = problem(40, columns, &numbers);
            let mut start = start;
            start.sort_unstable();
            start.dedup();
            let (products, right) = (matrix.tr_mul(&matrix), matrix.tr_mul(&b));
            let x = nnls_from(&products, &right, start, 1e-9 * b.norm()).unwrap();
            // Forty random rows determine their columns: the products lose some digits of sixteen.
            prop_assert!((x - nnls(&matrix, &b).unwrap()).norm() < 1e-7);
        }
    }
}
