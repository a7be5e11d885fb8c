//! The stabilised cycle found directly, instead of waited for.
//!
//! The unknown is the memory m at the start of the cycle; one cycle maps it to m' at its end, and the stabilised cycle is
//! the fixed point. Taking m' for the next m is marching, which needs T/lambda cycles to forget the start. For a given
//! periodic pressure the fixed point is known in closed form, m* = (m' - E m)/(1 - E) per branch with E = exp(-T/lambda);
//! jumping there diverges where slow branches are strong, because the pressure answers them. Newton's method per node knows
//! that answer, and Anderson acceleration (D. G. Anderson, J. ACM 12 (1965) 547) takes care of the rest: of nodes that enter
//! and leave the contact, and of the elastic coupling between them. Where cells come and go without end, what is left to do is done by
//! Newton's method on the whole map, in the same memory.
//!
//! ```
//! use std::f64::consts::TAU;
//!
//! # extern crate contact_dma_core as contact_dma;
//! use contact_dma::contact::Prescribed;
//! use contact_dma::contact::axisymmetric::{Axisymmetric, Edge};
//! use contact_dma::history::{March, TimeRule};
//! use contact_dma::material::classical::zener;
//! use contact_dma::material::{Material, ModulusKind};
//! use contact_dma::steady::{Cycle, SteadySettings, find};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Springs under a sphere of 10 mm, whose transformed gap is x^2 / R.
//! let width_m = 3e-6;
//! let gaps_m = (0..200).map(|i| ((f64::from(i) + 0.5) * width_m).powi(2) / 0.01);
//! let mut engine = Axisymmetric::new(width_m, gaps_m.collect(), Edge::Open, true);
//! let solid = Material::from_creep(zener(1e9, 1e9, 1.0)?, ModulusKind::Shear, 0.35)?.contact_compliance()?;
//! let mut march = March::new(&mut engine, solid, TimeRule::Linear);
//! let cycle = Cycle {
//!     drive: &|fraction| Prescribed::LoadN(5.0 + 2.0 * (TAU * fraction).sin()),
//!     mean: Prescribed::LoadN(5.0),
//!     period_s: 1.0,
//!     steps: 40,
//! };
//! let settings = SteadySettings { tolerance: 1e-6, max_cycles: 100, is_quick: true };
//! let found = find(&mut march, &cycle, None, settings, &|| false)?;
//! assert!(found.converged && found.cycles < 20);
//! # Ok(())
//! # }
//! ```

mod anderson;
mod correction;
mod instants;
mod iteration;
mod newton;
mod remaining;

pub(crate) use anderson::Anderson;
pub use iteration::{Cycle, Steady, SteadySettings, find};
pub(crate) use iteration::{Record, find_recorded};
pub(crate) use newton::find_by_newton;
pub use remaining::Remaining;
