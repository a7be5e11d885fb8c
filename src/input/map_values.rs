//! What the values of a height map mean: their unit, and what is subtracted from them; and whether the map is a surface that contact can
//! be computed for.

use crate::indenter::height_map::{HEIGHT_UNIT, HEIGHT_UNITS, LEVEL, MAP_SPACING, MapLevel};
use crate::indenter::{HeightMap, IndenterError, MapEdge, MapQuantity, Setting};
use crate::numerics::order::upper_median;
use crate::quantity::key::Key;

/// The median slope of a map above which it is no surface in contact. Of rough surfaces, paraboloids, punches with walls and maps
/// with 5 % of bad points the median was at most 0.6 (a cone 30 degrees from flat); the same heights in micrometres read as metres
/// gave 2e4 and more. The root mean square is above 1 for walls and bad points, too.
const STEEPEST_MAP: f64 = 1.0;

/// How the values of a map were read.
pub(super) struct MapReading {
    /// Whether the file gives the place of every point in metres, and with it the spacing and the unit of the heights.
    pub gives_places: bool,
    /// As in [`HEIGHT_UNITS`].
    pub unit_per_m: f64,
    pub level: MapLevel,
}

/// Why a map is refused: the message, what is said at its place, and what to write instead.
pub(super) type Refusal = (String, String, String);

impl MapReading {
    /// Why a map that was read like this is refused, where it is.
    pub(super) fn refusal(&self, map: &HeightMap, name: &str) -> Option<Refusal> {
        self.too_steep(map, name)
            .or_else(|| self.at_border(map, name))
    }

    /// A setting of the map as the file was read, without what the file gives itself.
    pub(super) fn parameter(&self, own: Setting) -> Option<Setting> {
        let is = |key: &Key| own.key == key.name;
        if self.gives_places && (is(&MAP_SPACING) || is(&HEIGHT_UNIT)) {
            return None;
        }
        if is(&HEIGHT_UNIT) {
            let mut units = HEIGHT_UNITS.iter();
            let unit = units.find(|(_, per_m)| *per_m == self.unit_per_m)?;
            return HEIGHT_UNIT.setting(unit.0.to_owned());
        }
        match is(&LEVEL) {
            true => LEVEL.setting(self.level),
            false => Some(own),
        }
    }

    /// Refuses a map that is steep all over: its heights are in another unit than they are read in, or it is tilted.
    fn too_steep(&self, map: &HeightMap, name: &str) -> Option<Refusal> {
        let slope = median_slope(map);
        if slope <= STEEPEST_MAP {
            return None;
        }
        let is_cure = |per_m: f64| slope * self.unit_per_m / per_m <= STEEPEST_MAP;
        let named = HEIGHT_UNITS.iter().filter(|(key, _)| key.is_ascii());
        let units: Vec<String> = named
            .filter(|(_, per_m)| is_cure(*per_m))
            .map(|(key, _)| format!("height_unit = \"{key}\""))
            .collect();
        let tilted = without_plane(map).is_ok_and(|flat| median_slope(&flat) <= STEEPEST_MAP);
        let help = match (tilted, self.gives_places) {
            (true, _) => "if the map is tilted, write level = \"plane\"".to_owned(),
            (_, true) => "convert the column z_m to metres".to_owned(),
            _ if units.is_empty() => "check heights and `spacing`".to_owned(),
            _ => format!(
                "write the unit that the heights are in, {}, and check `spacing`",
                units.join(" or ")
            ),
        };
        let mut units = HEIGHT_UNITS.iter();
        let read_in = units.find(|(_, per_m)| *per_m == self.unit_per_m);
        Some((
            format!("`{name}`: half of the map is steeper than {slope:.1e}"),
            format!(
                "contact is computed for slopes far below 1; heights are read in {}",
                read_in.map_or("", |(key, _)| key)
            ),
            help,
        ))
    }

    /// Refuses a map whose contact begins where its data end.
    fn at_border(&self, map: &HeightMap, name: &str) -> Option<Refusal> {
        let (MapEdge::Unknown, Some((column, row))) = (map.edge(), touches_at_border(map)) else {
            return None;
        };
        let tilted = self.level != MapLevel::Plane
            && without_plane(map).is_ok_and(|flat| touches_at_border(&flat).is_none());
        let help = match tilted {
            true => "if the map is tilted, write level = \"plane\"",
            false => {
                "give a map that reaches further, or edge = \"rim\" where the indenter ends there"
            }
        };
        Some((
            format!("`{name}`: the map touches first on its border, at column {column}, row {row}"),
            "beyond the border the shape is not known".to_owned(),
            help.to_owned(),
        ))
    }
}

/// The slope that half of a map does not exceed. It tells heights in another unit than they are read in, whatever walls,
/// flat parts and bad points a map has: on surfaces that small slopes describe it is far below 1, on the same heights in
/// micrometres read as metres far above.
fn median_slope(map: &HeightMap) -> f64 {
    let ((cells_x, cells_y), (spacing_x_m, spacing_y_m)) = (map.cells(), map.spacing_m());
    let (gaps_m, last_x, last_y) = (map.gaps_m(), cells_x - 1, cells_y - 1);
    let slope = |at: usize| {
        let cell = at / last_x * cells_x + at % last_x;
        let along_x = (gaps_m[cell + 1] - gaps_m[cell]) / spacing_x_m;
        let along_y = (gaps_m[cell + cells_x] - gaps_m[cell]) / spacing_y_m;
        along_x.hypot(along_y)
    };
    upper_median((0..last_x * last_y).map(slope)).unwrap_or(0.0)
}

/// The same map without the plane through its points.
fn without_plane(map: &HeightMap) -> Result<HeightMap, IndenterError> {
    let (cells, mut gaps_m) = (map.cells(), map.gaps_m().to_vec());
    MapLevel::Plane.subtract(cells.0, &mut gaps_m);
    HeightMap::new(cells, map.spacing_m(), gaps_m, MapQuantity::Gap, map.edge())
}

/// Column and row, counted from 1, of a point on the border that touches first, where one does: contact begins there.
fn touches_at_border(map: &HeightMap) -> Option<(usize, usize)> {
    let (cells_x, cells_y) = map.cells();
    let place = |at: usize| (at % cells_x + 1, at / cells_x + 1);
    let is_border = |(x, y): &(usize, usize)| [1, cells_x].contains(x) || [1, cells_y].contains(y);
    let points = map.gaps_m().iter().enumerate();
    let mut first = points.filter(|(_, gap_m)| **gap_m == 0.0);
    first.find_map(|(at, _)| Some(place(at)).filter(is_border))
}

#[cfg(test)]
mod tests {
    use super::*;

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
            MapLevel::Plane.subtract(cells_x, &mut values);
            // Sums of tens of numbers of size 30.
            assert!(values.iter().all(|z| z.abs() < 1e-13), "{values:?}");
        }
        // What is left is at right angles to every plane.
        let mut values: Vec<f64> = (0..20).map(|i| f64::from(i * i % 13)).collect();
        MapLevel::Plane.subtract(5, &mut values);
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
        MapLevel::Mean.subtract(3, &mut values);
        assert_eq!(values, [-2.0, -1.0, 3.0]);
        MapLevel::None.subtract(3, &mut values);
        assert_eq!(values, [-2.0, -1.0, 3.0]);
    }

    #[test]
    fn a_tilted_map_touches_at_its_border_and_without_its_plane_where_it_did() {
        let bump = |x: f64, y: f64| -1e-3 * (x * x + y * y);
        let straight = square(31, bump);
        let tilted = square(31, |x, y| bump(x, y) + 0.1 * x - 0.07 * y);
        assert_eq!(touches_at_border(&straight), None);
        assert_eq!(touches_at_border(&tilted), Some((31, 1)));
        let cured = without_plane(&tilted).unwrap();
        assert_eq!(touches_at_border(&cured), None);
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
            let own = median_slope(&square(cells, height));
            let wrong = median_slope(&square(cells, |x, y| 1e6 * height(x, y)));
            assert!(own < 0.6 && wrong > 1e4, "{name}: {own:e}, {wrong:e}");
        }
        // Walls are walls in any unit.
        let punch = |x: f64, y: f64| if round(x, y) < 20.0 { 0.0 } else { -1e6 };
        assert_eq!(median_slope(&square(64, punch)), 0.0);
    }
}
