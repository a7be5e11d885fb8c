//! The stabilised cycle found directly, instead of waited for.
//!
//! The unknown is the memory m at the start of the cycle; one cycle maps it to m' at its end, and the stabilised cycle is
//! the fixed point. Taking m' for the next m is marching, which needs T/lambda cycles to forget the start. For a given
//! periodic pressure the fixed point is known in closed form, m* = (m' - E m)/(1 - E) per branch with E = exp(-T/lambda);
//! jumping there diverges where slow branches are strong, because the pressure answers them. Newton's method per node knows
//! that answer, and Anderson acceleration (D. G. Anderson, J. ACM 12 (1965) 547) takes care of the rest: of nodes that enter
//! and leave the contact, and of the elastic coupling between them.

mod anderson;
mod correction;
mod iteration;
mod remaining;

pub use iteration::{Begin, Cycle, SearchState, Steady, SteadySettings, Watch, find, find_from};
pub use remaining::{MeanPressure, Remaining};
