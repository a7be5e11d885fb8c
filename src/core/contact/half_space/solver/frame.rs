//! Rectangular parts of a grid: where a field has values, and the window in which an instant is solved.

use std::ops::Range;

use super::super::convolution::window_length;
use super::super::grid::Grid;
use crate::contact::sums;
use crate::numerics::threads::{Rows, in_rows};

/// A rectangle of cells of a grid: a window of it, or where a field has values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Frame {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) cells_x: usize,
    pub(super) cells_y: usize,
}

/// Room in a window on either side of the contact: as a share of its width, so that what lies beyond is seldom in doubt (see
/// [`super::outside`]), and in cells.
const ROOM_SHARE: f64 = 0.1;
const ROOM_CELLS: usize = 3;

/// Cells that a window must have to hold these: on a mirrored grid it begins at the axis.
fn length_to_hold(first: usize, cells: usize, grid: &Grid) -> usize {
    match grid.is_mirrored() {
        true => first + cells,
        false => cells,
    }
}

impl Frame {
    pub(super) fn whole(grid: &Grid) -> Self {
        Self {
            x: 0,
            y: 0,
            cells_x: grid.cells_x(),
            cells_y: grid.cells_y(),
        }
    }

    /// The smallest one that holds all values that are not zero of a field of rows of `cells_x` values; `None` for zero everywhere.
    pub(super) fn of(field: &[f64], cells_x: usize) -> Option<Self> {
        // Most rows hold none: looking at all bits but the sign at once is faster than stopping at the first value.
        let empty =
            |row: &[f64]| row.iter().fold(0, |bits, value| bits | value.to_bits()) << 1 == 0;
        Self::of_rows(field, cells_x, empty, |value| value != 0.0)
    }

    /// The smallest one that holds the cells whose value is chosen.
    pub(super) fn of_cells(
        field: &[f64],
        cells_x: usize,
        chosen: impl Fn(f64) -> bool,
    ) -> Option<Self> {
        Self::of_rows(field, cells_x, |_| false, chosen)
    }

    fn of_rows(
        field: &[f64],
        cells_x: usize,
        empty: impl Fn(&[f64]) -> bool,
        chosen: impl Fn(f64) -> bool,
    ) -> Option<Self> {
        let mut bounds: Option<(Range<usize>, Range<usize>)> = None;
        let rows = field.chunks_exact(cells_x).enumerate();
        for (iy, row) in rows.filter(|(_, row)| !empty(row)) {
            let Some(first) = row.iter().position(|&value| chosen(value)) else {
                continue;
            };
            let (x, y) = bounds.unwrap_or((first..first, iy..iy));
            // Only what lies beyond the bounds so far can widen them.
            let known = x.end.max(first + 1);
            let beyond = row[known..].iter().rposition(|&value| chosen(value));
            let end = beyond.map_or(known, |at| known + at + 1);
            bounds = Some((x.start.min(first)..end, y.start..iy + 1));
        }
        bounds.map(|(x, y)| Self::between(x, y))
    }

    fn between(x: Range<usize>, y: Range<usize>) -> Self {
        Self {
            x: x.start,
            y: y.start,
            cells_x: x.len(),
            cells_y: y.len(),
        }
    }

    /// Columns.
    pub(super) fn columns(&self) -> Range<usize> {
        self.x..self.x + self.cells_x
    }

    /// Rows.
    pub(super) fn rows(&self) -> Range<usize> {
        self.y..self.y + self.cells_y
    }

    /// The smallest one that holds both.
    fn union(&self, other: &Self) -> Self {
        let join = |a: Range<usize>, b: Range<usize>| a.start.min(b.start)..a.end.max(b.end);
        Self::between(
            join(self.columns(), other.columns()),
            join(self.rows(), other.rows()),
        )
    }

    /// The same rectangle in a grid in which the field's first cell is that of `frame`.
    pub(super) fn moved(self, frame: &Self) -> Self {
        Self {
            x: self.x + frame.x,
            y: self.y + frame.y,
            ..self
        }
    }

    /// A window with room about a contact; on a mirrored grid it begins at the axes.
    pub(super) fn with_room(contact: &Self, grid: &Grid) -> Self {
        let needed = |first: usize, cells: usize| {
            // On a mirrored grid half of the width, with room on one side.
            let sides = if grid.is_mirrored() { 1 } else { 2 };
            let length = length_to_hold(first, cells, grid);
            let width = 2 / sides * length;
            let room = (ROOM_SHARE * width as f64).ceil() as usize;
            length + sides * room.max(ROOM_CELLS)
        };
        contact.widened(needed, grid)
    }

    /// The smallest window that holds this one and these cells.
    pub(super) fn holding(&self, cells: Option<Self>, grid: &Grid) -> Self {
        match cells.map(|cells| self.union(&cells)) {
            Some(all) if all != *self => {
                all.widened(|first, cells| length_to_hold(first, cells, grid), grid)
            }
            _ => *self,
        }
    }

    /// A window about this one, with at least as many cells along either side as are needed for its first cell and its length.
    fn widened(&self, needed: impl Fn(usize, usize) -> usize, grid: &Grid) -> Self {
        let place = |first: usize, own: usize, cells: usize| {
            let length = window_length(needed(first, own).min(cells), cells);
            let start = match grid.is_mirrored() {
                true => 0,
                false => (2 * first + own).saturating_sub(length) / 2,
            };
            (start.min(cells - length), length)
        };
        let (x, cells_x) = place(self.x, self.cells_x, grid.cells_x());
        let (y, cells_y) = place(self.y, self.cells_y, grid.cells_y());
        Self {
            x,
            y,
            cells_x,
            cells_y,
        }
    }

    pub(super) fn cells(&self) -> usize {
        self.cells_x * self.cells_y
    }

    /// Whether these cells come to within a cell of a side beyond which the grid goes on.
    pub(super) fn is_touched_by(&self, inner: &Self, grid: &Grid) -> bool {
        let touched = |frame: Range<usize>, inner: Range<usize>, cells: usize| {
            (frame.start > 0 && inner.start <= frame.start)
                || (frame.end < cells && inner.end >= frame.end)
        };
        touched(self.columns(), inner.columns(), grid.cells_x())
            || touched(self.rows(), inner.rows(), grid.cells_y())
    }

    /// Does something to every row of this window of a field of rows of `field_cells_x` values, and that of a part of its size.
    fn each_row(
        &self,
        field: &[f64],
        field_cells_x: usize,
        part: &mut [f64],
        leaf: impl Fn(&[f64], &mut [f64]) + Sync,
    ) {
        let (cells_x, columns) = (self.cells_x, self.columns());
        let field = &field[self.y * field_cells_x..(self.y + self.cells_y) * field_cells_x];
        let rows = (Rows(field, field_cells_x), Rows(part, cells_x));
        in_rows(self.cells_y, cells_x, rows, |_, (field, part)| {
            let rows = field.0.chunks_exact(field_cells_x);
            for (row, part) in rows.zip(part.0.chunks_exact_mut(cells_x)) {
                leaf(&row[columns.clone()], part);
            }
        });
    }

    /// The same, where the field is to change.
    fn each_row_mut(
        &self,
        field: &mut [f64],
        field_cells_x: usize,
        part: &[f64],
        leaf: impl Fn(&mut [f64], &[f64]) + Sync,
    ) {
        let (cells_x, columns) = (self.cells_x, self.columns());
        let field = &mut field[self.y * field_cells_x..(self.y + self.cells_y) * field_cells_x];
        let rows = (Rows(field, field_cells_x), Rows(part, cells_x));
        in_rows(self.cells_y, cells_x, rows, |_, (field, part)| {
            let rows = field.0.chunks_exact_mut(field_cells_x);
            for (row, part) in rows.zip(part.0.chunks_exact(cells_x)) {
                leaf(&mut row[columns.clone()], part);
            }
        });
    }

    /// Copies this window out of a field of rows of `grid_cells_x` values.
    pub(super) fn gather(&self, field: &[f64], grid_cells_x: usize, part: &mut [f64]) {
        self.each_row(field, grid_cells_x, part, |row, part| {
            part.copy_from_slice(row)
        });
    }

    /// Copies this window back into such a field.
    pub(super) fn scatter(&self, part: &[f64], grid_cells_x: usize, field: &mut [f64]) {
        self.each_row_mut(field, grid_cells_x, part, |row, part| {
            row.copy_from_slice(part)
        });
    }

    /// Adds a part of this window's size, times a factor, to a field of rows of `cells_x` values.
    pub(super) fn add_scaled(&self, part: &[f64], factor: f64, cells_x: usize, field: &mut [f64]) {
        self.each_row_mut(field, cells_x, part, |row, part| {
            sums::add_scaled(row, factor, part);
        });
    }

    /// Adds this window of a field of rows of `cells_x` values to a part of the window's size.
    pub(super) fn add_part(&self, field: &[f64], cells_x: usize, part: &mut [f64]) {
        self.each_row(field, cells_x, part, |row, part| {
            part.iter_mut()
                .zip(row)
                .for_each(|(part, value)| *part += value);
        });
    }

    /// The window `inner` of the same grid, as a window of this one.
    pub(super) fn part(&self, inner: &Self) -> Self {
        Self {
            x: inner.x - self.x,
            y: inner.y - self.y,
            ..*inner
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_hold_every_value_and_no_more() {
        let mut field = vec![0.0; 7 * 5];
        assert_eq!(Frame::of(&field, 7), None);
        for (cells, expected) in [
            (&[(3, 2)][..], (3..4, 2..3)),
            (&[(5, 1), (1, 4)], (1..6, 1..5)),
            (&[(2, 3), (6, 0), (0, 4)], (0..7, 0..5)),
        ] {
            field.fill(0.0);
            for (x, y) in cells {
                field[y * 7 + x] = 1.0;
            }
            let found = Frame::of(&field, 7).unwrap();
            assert_eq!((found.columns(), found.rows()), expected);
        }
    }

    #[test]
    fn a_window_holds_the_contact_with_room_wherever_it_lies() {
        let grid = Grid::new(200, 90, 1.0, 1.0).unwrap();
        for x in [0, 1, 50, 180, 199] {
            for y in [0, 40, 89] {
                for length in [1, 7, 40, 200] {
                    let contact = Frame::between(x..(x + length).min(200), y..(y + length).min(90));
                    let frame = Frame::with_room(&contact, &grid);
                    assert!(frame.columns().end <= 200 && frame.rows().end <= 90);
                    assert_eq!(frame.union(&contact), frame);
                    assert!(
                        !frame.is_touched_by(&contact, &grid),
                        "{contact:?} {frame:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_window_of_a_quarter_begins_at_the_axes() {
        let grid = Grid::new(400, 180, 1.0, 1.0).unwrap().quarter().unwrap();
        for (from, to) in [(0, 1), (0, 30), (20, 60), (80, 90)] {
            let contact = Frame::between(from..to, from..to);
            let frame = Frame::with_room(&contact, &grid);
            assert_eq!((frame.x, frame.y), (0, 0));
            assert!(frame.cells_x >= to.min(200) && frame.cells_y >= to.min(90));
            assert!(!frame.is_touched_by(&contact, &grid));
            assert_eq!(frame.holding(Some(contact), &grid), frame);
        }
    }

    #[test]
    fn a_window_taken_out_and_put_back_leaves_the_field_as_it_was() {
        let grid = Grid::new(40, 30, 1.0, 1.0).unwrap();
        let field: Vec<f64> = (0..grid.cells()).map(|i| i as f64).collect();
        let frame = Frame {
            x: 3,
            y: 5,
            cells_x: 20,
            cells_y: 18,
        };
        let mut part = vec![0.0; frame.cells()];
        frame.gather(&field, 40, &mut part);
        assert_eq!(part[0], (5 * 40 + 3) as f64);
        let mut back = field.clone();
        back.iter_mut().for_each(|value| *value += 0.0);
        frame.scatter(&part, 40, &mut back);
        assert_eq!(back, field);
        let inner = Frame {
            x: 10,
            y: 9,
            cells_x: 4,
            cells_y: 4,
        };
        let mut small = vec![0.0; inner.cells()];
        frame.part(&inner).gather(&part, frame.cells_x, &mut small);
        assert_eq!(small[0], (9 * 40 + 10) as f64);
    }
}
