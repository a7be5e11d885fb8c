//! A block of a file: a header, perhaps a row of units, and rows of numbers. What all formats have in common once their blocks are
//! found: which columns are read, in which units, and what a row must hold.

mod rows;

use std::f64::consts::TAU;
use std::ops::Range;

use super::columns::{self, Named, Role};
use super::units::{self, Scale};
use crate::input::data_file::grid::{Grid, Line};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::material::ModulusKind;
use crate::material::dynamic::DynamicPoint;
use rows::RowReader;
pub(super) use rows::Skipped;

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
    /// Whether the frequencies are in Hz.
    pub(super) is_in_hertz: bool,
    pub(super) assumed: Vec<String>,
}

/// A column that is read.
struct Column {
    place: usize,
    role: Role,
    scale: Scale,
    /// As written.
    unit: Option<String>,
}

/// Storage and loss modulus from two columns.
type Moduli = fn(f64, f64) -> (f64, f64);

/// Columns that give both moduli, those to be preferred first.
const PAIRS: [(Role, Role, Moduli); 4] = [
    (Role::Storage, Role::Loss, |a, b| (a, b)),
    (Role::Storage, Role::TanDelta, |a, b| (a, a * b)),
    (Role::Complex, Role::PhaseAngle, |a, b| {
        (a * b.cos(), a * b.sin())
    }),
    (Role::Complex, Role::TanDelta, |a, b| {
        let storage = a / 1f64.hypot(b);
        (storage, storage * b)
    }),
];

/// What the names of a header say, cell by cell.
pub(super) fn names(header: &Line<'_>) -> Vec<Option<Named>> {
    // No instrument writes as many; a hostile file may.
    let cells = header.texts().take(2000);
    cells.map(columns::recognise).collect()
}

/// Whether one of these columns has this role.
fn has(names: &[Option<Named>], role: Role) -> bool {
    names.iter().flatten().any(|named| named.role == role)
}

/// The first pair of columns that gives both moduli.
fn pair(names: &[Option<Named>]) -> Option<&'static (Role, Role, Moduli)> {
    let is_there = |(a, b, _): &&(Role, Role, Moduli)| has(names, *a) && has(names, *b);
    PAIRS.iter().find(is_there)
}

/// Whether these columns are dynamic data: a frequency, and two that give both moduli.
pub(super) fn is_dynamic(names: &[Option<Named>]) -> bool {
    lacking(names).is_none()
}

/// What these columns lack of dynamic data.
pub(super) fn lacking(names: &[Option<Named>]) -> Option<&'static str> {
    let has = |role| has(names, role);
    match () {
        () if !has(Role::Frequency) && !has(Role::AngularFrequency) => Some("frequencies"),
        () if !has(Role::Storage) && !has(Role::Complex) => Some("storage moduli"),
        () if pair(names).is_none() => Some("loss moduli"),
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
            && below.texts().any(units::is_unit);
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
            columns: self.described(&columns),
            is_in_hertz: columns.frequency.scale.factor == TAU,
            assumed: self.assumed(&columns),
        };
        let mut reader = RowReader {
            block: self,
            columns: &columns,
            numbers: self.grid.numbers(self.rows.clone()),
            problems: Problems::new(),
        };
        let is_read = |line: &usize| {
            !self.grid.is_comment(*line) && self.skipped.binary_search(line).is_err()
        };
        for line in self.rows.clone().filter(is_read) {
            let place = self.grid.place(line);
            let row = aligned(self.grid.line(line), self.header.len());
            match reader.point(&row, &place) {
                Ok(measured) => content.points.push(measured),
                Err(Skipped::Noise) => content.noise.get_or_insert((place, 0)).1 += 1,
                Err(Skipped::Missing) => content.missing += 1,
                Err(Skipped::Bad) => {}
            }
        }
        let RowReader {
            numbers, problems, ..
        } = reader;
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
        let pair = match pair(&names) {
            Some((a, b, moduli)) => find(*a)?.zip(find(*b)?).map(|both| (both, *moduli)),
            None => None,
        };
        let Some(((first, second), moduli)) = pair else {
            return Err(match has(&names, Role::Storage) {
                true => self.absent("loss moduli", "E'' [MPa]` or `tan delta"),
                false => self.absent("storage moduli", "storage_modulus_mpa` or `E' [MPa]"),
            });
        };
        let errors = [find(Role::StorageError)?, find(Role::LossError)?];
        let temperature = match self.is_master {
            true => None,
            false => find(Role::Temperature)?,
        };
        Ok(Columns {
            frequency,
            pair: [first, second],
            moduli,
            temperature,
            set: find(Role::Set)?,
            errors,
        })
    }

    /// The column of this role, of this modulus: the only one, or of an instrument's the first whose unit can be read.
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
        let (asked, others): (Vec<_>, Vec<_>) =
            of_role.partition(|(_, named)| named.kind.is_none_or(|k| k == kind));
        match (asked.as_slice(), others.first()) {
            ([], Some((other, _))) => return Err(self.other_modulus(*other, kind)),
            ([(first, _), (second, _), ..], _) if !self.by_instrument => {
                let message = format!("the table has two columns of {}", role.what());
                return Err(Diagnostic::at(&self.header.place(*second), message)
                    .label(&self.header.place(*first), "the other one")
                    .help("keep one of them"));
            }
            _ => {}
        }
        let read = asked.iter().map(|(place, named)| {
            Ok(Column {
                place: *place,
                role,
                scale: self.scale(*place, named)?,
                unit: self.unit_of(*place, named),
            })
        });
        let read: Vec<Result<Column, Diagnostic>> = read.collect();
        let first = read.iter().position(Result::is_ok).unwrap_or(0);
        read.into_iter().nth(first).transpose()
    }

    /// The unit of a column as written, in the header or below it.
    fn unit_of(&self, place: usize, named: &Named) -> Option<String> {
        let below = self.units.as_ref().map(|units| units.text(place));
        let unit = named.unit.as_deref().or(below).and_then(given)?;
        Some(unit.to_owned())
    }

    fn scale(&self, place: usize, named: &Named) -> Result<Scale, Diagnostic> {
        let at_header = self.header.place(place);
        let above = named.unit.as_deref().and_then(given);
        let above = above.map(|unit| (unit, at_header.clone()));
        let below = self.units.as_ref();
        let below = below.and_then(|row| Some((given(row.text(place))?, row.place(place))));
        let what = named.role.what();
        let read = |(unit, at): &(&str, Location)| {
            units::scale(named.role, Some(unit)).map_err(|why| {
                Diagnostic::at(at, format!("`{unit}` is no unit of the column of {what}"))
                    .because(why)
            })
        };
        match (above, below) {
            (Some(unit), None) | (None, Some(unit)) => read(&unit),
            (Some(above), Some(below)) => {
                let (scale, other) = (read(&above)?, read(&below)?);
                match scale == other {
                    true => Ok(scale),
                    false => Err(Diagnostic::at(&below.1, "the header gives another unit")
                        .label(&above.1, "this one")
                        .help("keep one of the two")),
                }
            }
            (None, None) => units::scale(named.role, None).map_err(|write| {
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

    /// The names of the columns, with their units.
    fn described(&self, columns: &Columns) -> String {
        let described = columns.all().map(|column| {
            let name = self.header.text(column.place);
            let unit = column.unit.as_deref().filter(|unit| !name.contains(unit));
            unit.map_or_else(|| format!("`{name}`"), |unit| format!("`{name}` [{unit}]"))
        });
        described.collect::<Vec<_>>().join(", ")
    }

    fn assumed(&self, columns: &Columns) -> Vec<String> {
        let mut assumed = Vec::new();
        if let [Some(_), None] | [None, Some(_)] = columns.errors {
            assumed.push("the errors of one modulus alone are not used".to_owned());
        }
        let frequency = &columns.frequency;
        if frequency.role == Role::AngularFrequency && frequency.unit.is_none() {
            assumed.push("angular frequencies without a unit are taken in rad/s".to_owned());
        }
        assumed
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

/// A unit that is one.
fn given(unit: &str) -> Option<&str> {
    Some(units::bare(unit)).filter(|unit| !["", "-"].contains(unit))
}

/// The columns that are read.
struct Columns {
    frequency: Column,
    /// What the moduli come from.
    pair: [Column; 2],
    moduli: Moduli,
    temperature: Option<Column>,
    set: Option<Column>,
    /// Of storage and loss modulus; used where both are there.
    errors: [Option<Column>; 2],
}

impl Columns {
    fn both_errors(&self) -> Option<[&Column; 2]> {
        let [storage, loss] = &self.errors;
        storage.as_ref().zip(loss.as_ref()).map(|(a, b)| [a, b])
    }

    fn all(&self) -> impl Iterator<Item = &Column> {
        let needed = std::iter::once(&self.frequency).chain(&self.pair);
        let others = self.temperature.iter().chain(&self.set);
        let errors = self.both_errors().into_iter().flatten();
        needed.chain(others).chain(errors)
    }
}
