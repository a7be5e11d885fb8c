//! The classical models of one or two springs and one dashpot: Maxwell, Zener, Kelvin-Voigt.
//!
//! Each is one block with its sketch, its functions and its limits. All moduli here are shear
//! moduli, as in S. Spinu, Advances in Tribology 2018, 9432894, equations (3) to (6); so are the
//! functions. `J(t)` is the shear creep compliance of the rheology books; that paper writes
//! `Phi = J/2`. Formulas: N. W. Tschoegl, *The Phenomenological Theory of Linear Viscoelastic
//! Behavior*, Springer 1989, chapter 3; R. M. Christensen, *Theory of Viscoelasticity*, 2nd
//! edition, Academic Press 1982, chapter 1.

use super::creep::{Creep, CreepBranch};
use super::error::{MaterialError, positive};
use super::relaxation::{Relaxation, RelaxationBranch};
use super::{Compressibility, Material, ModulusKind};

/// The Maxwell fluid: a spring and a dashpot in series.
///
/// ```text
///     ---/\/\/\---[ |---
///           G        G tau
/// ```
///
/// `G(t) = G exp(-t/tau)`, `J(t) = (1 + t/tau)/G`, hence `Phi(t) = (1 + t/tau)/(2G)`.
/// Limits: `G(0) = G`, `G(infinity) = 0`, steady-flow viscosity `G tau`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Maxwell {
    shear_modulus_pa: f64,
    time_s: f64,
}

impl Maxwell {
    /// Shear modulus `G` of the spring in Pa, relaxation time `tau` in s.
    ///
    /// # Errors
    /// A parameter that is not finite and positive.
    pub fn new(shear_modulus_pa: f64, time_s: f64) -> Result<Self, MaterialError> {
        Ok(Maxwell {
            shear_modulus_pa: positive(
                "shear modulus of the Maxwell model (Pa)",
                shear_modulus_pa,
            )?,
            time_s: positive("relaxation time of the Maxwell model (s)", time_s)?,
        })
    }

    /// Shear creep compliance `J(t) = (1 + t/tau)/G`.
    ///
    /// # Errors
    /// A compliance or viscosity beyond the range of a double.
    pub fn creep(&self) -> Result<Creep, MaterialError> {
        let viscosity_pa_s = self.shear_modulus_pa * self.time_s;
        Creep::new(
            1.0 / self.shear_modulus_pa,
            Vec::new(),
            Some(viscosity_pa_s),
        )
    }

    /// Shear relaxation modulus `G(t) = G exp(-t/tau)`.
    ///
    /// # Errors
    /// A modulus beyond the range of a double.
    pub fn relaxation(&self) -> Result<Relaxation, MaterialError> {
        let branch = RelaxationBranch {
            modulus_pa: self.shear_modulus_pa,
            time_s: self.time_s,
        };
        Relaxation::new(0.0, vec![branch])
    }

    /// The material with this model in shear and a constant Poisson ratio.
    ///
    /// # Errors
    /// As [`Material::from_relaxation`].
    pub fn material(
        &self,
        compressibility: impl Into<Compressibility>,
    ) -> Result<Material, MaterialError> {
        Material::from_relaxation(self.relaxation()?, ModulusKind::Shear, compressibility)
    }
}

/// The Zener (standard linear) solid: a spring in series with a Kelvin unit.
///
/// ```text
///                  |--/\/\/\--|  G_K
///     ---/\/\/\----|          |----
///           G      |---[ |----|  eta = G_K tau
/// ```
///
/// `J(t) = 1/G + (1 - exp(-t/tau))/G_K`, `Phi = J/2`, with the retardation time `tau = eta/G_K`;
/// `G(t) = G_inf + (G - G_inf) exp(-t/tau_r)` with `G_inf = G G_K/(G + G_K)` and the shorter
/// relaxation time `tau_r = tau G_K/(G + G_K)`.
/// Limits: `G_K -> infinity` is the elastic solid `G`, `G -> infinity` the Kelvin-Voigt solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zener {
    spring_pa: f64,
    kelvin_spring_pa: f64,
    retardation_time_s: f64,
}

impl Zener {
    /// Spring `G` and Kelvin spring `G_K` (shear moduli, Pa), retardation time `tau` in s.
    ///
    /// # Errors
    /// A parameter that is not finite and positive.
    pub fn new(
        spring_pa: f64,
        kelvin_spring_pa: f64,
        retardation_time_s: f64,
    ) -> Result<Self, MaterialError> {
        Ok(Zener {
            spring_pa: positive("spring of the Zener model (Pa)", spring_pa)?,
            kelvin_spring_pa: positive("Kelvin spring of the Zener model (Pa)", kelvin_spring_pa)?,
            retardation_time_s: positive(
                "retardation time of the Zener model (s)",
                retardation_time_s,
            )?,
        })
    }

    /// Shear creep compliance `J(t) = 1/G + (1 - exp(-t/tau))/G_K`.
    ///
    /// # Errors
    /// A compliance beyond the range of a double.
    pub fn creep(&self) -> Result<Creep, MaterialError> {
        let branch = CreepBranch {
            compliance_per_pa: 1.0 / self.kelvin_spring_pa,
            time_s: self.retardation_time_s,
        };
        Creep::new(1.0 / self.spring_pa, vec![branch], None)
    }

    /// Shear relaxation modulus `G(t) = G_inf + (G - G_inf) exp(-t/tau_r)`.
    ///
    /// # Errors
    /// A modulus beyond the range of a double.
    pub fn relaxation(&self) -> Result<Relaxation, MaterialError> {
        // Fractions of G and of tau, so that no product of two moduli can overflow.
        let kept = 1.0 / (1.0 + self.spring_pa / self.kelvin_spring_pa);
        let lost = 1.0 / (1.0 + self.kelvin_spring_pa / self.spring_pa);
        let branch = RelaxationBranch {
            modulus_pa: self.spring_pa * lost,
            time_s: self.retardation_time_s * kept,
        };
        Relaxation::new(self.spring_pa * kept, vec![branch])
    }

    /// The material with this model in shear and a constant Poisson ratio.
    ///
    /// # Errors
    /// As [`Material::from_creep`].
    pub fn material(
        &self,
        compressibility: impl Into<Compressibility>,
    ) -> Result<Material, MaterialError> {
        Material::from_creep(self.creep()?, ModulusKind::Shear, compressibility)
    }
}

/// The Kelvin-Voigt solid: a spring and a dashpot side by side.
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KelvinVoigt {
    spring_pa: f64,
    time_s: f64,
}

impl KelvinVoigt {
    /// Shear modulus `G` of the spring in Pa, retardation time `tau = eta/G` in s.
    ///
    /// # Errors
    /// A parameter that is not finite and positive.
    pub fn new(spring_pa: f64, time_s: f64) -> Result<Self, MaterialError> {
        Ok(KelvinVoigt {
            spring_pa: positive("spring of the Kelvin-Voigt model (Pa)", spring_pa)?,
            time_s: positive("retardation time of the Kelvin-Voigt model (s)", time_s)?,
        })
    }

    /// Shear creep compliance `J(t) = (1 - exp(-t/tau))/G`.
    ///
    /// # Errors
    /// A compliance beyond the range of a double.
    pub fn creep(&self) -> Result<Creep, MaterialError> {
        let branch = CreepBranch {
            compliance_per_pa: 1.0 / self.spring_pa,
            time_s: self.time_s,
        };
        Creep::new(0.0, vec![branch], None)
    }

    /// The material with this model in shear and a constant Poisson ratio.
    ///
    /// # Errors
    /// As [`Material::from_creep`].
    pub fn material(
        &self,
        compressibility: impl Into<Compressibility>,
    ) -> Result<Material, MaterialError> {
        Material::from_creep(self.creep()?, ModulusKind::Shear, compressibility)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    // Closed forms against closed forms: a few roundings.
    const ROUNDING: f64 = 4e-15;

    #[test]
    fn the_maxwell_creep_and_relaxation_are_one_material() {
        let maxwell = Maxwell::new(2.0, 5.0).unwrap();
        let creep = maxwell.creep().unwrap();
        assert_relative_eq!(
            creep.compliance(15.0),
            (1.0 + 3.0) / 2.0,
            max_relative = ROUNDING
        );
        assert_eq!(maxwell.relaxation().unwrap().to_creep().unwrap(), creep);
        let material = maxwell.material(0.5).unwrap();
        let phi = material.shear_creep_function().unwrap();
        assert_relative_eq!(phi.compliance(15.0), 1.0, max_relative = ROUNDING);
    }

    #[test]
    fn the_zener_relaxation_is_the_converted_creep() {
        for (spring, kelvin) in [(1e9, 1e9), (1e9, 3e5), (2e6, 7e12)] {
            let zener = Zener::new(spring, kelvin, 40.0).unwrap();
            let given = zener.relaxation().unwrap();
            let converted = zener.creep().unwrap().to_relaxation().unwrap();
            assert_relative_eq!(
                given.equilibrium_modulus(),
                converted.equilibrium_modulus(),
                max_relative = ROUNDING
            );
            assert_relative_eq!(
                given.branches()[0].modulus_pa,
                converted.branches()[0].modulus_pa,
                max_relative = ROUNDING
            );
            assert_relative_eq!(
                given.branches()[0].time_s,
                converted.branches()[0].time_s,
                max_relative = ROUNDING
            );
        }
    }

    #[test]
    fn a_zener_with_a_stiff_kelvin_unit_is_elastic_and_with_a_stiff_spring_is_kelvin_voigt() {
        let elastic = Zener::new(1e9, 1e30, 1.0).unwrap().creep().unwrap();
        assert_relative_eq!(elastic.compliance(100.0), 1e-9, max_relative = ROUNDING);
        let nearly = Zener::new(1e30, 1e9, 1.0).unwrap().creep().unwrap();
        let voigt = KelvinVoigt::new(1e9, 1.0).unwrap().creep().unwrap();
        for omega in [0.01, 1.0, 100.0] {
            let difference = nearly.complex_modulus(omega) - voigt.complex_modulus(omega);
            // The spring adds 1e-30 to a compliance of at least 1e-13.
            assert!(difference.norm() <= ROUNDING * voigt.complex_modulus(omega).norm());
        }
    }

    #[test]
    fn the_kelvin_voigt_modulus_is_a_spring_plus_a_dashpot() {
        let voigt = KelvinVoigt::new(3.0, 2.0).unwrap().creep().unwrap();
        for omega in [1e-6, 0.5, 1e6] {
            let modulus = voigt.complex_modulus(omega);
            // D' and D'' carry a few roundings each; E' at high frequency is D'/D''^2.
            assert_relative_eq!(modulus.re, 3.0, max_relative = ROUNDING);
            assert_relative_eq!(modulus.im, 3.0 * omega * 2.0, max_relative = ROUNDING);
        }
    }

    #[test]
    fn parameters_that_are_not_positive_are_refused() {
        assert!(Maxwell::new(0.0, 1.0).is_err());
        assert!(Maxwell::new(1.0, f64::INFINITY).is_err());
        assert!(Zener::new(1.0, -1.0, 1.0).is_err());
        assert!(KelvinVoigt::new(f64::NAN, 1.0).is_err());
    }
}
