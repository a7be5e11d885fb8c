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
    pub struct Cone in "cone" sealed {
        /// Angle between axis and flank; 90 deg is a plane.
        half_angle_rad: f64 => "half_angle", Kind::Number(quantity(Dimension::Angle).above_zero().such_as("\"70 deg\""));
    }
}

impl Cone {
    /// A cone of this half angle (rad), between 0 and pi/2. Small slopes: the linear theory asks for one near pi/2.
    pub fn new(half_angle_rad: f64) -> Result<Self, IndenterError> {
        Self { half_angle_rad }.checked()
    }

    /// The cone, where it is none that is refused by [`Cone::new`].
    pub fn checked(self) -> Result<Self, IndenterError> {
        let half_angle_rad = self.half_angle_rad;
        match half_angle_rad > 0.0 && half_angle_rad < FRAC_PI_2 && self.slope() > 0.0 {
            true => Ok(self),
            false => Err(IndenterError::HalfAngle { half_angle_rad }),
        }
    }

    fn slope(&self) -> f64 {
        self.half_angle_rad.tan().recip()
    }
}

impl Indenter for Cone {
    fn shape(&self) -> &'static str {
        Self::NAME
    }

    fn parameters(&self) -> Vec<Setting> {
        self.settings().collect()
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        x_m.hypot(y_m) * self.slope()
    }

    fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
        Some(self)
    }

    /// Love and Sneddon: W = (pi/2) a^2 cot(alpha) / C.
    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
        (2.0 * load_n * compliance_per_pa / (PI * self.slope())).sqrt()
    }
}

impl Axisymmetric for Cone {
    /// G(x) = (pi/2) x cot(alpha).
    fn transformed_gap_m(&self, x_m: f64) -> f64 {
        FRAC_PI_2 * x_m * self.slope()
    }

    /// The apex makes the pressure grow like the logarithm of 1/r.
    fn has_bounded_pressure(&self) -> bool {
        false
    }
}
