//! The `[layer]` of a plan: the body is a layer on a rigid base in place of a half-space.
//!
//! Base and layer relax in proportion, since the base does not yield at all, and the Poisson ratio is constant: space and time
//! separate as on the half-space, and everything but the influence of a load on its surroundings stays as it is.

use crate::contact::half_space::layer::{Base, Layer};
use crate::quantity::{Dimension, format_human, format_si};
use crate::sweep::plan::check::PlanError;

/// A layer of the plan's material on a rigid base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerPlan {
    /// m.
    pub thickness_m: f64,
    pub base: Base,
}

impl LayerPlan {
    /// With the Poisson ratio of the material it is made of.
    pub fn of_material(self, poisson_ratio: f64) -> Layer {
        Layer {
            thickness_m: self.thickness_m,
            base: self.base,
            poisson_ratio,
        }
    }

    /// The `[layer]` block, with an empty line before it.
    pub(crate) fn text(&self) -> String {
        format!(
            "\n[layer]\nthickness = \"{}\"\nbase = \"{}\"\n",
            format_si(self.thickness_m, Dimension::Length),
            self.base.name()
        )
    }

    /// How it lies, in words.
    pub fn lies(&self) -> &'static str {
        match self.base {
            Base::Bonded => "bonded to a rigid base",
            Base::Frictionless => "on a rigid base without friction",
        }
    }

    /// In words, to follow a material: `in a layer of 100 um bonded to a rigid base`.
    pub fn words(&self) -> String {
        let thickness = format_human(self.thickness_m, Dimension::Length, 4);
        format!("in a layer of {thickness} {}", self.lies())
    }

    pub(in crate::sweep) fn check(&self) -> Result<(), PlanError> {
        match self.thickness_m.is_finite() && self.thickness_m > 0.0 {
            true => Ok(()),
            false => Err(PlanError::Thickness {
                thickness_m: self.thickness_m,
            }),
        }
    }
}
