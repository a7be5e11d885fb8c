//! Real Fourier transform of a row that is one period, or a little less, filled up with zeros.

use std::sync::Arc;

use contact_dma_transforms::Precision;
use num_complex::Complex;
use realfft::{ComplexToReal, FftError, RealToComplex};

use super::even_column::FrequencyPerBin;
use super::length::fast_row_half;
use super::spectral::Row;

/// Plans for rows of one length. Immutable; buffers are the caller's.
pub(super) struct PeriodicRow<T = f64> {
    period: usize,
    forward: Arc<dyn RealToComplex<T>>,
    inverse: Arc<dyn ComplexToReal<T>>,
}

impl<T: Precision> PeriodicRow<T> {
    /// Plans for rows of `cells` values, and what it takes for a period of which transforms run fast.
    pub(super) fn new(cells: usize) -> Self {
        Self::of_period(2 * fast_row_half(cells))
    }

    /// Plans for rows that repeat after this many values.
    pub(super) fn of_period(period: usize) -> Self {
        Self {
            period,
            forward: T::real_forward(period),
            inverse: T::real_inverse(period),
        }
    }

    /// Transforms a period, which it overwrites, into its frequencies.
    pub(super) fn bins_of(
        &self,
        period: &mut [T],
        bins: &mut [Complex<T>],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        let work = &mut work[..self.forward.get_scratch_len()];
        self.forward.process_with_scratch(period, bins, work)
    }

    /// Transforms frequencies, which it overwrites, back into a period.
    pub(super) fn period_of(
        &self,
        bins: &mut [Complex<T>],
        period: &mut [T],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        // Real by symmetry; the transform refuses what rounding leaves there.
        bins[0].im = T::zero();
        if self.period.is_multiple_of(2) {
            bins[self.period / 2].im = T::zero();
        }
        let work = &mut work[..self.inverse.get_scratch_len()];
        self.inverse.process_with_scratch(bins, period, work)
    }
}

/// A row, and zeros beyond it.
pub(super) fn fill_up<T: Precision>(row: &[T], buffer: &mut [T]) {
    let (given, beyond) = buffer.split_at_mut(row.len());
    given.copy_from_slice(row);
    beyond.fill(T::zero());
}

impl<T: Precision> Row<T> for PeriodicRow<T> {
    fn period(&self) -> usize {
        self.period
    }

    fn bins(&self) -> usize {
        self.period / 2 + 1
    }

    fn buffer_length(&self) -> usize {
        self.period
    }

    fn work_length(&self) -> usize {
        let forward = self.forward.get_scratch_len();
        forward.max(self.inverse.get_scratch_len())
    }

    fn forward(
        &self,
        row: &[T],
        bins: &mut [Complex<T>],
        buffer: &mut [T],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        fill_up(row, buffer);
        self.bins_of(buffer, bins, work)
    }

    fn inverse(
        &self,
        bins: &mut [Complex<T>],
        row: &mut [T],
        buffer: &mut [T],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        self.period_of(bins, buffer, work)?;
        row.copy_from_slice(&buffer[..row.len()]);
        Ok(())
    }
}

impl<T: Precision> FrequencyPerBin<T> for PeriodicRow<T> {
    fn frequency_and_weight(&self, bin: usize) -> (usize, f64) {
        (bin, 1.0)
    }
}
