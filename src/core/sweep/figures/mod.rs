//! How figures are to look: no part of the results.

pub mod figure_plan;
