//! A column as it is: transformed, multiplied by a spectrum that is real and even, and transformed back.

use std::ops::Range;
use std::sync::Arc;

use num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use super::spectral::{Column, ZERO};

/// Plans for columns of one length.
pub(super) struct EvenColumn {
    length: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl EvenColumn {
    /// Plans for columns of this length, padding included.
    pub(super) fn new(length: usize) -> Self {
        let mut planner = FftPlanner::new();
        Self {
            length,
            forward: planner.plan_fft_forward(length),
            inverse: planner.plan_fft_inverse(length),
        }
    }
}

impl Column for EvenColumn {
    fn length(&self) -> usize {
        self.length
    }

    fn period(&self) -> usize {
        self.length
    }

    /// The frequencies up to half the length.
    fn kernel_length(&self) -> usize {
        self.length / 2 + 1
    }

    fn work_length(&self) -> usize {
        let forward = self.forward.get_inplace_scratch_len();
        forward.max(self.inverse.get_inplace_scratch_len())
    }

    fn multiply(
        &self,
        column: &mut [Complex<f64>],
        loaded: &Range<usize>,
        _wanted: &Range<usize>,
        kernel: &[f64],
        work: &mut [Complex<f64>],
    ) {
        let column = &mut column[..self.length];
        column[..loaded.start].fill(ZERO);
        column[loaded.end..].fill(ZERO);
        self.forward.process_with_scratch(column, work);
        multiply_by_even(column, kernel);
        self.inverse.process_with_scratch(column, work);
    }
}

/// Multiplies frequency `k` and its mirror image `length - k` by `even[k]`.
fn multiply_by_even(column: &mut [Complex<f64>], even: &[f64]) {
    let (Some((zero, others)), Some((even_zero, even))) =
        (column.split_first_mut(), even.split_first())
    else {
        return;
    };
    *zero *= even_zero;
    let pairs = others.len() / 2;
    let (lower, upper) = others.split_at_mut(pairs);
    let mirrored = upper.iter_mut().rev();
    for ((a, b), factor) in lower.iter_mut().zip(mirrored).zip(even) {
        *a *= factor;
        *b *= factor;
    }
    // An even length has one frequency that is its own mirror image; `upper` is then one longer than `lower`.
    if upper.len() > pairs
        && let (Some(middle), Some(factor)) = (upper.first_mut(), even.get(pairs))
    {
        *middle *= factor;
    }
}
