//! How a material changes its volume: with a Poisson ratio that does not depend on time, or with a bulk modulus that does not.
//!
//! With a constant bulk modulus K everything follows from the shear modulus G, each as a transform times s:
//!
//! ```text
//! 1/E = 1/(3G) + 1/(9K)        nu = (3K - 2G)/(2(3K + G)) = -1 + (9K/2)/(3K + G)
//! C = (1 - nu)/(2G) = 1/(4G) + (3/4)/(3K + G)
//! ```
//!
//! (N. W. Tschoegl, W. G. Knauss, I. Emri, *Poisson's ratio in linear viscoelasticity - a critical review*, Mech. Time-Depend. Mater. 6
//! (2002) 3.) 3K + G is a Prony series where G is, so that its reciprocal is a creep function, exactly: nothing is fitted.

use num_complex::Complex;

use super::creep::Creep;
use super::error::{MaterialError, positive};
use super::relaxation::Relaxation;

/// What of the change of volume does not depend on time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Compressibility {
    PoissonRatio(f64),
    BulkModulusPa(f64),
}

impl From<f64> for Compressibility {
    /// A Poisson ratio.
    fn from(poisson_ratio: f64) -> Self {
        Self::PoissonRatio(poisson_ratio)
    }
}

impl Compressibility {
    /// The Poisson ratio, where it is constant.
    pub fn poisson_ratio(self) -> Option<f64> {
        match self {
            Self::PoissonRatio(nu) => Some(nu),
            Self::BulkModulusPa(_) => None,
        }
    }

    /// The bulk modulus (Pa), where it is constant.
    pub fn bulk_modulus_pa(self) -> Option<f64> {
        match self {
            Self::PoissonRatio(_) => None,
            Self::BulkModulusPa(bulk_pa) => Some(bulk_pa),
        }
    }

    /// The same, where it leaves both the shear and the bulk modulus positive.
    pub(super) fn checked(self) -> Result<Self, MaterialError> {
        match self {
            Self::PoissonRatio(nu) if nu > -1.0 && nu <= 0.5 => Ok(self),
            Self::PoissonRatio(nu) => Err(MaterialError::Parameter {
                parameter: "Poisson ratio".to_owned(),
                value: nu,
                requirement: "greater than -1 and at most 0.5",
            }),
            Self::BulkModulusPa(bulk_pa) => {
                positive("bulk modulus (Pa)", bulk_pa).map(Self::BulkModulusPa)
            }
        }
    }
}

/// The shear creep compliance J = 3D - 1/(3K) of a uniaxial one.
///
/// # Errors
/// A bulk modulus so small that the body would be stiffer in tension than its volume allows, E(0) >= 9K.
pub(super) fn shear_of_longitudinal(creep: &Creep, bulk_pa: f64) -> Result<Creep, MaterialError> {
    let shear = creep.scaled(3.0)?;
    let instantaneous = shear.instantaneous_compliance() - 1.0 / (3.0 * bulk_pa);
    if instantaneous <= 0.0 && !creep.is_instantaneously_rigid() {
        return Err(MaterialError::SmallBulkModulus {
            bulk_pa,
            least_pa: 1.0 / (9.0 * creep.instantaneous_compliance()),
        });
    }
    shear.with_instantaneous(instantaneous.max(0.0))
}

/// The uniaxial creep compliance D = J/3 + 1/(9K) of a shear compliance.
pub(super) fn longitudinal_of_shear(creep: &Creep, bulk_pa: f64) -> Result<Creep, MaterialError> {
    let third = creep.scaled(1.0 / 3.0)?;
    third.with_instantaneous(third.instantaneous_compliance() + 1.0 / (9.0 * bulk_pa))
}

/// 1/(3K + G), a creep function.
pub(super) fn under_lateral_constraint(
    shear: &Relaxation,
    bulk_pa: f64,
) -> Result<Creep, MaterialError> {
    let equilibrium = shear.equilibrium_modulus() + 3.0 * bulk_pa;
    Relaxation::new(equilibrium, shear.branches().to_vec())?.to_creep()
}

/// Young's modulus E* (Pa) of a shear modulus G*.
pub(super) fn young_of_shear(shear_pa: Complex<f64>, bulk_pa: f64) -> Complex<f64> {
    9.0 * bulk_pa * shear_pa / (3.0 * bulk_pa + shear_pa)
}

/// 1/C* (Pa) of a shear modulus G*.
pub(super) fn contact_of_shear(shear_pa: Complex<f64>, bulk_pa: f64) -> Complex<f64> {
    let compliance = (4.0 * shear_pa).inv() + 0.75 * (3.0 * bulk_pa + shear_pa).inv();
    compliance.inv()
}

/// The shear modulus G* (Pa) of M = 1/C*: the root of 4 G^2 + (12 K - 4 M) G - 3 K M = 0 that is a modulus, written so that nothing
/// cancels, be K large or small.
pub(super) fn shear_of_contact(contact_pa: Complex<f64>, bulk_pa: f64) -> Complex<f64> {
    let excess = 3.0 * bulk_pa - contact_pa;
    let root = (excess * excess + 3.0 * bulk_pa * contact_pa).sqrt();
    let (sum, difference) = (root + excess, root - excess);
    match sum.norm() > difference.norm() {
        true => 1.5 * bulk_pa * contact_pa / sum,
        false => 0.5 * difference,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shear_modulus_comes_back_from_the_contact_modulus() {
        for bulk_pa in [1e6, 1e9, 1e12, 1e25] {
            for shear_pa in [
                Complex::new(1e6, 0.0),
                Complex::new(3e8, 2e8),
                Complex::new(1e3, 9e9),
            ] {
                let back = shear_of_contact(contact_of_shear(shear_pa, bulk_pa), bulk_pa);
                // The contact modulus of a body without shear stiffness is that of nu = 1/2, and of a very compressible one tells of
                // G by a factor of four: a handful of roundings.
                assert!(
                    (back / shear_pa - 1.0).norm() < 1e-14,
                    "{bulk_pa:e} {shear_pa}"
                );
            }
        }
    }
}
