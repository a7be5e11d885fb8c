//! Domains that grow with the contact: a history begins on one that just holds its first contact, and moves to one twice as wide,
//! with as many nodes, whenever the contact reaches the edge.
//!
//! What moves is what the body remembers, which is a field over the nodes. A node of the wider domain takes the mean over its
//! width, or over its area, of what the nodes of the narrower one hold, so that every load remembered stays what it was. Where
//! nodes are twice as wide, each covers two of them, or two by two, exactly. What H is made of moves in the same way, for both
//! transforms are linear; the instant under way is then solved on the wider domain.

use std::borrow::Cow;

use crate::contact::half_space::grid::Grid;
use crate::history::{PastState, StepState};
use crate::indenter::Indenter;

/// Where the nodes of an engine are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Layout {
    /// Springs side by side from the axis on, and the width of each (m).
    Springs { springs: usize, width_m: f64 },
    /// Cells.
    Cells(Grid),
}

/// A row of equal intervals: where the first begins (m), how wide each is, and how many there are.
#[derive(Debug, Clone, Copy)]
struct Row {
    start_m: f64,
    width_m: f64,
    count: usize,
}

/// What each interval of a row takes: place and weight of intervals of another row.
type Shares = Vec<Vec<(usize, f64)>>;

impl Row {
    fn new(start_m: f64, width_m: f64, count: usize) -> Self {
        Self {
            start_m,
            width_m,
            count,
        }
    }

    /// For each interval the intervals of `from` that it overlaps, and the part of its own width.
    fn shares(&self, from: &Row) -> Shares {
        /// Of a width: what rounding makes of intervals that only touch.
        const ROUNDING: f64 = 1e-9;
        let of = |i: usize| {
            let low = (self.start_m + i as f64 * self.width_m - from.start_m) / from.width_m;
            let wide = self.width_m / from.width_m;
            let first = low.max(0.0).floor() as usize;
            let overlap = |k: usize| (low + wide).min(k as f64 + 1.0) - low.max(k as f64);
            (first..from.count)
                .take_while(|&k| (k as f64) < low + wide)
                .map(|k| (k, overlap(k)))
                .filter(|(_, part)| *part > ROUNDING)
                .map(|(k, part)| (k, part / wide))
                .collect()
        };
        (0..self.count).map(of).collect()
    }
}

impl Layout {
    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        match self {
            Self::Springs { springs, .. } => *springs,
            Self::Cells(grid) => grid.cells(),
        }
    }

    /// The rows of intervals along x and y that the nodes are; springs have one along y.
    fn rows(&self) -> [Row; 2] {
        match self {
            Self::Springs { springs, width_m } => {
                [Row::new(0.0, *width_m, *springs), Row::new(0.0, 1.0, 1)]
            }
            Self::Cells(grid) => {
                let (x_m, y_m) = (grid.spacing_x_m(), grid.spacing_y_m());
                [
                    Row::new(grid.x_m(0) - 0.5 * x_m, x_m, grid.cells_x()),
                    Row::new(grid.y_m(0) - 0.5 * y_m, y_m, grid.cells_y()),
                ]
            }
        }
    }
}

/// Moves fields from one layout to another.
struct Moving {
    x: Shares,
    y: Shares,
    from_row: usize,
}

impl Moving {
    fn new(from: &Layout, to: &Layout) -> Self {
        let ([from_x, from_y], [to_x, to_y]) = (from.rows(), to.rows());
        Self {
            x: to_x.shares(&from_x),
            y: to_y.shares(&from_y),
            from_row: from_x.count,
        }
    }

    /// The mean over each new node.
    fn field(&self, field: &[f64]) -> Vec<f64> {
        let mut moved = Vec::with_capacity(self.x.len() * self.y.len());
        for rows in &self.y {
            for columns in &self.x {
                let mut sum = 0.0;
                for &(iy, in_y) in rows {
                    for &(ix, in_x) in columns {
                        sum += in_y * in_x * field[iy * self.from_row + ix];
                    }
                }
                moved.push(sum);
            }
        }
        moved
    }
}

/// The state within a step of a march on the nodes of `from`, as a march on those of `to` goes on from it.
pub(crate) fn moved(state: StepState<'_>, from: &Layout, to: &Layout) -> StepState<'static> {
    let moving = Moving::new(from, to);
    let fields = |fields: &[f64]| -> Cow<'static, [f64]> {
        let each = fields.chunks_exact(from.nodes());
        each.flat_map(|field| moving.field(field)).collect()
    };
    StepState {
        stage: state.stage,
        memory: PastState {
            nodal: (state.memory.nodal.iter())
                .map(|part| fields(part))
                .collect(),
            steps: Cow::Owned(state.memory.steps.into_owned()),
        },
        guess: fields(&state.guess),
        history: fields(&state.history),
        // Guesses start anew.
        course: state.course.map(|_| Cow::default()),
        solution: state.solution,
        work: state.work,
    }
}

/// Whether the gap is convex within this half width (m), as far as a lattice of points tells: then contact grows outwards from
/// where it began, and cannot begin anew elsewhere.
pub(crate) fn is_convex_within(indenter: &dyn Indenter, half_width_m: f64) -> bool {
    /// Points along a side; no distance of them is commensurate with the origin.
    const POINTS: i32 = 9;
    /// Of the largest gap at the two ends.
    const ROUNDING: f64 = 1e-9;
    let at = |k: i32| half_width_m * (2.0 * f64::from(k) / f64::from(POINTS - 1) - 1.0);
    let lattice = || (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| (i, j)));
    let gap = |(i, j)| indenter.gap_m(at(i), at(j));
    lattice().all(|one| {
        let one_m = gap(one);
        lattice().filter(|other| *other > one).all(|other| {
            let other_m = gap(other);
            let (x_m, y_m) = (at(one.0) + at(other.0), at(one.1) + at(other.1));
            let middle_m = indenter.gap_m(0.5 * x_m, 0.5 * y_m);
            middle_m <= 0.5 * (one_m + other_m) + ROUNDING * one_m.abs().max(other_m.abs())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indenter::{Asperities, Asperity, Cone, Ellipsoid, FlatPunch, Sphere};

    fn cells(n: usize, spacing_m: f64) -> Grid {
        Grid::square(n, spacing_m).unwrap()
    }

    #[test]
    fn what_moves_to_nodes_twice_as_wide_is_the_mean_of_those_they_cover() {
        let springs = |width_m| Layout::Springs {
            springs: 4,
            width_m,
        };
        let moving = Moving::new(&springs(0.1), &springs(0.2));
        assert_eq!(moving.field(&[1.0, 3.0, 5.0, 8.0]), [2.0, 6.5, 0.0, 0.0]);
        // A quarter of a surface begins at its corner, a whole one at its edge.
        let quarter = |spacing_m| Layout::Cells(cells(4, spacing_m).quarter().unwrap());
        let moving = Moving::new(&quarter(0.1), &quarter(0.2));
        assert_eq!(moving.field(&[1.0, 2.0, 3.0, 6.0]), [3.0, 0.0, 0.0, 0.0]);
        let whole = |spacing_m| Layout::Cells(cells(4, spacing_m));
        let moving = Moving::new(&whole(0.1), &whole(0.2));
        let field: Vec<f64> = (0..16).map(f64::from).collect();
        let moved = moving.field(&field);
        // 0, 1, 4, 5 and so on in the middle of the wider domain.
        assert_eq!(&moved[5..7], [2.5, 4.5]);
        assert_eq!(&moved[9..11], [10.5, 12.5]);
        assert_eq!(moved.iter().filter(|value| **value != 0.0).count(), 4);
    }

    #[test]
    fn the_load_stays_between_any_two_grids_the_wider_of_which_holds_the_other() {
        for (n, to) in [(5, cells(5, 0.2)), (6, cells(6, 0.2)), (7, cells(9, 0.17))] {
            let from = cells(n, 0.1);
            let field: Vec<f64> = (0..n * n).map(|i| (i as f64).sin() + 2.0).collect();
            let moved = Moving::new(&Layout::Cells(from), &Layout::Cells(to)).field(&field);
            let load = |grid: &Grid, field: &[f64]| grid.cell_area_m2() * field.iter().sum::<f64>();
            let (before, after) = (load(&from, &field), load(&to, &moved));
            // Some fifty roundings.
            assert!((after / before - 1.0).abs() < 1e-13, "{n}");
        }
    }

    #[test]
    fn one_apex_is_convex_and_two_are_not() {
        let convex: [&dyn Indenter; 4] = [
            &Sphere::new(0.01).unwrap(),
            &Cone::new(1.2).unwrap(),
            &FlatPunch::new(1e-3).unwrap(),
            &Ellipsoid::new(0.01, 1.0).unwrap(),
        ];
        for indenter in convex {
            assert!(is_convex_within(indenter, 1.5e-3), "{}", indenter.shape());
        }
        let apex = |x_m| Asperity {
            center_x_m: x_m,
            center_y_m: 0.0,
            radius_m: 0.01,
            height_m: 0.0,
        };
        let two = Asperities::new(vec![apex(-1e-3), apex(1e-3)]).unwrap();
        assert!(!is_convex_within(&two, 1.5e-3));
    }
}
