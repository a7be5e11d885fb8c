//! Frequency sweeps: what to compute, cases in parallel, records on disk, peak search.

pub mod case;
pub mod domain;
pub mod peak;
pub mod plan;
pub mod record;
pub mod resolved;
pub mod run;
pub mod store;
