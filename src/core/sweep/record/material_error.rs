//! The error of a result that comes from the noise of the data which its material was fitted to.

use crate::material::dynamic::replicas;

/// Fewest replicas of which the spread is reported.
const FEWEST: usize = 8;
/// As many in a hundred may be without a value: more of them would be those that matter.
const MOST_WITHOUT: usize = 10;

/// The error (95 %) of a value of which the replicas of the material make these values, in the unit of the value, as
/// [`replicas::error`] has it; `None` where there are too few of them.
pub fn from_replicas(value: f64, replicas: &[Option<f64>]) -> Option<f64> {
    enough(replicas).and_then(|known| replicas::error(value, &known))
}

/// Half width of the simultaneous band of a curve at this value, as [`replicas::band`] has it; `None` where there are too few of them.
pub fn band(value: f64, replicas: &[Option<f64>]) -> Option<f64> {
    enough(replicas).and_then(|known| replicas::band(value, &known))
}

/// The values that are known, where they are enough.
fn enough(replicas: &[Option<f64>]) -> Option<Vec<f64>> {
    let known: Vec<f64> = replicas.iter().flatten().copied().collect();
    let enough = known.len() >= FEWEST
        && 100 * (replicas.len() - known.len()) <= MOST_WITHOUT * replicas.len();
    enough.then_some(known)
}
