//! Spectrum of the influence coefficients on the padded grid.
//!
//! Periodic on the padded grid, a coefficient depends on the shorter way round. That function is even in both
//! directions, so its spectrum is real and even, and half the frequencies of each direction hold all of it.

use std::sync::Arc;

use num_complex::Complex;
use realfft::{FftError, RealFftPlanner, RealToComplex};

use super::super::influence::Influence;
use super::spectral::Row;

/// Rows whose every bin is one frequency.
pub(super) trait FrequencyPerBin: Row {
    /// Frequency of a bin as a real even function sees it, and how often it occurs in the sum of the inverse transform as
    /// this type takes it.
    fn frequency_and_weight(&self, bin: usize) -> (usize, f64);
}

/// The spectrum in the order in which an [`EvenColumn`](super::even_column::EvenColumn) uses it: for every bin of `row`, the
/// frequencies `0..=column_length / 2` along the column, scaled so that the inverse transforms need no scaling of their own.
pub(super) fn columns(
    influence: &Influence,
    row: &impl FrequencyPerBin,
    column_length: usize,
) -> Result<Vec<f64>, FftError> {
    let mut kernel = Kernel::new(influence, row.period(), column_length)?;
    let column_half = column_length / 2 + 1;
    let mut columns = vec![0.0; row.bins() * column_half];
    for (bin, spectrum) in columns.chunks_exact_mut(column_half).enumerate() {
        let (frequency, weight) = row.frequency_and_weight(bin);
        kernel.column(frequency, spectrum)?;
        let scale = weight / (row.period() as f64 * column_length as f64);
        spectrum.iter_mut().for_each(|value| *value *= scale);
    }
    Ok(columns)
}

/// The influence coefficients, transformed along x.
pub(super) struct Kernel {
    /// For every offset along y up to half the period, the frequencies along x up to half of theirs.
    rows: Vec<f64>,
    row_half: usize,
    along_y: EvenTransform,
}

impl Kernel {
    /// Coefficients made periodic with these lengths.
    pub(super) fn new(
        influence: &Influence,
        period_x: usize,
        period_y: usize,
    ) -> Result<Self, FftError> {
        let (row_half, column_half) = (period_x / 2 + 1, period_y / 2 + 1);
        let mut planner = RealFftPlanner::new();
        let mut along_x = EvenTransform::new(planner.plan_fft_forward(period_x));
        let mut rows = vec![0.0; column_half * row_half];
        for (offset_y, spectrum) in rows.chunks_exact_mut(row_half).enumerate() {
            let coefficient = |offset_x| influence.coefficient_m(offset_x, offset_y);
            along_x.transform(coefficient, spectrum)?;
        }
        Ok(Self {
            rows,
            row_half,
            along_y: EvenTransform::new(planner.plan_fft_forward(period_y)),
        })
    }

    /// The frequencies `0..=period_y / 2` along y at one frequency along x, not scaled.
    pub(super) fn column(
        &mut self,
        frequency: usize,
        spectrum: &mut [f64],
    ) -> Result<(), FftError> {
        let (rows, row_half) = (&self.rows, self.row_half);
        let value = |offset_y| rows[offset_y * row_half + frequency];
        self.along_y.transform(value, spectrum)
    }
}

/// Fourier transform of an even periodic function, which is real.
struct EvenTransform {
    plan: Arc<dyn RealToComplex<f64>>,
    values: Vec<f64>,
    spectrum: Vec<Complex<f64>>,
    work: Vec<Complex<f64>>,
}

impl EvenTransform {
    fn new(plan: Arc<dyn RealToComplex<f64>>) -> Self {
        Self {
            values: plan.make_input_vec(),
            spectrum: plan.make_output_vec(),
            work: plan.make_scratch_vec(),
            plan,
        }
    }

    /// Transforms the function whose value at the distance `d` from the origin is `value(d)`.
    fn transform(
        &mut self,
        value: impl Fn(usize) -> f64,
        spectrum: &mut [f64],
    ) -> Result<(), FftError> {
        let length = self.values.len();
        for distance in 0..=length / 2 {
            let here = value(distance);
            self.values[distance] = here;
            if distance > 0 {
                self.values[length - distance] = here;
            }
        }
        self.plan
            .process_with_scratch(&mut self.values, &mut self.spectrum, &mut self.work)?;
        for (real, complex) in spectrum.iter_mut().zip(&self.spectrum) {
            *real = complex.re;
        }
        Ok(())
    }
}
