//! A quantity over both axes of a sweep, frequency and the second one, as a map: coloured between the cases, which are dots.

use super::curve::{Curve, place_columns, place_of};
use super::moduli_error::WIDE;
use super::units::Units;
use crate::report::chart::{HeatMap, MapShape, Scale};
use crate::report::number::range;
use crate::report::table::csv_leading;
use crate::sweep::plan::{Axes, SweepPlan};
use crate::sweep::record::CaseRecord;

const WIDTH_PX: u32 = 800;
const HEIGHT_PX: u32 = 600;
/// Cells that are coloured.
const COLUMNS: usize = 128;
const ROWS: usize = 96;
/// Cases that are dots, at most; more would hide the colours.
const DOTS: usize = 6000;
/// Values that vary by more than this have colours on a logarithmic scale.
const WIDE_COLOURS: f64 = 30.0;

/// What is mapped.
pub struct Mapped<'a> {
    pub value: &'a dyn Fn(&CaseRecord) -> Option<f64>,
    pub label: String,
    /// (angular frequency, varied number) of what is pointed out.
    pub rings: Vec<(f64, f64)>,
}

/// The map; `None` where there are not two frequencies under each of two conditions to colour between.
pub fn map(
    plan: &SweepPlan,
    axis: &Axes,
    (curves, units): (&[Curve<'_>], &Units),
    mapped: Mapped<'_>,
) -> Option<HeatMap> {
    let control = plan.drive.control();
    let to_omega = units.frequency().0;
    let records = || curves.iter().flat_map(|curve| &curve.records);
    let values = records().filter_map(|record| (mapped.value)(record));
    let value_scale = scale(range(values), WIDE_COLOURS);
    let values = || curves.iter().filter_map(|curve| curve.condition.value());
    let (low, high) = (values().next()?, values().next_back()?);
    let unit = units.varied(&axis.varied(), low.abs().max(high.abs()));
    let y_scale = scale((low, high), WIDE);
    let x_range = range(records().map(|record| record.angular_frequency_rad_per_s));
    if x_range.0 >= x_range.1 || low >= high {
        return None;
    }
    let grid = Grid {
        rows: curves
            .iter()
            .filter_map(|curve| row(curve, y_scale, value_scale, mapped.value))
            .collect(),
    };
    let centre = |(from, to): (f64, f64), k: usize, count: usize| {
        from + (to - from) * (k as f64 + 0.5) / count as f64
    };
    let (x, y) = (
        (x_range.0.log10(), x_range.1.log10()),
        (on(y_scale, low), on(y_scale, high)),
    );
    let cell = |i: usize| {
        let value = grid.at(
            centre(x, i % COLUMNS, COLUMNS),
            centre(y, i / COLUMNS, ROWS),
        )?;
        Some(match value_scale {
            Scale::Linear => value,
            Scale::Log => 10_f64.powf(value),
        })
    };
    let coloured: Vec<Option<f64>> = (0..COLUMNS * ROWS).map(cell).collect();
    coloured.iter().any(Option::is_some).then_some(())?;
    let points = curves.iter().flat_map(|curve| {
        let value = curve.condition.value().map(|value| unit.of(value));
        let there = curve.records.iter().filter(|r| (mapped.value)(r).is_some());
        there.filter_map(move |r| Some((to_omega * r.angular_frequency_rad_per_s, value?)))
    });
    Some(HeatMap {
        title: None,
        x_label: units.frequency_title(),
        y_label: unit.title(&axis.varied(), control),
        x_range: (to_omega * x_range.0, to_omega * x_range.1),
        y_range: (unit.of(low), unit.of(high)),
        x_scale: Scale::Log,
        y_scale,
        columns: COLUMNS,
        rows: ROWS,
        values: coloured,
        value_label: mapped.label,
        value_range: None,
        value_scale,
        contours: true,
        points: match records().count() > DOTS {
            true => Vec::new(),
            false => points.collect(),
        },
        rings: mapped
            .rings
            .iter()
            .map(|(x, y)| (to_omega * x, unit.of(*y)))
            .collect(),
        width_px: WIDTH_PX,
        shape: MapShape::HeightPx(HEIGHT_PX),
    })
}

/// What a map shows of these cases: dots, where they have room.
pub fn words(curves: &[Curve<'_>]) -> &'static str {
    let cases: usize = curves.iter().map(|curve| curve.records.len()).sum();
    match cases > DOTS {
        true => "Coloured linearly between the computed cases",
        false => "Dots: computed cases, coloured linearly between",
    }
}

fn scale((least, largest): (f64, f64), wide: f64) -> Scale {
    if least > 0.0 && largest > wide * least {
        Scale::Log
    } else {
        Scale::Linear
    }
}

/// A number on a scale.
fn on(scale: Scale, value: f64) -> f64 {
    match scale {
        Scale::Linear => value,
        Scale::Log => value.log10(),
    }
}

/// Values on their scale, row by row, each along its own frequencies.
struct Grid {
    rows: Vec<Row>,
}

/// One value of the second axis, and (logarithm of the frequency, value or `None`), ascending.
struct Row {
    place: f64,
    cases: Vec<(f64, Option<f64>)>,
}

fn row(
    curve: &Curve<'_>,
    y_scale: Scale,
    value_scale: Scale,
    value: &dyn Fn(&CaseRecord) -> Option<f64>,
) -> Option<Row> {
    let case = |record: &&CaseRecord| {
        let value = value(record).map(|value| on(value_scale, value));
        (record.angular_frequency_rad_per_s.log10(), value)
    };
    Some(Row {
        place: on(y_scale, curve.condition.value()?),
        cases: curve.records.iter().map(case).collect(),
    })
}

impl Grid {
    /// Linear between the neighbours; `None` beside a case without a value.
    fn at(&self, x: f64, y: f64) -> Option<f64> {
        let above = self.rows.partition_point(|row| row.place < y).max(1);
        let (low, high) = (self.rows.get(above - 1)?, self.rows.get(above)?);
        let part = (y - low.place) / (high.place - low.place);
        let (from, to) = (low.at(x)?, high.at(x)?);
        Some(from + part * (to - from))
    }
}

impl Row {
    fn at(&self, x: f64) -> Option<f64> {
        let right = self.cases.partition_point(|case| case.0 < x).max(1);
        let (left, right) = (self.cases.get(right - 1)?, self.cases.get(right)?);
        let part = (x - left.0) / (right.0 - left.0);
        let (from, to) = (left.1?, right.1?);
        Some(from + part * (to - from))
    }
}

/// A column of a table: its name, and its value for a case.
pub type Column<'a> = (&'a str, &'a dyn Fn(&CaseRecord) -> Option<f64>);

/// The table behind a map: the cases.
pub fn data<const N: usize>(
    axis: &Axes,
    (curves, units): (&[Curve<'_>], &Units),
    columns: [Column<'_>; N],
) -> Vec<u8> {
    let unit = units.frequency_unit();
    let mut names = place_columns(Some(axis));
    names.push("angular_frequency_rad_per_s".to_owned());
    names.extend(columns.iter().map(|(name, _)| (*name).to_owned()));
    let rows = curves
        .iter()
        .flat_map(|curve| &curve.records)
        .map(|record| {
            let mut row = place_of(Some(axis), record);
            row.push(record.angular_frequency_rad_per_s.into());
            row.extend(columns.iter().map(|(_, value)| value(record).into()));
            row
        });
    csv_leading(unit, &names, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_the_cases_a_bilinear_function_is_reproduced_and_beside_a_gap_is_nothing() {
        let f = |x: f64, y: f64| 1.0 + 2.0 * x - 3.0 * y + 0.5 * x * y;
        let row = |y: f64, xs: &[f64]| Row {
            place: y,
            cases: xs.iter().map(|&x| (x, Some(f(x, y)))).collect(),
        };
        let mut grid = Grid {
            // Each row has frequencies of its own.
            rows: vec![row(0.0, &[0.0, 1.0, 4.0]), row(2.0, &[0.0, 2.0, 4.0])],
        };
        for (x, y) in [(0.3, 0.1), (1.7, 1.9), (3.9, 1.0), (0.0, 0.0), (4.0, 2.0)] {
            assert!((grid.at(x, y).unwrap() - f(x, y)).abs() < 1e-14);
        }
        assert_eq!(grid.at(4.1, 1.0), None);
        grid.rows[0].cases[1].1 = None;
        assert_eq!(grid.at(0.3, 0.1), None);
    }
}
