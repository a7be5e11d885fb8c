//! How exactly the half-space engine solves each instant of a cycle: as exactly as the loss asks for.
//!
//! What a tolerance leaves in the loss is noise in the approach, of that part of the approach itself, against the width of the
//! loop: relative to the loss it is the tolerance over the product of drive amplitude over mean and sine of the phase lag, times
//! a factor that was seen to lie between 0.003 and 0.11 (PMMA under a sphere, 1e-4 to 100 rad/s, amplitudes of 5 to 50 % of
//! the mean, tolerances of 1e-10 to 1e-4).

use crate::drive::HarmonicDrive;
use crate::material::Creep;

/// Tolerance of an instant where no loss says what is needed: so tight that rounding, which leads the solver another way in
/// other units, stays below 1e-9.
pub const OF_A_HISTORY: f64 = 1e-10;

/// The loosest, for the sake of radii and pressures, and the tightest, above what rounding leaves.
const LOOSEST: f64 = 1e-6;
const TIGHTEST: f64 = 1e-12;

/// Tolerance of an instant that leaves about a tenth of `cycle_tolerance` in the loss, relative, at the most.
pub fn of_a_cycle(
    compliance: &Creep,
    drive: &HarmonicDrive,
    angular_frequency_rad_per_s: f64,
    cycle_tolerance: f64,
) -> f64 {
    let answer = compliance.complex_compliance(angular_frequency_rad_per_s);
    let sine_of_phase_lag = answer.im.abs() / answer.norm();
    let amplitude_over_mean = (drive.amplitude() / drive.mean()).abs().min(1.0);
    let tolerance = cycle_tolerance * amplitude_over_mean * sine_of_phase_lag;
    match tolerance > TIGHTEST {
        true => tolerance.min(LOOSEST),
        // What is not a number asks for the tightest, too.
        false => TIGHTEST,
    }
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
        let asked =
            |amplitude_n, omega, cycle| of_a_cycle(&pmma, &drive(amplitude_n), omega, cycle);
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
