//! Which rows of a block are one isotherm.
//!
//! - Where a column numbers the isotherms, it decides.
//! - Where an instrument wrote the block, no frequency is in it twice and its temperatures lie within 5 K, it is one isotherm.
//! - Else temperatures decide, wherever their rows stand. In ascending order, a gap of more than 0.15 of the largest gap, and of 0.5
//!   to 1.5 K, begins another isotherm: within one, the measured temperature scatters by some tenths of a kelvin, and isotherms are 2
//!   to 20 K apart. Temperatures that cover more than 3 K without such a gap are those of a ramp, not of isotherms.

use std::collections::HashMap;

use super::block::{Block, Measured};
use crate::input::diagnostic::Diagnostic;
use crate::quantity::celsius;

/// Widest isotherm in a step of an instrument (K).
const WIDEST_STEP_K: f64 = 5.0;
/// Widest isotherm found from temperatures alone (K).
const WIDEST_CLUSTER_K: f64 = 3.0;
/// A gap is one between isotherms from this share of the largest.
const SHARE_OF_LARGEST: f64 = 0.15;
/// Narrowest and widest such share (K).
const GAP_K: (f64, f64) = (0.5, 1.5);

/// The rows of a block, isotherm by isotherm.
///
/// # Errors
/// Temperatures without gaps.
pub(super) fn split(
    block: &Block<'_>,
    points: Vec<Measured>,
) -> Result<Vec<Vec<Measured>>, Diagnostic> {
    if points.iter().any(|measured| measured.set.is_some()) {
        return Ok(by_set(points));
    }
    let temperatures: Option<Vec<f64>> = points
        .iter()
        .map(|measured| measured.point.temperature_k)
        .collect();
    let Some(mut temperatures) = temperatures.filter(|list| !list.is_empty()) else {
        return Ok(vec![points]);
    };
    temperatures.sort_by(f64::total_cmp);
    if block.section.by_instrument
        && width(&temperatures) <= WIDEST_STEP_K
        && frequencies_differ(&points)
    {
        return Ok(vec![points]);
    }
    let gaps = temperatures.windows(2).map(|pair| pair[1] - pair[0]);
    let least = (SHARE_OF_LARGEST * gaps.fold(0.0, f64::max)).clamp(GAP_K.0, GAP_K.1);
    let clusters: Vec<&[f64]> = temperatures.chunk_by(|a, b| b - a <= least).collect();
    let mut wide = clusters
        .iter()
        .filter(|cluster| width(cluster) > WIDEST_CLUSTER_K);
    if let (Some([first, .., last]), Some(measured)) = (wide.next(), points.first()) {
        let (first, last) = (celsius(*first), celsius(*last));
        let message = format!(
            "temperatures run from {first} to {last} without a gap: these are no isotherms"
        );
        return Err(Diagnostic::at(&measured.place, message).help(
            "measure at constant temperatures, or add a column `Set` that numbers the isotherms",
        ));
    }
    let mut isotherms: Vec<Vec<Measured>> = clusters.iter().map(|_| Vec::new()).collect();
    for measured in points {
        let temperature = measured.point.temperature_k.unwrap_or_default();
        let is_below =
            |cluster: &&[f64]| cluster.first().is_some_and(|first| *first <= temperature);
        let which = clusters.partition_point(is_below).saturating_sub(1);
        if let Some(isotherm) = isotherms.get_mut(which) {
            isotherm.push(measured);
        }
    }
    Ok(isotherms)
}

fn width(ascending: &[f64]) -> f64 {
    ascending
        .first()
        .zip(ascending.last())
        .map_or(0.0, |(first, last)| last - first)
}

fn frequencies_differ(points: &[Measured]) -> bool {
    let mut all: Vec<f64> = points
        .iter()
        .map(|measured| measured.point.angular_frequency_rad_per_s)
        .collect();
    all.sort_by(f64::total_cmp);
    all.windows(2).all(|pair| pair[1] / pair[0] > 1.001)
}

fn by_set(points: Vec<Measured>) -> Vec<Vec<Measured>> {
    let (mut places, mut sets) = (HashMap::new(), Vec::new());
    for mut measured in points {
        let next = places.len();
        let place = *places.entry(measured.set.take()).or_insert(next);
        if place == next {
            sets.push(Vec::new());
        }
        sets[place].push(measured);
    }
    sets
}
