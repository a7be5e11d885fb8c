//! The answer of one exponential to a harmonic excitation, without overflow or cancellation.
//!
//! Convention of the whole room: the excitation is `exp(+i omega t)`, so that
//! `E* = E' + i E''` and `D* = 1/E* = D' - i D''` with `E''` and `D''` not negative.

use num_complex::Complex;

/// The three shares of a Debye relaxation at `x = omega * tau`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Debye {
    /// `x^2 / (1 + x^2)`: what answers as if it had no time to relax.
    pub(super) frozen: f64,
    /// `x / (1 + x^2)`: what answers a quarter of a period late.
    pub(super) loss: f64,
    /// `1 / (1 + x^2)`: what has relaxed.
    pub(super) relaxed: f64,
}

impl Debye {
    /// Each share to a few units in the last place for any `x`, zero and infinity included:
    /// above one it is written in `1/x`, so that `x^2` never overflows.
    pub(super) fn at(x: f64) -> Self {
        if x.abs() <= 1.0 {
            let denominator = 1.0 + x * x;
            Debye {
                frozen: x * x / denominator,
                loss: x / denominator,
                relaxed: 1.0 / denominator,
            }
        } else {
            let inverse = 1.0 / x;
            let denominator = 1.0 + inverse * inverse;
            Debye {
                frozen: 1.0 / denominator,
                loss: inverse / denominator,
                relaxed: inverse * inverse / denominator,
            }
        }
    }

    /// Derivative of `loss` with respect to `ln x`: `x (1 - x^2)/(1 + x^2)^2`.
    pub(super) fn loss_slope(self) -> f64 {
        self.loss * (self.relaxed - self.frozen)
    }

    /// Derivative of `frozen` with respect to `ln x`, minus that of `relaxed`:
    /// `2 x^2/(1 + x^2)^2`.
    pub(super) fn frozen_slope(self) -> f64 {
        2.0 * self.frozen * self.relaxed
    }
}

/// `1/z` by Smith's method (R. L. Smith, Communications of the ACM 5 (1962) 435): the squares of
/// the parts never appear, so neither a compliance of 1e-200 nor one of 1e200 is lost.
///
/// `1/0` is infinite and real, `1/infinity` is zero.
pub(super) fn reciprocal(z: Complex<f64>) -> Complex<f64> {
    if z.re == 0.0 && z.im == 0.0 {
        return Complex::new(f64::INFINITY, 0.0);
    }
    if z.re.is_infinite() || z.im.is_infinite() {
        return Complex::new(0.0, 0.0);
    }
    if z.re.abs() >= z.im.abs() {
        let ratio = z.im / z.re;
        let denominator = z.re + z.im * ratio;
        Complex::new(1.0 / denominator, -ratio / denominator)
    } else {
        let ratio = z.re / z.im;
        let denominator = z.im + z.re * ratio;
        Complex::new(ratio / denominator, -1.0 / denominator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_shares_keep_their_leading_order_over_six_hundred_decades() {
        for exponent in -300..=300 {
            let x = format!("1e{exponent}").parse::<f64>().unwrap();
            let debye = Debye::at(x);
            // x/(1 + x^2) is x far below one and 1/x far above; both corrections are of order
            // min(x, 1/x)^2, which is below rounding beyond eight decades.
            if exponent <= -8 {
                assert_relative_eq!(debye.loss, x, max_relative = 1e-15);
                assert_relative_eq!(debye.relaxed, 1.0, max_relative = 1e-15);
            }
            if exponent >= 8 {
                assert_relative_eq!(debye.loss, 1.0 / x, max_relative = 1e-15);
                assert_relative_eq!(debye.frozen, 1.0, max_relative = 1e-15);
            }
            // Two roundings of numbers below one.
            assert!((debye.frozen + debye.relaxed - 1.0).abs() <= 3e-16);
        }
    }

    #[test]
    fn zero_and_infinity_are_ordinary_arguments() {
        let still = Debye::at(0.0);
        assert_eq!((still.frozen, still.loss, still.relaxed), (0.0, 0.0, 1.0));
        let fast = Debye::at(f64::INFINITY);
        assert_eq!((fast.frozen, fast.loss, fast.relaxed), (1.0, 0.0, 0.0));
    }

    #[test]
    fn the_reciprocal_survives_numbers_whose_squares_do_not() {
        for scale in [1e-200, 1.0, 1e200] {
            let z = Complex::new(3.0, -4.0) * scale;
            let inverse = reciprocal(z) * scale;
            // 1/(3 - 4i) = (3 + 4i)/25, a handful of roundings.
            assert_relative_eq!(inverse.re, 0.12, max_relative = 1e-15);
            assert_relative_eq!(inverse.im, 0.16, max_relative = 1e-15);
        }
        assert_eq!(
            reciprocal(Complex::new(1.0, f64::NEG_INFINITY)),
            Complex::new(0.0, 0.0)
        );
    }
}
