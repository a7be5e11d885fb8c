//! The domain of contacts on a layer. How large they are has no closed form, and may be far from what a half-space makes of the
//! same load: they are found on few cells, in domains that shrink or grow until they are filled.

use std::sync::Arc;

use crate::contact::half_space::convolution::Convolution;
use crate::contact::half_space::layer::LayerInfluence;
use crate::contact::half_space::{HalfSpace, SolverSettings};
use crate::contact::{ContactError, Engine, Instant};
use crate::engine::domain::{self, GROWTH};
use crate::engine::{EngineError, LargestContact, prescribed};
use crate::indenter::{Domain, Indenter};

/// Cells along the side of a trial.
const CELLS: usize = 48;
/// Trials: a thousandth of the half-space's contact, or ten times of it, are reached in these.
const TRIALS: usize = 24;
/// The smallest part of a domain that its contact fills, for the trial to be the last.
const FILLED: f64 = 0.8;
/// Of a trial, whose cells are coarse.
const TOLERANCE: f64 = 1e-4;

/// The domain that just holds the largest contact on a layer, from that on a half-space. Where no trial tells, the latter: a contact that
/// does not fit enlarges it later.
pub(super) fn contact_domain(
    layer: &Arc<LayerInfluence>,
    indenter: &dyn Indenter,
    on_half_space: Domain,
    largest: LargestContact,
) -> Result<Domain, EngineError> {
    // A contact does not leave a rim, on whatever body.
    let is_known = matches!(on_half_space, Domain::Cells { .. }) || indenter.rim().is_some();
    if is_known || largest.maximum <= 0.0 {
        return Ok(on_half_space);
    }
    let mut factor = 1.0;
    for _ in 0..TRIALS {
        let domain = domain::scaled(&on_half_space, factor);
        match part_filled(layer, indenter, &domain, largest)? {
            Filled::Beyond if domain::can_grow(&domain, 0) => factor *= GROWTH * GROWTH,
            Filled::Part(part) if part < FILLED => factor *= part.max(0.5 / CELLS as f64) / FILLED,
            Filled::Part(part) => return Ok(domain::scaled(&domain, part)),
            Filled::Beyond | Filled::Unknown => return Ok(domain),
        }
    }
    Ok(on_half_space)
}

/// How much of a domain is filled by the contact.
enum Filled {
    /// This part of its width, the outermost cells counted in.
    Part(f64),
    /// More than all.
    Beyond,
    Unknown,
}

fn part_filled(
    layer: &Arc<LayerInfluence>,
    indenter: &dyn Indenter,
    domain: &Domain,
    largest: LargestContact,
) -> Result<Filled, EngineError> {
    let failed = |reason: String| EngineError::Grid(reason);
    let grid = domain::grid(domain, CELLS, 0).map_err(|e| failed(e.to_string()))?;
    let grid = domain::quarter_of(indenter, &grid).unwrap_or(grid);
    let operator = Convolution::on(grid, Some(Arc::clone(layer)));
    let operator = Arc::new(operator.map_err(|e| failed(e.to_string()))?);
    let settings = SolverSettings {
        tolerance: TOLERANCE,
        ..SolverSettings::default()
    };
    let gaps_m = domain::gaps_m(indenter, &grid);
    let mut engine = HalfSpace::new(operator, gaps_m, true, settings);
    let history = vec![0.0; grid.cells()];
    let mut pressure = vec![0.0; grid.cells()];
    let instant = Instant {
        history: &history,
        compliance_per_pa: largest.compliance_per_pa,
        prescribed: prescribed(largest.control, largest.maximum),
    };
    match engine.solve(&instant, &mut pressure) {
        Ok(_) => {}
        Err(ContactError::ReachedEdge { .. }) => return Ok(Filled::Beyond),
        Err(_) => return Ok(Filled::Unknown),
    }
    let (half_x_m, half_y_m) = domain::contact_half_widths_m(domain);
    let loaded = (0..grid.cells()).filter(|&cell| pressure[cell] > 0.0);
    let parts = loaded.map(|cell| {
        let (x_m, y_m) = grid.center(cell);
        let along_x = (x_m.abs() + 0.5 * grid.spacing_x_m()) / half_x_m;
        let along_y = (y_m.abs() + 0.5 * grid.spacing_y_m()) / half_y_m;
        along_x.max(along_y)
    });
    Ok(parts.reduce(f64::max).map_or(Filled::Unknown, Filled::Part))
}
