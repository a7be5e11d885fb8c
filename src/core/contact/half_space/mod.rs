//! The half-space engine: rectangular cells of uniform pressure on an elastic half-space in free space, or on a layer that lies
//! on a rigid base, for any shape; and one period of a surface that repeats itself.
//!
//! Conventions: displacement positive into the body, pressure positive in compression, cells row-major (x fastest).

mod active_set;
pub mod convolution;
pub mod grid;
pub mod influence;
mod instant;
pub mod layer;
pub mod love;
mod memory;
mod passes;
pub mod periodic;
mod polonsky_keer;
mod solver;

pub use instant::SolverSettings;
pub use memory::CellField;
pub use solver::HalfSpace;
