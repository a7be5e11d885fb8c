//! Linear viscoelastic materials: relaxation modulus, creep compliance, complex modulus.
//!
//! A [`Material`] holds both functions of one material, the [`Creep`] compliance and, where there is
//! one, the [`Relaxation`] modulus, with a Poisson ratio that does not depend on time, or a bulk modulus that may relax. SI units
//! throughout; harmonic quantities vary as `exp(+i omega t)`, so `E* = E' + i E''` and
//! `D* = 1/E* = D' - i D''`.
//!
//! With a constant Poisson ratio every function of the material is a multiple of one of them:
//!
//! | function | from longitudinal D | from shear J |
//! |---|---|---|
//! | longitudinal creep compliance D | D | J/(2 (1 + nu)) |
//! | shear creep compliance J | 2 (1 + nu) D | J |
//! | Phi, shear as S. Spinu (2018) writes it | (1 + nu) D | J/2 |
//! | contact compliance C = (1 - nu) Phi | (1 - nu^2) D | (1 - nu) J/2 |
//!
//! With a bulk modulus in its place the Poisson ratio changes as the body relaxes: [`compressibility`].
//!
//! This room knows nothing of indenters, drives or contact.
//!
//! ```
//! # extern crate contact_dma_core as contact_dma;
//! use contact_dma::material::{Material, MaterialError, ModulusKind, Relaxation, RelaxationBranch};
//!
//! let branch = RelaxationBranch { modulus_pa: 2e9, time_s: 1.0 };
//! let relaxation = Relaxation::new(1e9, vec![branch])?;
//! let solid = Material::from_relaxation(relaxation, ModulusKind::Longitudinal, 0.35)?;
//! let modulus = solid.longitudinal_complex_modulus(1.0); // at 1 rad/s
//! assert!((modulus.re - 2e9).abs() < 1.0 && (modulus.im - 1e9).abs() < 1.0);
//! # Ok::<(), MaterialError>(())
//! ```

pub mod classical;
pub mod compressibility;
pub mod continuous;
pub mod dynamic;
pub mod export;
pub mod fit;
pub mod fractional;
pub mod interpolant;
pub mod keys;
pub mod law;
pub mod library;
pub mod sampled;
pub mod tabulated;

mod conversion;
mod creep;
mod error;
mod functions;
mod harmonic;
mod peaks;
mod relaxation;
mod spectrum;
#[cfg(test)]
mod synthetic;

use crate::words;

pub use compressibility::Compressibility;
pub use creep::{Creep, CreepBranch};
pub use error::MaterialError;
pub use peaks::{LossPeak, LossPeaks};
pub use relaxation::{Relaxation, RelaxationBranch};

words! {
    /// What a modulus or a compliance relates: shear stress and engineering shear strain, or
    /// longitudinal (uniaxial) stress and strain.
    #[derive(Hash)]
    pub enum ModulusKind {
        /// Young's modulus E and uniaxial creep compliance D.
        Longitudinal = "longitudinal",
        /// Shear modulus G and shear creep compliance J.
        Shear = "shear",
    }
}

words! {
    /// The function of the material that was given; the other was computed from it.
    #[derive(Hash)]
    pub enum MaterialFunction {
        /// A creep compliance.
        Creep = "creep",
        /// A relaxation modulus.
        Relaxation = "relaxation",
    }
}

/// `1 branch`, `3 branches`.
pub(crate) fn branches_in_words(count: usize) -> String {
    match count {
        1 => "1 branch".to_owned(),
        count => format!("{count} branches"),
    }
}

impl MaterialFunction {
    /// The letter of the function of this kind.
    pub const fn symbol(self, kind: ModulusKind) -> char {
        match (self, kind) {
            (Self::Relaxation, ModulusKind::Longitudinal) => 'E',
            (Self::Relaxation, ModulusKind::Shear) => 'G',
            (Self::Creep, ModulusKind::Longitudinal) => 'D',
            (Self::Creep, ModulusKind::Shear) => 'J',
        }
    }
}

/// An isotropic linear viscoelastic material of constant Poisson ratio, or of a bulk modulus, constant or relaxing.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    name: Option<String>,
    compressibility: Compressibility,
    /// Shear where a bulk modulus is given.
    kind: ModulusKind,
    function: MaterialFunction,
    creep: Creep,
    relaxation: Option<Relaxation>,
    indenter_material: Option<Box<Material>>,
    /// What is known of where its numbers come from.
    pub origin: Origin,
}

/// Where the numbers of a material come from: data, a fit, a model that the series stands for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Origin {
    /// Where the material was fitted to a table: how well, and what was assumed.
    pub fit: Option<fit::FitReport>,
    /// Where the material stands for a fractional model: over which band, and how well.
    pub approximation: Option<fractional::Approximation>,
    /// First and last time (s) at which the material was observed. What it does at angular frequencies outside
    /// `1/last < omega < 1/first` is an extrapolation.
    pub measured_window_s: Option<(f64, f64)>,
    /// The temperature (K) that the material is at.
    pub temperature_k: Option<f64>,
    /// How the material shifts in time with the temperature, from its own on.
    pub shift: Option<dynamic::shift_law::Wlf>,
    /// Lowest and highest temperature (K) of the isotherms that the material comes from. What it does at a temperature outside is an
    /// extrapolation of its shift.
    pub isotherms_k: Option<(f64, f64)>,
    /// Materials of the same kind that this one may be as well: what a result with one of them differs by is an error of the result.
    /// Beside a series fitted to a table they fit the data about as well, and differ in what the data leave open: the equilibrium
    /// modulus at its lowest and highest, and the instantaneous one. Beside the series of a fractional model, one that is far closer
    /// to the model. They have no alternatives of their own. Empty where nothing is open.
    pub alternatives: Vec<Material>,
    /// Materials of the same kind, drawn at random: what the fit gives where the noise of the data falls otherwise. All are alike in
    /// probability, and have no replicas and no window of their own. What a result is with each of them tells its uncertainty. Empty
    /// where none were drawn.
    pub replicas: Vec<Material>,
}

impl Material {
    /// A material from its relaxation modulus.
    ///
    /// # Errors
    /// A Poisson ratio outside -1 < nu <= 1/2; a bulk modulus that is not positive, or too small for moduli in tension; a creep
    /// compliance beyond the range of a double.
    pub fn from_relaxation(
        relaxation: Relaxation,
        kind: ModulusKind,
        compressibility: impl Into<Compressibility>,
    ) -> Result<Self, MaterialError> {
        let compressibility = compressibility.into().checked()?;
        if let (Compressibility::BulkModulus(_), ModulusKind::Longitudinal) =
            (&compressibility, kind)
        {
            return Self::from_creep(relaxation.to_creep()?, kind, compressibility);
        }
        let (function, creep) = (MaterialFunction::Relaxation, relaxation.to_creep()?);
        let relaxation = Some(relaxation);
        Ok(Self::plain(
            compressibility,
            kind,
            function,
            creep,
            relaxation,
        ))
    }

    /// A material from its creep compliance. Without an instantaneous compliance (Kelvin-Voigt) it
    /// has no relaxation modulus and cannot go into contact, but can be looked at.
    ///
    /// # Errors
    /// A Poisson ratio outside -1 < nu <= 1/2; a bulk modulus that is not positive, or too small for compliances in tension; a
    /// relaxation modulus beyond the range of a double.
    pub fn from_creep(
        creep: Creep,
        kind: ModulusKind,
        compressibility: impl Into<Compressibility>,
    ) -> Result<Self, MaterialError> {
        let compressibility = compressibility.into().checked()?;
        let (creep, kind) = match (&compressibility, kind) {
            (Compressibility::BulkModulus(bulk), ModulusKind::Longitudinal) => {
                let shear = compressibility::shear_of_longitudinal(&creep, bulk)?;
                (shear, ModulusKind::Shear)
            }
            _ => (creep, kind),
        };
        let relaxation = match creep.to_relaxation() {
            Ok(relaxation) => Some(relaxation),
            Err(MaterialError::NoRelaxationModulus) => None,
            Err(error) => return Err(error),
        };
        let function = MaterialFunction::Creep;
        Ok(Self::plain(
            compressibility,
            kind,
            function,
            creep,
            relaxation,
        ))
    }

    /// Of which no more is known.
    fn plain(
        compressibility: Compressibility,
        kind: ModulusKind,
        function: MaterialFunction,
        creep: Creep,
        relaxation: Option<Relaxation>,
    ) -> Self {
        Material {
            name: None,
            compressibility,
            kind,
            function,
            creep,
            relaxation,
            indenter_material: None,
            origin: Origin::default(),
        }
    }

    /// The same material under a name.
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// The same material, pressed by an indenter of this one in place of a rigid one.
    pub fn against(mut self, indenter: Material) -> Self {
        let origin = &mut self.origin;
        for other in origin.alternatives.iter_mut().chain(&mut origin.replicas) {
            *other = other.clone().against(indenter.clone());
        }
        self.indenter_material = Some(Box::new(indenter));
        self
    }

    /// What the indenter is made of; `None` for a rigid one.
    pub fn indenter_material(&self) -> Option<&Material> {
        self.indenter_material.as_deref()
    }

    /// Which part of each branch of the [contact compliance](Self::contact_compliance) is the indenter's, in their order: all or
    /// nothing, but for a retardation time that both bodies have, whose strains differ by a factor only. `None` for a rigid one.
    ///
    /// # Errors
    /// As [`Self::contact_compliance`].
    pub fn shares_of_indenter(&self) -> Result<Vec<Option<f64>>, MaterialError> {
        let pair = self.contact_compliance()?;
        let Some(indenter) = &self.indenter_material else {
            return Ok(vec![None; pair.branches().len()]);
        };
        let own = indenter.contact_compliance()?;
        let share = |branch: &CreepBranch| {
            let same = own
                .branches()
                .iter()
                .find(|other| other.time_s == branch.time_s);
            Some(same.map_or(0.0, |other| {
                other.compliance_per_pa / branch.compliance_per_pa
            }))
        };
        Ok(pair.branches().iter().map(share).collect())
    }

    /// The name, if it has one.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// What says how the volume changes.
    pub fn compressibility(&self) -> &Compressibility {
        &self.compressibility
    }

    /// The Poisson ratio, where it is constant in time.
    pub fn poisson_ratio(&self) -> Option<f64> {
        self.compressibility.poisson_ratio()
    }

    /// The Poisson ratio at this time (s) of a relaxation test in tension, minus the lateral over the axial strain.
    ///
    /// # Errors
    /// [`MaterialError::NoRelaxationModulus`]; a compliance beyond the range of a double.
    pub fn poisson_ratio_at(&self, time_s: f64) -> Result<f64, MaterialError> {
        match &self.compressibility {
            Compressibility::PoissonRatio(nu) => Ok(*nu),
            Compressibility::BulkModulus(bulk) => {
                compressibility::poisson_ratio_at(self.needed_relaxation()?, bulk, time_s)
            }
        }
    }

    fn needed_relaxation(&self) -> Result<&Relaxation, MaterialError> {
        let relaxation = self.relaxation.as_ref();
        relaxation.ok_or(MaterialError::NoRelaxationModulus)
    }

    /// Whether [`creep`](Self::creep) and [`relaxation`](Self::relaxation) are shear or longitudinal.
    pub fn kind(&self) -> ModulusKind {
        self.kind
    }

    /// Which of its two functions was given.
    pub fn function(&self) -> MaterialFunction {
        self.function
    }

    /// Creep compliance of the material's own [`kind`](Self::kind), in 1/Pa.
    pub fn creep(&self) -> &Creep {
        &self.creep
    }

    /// Relaxation modulus of the material's own [`kind`](Self::kind), in Pa; `None` if the
    /// material is instantaneously rigid (Kelvin-Voigt).
    pub fn relaxation(&self) -> Option<&Relaxation> {
        self.relaxation.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    // A handful of multiplications.
    const ROUNDING: f64 = 1e-15;

    fn elastic(modulus_pa: f64, kind: ModulusKind, poisson_ratio: f64) -> Material {
        Material::from_relaxation(
            Relaxation::new(modulus_pa, vec![]).unwrap(),
            kind,
            poisson_ratio,
        )
        .unwrap()
    }

    #[test]
    fn an_elastic_solid_has_the_contact_modulus_of_hertz() {
        for nu in [-0.9, 0.0, 0.3, 0.5] {
            let young = 3e9;
            let shear = young / (2.0 * (1.0 + nu));
            let hertz = (1.0 - nu * nu) / young;
            let from_young = elastic(young, ModulusKind::Longitudinal, nu);
            let from_shear = elastic(shear, ModulusKind::Shear, nu);
            for material in [from_young, from_shear] {
                let contact = material
                    .contact_compliance()
                    .unwrap()
                    .instantaneous_compliance();
                assert_relative_eq!(contact, hertz, max_relative = ROUNDING);
                let phi = material
                    .shear_creep_function()
                    .unwrap()
                    .instantaneous_compliance();
                assert_relative_eq!(phi, 1.0 / (2.0 * shear), max_relative = ROUNDING);
                let modulus = material.longitudinal_complex_modulus(1.0);
                assert_relative_eq!(modulus.re, young, max_relative = ROUNDING);
                assert_relative_eq!(
                    material.shear_complex_modulus(1.0).re,
                    shear,
                    max_relative = ROUNDING
                );
                let contact = material.contact_complex_modulus(1.0).re;
                assert_relative_eq!(contact, 1.0 / hertz, max_relative = ROUNDING);
            }
        }
    }

    #[test]
    fn shear_and_longitudinal_descriptions_of_one_material_agree() {
        let branch = RelaxationBranch {
            modulus_pa: 5e8,
            time_s: 3.0,
        };
        let relaxation = Relaxation::new(1e9, vec![branch]).unwrap();
        let nu = 0.4;
        let shear = Material::from_relaxation(relaxation.clone(), ModulusKind::Shear, nu).unwrap();
        let longitudinal = Material::from_relaxation(
            relaxation.scaled(2.0 * (1.0 + nu)).unwrap(),
            ModulusKind::Longitudinal,
            nu,
        )
        .unwrap();
        for omega in [0.0, 0.01, 0.4, 30.0, f64::INFINITY] {
            let difference = shear.longitudinal_complex_modulus(omega)
                - longitudinal.longitudinal_complex_modulus(omega);
            assert!(difference.norm() <= 4e-15 * 4e9, "{difference} at {omega}");
        }
        for time_s in [0.0, 0.1, 3.0, 100.0] {
            let left = shear.contact_compliance().unwrap().compliance(time_s);
            let right = longitudinal
                .contact_compliance()
                .unwrap()
                .compliance(time_s);
            assert_relative_eq!(left, right, max_relative = 4e-15);
            let left = shear
                .creep_as(ModulusKind::Longitudinal)
                .unwrap()
                .compliance(time_s);
            assert_relative_eq!(
                left,
                longitudinal.creep().compliance(time_s),
                max_relative = 4e-15
            );
            let right = longitudinal
                .relaxation_as(ModulusKind::Shear)
                .unwrap()
                .unwrap();
            assert_relative_eq!(
                right.modulus(time_s),
                relaxation.modulus(time_s),
                max_relative = 4e-15
            );
        }
    }

    #[test]
    fn a_kelvin_voigt_solid_can_be_looked_at_but_not_put_into_contact() {
        let creep = classical::kelvin_voigt(1e9, 2.0).unwrap();
        let material = Material::from_creep(creep, ModulusKind::Shear, 0.3).unwrap();
        assert_eq!(material.relaxation(), None);
        assert_eq!(material.function(), MaterialFunction::Creep);
        assert_relative_eq!(
            material.shear_complex_modulus(0.5).re,
            1e9,
            max_relative = ROUNDING
        );
        let error = material.contact_compliance().unwrap_err();
        assert_eq!(error, MaterialError::SingularContactPressure);
        assert!(error.to_string().contains("Zener"));
    }

    #[test]
    fn a_poisson_ratio_outside_the_thermodynamic_range_is_refused() {
        let relaxation = Relaxation::new(1.0, vec![]).unwrap();
        for nu in [-1.0, 0.51, f64::NAN, f64::INFINITY] {
            let error =
                Material::from_relaxation(relaxation.clone(), ModulusKind::Shear, nu).unwrap_err();
            assert!(error.to_string().contains("Poisson ratio"), "{error}");
        }
    }

    #[test]
    fn a_name_is_kept() {
        let material = elastic(1.0, ModulusKind::Shear, 0.0);
        assert_eq!(material.name(), None);
        assert_eq!(material.named("glass").name(), Some("glass"));
    }
}
