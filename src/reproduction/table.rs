//! Rows of named quantities.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::contact::surface::{Along, PressureLine, Surface};
use crate::simulation::HistoryRow;

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Quantity {
    /// In tau (or s); of a cycle as a part of it.
    #[default]
    Time,
    /// f = omega tau / 2 pi.
    Frequency,
    /// In rad/s.
    AngularFrequency,
    Load,
    Approach,
    ContactRadius,
    PeakPressure,
    /// In MPa, as a contact that does not change shows it: in proportion to the load.
    RelaxationModulus,
    /// From the axis.
    Radius,
    Pressure,
    Displacement,
    /// The energy in W0 delta_H.
    Loss,
    /// Dissipated by a cycle, or put into a history (J).
    Energy,
    /// The energy over the largest.
    Share,
}

/// What is undefined is missing.
pub(super) type Row = BTreeMap<Quantity, f64>;

pub(super) fn row<const N: usize>(values: [(Quantity, Option<f64>); N]) -> Row {
    let values = values.into_iter();
    values
        .filter_map(|(of, value)| Some((of, value?)))
        .collect()
}

/// An instant, in SI units.
pub(super) fn instant(instant: &HistoryRow) -> Row {
    row([
        (Quantity::Time, Some(instant.time_s)),
        (Quantity::Load, Some(instant.load_n)),
        (Quantity::Approach, instant.approach_m),
        (Quantity::ContactRadius, Some(instant.contact_radius_m)),
        (Quantity::PeakPressure, instant.peak_pressure_pa),
    ])
}

fn point(radius_m: f64, pressure_pa: Option<f64>, displacement_m: Option<f64>) -> Row {
    row([
        (Quantity::Radius, Some(radius_m)),
        (Quantity::Pressure, pressure_pa),
        (Quantity::Displacement, displacement_m),
    ])
}

/// A surface from the axis outwards in SI units: along the radius, or over the cells of the row beside the middle.
pub(super) fn surface(surface: &Surface) -> Vec<Row> {
    match surface {
        Surface::Radial(radial) => {
            let values = radial.pressure_pa.iter().zip(&radial.displacement_m);
            let points = radial.radius_m.iter().zip(values);
            points.map(|(r, (p, u))| point(*r, *p, Some(*u))).collect()
        }
        Surface::Cells(cells) => {
            let (width, row) = (cells.grid.cells_x(), cells.grid.cells_y() / 2);
            let row = row * width + width / 2..(row + 1) * width;
            row.map(|cell| {
                let (x_m, y_m) = cells.grid.center(cell);
                let values = (cells.pressure_pa[cell], cells.displacement_m[cell]);
                point(x_m.hypot(y_m), Some(values.0), Some(values.1))
            })
            .collect()
        }
    }
}

/// The pressure along a line, likewise; on cells it is the mean of the two rows beside the middle, half a cell from the axis.
pub(super) fn pressure(line: &PressureLine) -> Vec<Row> {
    let aside_m = match (line.along, &line.position_m[..]) {
        (Along::X | Along::Y, [first, second, ..]) => 0.5 * (second - first),
        _ => 0.0,
    };
    let places = line.position_m.iter().zip(&line.pressure_pa);
    let outwards = places.filter(|(position_m, _)| **position_m >= 0.0);
    let points = outwards.map(|(x_m, pa)| point(x_m.hypot(aside_m), *pa, None));
    points.collect()
}

/// y at this x, linear between rows; before the first row that of the first. `None` beyond the last, and beside a row where y is
/// undefined.
pub(super) fn at(rows: &[Row], [x, y]: [Quantity; 2], place: f64) -> Option<f64> {
    let same = 1e-9 * place.abs();
    let is_next = |row: &Row| row.get(&x).is_some_and(|x| *x >= place - same);
    let next = rows.iter().position(is_next)?;
    let (to_x, to_y) = (rows[next].get(&x)?, *rows[next].get(&y)?);
    if next == 0 || *to_x <= place + same {
        return Some(to_y);
    }
    let (from_x, from_y) = (rows[next - 1].get(&x)?, rows[next - 1].get(&y)?);
    Some(from_y + (place - from_x) / (to_x - from_x) * (to_y - from_y))
}

/// x and y of the rows that have both.
pub(super) fn points(rows: &[Row], [x, y]: [Quantity; 2]) -> Vec<(f64, f64)> {
    let point = |row: &Row| Some((*row.get(&x)?, *row.get(&y)?));
    rows.iter().filter_map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_undefined_in_a_row_is_undefined_beside_it() {
        let rows = [(0.25, Some(3.0)), (0.5, Some(1.0)), (0.75, None)];
        let rows = rows.map(|(radius, pressure)| point(radius, pressure, Some(1.0)));
        let axes = [Quantity::Radius, Quantity::Pressure];
        let pressure = |radius: f64| at(&rows, axes, radius);
        assert_eq!(
            [0.0, 0.375, 0.5, 0.625, 1.0].map(pressure),
            [Some(3.0), Some(2.0), Some(1.0), None, None]
        );
        let displacement = at(&rows, [Quantity::Radius, Quantity::Displacement], 0.625);
        assert_eq!(displacement, Some(1.0));
        assert_eq!(points(&rows, axes), [(0.25, 3.0), (0.5, 1.0)]);
    }
}
