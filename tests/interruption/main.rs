//! Runs that are killed, interrupted, resumed and shared. On their own, since they wait for moments that heavy tests would shift.

#![cfg(all(unix, feature = "cli"))]

#[path = "../common/kills.rs"]
mod kills;
#[path = "../common/program.rs"]
mod program;
#[path = "../common/random.rs"]
mod random;
#[path = "../common/segments.rs"]
mod segments;

mod one_plan;
mod signals;
mod simulate_survival;
mod survival;
