//! The `[adhesion]` of a plan: a constant stress within a range, by the theory of D. Maugis (J. Colloid Interface Sci. 150 (1992) 243), and
//! its two limits.
//!
//! Work of adhesion is stress times range. Tabor's parameter of a sphere,
//!
//! ```text
//! mu = (R w^2 / (E*^2 z0^3))^(1/3)        (D. Tabor, J. Colloid Interface Sci. 58 (1977) 2)
//! ```
//!
//! with the distance z0 of the surfaces at equilibrium, says how far the attraction deforms the body before the surfaces touch. A stress
//! as large as the largest of the potential of Lennard and Jones, 16 w / (9 sqrt(3) z0), has a range of 0.97 z0.
//!
//! Below about 0.1 the theory of Derjaguin, Muller and Toporov holds (J. Colloid Interface Sci. 53 (1975) 314): the contact is that of
//! Hertz under the load and a constant attraction 2 pi w R together. From about 5 on that of Johnson, Kendall and Roberts does, in
//! which the zone of attraction has no width (K. L. Johnson, J. A. Greenwood, J. Colloid Interface Sci. 192 (1997) 326).

use std::f64::consts::TAU;

use crate::adhesive::Attraction;
use crate::indenter::Indenter;
use crate::quantity::Dimension;
use crate::quantity::block::Conflict;
use crate::quantity::key::{Kind, quantity};
use crate::{block, words};

words! {
    /// What is computed of an attraction.
    pub enum AdhesionModel {
        /// The zone of attraction as it is.
        Maugis = "maugis",
        /// A constant pull on the contact of Hertz: small, stiff spheres.
        Dmt = "dmt",
        /// A zone too narrow to matter, which loses the contact of a relaxed body its width: large, soft spheres.
        Jkr = "jkr",
    }
}

block! {
    /// Surfaces that attract one another by a constant stress up to a range.
    #[derive(Copy)]
    pub struct AdhesionPlan in "adhesion" unless in_conflict {
        /// Work of adhesion: energy to separate a unit area.
        work_j_per_m2: f64 => "work", Kind::Number(quantity(Dimension::EnergyPerArea).above_zero());
        /// Gap up to which the surfaces attract one another; 0.16 nm where neither it nor `stress` is given.
        range_m: Option<f64> = None => "range", Kind::Number(quantity(Dimension::Length).above_zero());
        /// Stress by which they do, in place of the range: work over range.
        stress_pa: Option<f64> = None => "stress", Kind::Number(quantity(Dimension::Stress).above_zero());
        /// What is computed: `maugis` the attraction as it is, `dmt` and `jkr` its limits for small, stiff and for large, soft spheres.
        model: AdhesionModel = AdhesionModel::Maugis => "model", Kind::Word(AdhesionModel::WORDS);
    }
}

impl AdhesionPlan {
    /// The range where nothing is said: that of an equilibrium distance of 0.165 nm, which goes with surface energies of most condensed
    /// bodies (J. N. Israelachvili, *Intermolecular and Surface Forces*, 3rd ed. 2011, section 13.9).
    pub const RANGE_M: f64 = 0.16e-9;

    /// Tabor's parameter of the relaxed body in place of the infinite one of JKR: the pull-off load is within 0.4 %, the radius
    /// without load within 1 %.
    const JKR_TABOR_PARAMETER: f64 = 5.0;

    /// z0 of a range.
    const DISTANCE_OF_RANGE: f64 = 1.026_400;

    /// Of this work (J/m^2), range where nothing is said, and all of it computed.
    pub fn of_work(work_j_per_m2: f64) -> Self {
        Self {
            work_j_per_m2,
            range_m: None,
            stress_pa: None,
            model: AdhesionModel::Maugis,
        }
    }

    /// The gap (m) up to which the surfaces attract one another.
    pub fn range_m(&self) -> f64 {
        let of_stress = self
            .stress_pa
            .map(|stress_pa| self.work_j_per_m2 / stress_pa);
        self.range_m.or(of_stress).unwrap_or(Self::RANGE_M)
    }

    /// Logarithms of work (J/m^2) and range (m), of which as many as are sought are unknowns.
    pub(crate) fn logarithms(&self) -> [f64; 2] {
        [self.work_j_per_m2, self.range_m()].map(f64::ln)
    }

    /// The same with other values of the first of them.
    pub(crate) fn with_logarithms(self, logarithms: &[f64]) -> Self {
        let value = |place: usize| logarithms.get(place).map(|ln| ln.exp());
        Self {
            work_j_per_m2: value(0).unwrap_or(self.work_j_per_m2),
            range_m: Some(value(1).unwrap_or(self.range_m())),
            stress_pa: None,
            ..self
        }
    }

    /// Whether the attraction moves the edge of the contact; `None` in its place is a constant pull, or none.
    pub fn attraction(&self, indenter: &dyn Indenter, relaxed_per_pa: f64) -> Option<Attraction> {
        let range_m = match (self.model, indenter.tip_radius_m()) {
            (AdhesionModel::Dmt, _) => return None,
            (AdhesionModel::Jkr, Some(radius_m)) => {
                let length_m = (radius_m * (self.work_j_per_m2 * relaxed_per_pa).powi(2)).cbrt();
                length_m / (Self::JKR_TABOR_PARAMETER * Self::DISTANCE_OF_RANGE)
            }
            _ => self.range_m(),
        };
        Some(Attraction {
            stress_pa: self.work_j_per_m2 / range_m,
            range_m,
        })
    }

    /// What may pull on the indenter before it comes off (N): 2 pi w R under the constant attraction of a sphere, what comes of it
    /// where that is computed; `None` of a shape that the model does not know.
    pub fn pull_off_n(&self, indenter: &dyn Indenter) -> Option<f64> {
        match self.model {
            AdhesionModel::Dmt => Some(TAU * self.work_j_per_m2 * indenter.tip_radius_m()?),
            AdhesionModel::Jkr => indenter.tip_radius_m().map(|_| f64::INFINITY),
            AdhesionModel::Maugis => indenter.axisymmetric().map(|_| f64::INFINITY),
        }
    }

    /// Tabor's parameter of a sphere on a body of this contact modulus (Pa); `None` of another shape.
    pub fn tabor_parameter(&self, indenter: &dyn Indenter, contact_modulus_pa: f64) -> Option<f64> {
        let ratio = self.work_j_per_m2 / contact_modulus_pa;
        let distance_m = Self::DISTANCE_OF_RANGE * self.range_m();
        Some((indenter.tip_radius_m()? * ratio * ratio).cbrt() / distance_m)
    }

    fn in_conflict(&self) -> Option<Conflict> {
        self.range_m.and(self.stress_pa).map(|_| Conflict {
            key: "stress",
            what: "range and stress of an attraction follow from one another".to_owned(),
            because: Some("the work is stress times range"),
            help: "leave out `stress` or `range`",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indenter::{Cone, Sphere};
    use crate::reference::adhesive::Maugis;

    #[test]
    fn a_small_hard_sphere_and_a_large_soft_one_lie_at_the_two_ends_of_tabors_parameter() {
        let adhesion = AdhesionPlan::of_work(0.05);
        let of = |radius_m, modulus_pa| {
            let sphere = Sphere::new(radius_m).unwrap();
            adhesion.tabor_parameter(&sphere, modulus_pa).unwrap()
        };
        // A tip of 10 nm on glass, and a ball of 1 cm on rubber.
        let (tip, ball) = (of(1e-8, 7e10), of(1e-2, 1e6));
        assert!(tip < 0.2 && ball > 1000.0, "{tip} {ball}");
        // Maugis' parameter is 1.16 of it, within the digits of the number.
        let own = Maugis::of_tabor_number(tip, 1e-8, 1.0 / 7e10, 0.05);
        assert!((0.05 / own.stress_pa / AdhesionPlan::RANGE_M - 1.0).abs() < 4e-3);
        let cone = Cone::new(1.2).unwrap();
        assert_eq!(adhesion.tabor_parameter(&cone, 1e9), None);
        assert_eq!(adhesion.pull_off_n(&cone), Some(f64::INFINITY));
        let dmt = AdhesionPlan {
            model: AdhesionModel::Dmt,
            ..adhesion
        };
        assert_eq!(dmt.pull_off_n(&cone), None);
        let pull_off_n = dmt.pull_off_n(&Sphere::new(1e-6).unwrap()).unwrap();
        assert!((pull_off_n / (TAU * 0.05 * 1e-6) - 1.0).abs() < 1e-15);
    }
}
