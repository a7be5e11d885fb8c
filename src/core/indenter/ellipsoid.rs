//! The ellipsoid by its principal radii of curvature, in small-slope form: g = x^2 / (2 Rx) + y^2 / (2 Ry).

use super::radius_under_approach_m;
use super::{Axisymmetric, Domain, Indenter, IndenterError, LENGTH, Setting, in_range};
use crate::block;
use crate::quantity::block::Block as _;

block! {
    /// An elliptic paraboloid.
    #[derive(Copy)]
    pub struct Ellipsoid in "ellipsoid" sealed {
        /// Principal radius of curvature along x.
        radius_x_m: f64 => "radius_x", LENGTH;
        /// Principal radius of curvature along y.
        radius_y_m: f64 => "radius_y", LENGTH;
    }
}

impl Ellipsoid {
    /// An ellipsoid with these principal radii of curvature (m) at its lowest point; its elastic contact is an ellipse (Hertz).
    ///
    /// Two crossed cylinders of radii R1 and R2, one of them along x and the other along y, have the same gap.
    ///
    /// # Errors
    /// [`IndenterError::Length`] where one of them is not positive and finite.
    pub fn new(radius_x_m: f64, radius_y_m: f64) -> Result<Self, IndenterError> {
        in_range(Self {
            radius_x_m,
            radius_y_m,
        })
    }

    /// Principal radii of curvature along x and y (m).
    pub fn radii_m(&self) -> (f64, f64) {
        (self.radius_x_m, self.radius_y_m)
    }

    /// Semi-axes of the elastic contact along x and y (m), to 3 %.
    ///
    /// a^3 = 3 k^2 E W R C / pi with 1/R = 1/Rx + 1/Ry, and for the axis ratio k and the elliptic integral E the
    /// approximations k = r^(2/pi), E = 1 + (pi/2 - 1)/r of B. J. Hamrock and D. Brewe, J. Lubr. Technol. 105 (1983) 171,
    /// r being the larger radius over the smaller.
    fn elastic_semi_axes_m(&self, load_n: f64, compliance_per_pa: f64) -> (f64, f64) {
        use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};
        let (rx, ry) = self.radii_m();
        let ratio = rx.max(ry) / rx.min(ry);
        let axis_ratio = ratio.powf(FRAC_2_PI);
        let integral = 1.0 + (FRAC_PI_2 - 1.0) / ratio;
        let radius_m = (rx.recip() + ry.recip()).recip();
        let scale = load_n * compliance_per_pa * radius_m;
        let long_m = (3.0 / PI * axis_ratio * axis_ratio * integral * scale).cbrt();
        let short_m = long_m / axis_ratio;
        if rx >= ry {
            (long_m, short_m)
        } else {
            (short_m, long_m)
        }
    }
}

impl Indenter for Ellipsoid {
    fn shape(&self) -> &'static str {
        Self::NAME
    }

    fn parameters(&self) -> Vec<Setting> {
        self.settings().collect()
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        x_m * x_m / (2.0 * self.radius_x_m) + y_m * y_m / (2.0 * self.radius_y_m)
    }

    /// With equal radii it is a body of revolution.
    fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
        (self.radius_x_m == self.radius_y_m).then_some(self as _)
    }

    fn not_axisymmetric_because(&self) -> String {
        "has two different radii and is not a body of revolution".to_owned()
    }

    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
        let (x_m, y_m) = self.elastic_semi_axes_m(load_n, compliance_per_pa);
        x_m.max(y_m)
    }

    /// The ellipse under this approach, to 5 %: its pressure p sqrt(1 - x^2/a^2 - y^2/b^2) on a half-space of compliance C
    /// makes an approach C p b K and a curvature 1/R = 2 C p b (K - E) / (e a)^2 along the longer semi-axis a, e^2 = 1 - (b/a)^2
    /// (K. L. Johnson, Contact Mechanics, 1985, section 4.2), with K = pi/2 + (pi/2 - 1) ln r as in
    /// `Ellipsoid::elastic_semi_axes_m`.
    fn half_widths_under_approach_m(&self, approach_m: f64) -> (f64, f64) {
        use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};
        if let Some(sphere) = self.axisymmetric() {
            let radius_m = radius_under_approach_m(sphere, approach_m);
            return (radius_m, radius_m);
        }
        let (rx, ry) = self.radii_m();
        let ratio = rx.max(ry) / rx.min(ry);
        let axis_ratio = ratio.powf(FRAC_2_PI);
        let second = 1.0 + (FRAC_PI_2 - 1.0) / ratio;
        let first = FRAC_PI_2 + (FRAC_PI_2 - 1.0) * ratio.ln();
        let eccentricity_squared = 1.0 - axis_ratio.powi(-2);
        let share = (first - second) / (eccentricity_squared * first);
        let long_m = (2.0 * rx.max(ry) * approach_m.max(0.0) * share).sqrt();
        match rx >= ry {
            true => (long_m, long_m / axis_ratio),
            false => (long_m / axis_ratio, long_m),
        }
    }

    /// A rectangle with the axis ratio of the contact, and cells likewise: both semi-axes get as many of them.
    fn domain(&self, load_n: f64, compliance_per_pa: f64) -> Domain {
        let (x_m, y_m) = self.elastic_semi_axes_m(load_n, compliance_per_pa);
        Domain::Around {
            half_widths_m: (x_m, y_m),
            cell_aspect_ratio: x_m / y_m,
            limit_m: None,
        }
    }
}

/// Of equal radii, as a sphere.
impl Axisymmetric for Ellipsoid {
    fn transformed_gap_m(&self, x_m: f64) -> f64 {
        x_m * x_m / self.radius_x_m
    }

    fn has_bounded_pressure(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::Sphere;
    use super::*;

    #[test]
    fn equal_radii_make_a_sphere_and_its_axisymmetric_body() {
        let (ellipsoid, sphere) = (
            Ellipsoid::new(0.02, 0.02).unwrap(),
            Sphere::new(0.02).unwrap(),
        );
        // Two squares over 2R added, or their sum over 2R: one rounding.
        let difference = ellipsoid.gap_m(3e-4, 1e-4) - sphere.gap_m(3e-4, 1e-4);
        assert!(difference.abs() < 1e-15 * sphere.gap_m(3e-4, 1e-4));
        let body = ellipsoid.axisymmetric().unwrap();
        assert_eq!(body.transformed_gap_m(1e-4), sphere.transformed_gap_m(1e-4));
        let (own, its) = (
            ellipsoid.elastic_half_width_m(10.0, 4e-10),
            sphere.elastic_half_width_m(10.0, 4e-10),
        );
        assert!((own / its - 1.0).abs() < 1e-14);
        assert!(Ellipsoid::new(0.02, 0.01).unwrap().axisymmetric().is_none());
    }

    #[test]
    fn exchanging_the_radii_exchanges_the_axes() {
        let (one, other) = (
            Ellipsoid::new(0.02, 0.005).unwrap(),
            Ellipsoid::new(0.005, 0.02).unwrap(),
        );
        assert_eq!(one.gap_m(1e-4, 3e-4), other.gap_m(3e-4, 1e-4));
        let (x_m, y_m) = one.elastic_semi_axes_m(3.0, 4e-10);
        assert_eq!(other.elastic_semi_axes_m(3.0, 4e-10), (y_m, x_m));
        assert!(x_m > y_m);
    }

    #[test]
    fn a_radius_that_is_no_length_is_refused_by_its_name() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let refused = Ellipsoid::new(1.0, bad).unwrap_err().to_string();
            assert!(refused.contains("radius_y"), "{refused}");
            assert!(Ellipsoid::new(bad, 1.0).is_err());
        }
    }
}
