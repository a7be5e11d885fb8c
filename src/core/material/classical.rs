//! The classical models of one or two springs and one dashpot: Maxwell, Zener, Kelvin-Voigt.
//!
//! Each is one function, with the sketch and the limits of its model. All moduli here are shear
//! moduli, as in S. Spinu, Advances in Tribology 2018, 9432894, equations (3) to (6); so are the
//! functions of the material that is returned. `J(t)` is the shear creep compliance of the rheology books; that paper writes
//! `Phi = J/2`. Formulas: N. W. Tschoegl, *The Phenomenological Theory of Linear Viscoelastic
//! Behavior*, Springer 1989, chapter 3; R. M. Christensen, *Theory of Viscoelasticity*, 2nd
//! edition, Academic Press 1982, chapter 1.

use super::creep::{Creep, CreepBranch};
use super::error::{MaterialError, positive};
use super::relaxation::{Relaxation, RelaxationBranch};

/// The Maxwell fluid, a spring and a dashpot in series, of the shear modulus `G` (Pa) of the spring and the relaxation time `tau` (s).
///
/// ```text
///     ---/\/\/\---[ |---
///           G        G tau
/// ```
///
/// `G(t) = G exp(-t/tau)`, `J(t) = (1 + t/tau)/G`, hence `Phi(t) = (1 + t/tau)/(2G)`.
/// Limits: `G(0) = G`, `G(infinity) = 0`, steady-flow viscosity `G tau`.
///
/// # Errors
/// A parameter that is not finite and positive.
pub fn maxwell(shear_modulus_pa: f64, time_s: f64) -> Result<Relaxation, MaterialError> {
    let branch = RelaxationBranch {
        modulus_pa: positive("shear modulus of the Maxwell model (Pa)", shear_modulus_pa)?,
        time_s: positive("relaxation time of the Maxwell model (s)", time_s)?,
    };
    Relaxation::new(0.0, vec![branch])
}

/// The Zener (standard linear) solid, a spring in series with a Kelvin unit, of the spring `G` and the Kelvin spring `G_K` (shear moduli,
/// Pa) and the retardation time `tau = eta/G_K` (s).
///
/// ```text
///                  |--/\/\/\--|  G_K
///     ---/\/\/\----|          |----
///           G      |---[ |----|  eta = G_K tau
/// ```
///
/// `J(t) = 1/G + (1 - exp(-t/tau))/G_K`, `Phi = J/2`; `G(t) = G_inf + (G - G_inf) exp(-t/tau_r)` with
/// `G_inf = G G_K/(G + G_K)` and the shorter relaxation time `tau_r = tau G_K/(G + G_K)`.
/// Limits: `G_K -> infinity` is the elastic solid `G`, `G -> infinity` the Kelvin-Voigt solid.
///
/// # Errors
/// A parameter that is not finite and positive; a compliance beyond the range of a double.
pub fn zener(
    spring_pa: f64,
    kelvin_spring_pa: f64,
    retardation_time_s: f64,
) -> Result<Creep, MaterialError> {
    let instantaneous_per_pa = positive("spring of the Zener model (Pa)", spring_pa)?.recip();
    let kelvin_spring_pa = positive("Kelvin spring of the Zener model (Pa)", kelvin_spring_pa)?;
    let branch = CreepBranch {
        compliance_per_pa: kelvin_spring_pa.recip(),
        time_s: positive(
            "retardation time of the Zener model (s)",
            retardation_time_s,
        )?,
    };
    Creep::new(instantaneous_per_pa, vec![branch], None)
}

/// The Kelvin-Voigt solid, a spring and a dashpot side by side, of the shear modulus `G` (Pa) of the spring and the retardation time
/// `tau = eta/G` (s).
///
/// ```text
///        |--/\/\/\--|  G
///     ---|          |---
///        |---[ |----|  eta = G tau
/// ```
///
/// `J(t) = (1 - exp(-t/tau))/G`, `G* = G (1 + i omega tau)`.
/// Limits: `J(0) = 0`, `J(infinity) = 1/G`. Nothing yields at the first instant, so there is no
/// relaxation modulus in the ordinary sense and no bounded contact pressure: it is a material to
/// look at, and contact refuses it.
///
/// # Errors
/// A parameter that is not finite and positive; a compliance beyond the range of a double.
pub fn kelvin_voigt(spring_pa: f64, time_s: f64) -> Result<Creep, MaterialError> {
    let spring_pa = positive("spring of the Kelvin-Voigt model (Pa)", spring_pa)?;
    let branch = CreepBranch {
        compliance_per_pa: spring_pa.recip(),
        time_s: positive("retardation time of the Kelvin-Voigt model (s)", time_s)?,
    };
    Creep::new(0.0, vec![branch], None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Material, ModulusKind};
    use approx::assert_relative_eq;

    // Closed forms against closed forms: a few roundings.
    const ROUNDING: f64 = 4e-15;

    #[test]
    fn the_maxwell_creep_and_relaxation_are_one_material() {
        let relaxation = maxwell(2.0, 5.0).unwrap();
        let creep = relaxation.to_creep().unwrap();
        assert_relative_eq!(
            creep.compliance(15.0),
            (1.0 + 3.0) / 2.0,
            max_relative = ROUNDING
        );
        assert_eq!(creep, Creep::new(0.5, vec![], Some(10.0)).unwrap());
        let material = Material::from_relaxation(relaxation, ModulusKind::Shear, 0.5).unwrap();
        let phi = material.shear_creep_function().unwrap();
        assert_relative_eq!(phi.compliance(15.0), 1.0, max_relative = ROUNDING);
    }

    #[test]
    fn the_zener_relaxation_is_the_converted_creep() {
        for (spring, kelvin) in [(1e9, 1e9), (1e9, 3e5), (2e6, 7e12)] {
            // Fractions of G and of tau: G_inf = G G_K/(G + G_K), tau_r = tau G_K/(G + G_K).
            let kept = 1.0 / (1.0 + spring / kelvin);
            let lost = 1.0 / (1.0 + kelvin / spring);
            let converted = zener(spring, kelvin, 40.0)
                .unwrap()
                .to_relaxation()
                .unwrap();
            assert_relative_eq!(
                spring * kept,
                converted.equilibrium_modulus(),
                max_relative = ROUNDING
            );
            assert_relative_eq!(
                spring * lost,
                converted.branches()[0].modulus_pa,
                max_relative = ROUNDING
            );
            assert_relative_eq!(
                40.0 * kept,
                converted.branches()[0].time_s,
                max_relative = ROUNDING
            );
        }
    }

    #[test]
    fn a_zener_with_a_stiff_kelvin_unit_is_elastic_and_with_a_stiff_spring_is_kelvin_voigt() {
        let elastic = zener(1e9, 1e30, 1.0).unwrap();
        assert_relative_eq!(elastic.compliance(100.0), 1e-9, max_relative = ROUNDING);
        let nearly = zener(1e30, 1e9, 1.0).unwrap();
        let voigt = kelvin_voigt(1e9, 1.0).unwrap();
        for omega in [0.01, 1.0, 100.0] {
            let difference = nearly.complex_modulus(omega) - voigt.complex_modulus(omega);
            // The spring adds 1e-30 to a compliance of at least 1e-13.
            assert!(difference.norm() <= ROUNDING * voigt.complex_modulus(omega).norm());
        }
    }

    #[test]
    fn the_kelvin_voigt_modulus_is_a_spring_plus_a_dashpot() {
        let voigt = kelvin_voigt(3.0, 2.0).unwrap();
        for omega in [1e-6, 0.5, 1e6] {
            let modulus = voigt.complex_modulus(omega);
            // D' and D'' carry a few roundings each; E' at high frequency is D'/D''^2.
            assert_relative_eq!(modulus.re, 3.0, max_relative = ROUNDING);
            assert_relative_eq!(modulus.im, 3.0 * omega * 2.0, max_relative = ROUNDING);
        }
    }

    #[test]
    fn parameters_that_are_not_positive_are_refused() {
        assert!(maxwell(0.0, 1.0).is_err());
        assert!(maxwell(1.0, f64::INFINITY).is_err());
        assert!(zener(1.0, -1.0, 1.0).is_err());
        assert!(kelvin_voigt(f64::NAN, 1.0).is_err());
    }
}
