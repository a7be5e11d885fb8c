//! The deformed surface at one instant: pressure and displacement, along a radius or over the cells of a grid.

use serde::{Deserialize, Serialize};

use super::half_space::grid::Grid;

/// What the surface needs besides the nodal pressure: how the body answered.
#[derive(Debug, Clone, Copy)]
pub struct Response<'a> {
    /// Nodal pressure of the instant, in the engine's unit.
    pub pressure: &'a [f64],
    /// H per node, as in [`super::Instant`].
    pub history: &'a [f64],
    /// A (1/Pa), as in [`super::Instant`].
    pub compliance_per_pa: f64,
    /// Contact radius (m), as in [`super::Solution`].
    pub contact_radius_m: f64,
}

/// The surface at one instant. Displacements are positive into the body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Surface {
    /// Of a body of revolution.
    Radial(RadialSurface),
    /// On a grid of cells.
    Cells(CellSurface),
}

/// Values along a radius, from the axis outwards, beyond the contact and the row of springs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RadialSurface {
    pub radius_m: Vec<f64>,
    /// 0 outside the contact; `None` where it is unbounded, at an apex.
    pub pressure_pa: Vec<Option<f64>>,
    pub displacement_m: Vec<f64>,
}

/// Values at the centres of cells, row by row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellSurface {
    pub grid: Grid,
    pub pressure_pa: Vec<f64>,
    pub displacement_m: Vec<f64>,
}

/// What a line through the origin of the surface runs along.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Along {
    /// From the axis of a body of revolution outwards.
    Radius,
    X,
    Y,
}

impl Along {
    /// The symbol used in every output.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Radius => "r",
            Self::X => "x",
            Self::Y => "y",
        }
    }
}

/// The contact pressure along a line through the origin, at ascending positions; 0 outside the contact, `None` where it is
/// unbounded, at an apex or a sharp rim.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PressureLine {
    pub along: Along,
    pub position_m: Vec<f64>,
    pub pressure_pa: Vec<Option<f64>>,
}

impl PressureLine {
    /// The pressure of a field along the row and along the column through the centre of its grid.
    pub(super) fn through_centre(grid: &Grid, pressure: &[f64]) -> Vec<Self> {
        let lines = [
            (Along::X, grid.centre_row()),
            (Along::Y, grid.centre_column()),
        ];
        let mean = |(_, [a, b]): &(f64, [usize; 2])| Some(0.5 * (pressure[*a] + pressure[*b]));
        lines
            .map(|(along, places)| Self {
                along,
                position_m: places.iter().map(|(position_m, _)| *position_m).collect(),
                pressure_pa: places.iter().map(mean).collect(),
            })
            .into()
    }
}
