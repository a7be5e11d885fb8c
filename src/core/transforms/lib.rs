//! Plans of discrete Fourier transforms in double precision, none of them scaled.
//!
//! A crate that makes plans compiles every algorithm of rustfft for itself, a quarter of all the code of the core. Here that is
//! done once, and not again after every change of a line there.

use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner, FftPlannerScalar};

/// Forward and inverse transform of this many complex numbers.
#[must_use]
pub fn complex(length: usize) -> (Arc<dyn Fft<f64>>, Arc<dyn Fft<f64>>) {
    let mut planner = FftPlanner::new();
    (
        planner.plan_fft_forward(length),
        planner.plan_fft_inverse(length),
    )
}

/// Transform of this many real numbers into the `length / 2 + 1` lines of their spectrum.
#[must_use]
pub fn real_forward(length: usize) -> Arc<dyn RealToComplex<f64>> {
    RealFftPlanner::new().plan_fft_forward(length)
}

/// Transform of the `length / 2 + 1` lines of a spectrum into this many real numbers.
#[must_use]
pub fn real_inverse(length: usize) -> Arc<dyn ComplexToReal<f64>> {
    RealFftPlanner::new().plan_fft_inverse(length)
}

/// Inverse transform of this many complex numbers without instructions that only some processors have, so that its results
/// are the same on all of them.
#[must_use]
pub fn complex_inverse_anywhere(length: usize) -> Arc<dyn Fft<f64>> {
    FftPlannerScalar::new().plan_fft_inverse(length)
}
