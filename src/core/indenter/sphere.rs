//! The sphere, in the small-slope (paraboloid) form on which Hertz contact rests: g = r^2 / (2 R).

use super::{Axisymmetric, Indenter, IndenterError, LENGTH, Setting, in_range};
use crate::block;
use crate::quantity::block::Block as _;

block! {
    /// A sphere, as the paraboloid of its radius.
    #[derive(Copy)]
    pub struct Sphere in "sphere" sealed {
        /// Radius.
        radius_m: f64 => "radius", LENGTH;
    }
}

impl Sphere {
    /// A sphere of this radius (m).
    pub fn new(radius_m: f64) -> Result<Self, IndenterError> {
        in_range(Self { radius_m })
    }

    /// Radius R (m).
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }
}

impl Indenter for Sphere {
    fn shape(&self) -> &'static str {
        Self::NAME
    }

    fn parameters(&self) -> Vec<Setting> {
        self.settings().collect()
    }

    fn tip_radius_m(&self) -> Option<f64> {
        Some(self.radius_m)
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        (x_m * x_m + y_m * y_m) / (2.0 * self.radius_m)
    }

    fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
        Some(self)
    }

    /// Hertz: a^3 = (3/4) W R C.
    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
        (0.75 * load_n * self.radius_m * compliance_per_pa).cbrt()
    }
}

impl Axisymmetric for Sphere {
    /// G(x) = x^2 / R.
    fn transformed_gap_m(&self, x_m: f64) -> f64 {
        x_m * x_m / self.radius_m
    }

    fn has_bounded_pressure(&self) -> bool {
        true
    }
}
