//! A block of a file: a header, perhaps a row of units, and rows of numbers. What all formats have in common once their blocks are
//! found: which columns are read, in which units, and what a row must hold.

use std::f64::consts::TAU;

use super::columns::{self, Named, Role};
use crate::input::data_file::Holes;
use crate::input::data_file::grid::{Grid, Line};
use crate::input::data_file::section::{Asked, Section, Table};
use crate::input::data_file::units::{Scale, given};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::material::ModulusKind;
use crate::material::dynamic::DynamicPoint;

/// One table of a file.
pub(super) struct Block<'a> {
    pub(super) section: Section<'a>,
    /// What the file calls it.
    pub(super) name: Option<String>,
    /// Where the file says it of the block as a whole.
    pub(super) temperature_k: Option<f64>,
    /// Whether an instrument wrote it: of columns with the same meaning the first counts.
    pub(super) by_instrument: bool,
    /// Whether frequencies are reduced, so that the temperatures of the rows are not that of the curve.
    pub(super) is_master: bool,
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
#[derive(Clone)]
pub(super) struct Column {
    pub(super) place: usize,
    pub(super) role: Role,
    pub(super) scale: Scale,
    /// As written.
    pub(super) unit: Option<String>,
}

/// Storage and loss modulus from two columns.
pub(super) type Moduli = fn(f64, f64) -> (f64, f64);

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
        let names = names(&grid.header(header));
        let is_known = |place: usize| names.get(place).is_some_and(Option::is_some);
        Self::of(Section::new(grid, header, end, is_known))
    }

    pub(super) fn of(section: Section<'a>) -> Self {
        Self {
            section,
            name: None,
            temperature_k: None,
            by_instrument: false,
            is_master: false,
        }
    }

    /// As an instrument wrote it.
    pub(super) fn by_instrument(mut self) -> Self {
        self.by_instrument = true;
        self.section.may_be_ragged = true;
        self
    }

    /// The rows in SI units.
    ///
    /// # Errors
    /// Columns that are absent, double, without a unit or of the other modulus; cells that are no positive numbers.
    pub(super) fn read(&self, kind: ModulusKind) -> Result<Content, Diagnostics> {
        let columns = self.columns(kind)?;
        let described = (self.described(&columns), self.assumed(&columns));
        self.content(&columns, described)
    }

    /// The rows of these columns, of which something may be said.
    ///
    /// # Errors
    /// Cells that are no positive numbers.
    pub(super) fn content(
        &self,
        columns: &Columns,
        (described, assumed): (String, Vec<String>),
    ) -> Result<Content, Diagnostics> {
        let help =
            "write it as `1.5e6`, write `---` where it is missing, or leave the whole row out";
        let problems = Problems::new();
        let table = self
            .section
            .read(&columns.asked(), Holes::Kept, help, &problems);
        let mut content = Content {
            points: Vec::new(),
            missing: 0,
            noise: None,
            columns: described,
            is_in_hertz: columns.frequency.scale.factor == TAU,
            assumed,
        };
        for row in 0..table.len() {
            match self.point(columns, &table, row) {
                Row::Measured(measured) => content.points.push(measured),
                Row::Missing => content.missing += 1,
                Row::Noise => content.noise.get_or_insert((table.row(row), 0)).1 += 1,
                Row::Refused(why) => {
                    problems.push(why);
                }
            }
        }
        let mostly = content.noise.as_ref();
        if let Some((first, count)) = mostly.filter(|(_, count)| *count > content.points.len()) {
            let message = format!(
                "{count} rows of a table of {} hold a value that is not positive",
                count + content.points.len()
            );
            problems
                .at(first, message)
                .because("the first")
                .help("check the columns and their signs");
        }
        problems.into_result(Some(content))
    }

    /// What a row gives.
    fn point(&self, columns: &Columns, table: &Table, row: usize) -> Row {
        let values = table.values.iter().skip(row * table.width()).copied();
        let values: Vec<f64> = values.take(table.width()).collect();
        let (needed, others) = values.split_at(3);
        for (which, (column, value)) in columns.all().zip(needed).enumerate() {
            if *value <= 0.0 {
                // A loss near zero is as often below it as above, in any table.
                if self.by_instrument || which == 2 {
                    return Row::Noise;
                }
                let message = format!("{} must be positive", column.role.what());
                return Row::Refused(
                    Diagnostic::at(&table.cell(row, which), message)
                        .help("leave the row out: a measured value that is not positive is noise"),
                );
            }
        }
        let (temperature, errors) = others.split_at(columns.temperature.iter().count());
        if needed.iter().chain(temperature).any(|value| value.is_nan()) {
            return Row::Missing;
        }
        let (storage_modulus_pa, loss_modulus_pa) = (columns.moduli)(needed[1], needed[2]);
        let of_errors = columns.both_errors().zip(<[f64; 2]>::try_from(errors).ok());
        let errors_pa = of_errors.map(|([a, b], [storage, loss])| {
            let storage = a.absolute(storage, storage_modulus_pa);
            (storage, b.absolute(loss, loss_modulus_pa))
        });
        let point = DynamicPoint {
            temperature_k: temperature.first().copied().or(self.temperature_k),
            angular_frequency_rad_per_s: needed[0],
            storage_modulus_pa,
            loss_modulus_pa,
            errors_pa: errors_pa.filter(|(storage, loss)| *storage > 0.0 && *loss > 0.0),
        };
        let place = table.row(row);
        // Moduli of a very large or very small number may leave what a double holds, and temperatures fall below zero.
        if let Some((what, value)) = point.not_positive() {
            let message = format!("{what} must be positive, and is {value:e} in SI units");
            let help = "leave the row out, or check its units";
            return Row::Refused(Diagnostic::at(&place, message).help(help));
        }
        let set = columns.set.as_ref();
        Row::Measured(Measured {
            point,
            place,
            set: set.map(|column| table.line(row).text(column.place).to_owned()),
        })
    }

    fn columns(&self, kind: ModulusKind) -> Result<Columns, Diagnostic> {
        let names = names(&self.section.header);
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
                return Err(self.section.twice([*first, *second], role.what()));
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
        let below = self.section.units.as_ref().map(|units| units.text(place));
        let unit = named.unit.as_deref().or(below).and_then(given)?;
        Some(unit.to_owned())
    }

    fn scale(&self, place: usize, named: &Named) -> Result<Scale, Diagnostic> {
        let name = self.section.header.text(place);
        let read = |unit: Option<&str>| match (named.role, unit) {
            (Role::Frequency, None) => Err(format!(
                "write `{name} [Hz]` or `{name} [rad/s]`: they differ by a factor of 6.28"
            )),
            (role, unit) => columns::scale(role, unit),
        };
        let column = (place, named.role.what());
        self.section.scale(column, named.unit.as_deref(), read)
    }

    /// The names of the columns, with their units.
    fn described(&self, columns: &Columns) -> String {
        let described = columns.all().chain(&columns.set).map(|column| {
            let name = self.section.header.text(column.place);
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
        Diagnostic::at(&self.section.header.place(place), message).help(format!(
            "write modulus = \"{word}\", or give --modulus {word}"
        ))
    }

    fn absent(&self, what: &str, example: &str) -> Diagnostic {
        let place = self.section.header.place(0);
        Diagnostic::at(&place, format!("the table has no column of {what}"))
            .help(format!("name it with its unit, such as `{example}`"))
    }
}

/// What a row gives.
enum Row {
    Measured(Measured),
    /// A number is missing.
    Missing,
    /// An instrument wrote a value that is not positive.
    Noise,
    Refused(Diagnostic),
}

impl Column {
    /// The error of a modulus (Pa).
    fn absolute(&self, error: f64, modulus_pa: f64) -> f64 {
        match self.unit.as_deref().is_some_and(columns::is_relative) {
            true => error * modulus_pa,
            false => error,
        }
    }
}

/// The columns that are read.
pub(super) struct Columns {
    pub(super) frequency: Column,
    /// What the moduli come from.
    pub(super) pair: [Column; 2],
    pub(super) moduli: Moduli,
    pub(super) temperature: Option<Column>,
    pub(super) set: Option<Column>,
    /// Of storage and loss modulus; used where both are there.
    pub(super) errors: [Option<Column>; 2],
}

impl Columns {
    fn both_errors(&self) -> Option<[&Column; 2]> {
        let [storage, loss] = &self.errors;
        storage.as_ref().zip(loss.as_ref()).map(|(a, b)| [a, b])
    }

    /// Those of numbers: frequency, what the moduli come from, temperature, errors.
    fn all(&self) -> impl Iterator<Item = &Column> {
        let needed = std::iter::once(&self.frequency).chain(&self.pair);
        let errors = self.both_errors().into_iter().flatten();
        needed.chain(&self.temperature).chain(errors)
    }

    fn asked(&self) -> Vec<Asked> {
        let asked = |column: &Column| Asked {
            place: column.place,
            scale: column.scale,
            what: column.role.what(),
        };
        self.all().map(asked).collect()
    }
}
