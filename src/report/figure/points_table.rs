//! The table behind a figure: its points, in SI units.

use super::plot::Plot;
use super::trace::{Point, Trace};
use crate::quantity::FrequencyUnit;
use crate::report::table::{Cell, csv_leading};

/// The table of frames: a row per point, frames over the same points side by side.
pub(super) fn table(plots: &[Plot], unit: FrequencyUnit) -> Vec<u8> {
    let mut table = Table::default();
    for plot in plots {
        for trace in plot.traces.iter().filter(|trace| trace.in_table) {
            table.add(plot, trace);
        }
    }
    csv_leading(
        unit,
        &table.columns,
        table.rows.iter().map(|row| {
            let mut cells = vec![Cell::Absent; table.columns.len()];
            for (place, cell) in row {
                cells[*place] = cell.clone();
            }
            cells
        }),
    )
}

/// Rows of cells by the places of their columns.
#[derive(Default)]
struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<(usize, Cell)>>,
    /// Which curves over which points there are already, and in which row each begins.
    curves: Vec<(String, Vec<f64>, usize)>,
}

impl Table {
    /// The place of a column, which is added where it is new.
    fn place(&mut self, name: impl Into<String>) -> usize {
        let name = name.into();
        let known = self.columns.iter().position(|column| *column == name);
        known.unwrap_or_else(|| {
            self.columns.push(name);
            self.columns.len() - 1
        })
    }

    fn add(&mut self, plot: &Plot, trace: &Trace) {
        let first = self.first_row(plot, trace);
        let of_errors = |value: fn(&Point) -> Option<f64>| {
            let values = trace.points.iter().map(value);
            values.collect::<Vec<_>>()
        };
        let (y, column_of) = (&plot.y, |what| plot.y.column_of(what));
        let columns = [
            (y.column.to_string(), of_errors(|point| point.y)),
            (column_of("error"), of_errors(|point| point.error)),
            (column_of("lower"), of_errors(|point| Some(point.band?.0))),
            (column_of("upper"), of_errors(|point| Some(point.band?.1))),
        ];
        for (k, (name, values)) in columns.into_iter().enumerate() {
            if k > 0 && values.iter().all(Option::is_none) {
                continue;
            }
            let place = self.place(name);
            for (row, value) in self.rows[first..].iter_mut().zip(values) {
                row.push((place, Cell::from(value)));
            }
        }
    }

    /// The row of the first point of a curve: that of the same curve over the same points in an earlier frame, or a new one.
    fn first_row(&mut self, plot: &Plot, trace: &Trace) -> usize {
        let xs: Vec<f64> = trace.points.iter().map(|point| point.x).collect();
        let name = format!("{} {:?} {:?}", plot.x.column, trace.label, trace.member);
        let mut known = self.curves.iter();
        if let Some((.., first)) = known.find(|(n, x, _)| *n == name && *x == xs) {
            return *first;
        }
        let which = match (&plot.family, trace.member, &trace.label) {
            (Some(family), Some(member), _) => {
                Some((self.place(&*family.column), Cell::from(member)))
            }
            (_, _, Some(label)) => Some((self.place("curve"), Cell::from(label.as_str()))),
            (_, _, None) => None,
        };
        let along = plot.along.as_ref().map(|along| self.place(&*along.column));
        let x = self.place(&*plot.x.column);
        let first = self.rows.len();
        self.rows.extend(trace.points.iter().map(|point| {
            let along = along.map(|place| (place, Cell::from(point.along)));
            let place = (x, Cell::from(point.x));
            which
                .clone()
                .into_iter()
                .chain(along)
                .chain([place])
                .collect()
        }));
        self.curves.push((name, xs, first));
        first
    }
}
