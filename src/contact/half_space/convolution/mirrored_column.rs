//! Two columns of real numbers, mirrored at their beginning, as one of complex numbers: cosine transforms of both, products
//! with their spectra, and back. The transform is that of [`super::mirrored_row`].

use std::ops::Range;
use std::sync::Arc;

use num_complex::Complex;
use realfft::FftError;
use rustfft::{Fft, FftPlanner};

use super::super::influence::Influence;
use super::even_column::Kernel;
use super::mirrored_row::{MirroredRow, twist};
use super::spectral::{Column, Row, ZERO};

/// Plans for columns of one length.
pub(super) struct MirroredColumn {
    /// Half the period, `m`; even.
    half: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    twist: Vec<Complex<f64>>,
}

impl MirroredColumn {
    /// Plans for columns that repeat after `2 half` values, `half` even.
    pub(super) fn new(half: usize) -> Self {
        let mut planner = FftPlanner::new();
        Self {
            half,
            forward: planner.plan_fft_forward(half),
            inverse: planner.plan_fft_inverse(half),
            twist: twist(half),
        }
    }
}

/// A function of frequency and spectrum of the influence coefficients in the order in which it is used: for every bin of a row, four
/// numbers per pair of frequencies `l` and `m - l` along the column, two for either column of the pair; scaled so that the
/// inverse transforms need no scaling of their own.
pub(super) fn spectrum(
    influence: &Influence,
    row: &MirroredRow,
    column: &MirroredColumn,
    function: impl Fn((usize, usize), f64) -> f64,
) -> Result<Vec<f64>, FftError> {
    let (half_x, half_y) = (row.period() / 2, column.half);
    let mut kernel = Kernel::new(influence, 2 * half_x, 2 * half_y)?;
    let mut pair = [vec![0.0; half_y + 1], vec![0.0; half_y + 1]];
    let mut spectrum = Vec::with_capacity(2 * half_y * row.bins());
    let scale = 1.0 / (half_x as f64 * half_y as f64);
    for bin in 0..row.bins() {
        for (frequency, values) in row.frequencies(bin).into_iter().zip(&mut pair) {
            kernel.column(frequency, values)?;
            for (l, value) in values.iter_mut().enumerate() {
                *value = function((frequency, l), *value);
            }
        }
        let [first, second] = &pair;
        let middle = half_y / 2;
        let own = [first[0], second[0], first[middle], second[middle]];
        spectrum.extend(own.map(|value| scale * value));
        for l in 1..middle {
            let mirror = half_y - l;
            let values = [first[l], first[mirror], second[l], second[mirror]];
            // Sums and differences of two numbers stand for their means.
            spectrum.extend(values.map(|value| 0.5 * scale * value));
        }
    }
    Ok(spectrum)
}

impl Column for MirroredColumn {
    fn length(&self) -> usize {
        self.half
    }

    fn period(&self) -> usize {
        2 * self.half
    }

    /// Four numbers for every pair of frequencies.
    fn kernel_length(&self) -> usize {
        2 * self.half
    }

    /// The values in the order of the transform, and what the transforms ask for.
    fn work_length(&self) -> usize {
        let forward = self.forward.get_inplace_scratch_len();
        self.half + forward.max(self.inverse.get_inplace_scratch_len())
    }

    fn multiply(
        &self,
        column: &mut [Complex<f64>],
        loaded: &Range<usize>,
        wanted: &Range<usize>,
        kernel: &[f64],
        work: &mut [Complex<f64>],
    ) {
        let (values, work) = work.split_at_mut(self.half);
        column[..loaded.start].fill(ZERO);
        makhoul_permute(&column[..loaded.end], values);
        self.forward.process_with_scratch(values, work);
        self.multiply_pairs(values, kernel);
        self.inverse.process_with_scratch(values, work);
        makhoul_unpermute(values, &mut column[..wanted.end]);
    }
}

/// Even values in ascending, odd ones in descending order, zeros between.
fn makhoul_permute(column: &[Complex<f64>], values: &mut [Complex<f64>]) {
    let (even, odd) = (column.len().div_ceil(2), column.len() / 2);
    let beyond = values.len() - odd;
    values[even..beyond].fill(ZERO);
    let pairs = column.chunks_exact(2);
    if let [last] = pairs.remainder() {
        values[even - 1] = *last;
    }
    let (ascending, descending) = values.split_at_mut(beyond);
    let places = ascending.iter_mut().zip(descending.iter_mut().rev());
    for ((a, b), pair) in places.zip(pairs) {
        (*a, *b) = (pair[0], pair[1]);
    }
}

/// The reverse of [`makhoul_permute`].
fn makhoul_unpermute(values: &[Complex<f64>], column: &mut [Complex<f64>]) {
    let even = column.len().div_ceil(2);
    let (ascending, descending) = values.split_at(even);
    let places = ascending.iter().zip(descending.iter().rev());
    let mut pairs = column.chunks_exact_mut(2);
    for (pair, (a, b)) in pairs.by_ref().zip(places) {
        (pair[0], pair[1]) = (*a, *b);
    }
    if let ([last], Some(a)) = (pairs.into_remainder(), ascending.last()) {
        *last = *a;
    }
}

impl MirroredColumn {
    /// From the transform of the ordered values to that of their product.
    ///
    /// With A and B the transforms of real and imaginary part, `V(l) = A + i B` and `V(m-l) = conj A + i conj B`; real and
    /// imaginary part of `exp(-i pi l / 2m) A` are the cosine transforms of the first column at `l` and, with the opposite sign,
    /// at `m - l`.
    fn multiply_pairs(&self, values: &mut [Complex<f64>], kernel: &[f64]) {
        let (own, kernel) = kernel.split_at(4);
        let (lower, upper) = values.split_at_mut(self.half / 2);
        let (middle, upper) = upper.split_at_mut(1);
        let (zero, lower) = lower.split_at_mut(1);
        zero[0] = Complex::new(own[0] * zero[0].re, own[1] * zero[0].im);
        middle[0] = Complex::new(own[2] * middle[0].re, own[3] * middle[0].im);
        let pairs = lower.iter_mut().zip(upper.iter_mut().rev());
        let factors = kernel.chunks_exact(4).zip(&self.twist[1..]);
        for ((low, high), (k, w)) in pairs.zip(factors) {
            let (sum, difference) = (*low + high.conj(), *low - high.conj());
            let a = sum * w;
            let b = Complex::new(difference.im, -difference.re) * w;
            let a = Complex::new(k[0] * a.re, k[1] * a.im) * w.conj();
            let b = Complex::new(k[2] * b.re, k[3] * b.im) * w.conj();
            *low = Complex::new(a.re - b.im, a.im + b.re);
            *high = Complex::new(a.re + b.im, b.re - a.im);
        }
    }
}
