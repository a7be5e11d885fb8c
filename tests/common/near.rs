//! Numbers held to others. What is said when one is not names it, what it is held to, and how far apart they are.

use std::fmt::Arguments;

/// Holds a number to an expected one, relative to that: `near!(loss_j, exact_j, 1e-3, "{omega} rad/s")`.
macro_rules! near {
    ($found:expr, $expected:expr, $tolerance:expr) => {
        near!($found, $expected, $tolerance, "found")
    };
    ($found:expr, $expected:expr, $tolerance:expr, $($what:tt)+) => {
        $crate::near::near($found, $expected, $tolerance, format_args!($($what)+))
    };
}

/// Holds a number below a bound: `below!(error.abs(), 1e-3, "{omega} rad/s")`.
macro_rules! below {
    ($value:expr, $bound:expr) => {
        below!($value, $bound, "found")
    };
    ($value:expr, $bound:expr, $($what:tt)+) => {
        $crate::near::below($value, $bound, format_args!($($what)+))
    };
}

#[track_caller]
pub fn near(found: f64, expected: f64, tolerance: f64, what: Arguments<'_>) {
    let off = found / expected - 1.0;
    assert!(
        off.abs() < tolerance,
        "{what}: {found:e} is off {expected:e} by {off:.2e}, above {tolerance:.1e}"
    );
}

#[track_caller]
pub fn below(value: f64, bound: f64, what: Arguments<'_>) {
    assert!(value < bound, "{what}: {value:e} is not below {bound:e}");
}
