//! A quantity over two axes of a sweep as a map, coloured between the cases: over frequency and a second axis, or at one frequency
//! over two axes.

use super::curve::{Curve, SweepCurves};
use super::plot::Plot;
use super::quantity::{Quantity, Spread, WIDE, is_even, scale};
use super::trace::{Point, Trace};
use super::{Drawn, Figure};
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, HeatMap, MapShape, Scale};
use crate::report::number::{largest, range};
use crate::sweep::record::CaseRecord;

/// Cells that are coloured.
const COLUMNS: usize = 128;
const ROWS: usize = 96;
/// Values along each axis from which a map shows more than curves do.
const LEAST: usize = 4;
/// Cases that are dots, at most; more would hide the colours.
const DOTS: usize = 200;
/// Values that vary by more than this have colours on a logarithmic scale.
const WIDE_COLOURS: f64 = 30.0;

/// What is mapped.
pub struct Mapped<'a> {
    pub name: &'static str,
    pub caption: Caption,
    pub quantity: Quantity,
    pub value: &'a dyn Fn(&CaseRecord) -> Option<f64>,
    pub error: &'a dyn Fn(&CaseRecord) -> Option<f64>,
    /// (place on the abscissa, on the second axis) of what is pointed out.
    pub rings: Vec<(f64, f64)>,
}

/// The map of a sweep whose curves are a family.
pub fn figure(sweep: &SweepCurves<'_>, mapped: Mapped<'_>) -> Drawn {
    const TOO_FEW: &str = "no map: it takes four values with results along each of two axes of numbers; curves show fewer";
    let family = sweep.family.clone().ok_or(TOO_FEW)?;
    let rows = sweep
        .curves
        .iter()
        .filter_map(|curve| Row::of(sweep, curve, mapped.value));
    let mut rows: Vec<Row> = rows.collect();
    rows.sort_by(|a, b| a.place.total_cmp(&b.place));
    let columns = rows.iter().map(|row| row.cases.len()).max();
    if rows.len() < LEAST || columns.is_none_or(|columns| columns < LEAST) {
        return Err(TOO_FEW);
    }
    let chart = chart(sweep, &family, &rows, &mapped).ok_or(TOO_FEW)?;
    let cases = sweep.records().count();
    let dots = match cases <= DOTS {
        true => "Dots: computed cases, coloured linearly between",
        false => "Coloured linearly between the computed cases",
    };
    let traces = sweep.curves.iter().map(|curve| {
        let points = curve.records.iter().map(|record| {
            let value = (mapped.value)(record);
            Point::new(sweep.place(record), value).error((mapped.error)(record))
        });
        Trace::line(points).member(curve.member)
    });
    let y = mapped.quantity.clone();
    let table = Plot::new(sweep.x.clone(), y).family(family).traces(traces);
    let caption = mapped
        .caption
        .say(format!("{dots}; lines: labelled values."));
    let figure = Figure::of(mapped.name, &[table], caption, &sweep.units);
    Ok(Figure {
        picture: chart.into(),
        ..figure
    })
}

fn chart(
    sweep: &SweepCurves<'_>,
    family: &Quantity,
    rows: &[Row],
    mapped: &Mapped<'_>,
) -> Option<Chart> {
    let places = || rows.iter().flat_map(|row| &row.cases).map(|case| case.0);
    let (left, right) = range(places());
    let (low, high) = (rows.first()?.place, rows.last()?.place);
    if left >= right || low >= high {
        return None;
    }
    let values = || {
        rows.iter()
            .flat_map(|row| &row.cases)
            .filter_map(|case| case.1)
    };
    let colours = scale(range(values()), WIDE_COLOURS);
    let members: Vec<f64> = rows.iter().map(|row| row.place).collect();
    let along = |quantity: &Quantity, (from, to): (f64, f64), all: &[f64]| {
        let shown = sweep
            .units
            .shown(quantity.measure, from.abs().max(to.abs()));
        let axis = Axis {
            label: shown.title(&quantity.words),
            scale: match quantity.spread {
                Spread::Log => Scale::Log,
                _ if is_even(all) => Scale::Linear,
                _ => scale((from, to), WIDE),
            },
            range: Some((shown.of(from), shown.of(to))),
            ..Axis::default()
        };
        (axis, shown)
    };
    let (x, to_x) = along(&sweep.x, (left, right), &places().collect::<Vec<_>>());
    let (y, to_y) = along(family, (low, high), &members);
    let grid = Grid {
        rows,
        scales: [x.scale, y.scale, colours],
    };
    let (unit, cells) = {
        let unit = sweep
            .units
            .shown(mapped.quantity.measure, largest(values().map(f64::abs)));
        let cell = |k: usize| {
            let x = middle(x.scale, (left, right), (k % COLUMNS, COLUMNS));
            let y = middle(y.scale, (low, high), (k / COLUMNS, ROWS));
            Some(unit.of(colours.value(grid.at(x, y)?)))
        };
        let cells: Vec<Option<f64>> = (0..COLUMNS * ROWS).map(cell).collect();
        (unit, cells)
    };
    cells.iter().any(Option::is_some).then_some(())?;
    let points = rows.iter().flat_map(|row| {
        let there = row.cases.iter().filter(|case| case.1.is_some());
        there.map(|case| (to_x.of(case.0), to_y.of(row.place)))
    });
    let points: Vec<(f64, f64)> = points.collect();
    let rings = mapped.rings.iter();
    let map = HeatMap {
        columns: COLUMNS,
        rows: ROWS,
        values: cells,
        value_label: unit.title(&mapped.quantity.words),
        value_range: None,
        value_scale: colours,
        contours: true,
        points: if points.len() <= DOTS {
            points
        } else {
            Vec::new()
        },
        rings: rings.map(|(at, of)| (to_x.of(*at), to_y.of(*of))).collect(),
        shape: MapShape::Stretched,
    };
    Some(Chart::new(x, y).map(map))
}

/// The middle of a cell on the scale of an axis.
fn middle(scale: Scale, (from, to): (f64, f64), (k, count): (usize, usize)) -> f64 {
    let (from, to) = (scale.linearised(from), scale.linearised(to));
    from + (to - from) * (k as f64 + 0.5) / count as f64
}

/// Rows at ascending places of the second axis.
struct Grid<'a> {
    rows: &'a [Row],
    /// Of the abscissa, of the second axis and of the values.
    scales: [Scale; 3],
}

/// One value of the second axis, and (place on the abscissa, value or `None`), ascending.
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

impl Grid<'_> {
    /// Linear between the neighbours on the scales; `None` beside a case without a value.
    fn at(&self, x: f64, y: f64) -> Option<f64> {
        let [x_scale, y_scale, colours] = self.scales;
        let place = |row: &Row| y_scale.linearised(row.place);
        let (low, high, part) = neighbours(self.rows, place, y)?;
        let in_row = |row: &Row| {
            let place = |case: &(f64, Option<f64>)| x_scale.linearised(case.0);
            let (left, right, part) = neighbours(&row.cases, place, x)?;
            let (from, to) = (colours.linearised(left.1?), colours.linearised(right.1?));
            Some(from + part * (to - from))
        };
        let (from, to) = (in_row(low)?, in_row(high)?);
        Some(from + part * (to - from))
    }
}

impl Row {
    fn of(
        sweep: &SweepCurves<'_>,
        curve: &Curve<'_>,
        value: &dyn Fn(&CaseRecord) -> Option<f64>,
    ) -> Option<Self> {
        let records = curve.records.iter();
        let case = |record: &&CaseRecord| (sweep.place(record), value(record));
        Some(Self {
            place: curve.member?,
            cases: records.map(case).collect(),
        })
    }
}
