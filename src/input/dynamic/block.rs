//! A block of a file: a header, perhaps a row of units, and rows of numbers. What all formats have in common once their blocks are
//! found: which columns are read, in which units, and what a row must hold.

use std::ops::Range;

use super::columns::{self, Named, Role, Scale};
use crate::input::data_file::grid::{Cell, Grid, Line, Numbers};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::material::ModulusKind;
use crate::material::dynamic::DynamicPoint;

/// Where one table of a file stands.
pub(super) struct Block<'a> {
    pub(super) grid: &'a Grid,
    pub(super) header: Line<'a>,
    pub(super) units: Option<Line<'a>>,
    /// Lines of numbers.
    pub(super) rows: Range<usize>,
    /// What the file calls it.
    pub(super) name: Option<String>,
    /// Where the file says it of the block as a whole.
    pub(super) temperature_k: Option<f64>,
    /// Whether an instrument wrote it: of columns with the same meaning the first counts, and rows may be short.
    pub(super) by_instrument: bool,
    /// Whether frequencies are reduced, so that the temperatures of the rows are not that of the curve.
    pub(super) is_master: bool,
    /// Lines of the rows that are passed over, ascending.
    pub(super) skipped: Vec<usize>,
}

/// A row that was read.
pub(super) struct Measured {
    pub(super) point: DynamicPoint,
    pub(super) place: Location,
    /// What the column of isotherms holds.
    pub(super) set: Option<String>,
}

/// What a block holds.
pub(super) struct Content {
    pub(super) points: Vec<Measured>,
    /// Rows in which a number is marked as missing.
    pub(super) missing: usize,
    /// Rows of an instrument in which a value is not positive: the first, and how many.
    pub(super) noise: Option<(Location, usize)>,
    /// The columns read, with their units.
    pub(super) columns: String,
    pub(super) assumed: Vec<String>,
}

/// A column that is read.
#[derive(Clone, Copy)]
struct Column {
    place: usize,
    role: Role,
    scale: Scale,
}

/// What storage and loss modulus come from.
#[derive(Clone, Copy)]
enum Moduli {
    StorageAndLoss,
    StorageAndTangent,
    MagnitudeAndAngle,
    MagnitudeAndTangent,
}

impl Moduli {
    const ALL: [(Self, Role, Role); 4] = [
        (Self::StorageAndLoss, Role::Storage, Role::Loss),
        (Self::StorageAndTangent, Role::Storage, Role::TanDelta),
        (Self::MagnitudeAndAngle, Role::Complex, Role::PhaseAngle),
        (Self::MagnitudeAndTangent, Role::Complex, Role::TanDelta),
    ];

    fn storage_and_loss(self, a: f64, b: f64) -> (f64, f64) {
        match self {
            Self::StorageAndLoss => (a, b),
            Self::StorageAndTangent => (a, a * b),
            Self::MagnitudeAndAngle => (a * b.cos(), a * b.sin()),
            Self::MagnitudeAndTangent => {
                let storage = a / 1f64.hypot(b);
                (storage, storage * b)
            }
        }
    }
}

/// What the names of a header say, cell by cell.
pub(super) fn names(header: &Line<'_>) -> Vec<Option<Named>> {
    // No instrument writes as many; a hostile file may.
    let cells = header.texts().take(2000);
    cells.map(columns::recognise).collect()
}

/// Whether these columns are dynamic data: a frequency, and two that give both moduli.
pub(super) fn is_dynamic(names: &[Option<Named>]) -> bool {
    let has = |role| names.iter().flatten().any(|named| named.role == role);
    let moduli = Moduli::ALL.iter().any(|(_, a, b)| has(*a) && has(*b));
    moduli && (has(Role::Frequency) || has(Role::AngularFrequency))
}

/// What these columns lack of dynamic data.
pub(super) fn lacking(names: &[Option<Named>]) -> Option<&'static str> {
    let has = |role| names.iter().flatten().any(|named| named.role == role);
    match () {
        () if !has(Role::Frequency) && !has(Role::AngularFrequency) => Some("frequencies"),
        () if !has(Role::Storage) && !has(Role::Complex) => Some("storage moduli"),
        () if !is_dynamic(names) => Some("loss moduli"),
        () => None,
    }
}

impl<'a> Block<'a> {
    /// A table whose header is this line: the rows down to `end`, the first of which may be one of units.
    pub(super) fn new(grid: &'a Grid, header: usize, end: usize) -> Self {
        let cells = grid.header(header);
        let below = grid.line(header + 1);
        let roles = names(&cells);
        let of_column = |place: usize| roles.get(place).is_some_and(Option::is_some);
        let below = aligned(below, cells.len());
        let has_number = (0..below.len()).any(|place| of_column(place) && below.is_number(place));
        let is_row = header + 1 < end
            && grid.is_comment(header + 1) <= grid.is_comment(header)
            && !has_number
            && below.texts().any(columns::is_unit);
        let units = is_row.then_some(below);
        let rows = header + 1 + usize::from(is_row)..end;
        Self {
            grid,
            header: cells,
            units,
            rows,
            name: None,
            temperature_k: None,
            by_instrument: false,
            is_master: false,
            skipped: Vec::new(),
        }
    }

    /// As an instrument wrote it.
    pub(super) fn by_instrument(mut self) -> Self {
        self.by_instrument = true;
        self
    }

    /// The rows in SI units.
    ///
    /// # Errors
    /// Columns that are absent, double, without a unit or of the other modulus; cells that are no positive numbers.
    pub(super) fn read(&self, kind: ModulusKind) -> Result<Content, Diagnostics> {
        let columns = self.columns(kind)?;
        let mut content = Content {
            points: Vec::new(),
            missing: 0,
            noise: None,
            columns: columns.described(self),
            assumed: columns.assumed.clone(),
        };
        let (problems, mut numbers) = (Problems::new(), self.grid.numbers(self.rows.clone()));
        let is_read = |line: &usize| {
            !self.grid.is_comment(*line) && self.skipped.binary_search(line).is_err()
        };
        for line in self.rows.clone().filter(is_read) {
            let row = aligned(self.grid.line(line), self.header.len());
            let mut reader = RowReader {
                block: self,
                numbers: &mut numbers,
                problems: &problems,
                row: &row,
                bad: false,
                noise: false,
            };
            let place = self.grid.place(line);
            match reader.point(&columns, place.clone()) {
                Some(measured) => content.points.push(measured),
                None if reader.noise => content.noise.get_or_insert((place, 0)).1 += 1,
                None => content.missing += usize::from(!reader.bad),
            }
        }
        if let Some((first, count)) = content
            .noise
            .as_ref()
            .filter(|(_, count)| *count > content.points.len())
        {
            let message = format!(
                "{count} rows of a table of {} hold a value that is not positive",
                count + content.points.len()
            );
            problems
                .at(first, message)
                .because("the first")
                .help("check the columns and their signs");
        }
        numbers.check(&problems);
        problems.into_result(Some(content))
    }

    fn columns(&self, kind: ModulusKind) -> Result<Columns, Diagnostic> {
        let names = names(&self.header);
        let find = |role| self.find(&names, role, kind);
        let angular = find(Role::AngularFrequency)?;
        let frequency = match angular {
            Some(angular) => angular,
            None => find(Role::Frequency)?
                .ok_or_else(|| self.absent("frequencies", "frequency_hz` or `Frequency [Hz]"))?,
        };
        let mut pairs = Vec::new();
        for (moduli, a, b) in Moduli::ALL {
            let has = |role| names.iter().flatten().any(|named| named.role == role);
            if pairs.is_empty() && has(a) && has(b) {
                pairs.push((moduli, find(a)?, find(b)?));
            }
        }
        let Some((moduli, Some(first), Some(second))) = pairs.first().copied() else {
            let has_storage = names
                .iter()
                .flatten()
                .any(|named| named.role == Role::Storage);
            return Err(match has_storage {
                true => self.absent("loss moduli", "E'' [MPa]` or `tan delta"),
                false => self.absent("storage moduli", "storage_modulus_mpa` or `E' [MPa]"),
            });
        };
        let errors = (find(Role::StorageError)?, find(Role::LossError)?);
        let mut assumed = Vec::new();
        if let (Some(_), None) | (None, Some(_)) = errors {
            assumed.push("the errors of one modulus alone are not used".to_owned());
        }
        if frequency.role == Role::AngularFrequency
            && self.unit_of(frequency.place, &names).is_none()
        {
            assumed.push("angular frequencies without a unit are taken in rad/s".to_owned());
        }
        Ok(Columns {
            frequency,
            moduli: (moduli, first, second),
            temperature: if self.is_master {
                None
            } else {
                find(Role::Temperature)?
            },
            set: find(Role::Set)?,
            errors: errors.0.zip(errors.1),
            assumed,
        })
    }

    /// The unit of a column as written, in the header or below it.
    fn unit_of(&self, place: usize, names: &[Option<Named>]) -> Option<String> {
        let above = names.get(place)?.as_ref()?.unit.clone();
        let below = self
            .units
            .as_ref()
            .map(|units| columns::bare(units.text(place)).to_owned());
        above
            .or(below)
            .filter(|unit| !["", "-"].contains(&unit.as_str()))
    }

    fn find(
        &self,
        names: &[Option<Named>],
        role: Role,
        kind: ModulusKind,
    ) -> Result<Option<Column>, Diagnostic> {
        let of_role = names.iter().enumerate().filter_map(|(place, named)| {
            let named = named.as_ref().filter(|named| named.role == role)?;
            Some((place, named))
        });
        let all: Vec<(usize, &Named)> = of_role.collect();
        let asked: Vec<(usize, &Named)> = all
            .iter()
            .copied()
            .filter(|(_, named)| named.kind.is_none_or(|k| k == kind))
            .collect();
        let (Some((first, _)), true) = (all.first(), asked.is_empty()) else {
            return self.one_of(&asked, role);
        };
        Err(self.other_modulus(*first, kind))
    }

    /// The one of these columns, or of an instrument's the first whose unit can be read.
    fn one_of(
        &self,
        columns: &[(usize, &Named)],
        role: Role,
    ) -> Result<Option<Column>, Diagnostic> {
        let mut scaled = columns.iter().map(|(place, named)| {
            let scale = self.scale(*place, named)?;
            Ok(Column {
                place: *place,
                role,
                scale,
            })
        });
        if self.by_instrument {
            let read: Vec<Result<Column, Diagnostic>> = scaled.collect();
            let first = read.iter().position(Result::is_ok).unwrap_or(0);
            return read.into_iter().nth(first).transpose();
        }
        match columns {
            [(first, _), (second, _), ..] => {
                let message = format!("the table has two columns of {}", role.what());
                Err(Diagnostic::at(&self.header.place(*second), message)
                    .label(&self.header.place(*first), "the other one")
                    .help("keep one of them"))
            }
            _ => scaled.next().transpose(),
        }
    }

    fn scale(&self, place: usize, named: &Named) -> Result<Scale, Diagnostic> {
        let above = named.unit.as_deref();
        let below = self.units.as_ref().map(|units| units.text(place));
        let given = |unit: Option<&str>| {
            unit.map(columns::bare)
                .filter(|unit| !["", "-"].contains(unit))
                .map(str::to_owned)
        };
        let (above, below) = (given(above), given(below));
        let at_header = self.header.place(place);
        let at_units = self
            .units
            .as_ref()
            .map_or_else(|| at_header.clone(), |units| units.place(place));
        let what = named.role.what();
        let read = |unit: &str, at: &Location| {
            columns::scale(named.role, Some(unit)).map_err(|why| {
                Diagnostic::at(at, format!("`{unit}` is no unit of the column of {what}"))
                    .because(why)
            })
        };
        match (above, below) {
            (Some(unit), None) => read(&unit, &at_header),
            (None, Some(unit)) => read(&unit, &at_units),
            (Some(above), Some(below)) => {
                let (above, below) = (read(&above, &at_header)?, read(&below, &at_units)?);
                match above == below {
                    true => Ok(above),
                    false => Err(Diagnostic::at(&at_units, "the header gives another unit")
                        .label(&at_header, "this one")
                        .help("keep one of the two")),
                }
            }
            (None, None) => columns::scale(named.role, None).map_err(|write| {
                let problem =
                    Diagnostic::at(&at_header, format!("the column of {what} has no unit"));
                match named.role {
                    Role::Frequency => problem.help(format!(
                        "write `{0} [Hz]` or `{0} [rad/s]`: they differ by a factor of 6.28",
                        at_header.text()
                    )),
                    _ => problem.help(write),
                }
            }),
        }
    }

    fn other_modulus(&self, place: usize, asked: ModulusKind) -> Diagnostic {
        let (is, word, asked) = match asked {
            ModulusKind::Longitudinal => ("a shear modulus", "shear", "longitudinal"),
            ModulusKind::Shear => ("a modulus of tension or bending", "longitudinal", "shear"),
        };
        let message = format!("this column is {is}, and the {asked} modulus was asked for");
        Diagnostic::at(&self.header.place(place), message).help(format!(
            "write modulus = \"{word}\", or give --modulus {word}"
        ))
    }

    fn absent(&self, what: &str, example: &str) -> Diagnostic {
        let place = self.header.place(0);
        Diagnostic::at(&place, format!("the table has no column of {what}"))
            .help(format!("name it with its unit, such as `{example}`"))
    }
}

/// A row without the empty cell that some instruments put before it.
pub(super) fn aligned(row: Line<'_>, columns: usize) -> Line<'_> {
    let is_shifted = row.len() == columns + 1 && row.text(0).is_empty();
    row.without(usize::from(is_shifted))
}

/// The columns that are read.
struct Columns {
    frequency: Column,
    moduli: (Moduli, Column, Column),
    temperature: Option<Column>,
    set: Option<Column>,
    errors: Option<(Column, Column)>,
    assumed: Vec<String>,
}

impl Columns {
    fn described(&self, block: &Block<'_>) -> String {
        let (_, first, second) = self.moduli;
        let errors = self.errors.map(|(a, b)| [a, b]);
        let all = [
            Some(self.frequency),
            Some(first),
            Some(second),
            self.temperature,
            self.set,
        ];
        let names = names(&block.header);
        let described = all
            .into_iter()
            .flatten()
            .chain(errors.into_iter().flatten())
            .map(|column| {
                let name = block.header.text(column.place);
                match block
                    .unit_of(column.place, &names)
                    .filter(|unit| !name.contains(unit.as_str()))
                {
                    Some(unit) => format!("`{name}` [{unit}]"),
                    None => format!("`{name}`"),
                }
            });
        described.collect::<Vec<_>>().join(", ")
    }
}

/// Reads the cells of one row.
struct RowReader<'a, 'b> {
    block: &'a Block<'b>,
    numbers: &'a mut Numbers<'b>,
    problems: &'a Problems,
    row: &'a Line<'b>,
    /// Whether a problem of this row was reported.
    bad: bool,
    /// Whether an instrument wrote a value that is not positive.
    noise: bool,
}

impl RowReader<'_, '_> {
    /// The point; `None` where a number is missing or a problem was reported.
    fn point(&mut self, columns: &Columns, place: Location) -> Option<Measured> {
        let expected = self.block.header.len();
        let is_empty = |cell: usize| self.row.text(cell).is_empty();
        if !self.block.by_instrument
            && (self.row.len() < expected || !(expected..self.row.len()).all(is_empty))
        {
            return self.ragged(&place, expected);
        }
        let (moduli, first, second) = columns.moduli;
        let frequency = self.positive(columns.frequency);
        let (a, b) = (self.positive(first), self.positive(second));
        let temperature = columns.temperature.map(|column| self.number(column));
        let errors = columns
            .errors
            .map(|(a, b)| (self.number(a), self.number(b)));
        if self.bad {
            return None;
        }
        let (storage, loss) = moduli.storage_and_loss(a?, b?);
        let temperature_k = match temperature {
            Some(temperature) => Some(temperature?),
            None => self.block.temperature_k,
        };
        let point = DynamicPoint {
            temperature_k,
            angular_frequency_rad_per_s: frequency?,
            storage_modulus_pa: storage,
            loss_modulus_pa: loss,
            errors_pa: self.errors(columns, errors, (storage, loss)),
        };
        self.check(&point, &place)?;
        let set = columns
            .set
            .map(|column| self.row.text(column.place).to_owned());
        Some(Measured { point, place, set })
    }

    fn ragged(&mut self, place: &Location, expected: usize) -> Option<Measured> {
        self.bad = true;
        let found = self.row.len();
        let s = if found == 1 { "" } else { "s" };
        let message = format!("a row of {found} cell{s} in a table of {expected} columns");
        self.problems.at(place, message).help(
            "give every row one cell per column; where commas separate cells, numbers have a decimal point",
        );
        None
    }

    /// Errors of both moduli, where the row has both.
    fn errors(
        &self,
        columns: &Columns,
        errors: Option<(Option<f64>, Option<f64>)>,
        (storage, loss): (f64, f64),
    ) -> Option<(f64, f64)> {
        let ((of_storage, of_loss), (a, b)) = (columns.errors?, errors?);
        let absolute = |column: Column, error: f64, modulus: f64| match column.scale.is_relative {
            true => error * modulus,
            false => error,
        };
        let errors = (
            absolute(of_storage, a?, storage),
            absolute(of_loss, b?, loss),
        );
        (errors.0 > 0.0 && errors.1 > 0.0).then_some(errors)
    }

    /// Moduli of a very large or very small number may leave what a double holds, and temperatures fall below zero.
    fn check(&mut self, point: &DynamicPoint, place: &Location) -> Option<()> {
        let values = [
            ("the frequency", point.angular_frequency_rad_per_s),
            ("the storage modulus", point.storage_modulus_pa),
            ("the loss modulus", point.loss_modulus_pa),
            (
                "the absolute temperature",
                point.temperature_k.unwrap_or(1.0),
            ),
        ];
        let bad = values
            .into_iter()
            .find(|(_, value)| !(value.is_finite() && *value > 0.0));
        let Some((what, value)) = bad else {
            return Some(());
        };
        self.bad = true;
        self.problems
            .at(
                place,
                format!("{what} must be positive, and is {value:e} in SI units"),
            )
            .help("leave the row out, or check its units");
        None
    }

    fn positive(&mut self, column: Column) -> Option<f64> {
        let number = self.number(column)?;
        if number > 0.0 {
            return Some(number);
        }
        if self.block.by_instrument {
            self.noise = true;
            return None;
        }
        self.bad = true;
        let (cell, what) = (self.row.place(column.place), column.role.what());
        self.problems
            .at(&cell, format!("{what} must be positive"))
            .help("leave the row out: a measured value that is not positive is noise");
        None
    }

    /// The number in SI units; `None` where it is missing or a problem was reported.
    fn number(&mut self, column: Column) -> Option<f64> {
        let name = self.block.header.text(column.place);
        match self.numbers.read(self.row, column.place) {
            Cell::Number(number) => Some(column.scale.zero + column.scale.factor * number),
            Cell::Missing => None,
            Cell::Bad(why) => {
                self.bad = true;
                let cell = self.row.place(column.place);
                self.problems
                    .at(&cell, format!("a cell of the column `{name}` must be a number"))
                    .because(why)
                    .help("write it as `1.5e6`, write `---` where it is missing, or leave the whole row out");
                None
            }
        }
    }
}
