//! Linear least squares with few unknowns and many samples: normal equations of columns that are nearly orthogonal.

use nalgebra::{DMatrix, DVector};

/// Rows of a linear model, one a sample.
pub(super) struct Design {
    columns: usize,
    values: Vec<f64>,
}

impl Design {
    pub(super) fn new(columns: usize, samples: usize) -> Self {
        Self {
            columns,
            values: Vec::with_capacity(columns * samples),
        }
    }

    /// Appends a row, filled by the caller.
    pub(super) fn push(&mut self, fill: impl FnOnce(&mut [f64])) {
        let from = self.values.len();
        self.values.resize(from + self.columns, 0.0);
        fill(&mut self.values[from..]);
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.columns)
    }

    /// Products of all pairs of columns.
    pub(super) fn gram(&self) -> DMatrix<f64> {
        let p = self.columns;
        let mut lower = vec![0.0; p * p];
        // Four rows at once: the sums are then read and written a quarter as often.
        let mut fours = self.values.chunks_exact(4 * p);
        for four in fours.by_ref() {
            let (first, second) = four.split_at(2 * p);
            let ((a, b), (c, d)) = (first.split_at(p), second.split_at(p));
            for i in 0..p {
                let x = [a[i], b[i], c[i], d[i]];
                let sums = lower[i * p..=i * p + i].iter_mut();
                for ((((sum, a), b), c), d) in sums.zip(a).zip(b).zip(c).zip(d) {
                    *sum += (x[0] * a + x[1] * b) + (x[2] * c + x[3] * d);
                }
            }
        }
        for row in fours.remainder().chunks_exact(p) {
            for (i, x) in row.iter().enumerate() {
                for (sum, other) in lower[i * p..=i * p + i].iter_mut().zip(row) {
                    *sum += x * other;
                }
            }
        }
        DMatrix::from_fn(p, p, |i, j| lower[i.max(j) * p + i.min(j)])
    }

    /// Products of all columns with a signal.
    pub(super) fn with(&self, signal: impl Iterator<Item = f64>) -> DVector<f64> {
        let mut sums = vec![0.0; self.columns];
        for (row, value) in self.rows().zip(signal) {
            for (sum, x) in sums.iter_mut().zip(row) {
                *sum += x * value;
            }
        }
        DVector::from_vec(sums)
    }

    /// The model with these coefficients, sample by sample.
    pub(super) fn model<'a>(&'a self, coefficients: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let product = move |row: &[f64]| row.iter().zip(coefficients).map(|(x, c)| x * c).sum();
        self.rows().map(product)
    }
}

/// Normal equations of some of the columns, solved by Cholesky.
pub(super) struct Normal {
    factor: nalgebra::Cholesky<f64, nalgebra::Dyn>,
    /// By which columns were divided.
    scales: Vec<f64>,
    columns: Vec<usize>,
    all: usize,
}

impl Normal {
    /// Takes these columns; `None` where they depend on one another.
    pub(super) fn new(gram: &DMatrix<f64>, columns: Vec<usize>) -> Option<Self> {
        let scales: Vec<f64> = columns.iter().map(|i| gram[(*i, *i)].sqrt()).collect();
        if scales
            .iter()
            .any(|scale| !(scale.is_finite() && *scale > 0.0))
        {
            return None;
        }
        let p = columns.len();
        let scaled = DMatrix::from_fn(p, p, |i, j| {
            gram[(columns[i], columns[j])] / (scales[i] * scales[j])
        });
        let factor = scaled.cholesky()?;
        // The square root of what a column has of its own beside the others.
        let least = (0..p).map(|i| factor.l_dirty()[(i, i)]).fold(1.0, f64::min);
        (least > 1e-6).then_some(Self {
            factor,
            scales,
            columns,
            all: gram.nrows(),
        })
    }

    /// Coefficients of all columns, zero for those that were not taken.
    pub(super) fn solve(&self, right: &DVector<f64>) -> Vec<f64> {
        let scaled = self.scaled(right);
        let solution = self.factor.solve(&scaled);
        let mut coefficients = vec![0.0; self.all];
        for (k, column) in self.columns.iter().enumerate() {
            coefficients[*column] = solution[k] / self.scales[k];
        }
        coefficients
    }

    /// The square of what the taken columns hold of a vector whose products with all columns these are.
    pub(super) fn explained(&self, right: &DVector<f64>) -> f64 {
        let scaled = self.scaled(right);
        scaled.dot(&self.factor.solve(&scaled))
    }

    /// The inverse of the normal matrix, in the order of the taken columns.
    pub(super) fn inverse(&self) -> DMatrix<f64> {
        let inverse = self.factor.inverse();
        let p = self.scales.len();
        DMatrix::from_fn(p, p, |i, j| {
            inverse[(i, j)] / (self.scales[i] * self.scales[j])
        })
    }

    fn scaled(&self, right: &DVector<f64>) -> DVector<f64> {
        let columns = self.columns.iter().zip(&self.scales);
        DVector::from_iterator(
            self.scales.len(),
            columns.map(|(i, scale)| right[*i] / scale),
        )
    }
}

/// Columns of one sample: 1, then sin and cos of every multiple of the angle. Returns how many these are.
pub(super) fn harmonic_columns(row: &mut [f64], angle: f64, harmonics: usize) -> usize {
    let (sine, cosine) = angle.sin_cos();
    let (mut s, mut c) = (sine, cosine);
    row[0] = 1.0;
    for n in 0..harmonics {
        row[1 + 2 * n] = s;
        row[2 + 2 * n] = c;
        (s, c) = (s * cosine + c * sine, c * cosine - s * sine);
    }
    1 + 2 * harmonics
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_of_an_exact_model_come_back_at_times_that_are_not_uniform() {
        let mut design = Design::new(5, 40);
        let truth = [0.3, -1.0, 2.0, 0.5, 0.25];
        for i in 0..40 {
            let angle = 0.41 * f64::from(i) + 0.1 * f64::from(i * i % 7);
            design.push(|row| {
                harmonic_columns(row, angle, 2);
            });
        }
        let gram = design.gram();
        let signal: Vec<f64> = design.model(&truth).collect();
        let normal = Normal::new(&gram, (0..5).collect()).unwrap();
        let right = design.with(signal.iter().copied());
        for (found, expected) in normal.solve(&right).iter().zip(truth) {
            // Normal equations of a condition number of some tens.
            assert!((found - expected).abs() < 1e-13);
        }
        let whole: f64 = signal.iter().map(|value| value * value).sum();
        assert!((normal.explained(&right) / whole - 1.0).abs() < 1e-13);
        assert!(Normal::new(&gram, vec![1, 1]).is_none());
    }
}
