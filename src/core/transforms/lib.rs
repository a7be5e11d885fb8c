//! Plans of discrete Fourier transforms, none of them scaled.
//!
//! A crate that makes plans compiles every algorithm of rustfft for itself, a quarter of all the code of the core. Here that is
//! done once, and not again after every change of a line there.

use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_traits::Zero;
use rustfft::{Fft, FftNum, FftPlanner, FftPlannerScalar};

/// A precision in which transforms run, and its plans: `f64`, and `f32` for what need not be exact.
pub trait Precision: FftNum + Zero + Default {
    /// The nearest number.
    fn of(value: f64) -> Self;

    /// The same number.
    fn to_double(self) -> f64;

    /// Forward and inverse transform of this many complex numbers.
    fn complex(length: usize) -> (Arc<dyn Fft<Self>>, Arc<dyn Fft<Self>>);

    /// Transform of this many real numbers into the `length / 2 + 1` lines of their spectrum.
    fn real_forward(length: usize) -> Arc<dyn RealToComplex<Self>>;

    /// Transform of the `length / 2 + 1` lines of a spectrum into this many real numbers.
    fn real_inverse(length: usize) -> Arc<dyn ComplexToReal<Self>>;
}

/// Both in this crate, and so compiled here.
macro_rules! precisions {
    ($($real:ident)*) => {
        $(impl Precision for $real {
            #[inline]
            fn of(value: f64) -> Self {
                value as Self
            }

            #[inline]
            fn to_double(self) -> f64 {
                self.into()
            }

            fn complex(length: usize) -> (Arc<dyn Fft<Self>>, Arc<dyn Fft<Self>>) {
                let mut planner = FftPlanner::new();
                (
                    planner.plan_fft_forward(length),
                    planner.plan_fft_inverse(length),
                )
            }

            fn real_forward(length: usize) -> Arc<dyn RealToComplex<Self>> {
                RealFftPlanner::new().plan_fft_forward(length)
            }

            fn real_inverse(length: usize) -> Arc<dyn ComplexToReal<Self>> {
                RealFftPlanner::new().plan_fft_inverse(length)
            }
        })*
    };
}

precisions!(f32 f64);

/// Inverse transform of this many complex numbers without instructions that only some processors have, so that its results
/// are the same on all of them.
#[must_use]
pub fn complex_inverse_anywhere(length: usize) -> Arc<dyn Fft<f64>> {
    FftPlannerScalar::new().plan_fft_inverse(length)
}
