//! Tables as CSV: one header line, then rows; numbers as short as they can be without losing a bit, absent values empty.

use super::work_line::WorkLine;
use crate::cycle::Loop;
use crate::drive::Control;
use crate::quantity::FrequencyUnit;
use crate::sweep::plan::Varied;
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
    pub fn of_axis(varied: &Varied, value: Option<f64>) -> Self {
        match value.and_then(|value| varied.block_name(value)) {
            Some(name) => name.to_owned().into(),
            None => value.into(),
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

/// `loops/<index>.csv`: the stabilised cycle of one case.
pub fn samples(samples: &Loop) -> Vec<u8> {
    let columns = [
        "time_s",
        "load_n",
        "approach_m",
        "contact_radius_m",
        "peak_pressure_pa",
    ];
    let rows = (0..samples.time_s.len()).map(|i| {
        let at = |signal: &[f64]| signal.get(i).copied();
        cells![
            at(&samples.time_s),
            at(&samples.load_n),
            at(&samples.approach_m),
            at(&samples.contact_radius_m),
            samples.peak_pressure_pa.get(i).copied().flatten(),
        ]
    });
    csv(&columns, rows)
}

/// `pressures/<index>.csv`: the pressure over the contact at the instants recorded of the stabilised cycle, one row per place.
pub fn pressures(profiles: &[PressureProfile], control: Control) -> Vec<u8> {
    let columns = [
        "instant",
        "time_s",
        "load_n",
        "approach_m",
        "contact_radius_m",
        "line",
        "position_m",
        "pressure_pa",
    ];
    let rows = profiles.iter().flat_map(|profile| {
        profile.lines.iter().flat_map(move |line| {
            let places = line.position_m.iter().zip(&line.pressure_pa);
            places.map(move |(position_m, pressure_pa)| {
                cells![
                    profile.quarter.name(control),
                    profile.time_s,
                    profile.load_n,
                    profile.approach_m,
                    profile.contact_radius_m,
                    line.along.symbol(),
                    *position_m,
                    *pressure_pa,
                ]
            })
        })
    });
    csv(&columns, rows)
}

/// `work/<index>.csv`: the density of the work per cycle along one line.
pub fn work(line: &WorkLine) -> Vec<u8> {
    let rows = line.points.iter();
    csv(
        &[line.along.column(), "work_j_per_m2"],
        rows.map(|(position_m, density)| cells![*position_m, *density]),
    )
}
