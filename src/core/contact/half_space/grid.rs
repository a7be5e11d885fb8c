//! The surface grid: equal rectangular cells centred on the origin, row-major.
//!
//! Cell `(ix, iy)` has the index `iy * cells_x + ix` and its centre at
//! `((ix - (cells_x - 1) / 2) * spacing_x, (iy - (cells_y - 1) / 2) * spacing_y)`, so an odd number of cells puts a
//! centre on the origin and an even number puts a cell edge there.
//!
//! Of a surface that is even in x and in y a quarter says everything: a mirrored grid is that quarter, its first cell's corner
//! on the origin, and each of its cells stands for four.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Most cells a grid may have: 2^26, that is 8192 x 8192, whose fields take 0.5 GiB each.
pub const MAX_CELLS: usize = 1 << 26;

/// Most that the longer side of a cell may exceed the shorter one by.
pub const MAX_ASPECT_RATIO: f64 = 1000.0;

/// Why a grid cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum GridError {
    /// One direction has no cells, or both together have more than [`MAX_CELLS`].
    #[error(
        "cannot build a grid of {cells_x} x {cells_y} cells: give at least 1 cell per direction and at most \
         {MAX_CELLS} cells in all"
    )]
    Cells {
        /// Cells asked for along x.
        cells_x: usize,
        /// Cells asked for along y.
        cells_y: usize,
    },
    /// A spacing is not a positive finite length, or the cell's area leaves the range of floating-point numbers.
    #[error(
        "cannot build a grid with a cell of {spacing_x_m:?} m x {spacing_y_m:?} m: give two positive, finite lengths \
         whose product is neither zero nor infinite"
    )]
    Spacing {
        /// Cell side asked for along x, m.
        spacing_x_m: f64,
        /// Cell side asked for along y, m.
        spacing_y_m: f64,
    },
    /// The cells are needles, with which no pressure field is resolved.
    #[error(
        "cannot build a grid with a cell of {spacing_x_m:?} m x {spacing_y_m:?} m: give sides that differ by at most a \
         factor of {MAX_ASPECT_RATIO}"
    )]
    AspectRatio {
        /// Cell side asked for along x, m.
        spacing_x_m: f64,
        /// Cell side asked for along y, m.
        spacing_y_m: f64,
    },
}

/// A grid of equal rectangular cells centred on the origin; fields on it are slices of [`Grid::cells`] values, row by row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(into = "Parts", try_from = "Parts")]
pub struct Grid {
    cells_x: usize,
    cells_y: usize,
    spacing_x_m: f64,
    spacing_y_m: f64,
    /// Whether it is the quarter with x > 0 and y > 0 of a surface even in both.
    mirrored: bool,
}

/// What a grid is made of, in the order of its fields.
type Parts = (usize, usize, f64, f64, bool);

impl From<Grid> for Parts {
    fn from(grid: Grid) -> Self {
        let (x_m, y_m) = (grid.spacing_x_m, grid.spacing_y_m);
        (grid.cells_x, grid.cells_y, x_m, y_m, grid.mirrored)
    }
}

impl TryFrom<Parts> for Grid {
    type Error = GridError;

    fn try_from((cells_x, cells_y, x_m, y_m, mirrored): Parts) -> Result<Self, GridError> {
        let grid = Self::new(cells_x, cells_y, x_m, y_m)?;
        Ok(Self { mirrored, ..grid })
    }
}

impl Grid {
    /// A grid of `cells_x` by `cells_y` cells with the sides `spacing_x_m` and `spacing_y_m` (m).
    ///
    /// # Errors
    /// [`GridError`] if a direction has no cells, there are more than [`MAX_CELLS`], a spacing is not a positive finite
    /// length, or the sides differ by more than [`MAX_ASPECT_RATIO`].
    pub fn new(
        cells_x: usize,
        cells_y: usize,
        spacing_x_m: f64,
        spacing_y_m: f64,
    ) -> Result<Self, GridError> {
        match cells_x.checked_mul(cells_y) {
            Some(1..=MAX_CELLS) => {}
            _ => return Err(GridError::Cells { cells_x, cells_y }),
        }
        let positive = spacing_x_m > 0.0 && spacing_y_m > 0.0;
        if !positive || !(spacing_x_m * spacing_y_m).is_normal() {
            return Err(GridError::Spacing {
                spacing_x_m,
                spacing_y_m,
            });
        }
        if spacing_x_m.max(spacing_y_m) / spacing_x_m.min(spacing_y_m) > MAX_ASPECT_RATIO {
            return Err(GridError::AspectRatio {
                spacing_x_m,
                spacing_y_m,
            });
        }
        Ok(Self {
            cells_x,
            cells_y,
            spacing_x_m,
            spacing_y_m,
            mirrored: false,
        })
    }

    /// A square grid: `cells_per_side` square cells of side `spacing_m` (m) in both directions.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn square(cells_per_side: usize, spacing_m: f64) -> Result<Self, GridError> {
        Self::new(cells_per_side, cells_per_side, spacing_m, spacing_m)
    }

    /// Cells along x, that is per row.
    pub fn cells_x(&self) -> usize {
        self.cells_x
    }

    /// Cells along y, that is the number of rows.
    pub fn cells_y(&self) -> usize {
        self.cells_y
    }

    /// Side of a cell along x, m.
    pub fn spacing_x_m(&self) -> f64 {
        self.spacing_x_m
    }

    /// Side of a cell along y, m.
    pub fn spacing_y_m(&self) -> f64 {
        self.spacing_y_m
    }

    /// Number of cells: the length of every field on this grid.
    pub fn cells(&self) -> usize {
        self.cells_x * self.cells_y
    }

    /// Area of one cell, m^2.
    pub fn cell_area_m2(&self) -> f64 {
        self.spacing_x_m * self.spacing_y_m
    }

    /// A grid of this many of its cells along either side, at most of all.
    pub(super) fn part(&self, cells_x: usize, cells_y: usize) -> Self {
        Self {
            cells_x: cells_x.clamp(1, self.cells_x),
            cells_y: cells_y.clamp(1, self.cells_y),
            ..*self
        }
    }

    /// As many cells of the same shape and of length 1 along x. Their ratio loses the last five bits, a few units in the last place of
    /// what is made of it, so that grids of one shape have the same, however long their cells.
    pub(super) fn in_cells(&self) -> Self {
        const LOST: u64 = 1 << 5;
        let ratio = (self.spacing_y_m / self.spacing_x_m).to_bits();
        Self {
            spacing_x_m: 1.0,
            spacing_y_m: f64::from_bits((ratio + LOST / 2) / LOST * LOST),
            ..*self
        }
    }

    /// The quarter with x > 0 and y > 0, which holds all of a field that is even in x and in y; `None` where a row or column of
    /// cells lies on an axis.
    pub fn quarter(&self) -> Option<Self> {
        let even = self.cells_x.is_multiple_of(2) && self.cells_y.is_multiple_of(2);
        (even && !self.mirrored).then_some(Self {
            cells_x: self.cells_x / 2,
            cells_y: self.cells_y / 2,
            mirrored: true,
            ..*self
        })
    }

    /// Whether it is such a quarter.
    pub fn is_mirrored(&self) -> bool {
        self.mirrored
    }

    /// How many cells of the surface each of its cells stands for: 4 or 1.
    pub fn copies(&self) -> usize {
        if self.mirrored { 4 } else { 1 }
    }

    /// The grid of the whole surface.
    pub fn whole(&self) -> Self {
        match self.mirrored {
            true => Self {
                cells_x: 2 * self.cells_x,
                cells_y: 2 * self.cells_y,
                mirrored: false,
                ..*self
            },
            false => *self,
        }
    }

    /// A field of this grid on [`Grid::whole`].
    pub fn unfolded(&self, field: &[f64]) -> Vec<f64> {
        if !self.mirrored {
            return field.to_vec();
        }
        let mut whole = Vec::with_capacity(4 * field.len());
        let rows = field.chunks_exact(self.cells_x);
        for row in rows.clone().rev().chain(rows) {
            whole.extend(row.iter().rev().chain(row));
        }
        whole
    }

    /// The row through the centre of the whole surface: x (m) of each place on it, and the two cells of this grid whose mean is the
    /// value there. Those are of the two rows beside the x axis; one and the same where a row lies on it, or mirrors the other.
    pub fn centre_row(&self) -> Vec<(f64, [usize; 2])> {
        let whole = self.whole();
        let rows = middle(whole.cells_y);
        let place = |ix| (whole.x_m(ix), rows.map(|iy| self.cell_at(ix, iy)));
        (0..whole.cells_x).map(place).collect()
    }

    /// The column through the centre, as [`Grid::centre_row`]: y (m) of each place.
    pub fn centre_column(&self) -> Vec<(f64, [usize; 2])> {
        let whole = self.whole();
        let columns = middle(whole.cells_x);
        let place = |iy| (whole.y_m(iy), columns.map(|ix| self.cell_at(ix, iy)));
        (0..whole.cells_y).map(place).collect()
    }

    /// The cell of this grid that holds the value of a cell of [`Grid::whole`].
    fn cell_at(&self, ix: usize, iy: usize) -> usize {
        let folded = |i: usize, n: usize| match self.mirrored {
            true if i < n => n - 1 - i,
            true => i - n,
            false => i,
        };
        folded(iy, self.cells_y) * self.cells_x + folded(ix, self.cells_x)
    }

    /// x of the centres of column `ix`, m. Columns outside the grid continue it.
    pub fn x_m(&self, ix: usize) -> f64 {
        self.position(ix, self.cells_x) * self.spacing_x_m
    }

    /// y of the centres of row `iy`, m. Rows outside the grid continue it.
    pub fn y_m(&self, iy: usize) -> f64 {
        self.position(iy, self.cells_y) * self.spacing_y_m
    }

    /// Position of cell `i` of `n` from the origin, in cells. Half integers are exact, so the grid is exactly symmetric.
    fn position(&self, i: usize, n: usize) -> f64 {
        match self.mirrored {
            true => i as f64 + 0.5,
            false => i as f64 - 0.5 * (n as f64 - 1.0),
        }
    }

    /// Centre `(x, y)` of the cell with this index, m.
    pub fn center(&self, index: usize) -> (f64, f64) {
        (
            self.x_m(index % self.cells_x),
            self.y_m(index / self.cells_x),
        )
    }
}

/// The two rows beside the middle of `n`, which are one where `n` is odd.
fn middle(n: usize) -> [usize; 2] {
    [(n - 1) / 2, n / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_odd_grid_has_a_centre_on_the_origin_and_an_even_one_an_edge() {
        let odd = Grid::square(5, 0.1).unwrap();
        assert_eq!(odd.center(12), (0.0, 0.0));
        let even = Grid::new(4, 2, 2.0, 3.0).unwrap();
        assert_eq!(even.center(1), (-1.0, -1.5));
        assert_eq!(even.center(2), (1.0, -1.5));
        assert_eq!(even.center(7), (3.0, 1.5));
    }

    #[test]
    fn centres_are_mirrored_exactly() {
        for n in [1, 2, 7, 64, 129] {
            let grid = Grid::new(n, n + 1, 1.0e-6 / 3.0, 0.7e-6).unwrap();
            for i in 0..n {
                assert_eq!(grid.x_m(i), -grid.x_m(n - 1 - i));
            }
            for i in 0..=n {
                assert_eq!(grid.y_m(i), -grid.y_m(n - i));
            }
        }
    }

    #[test]
    fn a_quarter_has_the_cells_of_the_whole_and_unfolds_to_it() {
        let whole = Grid::new(6, 4, 0.3, 0.7).unwrap();
        let quarter = whole.quarter().unwrap();
        assert_eq!((quarter.cells(), quarter.copies()), (6, 4));
        assert_eq!(quarter.whole(), whole);
        let even = |(x, y): (f64, f64)| x.abs() + 10.0 * y.abs();
        let field: Vec<f64> = (0..6).map(|cell| even(quarter.center(cell))).collect();
        let expected: Vec<f64> = (0..24).map(|cell| even(whole.center(cell))).collect();
        assert_eq!(quarter.unfolded(&field), expected);
        assert_eq!(whole.unfolded(&expected), expected);
        assert_eq!(Grid::new(5, 4, 1.0, 1.0).unwrap().quarter(), None);
        assert_eq!(quarter.quarter(), None);
    }

    #[test]
    fn the_lines_through_the_centre_are_those_of_the_whole_surface_on_a_quarter_too() {
        // Linear in |y|: the mean of the rows beside the axis is the value half a cell from it.
        let value = |(x, y): (f64, f64)| x * x + 10.0 * y.abs();
        let on = |line: Vec<(f64, [usize; 2])>, grid: &Grid| -> Vec<(f64, f64)> {
            let mean = |[a, b]: [usize; 2]| 0.5 * (value(grid.center(a)) + value(grid.center(b)));
            line.into_iter()
                .map(|(at, cells)| (at, mean(cells)))
                .collect()
        };
        for (cells_x, cells_y) in [(6, 4), (6, 3), (5, 4), (5, 3), (1, 1), (2, 2)] {
            let grid = Grid::new(cells_x, cells_y, 1.0, 2.0).unwrap();
            let beside = |cells: usize, spacing: f64| {
                [0.0, 0.5 * spacing][usize::from(cells.is_multiple_of(2))]
            };
            let row = (0..cells_x).map(|ix| grid.x_m(ix));
            let row: Vec<_> = row.map(|x| (x, value((x, beside(cells_y, 2.0))))).collect();
            let column = (0..cells_y).map(|iy| grid.y_m(iy));
            let column: Vec<_> = column
                .map(|y| (y, value((beside(cells_x, 1.0), y))))
                .collect();
            for grid in [Some(grid), grid.quarter()].into_iter().flatten() {
                assert_eq!(on(grid.centre_row(), &grid), row, "{grid:?}");
                assert_eq!(on(grid.centre_column(), &grid), column, "{grid:?}");
            }
        }
    }

    #[test]
    fn the_index_runs_along_x_first() {
        let grid = Grid::new(3, 4, 1.0, 10.0).unwrap();
        assert_eq!(grid.cells(), 12);
        assert_eq!(grid.cell_area_m2(), 10.0);
        for iy in 0..4 {
            for ix in 0..3 {
                assert_eq!(grid.center(iy * 3 + ix), (grid.x_m(ix), grid.y_m(iy)));
            }
        }
    }

    #[test]
    fn a_grid_without_cells_or_with_too_many_is_refused() {
        for (cells_x, cells_y) in [
            (0, 4),
            (4, 0),
            (MAX_CELLS, 2),
            (usize::MAX, 2),
            (usize::MAX, usize::MAX),
        ] {
            assert_eq!(
                Grid::new(cells_x, cells_y, 1.0, 1.0),
                Err(GridError::Cells { cells_x, cells_y })
            );
        }
        assert!(Grid::new(MAX_CELLS, 1, 1.0, 1.0).is_ok());
    }

    #[test]
    fn a_spacing_that_is_no_length_is_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1.0e-200, 1.0e200] {
            assert!(
                matches!(Grid::square(4, bad), Err(GridError::Spacing { .. })),
                "{bad}"
            );
        }
        assert!(matches!(
            Grid::new(4, 4, 1.0, f64::NAN),
            Err(GridError::Spacing { .. })
        ));
        assert!(matches!(
            Grid::new(4, 4, 1.0, 1001.0),
            Err(GridError::AspectRatio { .. })
        ));
    }
}
