//! Cosine transform of a row that is mirrored at its beginning, in one real transform of half its period.
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
use std::sync::Arc;

use num_complex::Complex;
use realfft::{ComplexToReal, FftError, RealFftPlanner, RealToComplex};

use super::spectral::Row;

/// Plans for rows of one length. Immutable; buffers are the caller's.
pub(super) struct MirroredRow {
    /// Half the period, `m`; even.
    half: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    /// `exp(-i pi k / 2m)` for `k < m/2`.
    twist: Vec<Complex<f64>>,
}

/// `exp(-i pi k / 2m)` for `k < m/2`.
pub(super) fn twist(half: usize) -> Vec<Complex<f64>> {
    let angle = -0.5 * PI / half as f64;
    (0..half / 2)
        .map(|k| Complex::cis(angle * k as f64))
        .collect()
}

impl MirroredRow {
    /// Plans for rows that repeat after `2 half` values, `half` even.
    pub(super) fn new(half: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        Self {
            half,
            forward: planner.plan_fft_forward(half),
            inverse: planner.plan_fft_inverse(half),
            twist: twist(half),
        }
    }

    /// The two frequencies of a bin: `k` in its real and `m - k` in its imaginary part; 0 and `m / 2` in the first.
    pub(super) fn frequencies(&self, bin: usize) -> [usize; 2] {
        match bin {
            0 => [0, self.half / 2],
            k => [k, self.half - k],
        }
    }
}

impl Row for MirroredRow {
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
        row: &[f64],
        bins: &mut [Complex<f64>],
        buffer: &mut [f64],
        work: &mut [Complex<f64>],
    ) -> Result<(), FftError> {
        let (even, odd) = (row.len().div_ceil(2), row.len() / 2);
        buffer[even..self.half - odd].fill(0.0);
        let pairs = row.chunks_exact(2);
        if let [last] = pairs.remainder() {
            buffer[even - 1] = *last;
        }
        let (ascending, descending) = buffer.split_at_mut(self.half / 2);
        let places = ascending.iter_mut().zip(descending.iter_mut().rev());
        for ((a, b), pair) in places.zip(pairs) {
            (*a, *b) = (pair[0], pair[1]);
        }
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
        bins: &mut [Complex<f64>],
        row: &mut [f64],
        buffer: &mut [f64],
        work: &mut [Complex<f64>],
    ) -> Result<(), FftError> {
        let (spectrum, work) = work.split_at_mut(self.half / 2 + 1);
        for ((value, bin), w) in spectrum.iter_mut().zip(bins.iter()).zip(&self.twist) {
            *value = (bin * w).conj();
        }
        spectrum[0] = bins[0].re.into();
        spectrum[self.half / 2] = bins[0].im.into();
        let work = &mut work[..self.inverse.get_scratch_len()];
        self.inverse.process_with_scratch(spectrum, buffer, work)?;
        let (ascending, descending) = buffer.split_at(self.half / 2);
        let mut places = ascending.iter().zip(descending.iter().rev());
        let mut pairs = row.chunks_exact_mut(2);
        for (pair, (a, b)) in pairs.by_ref().zip(places.by_ref()) {
            (pair[0], pair[1]) = (*a, *b);
        }
        if let ([last], Some((a, _))) = (pairs.into_remainder(), places.next()) {
            *last = *a;
        }
        Ok(())
    }
}
