//! What a sweep's page carries of the surface at one frequency: where the work goes in, and the pressure at some instants.

use serde::Serialize;

use super::compact::{CoarseCells, coarse, picked, picked_optional, rounded, spread};
use crate::contact::surface::{Along, PressureLine};
use crate::drive::Control;
use crate::report::work_line::{WorkAlong, WorkLine};
use crate::sweep::record::{CellLoss, PressureProfile, SurfaceLoss};

/// Points of the line of work and of all lines of pressure together, and cells along a side of a map.
pub(super) struct Fineness {
    pub(super) work: usize,
    pub(super) pressure: usize,
    pub(super) map: usize,
}

/// A number of points that is `most` up to a hundred cases, as fine as can be seen, and falls with more of them, so that the page
/// stays light, to `least`.
pub(super) fn share(cases: usize, most: usize, least: usize) -> usize {
    (100 * most / cases.max(100)).max(least)
}

impl Fineness {
    /// On a page of so many cases. Maps weigh most: beyond 40 of them, each gets its part of as many cells.
    pub(super) fn of(cases: usize) -> Self {
        const CELLS: usize = 40 * 40 * 40;
        Self {
            work: share(cases, 80, 24),
            pressure: share(cases, 128, 48),
            map: (CELLS / cases.max(1)).isqrt().clamp(12, 40),
        }
    }
}

/// Density of the work over the surface: a line of it, and the map of what was solved on cells.
#[derive(Serialize)]
pub(super) struct WorkData {
    along: &'static str,
    /// Where the line runs and how it was made, in words.
    line: &'static str,
    position_m: Vec<f64>,
    density_j_per_m2: Vec<Option<f64>>,
    map: Option<MapData>,
}

#[derive(Serialize)]
struct MapData {
    #[serde(flatten)]
    cells: CoarseCells,
    values: Vec<Option<f64>>,
}

/// Pressure along one line or two, at the same instants.
#[derive(Serialize)]
pub(super) struct PressureData {
    instants: Vec<InstantData>,
    lines: Vec<LineData>,
}

#[derive(Serialize)]
struct InstantData {
    name: String,
    time_s: f64,
    load_n: f64,
    contact_radius_m: f64,
}

#[derive(Serialize)]
struct LineData {
    along: &'static str,
    /// Of every instant, or once of all.
    position_m: Vec<Vec<f64>>,
    pressure_pa: Vec<Vec<Option<f64>>>,
}

impl WorkData {
    pub(super) fn of(surface: &SurfaceLoss, line: &WorkLine, fineness: &Fineness) -> Self {
        let places = spread(line.points.len(), fineness.work);
        let (position_m, density): (Vec<f64>, Vec<Option<f64>>) =
            line.points.iter().copied().unzip();
        Self {
            along: line.along.symbol(),
            line: line.along.words(),
            position_m: picked(&position_m, &places),
            density_j_per_m2: picked_optional(&density, &places),
            map: match surface {
                SurfaceLoss::Radial { .. } => None,
                SurfaceLoss::Cells(cells) => Some(MapData::of(cells, fineness)),
            },
        }
    }
}

impl MapData {
    fn of(cells: &CellLoss, fineness: &Fineness) -> Self {
        let density = &cells.density_j_per_m2;
        let value = |i: usize| density.get(i).map(|v| f64::from(*v));
        let field = coarse(cells.cells_x, density.len(), value, fineness.map);
        Self {
            cells: field.cells(
                [cells.first_x_m, cells.first_y_m],
                [cells.spacing_x_m, cells.spacing_y_m],
            ),
            values: field.values,
        }
    }
}

impl PressureData {
    /// Of a contact whose work has a line along this: under an indenter of revolution, y is as x.
    pub(super) fn of<'a>(
        profiles: &'a [PressureProfile],
        work: WorkAlong,
        control: Control,
        fineness: &Fineness,
    ) -> Self {
        let instant = |profile: &PressureProfile| InstantData {
            name: profile.quarter.name(control),
            time_s: rounded(profile.time_s),
            load_n: rounded(profile.load_n),
            contact_radius_m: rounded(profile.contact_radius_m),
        };
        let shown = |along: &Along| *along != Along::Y || work == WorkAlong::X;
        let lines = [Along::Radius, Along::X, Along::Y].into_iter();
        let lines = lines.filter(shown);
        let of_all = |along: Along| -> Option<Vec<&PressureLine>> {
            let line =
                |profile: &'a PressureProfile| profile.lines.iter().find(|l| l.along == along);
            profiles.iter().map(line).collect()
        };
        let lines: Vec<Vec<&PressureLine>> = lines.filter_map(of_all).collect();
        let limit = fineness.pressure / lines.len().max(1);
        Self {
            instants: profiles.iter().map(instant).collect(),
            lines: lines
                .iter()
                .filter_map(|lines| LineData::of(lines, limit))
                .collect(),
        }
    }
}

impl LineData {
    fn of(lines: &[&PressureLine], limit: usize) -> Option<Self> {
        let first = lines.first()?;
        let same_places = lines.iter().all(|line| line.position_m == first.position_m);
        let kept = |line: &PressureLine| -> Vec<usize> {
            let (from, count) = match same_places {
                true => pressed(lines),
                false => (0, line.position_m.len()),
            };
            let places = spread(count, limit);
            places.into_iter().map(|place| from + place).collect()
        };
        let position_m = |line: &&PressureLine| picked(&line.position_m, &kept(line));
        let pressure_pa = |line: &&PressureLine| picked_optional(&line.pressure_pa, &kept(line));
        let with_places = if same_places { 1 } else { lines.len() };
        Some(Self {
            along: first.along.symbol(),
            position_m: lines.iter().take(with_places).map(position_m).collect(),
            pressure_pa: lines.iter().map(pressure_pa).collect(),
        })
    }
}

/// The first of the places where there is contact at any instant, with one more on either side, and how many they are.
fn pressed(lines: &[&PressureLine]) -> (usize, usize) {
    let is_pressed = |p: &Option<f64>| *p != Some(0.0);
    let pressures = || lines.iter().map(|line| line.pressure_pa.iter());
    let first = pressures().filter_map(|mut p| p.position(is_pressed));
    let last = pressures().filter_map(|mut p| p.rposition(is_pressed));
    let length = lines.first().map_or(0, |line| line.position_m.len());
    match (first.min(), last.max()) {
        (Some(first), Some(last)) => {
            let from = first.saturating_sub(1);
            (from, (last + 2).min(length).saturating_sub(from))
        }
        _ => (0, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(pressure_pa: &[f64]) -> PressureLine {
        PressureLine {
            along: Along::X,
            position_m: (0..pressure_pa.len()).map(|k| k as f64).collect(),
            pressure_pa: pressure_pa.iter().copied().map(Some).collect(),
        }
    }

    #[test]
    fn lines_over_the_same_cells_are_cut_to_where_any_of_them_presses() {
        let (wide, narrow) = (
            line(&[0., 0., 1., 2., 3., 0., 0.]),
            line(&[0., 0., 0., 4., 0., 0., 0.]),
        );
        let data = LineData::of(&[&wide, &narrow], 64).unwrap();
        assert_eq!(data.position_m, [[1.0, 2.0, 3.0, 4.0, 5.0]]);
        let values = |k: usize| {
            data.pressure_pa[k]
                .iter()
                .map(|p| p.unwrap())
                .collect::<Vec<_>>()
        };
        assert_eq!(values(0), [0., 1., 2., 3., 0.]);
        assert_eq!(values(1), [0., 0., 4., 0., 0.]);
        let nowhere = line(&[0.0; 7]);
        let data = LineData::of(&[&nowhere, &nowhere], 64).unwrap();
        assert_eq!(data.position_m, [Vec::<f64>::new()]);
    }

    #[test]
    fn lines_that_end_at_their_own_edges_keep_their_places() {
        let (long, short) = (line(&[3.0, 2.0, 1.0, 0.0]), line(&[1.0, 0.0]));
        let data = LineData::of(&[&long, &short], 64).unwrap();
        assert_eq!(data.position_m, [vec![0.0, 1.0, 2.0, 3.0], vec![0.0, 1.0]]);
        assert!(LineData::of(&[], 64).is_none());
    }
}
