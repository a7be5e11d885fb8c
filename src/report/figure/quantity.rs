//! The quantities that figures draw, each with the column that tables have for it.

use super::plot::{Quantity, Spread};
use super::units::Measure;
use crate::quantity::Dimension;

pub const ENERGY_LOSS: Quantity =
    Quantity::new("energy_loss_j", "energy loss per cycle", Measure::Energy)
        .spread(Spread::OfCurves);
pub const LOAD: Quantity = Quantity::new("load_n", "load W", Measure::Load);
pub const APPROACH: Quantity = Quantity::new("approach_m", "approach δ", Measure::Approach);
pub const CONTACT_RADIUS: Quantity =
    Quantity::new("contact_radius_m", "contact radius a", Measure::Length);
pub const PRESSURE: Quantity = Quantity::new("pressure_pa", "pressure p", Measure::Pressure);
pub const DISPLACEMENT: Quantity =
    Quantity::new("displacement_m", "displacement u", Measure::Approach);
pub const WORK_PER_AREA: Quantity = Quantity::new(
    "work_j_per_m2",
    "work per cycle and area w",
    Measure::EnergyPerArea,
);
pub const TIME: Quantity = Quantity::new("time_s", "time t", Measure::Time);
pub const MODULUS: Quantity =
    Quantity::new("modulus_pa", "modulus", Measure::Modulus).spread(Spread::Log);
pub const STORAGE_MODULUS: Quantity =
    Quantity::new("storage_modulus_pa", "storage modulus E′", Measure::Modulus);
pub const LOSS_MODULUS: Quantity =
    Quantity::new("loss_modulus_pa", "loss modulus E″", Measure::Modulus);
pub const COMPLEX_MODULUS: Quantity = Quantity::new(
    "complex_modulus_pa",
    "magnitude of the complex modulus |E*|",
    Measure::Modulus,
)
.spread(Spread::OfValues);
/// δ is the approach, and so the angle is φ.
pub const PHASE_ANGLE: Quantity = Quantity::new(
    "phase_angle_rad",
    "phase angle φ",
    Measure::Of(Dimension::Angle),
);
pub const LOSS_TANGENT: Quantity = Quantity::new(
    "loss_tangent",
    "loss tangent tan φ = E″/E′",
    Measure::Number,
);
pub const TEMPERATURE: Quantity = Quantity::new(
    "temperature_k",
    "temperature T",
    Measure::Of(Dimension::Temperature),
);
pub const CYCLE: Quantity =
    Quantity::new("cycle", "number of the cycle", Measure::Number).spread(Spread::Whole);
pub const RESIDUAL: Quantity = Quantity::new(
    "relative_difference",
    "difference of model and data, over the data",
    Measure::Percent,
);
