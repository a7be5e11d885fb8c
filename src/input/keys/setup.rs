//! Keys of a setup file: the instrument and the contact of measured loops.

use super::material::POISSON_RATIO;
use super::rows;
use crate::input::document::kind::{
    Array, Boolean, Choice, Scalar, Table, Text, list, number, quantity,
};
use crate::input::document::limits::Limits;
use crate::input::document::row::{Optional, Or, Row, Rows};
use crate::quantity::Dimension::{Damping, FrameCompliance, Length, Mass, Speed, Stiffness, Time};

rows! { INSTRUMENT_KEYS:
    /// Compliance of frame and mount: the approach is the displacement less this times the load.
    FRAME_COMPLIANCE: Row<Scalar, Or<f64>> = "frame_compliance", quantity(FrameCompliance).not_negative(), Or(0.0);
    /// Moving mass, between the sensor of the force and the contact.
    MASS: Row<Scalar, Or<f64>> = "mass", quantity(Mass).not_negative(), Or(0.0);
    /// Damping of the suspension of the moving part.
    DAMPING: Row<Scalar, Or<f64>> = "damping", quantity(Damping).not_negative(), Or(0.0);
    /// Stiffness of the suspension; the displacement counts from where it is at rest.
    STIFFNESS: Row<Scalar, Or<f64>> = "stiffness", quantity(Stiffness).not_negative(), Or(0.0);
    /// By how much the channel of the approach is later than that of the load; negative where it is earlier.
    TIME_LAG: Row<Scalar, Or<f64>> = "time_lag", quantity(Time), Or(0.0);
    /// Rate at which temperature moves the approach, where it was measured.
    THERMAL_DRIFT: Row<Scalar, Or<f64>> = "thermal_drift", quantity(Speed), Or(0.0);
    /// Reading of the approach at first touch.
    APPROACH_AT_TOUCH: Row<Scalar, Or<f64>> = "approach_at_touch", quantity(Length), Or(0.0);
}

static INSTRUMENT_TABLE: Rows = super::table(
    " What the instrument adds to load and approach, taken out of every harmonic.",
    INSTRUMENT_KEYS,
);

/// Where the contact radius comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum RadiusFrom {
    Geometry,
    Column,
    AreaFunction,
}

const RADII: [(&str, RadiusFrom); 3] = [
    ("geometry", RadiusFrom::Geometry),
    ("column", RadiusFrom::Column),
    ("area-function", RadiusFrom::AreaFunction),
];

/// Of the contact depth: 0 to 1, a flat punch having the latter.
const EPSILON_LIMITS: Limits = Limits::between(0.0, 1.0);
/// More terms than instruments fit.
const MOST_TERMS: usize = 9;

rows! { _:
    /// Contact radius of the moduli: that of the shape at the mean approach, the mean of the column `contact_radius`, or from an area
    /// function.
    RADIUS_FROM: Row<Choice<RadiusFrom>, Or<RadiusFrom>> = "radius", Choice(&RADII), Or(RadiusFrom::Geometry);
    /// C₀, C₁, C₂, ... of A = C₀h² + C₁h + C₂h^½ + C₃h^¼ + ..., for h in m and A in m².
    AREA_FUNCTION: Row<Array<Scalar>, Optional> =
        "area_function",
        Array {
            entries: 1..=MOST_TERMS,
            instead: "give the coefficients from C₀ on, at most nine",
            ..list(number("24.5"))
        },
        Optional;
    /// ε of the contact depth h = δ₀ − ε W₀/S at which the area function is taken.
    EPSILON: Row<Scalar, Or<f64>> = "epsilon", number("0.75").within(EPSILON_LIMITS), Or(0.75);
    /// Whether the bias of the small-amplitude formula is computed with the exact model; it takes some hundredths of a second a record.
    BIAS: Row<Boolean, Or<bool>> = "bias", Boolean, Or(true);
}

static CONTACT_TABLE: Rows = super::table(
    " How moduli are read from the loop, (1 − ν²) W₁ exp(i phase lag)/(2 a₀ δ₁).",
    &[
        &POISSON_RATIO,
        &RADIUS_FROM,
        &AREA_FUNCTION,
        &EPSILON,
        &BIAS,
    ],
);

rows! { SETUP_KEYS:
    /// What tables and the page are headed with.
    SETUP_TITLE: Row<Text, Optional> = "title", Text, Optional;
    /// What the instrument adds.
    INSTRUMENT: Row<Table, Optional> = "instrument", Table(&INSTRUMENT_TABLE), Optional;
    /// The contact, where moduli are asked for.
    CONTACT: Row<Table, Optional> = "contact", Table(&CONTACT_TABLE), Optional;
    /// The rigid indenter, where its geometry is to be used.
    SETUP_INDENTER: Row<Table, Optional> = "indenter", Table(&super::indenter::INDENTER), Optional;
}

pub(super) static SETUP_FILE: Rows = super::table(
    " The instrument and the contact of measured loops, for `contact-dma analyse --setup`.",
    SETUP_KEYS,
);
