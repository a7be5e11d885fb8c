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
    if block.by_instrument && width(&temperatures) <= WIDEST_STEP_K && frequencies_differ(&points) {
        return Ok(vec![points]);
    }
    let starts = starts(&temperatures);
    let mut from = 0;
    for next in starts.iter().skip(1).copied().chain([f64::INFINITY]) {
        let to = temperatures.partition_point(|temperature| *temperature < next);
        let inside = temperatures.get(from..to).unwrap_or_default();
        if width(inside) > WIDEST_CLUSTER_K {
            return Err(ramp(block, &points, inside));
        }
        from = to;
    }
    let mut isotherms: Vec<Vec<Measured>> = starts.iter().map(|_| Vec::new()).collect();
    for measured in points {
        let temperature = measured.point.temperature_k.unwrap_or_default();
        let which = starts
            .partition_point(|start| *start <= temperature)
            .saturating_sub(1);
        if let Some(isotherm) = isotherms.get_mut(which) {
            isotherm.push(measured);
        }
    }
    Ok(isotherms)
}

fn ramp(block: &Block<'_>, points: &[Measured], inside: &[f64]) -> Diagnostic {
    let ends = [inside.first(), inside.last()].map(|end| celsius(end.copied().unwrap_or_default()));
    let place = points.first().map_or_else(
        || block.section.grid.whole(),
        |measured| measured.place.clone(),
    );
    let message = format!(
        "temperatures run from {} to {} without a gap: these are no isotherms",
        ends[0], ends[1]
    );
    Diagnostic::at(&place, message)
        .help("measure at constant temperatures, or add a column `Set` that numbers the isotherms")
}

fn width(ascending: &[f64]) -> f64 {
    ascending
        .first()
        .zip(ascending.last())
        .map_or(0.0, |(first, last)| last - first)
}

/// The lowest temperature of every isotherm.
fn starts(ascending: &[f64]) -> Vec<f64> {
    let gaps = || {
        ascending
            .windows(2)
            .map(|pair| (pair[1] - pair[0], pair[1]))
    };
    let largest = gaps().map(|(gap, _)| gap).fold(0.0, f64::max);
    let least = (SHARE_OF_LARGEST * largest).clamp(GAP_K.0, GAP_K.1);
    let above = gaps()
        .filter(|(gap, _)| *gap > least)
        .map(|(_, start)| start);
    ascending.iter().take(1).copied().chain(above).collect()
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
