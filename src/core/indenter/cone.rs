//! The cone of half angle alpha, measured between its axis and its side: g = r cot(alpha).

use super::{Axisymmetric, Indenter, IndenterError, Setting, Value};
use crate::quantity::Dimension;

/// A rigid cone. Small slopes: the linear theory asks for a half angle near 90 degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    half_angle_rad: f64,
    slope: f64,
}

impl Cone {
    /// A cone of this half angle (rad), between 0 and pi/2.
    pub fn new(half_angle_rad: f64) -> Result<Self, IndenterError> {
        let slope = half_angle_rad.tan().recip();
        if half_angle_rad > 0.0 && half_angle_rad < std::f64::consts::FRAC_PI_2 && slope > 0.0 {
            Ok(Self {
                half_angle_rad,
                slope,
            })
        } else {
            Err(IndenterError::HalfAngle { half_angle_rad })
        }
    }
}

impl Indenter for Cone {
    fn shape(&self) -> &'static str {
        "cone"
    }

    fn parameters(&self) -> Vec<Setting> {
        let angle = Value::Quantity(self.half_angle_rad, Dimension::Angle);
        vec![Setting::new("half_angle", angle)]
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        x_m.hypot(y_m) * self.slope
    }

    fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
        Some(self)
    }

    /// Love and Sneddon: W = (pi/2) a^2 cot(alpha) / C.
    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
        (2.0 * load_n * compliance_per_pa / (std::f64::consts::PI * self.slope)).sqrt()
    }
}

impl Axisymmetric for Cone {
    /// G(x) = (pi/2) x cot(alpha).
    fn transformed_gap_m(&self, x_m: f64) -> f64 {
        std::f64::consts::FRAC_PI_2 * x_m * self.slope
    }

    /// The apex makes the pressure grow like the logarithm of 1/r.
    fn has_bounded_pressure(&self) -> bool {
        false
    }
}
