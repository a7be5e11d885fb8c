//! The error of a result that comes from the noise of the data which its material was fitted to.

/// Fewest replicas from which a spread is told.
const FEWEST: usize = 8;
/// The error encloses the truth in 95 of 100 cases, as two standard deviations do.
const STANDARD_DEVIATIONS: f64 = 2.0;

/// The error of a value of which the replicas of the material make these values, in the unit of the value; `None` where there are
/// too few of them. What the fit is off the middle of its replicas is a part of it.
pub fn of(value: f64, replicas: &[Option<f64>]) -> Option<f64> {
    let squares: Vec<f64> = (replicas.iter().flatten())
        .map(|replica| (replica - value).powi(2))
        .collect();
    // More than a few without a value would be those that matter.
    if squares.len() < FEWEST || 10 * squares.len() < 9 * replicas.len() {
        return None;
    }
    let mean_square = squares.iter().sum::<f64>() / squares.len() as f64;
    Some(STANDARD_DEVIATIONS * mean_square.sqrt())
}
