//! The influence coefficients as a spectrum on the padded grid, and columns multiplied by it.
//!
//! Periodic on the padded grid, a coefficient depends on the shorter way round. That function is even in both
//! directions, so its spectrum is real and even, and half the frequencies of each direction hold all of it.

use std::ops::Range;
use std::sync::Arc;

use contact_dma_transforms::Precision;
use num_complex::Complex;
use realfft::{FftError, RealToComplex};
use rustfft::Fft;

use super::spectral::{Column, Row, zero};

/// Rows whose every bin is one frequency.
pub(super) trait FrequencyPerBin<T: Precision>: Row<T> {
    /// Frequency of a bin as a real even function sees it, and how often it occurs in the sum of the inverse transform as
    /// this type takes it.
    fn frequency_and_weight(&self, bin: usize) -> (usize, f64);
}

/// A function of frequency and scaled spectrum of coefficients, given by their offsets in cells along x and y, in the order in which an
/// [`EvenColumn`] uses it: for every bin of `row`, the frequencies `0..=column_length / 2` along the column, scaled so that the inverse
/// transforms need no scaling of their own.
pub(super) fn spectrum<T: Precision>(
    coefficient: impl Fn(usize, usize) -> f64,
    row: &impl FrequencyPerBin<T>,
    column_length: usize,
    function: impl Fn((usize, usize), f64) -> f64,
) -> Result<Vec<f64>, FftError> {
    let mut kernel = Kernel::new(coefficient, row.period(), column_length)?;
    let mut column = vec![0.0; column_length / 2 + 1];
    let mut spectrum = Vec::with_capacity(row.bins() * column.len());
    for bin in 0..row.bins() {
        let (frequency, weight) = row.frequency_and_weight(bin);
        kernel.column(frequency, &mut column)?;
        let scale = weight / (row.period() as f64 * column_length as f64);
        let values = column.iter().enumerate();
        spectrum.extend(values.map(|(l, value)| function((frequency, l), value * scale)));
    }
    Ok(spectrum)
}

/// Coefficients, transformed along x.
pub(super) struct Kernel {
    /// For every offset along y up to half the period, the frequencies along x up to half of theirs.
    rows: Vec<f64>,
    row_half: usize,
    along_y: EvenTransform,
}

impl Kernel {
    /// Coefficients made periodic with these lengths.
    pub(super) fn new(
        coefficient: impl Fn(usize, usize) -> f64,
        period_x: usize,
        period_y: usize,
    ) -> Result<Self, FftError> {
        let (row_half, column_half) = (period_x / 2 + 1, period_y / 2 + 1);
        let mut along_x = EvenTransform::new(f64::real_forward(period_x));
        let mut rows = vec![0.0; column_half * row_half];
        for (offset_y, spectrum) in rows.chunks_exact_mut(row_half).enumerate() {
            along_x.transform(|offset_x| coefficient(offset_x, offset_y), spectrum)?;
        }
        Ok(Self {
            rows,
            row_half,
            along_y: EvenTransform::new(f64::real_forward(period_y)),
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

/// Plans for columns of one length.
pub(super) struct EvenColumn<T = f64> {
    length: usize,
    forward: Arc<dyn Fft<T>>,
    inverse: Arc<dyn Fft<T>>,
}

impl<T: Precision> EvenColumn<T> {
    /// Plans for columns of this length, padding included.
    pub(super) fn new(length: usize) -> Self {
        let (forward, inverse) = T::complex(length);
        Self {
            length,
            forward,
            inverse,
        }
    }
}

impl<T: Precision> Column<T> for EvenColumn<T> {
    fn length(&self) -> usize {
        self.length
    }

    fn period(&self) -> usize {
        self.length
    }

    fn work_length(&self) -> usize {
        let forward = self.forward.get_inplace_scratch_len();
        forward.max(self.inverse.get_inplace_scratch_len())
    }

    fn multiply(
        &self,
        column: &mut [Complex<T>],
        loaded: &Range<usize>,
        _wanted: &Range<usize>,
        kernel: &[T],
        work: &mut [Complex<T>],
    ) {
        let column = &mut column[..self.length];
        column[..loaded.start].fill(zero());
        column[loaded.end..].fill(zero());
        self.forward.process_with_scratch(column, work);
        multiply_by_even(column, kernel);
        self.inverse.process_with_scratch(column, work);
    }
}

/// Multiplies frequency `k` and its mirror image `length - k` by `even[k]`.
fn multiply_by_even<T: Precision>(column: &mut [Complex<T>], even: &[T]) {
    let (Some((zero, others)), Some((even_zero, even))) =
        (column.split_first_mut(), even.split_first())
    else {
        return;
    };
    *zero = *zero * even_zero;
    let pairs = others.len() / 2;
    let (lower, upper) = others.split_at_mut(pairs);
    let mirrored = upper.iter_mut().rev();
    for ((a, b), factor) in lower.iter_mut().zip(mirrored).zip(even) {
        *a = *a * factor;
        *b = *b * factor;
    }
    // An even length has one frequency that is its own mirror image; `upper` is then one longer than `lower`.
    if upper.len() > pairs
        && let (Some(middle), Some(factor)) = (upper.first_mut(), even.get(pairs))
    {
        *middle = *middle * factor;
    }
}
