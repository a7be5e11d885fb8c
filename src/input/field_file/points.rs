//! A height map given point by point, in any order: from columns x, y, z to a regular grid.

use super::Field;
use crate::input::data_file::{DataFile, Table};
use crate::input::diagnostic::Diagnostic;

/// Coordinates closer than this share of their range are the same: a 250th of the spacing of 4096 points.
const SAME_COORDINATE: f64 = 1e-6;
/// Share of the spacing by which a coordinate may lie off the grid: digits lost in writing, not a displaced point.
const OFF_GRID: f64 = 0.01;

/// One axis of the grid.
struct Axis {
    start_m: f64,
    spacing_m: f64,
    count: usize,
}

impl Axis {
    fn index(&self, at_m: f64) -> usize {
        // Coordinates lie within the range, by construction; the cast rounds away what digits lost.
        let index = ((at_m - self.start_m) / self.spacing_m).round().max(0.0) as usize;
        index.min(self.count.saturating_sub(1))
    }

    fn position_m(&self, index: usize) -> f64 {
        self.start_m + index as f64 * self.spacing_m
    }
}

/// What to do about points that form no grid.
const NO_GRID: &str = "interpolate the points onto a regular grid before";

/// The grid of points with the columns x, y, z.
pub(super) fn field(file: &DataFile, table: &Table) -> Result<Field, Diagnostic> {
    let whole = |message: String, help| Diagnostic::at(&table.whole(), message).help(help);
    let points = table.len();
    if points == 0 {
        return Err(file.no_numbers("give one line of numbers per point"));
    }
    let (xs, ys) = (distinct(table.column(0)), distinct(table.column(1)));
    // A point short of a grid is a hole; scattered points have about as many coordinates as there are points.
    if xs.len().saturating_mul(ys.len()) > points.saturating_mul(2) {
        let message = format!(
            "the points do not form a grid: {points} points have {} different x and {} different y",
            xs.len(),
            ys.len()
        );
        return Err(whole(message, NO_GRID));
    }
    let uneven = |message| whole(message, NO_GRID);
    let (x, y) = (
        axis("x", &xs).map_err(uneven)?,
        axis("y", &ys).map_err(uneven)?,
    );
    let mut found: Vec<Option<(f64, usize)>> = vec![None; x.count * y.count];
    for (row, point) in table.values.chunks_exact(3).enumerate() {
        let slot = &mut found[y.index(point[1]) * x.count + x.index(point[0])];
        if let Some((_, first)) = *slot {
            return Err(
                Diagnostic::at(&table.row(row), "the same point is given twice")
                    .label(&table.row(first), "the first time")
                    .help("give every point once"),
            );
        }
        *slot = Some((point[2], row));
    }
    let value = |(index, slot): (usize, &Option<(f64, usize)>)| {
        slot.map(|(z, _)| z).ok_or_else(|| {
            let (x_m, y_m) = (x.position_m(index % x.count), y.position_m(index / x.count));
            let message = format!("a hole: no point at x = {x_m:e} m, y = {y_m:e} m");
            whole(message, super::HOLE)
        })
    };
    let values_m: Result<Vec<f64>, Diagnostic> = found.iter().enumerate().map(value).collect();
    Ok(Field {
        cells_x: x.count,
        cells_y: y.count,
        values_m: values_m?,
        spacing_m: Some((x.spacing_m, y.spacing_m)),
    })
}

/// The different coordinates among these, ascending.
fn distinct(mut all: Vec<f64>) -> Vec<f64> {
    all.sort_by(f64::total_cmp);
    let range = match (all.first(), all.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    };
    all.dedup_by(|next, kept| *next - *kept <= SAME_COORDINATE * range);
    all
}

/// The axis through coordinates, of which there is at least one, or why there is none.
fn axis(name: &str, coordinates: &[f64]) -> Result<Axis, String> {
    let count = coordinates.len();
    let (start_m, end_m) = (coordinates[0], coordinates[count - 1]);
    let axis = Axis {
        start_m,
        // A single row has no spacing; it is refused later, as a map too small.
        spacing_m: if count > 1 {
            (end_m - start_m) / (count - 1) as f64
        } else {
            1.0
        },
        count,
    };
    for (index, &at_m) in coordinates.iter().enumerate() {
        let share = (at_m - axis.position_m(index)).abs() / axis.spacing_m;
        if share > OFF_GRID {
            let share = 100.0 * share;
            return Err(format!(
                "the points are not evenly spaced along {name}: {at_m:e} m is off the grid by {share:.0} % of the spacing"
            ));
        }
    }
    Ok(axis)
}

#[cfg(test)]
mod tests {
    use super::super::field;

    /// The message and its place.
    fn refused(text: &str) -> (String, String) {
        let refused = field("map.csv", text.as_bytes()).unwrap_err();
        let first = refused.iter().next().unwrap();
        let place = first.location().unwrap().text();
        (first.message().to_owned(), place.to_owned())
    }

    /// A grid of 4 x 3 points with one line changed or left out.
    fn grid(change: impl Fn(usize) -> Option<String>) -> String {
        let mut text = "z_m,x_m,y_m\n".to_owned();
        for index in 0..12_usize {
            let (x, y) = (index % 4, index / 4);
            let line = format!("{index}e-9,{}e-7,{}e-6\n", 5 + x, 2 * y);
            text += &change(index).unwrap_or(line);
        }
        text
    }

    #[test]
    fn points_in_any_order_become_a_grid_with_its_spacing() {
        let text = grid(|_| None);
        let found = field("map.csv", text.as_bytes()).unwrap();
        assert_eq!((found.cells_x, found.cells_y), (4, 3));
        let (x_m, y_m) = found.spacing_m.unwrap();
        assert!((x_m / 1e-7 - 1.0).abs() < 1e-12 && (y_m / 2e-6 - 1.0).abs() < 1e-12);
        for (index, z) in found.values_m.iter().enumerate() {
            assert!((z - index as f64 * 1e-9).abs() < 1e-22);
        }
        let mut lines: Vec<&str> = text.lines().collect();
        lines[1..].reverse();
        let reversed = field("map.csv", lines.join("\n").as_bytes()).unwrap();
        assert_eq!(reversed, found);
    }

    #[test]
    fn points_that_form_no_grid_are_refused() {
        let hole = grid(|index| (index == 6).then(String::new));
        assert_eq!(
            refused(&hole).0,
            "a hole: no point at x = 7e-7 m, y = 2e-6 m"
        );
        let twice = grid(|index| (index == 6).then(|| "0,5e-7,0\n".to_owned()));
        let (message, place) = refused(&twice);
        assert_eq!(message, "the same point is given twice");
        assert_eq!(place, "0,5e-7,0");
        let bent = "x_m,y_m,z_m\n0,0,0\n1,0,0\n3,0,0\n0,1,0\n1,1,0\n3,1,0\n";
        assert_eq!(
            refused(bent).0,
            "the points are not evenly spaced along x: 1e0 m is off the grid by 33 % of the spacing"
        );
        let scattered = "x_m,y_m,z_m\n0,0,0\n1,2,0\n3,1,0\n2,3,0\n";
        assert_eq!(
            refused(scattered).0,
            "the points do not form a grid: 4 points have 4 different x and 4 different y"
        );
        let bad = grid(|index| (index == 3).then(|| "1e-9,a,0\n".to_owned()));
        let (message, place) = refused(&bad);
        assert_eq!(message, "a cell of the column `x_m` must be a number");
        assert_eq!(place, "a");
    }
}
