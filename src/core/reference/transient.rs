//! Sphere on a viscoelastic half-space under a step and under a half sine: contact radius and approach against time.
//!
//! Sources: E. H. Lee and J. R. M. Radok, J. Appl. Mech. 27 (1960) 438, while the contact radius does not decrease;
//! T. C. T. Ting, J. Appl. Mech. 33 (1966) 845, after its maximum. C(t) is the contact compliance.

use std::f64::consts::PI;

use crate::material::Creep;
use crate::numerics::roots::{ALL_DIGITS, bisect};

/// Contact radius (m) a time after a load was put on and held: a^3 = (3/4) R W C(t).
pub fn step_load_contact_radius_m(
    radius_m: f64,
    load_n: f64,
    contact_compliance: &Creep,
    time_s: f64,
) -> f64 {
    (0.75 * radius_m * load_n * contact_compliance.compliance(time_s)).cbrt()
}

/// (a/a_H)^3 of a Maxwell body under W = W_0 sin(s), s = t/tau between 0 and pi, a_H the Hertz radius at W_0.
///
/// Rising, a^3 follows Lee and Radok: sin s + 1 - cos s, up to its maximum at s = 3 pi/4, after that of the load. From
/// there the radius at s is the radius at the earlier s_1 at which, by Ting, W(s) is the load that the history up to s_1
/// alone has left: sin s = exp(s_1 - s) sin s_1.
pub fn maxwell_half_sine_cubed_radius(s: f64) -> f64 {
    let rising = |s: f64| s.sin() + 1.0 - s.cos();
    let turning = 0.75 * PI;
    if s <= turning {
        return rising(s.max(0.0));
    }
    // exp(x) sin x rises up to the turning point: bisection.
    let target = s.exp() * s.sin();
    let is_below = |x: f64| x.exp() * x.sin() < target;
    let (low, high) = bisect(0.0, turning, ALL_DIGITS, is_below);
    rising(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_half_sine_radius_turns_at_three_quarters_of_pi_and_falls_to_zero_with_the_load() {
        let maximum = maxwell_half_sine_cubed_radius(0.75 * PI);
        assert!((maximum.cbrt() - 1.3415).abs() < 5e-5);
        for s in [2.0, 2.2, 2.5, 3.0] {
            assert!(maxwell_half_sine_cubed_radius(s) < maximum);
        }
        assert!(maxwell_half_sine_cubed_radius(PI) < 1e-7);
        // Smooth across the maximum: both branches have slope zero there.
        let h = 1e-4;
        let after = maxwell_half_sine_cubed_radius(0.75 * PI + h);
        assert!((maximum - after).abs() < 10.0 * h * h);
    }
}
