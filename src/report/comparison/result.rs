//! A result as read from `sweep.csv` and `summary.json`.

use std::collections::HashMap;

use serde::Deserialize;

use super::Place;
use crate::quantity::FrequencyUnit;
use crate::report::quantities;
use crate::sweep::plan::{AxisValue, AxisValues, Block};
use crate::sweep::search::peak::Peak;

/// Why a result cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ComparisonError {
    #[error("{name}: {reason}")]
    Table { name: String, reason: String },
    #[error("{name}, line {line}: `{cell}` under {column} is no number")]
    Number {
        name: String,
        line: usize,
        column: String,
        cell: String,
    },
    #[error("there is no column {column} in either table")]
    NoColumn { column: String },
}

/// The table of a sweep, and its peaks where they are known.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepTable {
    name: String,
    pub(super) columns: Vec<String>,
    /// Those of them that hold what axes vary, where they are not of every table.
    axes: Vec<String>,
    /// What the blocks of a list are called, for each of these columns: those of the result that this one is beside, and then its own.
    /// A place has the number of a name in here.
    pub(super) names: Vec<Vec<String>>,
    places: HashMap<String, usize>,
    pub(super) rows: Vec<Row>,
    /// Rows by the bits of their places.
    exact: HashMap<Vec<u64>, usize>,
    peaks: Option<Vec<Peak>>,
    /// Whether the rows are measured loops: their frequencies and loads are what they were and not what was asked for.
    pub(super) measured: bool,
}

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    line: usize,
    cells: Vec<String>,
    pub(super) place: Place,
}

#[derive(Deserialize)]
struct Summary {
    peaks: Vec<Peak>,
    #[serde(default)]
    axes: Vec<SummaryAxis>,
}

/// An axis, and what the values of a peak on it are the places of.
#[derive(Deserialize)]
struct SummaryAxis {
    column: String,
    #[serde(default)]
    names: Vec<String>,
}

const BLOCKS: [Block; 4] = [Block::Material, Block::Layer, Block::Indenter, Block::Drive];

const FREQUENCY: &str = "angular_frequency_rad_per_s";
/// Frequencies and drives closer than this, relatively, are the same: what is left of a number written and read elsewhere.
const SAME: f64 = 1e-9;
/// The same of a measured frequency and one that was computed.
const SAME_MEASURED: f64 = 0.01;

/// Whether a column is what a second axis varies of something else than mean and amplitude.
fn is_of_axis(column: &str) -> bool {
    let is_of = |block: &Block| {
        let key = column.strip_prefix(block.name());
        key.is_some_and(|key| key.starts_with('_'))
    };
    let is_number = BLOCKS.iter().any(is_of) && quantities::of_name(column).is_none();
    is_number || has_names(column)
}

/// Whether a column holds the names of blocks.
fn has_names(column: &str) -> bool {
    BLOCKS.iter().any(|block| block.name() == column)
}

/// The place of a name in a list, to which it comes where it is new.
fn place_among(names: &mut Vec<String>, name: &str) -> usize {
    let known = names.iter().position(|known| known == name);
    known.unwrap_or_else(|| {
        names.push(name.to_owned());
        names.len() - 1
    })
}

impl Summary {
    /// The peaks, with the places of names among those that are known for these axes.
    fn peaks_among(mut self, axes: &[String], names: &mut [Vec<String>]) -> Vec<Peak> {
        for (k, axis) in self.axes.iter().enumerate() {
            let known = axes.iter().position(|column| *column == axis.column);
            let Some(known) = known.and_then(|known| names.get_mut(known)) else {
                continue;
            };
            let places: Vec<usize> = (axis.names.iter())
                .map(|name| place_among(known, name))
                .collect();
            for peak in &mut self.peaks {
                peak.varied = peak.varied.placed(k, &places);
            }
        }
        self.peaks
    }
}

impl SweepTable {
    /// Reads a `sweep.csv` that messages call `name`, and a `summary.json` where there is one.
    ///
    /// # Errors
    /// [`ComparisonError`] where these are not what a sweep writes.
    pub fn parse(
        name: &str,
        table: &[u8],
        summary: Option<&[u8]>,
    ) -> Result<Self, ComparisonError> {
        Self::parse_beside(None, name, table, summary)
    }

    /// The same of a result that is compared with another, which has read the names of its blocks before.
    ///
    /// # Errors
    /// As [`SweepTable::parse`].
    pub fn parse_beside(
        beside: Option<&Self>,
        name: &str,
        table: &[u8],
        summary: Option<&[u8]>,
    ) -> Result<Self, ComparisonError> {
        let wrong = |reason: String| ComparisonError::Table {
            name: name.to_owned(),
            reason,
        };
        let mut reader = csv::Reader::from_reader(table);
        let header = reader.headers().map_err(|e| wrong(e.to_string()))?;
        let columns: Vec<String> = header.iter().map(str::to_owned).collect();
        let axes = columns.iter().filter(|name| is_of_axis(name));
        let axes: Vec<String> = axes.cloned().collect();
        let known = |axis| beside.map_or(Vec::new(), |beside| beside.names_of(axis));
        let mut names: Vec<Vec<String>> = axes.iter().map(known).collect();
        let peaks = summary.map(|bytes| {
            let summary: Summary = serde_json::from_slice(bytes)
                .map_err(|e| wrong(format!("the summary.json beside it: {e}")))?;
            Ok(summary.peaks_among(&axes, &mut names))
        });
        let mut result = Self {
            name: name.to_owned(),
            places: columns.iter().cloned().zip(0..).collect(),
            columns,
            axes,
            names: Vec::new(),
            rows: Vec::new(),
            exact: HashMap::new(),
            peaks: peaks.transpose()?,
            measured: false,
        };
        if !result.has(FREQUENCY) {
            return Err(wrong(format!(
                "no column {FREQUENCY}: this is not the sweep.csv of a sweep"
            )));
        }
        for record in reader.records() {
            let record = record.map_err(|e| wrong(e.to_string()))?;
            let mut row = Row {
                line: record.position().map_or(0, |p| p.line() as usize),
                cells: record.iter().map(str::to_owned).collect(),
                place: Place::default(),
            };
            row.place = result.place_of(&row, &mut names)?;
            let next = result.rows.len();
            result.exact.entry(bits(&row.place)).or_insert(next);
            result.measured |= result.text(&row, "method") == "measured";
            result.rows.push(row);
        }
        result.names = names;
        if result.measured {
            // Peaks are located by solving between frequencies.
            result.peaks = None;
        }
        Ok(result)
    }

    fn place_of(&self, row: &Row, names: &mut [Vec<String>]) -> Result<Place, ComparisonError> {
        let number = |column| Ok(self.number(row, column)?.unwrap_or(0.0));
        let mut varied = Vec::with_capacity(self.axes.len());
        for (axis, names) in self.axes.iter().zip(names) {
            varied.push(match has_names(axis) {
                true => AxisValue::Block(place_among(names, self.text(row, axis))),
                false => AxisValue::Number(number(axis)?),
            });
        }
        Ok(Place {
            varied: AxisValues::new(&varied).ok_or_else(|| ComparisonError::Table {
                name: self.name.clone(),
                reason: "it has more axes than a sweep".to_owned(),
            })?,
            drive_mean: number("drive_mean")?,
            drive_amplitude: number("drive_amplitude")?,
            angular_frequency_rad_per_s: number(FREQUENCY)?,
        })
    }

    /// What the blocks of a list are called whose places a column of an axis has.
    fn names_of(&self, axis: &String) -> Vec<String> {
        let known = self.axes.iter().position(|known| known == axis);
        known.map_or(Vec::new(), |axis| self.names[axis].clone())
    }

    /// The unit of the frequencies that come first.
    pub(super) fn unit(&self) -> FrequencyUnit {
        let first = self.columns.first();
        let units = FrequencyUnit::NAMES.iter().map(|(_, unit)| *unit);
        let mut of_first = units.filter(|unit| first.is_some_and(|name| name == unit.column()));
        of_first.next().unwrap_or_default()
    }

    /// The peaks, or why they are not known.
    pub(super) fn peaks(&self) -> Result<&[Peak], String> {
        self.peaks.as_deref().ok_or_else(|| match self.measured {
            true => format!("{} was measured, and only computed peaks are located", self.name),
            false => format!(
                "{} was given without its summary.json, where the peaks are; name the folder of the sweep",
                self.name
            ),
        })
    }

    pub(super) fn has(&self, column: &str) -> bool {
        self.places.contains_key(column)
    }

    /// Whether a column has a number in any row; an unreadable one counts, and is told where it is compared.
    pub(super) fn has_numbers(&self, column: &str) -> bool {
        let mut rows = self.rows.iter();
        rows.any(|row| !matches!(self.number(row, column), Ok(None)))
    }

    /// What stands in a cell; nothing where the column is absent.
    pub(super) fn text<'a>(&self, row: &'a Row, column: &str) -> &'a str {
        let cell = self.places.get(column).and_then(|at| row.cells.get(*at));
        cell.map_or("", String::as_str)
    }

    /// The number in a cell; `None` where the cell is empty or the column absent.
    pub(super) fn number(&self, row: &Row, column: &str) -> Result<Option<f64>, ComparisonError> {
        let cell = self.text(row, column);
        match cell.parse::<f64>() {
            _ if cell.is_empty() => Ok(None),
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(ComparisonError::Number {
                name: self.name.clone(),
                line: row.line,
                column: column.to_owned(),
                cell: cell.to_owned(),
            }),
        }
    }

    /// The numbers under these columns, row by row; `None` where a cell is empty or the column absent.
    ///
    /// # Errors
    /// [`ComparisonError::Number`] at the first cell that is neither empty nor a number.
    pub fn numbers_under<const N: usize>(
        &self,
        columns: [&str; N],
    ) -> Result<Vec<[Option<f64>; N]>, ComparisonError> {
        let in_row = |row| {
            let mut numbers = [None; N];
            for (number, column) in numbers.iter_mut().zip(columns) {
                *number = self.number(row, column)?;
            }
            Ok(numbers)
        };
        self.rows.iter().map(in_row).collect()
    }

    /// The case at this place of another result. Where one of the two was measured, the nearest in frequency, and among equal
    /// ones the nearest in load.
    pub(super) fn row(&self, place: Place, other: &Self) -> Option<&Row> {
        if self.measured || other.measured {
            return self.nearest(place);
        }
        if let Some(at) = self.exact.get(&bits(&place)) {
            return self.rows.get(*at);
        }
        let near = |(a, b): (f64, f64)| (a - b).abs() <= SAME * a.abs().max(b.abs());
        let same_axes = |row: &&Row| row.place.varied.all().len() == place.varied.all().len();
        let mut rows = self.rows.iter().filter(same_axes);
        rows.find(|row| numbers(&row.place).zip(numbers(&place)).all(near))
    }

    fn nearest(&self, place: Place) -> Option<&Row> {
        let apart = |a: f64, b: f64| match a.abs().max(b.abs()) {
            0.0 => 0.0,
            larger => (a - b).abs() / larger,
        };
        let distance = |row: &Row| {
            let other = row.place;
            let frequency = apart(
                other.angular_frequency_rad_per_s,
                place.angular_frequency_rad_per_s,
            );
            let drive = apart(other.drive_mean, place.drive_mean)
                + apart(other.drive_amplitude, place.drive_amplitude);
            (frequency <= SAME_MEASURED).then_some(frequency + drive)
        };
        let near = self
            .rows
            .iter()
            .filter_map(|row| Some((distance(row)?, row)));
        let nearest = near.min_by(|(a, _), (b, _)| a.total_cmp(b));
        nearest.map(|(_, row)| row)
    }
}

/// What a place is made of.
fn numbers(place: &Place) -> impl Iterator<Item = f64> {
    let drive = [
        place.drive_mean,
        place.drive_amplitude,
        place.angular_frequency_rad_per_s,
    ];
    let varied = place.varied.all().iter().map(|value| value.as_number());
    varied.chain(drive)
}

/// The numbers of a place, bit for bit.
fn bits(place: &Place) -> Vec<u64> {
    numbers(place).map(f64::to_bits).collect()
}
