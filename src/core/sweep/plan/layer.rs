//! The `[layer]` of a plan: the body is a layer on a base in place of a half-space.
//!
//! Base and layer relax in proportion, or the base does not yield at all, and Poisson ratios are constant: space and time separate as
//! on the half-space, and everything but the influence of a load on its surroundings stays as it is.

use crate::contact::half_space::layer::{Base, Layer, YieldingBase};
use crate::engine::EngineError;
use crate::quantity::setting::{Table, Value};
use crate::quantity::{Dimension, format_human};
use crate::sweep::plan::check::{PlanError, check_positive};

/// A layer of the plan's material on a base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerPlan {
    /// m.
    pub thickness_m: f64,
    pub base: Base,
    /// What the base is made of, where it is not rigid.
    pub yielding: Option<YieldingBase>,
}

impl LayerPlan {
    /// With the Poisson ratio of the material it is made of.
    pub fn made_of(self, poisson_ratio: f64) -> Layer {
        Layer {
            thickness_m: self.thickness_m,
            base: self.base,
            yielding: self.yielding,
            poisson_ratio,
        }
    }

    /// The layer that a body of this Poisson ratio is, where it is one.
    ///
    /// # Errors
    /// [`EngineError`] for a body without a constant Poisson ratio.
    pub(crate) fn for_body(
        plan: Option<Self>,
        poisson_ratio: Option<f64>,
    ) -> Result<Option<Layer>, EngineError> {
        let Some(plan) = plan else {
            return Ok(None);
        };
        let poisson_ratio = poisson_ratio.ok_or(EngineError::LayerOfBulkModulus)?;
        Ok(Some(plan.made_of(poisson_ratio)))
    }

    /// The `[layer]` block.
    pub(crate) fn table(&self) -> Table {
        let Self {
            thickness_m,
            base,
            yielding,
        } = *self;
        Table::new("layer")
            .with("thickness", Value::Quantity(thickness_m, Dimension::Length))
            .with("base", base.name())
            .with_some(
                "base_modulus_ratio",
                yielding.map(|base| base.modulus_ratio),
            )
            .with_some(
                "base_poisson_ratio",
                yielding.map(|base| base.poisson_ratio),
            )
    }

    /// How it lies, in words, without a modulus of the base that an axis varies.
    pub fn lies(&self, is_varied: impl Fn(&str) -> bool) -> String {
        match (self.yielding, self.base) {
            (Some(_), _) if is_varied("base_modulus_ratio") => {
                "bonded to a base that yields".to_owned()
            }
            (Some(base), _) => {
                format!(
                    "bonded to a base of {} times its shear modulus",
                    base.modulus_ratio
                )
            }
            (None, Base::Bonded) => "bonded to a rigid base".to_owned(),
            (None, Base::Frictionless) => "on a rigid base without friction".to_owned(),
        }
    }

    /// In words, to follow a material, without what axes vary: `in a layer of 100 um bonded to a rigid base`.
    pub fn words(&self, is_varied: impl Fn(&str) -> bool) -> String {
        let of_thickness = match is_varied("thickness") {
            true => String::new(),
            false => format!(
                "of {} ",
                format_human(self.thickness_m, Dimension::Length, 4)
            ),
        };
        format!("in a layer {of_thickness}{}", self.lies(is_varied))
    }

    pub(crate) fn check(&self) -> Result<(), PlanError> {
        check_positive("layer's thickness", self.thickness_m, "m")?;
        let Some(base) = self.yielding else {
            return Ok(());
        };
        let is_known =
            (YieldingBase::SOFTEST..=YieldingBase::STIFFEST).contains(&base.modulus_ratio);
        match is_known && base.poisson_ratio > -1.0 && base.poisson_ratio <= 0.5 {
            true if self.base == Base::Bonded => Ok(()),
            _ => Err(PlanError::Base),
        }
    }
}
