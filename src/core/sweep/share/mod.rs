//! What cases cost, and how they are shared out: no part of the results.

pub mod cost;
pub mod shard;
mod trial;
