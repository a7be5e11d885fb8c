//! A height map given point by point, in any order: from columns x, y, z to a regular grid.

use super::{Field, FieldProblem, Place};

/// Coordinates closer than this share of their range are the same: a 250th of the spacing of 4096 points.
const SAME_COORDINATE: f64 = 1e-6;
/// Share of the spacing by which a coordinate may lie off the grid: digits lost in writing, not a displaced point.
const OFF_GRID: f64 = 0.01;

type Refused = (Place, FieldProblem);

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

/// The grid of the points `values` = x, y, z, x, y, z, ..., that stand on these lines.
pub(super) fn field(values: &[f64], lines: &[u64]) -> Result<Field, Refused> {
    let coordinate = |which: usize| values.iter().skip(which).step_by(3).copied();
    let (xs, ys) = (distinct(coordinate(0)), distinct(coordinate(1)));
    let points = lines.len();
    // A point short of a grid is a hole; scattered points have about as many coordinates as there are points.
    if xs.len().saturating_mul(ys.len()) > points.saturating_mul(2) {
        let problem = FieldProblem::NotAGrid {
            points,
            columns: xs.len(),
            rows: ys.len(),
        };
        return Err((Place::File, problem));
    }
    let (x, y) = (axis("x", &xs)?, axis("y", &ys)?);
    let mut found: Vec<Option<(f64, u64)>> = vec![None; x.count * y.count];
    for (point, &line) in values.chunks_exact(3).zip(lines) {
        let slot = &mut found[y.index(point[1]) * x.count + x.index(point[0])];
        if let Some((_, first_line)) = *slot {
            return Err((Place::Line(line), FieldProblem::SamePoint { first_line }));
        }
        *slot = Some((point[2], line));
    }
    let value = |(index, slot): (usize, &Option<(f64, u64)>)| {
        slot.map(|(z, _)| z).ok_or_else(|| {
            let (x_m, y_m) = (x.position_m(index % x.count), y.position_m(index / x.count));
            let hole = format!("no point at x = {x_m:e} m, y = {y_m:e} m");
            (Place::File, FieldProblem::Hole(hole))
        })
    };
    let values_m: Result<Vec<f64>, Refused> = found.iter().enumerate().map(value).collect();
    Ok(Field {
        cells_x: x.count,
        cells_y: y.count,
        values_m: values_m?,
        spacing_m: Some((x.spacing_m, y.spacing_m)),
    })
}

/// The different coordinates among these, ascending.
fn distinct(coordinates: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = coordinates.collect();
    all.sort_by(f64::total_cmp);
    let range = match (all.first(), all.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    };
    all.dedup_by(|next, kept| *next - *kept <= SAME_COORDINATE * range);
    all
}

fn axis(name: &'static str, coordinates: &[f64]) -> Result<Axis, Refused> {
    let count = coordinates.len();
    let (Some(&start_m), Some(&end_m)) = (coordinates.first(), coordinates.last()) else {
        return Err((Place::File, FieldProblem::Empty));
    };
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
            let problem = FieldProblem::Uneven {
                axis: name,
                at_m,
                share: 100.0 * share,
            };
            return Err((Place::File, problem));
        }
    }
    Ok(axis)
}

#[cfg(test)]
mod tests {
    use super::super::field;

    fn refused(text: &str) -> String {
        field("map.csv", text.as_bytes()).unwrap_err().to_string()
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
            refused(&hole),
            "`map.csv`: a hole: no point at x = 7e-7 m, y = 2e-6 m"
        );
        let twice = grid(|index| (index == 6).then(|| "0,5e-7,0\n".to_owned()));
        assert_eq!(
            refused(&twice),
            "`map.csv`, line 8: the same point as on line 2"
        );
        let bent = "x_m,y_m,z_m\n0,0,0\n1,0,0\n3,0,0\n0,1,0\n1,1,0\n3,1,0\n";
        assert_eq!(
            refused(bent),
            "`map.csv`: the points are not evenly spaced along x: 1e0 m is off the grid by 33 % of the spacing"
        );
        let scattered = "x_m,y_m,z_m\n0,0,0\n1,2,0\n3,1,0\n2,3,0\n";
        assert_eq!(
            refused(scattered),
            "`map.csv`: the points do not form a grid: 4 points have 4 different x and 4 different y"
        );
        let bad = grid(|index| (index == 3).then(|| "1e-9,a,0\n".to_owned()));
        assert_eq!(
            refused(&bad),
            "`map.csv`, line 5, column 2: `a` is not a number"
        );
    }
}
