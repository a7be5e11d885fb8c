//! The height map: a measured or computed indenter, given by one value per cell of a regular grid.

use super::{DataFile, Domain, Indenter, IndenterError, Parameter, Value};
use crate::quantity::Dimension;

/// Fewest points of a map in each direction: a contact needs a border of cells around it.
pub(super) const MIN_CELLS: usize = 3;
/// Most points of a map: 2^24, that is 4096 x 4096.
pub(super) const MAX_CELLS: usize = 1 << 24;

/// Share of a cell up to which a place beside a point is that point.
const ON_POINT_TOLERANCE: f64 = 1e-6;

/// What the values of a map are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapQuantity {
    /// Heights of the indenter's surface, positive towards the half-space: the highest point touches first.
    Height,
    /// The gap itself: the lowest point touches first.
    Gap,
}

/// What is beyond the border of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapEdge {
    /// The indenter goes on, though nobody knows how: contact at the border is an error.
    Unknown,
    /// The indenter ends half a cell beyond the outer points, as a punch does.
    Rim,
    /// The map is one period of a surface that repeats itself along x and along y without end.
    Periodic,
}

/// What is taken off the values of a map before they count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapLevel {
    None,
    /// Their mean, which leaves the gap as it is: that counts from the point that touches first.
    Mean,
    /// The plane through them by least squares: the tilt of the instrument.
    Plane,
}

/// The unit of the values of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightUnit {
    /// The name as written in a sweep file.
    pub name: &'static str,
    /// How many of it make a metre, to which values are brought by a single rounding.
    pub per_m: f64,
}

const fn unit(name: &'static str, per_m: f64) -> (&'static str, HeightUnit) {
    (name, HeightUnit { name, per_m })
}

/// Units of heights by their names, the one that counts where none is given first.
pub const HEIGHT_UNITS: [(&str, HeightUnit); 6] = [
    unit("m", 1.0),
    unit("mm", 1e3),
    unit("um", 1e6),
    ("µm", unit("um", 1e6).1),
    unit("nm", 1e9),
    unit("pm", 1e12),
];

/// The file a map was read from, and how it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct MapSource {
    pub data: DataFile,
    /// Whether the file gives the place of every point in metres, and with it the spacing and the unit of the heights.
    pub gives_places: bool,
    pub height_unit: HeightUnit,
    pub level: MapLevel,
}

impl MapLevel {
    /// Names as written in a sweep file.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("none", Self::None),
        ("mean", Self::Mean),
        ("plane", Self::Plane),
    ];

    /// Takes it off values given row by row, `cells_x` in a row.
    pub fn take_off(self, cells_x: usize, values: &mut [f64]) {
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

impl MapQuantity {
    /// Names as written in a sweep file.
    pub const NAMES: [(&'static str, Self); 2] = [("height", Self::Height), ("gap", Self::Gap)];
}

impl MapEdge {
    /// Names as written in a sweep file.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("unknown", Self::Unknown),
        ("rim", Self::Rim),
        ("periodic", Self::Periodic),
    ];

    pub(super) fn parameter(self) -> Parameter {
        Parameter::choice("edge", &Self::NAMES, self)
    }
}

/// A rigid indenter given on a grid that is centred on the origin. The least gap counts as 0: a map whose points miss the
/// summit of what it was taken from touches at its own highest point, and approaches are counted from there.
///
/// The half-space engine puts one cell on every point. On a grid of other spacing the gap is interpolated bilinearly.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    cells_x: usize,
    cells_y: usize,
    spacing_x_m: f64,
    spacing_y_m: f64,
    /// Row by row, x fastest, rows in the order of ascending y.
    gap_m: Vec<f64>,
    quantity: MapQuantity,
    edge: MapEdge,
    source: Option<MapSource>,
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
        Ok(Self {
            cells_x,
            cells_y,
            spacing_x_m: super::positive_length("spacing", spacing_m.0)?,
            spacing_y_m: super::positive_length("spacing", spacing_m.1)?,
            gap_m: gap_from(values_m, quantity),
            quantity,
            edge,
            source: None,
        })
    }

    /// The same map, which remembers the file it was read from.
    pub fn with_source(self, source: MapSource) -> Self {
        Self {
            source: Some(source),
            ..self
        }
    }

    /// Points along x and y.
    pub fn cells(&self) -> (usize, usize) {
        (self.cells_x, self.cells_y)
    }

    /// The slope that half of the map does not exceed. It tells heights in another unit than they are read in, whatever walls,
    /// flat parts and bad points a map has: on surfaces that small slopes describe it is far below 1, on the same heights in
    /// micrometres read as metres far above.
    pub fn median_slope(&self) -> f64 {
        let (last_x, last_y) = (self.cells_x - 1, self.cells_y - 1);
        let slope = |at: usize| {
            let cell = at / last_x * self.cells_x + at % last_x;
            let along_x = (self.gap_m[cell + 1] - self.gap_m[cell]) / self.spacing_x_m;
            let along_y = (self.gap_m[cell + self.cells_x] - self.gap_m[cell]) / self.spacing_y_m;
            along_x.hypot(along_y)
        };
        let mut slopes: Vec<f64> = (0..last_x * last_y).map(slope).collect();
        let middle = slopes.len() / 2;
        *slopes.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// The same map without the plane through its points.
    pub fn without_plane(&self) -> Self {
        let mut gap_m = self.gap_m.clone();
        MapLevel::Plane.take_off(self.cells_x, &mut gap_m);
        Self {
            gap_m: gap_from(gap_m, MapQuantity::Gap),
            source: None,
            ..*self
        }
    }

    /// Column and row, counted from 1, of a point on the border that touches first, where one does: contact begins there.
    pub fn touches_at_border(&self) -> Option<(usize, usize)> {
        let place = |at: usize| (at % self.cells_x + 1, at / self.cells_x + 1);
        let is_border = |(x, y): &(usize, usize)| {
            [1, self.cells_x].contains(x) || [1, self.cells_y].contains(y)
        };
        let first = self
            .gap_m
            .iter()
            .enumerate()
            .filter(|(_, gap_m)| **gap_m == 0.0);
        first.map(|(at, _)| place(at)).find(is_border)
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
    let place = if (place - nearest).abs() <= ON_POINT_TOLERANCE {
        nearest
    } else {
        place
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
        "height-map"
    }

    /// The file and how to read it; a map made of values in memory has no file.
    fn parameters(&self) -> Vec<Parameter> {
        let source = self.source.as_ref();
        let data = source.iter().flat_map(|source| source.data.parameters());
        let mut parameters: Vec<Parameter> = data.collect();
        parameters.push(Parameter::choice(
            "quantity",
            &MapQuantity::NAMES,
            self.quantity,
        ));
        if source.is_none_or(|source| !source.gives_places) {
            let spacing = vec![self.spacing_x_m, self.spacing_y_m];
            let spacing = Value::Quantities(spacing, Dimension::Length);
            parameters.push(Parameter::new("spacing", spacing));
            let unit = source.map_or(HEIGHT_UNITS[0].0, |source| source.height_unit.name);
            parameters.push(Parameter::text("height_unit", unit));
        }
        let level = source.map_or(MapLevel::None, |source| source.level);
        let level = Parameter::choice("level", &MapLevel::NAMES, level);
        parameters.extend([level, self.edge.parameter()]);
        parameters
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        let columns = neighbours(x_m, self.spacing_x_m, self.cells_x, self.edge);
        let rows = neighbours(y_m, self.spacing_y_m, self.cells_y, self.edge);
        let (Some((left, right, along_x)), Some((lower, upper, along_y))) = (columns, rows) else {
            return f64::INFINITY;
        };
        let along_row = |row: usize| {
            let row = row * self.cells_x;
            between(self.gap_m[row + left], self.gap_m[row + right], along_x)
        };
        between(along_row(lower), along_row(upper), along_y)
    }

    /// Half the longer side of the map: what any contact with it fits into.
    fn elastic_half_width_m(&self, _load_n: f64, _compliance_per_pa: f64) -> f64 {
        let x_m = self.cells_x as f64 * self.spacing_x_m;
        let y_m = self.cells_y as f64 * self.spacing_y_m;
        0.5 * x_m.max(y_m)
    }

    /// A cell on every point; around a rim one more on each side, which stays empty.
    fn domain(&self, _load_n: f64, _compliance_per_pa: f64) -> Domain {
        let border = match self.edge {
            MapEdge::Unknown | MapEdge::Periodic => 0,
            MapEdge::Rim => 2,
        };
        Domain::Cells {
            cells_x: self.cells_x + border,
            cells_y: self.cells_y + border,
            spacing_x_m: self.spacing_x_m,
            spacing_y_m: self.spacing_y_m,
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
            Domain::Cells {
                cells_x, cells_y, ..
            } => (cells_x, cells_y),
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

    /// Heights on `cells` by `cells` points, in units of their spacing.
    fn square(cells: usize, height: impl Fn(f64, f64) -> f64) -> HeightMap {
        let at = |i: usize| i as f64 - 0.5 * (cells - 1) as f64;
        let values = (0..cells * cells).map(|i| height(at(i % cells), at(i / cells)));
        let (cells, edge) = ((cells, cells), MapEdge::Unknown);
        HeightMap::new(
            cells,
            (1.0, 1.0),
            values.collect(),
            MapQuantity::Height,
            edge,
        )
        .unwrap()
    }

    #[test]
    fn the_plane_of_least_squares_is_taken_off_and_the_mean_with_it() {
        // A plane alone leaves nothing, on even and odd numbers of points.
        for (cells_x, cells_y) in [(4, 7), (5, 3)] {
            let plane = |at: usize| 7.0 + 2.0 * (at % cells_x) as f64 - 3.0 * (at / cells_x) as f64;
            let mut values: Vec<f64> = (0..cells_x * cells_y).map(plane).collect();
            MapLevel::Plane.take_off(cells_x, &mut values);
            // Sums of tens of numbers of size 30.
            assert!(values.iter().all(|z| z.abs() < 1e-13), "{values:?}");
        }
        // What is left is at right angles to every plane.
        let mut values: Vec<f64> = (0..20).map(|i| f64::from(i * i % 13)).collect();
        MapLevel::Plane.take_off(5, &mut values);
        let moment = |weight: fn(usize) -> f64| -> f64 {
            values.iter().enumerate().map(|(i, z)| z * weight(i)).sum()
        };
        for moment in [
            moment(|_| 1.0),
            moment(|i| (i % 5) as f64),
            moment(|i| (i / 5) as f64),
        ] {
            assert!(moment.abs() < 1e-12, "{moment:e}");
        }
        let mut values = vec![1.0, 2.0, 6.0];
        MapLevel::Mean.take_off(3, &mut values);
        assert_eq!(values, [-2.0, -1.0, 3.0]);
        MapLevel::None.take_off(3, &mut values);
        assert_eq!(values, [-2.0, -1.0, 3.0]);
    }

    #[test]
    fn a_tilted_map_touches_at_its_border_and_without_its_plane_where_it_did() {
        let bump = |x: f64, y: f64| -1e-3 * (x * x + y * y);
        let straight = square(31, bump);
        let tilted = square(31, |x, y| bump(x, y) + 0.1 * x - 0.07 * y);
        assert_eq!(straight.touches_at_border(), None);
        assert_eq!(tilted.touches_at_border(), Some((31, 1)));
        let cured = tilted.without_plane();
        assert_eq!(cured.touches_at_border(), None);
        let pairs = cured.gaps_m().iter().zip(straight.gaps_m());
        // Heights are of size 3.
        assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-13));
    }

    /// The choice of the median, on maps in their own unit and in micrometres read as metres: see the comment at the limit.
    #[test]
    fn the_median_slope_tells_a_wrong_unit_and_no_wall_or_bad_point() {
        let round = |x: f64, y: f64| x.hypot(y);
        let noise = |x: f64, y: f64| ((x * 12.9898 + y * 78.233).sin() * 43_758.5).fract();
        type Height<'a> = &'a dyn Fn(f64, f64) -> f64;
        let maps: [(&str, usize, Height<'_>); 6] = [
            ("paraboloid", 64, &|x, y| -2e-3 * (x * x + y * y)),
            ("paraboloid of few points", 9, &|x, y| {
                -2e-3 * (x * x + y * y)
            }),
            ("cone 30 degrees from flat", 64, &|x, y| {
                -0.577 * round(x, y)
            }),
            ("rough", 64, &|x, y| 0.3 * noise(x, y)),
            (
                "rough with 5 % bad points",
                64,
                &|x, y| match noise(y, x).abs() > 0.95 {
                    true => 100.0,
                    false => 0.3 * noise(x, y),
                },
            ),
            ("tilted", 64, &|x, y| 0.02 * x + 0.01 * noise(x, y)),
        ];
        for (name, cells, height) in maps {
            let own = square(cells, height).median_slope();
            let wrong = square(cells, |x, y| 1e6 * height(x, y)).median_slope();
            assert!(own < 0.6 && wrong > 1e4, "{name}: {own:e}, {wrong:e}");
        }
        // Walls are walls in any unit.
        let punch = |x: f64, y: f64| if round(x, y) < 20.0 { 0.0 } else { -1e6 };
        assert_eq!(square(64, punch).median_slope(), 0.0);
    }
}
