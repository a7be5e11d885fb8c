//! The error of a result that comes from the noise of the data which its material was fitted to.

use crate::material::dynamic::replicas;

/// Fewest replicas of which the spread is told.
const FEWEST: usize = 8;
/// As many in a hundred may be without a value: more of them would be those that matter.
const MOST_WITHOUT: usize = 10;

/// The error of a value of which the replicas of the material make these values, in the unit of the value, as
/// [`replicas::band`] has it; `None` where there are too few of them.
pub fn of(value: f64, replicas: &[Option<f64>]) -> Option<f64> {
    let known: Vec<f64> = replicas.iter().flatten().copied().collect();
    let enough = known.len() >= FEWEST
        && 100 * (replicas.len() - known.len()) <= MOST_WITHOUT * replicas.len();
    enough.then(|| replicas::band(value, &known)).flatten()
}
