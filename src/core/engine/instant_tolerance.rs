//! How exactly the half-space engine solves each instant of a cycle: as exactly as the loss asks for.
//!
//! What a tolerance leaves in the loss is noise in the approach, of that part of the approach itself, against the width of the
//! loop: relative to the loss it is the tolerance over the product of drive amplitude over mean and sine of the phase lag, times
//! a factor that was seen to lie between 0.003 and 0.11 (PMMA under a sphere, 1e-4 to 100 rad/s, amplitudes of 5 to 50 % of
//! the mean, tolerances of 1e-10 to 1e-4).
//!
//! What it leaves in the pressure goes into the memory of branches slower than the cycle, and comes back as a displacement
//! larger by the compliance at rest over that at the frequency: from a ratio of 1e5 on, a search then finds no cycle. Errors of
//! the cells are of either sign and differ from step to step, so that the root of that ratio was seen to be enough.
//!
//! Calibrated on one branch over equilibrium moduli lower by 1.3 to 1e6, under sphere, cone and ellipsoid, amplitudes of 1e-3, 0.1
//! and 1 of the mean, three frequencies between the retardation and the relaxation time. `tests/physics/instant_tolerance.rs` holds the
//! result to [`SHARE`] of the cycle's tolerance, which the error bars count in.

use crate::drive::HarmonicDrive;
use crate::material::Creep;

/// Tolerance of an instant where no loss says what is needed: so tight that rounding, which leads the solver another way in
/// other units, stays below 1e-9.
pub const OF_A_HISTORY: f64 = 1e-10;

/// The loosest, for the sake of radii and pressures, and the tightest, above what rounding leaves.
const LOOSEST: f64 = 1e-6;
const TIGHTEST: f64 = 1e-12;

/// What the instants may leave in the loss, as a part of what the distance to the stabilised cycle may.
pub const SHARE: f64 = 0.1;

/// Tolerance of an instant that leaves [`SHARE`] of `cycle_tolerance` in the loss, relative, at the most.
pub fn for_cycle(
    compliance: &Creep,
    drive: &HarmonicDrive,
    angular_frequency_rad_per_s: f64,
    cycle_tolerance: f64,
) -> f64 {
    let answer = compliance.complex_compliance(angular_frequency_rad_per_s);
    let sine_of_phase_lag = answer.im.abs() / answer.norm();
    let amplitude_over_mean = (drive.amplitude() / drive.mean()).abs().min(1.0);
    // A fluid, which has no compliance at rest, has no stabilised cycle either.
    let at_rest = compliance.equilibrium_compliance().unwrap_or(f64::INFINITY);
    let from_memory = (answer.norm() / at_rest).sqrt();
    let tolerance = cycle_tolerance * (amplitude_over_mean * sine_of_phase_lag).min(from_memory);
    match tolerance > TIGHTEST {
        true => tolerance.min(LOOSEST),
        // What is not a number asks for the tightest, too.
        false => TIGHTEST,
    }
}

/// What to try where a cycle is not found at this tolerance; `None` where nothing tighter is of use.
pub fn tighter(tolerance: f64) -> Option<f64> {
    const TIGHTER: f64 = 1e-3;
    (tolerance > TIGHTEST).then(|| (TIGHTER * tolerance).max(TIGHTEST))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::Control;
    use crate::material::library;

    fn drive(amplitude_n: f64) -> HarmonicDrive {
        HarmonicDrive::new(Control::Load, 10.0, amplitude_n, 0.0, 0.0).unwrap()
    }

    #[test]
    fn a_narrow_loop_asks_for_more_and_what_is_in_reach_bounds_it() {
        let material = library::find("pmma").unwrap().material().unwrap();
        let pmma = material.contact_compliance().unwrap();
        let asked = |amplitude_n, omega, cycle| for_cycle(&pmma, &drive(amplitude_n), omega, cycle);
        let wide = asked(5.0, 0.01, 1e-6);
        // In proportion to amplitude and accuracy.
        assert!((asked(0.5, 0.01, 1e-6) / wide - 0.1).abs() < 1e-12);
        assert!((asked(5.0, 0.01, 1e-7) / wide - 0.1).abs() < 1e-12);
        // A thousand times the frequency, a hundredth of the phase lag.
        assert!(asked(5.0, 10.0, 1e-6) < 0.05 * wide);
        assert_eq!(asked(5.0, 0.01, 0.1), LOOSEST);
        assert_eq!(asked(1e-9, 0.01, 1e-6), TIGHTEST);
        assert_eq!(asked(5.0, 0.0, 1e-4), TIGHTEST);
    }
}
