//! Influence coefficients of a grid of cells: the formula of [Love](super::love) on a half-space, and what a layer adds to it.

use std::sync::Arc;

use super::grid::Grid;
use super::layer::LayerInfluence;
use super::love::rectangle_displacement_m;

/// Influence coefficients of a grid: the displacement of one cell's centre by unit pressure on another cell.
#[derive(Debug, Clone)]
pub struct Influence {
    unit_m: f64,
    half_x: f64,
    half_y: f64,
    /// What the body is in place of a half-space, where it is a layer.
    layer: Option<Arc<LayerInfluence>>,
}

impl Influence {
    /// The coefficients of this grid's cells.
    pub fn new(grid: &Grid) -> Self {
        // Lengths are counted in cell sides, so that the digits of a coefficient do not depend on the unit of length.
        let unit_m = grid.spacing_x_m();
        Self {
            unit_m,
            half_x: 0.5,
            half_y: 0.5 * grid.spacing_y_m() / unit_m,
            layer: None,
        }
    }

    /// The coefficients of this grid's cells on a layer, where there is one.
    pub fn on(grid: &Grid, layer: Option<Arc<LayerInfluence>>) -> Self {
        Self {
            layer,
            ..Self::new(grid)
        }
    }

    /// Displacement of the centre of a cell by unit pressure on the cell `offset_x` columns and `offset_y` rows away, in m
    /// (per Pa of pressure and 1/Pa of contact compliance). Accurate to a few units in the last place at any offset.
    pub fn coefficient_m(&self, offset_x: usize, offset_y: usize) -> f64 {
        let x = offset_x as f64;
        let y = offset_y as f64 * (2.0 * self.half_y);
        match &self.layer {
            None => self.unit_m * rectangle_displacement_m(x, y, self.half_x, self.half_y),
            Some(layer) => {
                let [x, y, a, b] = [x, y, self.half_x, self.half_y].map(|side| side * self.unit_m);
                layer.rectangle_displacement_m(x, y, a, b)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::love::tests::assert_close;
    use super::*;

    fn coefficient(i: usize, j: usize, spacing_x_m: f64, spacing_y_m: f64) -> f64 {
        let grid = Grid::new(4, 4, spacing_x_m, spacing_y_m).unwrap();
        Influence::new(&grid).coefficient_m(i, j)
    }

    #[test]
    fn coefficients_keep_their_digits_at_any_distance_and_aspect_ratio() {
        // Love's closed form evaluated with 60 digits.
        let exact = [
            (0, 0, 1.0, 1.0, 1.1221997046783603),
            (1, 0, 1.0, 1.0, 0.33042149328895687),
            (1, 1, 1.0, 1.0, 0.23067835905022324),
            (2, 1, 1.0, 1.0, 0.14358608454020144),
            (3, 0, 1.0, 1.0, 0.10658968464026208),
            (3, 2, 1.0, 1.0, 0.08857253191956765),
            (7, 8, 1.0, 1.0, 0.029955150077047004),
            (8, 0, 1.0, 1.0, 0.03981460441950987),
            (31, 5, 1.0, 1.0, 0.010137480250982713),
            (33, 0, 1.0, 1.0, 0.009646123157200077),
            (1000, 0, 1.0, 1.0, 0.00031830989944670144),
            (707, 707, 1.0, 1.0, 0.00031835797513494747),
            (4000, 1, 1.0, 1.0, 7.957746926638477e-05),
            (0, 0, 1.0, 3.0, 1.783042691256274),
            (1, 0, 1.0, 3.0, 0.7917782113894034),
            (0, 1, 1.0, 3.0, 0.34714901991109676),
            (4, 1, 1.0, 3.0, 0.19143925160846145),
            (0, 0, 100.0, 1.0, 4.009638673236004),
            (0, 1, 100.0, 1.0, 2.9606048631962865),
            (1, 0, 100.0, 1.0, 0.3496967947739949),
            (1, 50, 100.0, 1.0, 0.29827946851931336),
            (0, 250, 100.0, 1.0, 0.12649021608982114),
            (3, 40, 100.0, 1.0, 0.10611881685494891),
            (0, 1000, 100.0, 1.0, 0.03181774325103475),
            (1000, 1000, 100.0, 1.0, 0.00031829399839959),
        ];
        for (i, j, spacing_x, spacing_y, expected) in exact {
            let found = coefficient(i, j, spacing_x, spacing_y);
            // Worst case: the closed form just inside three sides, where its terms are a dozen times their sum.
            assert_close(
                found,
                expected,
                4.0e-15,
                &format!("({i}, {j}), {spacing_x}:{spacing_y}"),
            );
        }
    }

    #[test]
    fn the_cell_itself_follows_the_closed_form() {
        // Both are one evaluation of elementary functions: a few roundings.
        let square = 4.0 * 1.0_f64.asinh() / PI;
        assert_close(
            coefficient(0, 0, 2.0e-6, 2.0e-6),
            2.0e-6 * square,
            1e-15,
            "square",
        );
        let (a, b) = (0.5e-3_f64, 0.8e-3_f64);
        let rectangle = 4.0 / PI * (a * (b / a).asinh() + b * (a / b).asinh());
        assert_close(
            coefficient(0, 0, 1.0e-3, 1.6e-3),
            rectangle,
            1e-15,
            "rectangle",
        );
    }

    #[test]
    fn far_away_a_cell_is_a_point_load_with_an_error_of_second_order() {
        // Multipole expansion of a square: 1/r (1 + (h/r)^2/24 + (h/r)^4 c), |c| < 0.01 in any direction.
        for (i, j) in [(10, 0), (10, 10), (40, 9), (160, 36), (300, 400)] {
            let r = (i as f64).hypot(j as f64);
            let excess = coefficient(i, j, 1.0, 1.0) * PI * r - 1.0;
            let second_order = 1.0 / (24.0 * r * r);
            let tolerance = 0.02 * r.powi(-4) + 4.0e-15;
            assert!(
                (excess - second_order).abs() < tolerance,
                "({i}, {j}): {excess:e}"
            );
        }
    }

    #[test]
    fn turning_the_grid_by_a_right_angle_turns_the_coefficients() {
        for (i, j) in [(0, 0), (1, 0), (0, 3), (2, 5), (9, 40), (500, 3)] {
            let one = coefficient(i, j, 1.0, 1.3);
            // Only the order of additions and the unit differ.
            assert_close(coefficient(j, i, 1.3, 1.0), one, 4e-15, "turned");
        }
    }

    #[test]
    fn coefficients_scale_with_the_unit_of_length() {
        // Scaling by 1e-6 rounds the spacings, which moves the ratio of the sides by a unit in the last place.
        for (i, j) in [(0, 0), (1, 0), (1, 2), (5, 3), (30, 7), (1000, 999)] {
            for (spacing_x, spacing_y) in [(1.0, 1.0), (0.3, 0.7), (1.9, 1.1)] {
                let large = coefficient(i, j, spacing_x, spacing_y);
                let small = coefficient(i, j, 1.0e-6 * spacing_x, 1.0e-6 * spacing_y);
                assert_close(
                    small,
                    1.0e-6 * large,
                    1e-15,
                    &format!("({i}, {j}) {spacing_x}"),
                );
            }
        }
    }

    #[test]
    fn coefficients_fall_with_distance_across_every_switch() {
        let mut last = f64::INFINITY;
        for i in 0..200 {
            let value = coefficient(i, 2, 1.0, 1.0);
            assert!(value > 0.0 && value < last, "{i}");
            last = value;
        }
    }
}
