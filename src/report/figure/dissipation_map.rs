//! Where the energy goes in, over the surface: the work per cycle and area of the case of the largest loss.

use super::curve::{Curve, SweepCurves};
use super::quantity::WORK_PER_AREA;
use super::units::{Measure, Units};
use super::{Drawn, Figure};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, HeatMap, MapShape};
use crate::report::number::{largest, with_error};
use crate::report::table::{cells, csv};
use crate::sweep::record::{CaseRecord, SurfaceLoss};

/// Steps along the radius of what is revolved, and beyond it to the edge of the map.
const ALONG_RADIUS: usize = 250;
const BEYOND: usize = 10;

/// The figure, of one curve.
pub fn figure(sweep: &SweepCurves<'_>, curve: &Curve<'_>) -> Drawn {
    const NOTHING: &str = "no dissipation map: nothing is dissipated";
    let (record, result) = curve.largest_result().ok_or(NOTHING)?;
    let field = Field::of(&result.cycle.surface_loss).ok_or(NOTHING)?;
    let case = sweep.label_of(record);
    let title = match &curve.label {
        Some(label) => format!("{case}, {label}"),
        None => case,
    };
    Ok(Figure {
        name: "dissipation-map".into(),
        picture: field.chart(title, &sweep.units).into(),
        caption: caption(sweep, curve, record),
        data: data(&result.cycle.surface_loss),
    })
}

fn caption(sweep: &SweepCurves<'_>, curve: &Curve<'_>, record: &CaseRecord) -> Caption {
    let at = sweep.label_of(record);
    let loss = record.energy_loss_j().map(|loss_j| {
        let loss = with_error(loss_j, record.energy_loss_error_j(), Dimension::Energy);
        format!("Its integral over the surface is the energy loss per cycle, {loss}.")
    });
    Caption::new(format!(
        "Work that the indenter does on the surface per cycle and area, at {at}, of the computed cases that of the largest loss"
    ))
    .say_all(curve.sentence.clone().into_iter().chain(loss))
}

/// Densities (J/m2) on a grid of cells, or along the radius of what is turned.
struct Field {
    x_range_m: (f64, f64),
    y_range_m: (f64, f64),
    map: HeatMap,
}

impl Field {
    /// `None` where there is nothing to be seen.
    fn of(surface: &SurfaceLoss) -> Option<Self> {
        let field = match surface {
            SurfaceLoss::Radial {
                radius_m,
                density_j_per_m2,
            } => Self::revolved(radius_m, density_j_per_m2)?,
            SurfaceLoss::Cells(cells) => {
                let rows = cells.density_j_per_m2.len().checked_div(cells.cells_x)?;
                let range = |first_m: f64, spacing_m: f64, cells: usize| {
                    let start_m = first_m - 0.5 * spacing_m;
                    (start_m, start_m + cells as f64 * spacing_m)
                };
                // Cells of the rectangle that were never in contact are blank.
                let value = |density: &f32| (*density != 0.0).then_some(f64::from(*density));
                Self {
                    x_range_m: range(cells.first_x_m, cells.spacing_x_m, cells.cells_x),
                    y_range_m: range(cells.first_y_m, cells.spacing_y_m, rows),
                    map: HeatMap {
                        columns: cells.cells_x,
                        rows,
                        values: cells.density_j_per_m2.iter().map(value).collect(),
                        ..HeatMap::default()
                    },
                }
            }
        };
        let mut values = field.map.values.iter().flatten();
        let seen = values.any(|density| *density != 0.0);
        seen.then_some(field)
    }

    /// A profile along a radius, turned about the axis.
    fn revolved(radius_m: &[f64], density: &[Option<f64>]) -> Option<Self> {
        let outer_m = radius_m.last().copied().filter(|outer_m| *outer_m > 0.0)?;
        let step_m = outer_m / ALONG_RADIUS as f64;
        let columns = ALONG_RADIUS + BEYOND;
        let edge_m = step_m * columns as f64;
        let at = |step: usize| {
            let r_m = step_m * (step as f64 + 0.5);
            let outer = radius_m.partition_point(|&r| r < r_m);
            let inner = outer.saturating_sub(1);
            let (from_m, to_m) = (*radius_m.get(inner)?, *radius_m.get(outer)?);
            let (from, to) = ((*density.get(inner)?)?, (*density.get(outer)?)?);
            let part = match to_m > from_m {
                true => (r_m - from_m) / (to_m - from_m),
                false => 0.0,
            };
            Some(from + part * (to - from))
        };
        Some(Self {
            x_range_m: (-edge_m, edge_m),
            y_range_m: (-edge_m, edge_m),
            map: HeatMap {
                columns,
                rows: 1,
                values: (0..columns).map(at).collect(),
                shape: MapShape::Turned,
                ..HeatMap::default()
            },
        })
    }

    fn chart(self, title: String, units: &Units) -> Chart {
        let [(left, right), (low, high)] = [self.x_range_m, self.y_range_m];
        let reach = [left, right, low, high].map(f64::abs);
        let length = units.shown(Measure::Length, largest(reach));
        let densities = self.map.values.iter().flatten();
        let density = units.shown(Measure::EnergyPerArea, largest(densities.map(|d| d.abs())));
        let mut map = self.map;
        map.value_label = density.title(&WORK_PER_AREA.words);
        for value in map.values.iter_mut().flatten() {
            *value = density.of(*value);
        }
        let axis = |name: &str, from: f64, to: f64| {
            Axis::linear(length.title(name)).range(length.of(from), length.of(to))
        };
        Chart::new(axis("x", left, right), axis("y", low, high))
            .title(title)
            .map(map)
    }
}

/// The field as it was computed: along a radius, or cell by cell.
fn data(surface: &SurfaceLoss) -> Vec<u8> {
    match surface {
        SurfaceLoss::Radial {
            radius_m,
            density_j_per_m2,
        } => {
            let points = radius_m.iter().zip(density_j_per_m2);
            csv(
                &["radius_m", "work_j_per_m2"],
                points.map(|(r_m, density)| cells![*r_m, *density]),
            )
        }
        SurfaceLoss::Cells(cells) => {
            let columns = cells.cells_x.max(1);
            let densities = cells.density_j_per_m2.iter().enumerate();
            let rows = densities.map(|(cell, density)| {
                cells![
                    cells.first_x_m + (cell % columns) as f64 * cells.spacing_x_m,
                    cells.first_y_m + (cell / columns) as f64 * cells.spacing_y_m,
                    format!("{density:e}"),
                ]
            });
            csv(&["x_m", "y_m", "work_j_per_m2"], rows)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_revolved_profile_has_the_values_of_its_radius_and_nothing_beyond() {
        let radius: Vec<f64> = (0..=50).map(|k| f64::from(k) * 1e-6).collect();
        let density: Vec<_> = radius.iter().map(|r| Some(3.0 - 2e4 * r)).collect();
        let field = Field::revolved(&radius, &density).unwrap();
        let step = 50.0e-6 / ALONG_RADIUS as f64;
        for (k, value) in field.map.values.iter().enumerate() {
            let r = (k as f64 + 0.5) * step;
            match value {
                // Linear in r, which linear interpolation reproduces but for rounding.
                Some(value) => assert!((value - (3.0 - 2e4 * r)).abs() < 1e-12),
                None => assert!(r > 50.0e-6),
            }
        }
        assert!((field.x_range_m.1 - 52.0e-6).abs() < 1e-18);
        assert!(Field::revolved(&[], &[]).is_none());
    }
}
