//! Methods that know nothing of contact or materials, each once: grids, roots, extremes, polynomials, order, least squares of
//! any unknowns and of unknowns that are not negative; and the threads that share a pass over a field.

pub mod grid;
pub mod levenberg_marquardt;
pub mod nnls;
pub mod order;
pub mod polynomial;
pub(crate) mod random;
pub mod roots;
pub(crate) mod threads;
