//! A quantity over both axes of a sweep, frequency and the second one, as a map: coloured between the cases, which are dots.

use super::curve::{Curve, SweepCurves};
use super::moduli_error::WIDE;
use super::{axis, scale};
use crate::report::chart::{Axis, Chart, HeatMap, MapShape, Scale};
use crate::report::number::range;
use crate::report::table::Cell;
use crate::sweep::plan::Axes;
use crate::sweep::record::CaseRecord;

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
pub fn chart(sweep: &SweepCurves<'_>, axes: &Axes, mapped: Mapped<'_>) -> Option<Chart> {
    let varied = axes.varied();
    let to_omega = sweep.units.frequency().0;
    let (first, last) = range(sweep.records().map(|r| r.angular_frequency_rad_per_s));
    let (low, high) = (sweep.values().next()?, sweep.values().next_back()?);
    if first >= last || low >= high {
        return None;
    }
    let unit = sweep.units.varied(&varied, low.abs().max(high.abs()));
    let title = unit.title(&varied, sweep.plan.base.drive.control());
    let x = Axis::log(sweep.units.frequency_title()).range(to_omega * first, to_omega * last);
    let y = axis((low, high), WIDE, title).range(unit.of(low), unit.of(high));
    let value_scale = scale(
        range(sweep.records().filter_map(mapped.value)),
        WIDE_COLOURS,
    );
    let curves = sweep.curves.iter();
    let rows = curves.filter_map(|curve| Row::of(curve, [y.scale, value_scale], mapped.value));
    let grid = Grid {
        rows: rows.collect(),
    };
    let on = |scale: Scale, (from, to): (f64, f64), k: usize, count: usize| {
        let (from, to) = (scale.linearised(from), scale.linearised(to));
        from + (to - from) * (k as f64 + 0.5) / count as f64
    };
    let cell = |i: usize| {
        let x = on(Scale::Log, (first, last), i % COLUMNS, COLUMNS);
        let y = on(y.scale, (low, high), i / COLUMNS, ROWS);
        Some(value_scale.value(grid.at(x, y)?))
    };
    let values: Vec<Option<f64>> = (0..COLUMNS * ROWS).map(cell).collect();
    values.iter().any(Option::is_some).then_some(())?;
    let place = |omega: f64, value: f64| (to_omega * omega, unit.of(value));
    let points = sweep.curves.iter().flat_map(|curve| {
        let value = curve.condition.number();
        let there = curve.records.iter().filter(|r| (mapped.value)(r).is_some());
        there.filter_map(move |r| Some(place(r.angular_frequency_rad_per_s, value?)))
    });
    let rings = mapped.rings.iter();
    let map = HeatMap {
        columns: COLUMNS,
        rows: ROWS,
        values,
        value_label: mapped.label,
        value_range: None,
        value_scale,
        contours: true,
        points: match has_dots(sweep) {
            true => points.collect(),
            false => Vec::new(),
        },
        rings: rings.map(|(omega, value)| place(*omega, *value)).collect(),
        shape: MapShape::Stretched,
    };
    Some(Chart::new(x, y).map(map))
}

fn has_dots(sweep: &SweepCurves<'_>) -> bool {
    sweep.records().count() <= DOTS
}

/// What a map shows of the cases: dots, where they have room.
pub fn words(sweep: &SweepCurves<'_>) -> &'static str {
    match has_dots(sweep) {
        true => "Dots: computed cases, coloured linearly between",
        false => "Coloured linearly between the computed cases",
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

/// The two neighbours of a number among ascending ones, and how far it is from the first to the second.
fn neighbours<T>(all: &[T], number: impl Fn(&T) -> f64, of: f64) -> Option<(&T, &T, f64)> {
    let above = all.partition_point(|one| number(one) < of).max(1);
    let (low, high) = (all.get(above - 1)?, all.get(above)?);
    Some((low, high, (of - number(low)) / (number(high) - number(low))))
}

impl Grid {
    /// Linear between the neighbours; `None` beside a case without a value.
    fn at(&self, x: f64, y: f64) -> Option<f64> {
        let (low, high, part) = neighbours(&self.rows, |row| row.place, y)?;
        let (from, to) = (low.at(x)?, high.at(x)?);
        Some(from + part * (to - from))
    }
}

impl Row {
    fn of(
        curve: &Curve<'_>,
        [y_scale, value_scale]: [Scale; 2],
        value: &dyn Fn(&CaseRecord) -> Option<f64>,
    ) -> Option<Self> {
        let case = |record: &&CaseRecord| {
            let value = value(record).map(|value| value_scale.linearised(value));
            (record.angular_frequency_rad_per_s.log10(), value)
        };
        Some(Self {
            place: y_scale.linearised(curve.condition.number()?),
            cases: curve.records.iter().map(case).collect(),
        })
    }

    fn at(&self, x: f64) -> Option<f64> {
        let (left, right, part) = neighbours(&self.cases, |case| case.0, x)?;
        let (from, to) = (left.1?, right.1?);
        Some(from + part * (to - from))
    }
}

/// A column of a table: its name, and its value for a case.
pub type Column<'a> = (&'a str, &'a dyn Fn(&CaseRecord) -> Option<f64>);

/// The table behind a map: the cases.
pub fn data(sweep: &SweepCurves<'_>, columns: &[Column<'_>]) -> Vec<u8> {
    let mut names = vec!["angular_frequency_rad_per_s"];
    names.extend(columns.iter().map(|(name, _)| name));
    let rows = sweep.records().map(|record| {
        let numbers = columns.iter().map(|(_, value)| value(record).into());
        let omega = Cell::from(record.angular_frequency_rad_per_s);
        let numbers = [omega].into_iter().chain(numbers);
        (sweep.place_of(record), numbers.collect::<Vec<_>>())
    });
    sweep.table(&[], &names, rows)
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
