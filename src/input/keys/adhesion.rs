//! Keys of `[adhesion]`: the surface attracts the indenter.

use super::rows;
use crate::input::document::kind::{Scalar, quantity};
use crate::input::document::row::{Or, Required, Row, Rows};
use crate::quantity::Dimension::{EnergyPerArea, Length};
use crate::sweep::plan::adhesion::AdhesionPlan;

rows! { ADHESION_KEYS:
    /// Work of adhesion, the energy that parts a unit of area.
    WORK: Row<Scalar, Required> = "work", quantity(EnergyPerArea).above_zero(), Required;
    /// Distance of the surfaces at equilibrium, which Tabor's parameter depends on.
    EQUILIBRIUM_DISTANCE: Row<Scalar, Or<f64>> =
        "equilibrium_distance", quantity(Length).above_zero(), Or(AdhesionPlan::EQUILIBRIUM_DISTANCE_M);
}

pub(super) static ADHESION: Rows = super::table(
    " Attraction outside the contact of a sphere, by the theory of Derjaguin, Muller and Toporov, under a prescribed load.",
    ADHESION_KEYS,
);
