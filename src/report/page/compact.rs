//! Numbers small enough for a page: six digits, about a hundred points a curve, at most some forty cells a side.

use serde::Serialize;

/// Rounded to six significant digits.
pub(super) fn rounded(value: f64) -> f64 {
    digits(value, 6)
}

/// All of them rounded.
pub(super) fn all_rounded(values: &[f64]) -> Vec<f64> {
    values.iter().copied().map(rounded).collect()
}

/// Rounded to so many significant digits.
pub(super) fn digits(value: f64, significant: usize) -> f64 {
    // What Rust prints of a number, Rust reads.
    let text = format!("{value:.*e}", significant.saturating_sub(1));
    text.parse().unwrap_or(value)
}

/// Indices of at most `limit` + 1 samples out of `count`, evenly spread, both ends among them.
pub(super) fn spread(count: usize, limit: usize) -> Vec<usize> {
    let intervals = count.saturating_sub(1);
    let kept = intervals.min(limit.max(1));
    if kept == 0 {
        return (0..count).collect();
    }
    (0..=kept)
        .map(|k| (2 * k * intervals + kept) / (2 * kept))
        .collect()
}

/// The samples at these places, rounded.
pub(super) fn picked(values: &[f64], places: &[usize]) -> Vec<f64> {
    let values = places.iter().filter_map(|&i| values.get(i));
    values.copied().map(rounded).collect()
}

/// The same of samples that may be absent.
pub(super) fn picked_optional(values: &[Option<f64>], places: &[usize]) -> Vec<Option<f64>> {
    let values = places.iter().filter_map(|&i| values.get(i));
    values.map(|value| value.map(rounded)).collect()
}

/// A field of cells, row by row, made coarser.
#[derive(Debug, PartialEq)]
pub(super) struct Coarse {
    pub(super) cells_x: usize,
    /// How many cells along each side became one.
    pub(super) factor: usize,
    pub(super) values: Vec<Option<f64>>,
}

/// Where the cells of such a field lie.
#[derive(Serialize)]
pub(super) struct CoarseCells {
    first_x_m: f64,
    first_y_m: f64,
    spacing_x_m: f64,
    spacing_y_m: f64,
    cells_x: usize,
}

impl Coarse {
    /// The place of the cells made of fine ones, of which these are the first centre and the spacing.
    pub(super) fn cells(&self, first_m: [f64; 2], spacing_m: [f64; 2]) -> CoarseCells {
        let factor = self.factor as f64;
        // The centre of a coarse cell lies between those of the cells in it.
        let shift = 0.5 * (factor - 1.0);
        let first = |axis: usize| rounded(first_m[axis] + shift * spacing_m[axis]);
        let [spacing_x_m, spacing_y_m] = spacing_m.map(|spacing| rounded(factor * spacing));
        CoarseCells {
            first_x_m: first(0),
            first_y_m: first(1),
            spacing_x_m,
            spacing_y_m,
            cells_x: self.cells_x,
        }
    }
}

/// Means over squares of cells, so that no side has more than `limit`; four digits, finer than a colour. Cells without a value
/// do not count.
pub(super) fn coarse(
    cells_x: usize,
    count: usize,
    value: impl Fn(usize) -> Option<f64>,
    limit: usize,
) -> Coarse {
    let cells_x = cells_x.max(1);
    let cells_y = count / cells_x;
    let factor = cells_x.max(cells_y).div_ceil(limit.max(1)).max(1);
    let (nx, ny) = (cells_x.div_ceil(factor), cells_y.div_ceil(factor));
    let mean = |i: usize, j: usize| {
        let rows = j * factor..((j + 1) * factor).min(cells_y);
        let cells = rows
            .flat_map(|row| (i * factor..((i + 1) * factor).min(cells_x)).map(move |c| (row, c)));
        let (sum, known) = cells
            .filter_map(|(row, column)| value(row * cells_x + column))
            .fold((0.0, 0_usize), |(sum, n), v| (sum + v, n + 1));
        (known > 0).then(|| digits(sum / known as f64, 4))
    };
    let places = (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j)));
    Coarse {
        cells_x: nx,
        factor,
        values: places.map(|(i, j)| mean(i, j)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits_are_kept() {
        assert_eq!(rounded(3.508_987_654e-6), 3.508_99e-6);
        assert_eq!(rounded(0.0), 0.0);
        assert_eq!(rounded(-123_456_789.0), -123_457_000.0);
    }

    #[test]
    fn a_spread_keeps_both_ends_and_no_sample_twice() {
        assert_eq!(spread(5, 100), [0, 1, 2, 3, 4]);
        assert_eq!(spread(201, 4), [0, 50, 100, 150, 200]);
        let some = spread(334, 100);
        assert_eq!((some[0], some[100], some.len()), (0, 333, 101));
        assert!(some.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(spread(1, 100), [0]);
        assert!(spread(0, 100).is_empty());
    }

    #[test]
    fn coarser_cells_hold_the_mean_of_what_is_known() {
        let values = [Some(1.0), Some(3.0), None, Some(5.0), None, Some(7.0)];
        let field = coarse(3, 6, |i| values[i], 2);
        assert_eq!((field.cells_x, field.factor), (2, 2));
        assert_eq!(field.values, [Some(3.0), Some(7.0)]);
    }
}
