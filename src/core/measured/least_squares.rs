//! Linear least squares with few unknowns and many samples: normal equations of functions that are nearly orthogonal.
//!
//! A linear model is a matrix with a row for each of its functions and a column for each sample.

use nalgebra::{DMatrix, DVector};

/// Normal equations of some of the functions of a model, solved by Cholesky.
pub(super) struct Normal {
    factor: nalgebra::Cholesky<f64, nalgebra::Dyn>,
    /// By which functions were divided.
    scales: DVector<f64>,
    taken: Vec<usize>,
    all: usize,
}

impl Normal {
    /// Takes these functions of a model of which the products of all pairs are given; `None` where they depend on one another.
    pub(super) fn new(gram: &DMatrix<f64>, taken: Vec<usize>) -> Option<Self> {
        let scales = gram.diagonal().select_rows(&taken).map(f64::sqrt);
        if !scales.iter().all(|scale| scale.is_finite() && *scale > 0.0) {
            return None;
        }
        let products = gram.select_rows(&taken).select_columns(&taken);
        let factor = products
            .component_div(&(&scales * scales.transpose()))
            .cholesky()?;
        // The square root of what a function has of its own beside the others.
        let least = factor.l_dirty().diagonal().min();
        (least > 1e-6).then_some(Self {
            factor,
            scales,
            taken,
            all: gram.nrows(),
        })
    }

    /// Coefficients of all functions for a signal of which the products with all are given; zero for those that were not taken.
    pub(super) fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        let solution = self
            .factor
            .solve(&self.scaled(right))
            .component_div(&self.scales);
        let mut coefficients = DVector::zeros(self.all);
        for (place, value) in self.taken.iter().zip(&solution) {
            coefficients[*place] = *value;
        }
        coefficients
    }

    /// The square of what the taken functions hold of a signal of which the products with all are given.
    pub(super) fn explained(&self, right: &DVector<f64>) -> f64 {
        let scaled = self.scaled(right);
        scaled.dot(&self.factor.solve(&scaled))
    }

    /// The inverse of the normal matrix, in the order of the taken functions.
    pub(super) fn inverse(&self) -> DMatrix<f64> {
        let scales = &self.scales * self.scales.transpose();
        self.factor.inverse().component_div(&scales)
    }

    fn scaled(&self, right: &DVector<f64>) -> DVector<f64> {
        right.select_rows(&self.taken).component_div(&self.scales)
    }
}

/// The functions 1, then sin and cos of every multiple of the angle, at one sample. Returns how many these are.
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
        let mut design = DMatrix::zeros(5, 40);
        let truth = [0.3, -1.0, 2.0, 0.5, 0.25];
        for (i, mut sample) in (0..).zip(design.column_iter_mut()) {
            let angle = 0.41 * f64::from(i) + 0.1 * f64::from(i * i % 7);
            harmonic_columns(sample.as_mut_slice(), angle, 2);
        }
        let gram = &design * design.transpose();
        let signal = design.tr_mul(&DVector::from_column_slice(&truth));
        let normal = Normal::new(&gram, (0..5).collect()).unwrap();
        let right = &design * &signal;
        for (found, expected) in normal.solve(&right).iter().zip(truth) {
            // Normal equations of a condition number of some tens.
            assert!((found - expected).abs() < 1e-13);
        }
        let whole: f64 = signal.iter().map(|value| value * value).sum();
        assert!((normal.explained(&right) / whole - 1.0).abs() < 1e-13);
        assert!(Normal::new(&gram, vec![1, 1]).is_none());
    }
}
