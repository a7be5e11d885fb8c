//! Lines along which a surface at one instant is shown: its radius, or the axes of its grid.

use crate::contact::half_space::grid::Grid;
use crate::contact::surface::{CellSurface, Surface};
use crate::simulation::{HistoryRow, SurfaceRecord};

/// One point of a profile. The pressure is absent where it is unbounded, the gap where there is no indenter or its place is
/// unknown.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ProfilePoint {
    pub position_m: f64,
    pub pressure_pa: Option<f64>,
    pub displacement_m: f64,
    pub gap_m: Option<f64>,
}

/// The surface at one instant along its lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    pub row: HistoryRow,
    /// The cells of the surface; `None` along a radius.
    pub grid: Option<Grid>,
    /// Along what, `r`, `x` or `y`, and the points.
    pub lines: Vec<(String, Vec<ProfilePoint>)>,
}

impl Profile {
    /// That of a surface.
    pub fn of(record: &SurfaceRecord) -> Self {
        let lines = lines(record).into_iter();
        Self {
            row: record.row,
            grid: grid(record),
            lines: lines
                .map(|(line, points)| (line.to_owned(), points))
                .collect(),
        }
    }
}

/// The cells of a surface.
pub fn grid(record: &SurfaceRecord) -> Option<Grid> {
    match &record.surface {
        Surface::Radial(_) => None,
        Surface::Cells(cells) => Some(cells.grid),
    }
}

/// The lines along which a surface is shown: its radius, or the axes of its grid.
pub fn lines(record: &SurfaceRecord) -> Vec<(&'static str, Vec<ProfilePoint>)> {
    let gap = |i: usize| {
        let gap = record.gap_m.as_ref().and_then(|gap| gap.get(i).copied());
        gap.filter(|gap| gap.is_finite())
    };
    match &record.surface {
        Surface::Radial(radial) => {
            let values = radial.pressure_pa.iter().zip(&radial.displacement_m);
            let points = radial.radius_m.iter().zip(values).enumerate();
            let point = |(i, (&position_m, (&pressure_pa, &displacement_m)))| ProfilePoint {
                position_m,
                pressure_pa,
                displacement_m,
                gap_m: gap(i),
            };
            vec![("r", points.map(point).collect())]
        }
        Surface::Cells(cells) => vec![
            ("x", centre_line(cells, &gap, cells.grid.centre_row())),
            ("y", centre_line(cells, &gap, cells.grid.centre_column())),
        ],
    }
}

/// Values along x or y through the centre, as [`Grid::centre_row`](crate::contact::half_space::grid::Grid::centre_row) finds
/// them.
fn centre_line(
    cells: &CellSurface,
    gap: &dyn Fn(usize) -> Option<f64>,
    places: Vec<(f64, [usize; 2])>,
) -> Vec<ProfilePoint> {
    let mean = |field: &[f64], [a, b]: [usize; 2]| 0.5 * (field[a] + field[b]);
    let point = |(position_m, pair): (f64, [usize; 2])| ProfilePoint {
        position_m,
        pressure_pa: Some(mean(&cells.pressure_pa, pair)),
        displacement_m: mean(&cells.displacement_m, pair),
        gap_m: gap(pair[0]).zip(gap(pair[1])).map(|(a, b)| 0.5 * (a + b)),
    };
    places.into_iter().map(point).collect()
}
