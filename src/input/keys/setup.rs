//! Keys of a setup file: the instrument and the contact of measured loops.

use super::material::POISSON_RATIO;
use crate::input::document::block::rows_of;
use crate::input::document::kind::{Array, Boolean, Choice, Number, Table, Text, list, number};
use crate::input::document::row::{Optional, Or, Row, Rows, rows, table};
use crate::measured::Corrections;
use crate::quantity::key::Limits;
use contact_dma_core::words;

static INSTRUMENT_TABLE: Rows = rows_of::<Corrections>();

words! {
    /// Where the contact radius comes from.
    pub(crate) enum RadiusFrom {
        Geometry = "geometry",
        Column = "column",
        AreaFunction = "area-function",
    }
}

/// Of the contact depth: 0 to 1, a flat punch having the latter.
const EPSILON_LIMITS: Limits = Limits::between(0.0, 1.0);
/// More terms than instruments fit.
const MOST_TERMS: usize = 9;

rows! { _:
    /// Contact radius of the moduli: that of the shape at the mean approach, the mean of the column `contact_radius`, or from an area
    /// function.
    RADIUS_FROM: Row<Choice<RadiusFrom>, Or<RadiusFrom>> = "radius", Choice(RadiusFrom::NAMES), Or(RadiusFrom::Geometry);
    /// C₀, C₁, C₂, ... of A = C₀h² + C₁h + C₂h^½ + C₃h^¼ + ..., for h in m and A in m².
    AREA_FUNCTION: Row<Array<Number>, Optional> =
        "area_function",
        Array {
            entries: 1..=MOST_TERMS,
            instead: "give the coefficients from C₀ on, at most nine",
            ..list(number("24.5"))
        },
        Optional;
    /// ε of the contact depth h = δ₀ − ε W₀/S at which the area function is taken.
    EPSILON: Row<Number, Or<f64>> = "epsilon", number("0.75").within(EPSILON_LIMITS), Or(0.75);
    /// Whether the bias of the small-amplitude formula is computed with the exact model, which takes some hundredths of a second per record.
    BIAS: Row<Boolean, Or<bool>> = "bias", Boolean, Or(true);
}

static CONTACT_TABLE: Rows = table(
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
    /// Title of tables and the page.
    SETUP_TITLE: Row<Text, Optional> = "title", Text, Optional;
    /// Contributions of the instrument.
    INSTRUMENT: Row<Table, Optional> = "instrument", Table(&INSTRUMENT_TABLE), Optional;
    /// The contact, if moduli are wanted.
    CONTACT: Row<Table, Optional> = "contact", Table(&CONTACT_TABLE), Optional;
    /// The rigid indenter, if its geometry is used.
    SETUP_INDENTER: Row<Table, Optional> = "indenter", Table(&crate::input::indenter_block::INDENTER), Optional;
}

pub(super) static SETUP_FILE: Rows = table(
    " The instrument and the contact of measured loops, for `contact-dma analyse --setup`.",
    SETUP_KEYS,
);
