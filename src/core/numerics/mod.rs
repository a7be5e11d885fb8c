//! Methods that know nothing of contact or materials, each once: roots, extremes, polynomials, order, non-negative least squares.

pub mod nnls;
pub mod order;
pub mod polynomial;
pub mod roots;
