//! A block of a file: a header, perhaps a row of units, and rows of numbers. What all formats have in common once their blocks are
//! found: which columns are read, in which units, and what a row must hold.

use std::f64::consts::TAU;

use super::columns::{self, Named, Role};
use super::steps::temperature_in;
use crate::input::data_file::Holes;
use crate::input::data_file::grid::{Grid, Line};
use crate::input::data_file::section::{Asked, Section, Table};
use crate::input::data_file::units::given;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::material::ModulusKind;
use crate::material::dynamic::DynamicPoint;

/// One table of a file.
pub(super) struct Block<'a> {
    pub(super) section: Section<'a>,
    /// What the file calls it.
    pub(super) name: Option<&'a str>,
    /// Where the file says it of the block as a whole.
    pub(super) temperature_k: Option<f64>,
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
    /// Whether the frequencies are in Hz.
    pub(super) is_in_hertz: bool,
    /// What was read and assumed.
    pub(super) notes: Vec<String>,
}

/// A column that is read.
pub(super) struct Column {
    asked: Asked,
    role: Role,
    /// As written.
    unit: Option<String>,
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

/// What these columns lack of dynamic data, and names that it may have.
pub(super) fn lacking(names: &[Option<Named>]) -> Option<[&'static str; 2]> {
    let has = |role| has(names, role);
    match () {
        () if !has(Role::Frequency) && !has(Role::AngularFrequency) => {
            Some(["frequencies", "`frequency_hz` or `Frequency [Hz]`"])
        }
        () if !has(Role::Storage) && !has(Role::Complex) => {
            Some(["storage moduli", "`storage_modulus_mpa` or `E' [MPa]`"])
        }
        () if pair(names).is_none() => Some(["loss moduli", "`E'' [MPa]` or `tan delta`"]),
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
            is_master: false,
        }
    }

    /// As an instrument wrote it: of columns with the same meaning the first counts.
    pub(super) fn by_instrument(mut self) -> Self {
        self.section.by_instrument = true;
        self
    }

    /// As an instrument wrote it, of a step whose name may say its temperature.
    pub(super) fn of_step(mut self, name: Option<&'a str>) -> Self {
        self.name = name;
        self.temperature_k = name.and_then(temperature_in);
        self.by_instrument()
    }

    /// What messages call it.
    pub(super) fn called(&self) -> &'a str {
        self.name.unwrap_or("without a name")
    }

    /// The rows in SI units.
    ///
    /// # Errors
    /// Columns that are absent, double, without a unit or of the other modulus; cells that are no positive numbers.
    pub(super) fn read(&self, kind: ModulusKind) -> Result<Content, Diagnostics> {
        let columns = self.columns(kind)?;
        self.content(&columns, self.notes(&columns))
    }

    /// The rows of these columns, of which these notes are made.
    ///
    /// # Errors
    /// Cells that are no positive numbers.
    pub(super) fn content(
        &self,
        columns: &Columns,
        notes: Vec<String>,
    ) -> Result<Content, Diagnostics> {
        let help =
            "write it as `1.5e6`, write `---` where it is missing, or leave the whole row out";
        let problems = Problems::new();
        let asked = (columns.numbers.each_ref()).map(|column| Some(column.as_ref()?.asked));
        let table = self.section.read(&asked, Holes::Kept, help, &problems);
        let mut content = Content {
            points: Vec::new(),
            missing: 0,
            noise: None,
            is_in_hertz: matches!(asked[0], Some(frequency) if frequency.scale.factor == TAU),
            notes,
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
        let number = |which: usize| table.number(row, which);
        for (which, asked) in columns.numbers.iter().flatten().take(3).enumerate() {
            if number(which).is_none_or(|number| number > 0.0) {
                continue;
            }
            // A loss near zero is as often below it as above, in any table.
            if self.section.by_instrument || which == 2 {
                return Row::Noise;
            }
            let message = format!("{} must be positive", asked.asked.what);
            let help = "leave the row out: a measured value that is not positive is noise";
            return Row::Refused(Diagnostic::at(&table.cell(row, which), message).help(help));
        }
        let (temperature_k, place) = (number(3), table.row(row));
        let (Some(omega), Some(first), Some(second)) = (number(0), number(1), number(2)) else {
            return Row::Missing;
        };
        if table.has(3) && temperature_k.is_none() {
            return Row::Missing;
        }
        let moduli = (columns.moduli)(first, second);
        let error = |which: usize, modulus_pa: f64| {
            let column = columns.numbers[4 + which].as_ref()?;
            Some(column.absolute(number(4 + which)?, modulus_pa)).filter(|error| *error > 0.0)
        };
        let point = DynamicPoint {
            temperature_k: temperature_k.or(self.temperature_k),
            angular_frequency_rad_per_s: omega,
            storage_modulus_pa: moduli.0,
            loss_modulus_pa: moduli.1,
            errors_pa: error(0, moduli.0).zip(error(1, moduli.1)),
        };
        // Moduli of a very large or very small number may leave what a double holds, and temperatures fall below zero.
        if let Some((what, value)) = point.not_positive() {
            let message = format!("{what} must be positive, and is {value:e} in SI units");
            let help = "leave the row out, or check its units";
            return Row::Refused(Diagnostic::at(&place, message).help(help));
        }
        let set = columns.set.as_ref();
        let set = set.map(|column| table.line(row).text(column.asked.place).to_owned());
        Row::Measured(Measured { point, place, set })
    }

    fn columns(&self, kind: ModulusKind) -> Result<Columns, Diagnostic> {
        let names = names(&self.section.header);
        if let Some([what, example]) = lacking(&names) {
            let message = format!("the table has no column of {what}");
            return Err(Diagnostic::at(&self.section.header.place(0), message)
                .help(format!("name it with its unit, such as {example}")));
        }
        let find = |role| self.find(&names, role, kind);
        let frequency = match find(Role::AngularFrequency)? {
            Some(angular) => Some(angular),
            None => find(Role::Frequency)?,
        };
        let (first, second, moduli) = *pair(&names).unwrap_or(&PAIRS[0]);
        let [first, second] = [find(first)?, find(second)?];
        let temperature = match self.is_master {
            true => None,
            false => find(Role::Temperature)?,
        };
        let errors = [find(Role::StorageError)?, find(Role::LossError)?];
        let has_one_error = errors.iter().flatten().count() == 1;
        let [storage, loss] = if has_one_error { [None, None] } else { errors };
        Ok(Columns {
            numbers: [frequency, first, second, temperature, storage, loss],
            moduli,
            set: find(Role::Set)?,
            has_one_error,
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
            ([(first, _), (second, _), ..], _) if !self.section.by_instrument => {
                return Err(self.section.twice([*first, *second], role.column().what));
            }
            _ => {}
        }
        let read = asked.iter().map(|(place, named)| {
            let above = named.unit.as_deref();
            Ok(Column {
                unit: self.unit_of(*place, named),
                ..Column::at(self.section.asked(role.column(), *place, above)?, role)
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

    /// The names of the columns, with their units, and what is assumed.
    fn notes(&self, columns: &Columns) -> Vec<String> {
        let (needed, errors) = columns.numbers.split_at(4);
        let needed = needed.iter().flatten().chain(&columns.set);
        let described = needed.chain(errors.iter().flatten()).map(|column| {
            let name = self.section.header.text(column.asked.place);
            let unit = column.unit.as_deref().filter(|unit| !name.contains(unit));
            unit.map_or_else(|| format!("`{name}`"), |unit| format!("`{name}` [{unit}]"))
        });
        let described: Vec<String> = described.collect();
        let mut notes = vec![format!("columns read: {}", described.join(", "))];
        if columns.has_one_error {
            notes.push("the errors of one modulus alone are not used".to_owned());
        }
        let frequency = columns.numbers[0].as_ref();
        if frequency.is_some_and(|of| of.role == Role::AngularFrequency && of.unit.is_none()) {
            notes.push("angular frequencies without a unit are taken in rad/s".to_owned());
        }
        notes
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
    /// One of a known role.
    pub(super) fn at(asked: Asked, role: Role) -> Self {
        Self {
            asked,
            role,
            unit: None,
        }
    }

    /// The error of a modulus (Pa).
    fn absolute(&self, error: f64, modulus_pa: f64) -> f64 {
        match self.unit.as_deref() == Some("%") {
            true => error * modulus_pa,
            false => error,
        }
    }
}

/// The columns that are read.
pub(super) struct Columns {
    /// Frequency, the two that the moduli come from, temperature, errors of storage and loss modulus, both or none.
    pub(super) numbers: [Option<Column>; 6],
    pub(super) moduli: Moduli,
    pub(super) set: Option<Column>,
    /// Whether the table has errors of one modulus alone, which are not used.
    pub(super) has_one_error: bool,
}
