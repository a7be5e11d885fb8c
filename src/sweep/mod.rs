//! Frequency sweeps: what to compute, cases in parallel, records on disk, peak search; and single drive histories.

pub mod body_material;
pub mod case;
pub mod domain;
pub mod engines;
pub mod error_bars;
pub mod files;
pub mod peak;
pub mod plan;
pub mod record;
pub mod refine;
pub mod resolved;
pub mod run;
pub mod scenario;
pub mod simulate;
mod stabilise;
pub mod store;
