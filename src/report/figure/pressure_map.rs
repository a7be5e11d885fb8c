//! The contact pressure over the surface as a heat map, blank outside the contact.

use std::borrow::Cow;

use super::Figure;
use super::quantity::PRESSURE;
use super::units::{Measure, Units};
use crate::contact::surface::{CellSurface, Surface};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, HeatMap};
use crate::report::number::{self, plain, scientific};
use crate::simulation::SurfaceRecord;

const NAME: &str = "pressure-map";

/// The map of the field with the largest pressure as `pressure-map`, and, where there are several fields, each as `pressure-map-<k>`,
/// all to one colour scale, each made when its turn comes; their data are `cases/fields/<k>-pressure_pa.npy`. None where no cells are
/// recorded.
///
/// # Errors
/// Why there is nothing to draw.
pub fn figures(
    records: &[SurfaceRecord],
    units: &Units,
) -> Result<impl Iterator<Item = Figure>, &'static str> {
    let fields = records
        .iter()
        .enumerate()
        .filter_map(|(k, record)| match &record.surface {
            Surface::Cells(cells) => Some((k, record.row.time_s, cells)),
            Surface::Radial(_) => None,
        });
    let fields: Vec<(usize, f64, &CellSurface)> = fields.collect();
    let by_pressure = |a: &&(usize, f64, &CellSurface), b: &&(usize, f64, &CellSurface)| {
        largest(a.2).total_cmp(&largest(b.2))
    };
    let most = fields.iter().max_by(by_pressure).copied();
    let peak = most.map_or(0.0, |(.., cells)| largest(cells));
    if most.is_some() && peak <= 0.0 {
        return Err("no pressure map: at no time asked for is there a contact");
    }
    let figure = move |name: Cow<'static, str>, time_s: f64, cells: &CellSurface| Figure {
        name,
        picture: chart(time_s, cells, peak, units).into(),
        caption: caption(time_s, cells),
        data: Vec::new(),
    };
    let each = (fields.len() > 1).then_some(fields).into_iter().flatten();
    let each = each.filter(|(.., cells)| largest(cells) > 0.0);
    let each = each.map(move |(k, time_s, cells)| figure(file(k).into(), time_s, cells));
    let most = most.map(|(_, time_s, cells)| figure(NAME.into(), time_s, cells));
    Ok(most.into_iter().chain(each))
}

/// The largest pressure (Pa).
fn largest(cells: &CellSurface) -> f64 {
    number::largest(cells.pressure_pa.iter().copied())
}

/// The map of the field `k`, without its ending.
pub fn file(k: usize) -> String {
    format!("{NAME}-{k}")
}

fn caption(time_s: f64, cells: &CellSurface) -> Caption {
    Caption::new(format!(
        "Contact pressure p over the surface at t = {} s, blank outside the contact",
        scientific(time_s, 4)
    ))
    .say(format!(
        "Largest: {}.",
        plain(largest(cells), Dimension::Stress, 4)
    ))
}

fn chart(time_s: f64, cells: &CellSurface, peak_pa: f64, units: &Units) -> Chart {
    let grid = &cells.grid;
    let half = (
        0.5 * grid.cells_x() as f64 * grid.spacing_x_m(),
        0.5 * grid.cells_y() as f64 * grid.spacing_y_m(),
    );
    let length = units.shown(Measure::Length, half.0.max(half.1));
    let pressure = units.shown(PRESSURE.measure, peak_pa);
    let value = |p: &f64| (*p > 0.0).then(|| pressure.of(*p));
    let map = HeatMap {
        columns: grid.cells_x(),
        rows: grid.cells_y(),
        values: cells.pressure_pa.iter().map(value).collect(),
        value_label: pressure.title(&PRESSURE.words),
        value_range: Some((0.0, pressure.of(peak_pa))),
        ..HeatMap::default()
    };
    let axis = |name: &str, half: f64| {
        Axis::linear(length.title(name)).range(length.of(-half), length.of(half))
    };
    // From a second on, so that times stay in seconds.
    let time = units.shown(Measure::Time, 1.0);
    let at = scientific(time.of(time_s), 4);
    Chart::new(axis("x", half.0), axis("y", half.1))
        .title(format!("t = {at} {}", time.unit))
        .map(map)
}
