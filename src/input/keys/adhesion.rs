//! Keys of `[adhesion]`: the surface attracts the indenter.

use super::rows;
use crate::input::document::kind::{Scalar, quantity};
use crate::input::document::row::{Or, Required, Row, Rows};
use crate::quantity::Dimension::{EnergyPerArea, Length};
use crate::sweep::plan::adhesion::AdhesionPlan;

rows! { ADHESION_KEYS:
    /// Work of adhesion: energy to separate a unit area.
    WORK: Row<Scalar, Required> = "work", quantity(EnergyPerArea).above_zero(), Required;
    /// Equilibrium distance of the surfaces, used in the Tabor parameter.
    EQUILIBRIUM_DISTANCE: Row<Scalar, Or<f64>> =
        "equilibrium_distance", quantity(Length).above_zero(), Or(AdhesionPlan::EQUILIBRIUM_DISTANCE_M);
}

pub(super) static ADHESION: Rows = super::table(
    " Adhesion of a sphere under a prescribed load, by the theory of Derjaguin, Muller and Toporov.",
    ADHESION_KEYS,
);
