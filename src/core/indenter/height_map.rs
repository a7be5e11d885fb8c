//! The height map: a measured or computed indenter, given by one value per cell of a regular grid.

use super::{Domain, Indenter, IndenterError, POSITION, Setting};
use crate::quantity::Dimension;
use crate::quantity::key::{Entries, Kind, quantity, words_of};
use crate::{keys, words};

/// Fewest points of a map in each direction: a contact needs a border of cells around it.
pub(super) const MIN_CELLS: usize = 3;
/// Most points of a map: 2^24, that is 4096 x 4096.
pub(super) const MAX_CELLS: usize = 1 << 24;

/// Share of a cell up to which a place beside a point is that point.
const ON_POINT_TOLERANCE: f64 = 1e-6;

words! {
    /// What the values of a map are.
    pub enum MapQuantity {
        /// Heights of the indenter's surface, positive towards the half-space: the highest point touches first.
        Height = "height",
        /// The gap itself: the lowest point touches first.
        Gap = "gap",
    }
}

words! {
    /// What is beyond the border of a map.
    pub enum MapEdge {
        /// The indenter goes on, though nobody knows how: contact at the border is an error.
        Unknown = "unknown",
        /// The indenter ends half a cell beyond the outer points, as a punch does.
        Rim = "rim",
        /// The map is one period of a surface that repeats itself along x and along y without end.
        Periodic = "periodic",
    }
}

/// Units of heights by their names, the one that counts where none is given first: how many of it make a metre, to which values
/// are brought by a single rounding.
pub const HEIGHT_UNITS: [(&str, f64); 6] = [
    ("m", 1.0),
    ("mm", 1e3),
    ("um", 1e6),
    ("µm", 1e6),
    ("nm", 1e9),
    ("pm", 1e12),
];

const UNIT_WORDS: [&str; HEIGHT_UNITS.len()] = words_of(&HEIGHT_UNITS);

words! {
    /// What is subtracted from the values of a map before they count.
    pub enum MapLevel {
        None = "none",
        /// Their mean, which leaves the gap as it is: that counts from the point that touches first.
        Mean = "mean",
        /// The plane through them by least squares: the tilt of the instrument.
        Plane = "plane",
    }
}

keys! {
    /// Distance between points of a matrix, or one for x and one for y; not for files with columns `x_m`, `y_m`, `z_m`.
    MAP_SPACING = "spacing", Kind::Numbers(quantity(Dimension::Length).above_zero(), Entries::of(1..=2, POSITION)), optional;
    /// Whether values are heights, positive towards the half-space, or gaps.
    MAP_QUANTITY = "quantity", Kind::Word(MapQuantity::WORDS), or MapQuantity::Height;
    /// Unit of the values of a matrix.
    HEIGHT_UNIT = "height_unit", Kind::Word(&UNIT_WORDS), or UNIT_WORDS[0].to_owned();
    /// What is subtracted from the values first: nothing, their mean, or the best-fit plane.
    LEVEL = "level", Kind::Word(MapLevel::WORDS), or MapLevel::None;
    /// What lies outside the map: unknown, so the contact must stay within; nothing (`rim`); or periodic repetitions of the map
    /// (`periodic`), under a prescribed load.
    EDGE = "edge", Kind::Word(MapEdge::WORDS), or MapEdge::Unknown;
}

impl MapLevel {
    /// Subtracts it from values given row by row, `cells_x` in a row.
    pub fn subtract(self, cells_x: usize, values: &mut [f64]) {
        let count = values.len() as f64;
        if self == Self::None || values.is_empty() {
            return;
        }
        let mean = values.iter().sum::<f64>() / count;
        values.iter_mut().for_each(|z| *z -= mean);
        if self == Self::Mean {
            return;
        }
        // About the middle of a grid the two directions do not mix, and either slope is a quotient of two sums.
        let cells_y = values.len() / cells_x;
        let middle = |cells: usize| 0.5 * (cells as f64 - 1.0);
        let place = |at: usize| {
            let (column, row) = (at % cells_x, at / cells_x);
            [
                column as f64 - middle(cells_x),
                row as f64 - middle(cells_y),
            ]
        };
        let (mut moment, mut inertia) = ([0.0; 2], [0.0; 2]);
        for (at, z) in values.iter().enumerate() {
            let place = place(at);
            for axis in 0..2 {
                moment[axis] += place[axis] * z;
                inertia[axis] += place[axis] * place[axis];
            }
        }
        let slope = [0, 1].map(|axis| match inertia[axis] > 0.0 {
            true => moment[axis] / inertia[axis],
            false => 0.0,
        });
        for (at, z) in values.iter_mut().enumerate() {
            let [x, y] = place(at);
            *z -= slope[0] * x + slope[1] * y;
        }
    }
}

/// A rigid indenter given on a grid that is centred on the origin. The least gap counts as 0: a map whose points miss the
/// summit of what it was taken from touches at its own highest point, and approaches are counted from there.
///
/// The half-space engine puts one cell on every point. On a grid of other spacing the gap is interpolated bilinearly.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    /// Points along x and y, and their distances.
    cells: (usize, usize),
    spacing_m: (f64, f64),
    /// Row by row, x fastest, rows in the order of ascending y.
    gap_m: Vec<f64>,
    edge: MapEdge,
    shape: &'static str,
    parameters: Vec<Setting>,
}

impl HeightMap {
    /// A map of `cells.0` by `cells.1` points, `spacing_m` (x, y) apart, from values (m) row by row, x fastest, the first row
    /// at the smallest y.
    ///
    /// # Errors
    /// [`IndenterError`] for fewer than 3 points in a direction, more than 2^24 in all, another number of values, values
    /// that are not finite, and spacings that are no lengths.
    pub fn new(
        cells: (usize, usize),
        spacing_m: (f64, f64),
        values_m: Vec<f64>,
        quantity: MapQuantity,
        edge: MapEdge,
    ) -> Result<Self, IndenterError> {
        let (cells_x, cells_y) = cells;
        let expected = cells_x.saturating_mul(cells_y);
        if cells_x.min(cells_y) < MIN_CELLS || expected > MAX_CELLS {
            return Err(IndenterError::MapSize { cells_x, cells_y });
        }
        if values_m.len() != expected {
            return Err(IndenterError::MapLength {
                found: values_m.len(),
                expected,
            });
        }
        if let Some(at) = values_m.iter().position(|z| !z.is_finite()) {
            return Err(IndenterError::MapHole {
                column: at % cells_x + 1,
                row: at / cells_x + 1,
                value: values_m[at],
            });
        }
        for each_m in [spacing_m.0, spacing_m.1] {
            super::positive_length("spacing", each_m)?;
        }
        let parameters = [
            MAP_QUANTITY.setting(quantity),
            MAP_SPACING.setting(vec![spacing_m.0, spacing_m.1]),
            HEIGHT_UNIT.setting(HEIGHT_UNITS[0].0.to_owned()),
            LEVEL.setting(MapLevel::None),
            EDGE.setting(edge),
        ];
        Ok(Self {
            cells,
            spacing_m,
            gap_m: gap_from(values_m, quantity),
            edge,
            shape: Self::SHAPE,
            parameters: parameters.into_iter().flatten().collect(),
        })
    }

    /// The shape of a map of values, as written in a sweep file.
    pub const SHAPE: &'static str = "height-map";

    /// The same map under the shape and the settings from which it was made: a file, or a rough surface.
    pub fn made_from(self, shape: &'static str, parameters: Vec<Setting>) -> Self {
        Self {
            shape,
            parameters,
            ..self
        }
    }

    /// Points along x and y.
    pub fn cells(&self) -> (usize, usize) {
        self.cells
    }

    /// Distance (m) between points along x and y.
    pub fn spacing_m(&self) -> (f64, f64) {
        self.spacing_m
    }

    /// Gap (m) at every point, row by row.
    pub fn gaps_m(&self) -> &[f64] {
        &self.gap_m
    }

    /// What lies beyond the border.
    pub fn edge(&self) -> MapEdge {
        self.edge
    }
}

/// Gaps from values: the point that touches first gets gap 0.
fn gap_from(mut values_m: Vec<f64>, quantity: MapQuantity) -> Vec<f64> {
    let fold = |start: f64, pick: fn(f64, f64) -> f64| values_m.iter().copied().fold(start, pick);
    match quantity {
        MapQuantity::Height => {
            let highest_m = fold(f64::NEG_INFINITY, f64::max);
            values_m.iter_mut().for_each(|z| *z = highest_m - *z);
        }
        MapQuantity::Gap => {
            let lowest_m = fold(f64::INFINITY, f64::min);
            values_m.iter_mut().for_each(|z| *z -= lowest_m);
        }
    }
    values_m
}

/// The two neighbouring points of a place on one axis, and the share of the second; `None` where the map has ended.
fn neighbours(
    position_m: f64,
    spacing_m: f64,
    cells: usize,
    edge: MapEdge,
) -> Option<(usize, usize, f64)> {
    let last = (cells - 1) as f64;
    let place = position_m / spacing_m + 0.5 * last;
    let nearest = place.round();
    let place = match (place - nearest).abs() <= ON_POINT_TOLERANCE {
        true => nearest,
        false => place,
    };
    let beyond = match edge {
        MapEdge::Unknown => 0.0,
        MapEdge::Rim => 0.5,
        MapEdge::Periodic => {
            let place = place.rem_euclid(cells as f64);
            // Rounding may make a whole period of a tiny part below zero.
            let index = place.floor() as usize % cells;
            return Some((index, (index + 1) % cells, place - place.floor()));
        }
    };
    if !(-beyond..=last + beyond).contains(&place) {
        return None;
    }
    let place = place.clamp(0.0, last);
    let first = place.floor();
    let index = first as usize;
    Some((index, (index + 1).min(cells - 1), place - first))
}

/// a, b or between; an end of the range is met exactly.
fn between(a: f64, b: f64, share: f64) -> f64 {
    if share == 0.0 { a } else { a + share * (b - a) }
}

impl Indenter for HeightMap {
    fn shape(&self) -> &'static str {
        self.shape
    }

    fn parameters(&self) -> Vec<Setting> {
        self.parameters.clone()
    }

    fn not_axisymmetric_because(&self) -> String {
        let of_what = match self.shape {
            Self::SHAPE => "",
            _ => "surface ",
        };
        format!("{of_what}is not a body of revolution")
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        let columns = neighbours(x_m, self.spacing_m.0, self.cells.0, self.edge);
        let rows = neighbours(y_m, self.spacing_m.1, self.cells.1, self.edge);
        let (Some((left, right, along_x)), Some((lower, upper, along_y))) = (columns, rows) else {
            return f64::INFINITY;
        };
        let along_row = |row: usize| {
            let row = row * self.cells.0;
            between(self.gap_m[row + left], self.gap_m[row + right], along_x)
        };
        between(along_row(lower), along_row(upper), along_y)
    }

    /// Half the longer side of the map: what any contact with it fits into.
    fn elastic_half_width_m(&self, _load_n: f64, _compliance_per_pa: f64) -> f64 {
        let x_m = self.cells.0 as f64 * self.spacing_m.0;
        let y_m = self.cells.1 as f64 * self.spacing_m.1;
        0.5 * x_m.max(y_m)
    }

    /// A cell on every point; around a rim one more on each side, which stays empty.
    fn domain(&self, _load_n: f64, _compliance_per_pa: f64) -> Domain {
        let border = if self.edge == MapEdge::Rim { 2 } else { 0 };
        Domain::Cells {
            cells: (self.cells.0 + border, self.cells.1 + border),
            spacing_m: self.spacing_m,
        }
    }

    fn own_cells(&self) -> Option<(usize, usize)> {
        Some(self.cells())
    }

    fn ends_in_data(&self) -> bool {
        self.edge == MapEdge::Unknown
    }

    fn is_periodic(&self) -> bool {
        self.edge == MapEdge::Periodic
    }

    fn pressure_is_bounded(&self) -> bool {
        self.edge == MapEdge::Unknown
    }
}

#[cfg(test)]
mod tests {
    use super::super::Sphere;
    use super::*;

    fn map(edge: MapEdge) -> HeightMap {
        // Four columns, three rows; highest at column 3, row 2.
        let values = vec![0.0, 1.0, 2.0, 1.0, 1.0, 3.0, 7.0, 2.0, 0.0, 1.0, 4.0, 1.0];
        HeightMap::new((4, 3), (0.1, 0.3), values, MapQuantity::Height, edge).unwrap()
    }

    #[test]
    fn the_highest_point_of_heights_and_the_lowest_of_gaps_touches_first() {
        let heights = map(MapEdge::Unknown);
        let gaps = HeightMap::new(
            (4, 3),
            (0.1, 0.3),
            heights.gaps_m().iter().map(|g| g + 12.0).collect(),
            MapQuantity::Gap,
            MapEdge::Unknown,
        )
        .unwrap();
        assert_eq!(gaps.gaps_m(), heights.gaps_m());
        assert_eq!(heights.gaps_m()[6], 0.0);
        assert_eq!(heights.gaps_m()[0], 7.0);
    }

    #[test]
    fn points_are_met_exactly_and_between_them_the_gap_is_bilinear() {
        let map = map(MapEdge::Unknown);
        for (index, &gap) in map.gaps_m().iter().enumerate() {
            let x = ((index % 4) as f64 - 1.5) * 0.1;
            let y = ((index / 4) as f64 - 1.0) * 0.3;
            assert_eq!(map.gap_m(x, y), gap);
        }
        // The mean of the four points 3, 7, 1, 4 of height 7 at most.
        let middle = map.gap_m(0.0, 0.15);
        assert!((middle - (7.0 - 3.75)).abs() < 1e-14, "{middle}");
    }

    #[test]
    fn beyond_the_outer_points_nothing_is_known_but_a_rim_reaches_half_a_cell_further() {
        let (open, rim) = (map(MapEdge::Unknown), map(MapEdge::Rim));
        assert_eq!(open.gap_m(0.151, 0.0), f64::INFINITY);
        assert_eq!(rim.gap_m(0.199, 0.0), 5.0);
        assert_eq!(rim.gap_m(0.201, 0.0), f64::INFINITY);
        assert_eq!(rim.gap_m(0.0, -0.46), f64::INFINITY);
        assert!(open.ends_in_data() && !rim.ends_in_data());
        assert!(open.pressure_is_bounded() && !rim.pressure_is_bounded());
        let cells = |map: &HeightMap| match map.domain(1.0, 1.0) {
            Domain::Cells { cells, .. } => cells,
            Domain::Around { .. } => (0, 0),
        };
        assert_eq!((cells(&open), cells(&rim)), ((4, 3), (6, 5)));
    }

    #[test]
    fn bilinear_interpolation_of_a_sphere_is_of_second_order() {
        let sphere = Sphere::new(0.01).unwrap();
        let error = |cells: usize| {
            let spacing = 1e-3 / (cells - 1) as f64;
            let at = |i: usize| (i as f64 - 0.5 * (cells - 1) as f64) * spacing;
            let values = (0..cells * cells)
                .map(|i| sphere.gap_m(at(i % cells), at(i / cells)))
                .collect();
            let gap = MapQuantity::Gap;
            let map = HeightMap::new(
                (cells, cells),
                (spacing, spacing),
                values,
                gap,
                MapEdge::Unknown,
            )
            .unwrap();
            (0..1000)
                .map(|i| 4.9e-7 * f64::from(i))
                .map(|x| (map.gap_m(x, -0.3 * x) - sphere.gap_m(x, -0.3 * x)).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(21) / error(41)).log2();
        assert!((order - 2.0).abs() < 0.1, "{order}");
    }

    #[test]
    fn maps_that_are_too_small_or_have_holes_are_refused() {
        let refused = |cells, values: Vec<f64>| {
            let map = HeightMap::new(
                cells,
                (1.0, 1.0),
                values,
                MapQuantity::Gap,
                MapEdge::Unknown,
            );
            map.unwrap_err().to_string()
        };
        assert!(refused((2, 3), vec![0.0; 6]).contains("2 x 3"));
        assert!(refused((3, 3), vec![0.0; 8]).contains("8 values where 9"));
        assert!(refused((usize::MAX, 3), Vec::new()).contains("at most"));
        let mut holed = vec![0.0; 12];
        holed[7] = f64::NAN;
        assert!(refused((4, 3), holed).contains("column 4, row 2"));
        let spacing = HeightMap::new(
            (3, 3),
            (1.0, 0.0),
            vec![0.0; 9],
            MapQuantity::Gap,
            MapEdge::Unknown,
        );
        assert!(matches!(spacing, Err(IndenterError::Length { .. })));
    }
}
