//! How large a contact is, to a part of a cell.
//!
//! The number of cells under pressure is too large by about a ninth of the length of the contact's edge, in cells: an error of
//! first order (Yastrebov, Anciaux and Molinari, Tribology International 114, 2017, correct its mean). Here the edge is found
//! between the cells instead. Near the edge of a smooth contact the pressure falls like the root of the distance to it, so its
//! square is a straight line; through the outermost two cells in contact, along a row or a column, that line tells where the
//! edge is. Rows and columns each give the area; their mean is taken.

use super::super::grid::Grid;
use super::frame::Frame;

/// Cells that a row of them in contact must have for its ends to be distinguished from its middle.
const FEWEST_CELLS: usize = 4;

/// The area under pressure, in cells of the grid (on a mirrored one, of the quarter). `pressure` is that in the window `frame`,
/// beyond which there is none.
pub(super) fn contact_area_cells(grid: &Grid, frame: &Frame, pressure: &[f64]) -> f64 {
    let (nx, ny) = (frame.cells_x, frame.cells_y);
    // The neighbour of the first cell of a mirrored field, across the axis, is that cell again.
    let axes = grid.is_mirrored();
    let (axis_x, axis_y) = (axes && frame.x == 0, axes && frame.y == 0);
    let mut area = 0.0;
    for (iy, row) in pressure.chunks_exact(nx).enumerate() {
        let column_at = |ix: usize| {
            move |at: isize| along(at, ny, axis_y).map_or(0.0, |at| pressure[at * nx + ix])
        };
        let row_at = |at: isize| along(at, nx, axis_x).map_or(0.0, |at| row[at]);
        for (ix, &p) in row.iter().enumerate() {
            if p > 0.0 {
                let ends = ends_at(ix, row_at) + ends_at(iy, column_at(ix));
                area += 1.0 + 0.5 * ends;
            }
        }
    }
    area
}

/// The index that a cell of this position has among `n`, of which the first may lie at an axis of symmetry.
fn along(at: isize, n: usize, axis: bool) -> Option<usize> {
    let at = if axis && at < 0 { -1 - at } else { at };
    usize::try_from(at).ok().filter(|at| *at < n)
}

/// What the ends of the contact at this cell of a line, on either side, add to its length in cells.
fn ends_at(at: usize, pressure: impl Fn(isize) -> f64) -> f64 {
    let at = at as isize;
    let end = |outwards: isize| {
        let inwards = |k: usize| pressure(at - outwards * k as isize);
        let is_end = pressure(at + outwards) <= 0.0 && (1..FEWEST_CELLS).all(|k| inwards(k) > 0.0);
        if is_end {
            beyond_face(inwards(0), inwards(1))
        } else {
            0.0
        }
    };
    end(1) + end(-1)
}

/// How far the edge lies beyond the outer face of the outermost cell in contact, in cells, from that cell's pressure and the
/// next one's. It lies between the centre of that cell and that of the first cell out of contact; a pressure that does not fall
/// towards the edge, as under a rim, ends with the cell.
fn beyond_face(outermost: f64, next: f64) -> f64 {
    let share = (outermost / next).powi(2);
    if share >= 1.0 {
        return 0.0;
    }
    (share / (1.0 - share) - 0.5).clamp(-0.5, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A Hertzian pressure on a disc with this centre, in cells from the centre of the grid, sampled at the cells' centres.
    fn pressure_on_disc(grid: &Grid, radius: f64, (x, y): (f64, f64)) -> Vec<f64> {
        let squared = |cell| {
            let (cx, cy) = grid.center(cell);
            radius * radius - (cx - x).powi(2) - (cy - y).powi(2)
        };
        let cells = 0..grid.cells();
        cells.map(|cell| squared(cell).max(0.0).sqrt()).collect()
    }

    fn radius(grid: &Grid, pressure: &[f64]) -> f64 {
        let area = contact_area_cells(grid, &Frame::whole(grid), pressure);
        (area * grid.copies() as f64 / std::f64::consts::PI).sqrt()
    }

    #[test]
    fn a_disc_is_as_large_as_it_is_wherever_it_lies() {
        let grid = Grid::square(128, 1.0).unwrap();
        for (k, size) in [20.0, 33.3, 47.9, 55.1].into_iter().enumerate() {
            let centre = (0.37 * k as f64, -0.21 * k as f64);
            let pressure = pressure_on_disc(&grid, size, centre);
            let found = radius(&grid, &pressure);
            // A straight line in place of a circle's parabola over one cell is wrong by 1/(2 R) of a cell; the rows about
            // the poles, too short to be judged, add as much.
            assert!((found - size).abs() < 1.0 / size, "{size}: {found}");
        }
    }

    #[test]
    fn a_quarter_has_a_quarter_of_the_area_and_a_window_all_of_it() {
        let grid = Grid::square(64, 1.0).unwrap();
        let quarter = grid.quarter().unwrap();
        for size in [1.2, 2.2, 3.4, 12.7, 25.0] {
            let whole = pressure_on_disc(&grid, size, (0.0, 0.0));
            let part = pressure_on_disc(&quarter, size, (0.0, 0.0));
            // The same cells, summed in another order.
            assert!((radius(&grid, &whole) - radius(&quarter, &part)).abs() < 1e-13);
            let frame = Frame {
                x: 5,
                y: 4,
                cells_x: 56,
                cells_y: 55,
            };
            let mut inside = vec![0.0; frame.cells()];
            frame.gather(&whole, 64, &mut inside);
            let windowed = contact_area_cells(&grid, &frame, &inside);
            let all = contact_area_cells(&grid, &Frame::whole(&grid), &whole);
            assert_eq!(windowed, all);
        }
    }

    #[test]
    fn a_uniform_pressure_and_a_few_cells_are_counted() {
        let grid = Grid::square(8, 1.0).unwrap();
        let mut pressure = vec![0.0; 64];
        assert_eq!(
            contact_area_cells(&grid, &Frame::whole(&grid), &pressure),
            0.0
        );
        for (iy, row) in pressure.chunks_exact_mut(8).enumerate() {
            if (1..7).contains(&iy) {
                row[1..6].fill(2.0);
            }
        }
        assert_eq!(
            contact_area_cells(&grid, &Frame::whole(&grid), &pressure),
            30.0
        );
        let mut few = vec![0.0; 64];
        few[27] = 1.0;
        few[28] = 3.0;
        few[29] = 1.0;
        assert_eq!(contact_area_cells(&grid, &Frame::whole(&grid), &few), 3.0);
    }

    #[test]
    fn the_edge_lies_where_the_squared_pressure_vanishes() {
        for distance in [0.05_f64, 0.3, 0.5, 0.8, 0.99] {
            // The outermost centre lies so far inside the edge.
            let found = beyond_face(distance.sqrt(), (1.0 + distance).sqrt());
            assert!((found - (distance - 0.5)).abs() < 1e-14, "{distance}");
        }
        assert_eq!(beyond_face(2.0, 1.0), 0.0);
        assert_eq!(beyond_face(0.99, 1.0), 0.5);
    }
}
