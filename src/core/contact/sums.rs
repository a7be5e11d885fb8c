//! Sums over slices in eight interleaved parts: fast, because additions need not wait for one another, and always in the same
//! order.
//!
//! Innermost loops are compiled once more for processors with AVX2, which take four lanes at a time in place of two:
//! the operations, and so the bits, are the same.

use multiversion::multiversion;

const LANES: usize = 8;

/// A number of either precision; all are added in double.
pub(crate) trait Number: Copy + Into<f64> {}

impl<T: Copy + Into<f64>> Number for T {}

/// Sums of `terms(a, b)` over pairs, `N` at a time.
#[inline(always)]
pub(crate) fn sums<const N: usize, A: Number, B: Number>(
    a: &[A],
    b: &[B],
    terms: impl Fn(f64, f64) -> [f64; N],
) -> [f64; N] {
    let mut lanes = [[0.0; LANES]; N];
    let ((whole_a, rest_a), (whole_b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in whole_a.iter().zip(whole_b) {
        for lane in 0..LANES {
            let terms = terms(a[lane].into(), b[lane].into());
            for n in 0..N {
                lanes[n][lane] += terms[n];
            }
        }
    }
    let mut totals = [0.0; N];
    for n in 0..N {
        totals[n] = lanes[n].iter().sum();
    }
    for (&a, &b) in rest_a.iter().zip(rest_b) {
        let terms = terms(a.into(), b.into());
        for n in 0..N {
            totals[n] += terms[n];
        }
    }
    totals
}

/// The sum of a term over triples.
#[inline(always)]
pub(crate) fn sum_over_triples(
    a: &[f64],
    b: &[f64],
    c: &[f64],
    term: impl Fn(f64, f64, f64) -> f64,
) -> f64 {
    let mut lanes = [0.0; LANES];
    let ((whole_a, rest_a), (whole_b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let (whole_c, rest_c) = c.as_chunks::<LANES>();
    for ((a, b), c) in whole_a.iter().zip(whole_b).zip(whole_c) {
        for lane in 0..LANES {
            lanes[lane] += term(a[lane], b[lane], c[lane]);
        }
    }
    let rest = rest_a.iter().zip(rest_b).zip(rest_c);
    let rest = rest.map(|((&a, &b), &c)| term(a, b, c));
    lanes.iter().sum::<f64>() + rest.sum::<f64>()
}

/// Adds this many times a field to another.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn add_scaled<T: Number>(to: &mut [f64], factor: f64, field: &[T]) {
    for (to, value) in to.iter_mut().zip(field) {
        *to += factor * (*value).into();
    }
}

pub(crate) fn sum<T: Number>(a: &[T]) -> f64 {
    sums(a, a, |a, _| [a])[0]
}

#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn dot<A: Number, B: Number>(a: &[A], b: &[B]) -> f64 {
    sums(a, b, |a, b| [a * b])[0]
}

/// The least value; infinite for none.
pub(crate) fn least(a: &[f64]) -> f64 {
    least_of(a, |a| a)
}

/// The least of a function of the values; infinite for none.
#[inline(always)]
pub(crate) fn least_of<T: Number>(a: &[T], function: impl Fn(f64) -> f64) -> f64 {
    let mut lanes = [f64::INFINITY; LANES];
    let (whole, rest) = a.as_chunks::<LANES>();
    for a in whole {
        for lane in 0..LANES {
            let value = function(a[lane].into());
            lanes[lane] = if value < lanes[lane] {
                value
            } else {
                lanes[lane]
            };
        }
    }
    let rest = rest.iter().map(|&a| function(a.into()));
    lanes.into_iter().chain(rest).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_any_length_are_those_of_a_loop() {
        for length in [0, 1, 7, 8, 9, 31, 64] {
            let a: Vec<f64> = (0..length).map(|i| f64::from(i) - 3.0).collect();
            let b: Vec<f64> = (0..length).map(|i| 0.5 * f64::from(i)).collect();
            // Small integers and halves: exact in any order.
            assert_eq!(sum(&a), a.iter().sum::<f64>());
            assert_eq!(
                dot(&a, &b),
                a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>()
            );
            let products = a.iter().zip(&b).map(|(a, b)| a * b * b);
            let triples = sum_over_triples(&a, &b, &b, |a, b, c| a * b * c);
            assert_eq!(triples, products.sum::<f64>());
            let expected = if length == 0 { f64::INFINITY } else { -3.0 };
            assert_eq!(least(&a), expected);
        }
    }
}
