//! Frequency sweeps: what to compute, cases in parallel, records on disk, peak search; and single drive histories.

pub mod archive;
pub mod body_material;
pub mod case;
pub mod checkpoint;
pub mod cost;
pub mod difference;
pub mod domain;
pub mod engines;
pub mod error_bars;
pub mod files;
mod locate;
pub mod merge;
pub mod peak;
pub mod plan;
pub mod provenance;
pub mod record;
pub mod refine;
pub mod resolved;
pub mod run;
pub mod scenario;
pub mod sealed;
mod search;
pub mod shard;
pub mod simulate;
mod stabilise;
pub mod store;
