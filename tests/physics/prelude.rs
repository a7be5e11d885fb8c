//! What nearly every test of the physics uses.

pub use std::f64::consts::{PI, TAU};
pub use std::path::Path;
pub use std::sync::Arc;
pub use std::sync::atomic::AtomicBool;

pub use contact_dma::contact::axisymmetric::Axisymmetric;
pub use contact_dma::contact::half_space::convolution::Convolution;
pub use contact_dma::contact::half_space::grid::Grid;
pub use contact_dma::contact::half_space::{HalfSpace, SolverSettings};
pub use contact_dma::contact::{ContactError, Engine, Instant, Prescribed, Solution};
pub use contact_dma::engine::{EngineKind, SolverPlan};
pub use contact_dma::history::{March, TimeRule};
pub use contact_dma::indenter::{MapEdge, MapQuantity, Roughness, Shifted};
pub use contact_dma::input::document::Document;
pub use contact_dma::input::sweep_file;
pub use contact_dma::material::{Compressibility, classical};
pub use contact_dma::prelude::*;
pub use contact_dma::reference::elastic::{ConeContact, Hertz};
pub use contact_dma::simulation::HistoryRow;
pub use contact_dma::sweep::case::Setup;
pub use contact_dma::sweep::plan::adhesion::{AdhesionModel, AdhesionPlan};
pub use contact_dma::sweep::plan::layer::LayerPlan;
pub use contact_dma::sweep::plan::{CyclePlan, Method, SweepPlan};
pub use contact_dma::sweep::record::error_bars::Quantity;
pub use contact_dma::sweep::record::{CaseResult, Status};
pub use num_complex::Complex;
pub use rayon::prelude::*;

pub use crate::common::engines::*;
pub use crate::common::random::Random;
pub use crate::common::*;
