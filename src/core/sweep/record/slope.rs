//! How steep an indenter is within the contact, and what strain goes with it.
//!
//! Small strains and small slopes are one question for indenters: with s the slope of the indenter within the contact, the
//! representative strain is 0.2 s, which is 0.2 a/R for a sphere and 0.2 cot(alpha) for a cone (K. L. Johnson, Contact
//! Mechanics, 1985, section 6.3, after D. Tabor, 1951). A convex body of revolution is steepest at the edge of contact, where its
//! slope follows from the transformed gap G,
//!
//! ```text
//! g(r) = (2/pi) * integral from 0 to pi/2 of G(r sin(t)) dt          s = g'(a)
//! ```
//!
//! A body with a rim, such as a flat punch, presses its rim in by the whole approach: s is at least delta/a there, which
//! has the mean pressure of a sphere with 1.5 s. On cells s is the slope that 95 % of the contact area stay below, from
//! differences between cells that are both in contact: one bad point of a map, or the wall of a punch, does not count.
//!
//! Heating, adhesion and inertia are not judged: the program knows neither conductivity nor surface energy nor density.

use std::f64::consts::FRAC_PI_2;

use crate::contact::half_space::grid::Grid;
use crate::engine::domain;
use crate::indenter::{Axisymmetric, Indenter};
use crate::sweep::record::warning::{
    GLASSY_MODULUS_PA, LARGEST_GLASSY_STRAIN, LARGEST_SLOPE, STRAIN_PER_SLOPE, Warning,
};
use crate::sweep::record::{CaseResult, CellLoss, SurfaceLoss};

/// Share of the contact area, on cells, that a slope is not below.
const STEEPEST_SHARE: f64 = 0.05;
/// Rounding of what is compared with a limit.
pub(crate) const ROUNDING: f64 = 1e-9;

/// A slope within the contact, and the strain that goes with it in a material of this modulus.
pub(crate) fn slope_warnings(
    slope: Option<f64>,
    contact_radius_m: f64,
    modulus_pa: f64,
) -> Vec<Warning> {
    // A record holds finite numbers.
    let Some(slope) = slope.filter(|slope| slope.is_finite()) else {
        return Vec::new();
    };
    let strain = STRAIN_PER_SLOPE * slope;
    let largest_strain = LARGEST_GLASSY_STRAIN * (1.0 + ROUNDING);
    let large = modulus_pa >= GLASSY_MODULUS_PA && strain > largest_strain;
    let large = large.then_some(Warning::LargeStrain { strain });
    let steep = (slope > LARGEST_SLOPE * (1.0 + ROUNDING)).then_some(Warning::SteepSlope {
        slope,
        contact_radius_m,
    });
    large.into_iter().chain(steep).collect()
}

/// Slope within the largest contact of a cycle.
pub(crate) fn slope_of_case(indenter: &dyn Indenter, result: &CaseResult) -> Option<f64> {
    let (radius_m, approach_m) = (result.contact_radius_m.maximum, result.approach_m.maximum);
    match (indenter.axisymmetric(), &result.cycle.surface_loss) {
        (Some(body), _) => slope_of_body(body, radius_m, approach_m),
        (None, SurfaceLoss::Cells(loss)) => Patch::from_work(indenter, loss).steepest(),
        (None, SurfaceLoss::Radial { .. }) => None,
    }
}

/// Slope of a convex body of revolution at the edge of contact, or what a rim amounts to.
pub(crate) fn slope_of_body(
    body: &dyn Axisymmetric,
    radius_m: f64,
    approach_m: f64,
) -> Option<f64> {
    /// Points of the quadrature, and the part of the radius over which the gap is differentiated.
    const POINTS: usize = 64;
    const STEP: f64 = 1e-3;
    if radius_m <= 0.0 {
        return None;
    }
    let sine = |k: usize| (FRAC_PI_2 * (k as f64 + 0.5) / POINTS as f64).sin();
    let gap_m = |r_m: f64| {
        let sum: f64 = (0..POINTS)
            .map(|k| body.transformed_gap_m(r_m * sine(k)))
            .sum();
        sum / POINTS as f64
    };
    let inner_m = radius_m * (1.0 - STEP);
    let slope = (gap_m(radius_m) - gap_m(inner_m)) / (radius_m - inner_m);
    let rim = body.contact_limit_m().map(|limit_m| approach_m / limit_m);
    Some(slope.max(rim.unwrap_or(0.0)))
}

/// A rectangle of cells with the gap (m) of those in contact.
pub(crate) struct Patch {
    cells_x: usize,
    spacing_m: [f64; 2],
    gap_m: Vec<Option<f64>>,
}

impl Patch {
    /// The cells that a cycle was in contact with, which are those it did work on.
    fn from_work(indenter: &dyn Indenter, loss: &CellLoss) -> Self {
        let gap_m = |(cell, density): (usize, &f32)| {
            let (column, row) = (cell % loss.cells_x, cell / loss.cells_x);
            let x_m = loss.first_x_m + column as f64 * loss.spacing_x_m;
            let y_m = loss.first_y_m + row as f64 * loss.spacing_y_m;
            (*density != 0.0).then(|| indenter.gap_m(x_m, y_m))
        };
        Self {
            cells_x: loss.cells_x,
            spacing_m: [loss.spacing_x_m, loss.spacing_y_m],
            gap_m: loss
                .density_j_per_m2
                .iter()
                .enumerate()
                .map(gap_m)
                .collect(),
        }
    }

    /// The cells of least gap that together have this area (m2).
    pub(crate) fn lowest(indenter: &dyn Indenter, grid: &Grid, area_m2: f64) -> Self {
        let gaps_m = domain::gaps_m(indenter, grid);
        let mut order: Vec<usize> = (0..gaps_m.len()).collect();
        let cell_m2 = grid.spacing_x_m() * grid.spacing_y_m();
        let count = (area_m2 / cell_m2).round() as usize;
        if count < order.len() {
            order.select_nth_unstable_by(count, |a, b| gaps_m[*a].total_cmp(&gaps_m[*b]));
        }
        let mut gap_m = vec![None; gaps_m.len()];
        for cell in order.into_iter().take(count) {
            gap_m[cell] = Some(gaps_m[cell]);
        }
        Self {
            cells_x: grid.cells_x(),
            spacing_m: [grid.spacing_x_m(), grid.spacing_y_m()],
            gap_m,
        }
    }

    /// The slope that all but a small share of the contact stay below; `None` where no two cells in contact are neighbours.
    pub(crate) fn steepest(&self) -> Option<f64> {
        let mut slopes: Vec<f64> = (0..self.gap_m.len())
            .filter_map(|c| self.slope(c))
            .collect();
        slopes.sort_by(f64::total_cmp);
        let last = slopes.len().checked_sub(1)?;
        let at = ((1.0 - STEEPEST_SHARE) * last as f64).round() as usize;
        slopes.get(at).copied()
    }

    /// Slope in a cell, from those of its neighbours that are in contact too.
    fn slope(&self, cell: usize) -> Option<f64> {
        let here_m = self.gap_m.get(cell).copied().flatten()?;
        let column = cell % self.cells_x;
        let at = |cell: Option<usize>| self.gap_m.get(cell?).copied().flatten();
        let along = |has_before: bool, has_after: bool, stride: usize, spacing_m: f64| {
            let before = at(has_before.then(|| cell - stride));
            let after = at(has_after.then_some(cell + stride));
            difference(before, here_m, after).map(|d| d / spacing_m)
        };
        let [spacing_x_m, spacing_y_m] = self.spacing_m;
        let x = along(column > 0, column + 1 < self.cells_x, 1, spacing_x_m);
        let y = along(cell >= self.cells_x, true, self.cells_x, spacing_y_m);
        match (x, y) {
            (None, None) => None,
            (x, y) => Some(x.unwrap_or(0.0).hypot(y.unwrap_or(0.0))),
        }
    }
}

/// Difference per cell, central where both neighbours are there.
fn difference(before: Option<f64>, here: f64, after: Option<f64>) -> Option<f64> {
    match (before, after) {
        (Some(before), Some(after)) => Some(0.5 * (after - before)),
        (Some(before), None) => Some(here - before),
        (None, Some(after)) => Some(after - here),
        (None, None) => None,
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::indenter::{
        Asperities, Asperity, Cone, Ellipsoid, FlatPunch, HeightMap, MapEdge, MapQuantity,
        PowerLaw, Shifted, Sphere,
    };

    #[test]
    fn the_slope_at_the_edge_of_contact_is_that_of_the_shape() {
        let radius_m = 1e-3;
        let slope = |body: &dyn Indenter| {
            let body = body.axisymmetric().unwrap();
            slope_of_body(body, radius_m, 3e-5).unwrap()
        };
        let sphere = Arc::new(Sphere::new(0.01).unwrap());
        let shifted = Shifted::new(Arc::clone(&sphere) as _, 5e-3, 0.0).unwrap();
        let angle = 70_f64.to_radians();
        let power = PowerLaw::new(3.0, 1e-3, 1e-4).unwrap();
        // The gap is differentiated over a thousandth of the radius, inside of it: half of that times the exponent less one;
        // and the quadrature of a cone is good to 1/(24 n^2) of (pi/2)^2.
        for (slope, exact, tolerance) in [
            (slope(sphere.as_ref()), 0.1, 6e-4),
            (slope(&shifted), 0.1, 6e-4),
            (slope(&Cone::new(angle).unwrap()), angle.tan().recip(), 1e-4),
            (slope(&power), 0.3, 1.1e-3),
            (slope(&FlatPunch::new(2e-3).unwrap()), 0.015, 1e-12),
        ] {
            assert!((slope / exact - 1.0).abs() < tolerance, "{slope} {exact}");
        }
        let body = sphere.axisymmetric().unwrap();
        assert_eq!(slope_of_body(body, 0.0, 0.0), None);
    }

    /// The work of a cycle on cells within an ellipse of these half axes about a point.
    fn work(center_m: [f64; 2], axes_m: [f64; 2], cells: usize) -> CellLoss {
        let spacing = axes_m.map(|a| 2.0 * a / cells as f64);
        let at = |i: usize| (i as f64 + 0.5) / (0.5 * cells as f64) - 1.0;
        let inside = |cell: usize| at(cell % cells).hypot(at(cell / cells)) < 1.0;
        let density = (0..cells * cells).map(|cell| if inside(cell) { -1e-12 } else { 0.0 });
        CellLoss {
            first_x_m: center_m[0] - axes_m[0] + 0.5 * spacing[0],
            first_y_m: center_m[1] - axes_m[1] + 0.5 * spacing[1],
            spacing_x_m: spacing[0],
            spacing_y_m: spacing[1],
            cells_x: cells,
            density_j_per_m2: density.collect(),
        }
    }

    #[test]
    fn on_cells_the_slope_is_about_the_largest_within_the_contact() {
        let center_m = [3e-3, -1e-3];
        let sphere = Arc::new(Sphere::new(0.01).unwrap());
        let shifted = Shifted::new(sphere, center_m[0], center_m[1]).unwrap();
        let round = work(center_m, [1e-3, 1e-3], 40);
        let slope = Patch::from_work(&shifted, &round).steepest().unwrap();
        // 95 % of a disc lie within 0.975 of its radius; half a cell of 40 is 0.025 of it.
        assert!((slope / 0.1 - 0.975).abs() < 0.025, "{slope}");
        let flat = Ellipsoid::new(0.09, 0.01).unwrap();
        let oval = work([0.0; 2], [3e-3, 1e-3], 40);
        let slope = Patch::from_work(&flat, &oval).steepest().unwrap();
        // From 3 mm/90 mm to 1 mm/10 mm around the edge: near the latter end.
        assert!(slope > 0.085 && slope < 0.1, "{slope}");
        // One cell has no slope.
        assert_eq!(
            Patch::from_work(&shifted, &work([0.0; 2], [1e-3; 2], 1)).steepest(),
            None
        );
    }

    #[test]
    fn the_lowest_part_of_a_shape_is_where_its_asperities_are() {
        let asperity = |center_x_m, radius_m| Asperity {
            center_x_m,
            center_y_m: 0.0,
            radius_m,
            height_m: 0.0,
        };
        let pair = Asperities::new(vec![asperity(-1e-3, 1e-3), asperity(1e-3, 1e-3)]).unwrap();
        let grid = Grid::new(256, 128, 1e-5, 1e-5).unwrap();
        // Two spots of radius 0.1 mm, which is ten cells.
        let area_m2 = 2.0 * std::f64::consts::PI * 1e-8;
        let slope = Patch::lowest(&pair, &grid, area_m2).steepest().unwrap();
        assert!((slope / 0.1 - 0.95).abs() < 0.05, "{slope}");
    }

    #[test]
    fn the_wall_of_a_punch_and_what_is_beside_the_contact_have_no_slope() {
        let heights = (0..100).map(|i| match (i % 10, i / 10) {
            (2..=7, 2..=7) => 0.0,
            _ => -1e-3,
        });
        let map = HeightMap::new(
            (10, 10),
            (1e-5, 1e-5),
            heights.collect(),
            MapQuantity::Height,
            MapEdge::Rim,
        )
        .unwrap();
        let grid = Grid::new(10, 10, 1e-5, 1e-5).unwrap();
        let patch = Patch::lowest(&map, &grid, 36.0 * 1e-10);
        assert_eq!(patch.steepest(), Some(0.0));
    }

    #[test]
    fn strains_count_in_glassy_materials_and_slopes_in_all() {
        let codes = |slope, modulus_pa| -> Vec<&str> {
            let warnings = slope_warnings(Some(slope), 1e-3, modulus_pa);
            warnings.iter().map(Warning::code).collect()
        };
        assert!(codes(0.05, 3e9).is_empty());
        assert_eq!(codes(0.051, 3e9), ["large-strain"]);
        assert!(codes(0.2, 1e7).is_empty());
        assert_eq!(codes(0.201, 1e7), ["steep-slope"]);
        assert_eq!(codes(360.0, 3e9), ["large-strain", "steep-slope"]);
        assert!(codes(f64::INFINITY, 1e7).is_empty());
    }
}
