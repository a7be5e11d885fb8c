//! The cells of the half-space engine: from what an indenter says of its contact to a grid, larger at every attempt.

use crate::contact::half_space::grid::{Grid, GridError};
use crate::indenter::{Domain, Indenter};

/// Room beyond the largest contact expected, because the cells on the border must stay empty.
const CELL_ROOM: f64 = 1.1;

/// Each enlargement of a domain.
pub const GROWTH: f64 = 1.25;

/// Half widths (m) along x and y of a domain enlarged `growths` times.
fn half_widths_m(domain: &Domain, growths: usize) -> (f64, f64) {
    match *domain {
        Domain::Around {
            half_width_x_m,
            half_width_y_m,
            limit_m,
            ..
        } => {
            let (limit_x_m, limit_y_m) = limit_m.unwrap_or((f64::INFINITY, f64::INFINITY));
            let enlarged = |half_m: f64| half_m * CELL_ROOM * GROWTH.powi(growths as i32);
            (
                enlarged(half_width_x_m).min(limit_x_m),
                enlarged(half_width_y_m).min(limit_y_m),
            )
        }
        Domain::Cells {
            cells_x,
            cells_y,
            spacing_x_m,
            spacing_y_m,
        } => (
            0.5 * cells_x as f64 * spacing_x_m,
            0.5 * cells_y as f64 * spacing_y_m,
        ),
    }
}

/// Half widths (m) along x and y of the contact that a domain is to hold.
pub fn contact_half_widths_m(domain: &Domain) -> (f64, f64) {
    match *domain {
        Domain::Around {
            half_width_x_m,
            half_width_y_m,
            ..
        } => (half_width_x_m, half_width_y_m),
        Domain::Cells { .. } => half_widths_m(domain, 0),
    }
}

/// A domain this many times as wide, where the indenter does not bring cells of its own.
pub fn scaled(domain: &Domain, factor: f64) -> Domain {
    let mut scaled = *domain;
    if let Domain::Around {
        half_width_x_m,
        half_width_y_m,
        ..
    } = &mut scaled
    {
        *half_width_x_m *= factor;
        *half_width_y_m *= factor;
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

/// The grid on a domain enlarged `growths` times: `cells` along the side that needs most of them, unless the indenter brings
/// cells of its own.
///
/// # Errors
/// [`GridError`], for example for cells that are too long and thin.
pub fn grid(domain: &Domain, cells: usize, growths: usize) -> Result<Grid, GridError> {
    match *domain {
        Domain::Cells {
            cells_x,
            cells_y,
            spacing_x_m,
            spacing_y_m,
        } => Grid::new(cells_x, cells_y, spacing_x_m, spacing_y_m),
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

/// The gap (m) at the centre of every cell.
pub fn gaps_m(indenter: &dyn Indenter, grid: &Grid) -> Vec<f64> {
    let gap = |cell| {
        let (x_m, y_m) = grid.center(cell);
        indenter.gap_m(x_m, y_m)
    };
    (0..grid.cells()).map(gap).collect()
}

/// The quarter of the grid, where the gap on it says everything: even in x and in y, to the last bit.
pub fn quarter_of(indenter: &dyn Indenter, grid: &Grid) -> Option<Grid> {
    let quarter = grid.quarter()?;
    let even = (0..quarter.cells()).all(|cell| {
        let (x_m, y_m) = quarter.center(cell);
        let gap_m = indenter.gap_m(x_m, y_m);
        let images = [(-x_m, y_m), (x_m, -y_m), (-x_m, -y_m)];
        images.iter().all(|&(x, y)| indenter.gap_m(x, y) == gap_m)
    });
    even.then_some(quarter)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(x: f64, y: f64, aspect: f64, limit_m: Option<(f64, f64)>) -> Domain {
        Domain::Around {
            half_width_x_m: x,
            half_width_y_m: y,
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
            cells_x: 8,
            cells_y: 5,
            spacing_x_m: 0.5,
            spacing_y_m: 1.0,
        };
        assert!(!can_grow(&own, 0));
        assert_eq!(half_width_m(&own, 3), 2.5);
        assert_eq!(grid(&own, 99, 3).unwrap().cells_x(), 8);
    }
}
