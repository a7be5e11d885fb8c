//! What a contact on cells is like as a whole: how much of the surface touches, in how many patches, under which pressures, and how far
//! apart the rest is.

use super::surface::CellSurface;

/// The contact of one instant. Means over the contact are those over its cells, none where nothing touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactStatistics {
    /// Cells under pressure over all cells.
    pub area_fraction: f64,
    /// Parts of the contact of which no two have cells side by side.
    pub patches: usize,
    /// Area (m^2) of the largest patch.
    pub largest_patch_m2: Option<f64>,
    pub mean_pressure_pa: Option<f64>,
    pub rms_pressure_pa: Option<f64>,
    /// Over all cells under the indenter, those in contact among them with no gap; none where its place is unknown.
    pub mean_gap_m: Option<f64>,
    pub rms_gap_m: Option<f64>,
}

impl ContactStatistics {
    /// Of pressures, and of gaps (m, one per cell, infinite where there is no indenter) where they are known. `repeats` says whether
    /// cells at opposite ends of the grid are neighbours.
    pub fn of(cells: &CellSurface, gap_m: Option<&[f64]>, repeats: bool) -> Self {
        let touches: Vec<bool> = cells.pressure_pa.iter().map(|p| *p > 0.0).collect();
        let sizes = patch_cells(&touches, cells.grid.cells_x(), repeats);
        let touching = touches.iter().filter(|touches| **touches).count();
        let pressures = cells.pressure_pa.iter().filter(|p| **p > 0.0).copied();
        let (mean_pressure_pa, rms_pressure_pa) = mean_and_rms(pressures).unzip();
        let gaps = gap_m.and_then(|gap_m| mean_and_rms(gaps_m(cells, gap_m)));
        let (mean_gap_m, rms_gap_m) = gaps.unzip();
        let largest = sizes.iter().max();
        Self {
            area_fraction: touching as f64 / touches.len() as f64,
            patches: sizes.len(),
            largest_patch_m2: largest.map(|cells_of| *cells_of as f64 * cells.grid.cell_area_m2()),
            mean_pressure_pa,
            rms_pressure_pa,
            mean_gap_m,
            rms_gap_m,
        }
    }
}

/// The gaps (m) of all cells under the indenter; of those in contact none, whatever rounding leaves there.
pub fn gaps_m<'a>(cells: &'a CellSurface, gap_m: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let both = cells.pressure_pa.iter().zip(gap_m);
    let finite = both.filter(|(_, gap_m)| gap_m.is_finite());
    finite.map(|(p, gap_m)| if *p > 0.0 { 0.0 } else { gap_m.max(0.0) })
}

fn mean_and_rms(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let (mut count, mut sum, mut squares) = (0_usize, 0.0, 0.0);
    for value in values {
        count += 1;
        sum += value;
        squares += value * value;
    }
    let count = (count > 0).then_some(count as f64)?;
    Some((sum / count, (squares / count).sqrt()))
}

/// The share of values above each of `places` evenly spaced ones, from 0 to `most`.
pub fn shares_above(
    values: impl Iterator<Item = f64>,
    most: f64,
    places: usize,
) -> Vec<(f64, f64)> {
    let place = |k: usize| most * k as f64 / (places.max(2) - 1) as f64;
    // How many places a value is above: those below it.
    let mut above = vec![0_usize; places + 1];
    let mut count = 0_usize;
    for value in values {
        let guess = (value / most * (places.max(2) - 1) as f64).ceil().max(0.0) as usize;
        let guess = guess.min(places);
        // Rounding may put a value that is a place on either side of it.
        let is_too_high = guess > 0 && place(guess - 1) >= value;
        let is_too_low = guess < places && place(guess) < value;
        above[guess - usize::from(is_too_high) + usize::from(is_too_low)] += 1;
        count += 1;
    }
    let mut left = count;
    (0..places)
        .map(|k| {
            left -= above[k];
            (place(k), left as f64 / count.max(1) as f64)
        })
        .collect()
}

/// Cells of every patch of cells that touch.
fn patch_cells(touches: &[bool], cells_x: usize, repeats: bool) -> Vec<usize> {
    let cells_y = touches.len() / cells_x;
    let mut seen: Vec<bool> = touches.iter().map(|touches| !touches).collect();
    let (mut patches, mut waiting) = (Vec::new(), Vec::new());
    for first in 0..touches.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        waiting.push(first);
        let mut size = 0;
        while let Some(cell) = waiting.pop() {
            size += 1;
            let (x, y) = (cell % cells_x, cell / cells_x);
            let along_x = beside(x, cells_x, repeats).map(|x| x.map(|x| y * cells_x + x));
            let along_y = beside(y, cells_y, repeats).map(|y| y.map(|y| y * cells_x + x));
            for next in along_x.into_iter().chain(along_y).flatten() {
                if !std::mem::replace(&mut seen[next], true) {
                    waiting.push(next);
                }
            }
        }
        patches.push(size);
    }
    patches
}

/// The places before and after one of so many.
fn beside(at: usize, count: usize, repeats: bool) -> [Option<usize>; 2] {
    let inside = [at.checked_sub(1), (at + 1 < count).then_some(at + 1)];
    match repeats {
        true => [inside[0].or(Some(count - 1)), inside[1].or(Some(0))],
        false => inside,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::half_space::grid::Grid;

    /// A surface of cells of 4 m^2 whose pressures are these digits.
    fn surface(rows: &[&str]) -> CellSurface {
        let grid = Grid::new(rows[0].len(), rows.len(), 2.0, 2.0).unwrap();
        let digits = rows.iter().flat_map(|row| row.bytes());
        let pressure_pa: Vec<f64> = digits.map(|digit| f64::from(digit - b'0')).collect();
        CellSurface {
            grid,
            displacement_m: vec![0.0; pressure_pa.len()],
            pressure_pa,
        }
    }

    #[test]
    fn patches_are_told_apart_by_their_sides_and_go_round_where_the_surface_does() {
        let cells = surface(&["1001", "0100", "0110", "1000"]);
        let of = |repeats| ContactStatistics::of(&cells, None, repeats);
        // Two corners above, one of three cells, one corner below.
        let (ends, repeats) = (of(false), of(true));
        assert_eq!((ends.patches, ends.largest_patch_m2), (4, Some(12.0)));
        // The three corners are one patch.
        assert_eq!((repeats.patches, repeats.largest_patch_m2), (2, Some(12.0)));
        assert_eq!(ends.area_fraction, 6.0 / 16.0);
        let none = ContactStatistics::of(&surface(&["00", "00"]), None, true);
        assert_eq!((none.patches, none.mean_pressure_pa), (0, None));
        assert_eq!((none.largest_patch_m2, none.mean_gap_m), (None, None));
        let all = ContactStatistics::of(&surface(&["12", "34"]), None, true);
        assert_eq!((all.patches, all.largest_patch_m2), (1, Some(16.0)));
        assert_eq!(all.mean_pressure_pa, Some(2.5));
        assert_eq!(all.rms_pressure_pa, Some(7.5_f64.sqrt()));
    }

    #[test]
    fn gaps_count_where_there_is_an_indenter_and_vanish_in_contact() {
        let cells = surface(&["10", "00"]);
        let gap_m = [-1e-20, 3.0, f64::INFINITY, 6.0];
        let found = ContactStatistics::of(&cells, Some(&gap_m), false);
        assert_eq!(found.mean_gap_m, Some(3.0));
        assert_eq!(found.rms_gap_m, Some(15.0_f64.sqrt()));
    }

    #[test]
    fn shares_above_are_counted_to_the_last_value() {
        let values = [0.0, 0.25, 0.3, 1.0];
        let found = shares_above(values.into_iter(), 1.0, 5);
        let expected = [
            (0.0, 0.75),
            (0.25, 0.5),
            (0.5, 0.25),
            (0.75, 0.25),
            (1.0, 0.0),
        ];
        assert_eq!(found, expected);
        // Of many values and places, those that are places among them.
        let values: Vec<f64> = (0..1000).map(|k| f64::from(k % 101) * 0.07).collect();
        for (place, share) in shares_above(values.iter().copied(), 7.0, 101) {
            let above = values.iter().filter(|value| **value > place).count();
            assert_eq!(share, above as f64 / 1000.0, "{place}");
        }
    }
}
