//! Columns: the names by which a header has them, and their units.
//!
//! A name stands alone (`E'`), with its unit (`E' [MPa]`, `G'' (Pa)`, `Frequency / Hz`, `f/Hz`, `Loss modulus, MPa`), or joined to it
//! (`storage_modulus_mpa`, `omega_rad_s`, `temperature_c`). Case does not matter, nor whether blanks, dots, hyphens or `_` part the
//! words; but `t` is no temperature, `F` no frequency, and `T` alone no time.

use std::f64::consts::TAU;

use super::grid::Line;
use super::section::Section;
use super::text::DELIMITERS;
use super::units::{self, Scale};
use crate::input::diagnostic::Diagnostic;
use crate::quantity::Dimension::{self, AngularFrequency, Frequency, Temperature, Time, Voltage};

/// A column that is looked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Column {
    /// Its names without unit, in lower case and joined by `_`; the first is the one that this program writes.
    pub(crate) names: &'static [&'static str],
    /// Words that may stand among those of a name.
    pub(crate) besides: &'static [&'static [&'static str]],
    pub(crate) holds: Holds,
    /// `None` of numbers and words without a unit.
    pub(crate) dimension: Option<Dimension>,
    /// What it holds, in the plural: `times`.
    pub(crate) what: &'static str,
    /// Whether it may be without a unit, and is then in SI units. Of angular frequencies one that must have a unit may be in Hz, too.
    pub(crate) unit_may_be_absent: bool,
    /// Whether a name with anything else in brackets than a unit of this column is one of something else.
    pub(crate) unit_decides: bool,
    /// Whether the table may be without it.
    pub(crate) is_optional: bool,
    /// Whether of several of its names in one table the first in their order counts; else it must be there once.
    pub(crate) first_name_counts: bool,
}

/// What a column holds of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Holds {
    Values,
    /// What is called errors, but for standard errors.
    Errors,
    StandardErrors,
    /// Errors under any word, which may be in %.
    ErrorsOrShares,
}

/// Times, of any table.
pub(crate) const TIME: Column = Column {
    unit_may_be_absent: true,
    ..Column::new(&["time"], Time, "times")
};

/// Words that make a name that of errors, and words that make it that of standard errors.
const OF_ERRORS: &str = "error err std stderr sd sigma uncertainty fehler unc stddev";
const OF_STANDARD_ERRORS: &str = "standard std stderr sd sigma stddev";

impl Column {
    /// A column that must have a unit.
    pub(crate) const fn new(
        names: &'static [&'static str],
        dimension: Dimension,
        what: &'static str,
    ) -> Self {
        Self {
            names,
            besides: &[],
            holds: Holds::Values,
            dimension: Some(dimension),
            what,
            unit_may_be_absent: false,
            unit_decides: false,
            is_optional: false,
            first_name_counts: false,
        }
    }

    /// A column of numbers, or of words, that have no unit.
    pub(crate) const fn pure(names: &'static [&'static str], what: &'static str) -> Self {
        Self {
            dimension: None,
            unit_may_be_absent: true,
            ..Self::new(names, Time, what)
        }
    }

    /// The column of the errors of what this one holds.
    pub(crate) const fn of_errors(self, holds: Holds, what: &'static str) -> Self {
        Self {
            holds,
            what,
            ..self
        }
    }

    /// The same column of a table that may be without it.
    pub(crate) const fn optional(self) -> Self {
        Self {
            is_optional: true,
            ..self
        }
    }

    /// The same column, of whose names in one table the first in their order counts.
    pub(crate) const fn by_first_name(self) -> Self {
        Self {
            first_name_counts: true,
            ..self
        }
    }

    /// The same column, where a name with a unit of something else is not one of it.
    pub(crate) const fn by_unit(self) -> Self {
        Self {
            unit_decides: true,
            ..self
        }
    }

    /// A name, a unit that it may have, and the name with its SI unit, as this program writes it: `creep_compliance_per_pa`.
    fn examples(&self) -> (&'static str, &'static str, String) {
        let (name, dimension) = (self.names.first().unwrap_or(&""), self.dimension);
        let unit = dimension.map_or("", Dimension::si_unit).to_lowercase();
        let unit = match unit.strip_prefix("1/") {
            Some(divisor) => format!("per_{divisor}"),
            None => unit.replace('/', "_per_").replace(' ', "_"),
        };
        let ending = match self.holds {
            Holds::Values => "",
            Holds::StandardErrors => "_standard_error",
            Holds::Errors | Holds::ErrorsOrShares => "_error",
        };
        let common = dimension.map_or("-", Dimension::common_unit);
        (name, common, format!("{name}{ending}_{unit}"))
    }

    /// The name with its SI unit.
    pub(crate) fn name_in_si(&self) -> String {
        self.examples().2
    }

    /// What turns the numbers of the column, which has this name, into SI units.
    ///
    /// # Errors
    /// The unit is none of this column, or absent: what to write.
    pub(crate) fn scale(&self, name: &str, unit: Option<&str>) -> Result<Scale, String> {
        let may_be_in_hertz = self.dimension == Some(AngularFrequency) && !self.unit_may_be_absent;
        let (Some(unit), Some(dimension)) = (unit.and_then(units::given), self.dimension) else {
            return match self.unit_may_be_absent {
                true => Ok(Scale::ONE),
                false if may_be_in_hertz => Err(format!(
                    "write `{name} [Hz]` or `{name} [rad/s]`: they differ by a factor of 6.28"
                )),
                false => Err(format!(
                    "write its unit, such as `{name} [{}]`",
                    self.examples().1
                )),
            };
        };
        match units::scale(unit, dimension) {
            Err(_) if unit == "%" && self.holds == Holds::ErrorsOrShares => Ok(Scale::times(0.01)),
            Err(_) if may_be_in_hertz => {
                units::scale(unit, Frequency).map(|hertz| Scale::times(TAU * hertz.factor))
            }
            // Where Hz are none, it means rad/s.
            Err(_) if dimension == AngularFrequency && units::spelt(unit) == "1/s" => {
                Ok(Scale::ONE)
            }
            scale => scale,
        }
    }

    /// Whether a cell of a header names this column.
    pub(crate) fn is_named(&self, cell: &str) -> bool {
        self.named(&ways(cell)).is_some()
    }

    /// Whether one of these cells names it.
    pub(crate) fn is_in(&self, header: &Line<'_>) -> bool {
        header.texts().any(|cell| self.is_named(cell))
    }

    /// How a cell of a header, taken apart in these ways, names this column; `None` where it names another one.
    pub(crate) fn named(&self, ways: &[Way<'_>]) -> Option<Named> {
        ways.iter().enumerate().find_map(|(place, way)| {
            // A unit may be joined to a name that has none beside it, in up to four words.
            let may_be_joined = way.unit.is_none() && self.dimension.is_some();
            let most = if may_be_joined { 5 } else { 1 };
            let ends = way.name.rmatch_indices('_').map(|(end, _)| end);
            let ends = [way.name.len()].into_iter().chain(ends).take(most);
            ends.enumerate().find_map(|(joined, end)| {
                let found = self.which(&way.name[..end]);
                let (which, name) = found.filter(|_| !self.is_other_symbol(way))?;
                let fits = |unit: &str| self.scale("", Some(unit)).is_ok();
                let is_joined = |unit: &String| units::given(unit) == Some(unit) && fits(unit);
                let unit = match joined {
                    0 => way.unit.map(str::to_owned),
                    _ => Some(way.joined(joined).into_iter().find(is_joined)?),
                };
                let is_own = match &unit {
                    // A deflection is a length unless it is in volts.
                    None if self.dimension == Some(Voltage) => false,
                    None => (self.dimension, &*way.written) != (Some(Time), "T"),
                    Some(unit) => (way.is_sure && self.is_sure(&name)) || fits(unit),
                };
                is_own.then_some(Named {
                    rank: [place, joined, which],
                    is_vague: !way.is_sure || which >= self.names.len(),
                    name,
                    unit,
                })
            })
        })
    }

    /// Whether a name begins with a symbol that in this case is one of another quantity.
    fn is_other_symbol(&self, way: &Way<'_>) -> bool {
        let symbols: &[&str] = match self.dimension {
            Some(Temperature) => &["t"],
            Some(AngularFrequency | Frequency) => &["F", "W"],
            _ => &[],
        };
        let first = way.written.split('_').next();
        first.is_some_and(|first| symbols.contains(&first))
    }

    /// Whether a name is one of this column with any unit, be it a wrong one: a letter stands for many things, but those of frequencies.
    fn is_sure(&self, name: &str) -> bool {
        let is_frequency = matches!(self.dimension, Some(AngularFrequency | Frequency));
        !self.unit_decides && (is_frequency || name.chars().nth(1).is_some())
    }

    /// Which of its names this is, beyond their number where it is two of them, as in `storage_modulus_e'`; and the name without words
    /// of errors.
    fn which(&self, name: &str) -> Option<(usize, String)> {
        let has = |list: &str, word: &str| list.split(' ').any(|known| known == word);
        let mut words: Vec<&str> = name.split('_').collect();
        let has_error = words.iter().any(|word| has(OF_ERRORS, word));
        let is_standard = words.iter().any(|word| has(OF_STANDARD_ERRORS, word));
        let is_held = match self.holds {
            Holds::Values => !has_error,
            Holds::Errors => words.contains(&"error") && !is_standard,
            Holds::StandardErrors => words.contains(&"error") && is_standard,
            Holds::ErrorsOrShares => has_error,
        };
        if !is_held {
            return None;
        }
        if has_error {
            words.retain(|word| !has(OF_ERRORS, word) && !has("standard of", word));
        }
        let name = words.join("_");
        words.retain(|word| !self.besides.iter().any(|list| list.contains(word)));
        let own = |words: &[&str]| {
            let is_it = |known: &&str| known.split('_').eq(words.iter().copied());
            self.names.iter().position(is_it)
        };
        let two = || {
            let ends = [words.split_at_checked(1)?, words.split_at(words.len() - 1)];
            let two = ends
                .into_iter()
                .find_map(|(a, b)| Some(own(a)?.min(own(b)?)));
            Some(self.names.len() + two?)
        };
        Some((own(&words).or_else(two)?, name))
    }

    /// Where the column stands in a table, and the unit beside its name; `None` where it is not there and need not be. Of several cells
    /// with its name the surest counts, of an instrument's the first.
    pub(super) fn found(
        &self,
        section: &Section<'_>,
    ) -> Result<Option<(usize, Option<String>)>, Diagnostic> {
        let named = |(place, cell)| Some((place, self.named(&ways(cell))?));
        let mut found: Vec<_> = section
            .header
            .texts()
            .enumerate()
            .filter_map(named)
            .collect();
        let rank = |(place, named): &(usize, Named)| match section.by_instrument {
            true => (false, *place),
            false => (
                named.is_vague,
                named.rank[2] * usize::from(self.first_name_counts),
            ),
        };
        let first = found.iter().map(rank).min();
        found.retain(|one| Some(rank(one)) == first);
        match found.as_mut_slice() {
            [] if self.is_optional => Ok(None),
            [] => Err(self.missing(section)),
            [(place, named)] => Ok(Some((*place, named.unit.take()))),
            [(first, _), (second, _), ..] => Err(section.twice([*first, *second], self.what)),
        }
    }

    fn missing(&self, section: &Section<'_>) -> Diagnostic {
        let ((first, unit, name), header) = (self.examples(), &section.header);
        let problem = Diagnostic::at(&section.grid.place(0), format!("no column `{name}`"));
        if (0..header.len()).any(|cell| header.is_number(cell)) {
            return problem
                .because("numbers")
                .help("begin the table with a line of column names");
        }
        let delimiter = section.grid.delimiter();
        let by = DELIMITERS.iter().find(|(known, _)| *known == delimiter);
        let because = match (header.len(), by) {
            (1, _) | (_, None) => "one column".to_owned(),
            (count, Some((_, by))) => format!("{count} columns, separated by {by}"),
        };
        let what = self.what;
        problem.because(because).help(format!(
            "name the column of {what} with its unit, such as `{name}` or `{first} [{unit}]`"
        ))
    }
}

/// How a cell of a header names a column.
#[derive(Debug, PartialEq)]
pub(crate) struct Named {
    /// The lower the surer: in which way the cell is taken apart, how many of its words are the unit, which of the names it is.
    pub(crate) rank: [usize; 3],
    /// Whether it may as well mean something else.
    is_vague: bool,
    /// In lower case, its words joined by `_`, without those of errors.
    pub(crate) name: String,
    /// Where the cell gives it.
    pub(crate) unit: Option<String>,
}

/// A way to take a cell of a header apart.
pub(crate) struct Way<'a> {
    /// Words of the name, joined by `_`.
    written: String,
    /// The same in lower case.
    name: String,
    unit: Option<&'a str>,
    /// Whether the unit is in brackets or behind a stroke with blanks, where it is not joined to the name.
    is_sure: bool,
}

/// All ways to take a cell of a header apart into name and unit, the surest first.
pub(crate) fn ways(cell: &str) -> Vec<Way<'_>> {
    let cell = cell.trim();
    if cell.is_empty() || cell.len() > LONGEST || cell.parse::<f64>().is_ok() {
        return Vec::new();
    }
    let way = |is_sure, name: &str, unit| {
        let primes = name.replace(['\u{2033}', '\u{201c}', '\u{201d}', '"'], "''");
        let primes = primes.replace(['\u{2032}', '\u{2019}', '\u{2018}', '`', '\u{b4}'], "'");
        let words = primes.split(|c: char| c.is_whitespace() || "_-.".contains(c));
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let written = words.join("_");
        let name = written.to_lowercase();
        Way {
            written,
            name,
            unit,
            is_sure,
        }
    };
    // The argument of `E(t)` is no unit.
    let brackets = [('[', ']'), ('(', ')')].into_iter();
    let mut bracketed = brackets
        .filter_map(|(open, close)| cell.strip_suffix(close)?.rsplit_once(open))
        .filter(|(_, unit)| *unit != "t");
    let bracketed = bracketed.next().or_else(|| cell.rsplit_once(" / "));
    let bracketed = bracketed.map(|split| (true, split));
    // What stands behind other signs may be anything: `G*/sin(delta)`.
    let others = ["/", ", ", " in "].map(|mark| Some((false, cell.split_once(mark)?)));
    let split = [bracketed].into_iter().chain(others).flatten();
    let split = split.map(|(is_sure, (name, unit))| way(is_sure, name, Some(units::bare(unit))));
    [way(true, cell, None)].into_iter().chain(split).collect()
}

/// Longest cell of a header that is looked at, bytes.
const LONGEST: usize = 100;

impl Way<'_> {
    /// The units that the last words of the name may be.
    fn joined(&self, words: usize) -> [String; 3] {
        let before = self.written.rmatch_indices('_').take(words).last();
        units::joined(before.map_or("", |(at, _)| &self.written[at + 1..]))
    }
}
