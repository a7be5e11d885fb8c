//! The `[adhesion]` of a plan: attraction outside the contact, by the theory of Derjaguin, Muller and Toporov.
//!
//! The contact is that of Hertz under the load and the attraction together, W + 2 pi w R with the work of adhesion w, so that the load
//! may be a pull down to -2 pi w R, at which the sphere comes off (B. V. Derjaguin, V. M. Muller, Yu. P. Toporov, J. Colloid Interface
//! Sci. 53 (1975) 314; D. Maugis, *Contact, Adhesion and Rupture of Elastic Solids*, Springer 2000). The attraction does not depend on
//! the approach and dissipates nothing. That holds for small, stiff spheres: Tabor's parameter,
//!
//! ```text
//! mu = (R w^2 / (E*^2 z0^3))^(1/3)        (D. Tabor, J. Colloid Interface Sci. 58 (1977) 2)
//! ```
//!
//! with the distance z0 of the surfaces at equilibrium, must be well below 1. From about 5 on the theory of Johnson, Kendall and Roberts
//! holds, which is not solved here (K. L. Johnson, J. A. Greenwood, J. Colloid Interface Sci. 192 (1997) 326).

use std::f64::consts::TAU;

use crate::block;
use crate::indenter::Indenter;
use crate::quantity::Dimension;
use crate::quantity::key::{Kind, quantity};

block! {
    /// Adhesion of a sphere under a prescribed load, by the theory of Derjaguin, Muller and Toporov.
    #[derive(Copy)]
    pub struct AdhesionPlan in "adhesion" {
        /// Work of adhesion: energy to separate a unit area.
        work_j_per_m2: f64 => "work", Kind::Number(quantity(Dimension::EnergyPerArea).above_zero());
        /// Equilibrium distance of the surfaces, used in the Tabor parameter.
        equilibrium_distance_m: f64 = AdhesionPlan::EQUILIBRIUM_DISTANCE_M =>
            "equilibrium_distance", Kind::Number(quantity(Dimension::Length).above_zero());
    }
}

impl AdhesionPlan {
    /// z0 where nothing is said: the spacing that goes with surface energies of most condensed bodies (J. N. Israelachvili,
    /// *Intermolecular and Surface Forces*, 3rd ed. 2011, section 13.9).
    pub const EQUILIBRIUM_DISTANCE_M: f64 = 0.165e-9;

    /// 2 pi w R (N) of a sphere; `None` of another shape.
    pub fn pull_off_n(&self, indenter: &dyn Indenter) -> Option<f64> {
        Some(TAU * self.work_j_per_m2 * indenter.tip_radius_m()?)
    }

    /// Tabor's parameter of a contact of this pull-off load (N) and contact modulus (Pa).
    pub fn tabor_parameter(&self, pull_off_n: f64, contact_modulus_pa: f64) -> f64 {
        let radius_m = pull_off_n / (TAU * self.work_j_per_m2);
        let ratio = self.work_j_per_m2 / contact_modulus_pa;
        (radius_m * ratio * ratio / self.equilibrium_distance_m.powi(3)).cbrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indenter::{Cone, Sphere};

    #[test]
    fn a_small_hard_sphere_and_a_large_soft_one_lie_at_the_two_ends_of_tabors_parameter() {
        let adhesion = AdhesionPlan {
            work_j_per_m2: 0.05,
            equilibrium_distance_m: AdhesionPlan::EQUILIBRIUM_DISTANCE_M,
        };
        let of = |radius_m, modulus_pa| {
            let sphere = Sphere::new(radius_m).unwrap();
            let pull_off_n = adhesion.pull_off_n(&sphere).unwrap();
            assert!((pull_off_n / (TAU * 0.05 * radius_m) - 1.0).abs() < 1e-15);
            adhesion.tabor_parameter(pull_off_n, modulus_pa)
        };
        // A tip of 10 nm on glass, and a ball of 1 cm on rubber.
        let (tip, ball) = (of(1e-8, 7e10), of(1e-2, 1e6));
        assert!(
            (tip / (1e-8 * (0.05_f64 / 7e10).powi(2) / 0.165e-9_f64.powi(3)).cbrt() - 1.0).abs()
                < 1e-14
        );
        assert!(tip < 0.2 && ball > 1000.0, "{tip} {ball}");
        assert_eq!(adhesion.pull_off_n(&Cone::new(1.2).unwrap()), None);
    }
}
