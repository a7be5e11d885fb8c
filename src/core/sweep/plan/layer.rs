//! The `[layer]` of a plan: the body is a layer on a base in place of a half-space.
//!
//! Base and layer relax in proportion, or the base does not yield at all, and Poisson ratios are constant: space and time separate as
//! on the half-space, and everything but the influence of a load on its surroundings stays as it is.

use crate::block;
use crate::contact::half_space::layer::{Base, Layer, YieldingBase};
use crate::engine::EngineError;
use crate::quantity::block::Conflict;
use crate::quantity::key::{Kind, Limits, POISSON_RATIO, number, quantity};
use crate::quantity::{Dimension, format_human};

block! {
    /// The body is a laterally infinite layer of the material on a base instead of a half-space. Half-space engine only.
    #[derive(Copy)]
    pub struct LayerPlan in "layer" unless in_conflict {
        /// Thickness of the layer.
        thickness_m: f64 => "thickness", Kind::Number(quantity(Dimension::Length).above_zero());
        /// Interface to the base: `bonded`, or `frictionless`, sliding along a rigid base without separating.
        base: Base = Base::Bonded => "base", Kind::Word(Base::WORDS);
        /// Shear modulus of a deformable base over that of the layer, constant in time: base and layer relax in proportion. Left out: the
        /// base is rigid.
        base_modulus_ratio: Option<f64> = None => "base_modulus_ratio", Kind::Number(
            number("4.0")
                .within(Limits::between(YieldingBase::SOFTEST, YieldingBase::STIFFEST))
                .or_else("leave out base_modulus_ratio and base_poisson_ratio where the base is rigid beside the layer")
        );
        /// Poisson ratio of a deformable base.
        base_poisson_ratio: Option<f64> = None => "base_poisson_ratio", Kind::Number(POISSON_RATIO);
    }
}

impl LayerPlan {
    /// With the Poisson ratio of the material it is made of.
    pub fn made_of(self, poisson_ratio: f64) -> Layer {
        Layer {
            thickness_m: self.thickness_m,
            base: self.base,
            yielding: self.yielding(),
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

    /// What the base is made of, where it is not rigid.
    pub fn yielding(&self) -> Option<YieldingBase> {
        Some(YieldingBase {
            modulus_ratio: self.base_modulus_ratio?,
            poisson_ratio: self.base_poisson_ratio?,
        })
    }

    fn in_conflict(&self) -> Option<Conflict> {
        let (key, what, help) = match (self.base_modulus_ratio, self.base_poisson_ratio) {
            (Some(_), Some(_)) if self.base == Base::Frictionless => (
                "base_modulus_ratio",
                "a base that yields is one that the layer is bonded to",
                "write `base = \"bonded\"`, or leave out base_modulus_ratio and base_poisson_ratio",
            ),
            (None, None) | (Some(_), Some(_)) => return None,
            (Some(_), None) => (
                "base_modulus_ratio",
                "a base that yields has a Poisson ratio too",
                "add `base_poisson_ratio = 0.4`, that of the base",
            ),
            (None, Some(_)) => (
                "base_poisson_ratio",
                "a rigid base has no Poisson ratio",
                "add `base_modulus_ratio = 4`, the shear modulus of the base over that of the layer, or leave out `base_poisson_ratio`",
            ),
        };
        Some(Conflict {
            key,
            what: what.to_owned(),
            because: None,
            help,
        })
    }

    /// How it lies, in words, without a modulus of the base that an axis varies.
    pub fn lies(&self, is_varied: impl Fn(&str) -> bool) -> String {
        match (self.yielding(), self.base) {
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
}
