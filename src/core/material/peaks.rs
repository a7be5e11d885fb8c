//! The frequencies at which a material loses most: maxima of E'', D'' and tan delta.
//!
//! A maximum is found as a zero of the analytic derivative with respect to `ln omega`. Comparing
//! values of the function instead (golden section, Brent's minimiser) cannot place a maximum
//! better than the square root of the rounding error, about 1e-8.

use num_complex::Complex;

use super::creep::Creep;
use super::harmonic::reciprocal;
use super::relaxation::Relaxation;
use crate::numerics::roots::{ALL_DIGITS, bisect};

/// A local maximum over frequency.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct LossPeak {
    /// Where it is, in rad/s, to a relative 1e-12.
    pub angular_frequency_rad_per_s: f64,
    /// How high it is: Pa for a modulus, 1/Pa for a compliance, 1 for a loss tangent.
    pub value: f64,
}

/// The local maxima of a material's three measures of loss, by ascending frequency.
///
/// A list is empty where the measure has no maximum: an elastic solid has none at all, a Maxwell
/// fluid only one of E''. Maxima nearer than a fiftieth of a decade count as one.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct LossPeaks {
    /// Of the loss modulus E'', in Pa.
    pub loss_modulus: Vec<LossPeak>,
    /// Of the loss compliance D'', in 1/Pa: the loss of a contact under a small oscillating load
    /// peaks where this does.
    pub loss_compliance: Vec<LossPeak>,
    /// Of the loss tangent E''/E' = D''/D'.
    pub loss_tangent: Vec<LossPeak>,
}

/// Frequencies tried per decade before refinement; a peak of one exponential is a decade wide.
const SAMPLES_PER_DECADE: f64 = 100.0;

/// How far beyond the reciprocals of the time constants the search goes.
const MARGIN: f64 = 100.0;

/// The maxima within two decades beyond the range of the time constants of both functions.
pub(super) fn loss_peaks(creep: &Creep, relaxation: Option<&Relaxation>) -> LossPeaks {
    let retardation = creep.branches().iter().map(|branch| branch.time_s);
    let relaxing = relaxation.map_or(&[][..], Relaxation::branches);
    let times = retardation.chain(relaxing.iter().map(|branch| branch.time_s));
    let Some((shortest, longest)) = times.fold(None, |range: Option<(f64, f64)>, time| {
        let (low, high) = range.unwrap_or((time, time));
        Some((low.min(time), high.max(time)))
    }) else {
        return LossPeaks::default();
    };
    // Where there are doubles: the reciprocal of a very short time is none.
    let within = |omega: f64| omega.clamp(f64::MIN_POSITIVE, f64::MAX);
    let range = (within(1.0 / longest / MARGIN), within(MARGIN / shortest));
    LossPeaks {
        loss_modulus: maxima(creep, range, loss_modulus),
        loss_compliance: maxima(creep, range, loss_compliance),
        loss_tangent: maxima(creep, range, loss_tangent),
    }
}

/// A measure of loss, and a number with the sign of its derivative by `ln omega`, from the complex compliance and its derivative.
type Measure = fn(Complex<f64>, Complex<f64>) -> (f64, f64);

/// `E'' = Im 1/D*`, with `d(1/D*) = -dD*/D*^2` taken relative to `|E*|`.
fn loss_modulus(compliance: Complex<f64>, slope: Complex<f64>) -> (f64, f64) {
    let modulus = reciprocal(compliance);
    let relative = slope * modulus;
    (modulus.im, -(relative * modulus).im)
}

fn loss_compliance(compliance: Complex<f64>, slope: Complex<f64>) -> (f64, f64) {
    (-compliance.im, -slope.im)
}

/// `tan delta = D''/D'`; its derivative times `D'`.
fn loss_tangent(compliance: Complex<f64>, slope: Complex<f64>) -> (f64, f64) {
    let tangent = -compliance.im / compliance.re;
    (tangent, -slope.im - tangent * slope.re)
}

/// Every change of the slope from rising to falling on a logarithmic grid, refined by bisection.
fn maxima(creep: &Creep, range: (f64, f64), measure: Measure) -> Vec<LossPeak> {
    let at_omega = |omega: f64| {
        let slope = creep.complex_compliance_slope(omega);
        measure(creep.complex_compliance(omega), slope)
    };
    let (start, end) = (range.0.ln(), range.1.ln());
    let intervals = ((end - start) / std::f64::consts::LN_10 * SAMPLES_PER_DECADE).ceil();
    let rising = |logarithm: f64| at_omega(logarithm.exp()).1 > 0.0;
    let at = |index: u32| start + (end - start) * f64::from(index) / intervals;
    let mut peaks = Vec::new();
    let mut before = rising(start);
    // At most 616 decades of doubles: the count fits.
    for index in 1..=intervals as u32 {
        let now = rising(at(index));
        if before && !now {
            let (last_rising, _) = bisect(at(index - 1), at(index), ALL_DIGITS, rising);
            let angular_frequency_rad_per_s = last_rising.exp();
            let (value, _) = at_omega(angular_frequency_rad_per_s);
            peaks.push(LossPeak {
                angular_frequency_rad_per_s,
                value,
            });
        }
        before = now;
    }
    peaks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{CreepBranch, RelaxationBranch};
    use approx::assert_relative_eq;

    #[test]
    fn a_zener_solid_peaks_at_its_three_closed_form_frequencies() {
        // E'' at 1/tau with (E_0 - E_inf)/2, D'' at 1/lambda with D_1/2, tan delta at the
        // geometric mean of the two with (E_0 - E_inf)/(2 sqrt(E_0 E_inf)).
        let (d0, d1, lambda) = (1e-9, 3e-9, 20.0);
        let branch = CreepBranch {
            compliance_per_pa: d1,
            time_s: lambda,
        };
        let creep = Creep::new(d0, vec![branch], None).unwrap();
        let relaxation = creep.to_relaxation().unwrap();
        let peaks = loss_peaks(&creep, Some(&relaxation));
        let (glassy, rubbery) = (1.0 / d0, 1.0 / (d0 + d1));
        let tau = lambda * d0 / (d0 + d1);
        let expected = [
            (&peaks.loss_modulus, 1.0 / tau, (glassy - rubbery) / 2.0),
            (&peaks.loss_compliance, 1.0 / lambda, d1 / 2.0),
            (
                &peaks.loss_tangent,
                1.0 / (tau * lambda).sqrt(),
                (glassy - rubbery) / (2.0 * (glassy * rubbery).sqrt()),
            ),
        ];
        for (found, omega, value) in expected {
            assert_eq!(found.len(), 1);
            // The slope vanishes there: its rounding error, a few eps, over its own slope, near one.
            assert_relative_eq!(
                found[0].angular_frequency_rad_per_s,
                omega,
                max_relative = 1e-12
            );
            assert_relative_eq!(found[0].value, value, max_relative = 1e-14);
        }
    }

    #[test]
    fn a_maxwell_fluid_peaks_in_its_modulus_only() {
        let branch = RelaxationBranch {
            modulus_pa: 4e6,
            time_s: 0.1,
        };
        let relaxation = Relaxation::new(0.0, vec![branch]).unwrap();
        let peaks = loss_peaks(&relaxation.to_creep().unwrap(), Some(&relaxation));
        assert_eq!(peaks.loss_modulus.len(), 1);
        let peak = peaks.loss_modulus[0];
        assert_relative_eq!(peak.angular_frequency_rad_per_s, 10.0, max_relative = 1e-12);
        assert_relative_eq!(peak.value, 2e6, max_relative = 1e-14);
        assert!(peaks.loss_compliance.is_empty() && peaks.loss_tangent.is_empty());
    }

    #[test]
    fn an_elastic_solid_has_no_peak_and_a_kelvin_voigt_solid_only_in_its_compliance() {
        let elastic = Creep::new(1e-9, vec![], None).unwrap();
        assert_eq!(loss_peaks(&elastic, None), LossPeaks::default());
        let branch = CreepBranch {
            compliance_per_pa: 1e-9,
            time_s: 2.0,
        };
        let voigt = loss_peaks(&Creep::new(0.0, vec![branch], None).unwrap(), None);
        assert!(voigt.loss_modulus.is_empty() && voigt.loss_tangent.is_empty());
        assert_eq!(voigt.loss_compliance.len(), 1);
        let omega = voigt.loss_compliance[0].angular_frequency_rad_per_s;
        assert_relative_eq!(omega, 0.5, max_relative = 1e-12);
    }

    #[test]
    fn well_separated_branches_peak_one_by_one() {
        let branches = [1e-3, 1.0, 1e3]
            .map(|time_s| RelaxationBranch {
                modulus_pa: 1e6,
                time_s,
            })
            .to_vec();
        let relaxation = Relaxation::new(1e9, branches).unwrap();
        let peaks = loss_peaks(&relaxation.to_creep().unwrap(), Some(&relaxation));
        let frequencies: Vec<f64> = peaks
            .loss_modulus
            .iter()
            .map(|peak| peak.angular_frequency_rad_per_s)
            .collect();
        assert_eq!(frequencies.len(), 3);
        for (found, expected) in frequencies.iter().zip([1e-3, 1.0, 1e3]) {
            // Neighbours three decades away lend a tail of slope 1e-3, which moves the outer
            // maxima (curvature 1/2) by 2e-3 relative.
            assert_relative_eq!(*found, expected, max_relative = 4e-3);
        }
    }
}
