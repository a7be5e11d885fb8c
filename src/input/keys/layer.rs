//! Keys of `[layer]`: the body is a layer on a rigid base.

use super::rows;
use crate::contact::half_space::layer::Base;
use crate::input::document::kind::{Choice, Scalar, quantity};
use crate::input::document::row::{Or, Required, Row, Rows};
use crate::quantity::Dimension::Length;

const BASES: [(&str, Base); 2] = [
    (Base::Bonded.name(), Base::Bonded),
    (Base::Frictionless.name(), Base::Frictionless),
];

rows! { LAYER_KEYS:
    /// Thickness of the layer.
    THICKNESS: Row<Scalar, Required> = "thickness", quantity(Length).above_zero(), Required;
    /// How it lies on the rigid base: `bonded`, or `frictionless`, sliding along the base and never leaving it.
    BASE: Row<Choice<Base>, Or<Base>> = "base", Choice(&BASES), Or(Base::Bonded);
}

pub(super) static LAYER: Rows = super::table(
    " The body is a layer of the material on a rigid base, without end to all sides, in place of a half-space. Half-space engine alone.",
    LAYER_KEYS,
);
