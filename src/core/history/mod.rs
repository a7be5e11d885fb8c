//! Viscoelastic memory: the hereditary integral as a recursion, and time marching on it.
//!
//! For a generalised Kelvin compliance C(t) = C_0 + sum C_j (1 - exp(-t/lambda_j)) + t/eta, the hereditary integral
//! q(t) = integral of C(t-s) dp(s) needs one memory variable per node and branch instead of the whole past:
//!
//! ```text
//! q = C_0 p + sum C_j m_j + m_v / eta,      lambda_j dm_j/dt = p - m_j,      dm_v/dt = p
//! ```
//!
//! so that cost and storage per step do not grow with the number of steps. Any other compliance function takes the direct sum
//! over the past ([`DirectMemory`]). Marching serves both ([`Hereditary`]). This room owns the state and calls `contact`
//! once per instant; it knows neither indenters nor what drives the load.
//!
//! ```
//! # extern crate contact_dma_core as contact_dma;
//! use contact_dma::contact::Prescribed;
//! use contact_dma::contact::axisymmetric::{Axisymmetric, Edge};
//! use contact_dma::history::{March, TimeRule};
//! use contact_dma::material::classical::zener;
//! use contact_dma::material::{Material, ModulusKind};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Springs under a sphere of 10 mm, whose transformed gap is x^2 / R.
//! let width_m = 3e-6;
//! let gaps_m = (0..200).map(|i| ((f64::from(i) + 0.5) * width_m).powi(2) / 0.01);
//! let mut engine = Axisymmetric::new(width_m, gaps_m.collect(), Edge::Open, true);
//! let solid = Material::from_creep(zener(1e9, 1e9, 1.0)?, ModulusKind::Shear, 0.35)?.contact_compliance()?;
//! let mut march = March::new(&mut engine, solid, TimeRule::Linear);
//! let at_once = march.jump(Prescribed::LoadN(10.0))?;
//! march.hold(10.0, Prescribed::LoadN(10.0))?;
//! let crept = march.solution().ok_or("no instant")?;
//! assert!(crept.approach_m > 1.2 * at_once.approach_m);
//! # Ok(())
//! # }
//! ```

mod cycle_sums;
mod direct;
mod displaced;
mod dissipation;
mod extrapolation;
mod hereditary;
mod last_cycle;
mod march;
mod memory;
mod nodal_work;
mod rule;
mod work;

pub use cycle_sums::CycleSums;
pub use direct::{ComplianceFunction, DirectMemory};
pub use dissipation::Dissipation;
pub use extrapolation::Extrapolation;
pub use hereditary::{Hereditary, PastState};
pub(crate) use last_cycle::kept_bytes;
pub use march::{March, Observer, StepState};
pub use memory::Memory;
pub use nodal_work::NodalWork;
pub use rule::{DirectWeights, Recursion, Stage, Step, StepWeights, TimeRule, order_of_steps};
pub(crate) use rule::{linear_weight, rings};
pub use work::Work;
