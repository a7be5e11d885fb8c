//! The functions of a material: of the kind asked for, in contact, and at a frequency.

use num_complex::Complex;

use super::compressibility::{self, Compressibility};
use super::peaks::{self, LossPeaks};
use super::{Creep, Material, MaterialError, MaterialFunction, ModulusKind, Relaxation};

impl Material {
    /// Creep compliance of the kind asked for, in 1/Pa: `J = 2 (1 + nu) D`.
    ///
    /// # Errors
    /// A compliance beyond the range of a double.
    pub fn creep_as(&self, kind: ModulusKind) -> Result<Creep, MaterialError> {
        match (&self.compressibility, kind) {
            (Compressibility::PoissonRatio(nu), _) => {
                self.creep.scaled(1.0 / self.modulus_factor(kind, *nu))
            }
            (Compressibility::BulkModulus(_), ModulusKind::Shear) => self.creep.scaled(1.0),
            (Compressibility::BulkModulus(bulk), ModulusKind::Longitudinal) => {
                compressibility::longitudinal_of_shear(&self.creep, bulk)
            }
        }
    }

    /// Relaxation modulus of the kind asked for, in Pa: `E(t) = 2 (1 + nu) G(t)`; `None` if the
    /// material is instantaneously rigid.
    ///
    /// # Errors
    /// A modulus beyond the range of a double.
    pub fn relaxation_as(&self, kind: ModulusKind) -> Result<Option<Relaxation>, MaterialError> {
        let Some(relaxation) = &self.relaxation else {
            return Ok(None);
        };
        let own = match (&self.compressibility, kind) {
            (Compressibility::PoissonRatio(nu), _) => {
                relaxation.scaled(self.modulus_factor(kind, *nu))
            }
            (Compressibility::BulkModulus(_), ModulusKind::Shear) => relaxation.scaled(1.0),
            (Compressibility::BulkModulus(_), ModulusKind::Longitudinal) => {
                self.creep_as(kind)?.to_relaxation()
            }
        };
        own.map(Some)
    }

    /// The shear creep function `Phi(t) = J(t)/2 = (1 + nu) D(t)`, in 1/Pa, as S. Spinu writes it
    /// (Advances in Tribology 2018, 9432894, equations (3) to (10)); `1/(2G)` for an elastic solid.
    ///
    /// # Errors
    /// A compliance beyond the range of a double.
    pub fn shear_creep_function(&self) -> Result<Creep, MaterialError> {
        self.creep.scaled(match (self.kind, &self.compressibility) {
            (ModulusKind::Longitudinal, Compressibility::PoissonRatio(nu)) => 1.0 + nu,
            _ => 0.5,
        })
    }

    /// The contact compliance `C(t) = (1 - nu^2) D(t) = (1 - nu) J(t)/2`, in 1/Pa, or that of a bulk modulus: what takes the
    /// place of `1/E* = (1 - nu^2)/E` of a half-space when the solid is viscoelastic (E. H. Lee
    /// and J. R. M. Radok, Journal of Applied Mechanics 27 (1960) 438). That of an indenter which is not rigid is added: both
    /// surfaces move under the same pressure (K. L. Johnson, *Contact Mechanics*, Cambridge 1985, section 4.2).
    ///
    /// # Errors
    /// [`MaterialError::SingularContactPressure`] without an instantaneous compliance; a
    /// compliance beyond the range of a double.
    pub fn contact_compliance(&self) -> Result<Creep, MaterialError> {
        if self.creep.is_instantaneously_rigid() {
            return Err(MaterialError::SingularContactPressure);
        }
        let own = match &self.compressibility {
            Compressibility::PoissonRatio(nu) => {
                let lateral = 1.0 - nu;
                self.creep.scaled(match self.kind {
                    ModulusKind::Shear => 0.5 * lateral,
                    ModulusKind::Longitudinal => lateral * (1.0 + nu),
                })?
            }
            Compressibility::BulkModulus(bulk) => {
                let shear = self.needed_relaxation()?;
                let constrained = compressibility::under_lateral_constraint(shear, bulk)?;
                self.creep
                    .scaled(0.25)?
                    .beside(&constrained.scaled(0.75)?)?
            }
        };
        match &self.indenter_material {
            Some(indenter) => own.beside(&indenter.contact_compliance()?),
            None => Ok(own),
        }
    }

    /// Longitudinal complex modulus `E* = E' + i E'' = 2 (1 + nu) G*`, in Pa.
    pub fn longitudinal_complex_modulus(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        self.complex_modulus_as(ModulusKind::Longitudinal, angular_frequency_rad_per_s)
    }

    /// Shear complex modulus `G* = G' + i G''`, in Pa.
    pub fn shear_complex_modulus(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        self.complex_modulus_as(ModulusKind::Shear, angular_frequency_rad_per_s)
    }

    /// Contact complex modulus `1/C* = E*/(1 - nu^2)`, in Pa, which a flat punch sees.
    pub fn contact_complex_modulus(&self, angular_frequency_rad_per_s: f64) -> Complex<f64> {
        let omega = angular_frequency_rad_per_s;
        match &self.compressibility {
            Compressibility::PoissonRatio(nu) => {
                self.longitudinal_complex_modulus(omega) / ((1.0 - nu) * (1.0 + nu))
            }
            Compressibility::BulkModulus(bulk) => compressibility::contact_of_shear(
                self.shear_complex_modulus(omega),
                bulk.complex_modulus(omega),
            ),
        }
    }

    /// What a loop between the pair says of this material: storage and loss modulus (Pa) from those that the formula of
    /// [`LoopAnalysis::equivalent_moduli_pa`](crate::cycle::LoopAnalysis::equivalent_moduli_pa) reads with the material's Poisson ratio,
    /// as if the indenter were rigid, or with 0 where that is not constant. What the indenter yields is taken off, and with a constant
    /// bulk modulus E* is that of the contact modulus 1/C*.
    pub fn of_loop(
        &self,
        (storage_pa, loss_pa): (f64, f64),
        angular_frequency_rad_per_s: f64,
    ) -> (f64, f64) {
        let read = Complex::new(storage_pa, loss_pa);
        let nu = self.poisson_ratio().unwrap_or(0.0);
        let lateral = (1.0 - nu) * (1.0 + nu);
        let own = self.indenter_material.as_ref().map(|indenter| {
            indenter.as_indenter_taken_off(read, lateral, angular_frequency_rad_per_s)
        });
        let own = match &self.compressibility {
            Compressibility::PoissonRatio(_) => own.unwrap_or(read),
            Compressibility::BulkModulus(bulk) => {
                let bulk_pa = bulk.complex_modulus(angular_frequency_rad_per_s);
                let shear = compressibility::shear_of_contact(own.unwrap_or(read), bulk_pa);
                compressibility::young_of_shear(shear, bulk_pa)
            }
        };
        (own.re, own.im)
    }

    /// The modulus (Pa) of a body that this material presses as the indenter, from that which a loop gives as if it were rigid;
    /// `lateral` is 1 - nu^2 of the body.
    pub(crate) fn as_indenter_taken_off(
        &self,
        read: Complex<f64>,
        lateral: f64,
        angular_frequency_rad_per_s: f64,
    ) -> Complex<f64> {
        let own = self.contact_complex_modulus(angular_frequency_rad_per_s);
        lateral * (read.inv() * lateral - own.inv()).inv()
    }

    /// Local maxima over frequency of loss modulus, loss compliance (of the kind asked for) and
    /// loss tangent, searched to two decades beyond the time constants.
    ///
    /// # Errors
    /// A compliance beyond the range of a double.
    pub fn loss_peaks(&self, kind: ModulusKind) -> Result<LossPeaks, MaterialError> {
        let relaxation = self.relaxation_as(kind)?;
        Ok(peaks::loss_peaks(
            &self.creep_as(kind)?,
            relaxation.as_ref(),
        ))
    }

    /// The complex modulus from the function that was given, which has seen no conversion.
    fn complex_modulus_as(&self, kind: ModulusKind, omega: f64) -> Complex<f64> {
        let own = match (self.function, &self.relaxation) {
            (MaterialFunction::Relaxation, Some(relaxation)) => relaxation.complex_modulus(omega),
            _ => self.creep.complex_modulus(omega),
        };
        match (&self.compressibility, kind) {
            (Compressibility::PoissonRatio(nu), _) => own * self.modulus_factor(kind, *nu),
            (Compressibility::BulkModulus(_), ModulusKind::Shear) => own,
            (Compressibility::BulkModulus(bulk), ModulusKind::Longitudinal) => {
                compressibility::young_of_shear(own, bulk.complex_modulus(omega))
            }
        }
    }

    /// What a modulus of the material's own kind is multiplied by to be one of `kind`.
    fn modulus_factor(&self, kind: ModulusKind, poisson_ratio: f64) -> f64 {
        let longitudinal_over_shear = 2.0 * (1.0 + poisson_ratio);
        match (self.kind, kind) {
            (ModulusKind::Shear, ModulusKind::Longitudinal) => longitudinal_over_shear,
            (ModulusKind::Longitudinal, ModulusKind::Shear) => 1.0 / longitudinal_over_shear,
            _ => 1.0,
        }
    }
}
