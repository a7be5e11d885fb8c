//! How figures are to look, and the units that they may be in: no part of the results.

pub mod elastic_scale;
pub mod figure_plan;
