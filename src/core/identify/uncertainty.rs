//! What a least squares solution leaves open: covariance, intervals, and combinations that the data do not determine.

use nalgebra::{DMatrix, DVector, SVD};

use crate::identify::series::Point;
use crate::numerics::levenberg_marquardt::central_difference;

/// Singular values below this part of the largest count as none: what they stand for is not in the data at all.
const NONE: f64 = 1e-9;

/// Step of an unknown for derivatives of the complex modulus.
const STEP: f64 = 1e-4;

/// Directions of the unknowns, and how far the data let each of them go.
#[derive(Debug, Clone)]
pub(crate) struct Directions {
    /// Descending.
    pub(super) singular_values: Vec<f64>,
    /// A row for each direction, of length one.
    pub(super) vectors: DMatrix<f64>,
    /// Standard deviation along each, as a logarithm.
    pub(super) deviations: Vec<f64>,
    /// By how much all unknowns may be off together for an error that the data have in common, beside their noise.
    shift: Option<DVector<f64>>,
}

impl Directions {
    /// Of derivatives of residuals that scatter with this standard deviation; `None` where there is no decomposition.
    pub(crate) fn new(derivatives: &DMatrix<f64>, scatter: f64) -> Option<Self> {
        if !derivatives.iter().all(|value| value.is_finite()) {
            return None;
        }
        // As many directions as unknowns, also where there are fewer data.
        let (rows, columns) = derivatives.shape();
        let padded = match rows < columns {
            true => derivatives.clone().resize_vertically(columns, 0.0),
            false => derivatives.clone(),
        };
        let decomposed = SVD::new(padded, false, true);
        let vectors = decomposed.v_t?;
        let singular_values: Vec<f64> = decomposed.singular_values.iter().copied().collect();
        let largest = singular_values.iter().fold(0.0_f64, |a, s| a.max(*s));
        let deviations = singular_values
            .iter()
            .map(|s| scatter / s.max(NONE * largest));
        Some(Self {
            deviations: deviations.collect(),
            vectors,
            singular_values,
            shift: None,
        })
    }

    /// Includes an error that all computed numbers have together: `changes` of their residuals, to which the unknowns answer as least
    /// squares do. All of the answer is within an interval of this half width, in standard deviations.
    pub(super) fn include(&mut self, derivatives: &DMatrix<f64>, changes: &[f64], half_width: f64) {
        let changes = DVector::from_column_slice(changes);
        let of_data = derivatives.rows(0, changes.len());
        let largest = self.singular_values.iter().fold(0.0_f64, |a, s| a.max(*s));
        let mut along = &self.vectors * of_data.tr_mul(&changes);
        for (along, singular) in along.iter_mut().zip(&self.singular_values) {
            *along /= half_width * singular.max(NONE * largest).powi(2);
        }
        self.shift = Some(self.vectors.tr_mul(&along));
    }

    /// Covariance of the unknowns.
    pub(crate) fn covariance(&self) -> DMatrix<f64> {
        let squares = self.deviations.iter().map(|d| d * d);
        let diagonal = DMatrix::from_diagonal(&DVector::from_vec(squares.collect()));
        let of_noise = self.vectors.transpose() * diagonal * &self.vectors;
        match &self.shift {
            Some(shift) => of_noise + shift * shift.transpose(),
            None => of_noise,
        }
    }

    /// Variance of a quantity with this gradient.
    pub(crate) fn variance(&self, gradient: &DVector<f64>) -> f64 {
        // A gradient by the first unknowns alone.
        let gradient = gradient
            .clone()
            .resize_vertically(self.vectors.ncols(), 0.0);
        let along = &self.vectors * &gradient;
        let of_noise = along.iter().zip(&self.deviations);
        let of_noise: f64 = of_noise.map(|(a, d)| (a * d).powi(2)).sum();
        let common = self.shift.as_ref().map_or(0.0, |s| s.dot(&gradient));
        of_noise + common * common
    }
}

/// Gradients of two functions by the first so many unknowns, by central differences; `None` where there is no value.
pub(crate) fn gradients(
    unknowns: &[f64],
    count: usize,
    step: f64,
    both: &impl Fn(Vec<f64>) -> Option<[f64; 2]>,
) -> Option<[DVector<f64>; 2]> {
    let both = |moved| both(moved).map(|both| DVector::from_column_slice(&both));
    let columns = (0..count).map(|place| central_difference(unknowns, place, step, &both));
    let columns: Vec<DVector<f64>> = columns.collect::<Option<_>>()?;
    Some([0, 1].map(|part| DVector::from_fn(count, |place, _| columns[place][part])))
}

/// Logarithms of storage and loss modulus (Pa), and their gradients.
pub(super) fn moduli(point: &Point, angular_frequency_rad_per_s: f64) -> [(f64, DVector<f64>); 2] {
    let ln = |point: &Point| {
        let modulus = point.complex_modulus(angular_frequency_rad_per_s);
        [modulus.re, modulus.im].map(|part| part.max(f64::MIN_POSITIVE).ln())
    };
    let of = |moved| Some(ln(&Point(moved)));
    let count = point.0.len();
    let gradients = gradients(&point.0, count, STEP, &of);
    let [of_storage, of_loss] =
        gradients.unwrap_or_else(|| [(); 2].map(|()| DVector::zeros(count)));
    let [storage, loss] = ln(point);
    [(storage, of_storage), (loss, of_loss)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_combination_that_no_datum_feels_is_wide_open_and_the_others_are_not() {
        // Two data that feel the sum of two unknowns alone.
        let matrix = DMatrix::from_row_slice(3, 2, &[1.0, 1.0, 2.0, 2.0, 2.0, 2.0]);
        let directions = Directions::new(&matrix, 0.1).unwrap();
        let sum = DVector::from_vec(vec![1.0, 1.0]);
        let difference = DVector::from_vec(vec![1.0, -1.0]);
        // Variance of a sum that is measured with weights 1, 4 and 4.
        assert!((directions.variance(&sum) / (0.01 / 9.0) - 1.0).abs() < 1e-9);
        assert!(directions.variance(&difference) > 1e6);
    }

    #[test]
    fn an_error_in_common_moves_all_unknowns_and_averages_over_no_data() {
        // A hundred data of one unknown: their noise averages to a tenth, an error that they all have does not.
        let matrix = DMatrix::from_element(100, 1, 1.0);
        let mut directions = Directions::new(&matrix, 1.0).unwrap();
        let own = DVector::from_vec(vec![1.0]);
        assert!((directions.variance(&own) - 0.01).abs() < 1e-12);
        directions.include(&matrix, &[3.0; 100], 2.0);
        let expected = 0.01 + 1.5_f64.powi(2);
        assert!((directions.variance(&own) - expected).abs() < 1e-12);
        assert!((directions.covariance()[(0, 0)] - expected).abs() < 1e-12);
    }

    #[test]
    fn the_gradient_of_the_moduli_is_that_of_a_maxwell_element() {
        let point = Point(vec![1e6_f64.ln(), 1e8_f64.ln(), 0.0]);
        let [(storage, of_storage), (loss, of_loss)] = moduli(&point, 1.0);
        // At x = 1: E' = g_inf + g/2, E'' = g/2, which does not change with the time.
        assert!(
            (storage.exp() / 5.1e7 - 1.0).abs() < 1e-12 && (loss.exp() / 5e7 - 1.0).abs() < 1e-12
        );
        assert!((of_storage[1] - 5e7 / 5.1e7).abs() < 1e-7 && (of_loss[1] - 1.0).abs() < 1e-7);
        assert!((of_storage[2] - 5e7 / 5.1e7).abs() < 1e-7 && of_loss[2].abs() < 1e-7);
    }
}
