//! Cosine transforms of rows and columns that are mirrored at their beginning: of a row in one real transform of half its period, of two
//! columns of real numbers as one of complex numbers.
//!
//! The row `x` of `n` values goes on with `x(-1-i) = x(i)` to the left and with zeros to the right, and repeats after `2m`. All
//! its frequencies are told by the real numbers (the discrete cosine transform of the second kind)
//!
//! ```text
//! X(k) = sum over i of  x(i) cos(pi k (i + 1/2) / m),     0 <= k < m
//! ```
//!
//! With the even values in ascending and the odd ones in descending order, `v(i) = x(2i)`, `v(m-1-i) = x(2i+1)`, of which the
//! ordinary transform is V, they are `X(k) - i X(m-k) = exp(-i pi k / 2m) V(k)` (J. Makhoul, IEEE Transactions on Acoustics,
//! Speech and Signal Processing 28 (1980) 27). Two of them make one complex bin, so that columns are transformed in pairs.

use std::f64::consts::PI;
use std::ops::Range;
use std::sync::Arc;

use contact_dma_transforms::Precision;
use num_complex::Complex;
use realfft::{ComplexToReal, FftError, RealToComplex};
use rustfft::Fft;
use rustfft::num_traits::Zero;

use super::super::influence::Influence;
use super::even_column::Kernel;
use super::spectral::{Column, Row, zero};

/// Plans for rows of one length. Immutable; buffers are the caller's.
pub(super) struct MirroredRow<T = f64> {
    /// Half the period, `m`; even.
    half: usize,
    forward: Arc<dyn RealToComplex<T>>,
    inverse: Arc<dyn ComplexToReal<T>>,
    /// `exp(-i pi k / 2m)` for `k < m/2`.
    twist: Vec<Complex<T>>,
}

/// `exp(-i pi k / 2m)` for `k < m/2`.
fn twist<T: Precision>(half: usize) -> Vec<Complex<T>> {
    let angle = -0.5 * PI / half as f64;
    (0..half / 2)
        .map(|k| Complex::cis(angle * k as f64))
        .map(|w: Complex<f64>| Complex::new(T::of(w.re), T::of(w.im)))
        .collect()
}

impl<T: Precision> MirroredRow<T> {
    /// Plans for rows that repeat after `2 half` values, `half` even.
    pub(super) fn new(half: usize) -> Self {
        Self {
            half,
            forward: T::real_forward(half),
            inverse: T::real_inverse(half),
            twist: twist(half),
        }
    }

    /// The two frequencies of a bin: `k` in its real and `m - k` in its imaginary part; 0 and `m / 2` in the first.
    fn frequencies(&self, bin: usize) -> [usize; 2] {
        match bin {
            0 => [0, self.half / 2],
            k => [k, self.half - k],
        }
    }
}

impl<T: Precision> Row<T> for MirroredRow<T> {
    fn period(&self) -> usize {
        2 * self.half
    }

    fn bins(&self) -> usize {
        self.half / 2
    }

    fn buffer_length(&self) -> usize {
        self.half
    }

    /// A spectrum and what the transforms ask for.
    fn work_length(&self) -> usize {
        let forward = self.forward.get_scratch_len();
        self.half / 2 + 1 + forward.max(self.inverse.get_scratch_len())
    }

    fn forward(
        &self,
        row: &[T],
        bins: &mut [Complex<T>],
        buffer: &mut [T],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        makhoul_permute(row, buffer);
        let (spectrum, work) = work.split_at_mut(self.half / 2 + 1);
        let work = &mut work[..self.forward.get_scratch_len()];
        self.forward.process_with_scratch(buffer, spectrum, work)?;
        for ((bin, value), w) in bins.iter_mut().zip(spectrum.iter()).zip(&self.twist) {
            *bin = (value * w).conj();
        }
        // Of the middle frequency real and imaginary part say the same; a factor that comes back is left out.
        bins[0] = Complex::new(spectrum[0].re, spectrum[self.half / 2].re);
        Ok(())
    }

    fn inverse(
        &self,
        bins: &mut [Complex<T>],
        row: &mut [T],
        buffer: &mut [T],
        work: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        let (spectrum, work) = work.split_at_mut(self.half / 2 + 1);
        for ((value, bin), w) in spectrum.iter_mut().zip(bins.iter()).zip(&self.twist) {
            *value = (bin * w).conj();
        }
        spectrum[0] = bins[0].re.into();
        spectrum[self.half / 2] = bins[0].im.into();
        let work = &mut work[..self.inverse.get_scratch_len()];
        self.inverse.process_with_scratch(spectrum, buffer, work)?;
        makhoul_unpermute(buffer, row);
        Ok(())
    }
}

/// Plans for columns of one length.
pub(super) struct MirroredColumn<T = f64> {
    /// Half the period, `m`; even.
    half: usize,
    forward: Arc<dyn Fft<T>>,
    inverse: Arc<dyn Fft<T>>,
    twist: Vec<Complex<T>>,
}

impl<T: Precision> MirroredColumn<T> {
    /// Plans for columns that repeat after `2 half` values, `half` even.
    pub(super) fn new(half: usize) -> Self {
        let (forward, inverse) = T::complex(half);
        Self {
            half,
            forward,
            inverse,
            twist: twist(half),
        }
    }
}

/// A function of frequency and spectrum of the influence coefficients in the order in which it is used: for every bin of a row, four
/// numbers per pair of frequencies `l` and `m - l` along the column, two for either column of the pair; scaled so that the
/// inverse transforms need no scaling of their own.
pub(super) fn spectrum<T: Precision>(
    influence: &Influence,
    row: &MirroredRow<T>,
    column: &MirroredColumn<T>,
    function: impl Fn((usize, usize), f64) -> f64,
) -> Result<Vec<f64>, FftError> {
    let (half_x, half_y) = (row.period() / 2, column.half);
    let mut kernel = Kernel::new(|x, y| influence.coefficient_m(x, y), 2 * half_x, 2 * half_y)?;
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

impl<T: Precision> Column<T> for MirroredColumn<T> {
    fn length(&self) -> usize {
        self.half
    }

    fn period(&self) -> usize {
        2 * self.half
    }

    /// The values in the order of the transform, and what the transforms ask for.
    fn work_length(&self) -> usize {
        let forward = self.forward.get_inplace_scratch_len();
        self.half + forward.max(self.inverse.get_inplace_scratch_len())
    }

    fn multiply(
        &self,
        column: &mut [Complex<T>],
        loaded: &Range<usize>,
        wanted: &Range<usize>,
        kernel: &[T],
        work: &mut [Complex<T>],
    ) {
        let (values, work) = work.split_at_mut(self.half);
        column[..loaded.start].fill(zero());
        makhoul_permute(&column[..loaded.end], values);
        self.forward.process_with_scratch(values, work);
        self.multiply_pairs(values, kernel);
        self.inverse.process_with_scratch(values, work);
        makhoul_unpermute(values, &mut column[..wanted.end]);
    }
}

/// Even values in ascending, odd ones in descending order, zeros between.
fn makhoul_permute<T: Copy + Zero>(line: &[T], values: &mut [T]) {
    let (even, odd) = (line.len().div_ceil(2), line.len() / 2);
    let beyond = values.len() - odd;
    values[even..beyond].fill(T::zero());
    let pairs = line.chunks_exact(2);
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
fn makhoul_unpermute<T: Copy>(values: &[T], line: &mut [T]) {
    let even = line.len().div_ceil(2);
    let (ascending, descending) = values.split_at(even);
    let places = ascending.iter().zip(descending.iter().rev());
    let mut pairs = line.chunks_exact_mut(2);
    for (pair, (a, b)) in pairs.by_ref().zip(places) {
        (pair[0], pair[1]) = (*a, *b);
    }
    if let ([last], Some(a)) = (pairs.into_remainder(), ascending.last()) {
        *last = *a;
    }
}

impl<T: Precision> MirroredColumn<T> {
    /// From the transform of the ordered values to that of their product.
    ///
    /// With A and B the transforms of real and imaginary part, `V(l) = A + i B` and `V(m-l) = conj A + i conj B`; real and
    /// imaginary part of `exp(-i pi l / 2m) A` are the cosine transforms of the first column at `l` and, with the opposite sign,
    /// at `m - l`.
    fn multiply_pairs(&self, values: &mut [Complex<T>], kernel: &[T]) {
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
