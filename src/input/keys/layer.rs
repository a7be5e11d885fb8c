//! Keys of `[layer]`: the body is a layer on a base.

use super::material::POISSON_RATIO_VALUE;
use super::rows;
use crate::contact::half_space::layer::{Base, YieldingBase};
use crate::input::document::kind::{Choice, Scalar, number, quantity};
use crate::input::document::limits::Limits;
use crate::input::document::row::{Optional, Or, Required, Row, Rows};
use crate::quantity::Dimension::Length;

const BASES: [(&str, Base); 2] = [
    (Base::Bonded.name(), Base::Bonded),
    (Base::Frictionless.name(), Base::Frictionless),
];

const MODULUS_RATIO: Scalar = number("4.0")
    .within(Limits::between(YieldingBase::SOFTEST, YieldingBase::STIFFEST))
    .or_else("leave out base_modulus_ratio and base_poisson_ratio where the base is rigid beside the layer");

rows! { LAYER_KEYS:
    /// Thickness of the layer.
    THICKNESS: Row<Scalar, Required> = "thickness", quantity(Length).above_zero(), Required;
    /// Interface to the base: `bonded`, or `frictionless`, sliding along a rigid base without separating.
    BASE: Row<Choice<Base>, Or<Base>> = "base", Choice(&BASES), Or(Base::Bonded);
    /// Shear modulus of a deformable base over that of the layer, constant in time: base and layer relax in proportion. Left out: the
    /// base is rigid.
    BASE_MODULUS_RATIO: Row<Scalar, Optional> = "base_modulus_ratio", MODULUS_RATIO, Optional;
    /// Poisson ratio of a deformable base.
    BASE_POISSON_RATIO: Row<Scalar, Optional> = "base_poisson_ratio", POISSON_RATIO_VALUE, Optional;
}

pub(super) static LAYER: Rows = super::table(
    " The body is a laterally infinite layer of the material on a base instead of a half-space. Half-space engine only.",
    LAYER_KEYS,
);
