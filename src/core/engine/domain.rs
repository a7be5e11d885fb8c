//! The cells of the half-space engine: from what an indenter says of its contact to a grid, larger at every attempt.
//!
//! A face that ends in a rim is a staircase on cells. With N of them, each of the area h^2, under it, the face is as stiff as one
//! of the radius h (sqrt(N/pi) - b), b = 0.1155: the pressure is singular at the rim, and constant on each cell. What an uneven
//! staircase adds to b has a standard deviation of 0.024 (h/a)^(1/2) on the half-space (discs of 6 to 120 cells in radius, centred
//! on the grid or not), and on a layer the rim sees the same half-space. So the cells under a face are those with their centre
//! within a + b h, and h is the next size above the one asked for with which these have the area of a disc of this radius.

use std::f64::consts::PI;

use crate::contact::half_space::grid::{Grid, GridError};
use crate::indenter::{Domain, Indenter, Rim};
use crate::numerics::threads::in_pieces;

/// Room beyond the largest contact expected, because the cells on the border must stay empty.
const CELL_ROOM: f64 = 1.1;

/// Each enlargement of a domain.
pub const GROWTH: f64 = 1.25;

/// By how much of a cell the disc with the area of the cells under a face is larger than the face that is as stiff.
const BEYOND_RIM: f64 = 0.1155;

/// Half widths (m) along x and y of a domain enlarged `growths` times.
fn half_widths_m(domain: &Domain, growths: usize) -> (f64, f64) {
    match *domain {
        Domain::Around {
            half_widths_m: (x_m, y_m),
            limit_m,
            ..
        } => {
            let (limit_x_m, limit_y_m) = limit_m.unwrap_or((f64::INFINITY, f64::INFINITY));
            let enlarged = |half_m: f64| half_m * CELL_ROOM * GROWTH.powi(growths as i32);
            (enlarged(x_m).min(limit_x_m), enlarged(y_m).min(limit_y_m))
        }
        Domain::Cells { cells, spacing_m } => (
            0.5 * cells.0 as f64 * spacing_m.0,
            0.5 * cells.1 as f64 * spacing_m.1,
        ),
    }
}

/// Half widths (m) along x and y of the contact that a domain is to hold.
pub fn contact_half_widths_m(domain: &Domain) -> (f64, f64) {
    match *domain {
        Domain::Around { half_widths_m, .. } => half_widths_m,
        Domain::Cells { .. } => half_widths_m(domain, 0),
    }
}

/// A domain this many times as wide, where the indenter does not bring cells of its own.
pub fn scaled(domain: &Domain, factor: f64) -> Domain {
    let mut scaled = *domain;
    if let Domain::Around { half_widths_m, .. } = &mut scaled {
        *half_widths_m = (half_widths_m.0 * factor, half_widths_m.1 * factor);
    }
    scaled
}

/// The larger half width (m) of a domain enlarged `growths` times.
pub fn half_width_m(domain: &Domain, growths: usize) -> f64 {
    let (x_m, y_m) = half_widths_m(domain, growths);
    x_m.max(y_m)
}

/// Whether another enlargement still enlarges the domain.
pub fn can_grow(domain: &Domain, growths: usize) -> bool {
    half_widths_m(domain, growths + 1) != half_widths_m(domain, growths)
}

/// Fewest cells along the shorter side of a domain: those on its border must stay empty.
pub const FEWEST_ACROSS: usize = 4;

/// Fewest cells along the longer side of a domain enlarged `growths` times that leave [`FEWEST_ACROSS`] along the shorter one; `None`
/// where the indenter brings cells of its own.
pub fn fewest_cells(domain: &Domain, growths: usize) -> Option<usize> {
    let Domain::Around {
        cell_aspect_ratio, ..
    } = *domain
    else {
        return None;
    };
    let (x_m, y_m) = half_widths_m(domain, growths);
    let (x, y) = (x_m / cell_aspect_ratio, y_m);
    let slenderness = x.max(y) / x.min(y);
    Some(((FEWEST_ACROSS - 1) as f64 * slenderness) as usize + 1)
}

/// The grid on a domain enlarged `growths` times: `cells` along the side that needs most of them, unless the indenter brings
/// cells of its own.
///
/// # Errors
/// [`GridError`], for example for cells that are too long and thin.
pub fn grid(domain: &Domain, cells: usize, growths: usize) -> Result<Grid, GridError> {
    match *domain {
        Domain::Cells { cells, spacing_m } => Grid::new(cells.0, cells.1, spacing_m.0, spacing_m.1),
        Domain::Around {
            cell_aspect_ratio, ..
        } => {
            let (x_m, y_m) = half_widths_m(domain, growths);
            // Lengths in units in which a cell is square.
            let (x, y) = (x_m / cell_aspect_ratio, y_m);
            let longest = x.max(y);
            let spacing = 2.0 * longest / cells as f64;
            let along = |length: f64| (cells as f64 * (length / longest)).ceil() as usize;
            Grid::new(along(x), along(y), cell_aspect_ratio * spacing, spacing)
        }
    }
}

/// The grid, with cells a little longer where the indenter has a rim: those under its face are then as stiff as the face.
///
/// # Errors
/// As [`Grid::new`].
pub fn fitted_to_rim(grid: Grid, indenter: &dyn Indenter) -> Result<Grid, GridError> {
    /// Sizes that are tried, and the change of the radius in cells from one to the next. One is found after four on the average,
    /// and after 24 at most, on 12 to 1000 cells.
    const TRIALS: usize = 64;
    const CHANGE: f64 = 0.02;
    let Some(rim) = indenter.rim() else {
        return Ok(grid);
    };
    let asked_m = grid.spacing_x_m();
    let fits = |trial: usize| {
        let radius = rim.radius_m / asked_m - CHANGE * trial as f64;
        let cells = cells_under(&grid, rim, rim.radius_m / radius);
        let spacing_m = rim.radius_m / ((cells as f64 / PI).sqrt() - BEYOND_RIM);
        let is_fit = spacing_m >= asked_m && cells_under(&grid, rim, spacing_m) == cells;
        is_fit.then_some(spacing_m)
    };
    match (0..TRIALS).find_map(fits) {
        Some(spacing_m) => Grid::new(grid.cells_x(), grid.cells_y(), spacing_m, spacing_m),
        None => Ok(grid),
    }
}

/// How many cells of this size (m) are under the face within a rim.
fn cells_under(grid: &Grid, rim: Rim, spacing_m: f64) -> usize {
    let radius = rim.radius_m / spacing_m + BEYOND_RIM;
    // Lengths in cells from the first cell's centre.
    let place = |center_m: f64, cells: usize| center_m / spacing_m + 0.5 * (cells as f64 - 1.0);
    let x = place(rim.center_x_m, grid.cells_x());
    let y = place(rim.center_y_m, grid.cells_y());
    let last = grid.cells_x() as f64 - 1.0;
    let in_row = |row: usize| {
        let squared = radius * radius - (row as f64 - y).powi(2);
        if squared < 0.0 {
            return 0.0;
        }
        let half = squared.sqrt();
        let (from, to) = ((x - half).ceil().max(0.0), (x + half).floor().min(last));
        (to - from + 1.0).max(0.0)
    };
    // A number of cells, exact as a float.
    (0..grid.cells_y()).map(in_row).sum::<f64>() as usize
}

/// The gap (m) that a cell with this centre stands for: the one at its centre, and of a cell that belongs to a face though its
/// centre is beyond the rim, the one at the rim.
fn gap_of_cell_m(indenter: &dyn Indenter, grid: &Grid, (x_m, y_m): (f64, f64)) -> f64 {
    let Some(rim) = indenter.rim() else {
        return indenter.gap_m(x_m, y_m);
    };
    let (from_x_m, from_y_m) = (x_m - rim.center_x_m, y_m - rim.center_y_m);
    let distance_m = from_x_m.hypot(from_y_m);
    let beyond_m = distance_m - rim.radius_m;
    if beyond_m <= 0.0 || beyond_m > BEYOND_RIM * grid.spacing_x_m() {
        return indenter.gap_m(x_m, y_m);
    }
    // Inside of the rim by more than rounding.
    let part = (1.0 - 1e-12) * rim.radius_m / distance_m;
    indenter.gap_m(
        rim.center_x_m + part * from_x_m,
        rim.center_y_m + part * from_y_m,
    )
}

/// The gap (m) of every cell: the one at its centre, but for the cells at a rim.
pub fn gaps_m(indenter: &dyn Indenter, grid: &Grid) -> Vec<f64> {
    let mut gap_m = vec![0.0; grid.cells()];
    in_pieces(grid.cells(), &mut gap_m[..], |cells, gap_m| {
        for (cell, gap_m) in cells.zip(gap_m) {
            *gap_m = gap_of_cell_m(indenter, grid, grid.center(cell));
        }
    });
    gap_m
}

/// The quarter of the grid, where the gap on it says everything: even in x and in y, to the last bit.
pub fn quarter_of(indenter: &dyn Indenter, grid: &Grid) -> Option<Grid> {
    let quarter = grid.quarter()?;
    let gap_m = |x_m, y_m| gap_of_cell_m(indenter, grid, (x_m, y_m));
    let even = (0..quarter.cells()).all(|cell| {
        let (x_m, y_m) = quarter.center(cell);
        let own_m = gap_m(x_m, y_m);
        let images = [(-x_m, y_m), (x_m, -y_m), (-x_m, -y_m)];
        images.iter().all(|&(x, y)| gap_m(x, y) == own_m)
    });
    even.then_some(quarter)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(x: f64, y: f64, aspect: f64, limit_m: Option<(f64, f64)>) -> Domain {
        Domain::Around {
            half_widths_m: (x, y),
            cell_aspect_ratio: aspect,
            limit_m,
        }
    }

    #[test]
    fn a_round_contact_gets_the_square_grid_bit_for_bit() {
        for (half, growths) in [(3.456_789e-4, 0), (1e-3 / 3.0, 2)] {
            let found = grid(&around(half, half, 1.0, None), 129, growths).unwrap();
            let half_width = half * 1.1 * 1.25_f64.powi(growths as i32);
            assert_eq!(found, Grid::square(129, 2.0 * half_width / 129.0).unwrap());
        }
    }

    #[test]
    fn an_elliptic_contact_gets_as_many_cells_along_both_axes() {
        let domain = around(3e-4, 1e-4, 3e-4 / 1e-4, None);
        let grid = grid(&domain, 64, 0).unwrap();
        assert_eq!((grid.cells_x(), grid.cells_y()), (64, 64));
        assert!((grid.spacing_x_m() / grid.spacing_y_m() - 3.0).abs() < 1e-14);
        assert!((32.0 * grid.spacing_x_m() / 3.3e-4 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_row_of_round_contacts_gets_square_cells_and_fewer_of_them_across() {
        let grid = grid(&around(4e-4, 1e-4, 1.0, None), 128, 0).unwrap();
        assert_eq!((grid.cells_x(), grid.cells_y()), (128, 32));
        assert_eq!(grid.spacing_x_m(), grid.spacing_y_m());
    }

    #[test]
    fn a_domain_grows_up_to_its_limit_and_cells_of_its_own_do_not() {
        let limited = around(1.0, 1.0, 1.0, Some((1.5, 1.5)));
        assert!(can_grow(&limited, 0) && can_grow(&limited, 1) && !can_grow(&limited, 2));
        assert_eq!(half_width_m(&limited, 2), 1.5);
        let own = Domain::Cells {
            cells: (8, 5),
            spacing_m: (0.5, 1.0),
        };
        assert!(!can_grow(&own, 0));
        assert_eq!(half_width_m(&own, 3), 2.5);
        assert_eq!(grid(&own, 99, 3).unwrap().cells_x(), 8);
    }
}
