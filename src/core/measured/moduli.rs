//! From a loop to a modulus: the radius of the contact, and the formula of small amplitudes
//! E*/(1 - nu^2) = W_1 exp(i phi) / (2 a_0 delta_1) (G. Huang, B. Wang, H. Lu, Mech. Time-Depend. Mater. 8, 2004, 345).

use std::sync::Arc;

use num_complex::Complex;

use crate::cycle::Harmonics;
use crate::indenter::{Axisymmetric, Indenter};
use crate::material::Material;
use crate::numerics::roots::{ALL_DIGITS, bisect};

/// Where the contact radius comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum Radius {
    /// The shape, at the mean approach: G(a_0) = delta_0 of the method of dimensionality reduction, sqrt(R delta_0) of a sphere.
    Geometry,
    /// A column of the record, its mean.
    Column,
    /// A(h_c) = C_0 h_c^2 + C_1 h_c + C_2 h_c^(1/2) + C_3 h_c^(1/4) + ..., in SI units, at the contact depth h_c = delta_0 - epsilon
    /// W_0/S (W. C. Oliver and G. M. Pharr, J. Mater. Res. 7, 1992, 1564), S being the storage stiffness.
    AreaFunction {
        coefficients: Vec<f64>,
        epsilon: f64,
    },
}

/// What is needed to read a modulus from a loop.
#[derive(Debug, Clone)]
pub struct Contact {
    pub poisson_ratio: f64,
    pub radius: Radius,
    /// The shape, where it is known: the geometry needs it, and the exact model.
    pub indenter: Option<Arc<dyn Indenter>>,
    /// What the indenter is made of; `None` for a rigid one.
    pub indenter_material: Option<Material>,
    /// Whether the bias of the formula is computed and taken out.
    pub bias: bool,
}

impl Contact {
    /// The modulus (Pa) that the formula reads from a cycle with this contact radius (m), without what the indenter yields.
    pub(super) fn modulus_pa(
        &self,
        cycle: &Harmonics,
        radius_m: f64,
        angular_rad_per_s: f64,
    ) -> Option<Complex<f64>> {
        let stiffness = cycle.load_n.first()? / cycle.approach_m.first()?;
        let lateral = (1.0 - self.poisson_ratio) * (1.0 + self.poisson_ratio);
        let read = stiffness * lateral / (2.0 * radius_m);
        Some(match &self.indenter_material {
            Some(indenter) => indenter.as_indenter_taken_off(read, lateral, angular_rad_per_s),
            None => read,
        })
    }

    /// The contact radius (m) of a cycle, of which the record's column of radii has this mean.
    ///
    /// # Errors
    /// Why there is none, as a part of a sentence.
    pub fn radius_m(&self, cycle: &Harmonics, column_m: Option<f64>) -> Result<f64, String> {
        let radius_m = match &self.radius {
            Radius::Column => column_m.ok_or("the record has no column `contact_radius`")?,
            Radius::Geometry => {
                let body = self.indenter.as_ref().and_then(|i| i.axisymmetric());
                let body = body.ok_or("the shape is no convex body of revolution")?;
                radius_of_geometry(body, cycle.approach_mean_m)
                    .ok_or("the mean approach is not above zero: is it counted from first touch?")?
            }
            Radius::AreaFunction {
                coefficients,
                epsilon,
            } => area_radius(cycle, coefficients, *epsilon)
                .ok_or("the area function gives no area at the contact depth")?,
        };
        match radius_m.is_finite() && radius_m > 0.0 {
            true => Ok(radius_m),
            false => Err(format!("it comes out as {radius_m} m")),
        }
    }
}

/// The radius (m) up to which a body touches at this approach, as far as it touches on the way in.
pub fn radius_of_geometry(body: &dyn Axisymmetric, approach_m: f64) -> Option<f64> {
    if !(approach_m.is_finite() && approach_m > 0.0) {
        return None;
    }
    let reaches = |radius_m: f64| body.transformed_gap_m(radius_m) >= approach_m;
    let limit_m = body.contact_limit_m();
    if let Some(limit_m) = limit_m.filter(|limit_m| !reaches(*limit_m)) {
        return Some(limit_m);
    }
    // Any length will do to start from.
    let lengths = std::iter::successors(limit_m.or(Some(approach_m)), |length_m| {
        Some(2.0 * length_m)
    });
    let high_m = lengths
        .take_while(|length_m| length_m.is_finite())
        .find(|length_m| reaches(*length_m))?;
    Some(bisect(0.0, high_m, ALL_DIGITS, |radius_m| !reaches(radius_m)).1)
}

fn area_radius(cycle: &Harmonics, coefficients: &[f64], epsilon: f64) -> Option<f64> {
    let (load, approach) = (cycle.load_n.first()?, cycle.approach_m.first()?);
    let stiffness = (load / approach).re;
    let depth_m = cycle.approach_mean_m - epsilon * cycle.load_mean_n / stiffness;
    if depth_m.is_nan() || depth_m <= 0.0 {
        return None;
    }
    let power = |k: usize| match k {
        0 => 2.0,
        k => 0.5_f64.powi(k as i32 - 1),
    };
    let terms = coefficients.iter().enumerate();
    let area: f64 = terms.map(|(k, c)| c * depth_m.powf(power(k))).sum();
    (area > 0.0).then(|| (area / std::f64::consts::PI).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indenter::{Cone, FlatPunch, Sphere};

    fn cycle(approach_mean_m: f64) -> Harmonics {
        Harmonics {
            load_mean_n: 2e-3,
            approach_mean_m,
            load_n: vec![Complex::new(1e-4, 0.0)],
            approach_m: vec![Complex::new(1e-9, 0.0)],
        }
    }

    #[test]
    fn the_radius_of_a_shape_is_that_of_its_closed_form() {
        let sphere = Sphere::new(1e-3).unwrap();
        let found = radius_of_geometry(sphere.axisymmetric().unwrap(), 1e-6).unwrap();
        assert!((found / (1e-9_f64).sqrt() - 1.0).abs() < 1e-14);
        let cone = Cone::new(1.2).unwrap();
        let found = radius_of_geometry(cone.axisymmetric().unwrap(), 1e-6).unwrap();
        let expected = 1e-6 * 1.2_f64.tan() * 2.0 / std::f64::consts::PI;
        assert!((found / expected - 1.0).abs() < 1e-13);
        let punch = FlatPunch::new(2e-3).unwrap();
        assert_eq!(
            radius_of_geometry(punch.axisymmetric().unwrap(), 1e-6),
            Some(2e-3)
        );
        assert_eq!(
            radius_of_geometry(sphere.axisymmetric().unwrap(), -1e-6),
            None
        );
    }

    #[test]
    fn an_area_function_is_taken_at_the_contact_depth() {
        let contact = Contact {
            poisson_ratio: 0.3,
            radius: Radius::AreaFunction {
                coefficients: vec![24.5, 1e-7],
                epsilon: 0.75,
            },
            indenter: None,
            indenter_material: None,
            bias: false,
        };
        // Stiffness 1e5 N/m: 15 nm of 500 are elastic.
        let found = contact.radius_m(&cycle(5e-7), None).unwrap();
        let depth = 5e-7 - 0.75 * 2e-3 / 1e5;
        let area: f64 = 24.5 * depth * depth + 1e-7 * depth;
        assert!((found / (area / std::f64::consts::PI).sqrt() - 1.0).abs() < 1e-14);
        assert!(contact.radius_m(&cycle(1e-9), None).is_err());
    }
}
