//! Real Fourier transform of a row that is zero in its second half, in two transforms of a quarter of its length.
//!
//! A row of `m` values padded with zeros to `2m` has two kinds of frequencies. The even ones, `2k`, are the transform of
//! the unpadded row. The odd ones come in conjugate pairs, of which the frequencies `4l + 1` are one each, and
//!
//! ```text
//! X(4l+1) = sum over j < m/2 of  [x(j) - i x(j + m/2)] w^j  exp(-2 pi i j l / (m/2)),     w = exp(-i pi / m)
//! ```
//!
//! that is one complex transform of `m/2` values. Backwards, only the first `m` values are wanted; they are the sum of
//! what the even frequencies give (which repeats after `m`) and of what the odd ones give (which repeats with the
//! opposite sign). So the padding is never stored, and nothing is computed from it or for it.

use std::f64::consts::PI;
use std::sync::Arc;

use contact_dma_transforms::Precision;
use num_complex::Complex;
use realfft::FftError;
use rustfft::Fft;

use super::even_column::FrequencyPerBin;
use super::length::fast_row_half;
use super::periodic_row::{PeriodicRow, fill_up};
use super::spectral::Row;

/// Plans for rows of one length. Immutable; buffers are the caller's.
pub(super) struct PaddedRow<T = f64> {
    /// A quarter of the padded length, `m/2`.
    quarter: usize,
    /// Of the unpadded row.
    even: PeriodicRow<T>,
    odd_forward: Arc<dyn Fft<T>>,
    odd_inverse: Arc<dyn Fft<T>>,
    /// `w^j` for `j < m/2`.
    twist: Vec<Complex<T>>,
}

impl<T: Precision> PaddedRow<T> {
    /// Plans for rows of `cells` values, padded to at least twice that.
    pub(super) fn new(cells: usize) -> Self {
        let quarter = fast_row_half(cells);
        let (odd_forward, odd_inverse) = T::complex(quarter);
        let angle = -PI / (2 * quarter) as f64;
        Self {
            quarter,
            even: PeriodicRow::of_period(2 * quarter),
            odd_forward,
            odd_inverse,
            twist: (0..quarter)
                .map(|j| Complex::cis(angle * j as f64))
                .map(|w: Complex<f64>| Complex::new(T::of(w.re), T::of(w.im)))
                .collect(),
        }
    }
}

impl<T: Precision> Row<T> for PaddedRow<T> {
    /// Length of the padded row, `2m`.
    fn period(&self) -> usize {
        4 * self.quarter
    }

    /// Number of frequencies kept: `m/2 + 1` even ones, then `m/2` odd ones.
    fn bins(&self) -> usize {
        2 * self.quarter + 1
    }

    /// Length of the buffer for one real row.
    fn buffer_length(&self) -> usize {
        2 * self.quarter
    }

    /// Length of the work space of the transforms.
    fn work_length(&self) -> usize {
        (self.even.work_length())
            .max(self.odd_forward.get_inplace_scratch_len())
            .max(self.odd_inverse.get_inplace_scratch_len())
    }

    /// Transforms `row` into `bins`, not scaled.
    fn forward(
        &self,
        row: &[T],
        bins: &mut [Complex<T>],
        buffer: &mut [T],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        fill_up(row, buffer);
        let (even, odd) = bins.split_at_mut(self.quarter + 1);
        let (first, second) = buffer.split_at(self.quarter);
        for (((z, a), b), w) in odd.iter_mut().zip(first).zip(second).zip(&self.twist) {
            *z = Complex::new(*a * w.re + *b * w.im, *a * w.im - *b * w.re);
        }
        self.odd_forward.process_with_scratch(odd, work);
        self.even.bins_of(buffer, even, work)
    }

    /// Transforms `bins`, which it overwrites, back into `row`. The sum over frequencies is not divided by their number,
    /// and the odd ones must have been multiplied by their weight.
    fn inverse(
        &self,
        bins: &mut [Complex<T>],
        row: &mut [T],
        buffer: &mut [T],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        let (even, odd) = bins.split_at_mut(self.quarter + 1);
        self.even.period_of(even, buffer, work)?;
        self.odd_inverse.process_with_scratch(odd, work);

        let (row_first, row_second) = row.split_at_mut(self.quarter.min(row.len()));
        let (first, second) = buffer.split_at(self.quarter);
        let terms = odd.iter().zip(&self.twist);
        for ((u, even), (z, w)) in row_first.iter_mut().zip(first).zip(terms) {
            *u = *even + (z.re * w.re + z.im * w.im);
        }
        let terms = odd.iter().zip(&self.twist);
        for ((u, even), (z, w)) in row_second.iter_mut().zip(second).zip(terms) {
            *u = *even - (z.im * w.re - z.re * w.im);
        }
        Ok(())
    }
}

impl<T: Precision> FrequencyPerBin<T> for PaddedRow<T> {
    /// Frequency of a bin as a real even function sees it, that is between 0 and `m`, and how often it occurs in the sum
    /// of the inverse transform as this type takes it.
    fn frequency_and_weight(&self, bin: usize) -> (usize, f64) {
        match bin.checked_sub(self.quarter + 1) {
            None => (2 * bin, 1.0),
            Some(l) => {
                let frequency = 4 * l + 1;
                (frequency.min(4 * self.quarter - frequency), 2.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTHS: [usize; 12] = [1, 2, 3, 4, 5, 7, 8, 13, 31, 48, 64, 101];

    fn row(cells: usize) -> Vec<f64> {
        (0..cells)
            .map(|j| (1.7 * j as f64).sin() + 0.3 * j as f64 / cells as f64)
            .collect()
    }

    fn transformed(plan: &PaddedRow, row: &[f64]) -> Vec<Complex<f64>> {
        let mut bins = vec![Complex::new(f64::NAN, f64::NAN); plan.bins()];
        let mut buffer = vec![f64::NAN; plan.buffer_length()];
        let mut work = vec![Complex::new(f64::NAN, f64::NAN); plan.work_length()];
        plan.forward(row, &mut bins, &mut buffer, &mut work)
            .unwrap();
        bins
    }

    #[test]
    fn bins_are_the_transform_of_the_padded_row() {
        for cells in LENGTHS {
            let plan = PaddedRow::<f64>::new(cells);
            let row = row(cells);
            assert!(plan.period() >= 2 * cells);
            for (bin, found) in transformed(&plan, &row).into_iter().enumerate() {
                let (frequency, weight) = plan.frequency_and_weight(bin);
                let step = -2.0 * PI * frequency as f64 / plan.period() as f64;
                let sum: Complex<f64> = (0..cells)
                    .map(|j| row[j] * Complex::cis(step * j as f64))
                    .sum();
                // An odd frequency above m is kept in place of its conjugate below.
                let kept_conjugate = weight == 2.0 && 4 * (bin - plan.quarter - 1) + 1 != frequency;
                let expected = if kept_conjugate { sum.conj() } else { sum };
                // Rounding of angles up to 2 pi * 101 and of 101 terms of order one.
                assert!(
                    (found - expected).norm() < 1e-12,
                    "{cells} cells, bin {bin}"
                );
            }
        }
    }

    #[test]
    fn forward_and_inverse_give_the_row_back() {
        for cells in LENGTHS {
            let plan = PaddedRow::<f64>::new(cells);
            let row = row(cells);
            let mut bins = transformed(&plan, &row);
            for (bin, value) in bins.iter_mut().enumerate() {
                *value *= plan.frequency_and_weight(bin).1 / plan.period() as f64;
            }
            let mut back = vec![f64::NAN; cells];
            let mut buffer = vec![f64::NAN; plan.buffer_length()];
            let mut work = vec![Complex::new(f64::NAN, f64::NAN); plan.work_length()];
            plan.inverse(&mut bins, &mut back, &mut buffer, &mut work)
                .unwrap();
            for (found, expected) in back.iter().zip(&row) {
                // Two short transforms of values of order one.
                assert!((found - expected).abs() < 1e-14, "{cells} cells");
            }
        }
    }

    #[test]
    fn every_odd_frequency_is_kept_once() {
        for cells in LENGTHS {
            let plan = PaddedRow::<f64>::new(cells);
            let mut frequencies: Vec<usize> = (0..plan.bins())
                .map(|bin| plan.frequency_and_weight(bin).0)
                .collect();
            frequencies.sort_unstable();
            assert_eq!(frequencies, (0..plan.bins()).collect::<Vec<_>>());
        }
    }
}
