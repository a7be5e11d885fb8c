//! Tables as CSV: one header line, then rows; numbers as short as they can be without losing a bit, absent values empty.

use super::work_line::WorkLine;
use crate::cycle::Loop;
use crate::drive::Control;
use crate::quantity::FrequencyUnit;
use crate::sweep::plan::{AxisValue, Varied};
use crate::sweep::record::PressureProfile;

/// One cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// An undefined value: empty.
    Absent,
    Number(f64),
    Count(u64),
    Text(String),
}

impl Cell {
    /// Of what an axis varies: a number, or the name of a block.
    pub fn of_axis(varied: &Varied, value: Option<AxisValue>) -> Self {
        match value.and_then(|value| varied.block_name(value)) {
            Some(name) => name.to_owned().into(),
            None => value.and_then(AxisValue::number).into(),
        }
    }

    /// As it stands in a CSV file: `3.4737e-6`.
    pub fn text(&self) -> String {
        match self {
            Self::Absent => String::new(),
            Self::Number(value) => number(*value),
            Self::Count(count) => count.to_string(),
            Self::Text(text) => text.clone(),
        }
    }

    /// The number in it, where it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Count(count) => Some(*count as f64),
            Self::Absent | Self::Text(_) => None,
        }
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::Count(count as u64)
    }
}

impl From<u64> for Cell {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl From<String> for Cell {
    /// A text without letters is none.
    fn from(text: String) -> Self {
        match text.is_empty() {
            true => Self::Absent,
            false => Self::Text(text),
        }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::from(text.to_owned())
    }
}

impl<C: Into<Cell>> From<Option<C>> for Cell {
    fn from(value: Option<C>) -> Self {
        value.map_or(Self::Absent, Into::into)
    }
}

/// A row of a table from numbers, texts, or either that may be absent.
macro_rules! cells {
    ($($cell:expr),* $(,)?) => {
        [$($crate::report::table::Cell::from($cell)),*]
    };
}
pub(crate) use cells;

/// A number as it stands in every table: `3.4737e-6`.
pub fn number(value: f64) -> String {
    format!("{value:e}")
}

/// A table with these columns.
pub fn csv<C: AsRef<[u8]>, R: AsRef<[Cell]>>(
    columns: &[C],
    rows: impl IntoIterator<Item = R>,
) -> Vec<u8> {
    let mut builder = csv::WriterBuilder::new();
    let mut writer = builder.flexible(true).from_writer(Vec::new());
    // Writing to memory cannot fail.
    let _ = writer.write_record(columns);
    for row in rows {
        let _ = writer.write_record(row.as_ref().iter().map(Cell::text));
    }
    writer.into_inner().unwrap_or_default()
}

/// The same with frequencies in the unit asked for before those in rad/s.
pub fn csv_leading<C: AsRef<str>, R: AsRef<[Cell]>>(
    unit: FrequencyUnit,
    columns: &[C],
    rows: impl IntoIterator<Item = R>,
) -> Vec<u8> {
    let angular = FrequencyUnit::RadPerS.column();
    let columns: Vec<&str> = columns.iter().map(AsRef::as_ref).collect();
    let place = columns.iter().position(|column| *column == angular);
    let Some(place) = place.filter(|_| unit != FrequencyUnit::RadPerS) else {
        return csv(&columns, rows);
    };
    let mut columns = columns;
    columns.insert(place, unit.column());
    let rows = rows.into_iter().map(|row| {
        let mut row = row.as_ref().to_vec();
        let omega = row.get(place).and_then(Cell::number);
        let frequency = omega.map(|omega| unit.of(omega));
        row.insert(place, frequency.into());
        row
    });
    csv(&columns, rows)
}

/// The name of a column, and its cell in a row.
pub type ColumnOf<'a, R> = (&'a str, fn(&R) -> Cell);

/// A table whose rows are made of these, column by column.
pub fn of_rows<R>(rows: impl IntoIterator<Item = R>, columns: &[ColumnOf<'_, R>]) -> Vec<u8> {
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let cells = |row| columns.iter().map(move |(_, cell)| cell(&row));
    let rows = rows.into_iter();
    csv(&names, rows.map(|row| cells(row).collect::<Vec<_>>()))
}

/// `cases/loops/<index>.csv`: the stabilised cycle of one case.
pub fn samples(samples: &Loop) -> Vec<u8> {
    let rows = (0..samples.time_s.len()).map(|at| (samples, at));
    of_rows(
        rows,
        &[
            ("time_s", |(l, at)| l.time_s.get(*at).copied().into()),
            ("load_n", |(l, at)| l.load_n.get(*at).copied().into()),
            ("approach_m", |(l, at)| {
                l.approach_m.get(*at).copied().into()
            }),
            ("contact_radius_m", |(l, at)| {
                l.contact_radius_m.get(*at).copied().into()
            }),
            ("peak_pressure_pa", |(l, at)| {
                l.peak_pressure_pa.get(*at).copied().flatten().into()
            }),
        ],
    )
}

/// `cases/pressures/<index>.csv`: the pressure over the contact at the instants recorded of the stabilised cycle, one row per place.
pub fn pressures(profiles: &[PressureProfile], control: Control) -> Vec<u8> {
    let lines = profiles
        .iter()
        .flat_map(|p| p.lines.iter().map(move |line| (p, line)));
    let rows = lines.flat_map(|(profile, line)| {
        let places = line.position_m.iter().zip(&line.pressure_pa);
        places.map(move |place| (profile, line, place, control))
    });
    of_rows(
        rows,
        &[
            ("instant", |(p, _, _, control)| {
                p.quarter.name(*control).into()
            }),
            ("time_s", |(p, ..)| p.time_s.into()),
            ("load_n", |(p, ..)| p.load_n.into()),
            ("approach_m", |(p, ..)| p.approach_m.into()),
            ("contact_radius_m", |(p, ..)| p.contact_radius_m.into()),
            ("line", |(_, line, ..)| line.along.symbol().into()),
            ("position_m", |(_, _, (position_m, _), _)| {
                (**position_m).into()
            }),
            ("pressure_pa", |(_, _, (_, pressure_pa), _)| {
                (**pressure_pa).into()
            }),
        ],
    )
}

/// `cases/work/<index>.csv`: the density of the work per cycle along one line.
pub fn work(line: &WorkLine) -> Vec<u8> {
    let rows = line.points.iter();
    of_rows(
        rows,
        &[
            (line.along.column(), |(position_m, _)| (*position_m).into()),
            ("work_j_per_m2", |(_, density)| (*density).into()),
        ],
    )
}
