//! What figures are drawn in: their size on paper, their typefaces, and the units of normalised axes. Figures themselves are in the report.

pub mod elastic;
#[cfg(feature = "report")]
pub mod font;
pub mod paper;
