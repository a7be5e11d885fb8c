//! The cone of half angle alpha, measured between its axis and its side: g = r cot(alpha).

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Axisymmetric, Indenter, IndenterError, Setting};
use crate::block;
use crate::quantity::Dimension;
use crate::quantity::block::Block as _;
use crate::quantity::key::{Kind, quantity};

block! {
    /// A cone.
    #[derive(Copy)]
    pub struct ConeKeys in "cone" {
        /// Angle between axis and flank; 90 deg is a plane.
        half_angle_rad: f64 => "half_angle", Kind::Number(quantity(Dimension::Angle).above_zero().such_as("\"70 deg\""));
    }
}

/// A rigid cone. Small slopes: the linear theory asks for a half angle near 90 degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    keys: ConeKeys,
    /// cot(alpha), which gaps are asked for at every place and instant.
    slope: f64,
}

impl Cone {
    /// A cone of this half angle (rad), between 0 and pi/2.
    pub fn new(half_angle_rad: f64) -> Result<Self, IndenterError> {
        Self::of(ConeKeys { half_angle_rad })
    }

    /// The same of its keys.
    pub fn of(keys: ConeKeys) -> Result<Self, IndenterError> {
        let half_angle_rad = keys.half_angle_rad;
        let slope = half_angle_rad.tan().recip();
        match half_angle_rad > 0.0 && half_angle_rad < FRAC_PI_2 && slope > 0.0 {
            true => Ok(Self { keys, slope }),
            false => Err(IndenterError::HalfAngle { half_angle_rad }),
        }
    }
}

impl Indenter for Cone {
    fn shape(&self) -> &'static str {
        ConeKeys::NAME
    }

    fn parameters(&self) -> Vec<Setting> {
        self.keys.settings().collect()
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        x_m.hypot(y_m) * self.slope
    }

    fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
        Some(self)
    }

    /// Love and Sneddon: W = (pi/2) a^2 cot(alpha) / C.
    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
        (2.0 * load_n * compliance_per_pa / (PI * self.slope)).sqrt()
    }
}

impl Axisymmetric for Cone {
    /// G(x) = (pi/2) x cot(alpha).
    fn transformed_gap_m(&self, x_m: f64) -> f64 {
        FRAC_PI_2 * x_m * self.slope
    }

    /// The apex makes the pressure grow like the logarithm of 1/r.
    fn has_bounded_pressure(&self) -> bool {
        false
    }
}
