//! A proof, without a convolution, that nothing beyond a window touches the indenter.
//!
//! A load Q on the surface, spread with the radius of gyration s about its centre c, lowers a point x by at least
//! Q / (pi sqrt(|x - c|^2 + s^2)): 1/r is a convex function of r^2, whose mean over the load is |x - c|^2 + s^2 (Jensen's
//! inequality). Sources below zero, which a noisy table leaves, lift a point by no more than if all of them lay in its own cell.
//! Where the gap before deformation makes up the rest of the approach, the surface is clear of the indenter. Gaps
//! are kept as their least value per ring about the window, so that a proof costs no more than a few hundred operations.
//!
//! A layer on a rigid base yields less than the half-space, and rises in places: nothing is proved of it here.
//!
//! Places are in cells of width: from the centre of the grid's first cell, or, on a mirrored grid, from the axes.

use std::f64::consts::PI;

use super::super::active_set::over_blocks;
use super::super::grid::Grid;
use super::frame::Frame;

/// Total, centre and spread of a field q >= 0 of displacement sources (the hereditary integral of the pressure).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Moments {
    sum: f64,
    x: f64,
    y: f64,
    squares: f64,
}

impl Moments {
    /// Of a field of rows of `cells_x` values, the centre of whose first cell lies at `corner`, in units in which cells along x are 1
    /// apart and, along y, `step_y`; the second place of the corner is counted in cells.
    pub(super) fn of(field: &[f64], cells_x: usize, corner: (f64, f64), step_y: f64) -> Self {
        let found = over_blocks(field.len(), cells_x, |cells| {
            let mut moments = Self::default();
            let rows = field[cells.clone()].chunks_exact(cells_x);
            for (iy, row) in (cells.start / cells_x..).zip(rows) {
                moments.add_row(row, corner.0, (iy as f64 + corner.1) * step_y);
            }
            [moments.sum, moments.x, moments.y, moments.squares]
        });
        Self {
            sum: found.total(0),
            x: found.total(1),
            y: found.total(2),
            squares: found.total(3),
        }
    }

    /// Adds a row of values whose first cell's centre lies at `(x, y)` in units in which cells are `(1, step_y)` apart.
    fn add_row(&mut self, values: &[f64], x: f64, y: f64) {
        const LANES: usize = 4;
        let mut at: [f64; LANES] = std::array::from_fn(|lane| x + lane as f64);
        let mut lanes = [[0.0; LANES]; 3];
        let whole = values.chunks_exact(LANES);
        let mut rest = [0.0; LANES];
        rest[..whole.remainder().len()].copy_from_slice(whole.remainder());
        for values in whole.chain(std::iter::once(&rest[..])) {
            for lane in 0..LANES {
                let first = values[lane] * at[lane];
                lanes[0][lane] += values[lane];
                lanes[1][lane] += first;
                lanes[2][lane] += first * at[lane];
                at[lane] += LANES as f64;
            }
        }
        let [sum, first, second] = lanes.map(|lanes| lanes.iter().sum::<f64>());
        self.sum += sum;
        self.x += first;
        self.y += sum * y;
        self.squares += second + sum * y * y;
    }

    /// Those of the whole surface, where only the quarter of a mirrored grid was added, measured from the axes.
    pub(super) fn of_all_copies(self, grid: &Grid) -> Self {
        match grid.is_mirrored() {
            true => Self {
                sum: 4.0 * self.sum,
                x: 0.0,
                y: 0.0,
                squares: 4.0 * self.squares,
            },
            false => self,
        }
    }

    pub(super) fn sum(&self) -> f64 {
        self.sum
    }

    /// Centre, and squared radius of gyration of the values spread over their cells of sides `(1, step_y)`.
    pub(super) fn centre_and_spread(&self, step_y: f64) -> ((f64, f64), f64) {
        if self.sum <= 0.0 {
            return ((0.0, 0.0), 0.0);
        }
        let (x, y) = (self.x / self.sum, self.y / self.sum);
        let within = (1.0 + step_y * step_y) / 12.0;
        let spread = (self.squares / self.sum - x * x - y * y).max(0.0);
        ((x, y), spread + within)
    }

    /// A lower bound of the mean displacement of the field under itself, weighted by itself, per unit compliance and cell
    /// area: two points of it are sqrt(2) times the radius of gyration apart in the root mean square.
    pub(super) fn mean_displacement_lower_bound(&self, step_y: f64) -> f64 {
        let (_, spread) = self.centre_and_spread(step_y);
        self.sum / (PI * (2.0 * spread).sqrt())
    }
}

/// Least gaps beyond a window, ring by ring about its centre.
pub(super) struct OutsideGapBound {
    frame: Frame,
    centre: (f64, f64),
    width: f64,
    /// Least gap (m) at a distance of k to k+1 widths; infinite where the ring has no cell beyond the window.
    least_gap_m: Vec<f64>,
}

const RINGS: usize = 192;

/// Where the centre of a grid's first cell lies along either axis, in cells.
pub(super) fn first_centre(grid: &Grid) -> f64 {
    match grid.is_mirrored() {
        true => 0.5,
        false => 0.0,
    }
}

impl OutsideGapBound {
    pub(super) fn new(grid: &Grid, gap_m: &[f64], frame: Frame) -> Self {
        let step_y = grid.spacing_y_m() / grid.spacing_x_m();
        let first = first_centre(grid);
        let centre = match grid.is_mirrored() {
            true => (0.0, 0.0),
            false => (
                frame.x as f64 + 0.5 * (frame.cells_x as f64 - 1.0),
                (frame.y as f64 + 0.5 * (frame.cells_y as f64 - 1.0)) * step_y,
            ),
        };
        let reach = |cells: usize, centre: f64, step: f64| {
            let far = (cells as f64 - 1.0 + first) * step;
            centre.max(far - centre)
        };
        let farthest =
            reach(grid.cells_x(), centre.0, 1.0).hypot(reach(grid.cells_y(), centre.1, step_y));
        let width = farthest.max(1.0) / (RINGS as f64 - 1.0);
        let cells_x = grid.cells_x();
        let of_rings = over_blocks(gap_m.len(), cells_x, |cells| {
            let mut least_gap_m = [f64::INFINITY; RINGS];
            let rows = gap_m[cells.clone()].chunks_exact(cells_x);
            for (iy, row) in (cells.start / cells_x..).zip(rows) {
                let dy = (iy as f64 + first) * step_y - centre.1;
                let inside = match frame.rows().contains(&iy) {
                    true => frame.columns(),
                    false => 0..0,
                };
                for (ix, &gap_m) in row.iter().enumerate() {
                    if !inside.contains(&ix) {
                        let distance = (ix as f64 + first - centre.0).hypot(dy);
                        let ring = &mut least_gap_m[((distance / width) as usize).min(RINGS - 1)];
                        *ring = ring.min(gap_m);
                    }
                }
            }
            least_gap_m
        });
        let least_gap_m = (0..RINGS).map(|ring| of_rings.least(ring)).collect();
        Self {
            frame,
            centre,
            width,
            least_gap_m,
        }
    }

    pub(super) fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Whether sources with these moments, of the whole surface, certainly keep every cell beyond the
    /// window at least as low as the approach asks for.
    pub(super) fn are_clear(&self, sources: &Moments, approach_m: f64, grid: &Grid) -> bool {
        let step_y = grid.spacing_y_m() / grid.spacing_x_m();
        let ((x, y), spread) = sources.centre_and_spread(step_y);
        let aside = (x - self.centre.0).hypot(y - self.centre.1);
        // A sum over cells of the area of a cell, seen from this many spacings away.
        let load_m = sources.sum().max(0.0) * grid.spacing_y_m() / PI;
        let clear = |(ring, &gap_m): (usize, &f64)| {
            let distance = (ring + 1) as f64 * self.width + aside;
            gap_m + load_m / (distance * distance + spread).sqrt() >= approach_m
        };
        self.least_gap_m.iter().enumerate().all(clear)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::half_space::convolution::Convolution;

    /// Cells of a field in turn, for its moments.
    fn moments(grid: &Grid, field: &[f64]) -> Moments {
        let step_y = grid.spacing_y_m() / grid.spacing_x_m();
        Moments::of(field, grid.cells_x(), (0.0, 0.0), step_y)
    }

    #[test]
    fn the_bounds_hold_for_any_load() {
        let grid = Grid::new(40, 33, 2.0e-6, 3.0e-6).unwrap();
        let convolution = Convolution::new(grid).unwrap();
        let mut state = 5_u64;
        for round in 0..20 {
            let mut field = vec![0.0; grid.cells()];
            for _ in 0..=round {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                field[(state >> 33) as usize % grid.cells()] = (state >> 40) as f64;
            }
            let mut displacement = vec![0.0; grid.cells()];
            let mut scratch = convolution.scratch();
            convolution
                .apply(&field, &mut displacement, &mut scratch)
                .unwrap();
            let moments = moments(&grid, &field);
            let products = field.iter().zip(&displacement).map(|(q, u)| q * u);
            let mean = products.sum::<f64>() / moments.sum();
            let bound = moments.mean_displacement_lower_bound(1.5) * grid.spacing_y_m();
            // A single cell's own bound is 0.88 of what a square has; never above.
            assert!(bound > 0.0 && bound < mean, "{bound} {mean}");
            // A gap just as wide as the approach less the true displacement is the least that any valid proof may accept.
            let frame = Frame {
                x: 10,
                y: 10,
                cells_x: 8,
                cells_y: 8,
            };
            let largest = displacement.iter().fold(0.0_f64, |l, u| l.max(*u));
            for share in [0.1, 0.5, 0.9, 0.999] {
                let approach_m = largest;
                let gaps: Vec<f64> = displacement
                    .iter()
                    .map(|u| approach_m - u - (1.0 - share) * u)
                    .collect();
                // Everywhere penetrating: no proof may be found.
                assert!(
                    !OutsideGapBound::new(&grid, &gaps, frame)
                        .are_clear(&moments, approach_m, &grid)
                );
            }
        }
    }

    #[test]
    fn a_sphere_is_known_to_be_clear_from_a_fifth_beyond_its_contact_on() {
        // Hertz: p = sqrt(1 - r^2/a^2) gives u = (pi/4)(2a - r^2/a), so that g = (pi/4) r^2/a and delta = (pi/2) a.
        let cells = 128;
        let grid = Grid::square(cells, 1.0).unwrap();
        let radius = 30.0_f64;
        let (mut field, mut gaps) = (Vec::new(), Vec::new());
        for cell in 0..grid.cells() {
            let (x, y) = grid.center(cell);
            let r2 = x * x + y * y;
            field.push((1.0 - r2 / radius.powi(2)).max(0.0).sqrt());
            gaps.push(std::f64::consts::FRAC_PI_4 * r2 / radius);
        }
        let sources = moments(&grid, &field);
        let approach = std::f64::consts::FRAC_PI_2 * radius;
        let clear = |side: usize| {
            let start = (cells - side) / 2;
            let frame = Frame {
                x: start,
                y: start,
                cells_x: side,
                cells_y: side,
            };
            OutsideGapBound::new(&grid, &gaps, frame).are_clear(&sources, approach, &grid)
        };
        assert!(clear(74));
        // Two cells beyond the contact the gap is a hundredth of the approach: too close for the bound.
        assert!(!clear(64));
    }
}
