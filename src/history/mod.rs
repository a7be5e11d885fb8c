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

mod direct;
mod dissipation;
mod extrapolation;
mod hereditary;
mod loaded;
mod march;
mod memory;
mod work;

pub use direct::{ComplianceFunction, DirectMemory, DirectStep, Quadrature};
pub use dissipation::Dissipation;
pub use hereditary::{Hereditary, Stage};
pub use march::{March, MarchState, Observer, StepState};
pub use memory::{Memory, StepWeights, TimeRule, order_of_steps};
pub use work::Work;
