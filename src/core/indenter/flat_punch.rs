//! The flat-ended cylindrical punch: gap 0 inside its radius, no indenter outside.

use super::{Axisymmetric, Indenter, IndenterError, LENGTH, Setting, in_range};
use crate::block;
use crate::quantity::block::Block as _;

block! {
    /// A flat cylindrical punch.
    #[derive(Copy)]
    pub struct FlatPunch in "flat-punch" sealed {
        /// Radius.
        radius_m: f64 => "radius", LENGTH;
    }
}

impl FlatPunch {
    /// A punch of this radius (m).
    pub fn new(radius_m: f64) -> Result<Self, IndenterError> {
        in_range(Self { radius_m })
    }

    /// Radius a (m).
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }
}

impl Indenter for FlatPunch {
    fn shape(&self) -> &'static str {
        Self::NAME
    }

    fn parameters(&self) -> Vec<Setting> {
        self.settings().collect()
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        if x_m.hypot(y_m) <= self.radius_m {
            0.0
        } else {
            f64::INFINITY
        }
    }

    fn axisymmetric(&self) -> Option<&dyn Axisymmetric> {
        Some(self)
    }

    /// The contact is the face of the punch whatever the load.
    fn elastic_half_width_m(&self, _load_n: f64, _compliance_per_pa: f64) -> f64 {
        self.radius_m
    }
}

impl Axisymmetric for FlatPunch {
    fn transformed_gap_m(&self, x_m: f64) -> f64 {
        if x_m <= self.radius_m {
            0.0
        } else {
            f64::INFINITY
        }
    }

    fn contact_limit_m(&self) -> Option<f64> {
        Some(self.radius_m)
    }

    /// The pressure is unbounded at the sharp edge.
    fn has_bounded_pressure(&self) -> bool {
        false
    }
}
