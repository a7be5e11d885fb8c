//! Real Fourier transform of a row that is one period, or a little less, filled up with zeros.

use std::sync::Arc;

use num_complex::Complex;
use realfft::{ComplexToReal, FftError, RealFftPlanner, RealToComplex};

use super::even_column::FrequencyPerBin;
use super::length::fast_row_half;
use super::spectral::Row;

/// Plans for rows of one length. Immutable; buffers are the caller's.
pub(super) struct PeriodicRow {
    /// Half the period.
    half: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
}

impl PeriodicRow {
    /// Plans for rows of `cells` values.
    pub(super) fn new(cells: usize) -> Self {
        let half = fast_row_half(cells);
        let mut planner = RealFftPlanner::new();
        Self {
            half,
            forward: planner.plan_fft_forward(2 * half),
            inverse: planner.plan_fft_inverse(2 * half),
        }
    }
}

impl Row for PeriodicRow {
    fn period(&self) -> usize {
        2 * self.half
    }

    fn bins(&self) -> usize {
        self.half + 1
    }

    fn buffer_length(&self) -> usize {
        2 * self.half
    }

    fn work_length(&self) -> usize {
        let forward = self.forward.get_scratch_len();
        forward.max(self.inverse.get_scratch_len())
    }

    fn forward(
        &self,
        row: &[f64],
        bins: &mut [Complex<f64>],
        buffer: &mut [f64],
        work: &mut [Complex<f64>],
    ) -> Result<(), FftError> {
        let (given, beyond) = buffer.split_at_mut(row.len());
        given.copy_from_slice(row);
        beyond.fill(0.0);
        let work = &mut work[..self.forward.get_scratch_len()];
        self.forward.process_with_scratch(buffer, bins, work)
    }

    fn inverse(
        &self,
        bins: &mut [Complex<f64>],
        row: &mut [f64],
        buffer: &mut [f64],
        work: &mut [Complex<f64>],
    ) -> Result<(), FftError> {
        // Real by symmetry; the transform refuses what rounding leaves there.
        for real in [0, self.half] {
            bins[real].im = 0.0;
        }
        let work = &mut work[..self.inverse.get_scratch_len()];
        self.inverse.process_with_scratch(bins, buffer, work)?;
        row.copy_from_slice(&buffer[..row.len()]);
        Ok(())
    }
}

impl FrequencyPerBin for PeriodicRow {
    fn frequency_and_weight(&self, bin: usize) -> (usize, f64) {
        (bin, 1.0)
    }
}
