//! How a material changes its volume: with a Poisson ratio that does not depend on time, or by a bulk modulus, constant or relaxing.
//!
//! With a bulk modulus K everything follows from the shear modulus G, each as a transform times s:
//!
//! ```text
//! 1/E = 1/(3G) + 1/(9K)        nu = (3K - 2G)/(2(3K + G)) = 1/2 - (3/2) G/(3K + G)
//! C = (1 - nu)/(2G) = 1/(4G) + (3/4)/(3K + G)
//! ```
//!
//! (N. W. Tschoegl, W. G. Knauss, I. Emri, *Poisson's ratio in linear viscoelasticity - a critical review*, Mech. Time-Depend. Mater. 6
//! (2002) 3.) 3K + G is a Prony series where both are, so that its reciprocal is a creep function, exactly: nothing is fitted.

use num_complex::Complex;

use super::creep::Creep;
use super::error::{MaterialError, positive, refused};
use super::relaxation::{Relaxation, RelaxationBranch};

/// What says how the volume changes.
#[derive(Debug, Clone, PartialEq)]
pub enum Compressibility {
    /// Constant in time.
    PoissonRatio(f64),
    /// A bulk modulus, of no branches where it is constant in time.
    BulkModulus(Relaxation),
}

impl From<f64> for Compressibility {
    /// A Poisson ratio.
    fn from(poisson_ratio: f64) -> Self {
        Self::PoissonRatio(poisson_ratio)
    }
}

impl Compressibility {
    /// A bulk modulus (Pa) that is constant in time.
    ///
    /// # Errors
    /// One that is not positive and finite.
    pub fn constant_bulk_modulus(bulk_pa: f64) -> Result<Self, MaterialError> {
        let bulk_pa = positive("bulk modulus (Pa)", bulk_pa)?;
        Relaxation::new(bulk_pa, Vec::new()).map(Self::BulkModulus)
    }

    /// The Poisson ratio, where it is constant.
    pub fn poisson_ratio(&self) -> Option<f64> {
        match self {
            Self::PoissonRatio(nu) => Some(*nu),
            Self::BulkModulus(_) => None,
        }
    }

    /// 1/C* (Pa) of a body of this tensile modulus (Pa) at some frequency; a bulk modulus counts at rest.
    pub(crate) fn contact_modulus(&self, tensile_pa: Complex<f64>) -> Complex<f64> {
        match self {
            Self::PoissonRatio(nu) => tensile_pa / (1.0 - nu * nu),
            Self::BulkModulus(bulk) => {
                let bulk_pa = bulk.equilibrium_modulus();
                let shear_pa = tensile_pa / (3.0 - tensile_pa / (3.0 * bulk_pa));
                (0.25 / shear_pa + 0.75 / (3.0 * bulk_pa + shear_pa)).inv()
            }
        }
    }

    /// The bulk modulus, where it is given.
    pub fn bulk_modulus(&self) -> Option<&Relaxation> {
        match self {
            Self::PoissonRatio(_) => None,
            Self::BulkModulus(bulk) => Some(bulk),
        }
    }

    /// The bulk modulus (Pa), where it is given and constant.
    pub fn constant_bulk_modulus_pa(&self) -> Option<f64> {
        let constant = |bulk: &&Relaxation| bulk.branches().is_empty();
        let bulk = self.bulk_modulus().filter(constant);
        bulk.map(Relaxation::equilibrium_modulus)
    }

    /// The same, where it leaves both the shear and the bulk modulus positive.
    pub(super) fn checked(self) -> Result<Self, MaterialError> {
        match self {
            Self::PoissonRatio(nu) if nu > -1.0 && nu <= 0.5 => Ok(self),
            Self::PoissonRatio(nu) => {
                let requirement = "greater than -1 and at most 0.5";
                Err(refused("Poisson ratio", nu, requirement))
            }
            Self::BulkModulus(bulk) => {
                positive("bulk modulus at rest (Pa)", bulk.equilibrium_modulus())?;
                Ok(Self::BulkModulus(bulk))
            }
        }
    }
}

/// The shear creep compliance J = 3D - 1/(3K) of a uniaxial one.
///
/// # Errors
/// A bulk modulus so small that the body would be stiffer in tension than its volume allows, E(0) >= 9K, or one that relaxes: the
/// difference of two creep functions need not be one.
pub(super) fn shear_of_longitudinal(
    creep: &Creep,
    bulk: &Relaxation,
) -> Result<Creep, MaterialError> {
    if !bulk.branches().is_empty() {
        return Err(MaterialError::BulkRelaxationInTension);
    }
    let bulk_pa = bulk.equilibrium_modulus();
    let shear = creep.scaled(3.0)?;
    let instantaneous = shear.instantaneous_compliance() - 1.0 / (3.0 * bulk_pa);
    if instantaneous <= 0.0 && !creep.is_instantaneously_rigid() {
        return Err(MaterialError::SmallBulkModulus {
            bulk_pa,
            least_pa: 1.0 / (9.0 * creep.instantaneous_compliance()),
        });
    }
    let branches = shear.branches().to_vec();
    Creep::new(instantaneous.max(0.0), branches, shear.viscosity_pa_s())
}

/// The uniaxial creep compliance D = J/3 + 1/(9K) of a shear compliance.
pub(super) fn longitudinal_of_shear(
    creep: &Creep,
    bulk: &Relaxation,
) -> Result<Creep, MaterialError> {
    let of_volume = bulk.to_creep()?.scaled(1.0 / 9.0)?;
    creep.scaled(1.0 / 3.0)?.beside(&of_volume)
}

/// 1/(3K + G), a creep function.
pub(super) fn under_lateral_constraint(
    shear: &Relaxation,
    bulk: &Relaxation,
) -> Result<Creep, MaterialError> {
    let equilibrium = shear.equilibrium_modulus() + 3.0 * bulk.equilibrium_modulus();
    let of_volume = bulk.branches().iter().map(|branch| RelaxationBranch {
        modulus_pa: 3.0 * branch.modulus_pa,
        ..*branch
    });
    let branches = shear.branches().iter().copied().chain(of_volume);
    Relaxation::new(equilibrium, branches.collect())?.to_creep()
}

/// The Poisson ratio at this time (s) of a relaxation test in tension, minus the lateral over the axial strain: 1/2 - (3/2) G/(3K + G).
/// The poles of the last are those of 1/(3K + G), where G = -3K.
pub(super) fn poisson_ratio_at(
    shear: &Relaxation,
    bulk: &Relaxation,
    time_s: f64,
) -> Result<f64, MaterialError> {
    let constrained = under_lateral_constraint(shear, bulk)?;
    let at_once = shear.instantaneous_modulus() * constrained.instantaneous_compliance();
    let later = constrained.branches().iter().map(|pole| {
        let transform = bulk.branches().iter().map(|branch| {
            // s tau/(1 + s tau) at s = -1/(time of the pole).
            branch.modulus_pa * branch.time_s / (branch.time_s - pole.time_s)
        });
        let bulk_pa = bulk.equilibrium_modulus() + transform.sum::<f64>();
        let risen = -(-time_s / pole.time_s).exp_m1();
        -3.0 * bulk_pa * pole.compliance_per_pa * risen
    });
    Ok(0.5 - 1.5 * (at_once + later.sum::<f64>()))
}

/// Young's modulus E* (Pa) of a shear modulus G* and a bulk modulus K*.
pub(super) fn young_of_shear(shear_pa: Complex<f64>, bulk_pa: Complex<f64>) -> Complex<f64> {
    9.0 * bulk_pa * shear_pa / (3.0 * bulk_pa + shear_pa)
}

/// 1/C* (Pa) of a shear modulus G* and a bulk modulus K*.
pub(super) fn contact_of_shear(shear_pa: Complex<f64>, bulk_pa: Complex<f64>) -> Complex<f64> {
    let compliance = (4.0 * shear_pa).inv() + 0.75 * (3.0 * bulk_pa + shear_pa).inv();
    compliance.inv()
}

/// The shear modulus G* (Pa) of M = 1/C*: the root of 4 G^2 + (12 K - 4 M) G - 3 K M = 0 that is a modulus, written so that nothing
/// cancels, be K large or small.
///
/// The product of both roots is -(3/4) K M: where one stores and dissipates, as K and M do, the other cannot.
pub(super) fn shear_of_contact(contact_pa: Complex<f64>, bulk_pa: Complex<f64>) -> Complex<f64> {
    let excess = 3.0 * bulk_pa - contact_pa;
    let root = (excess * excess + 3.0 * bulk_pa * contact_pa).sqrt();
    let of = |root: Complex<f64>| {
        let (sum, difference) = (root + excess, root - excess);
        match sum.norm() > difference.norm() {
            true => 1.5 * bulk_pa * contact_pa / sum,
            false => 0.5 * difference,
        }
    };
    let least = |g: Complex<f64>| g.re.min(g.im) / g.norm();
    let (one, other) = (of(root), of(-root));
    match least(one) >= least(other) {
        true => one,
        false => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shear_modulus_comes_back_from_the_contact_modulus() {
        let constant = [1e6, 1e9, 1e12, 1e25].map(|bulk_pa| Complex::new(bulk_pa, 0.0));
        let relaxing = [Complex::new(1e9, 1e9), Complex::new(1e7, 4e8)];
        for bulk_pa in constant.into_iter().chain(relaxing) {
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
                    "{bulk_pa} {shear_pa}"
                );
            }
        }
    }
}
