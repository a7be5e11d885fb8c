//! The half-space engine: rectangular cells of uniform pressure on an elastic half-space in free space, or on a layer that lies
//! on a rigid base, for any shape.
//!
//! Conventions: displacement positive into the body, pressure positive in compression, cells row-major (x fastest).

pub mod convolution;
pub mod grid;
pub mod influence;
pub mod layer;
mod solver;

pub use convolution::predicted_memory_bytes;
pub use solver::{HalfSpace, SolverSettings};
