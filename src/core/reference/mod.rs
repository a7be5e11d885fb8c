//! Reference solutions, each with its source, and slow independent solvers. Tests, benches and users compare with them;
//! nothing that computes results for a user rests on them.

pub mod adhesive;
#[cfg(test)]
mod direct_sum;
pub mod elastic;
pub mod elliptic;
pub mod power_law;
pub mod steady;
pub mod step_load;
pub mod transient;
