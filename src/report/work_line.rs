//! The work that the indenter does on the surface per area and cycle, along one line: a radius wherever there is one.

use crate::indenter::Indenter;
use crate::sweep::record::{CellLoss, SurfaceLoss};

/// What a line of work densities runs along, and how it was made from the surface's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorkAlong {
    /// From the axis outwards, as computed.
    Radius,
    /// From the axis outwards: means over rings one cell wide about it.
    Rings,
    /// Along x through the centre of the work: the two rows of cells beside it, by their distances from it.
    X,
}

/// Work densities (J/m2) at ascending positions (m); `None` where the density is unbounded.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkLine {
    pub along: WorkAlong,
    pub points: Vec<(f64, Option<f64>)>,
}

impl WorkAlong {
    /// The symbol of the position.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Radius | Self::Rings => "r",
            Self::X => "x",
        }
    }

    /// The column of the position in a table.
    pub fn column(self) -> &'static str {
        match self {
            Self::Radius | Self::Rings => "radius_m",
            Self::X => "x_m",
        }
    }

    /// What the axis of a picture says.
    pub fn label(self) -> &'static str {
        match self {
            Self::Radius => "radius r",
            Self::Rings => "radius r (means over rings of cells)",
            Self::X => "x",
        }
    }

    /// Where the line runs and how it was made, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Radius => "over the radius r",
            Self::Rings => {
                "over the radius r: the mean over all cells whose centres lie in a ring one cell wide, at their mean distance from \
                 the axis"
            }
            Self::X => "along x through the centre of the work",
        }
    }
}

impl WorkLine {
    /// The line of a surface under an indenter: over the radius where the indenter is of revolution and the cells are square.
    pub fn of(surface: &SurfaceLoss, indenter: &dyn Indenter) -> Self {
        let cells = match surface {
            SurfaceLoss::Radial {
                radius_m,
                density_j_per_m2,
            } => {
                let points = radius_m.iter().copied();
                return Self {
                    along: WorkAlong::Radius,
                    points: points.zip(density_j_per_m2.iter().copied()).collect(),
                };
            }
            SurfaceLoss::Cells(cells) => Cells(cells),
        };
        if !cells.have_a_density() {
            return Self {
                along: WorkAlong::Radius,
                points: Vec::new(),
            };
        }
        match cells.lie_about_the_axis() && indenter.is_of_revolution_within(cells.reach_m()) {
            true => cells.rings(),
            false => cells.along_x(),
        }
    }
}

/// A rectangle of cells.
struct Cells<'a>(&'a CellLoss);

impl Cells<'_> {
    fn have_a_density(&self) -> bool {
        let is_length = |m: f64| m.is_finite() && m > 0.0;
        self.columns() > 0
            && self.rows() > 0
            && is_length(self.0.spacing_x_m)
            && is_length(self.0.spacing_y_m)
    }

    fn columns(&self) -> usize {
        self.0.cells_x
    }

    fn rows(&self) -> usize {
        self.0.density_j_per_m2.len() / self.columns()
    }

    /// The centre of a column of cells.
    fn x_m(&self, column: f64) -> f64 {
        self.0.first_x_m + column * self.0.spacing_x_m
    }

    /// Whether rings can be drawn through them: square cells, in about a square that holds the axis.
    fn lie_about_the_axis(&self) -> bool {
        /// A cell more on one side is rounding; twice that on both.
        const UNEVEN: usize = 4;
        let holds_axis = |at: i64, cells: usize| (-2 * cells as i64..=0).contains(&at);
        let (x, y) = self.first_half_cell();
        // Both spacings come from one side length, by way of a division each.
        (self.0.spacing_x_m / self.0.spacing_y_m - 1.0).abs() < 1e-9
            && self.columns().abs_diff(self.rows()) <= UNEVEN
            && holds_axis(x, self.columns())
            && holds_axis(y, self.rows())
    }

    /// The centre of the first cell in half cells from the axis: whole numbers, of which a root and a comparison are exact.
    fn first_half_cell(&self) -> (i64, i64) {
        let half_cells = |first_m: f64, spacing_m: f64| (2.0 * first_m / spacing_m).round() as i64;
        (
            half_cells(self.0.first_x_m, self.0.spacing_x_m),
            half_cells(self.0.first_y_m, self.0.spacing_y_m),
        )
    }

    /// Half the diagonal of the rectangle.
    fn reach_m(&self) -> f64 {
        let width_m = self.columns() as f64 * self.0.spacing_x_m;
        0.5 * width_m.hypot(self.rows() as f64 * self.0.spacing_y_m)
    }

    /// Means over all cells of the surface whose centres are between k and k + 1 cells from the axis, at the mean of their
    /// distances; those of the rectangle's surroundings have no work done on them. The sum of mean times area over the rings is
    /// the sum over the cells. Ends with the first ring beyond the last work.
    fn rings(&self) -> WorkLine {
        let (x, y) = self.first_half_cell();
        let distance = |x: i64, y: i64| 0.5 * ((x * x + y * y) as f64).sqrt();
        let worked = self.0.density_j_per_m2.iter().enumerate();
        let worked = worked.filter(|(_, density)| **density != 0.0);
        let worked = worked.map(|(cell, density)| {
            let (column, row) = (cell % self.columns(), cell / self.columns());
            let away = distance(x + 2 * column as i64, y + 2 * row as i64);
            (away as usize, f64::from(*density))
        });
        let last = worked.clone().map(|(ring, _)| ring).max();
        let mut sums = vec![(0_usize, 0.0, 0.0); last.map_or(0, |last| last + 2)];
        let end = 2 * sums.len() as i64;
        let centres = |first: i64| (-end..=end).filter(move |at| (at - first) % 2 == 0);
        for (x, y) in centres(y).flat_map(|y| centres(x).map(move |x| (x, y))) {
            let cells_away = distance(x, y);
            if let Some((count, distances, _)) = sums.get_mut(cells_away as usize) {
                *count += 1;
                *distances += cells_away;
            }
        }
        for (ring, density) in worked {
            sums[ring].2 += density;
        }
        let mean = |(count, distances, sum): (usize, f64, f64)| {
            let n = count.max(1) as f64;
            (self.0.spacing_x_m * distances / n, Some(sum / n))
        };
        WorkLine {
            along: WorkAlong::Rings,
            points: sums.into_iter().map(mean).collect(),
        }
    }

    /// The row through the centre of the work, between two rows by its distances from them, with the cells beside its ends.
    fn along_x(&self) -> WorkLine {
        let centre = self.centre_of_work();
        let (below, share) = (centre.floor(), centre.fract());
        let row = |row: f64| {
            let start = (row as usize).min(self.rows() - 1) * self.columns();
            self.0.density_j_per_m2[start..]
                .iter()
                .copied()
                .map(f64::from)
        };
        let pairs = row(below).zip(row(below + 1.0)).take(self.columns());
        let points = pairs.enumerate().map(|(column, (a, b))| {
            let density = (1.0 - share) * a + share * b;
            (self.x_m(column as f64), Some(density))
        });
        // No work is done beyond the rectangle.
        let beside = |column: f64| (self.x_m(column), Some(0.0));
        let ends = [beside(-1.0), beside(self.columns() as f64)].map(std::iter::once);
        let [first, last] = ends;
        WorkLine {
            along: WorkAlong::X,
            points: first.chain(points).chain(last).collect(),
        }
    }

    /// The row, from 0, that the work lies about: between two rows mostly.
    fn centre_of_work(&self) -> f64 {
        let last = (self.rows() - 1) as f64;
        let rows = self.0.density_j_per_m2.chunks_exact(self.columns());
        let (mut sum, mut moment) = (0.0, 0.0);
        for (row, cells) in rows.enumerate() {
            let work: f64 = cells.iter().copied().map(f64::from).sum();
            sum += work;
            moment += row as f64 * work;
        }
        // Work that gives energy back in places may have no centre.
        let centre = moment / sum;
        let is_there = sum > 0.0 && (0.0..=last).contains(&centre);
        if is_there { centre } else { 0.5 * last }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indenter::{Ellipsoid, Shifted, Sphere};

    /// A field of a density over cells of side 2, centred or not.
    fn cells(columns: usize, rows: usize, density: impl Fn(f64, f64) -> f64) -> SurfaceLoss {
        let first = |n: usize| 2.0 * (0.5 - 0.5 * n as f64);
        let at = |k: usize, n: usize| first(n) + 2.0 * k as f64;
        let value =
            |cell: usize| density(at(cell % columns, columns), at(cell / columns, rows)) as f32;
        SurfaceLoss::Cells(CellLoss {
            first_x_m: first(columns),
            first_y_m: first(rows),
            spacing_x_m: 2.0,
            spacing_y_m: 2.0,
            cells_x: columns,
            density_j_per_m2: (0..columns * rows).map(value).collect(),
        })
    }

    fn sphere() -> Sphere {
        Sphere::new(1000.0).unwrap()
    }

    #[test]
    fn rings_keep_a_density_linear_in_the_radius_and_the_sum_over_the_surface() {
        for n in [20, 21] {
            let density = |x: f64, y: f64| 64.0 - x.hypot(y);
            let line = WorkLine::of(&cells(n, n, density), &sphere());
            assert_eq!(line.along, WorkAlong::Rings);
            // Rings that lie in the square whole.
            for (r_m, value) in &line.points[..n / 2] {
                // Single precision.
                assert!((value.unwrap() - (64.0 - r_m)).abs() < 1e-5, "{r_m}");
            }
            let nearest_m = if n == 20 { 2.0_f64.sqrt() } else { 0.0 };
            assert!((line.points[0].0 - nearest_m).abs() < 1e-14);
            assert_eq!(line.points.last().unwrap().1, Some(0.0));
        }
    }

    #[test]
    fn cells_beyond_the_rectangle_count_as_without_work() {
        // A cross of five cells without its corners: the ring from one cell on has eight cells, of which four have work.
        let cross = |x: f64, y: f64| if x == 0.0 || y == 0.0 { 3.0 } else { 0.0 };
        let line = WorkLine::of(&cells(3, 3, cross), &sphere());
        assert_eq!(line.along, WorkAlong::Rings);
        let values: Vec<_> = line
            .points
            .iter()
            .map(|(_, value)| value.unwrap())
            .collect();
        assert_eq!(values, [3.0, 1.5, 0.0]);
        // A row of three alone: the same ring, with two.
        let line = WorkLine::of(&cells(3, 1, cross), &sphere());
        assert_eq!(line.points[1].1, Some(0.75));
        // An axis far outside is no axis of rings.
        let far = SurfaceLoss::Cells(CellLoss {
            first_x_m: 1e300,
            first_y_m: 0.0,
            spacing_x_m: 1e-9,
            spacing_y_m: 1e-9,
            cells_x: 1,
            density_j_per_m2: vec![1.0],
        });
        assert_eq!(WorkLine::of(&far, &sphere()).along, WorkAlong::X);
    }

    #[test]
    fn what_is_not_of_revolution_has_a_line_through_the_centre_of_its_work() {
        let ellipsoid = Ellipsoid::new(1000.0, 500.0).unwrap();
        let shifted = Shifted::new(std::sync::Arc::new(sphere()), 3.0, 1.0).unwrap();
        // Work about y = 1, between two rows of an odd number and on one of an even number.
        for n in [4, 5] {
            let density = |x: f64, y: f64| (20.0 - 2.0 * (y - 1.0).abs() + x).max(0.0);
            let weight = |x: f64, y: f64| {
                if (y - 1.0).abs() < 1.5 {
                    density(x, y)
                } else {
                    0.0
                }
            };
            for indenter in [&ellipsoid as &dyn Indenter, &shifted] {
                let line = WorkLine::of(&cells(n, n, weight), indenter);
                assert_eq!(line.along, WorkAlong::X);
                let off_the_row = if n == 4 { 0.0 } else { 1.0 };
                let inside = 1..line.points.len() - 1;
                let ends = [line.points[0], line.points[inside.end]];
                assert!(ends.iter().all(|end| end.1 == Some(0.0)));
                for (x_m, value) in &line.points[inside] {
                    let expected = 20.0 - 2.0 * off_the_row + x_m;
                    assert!((value.unwrap() - expected).abs() < 1e-5, "{x_m} {value:?}");
                }
            }
        }
    }

    #[test]
    fn a_surface_without_work_has_no_line() {
        assert!(
            WorkLine::of(&cells(0, 0, |_, _| 0.0), &sphere())
                .points
                .is_empty()
        );
        let nowhere = cells(3, 3, |_, _| 0.0);
        assert!(WorkLine::of(&nowhere, &sphere()).points.is_empty());
    }
}
