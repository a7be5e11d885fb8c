//! Keys of a setup file: the instrument and the contact of measured loops.

use crate::input::indenter_block::INDENTER;
use crate::measured::Corrections;
use crate::quantity::block::Block as _;
use crate::quantity::key::{self, Entries, Kind, Limits, number};
use crate::quantity::rows::{Rows, table};
use contact_dma_core::{block, keys, words};

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

block! {
    /// How moduli are read from the loop, (1 − ν²) W₁ exp(i phase lag)/(2 a₀ δ₁).
    pub(crate) struct ContactKeys in "contact" {
        /// Poisson ratio, constant in time.
        poisson_ratio: f64 => "poisson_ratio", Kind::Number(key::POISSON_RATIO);
        /// Contact radius of the moduli: that of the shape at the mean approach, the mean of the column `contact_radius`, or from an area
        /// function.
        radius: RadiusFrom = RadiusFrom::Geometry => "radius", Kind::Word(RadiusFrom::WORDS);
        /// C₀, C₁, C₂, ... of A = C₀h² + C₁h + C₂h^½ + C₃h^¼ + ..., for h in m and A in m².
        area_function: Option<Vec<f64>> = None => "area_function",
            Kind::Numbers(number("24.5"), Entries::of(1..=MOST_TERMS, "give the coefficients from C₀ on, at most nine"));
        /// ε of the contact depth h = δ₀ − ε W₀/S at which the area function is taken.
        epsilon: f64 = 0.75 => "epsilon", Kind::Number(number("0.75").within(EPSILON_LIMITS));
        /// Whether the bias of the small-amplitude formula is computed with the exact model, which takes some hundredths of a second per record.
        bias: bool = true => "bias", Kind::Flag;
    }
}

keys! {
    /// Title of tables and the page.
    SETUP_TITLE = "title", Kind::Text, optional;
    /// Contributions of the instrument.
    INSTRUMENT = "instrument", Kind::Table(&Corrections::ROWS), optional;
    /// The contact, if moduli are wanted.
    CONTACT = "contact", Kind::Table(&ContactKeys::ROWS), optional;
    /// The rigid indenter, if its geometry is used.
    SETUP_INDENTER = "indenter", Kind::Table(&INDENTER), optional;
}

pub(super) static SETUP_FILE: Rows = table(
    " The instrument and the contact of measured loops, for `contact-dma analyse --setup`.",
    &[&[SETUP_TITLE, INSTRUMENT, CONTACT, SETUP_INDENTER]],
);
