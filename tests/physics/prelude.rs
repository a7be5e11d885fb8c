//! What nearly every test of the physics uses.

pub use std::f64::consts::{PI, TAU};
pub use std::sync::Arc;
pub use std::sync::atomic::AtomicBool;

pub use contact_dma::contact::{ContactError, Engine, Instant, Prescribed, Solution};
pub use contact_dma::engine::{EngineKind, SolverPlan};
pub use contact_dma::history::{March, TimeRule};
pub use contact_dma::prelude::*;
pub use contact_dma::sweep::plan::{CyclePlan, Method, SweepPlan};
pub use contact_dma::sweep::record::error_bars::Quantity;
pub use contact_dma::sweep::record::{CaseResult, Status};
pub use rayon::prelude::*;

pub use crate::common::engines::*;
pub use crate::common::random::Random;
pub use crate::common::*;
