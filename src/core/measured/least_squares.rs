//! Linear least squares with few unknowns and many samples: normal equations of functions that are nearly orthogonal.
//!
//! A linear model is a matrix with a row for each of its functions and a column for each sample.

use nalgebra::{DMatrix, DVector};

/// What a function must have of its own beside the others, as a part of its size.
pub(super) const LEAST: f64 = 1e-6;

/// Normal equations of a linear model, solved by Cholesky.
pub(super) struct Normal {
    factor: nalgebra::Cholesky<f64, nalgebra::Dyn>,
    /// By which functions were divided.
    scales: DVector<f64>,
}

impl Normal {
    /// `None` where the functions depend on one another.
    pub(super) fn new(design: &DMatrix<f64>) -> Option<Self> {
        let gram = design * design.transpose();
        let scales = gram.diagonal().map(f64::sqrt);
        if !scales.iter().all(|scale| scale.is_finite() && *scale > 0.0) {
            return None;
        }
        let factor = gram
            .component_div(&(&scales * scales.transpose()))
            .cholesky()?;
        // The square root of what a function has of its own beside the others.
        let least = factor.l_dirty().diagonal().min();
        (least > LEAST).then_some(Self { factor, scales })
    }

    /// Coefficients of the functions for a signal of which the products with them are given.
    pub(super) fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        let scaled = right.component_div(&self.scales);
        self.factor.solve(&scaled).component_div(&self.scales)
    }

    /// The inverse of the normal matrix.
    pub(super) fn inverse(&self) -> DMatrix<f64> {
        let scales = &self.scales * self.scales.transpose();
        self.factor.inverse().component_div(&scales)
    }
}

/// The functions 1, then sin and cos of every multiple of the angle, at one sample.
pub(super) fn harmonic_columns(row: &mut [f64], angle: f64) {
    let (sine, cosine) = angle.sin_cos();
    let (mut s, mut c) = (sine, cosine);
    row[0] = 1.0;
    for pair in row[1..].chunks_exact_mut(2) {
        pair.copy_from_slice(&[s, c]);
        (s, c) = (s * cosine + c * sine, c * cosine - s * sine);
    }
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
            harmonic_columns(sample.as_mut_slice(), angle);
        }
        let signal = design.tr_mul(&DVector::from_column_slice(&truth));
        let normal = Normal::new(&design).unwrap();
        for (found, expected) in normal.solve(&(&design * &signal)).iter().zip(truth) {
            // Normal equations of a condition number of some tens.
            assert!((found - expected).abs() < 1e-13);
        }
        assert!(Normal::new(&design.select_rows(&[1, 1])).is_none());
    }
}
