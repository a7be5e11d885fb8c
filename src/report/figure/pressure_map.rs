//! The contact pressure over the surface as a heat map, blank outside the contact.

use super::{WriteFile, prefix, scientific, write_picture};
use crate::contact::surface::{CellSurface, Surface};
use crate::report::ReportError;
use crate::report::chart::{HeatMap, MapShape, Scale, heat_map_to_svg};
use crate::sweep::simulate::SurfaceRecord;

const NAME: &str = "pressure-map";
const WIDTH_PX: u32 = 800;

/// Writes the map of the field with the largest pressure as `pressure-map`, and, where there are several fields, each as
/// `fields/<k>-pressure-map`, all to one colour scale. Its data are `fields/<k>-pressure_pa.npy`. Returns why where there is
/// nothing to draw, nothing where nothing was asked for.
///
/// # Errors
/// [`ReportError`] naming the figure.
pub fn write(
    records: &[SurfaceRecord],
    write: &WriteFile<'_>,
) -> Result<Option<String>, ReportError> {
    let fields: Vec<(usize, f64, &CellSurface)> = records
        .iter()
        .enumerate()
        .filter_map(|(k, record)| match &record.surface {
            Surface::Cells(cells) => Some((k, record.row.time_s, cells)),
            Surface::Radial(_) => None,
        })
        .collect();
    let largest = |cells: &CellSurface| cells.pressure_pa.iter().copied().fold(0.0, f64::max);
    let by_pressure = |a: &&(usize, f64, &CellSurface), b: &&(usize, f64, &CellSurface)| {
        largest(a.2).total_cmp(&largest(b.2))
    };
    let Some(&(_, time_s, cells)) = fields.iter().max_by(by_pressure) else {
        return Ok(None);
    };
    let peak = largest(cells);
    if peak <= 0.0 {
        return Ok(Some(
            "no pressure map: at no time asked for is there a contact".to_owned(),
        ));
    }
    write_map(NAME, time_s, cells, peak, write)?;
    for &(k, time_s, cells) in &fields {
        if fields.len() > 1 && largest(cells) > 0.0 {
            write_map(&format!("fields/{k}-{NAME}"), time_s, cells, peak, write)?;
        }
    }
    Ok(None)
}

fn write_map(
    file: &str,
    time_s: f64,
    cells: &CellSurface,
    peak_pa: f64,
    write: &WriteFile<'_>,
) -> Result<(), ReportError> {
    let svg = heat_map_to_svg(&map(time_s, cells, peak_pa))
        .map_err(|source| ReportError::Chart { name: NAME, source })?;
    write_picture(file, NAME, &svg, write)
}

fn map(time_s: f64, cells: &CellSurface, peak_pa: f64) -> HeatMap {
    let grid = &cells.grid;
    let half = (
        0.5 * grid.cells_x() as f64 * grid.spacing_x_m(),
        0.5 * grid.cells_y() as f64 * grid.spacing_y_m(),
    );
    let (to_length, length) = prefix(half.0.max(half.1));
    let (to_pressure, pressure) = prefix(peak_pa);
    let value = |p: &f64| (*p > 0.0).then_some(to_pressure * p);
    HeatMap {
        title: Some(format!("t = {} s", scientific(time_s, 4))),
        x_label: format!("x / {length}m"),
        y_label: format!("y / {length}m"),
        x_range: (-to_length * half.0, to_length * half.0),
        y_range: (-to_length * half.1, to_length * half.1),
        x_scale: Scale::Linear,
        y_scale: Scale::Linear,
        columns: grid.cells_x(),
        rows: grid.cells_y(),
        values: cells.pressure_pa.iter().map(value).collect(),
        value_label: format!("pressure p / {pressure}Pa"),
        value_range: Some((0.0, to_pressure * peak_pa)),
        value_scale: Scale::Linear,
        contours: false,
        points: Vec::new(),
        rings: Vec::new(),
        width_px: WIDTH_PX,
        shape: MapShape::ToScale,
    }
}
