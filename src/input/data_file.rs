//! Data files: tables of named columns and matrices of numbers, in text, whatever program wrote them.
//!
//! - Text is UTF-8 or UTF-16, with or without a byte order mark, with the line ends of any system. Empty lines and lines that begin
//!   with `#` are passed over.
//! - Cells are separated by commas, semicolons, tabs, vertical bars or blanks, which is found out; quotation marks may enclose a cell.
//! - Numbers have a decimal point, or a decimal comma where commas do not separate cells. There, where one of them has both signs
//!   (`1.000,5`) or one of them twice, the other sign or this one groups thousands in all.
//! - A cell may say that its number is missing. In tables of what was measured its row is passed over or the cell left out; a table
//!   that prescribes something is refused.
//! - A column is asked for by its names and its dimension, and comes in SI units. The header gives the unit: `time_s`, `Time [s]`,
//!   `time (ms)`, `Time / s`; or a row of units below it does. In names joined by `_` case does not matter: `mpa` is MPa.
//!
//! Every problem is shown at its place, all of a file at once.
//!
//! Bytes become a text in `text`, those of a workbook one for every sheet in `workbook`; `grid` cuts it into lines of cells, of which a
//! `section` is a table: a header of names (`column`), perhaps a row of units (`units`), and rows of numbers (`numbers`). Files of
//! instruments, in [`super::dynamic`], are read by the same sections and columns.

pub(crate) mod column;
pub(crate) mod grid;
mod numbers;
mod plain;
pub(crate) mod section;
mod text;
pub(crate) mod units;
pub(crate) mod workbook;

use std::path::Path;
use std::sync::Arc;

use super::diagnostic::{Diagnostic, Diagnostics, Location, Problems, Source};
use super::document::{Located, cannot_read, read_limited};
pub(crate) use column::{Column, Holds, TIME};
use grid::{Grid, Line};
pub(super) use plain::matrix as plain_matrix;
use section::{Asked, Section};
pub(crate) use section::{Holes, Table};
use text::DELIMITERS;
use units::Scale;

/// Largest file read, bytes: a map of 4096 x 4096 points with 30 characters each.
pub const MAX_BYTES: usize = 512_000_000;

/// What messages call a file, and its bytes.
///
/// # Errors
/// It cannot be read, or has more bytes than that.
pub(super) fn contents(path: &Path, most: usize) -> Result<(String, Vec<u8>), Diagnostics> {
    let name = path.display().to_string();
    match read_limited(path, most) {
        Ok(bytes) => Ok((name, bytes)),
        Err(error) => Err(cannot_read(&name, &error).into()),
    }
}

/// Refuses a file of more bytes than that.
pub(super) fn within(name: &str, bytes: &[u8], most: usize, help: &str) -> Result<(), Diagnostic> {
    if bytes.len() <= most {
        return Ok(());
    }
    let message = format!("`{name}` is larger than {} MB", most / 1_000_000);
    Err(Diagnostic::new(message).help(help))
}

/// The bytes of the file that a key names, or of the table given under this name, and what messages call it. `None` where a problem was
/// reported.
pub(super) fn named(
    file: &Located<String>,
    folder: &Path,
    problems: &Problems,
) -> Option<(String, Vec<u8>)> {
    if let Some(bytes) = file.location.source().table(&file.value) {
        return Some((file.value.clone(), bytes.to_vec()));
    }
    let path = file.path_from(folder);
    let name = path.display().to_string();
    match read_limited(&path, MAX_BYTES) {
        Ok(bytes) => Some((name, bytes)),
        Err(error) => {
            problems
                .at(file, format!("cannot read `{name}`: {error}"))
                .help(file.path_rule());
            None
        }
    }
}

/// What is made of the file that a key names, from what messages call it and its bytes. `None` where a problem was reported.
pub(super) fn made_of<T>(
    file: &Located<String>,
    folder: &Path,
    problems: &Problems,
    make: impl FnOnce(&str, &[u8]) -> Result<T, Diagnostics>,
) -> Option<T> {
    let (name, bytes) = named(file, folder, problems)?;
    accepted(make(&name, &bytes), file, problems)
}

/// What was made of a data file; where it was refused, that is reported, with the place where the file is named.
pub(super) fn accepted<T>(
    made: Result<T, Diagnostics>,
    file: &Located<String>,
    problems: &Problems,
) -> Option<T> {
    made.map_err(|refused| problems.extend(refused.label_first(file, "the file is named here")))
        .ok()
}

/// The text of a data file.
pub(crate) struct DataFile {
    source: Arc<Source>,
}

impl DataFile {
    /// Takes the bytes of a file that messages call `name`.
    ///
    /// # Errors
    /// More than [`MAX_BYTES`], or no text.
    pub(crate) fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, Diagnostics> {
        let help = "save fewer rows of a table, and a map as .npy or with fewer points";
        within(name, bytes, MAX_BYTES, help)?;
        let source = Source::file(name, text::decode(name, bytes)?);
        Ok(Self { source })
    }

    /// Whether the header has one of these columns.
    pub(crate) fn has_any(&self, columns: &[Column]) -> bool {
        !self.headings(columns).0.is_empty()
    }

    /// The headings that name one of these columns, and all others, each in the order of the table; without those that are empty.
    pub(crate) fn headings(&self, wanted: &[Column]) -> (Vec<String>, Vec<String>) {
        let grid = self.header(wanted);
        let header = grid.line(0);
        let named = header.texts().filter(|cell| !cell.is_empty());
        let is_wanted = |cell: &String| wanted.iter().any(|column| column.is_named(cell));
        named.map(str::to_owned).partition(is_wanted)
    }

    /// The columns asked for, in SI units. `without_number` says what to do about a cell that has none.
    ///
    /// # Errors
    /// No header, an absent column or two of it, an absent or wrong unit; rows of the wrong number of cells, cells that are no
    /// numbers; commas that may separate decimals or thousands.
    pub(crate) fn columns(
        &self,
        wanted: &[Column],
        holes: Holes,
        without_number: &str,
    ) -> Result<Table, Diagnostics> {
        let header = self.header(wanted);
        if header.len() == 0 {
            let needed = wanted.iter().filter(|column| !column.is_optional);
            let names: Vec<String> = needed.map(Column::name_in_si).collect();
            let example = names.join(",");
            return Err(Diagnostic::at(&self.first_line(), "the table is empty")
                .help(format!("begin it with a line of column names: `{example}`"))
                .into());
        }
        let grid = Grid::of_table(&self.source, header.delimiter(), usize::MAX);
        Section::of(&grid, 0, wanted).table(wanted, holes, without_number)
    }

    /// All cells as numbers: a matrix without a header.
    ///
    /// # Errors
    /// Nothing but comments, rows of different length, cells that are no numbers.
    pub(crate) fn matrix(&self, without_number: &str) -> Result<Table, Diagnostics> {
        let is_numeric = |first: &Line<'_>| {
            let is_cell = |cell: usize| first.text(cell).is_empty() || first.is_number(cell);
            usize::from((0..first.len()).all(is_cell))
        };
        let first = self.opening(is_numeric);
        if first.len() == 0 {
            let help = "give one line of numbers per row, or per point";
            return Err(self.no_numbers(help).into());
        }
        let grid = Grid::of_table(&self.source, first.delimiter(), usize::MAX);
        let section = Section::without_names(&grid, 0);
        let column = |place| {
            let (scale, what) = (Scale::ONE, "");
            Some(Asked { place, scale, what })
        };
        let asked: Vec<Option<Asked>> = (0..section.header.len()).map(column).collect();
        let problems = Problems::new();
        let table = section.read(&asked, Holes::Refused, without_number, &problems);
        problems.into_result(Some(table))
    }

    /// A problem of a file without numbers.
    pub(crate) fn no_numbers(&self, help: &str) -> Diagnostic {
        Diagnostic::at(&Location::whole(&self.source), "the file holds no numbers").help(help)
    }

    /// The first line, for messages.
    pub(crate) fn first_line(&self) -> Location {
        Grid::of_table(&self.source, ',', 1).place(0)
    }

    /// The first line, cut by the delimiter that shows most of the columns.
    fn header(&self, wanted: &[Column]) -> Grid {
        self.opening(|header| wanted.iter().filter(|of| of.is_in(header)).count())
    }

    /// The first line, cut by the delimiter that does best; of equal ones the first that is there.
    fn opening(&self, score: impl Fn(&Line<'_>) -> usize) -> Grid {
        let cut = DELIMITERS.map(|(delimiter, _)| Grid::of_table(&self.source, delimiter, 1));
        let best = cut.into_iter().rev().max_by_key(|grid| {
            let line = grid.line(0);
            (score(&line), line.len() > 1)
        });
        best.unwrap_or_else(|| Grid::of_table(&self.source, ',', 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Dimension;
    use proptest::prelude::*;

    const MODULUS: Column = Column::new(&["e'", "storage_modulus"], Dimension::Stress, "moduli");
    const FREQUENCY: Column = Column::new(&["f", "frequency"], Dimension::Frequency, "frequencies");

    /// The unit that a cell of a header gives of a column, where it names that.
    fn unit_in(column: Column, cell: &str) -> Option<Option<String>> {
        Some(column.named(&column::ways(cell))?.unit)
    }

    fn read(text: &str) -> Result<Vec<[f64; 2]>, String> {
        let file = DataFile::from_bytes("dma.txt", text.as_bytes());
        let table = file
            .and_then(|file| file.columns(&[FREQUENCY, MODULUS], Holes::Refused, "leave it out"));
        let table = table.map_err(|refused| refused.to_string())?;
        Ok(table.values.chunks(2).map(|row| [row[0], row[1]]).collect())
    }

    #[test]
    fn one_table_in_every_dialect_is_the_same() {
        for text in [
            "frequency_hz,storage_modulus_mpa\n0.5,1\n1e3,2.5\n",
            "Frequency [Hz];E' [MPa]\n0,5;1\n1e3;2,5\n",
            "Frequency / Hz\tStorage modulus / MPa\tRemark\n0.5\t1\tx\n1000\t2.5\t\n",
            "f (mHz) | T (C) | E' (kPa)\n500 | 20 | 1000\n1e6 | 20 | 2500\n",
            "# NREL\nf,E',T\nHz, MPa, C\n0.5,1,-\n1000,2.5,-\n",
            "  f      E'  \n  [Hz]   [MPa]\n  0.5    1\n  1000   2.5\n",
            "\"Frequency\",\"Storage modulus\"\n\"Hz\",\"MPa\"\n\"0.5\",\"1\"\n\"1000\",\"2.5\"\n",
        ] {
            let ends = ["\n", "\r\n", "\r"].map(|end| text.replace('\n', end));
            for text in ends {
                assert_eq!(
                    read(&text).unwrap(),
                    [[0.5, 1e6], [1000.0, 2.5e6]],
                    "{text}"
                );
            }
        }
    }

    #[test]
    fn a_name_with_its_unit_is_taken_apart() {
        for (cell, unit) in [
            ("storage_modulus_pa", Some(Some("Pa"))),
            ("Storage_Modulus_MPA", Some(Some("MPa"))),
            ("storage modulus (mPa)", Some(Some("mPa"))),
            ("Storage-Modulus[N/mm^2]", Some(Some("N/mm^2"))),
            ("E' / GPa", Some(Some("GPa"))),
            ("E’/GPa", Some(Some("GPa"))),
            ("Storage modulus, MPa", Some(Some("MPa"))),
            ("Storage modulus in kPa", Some(Some("kPa"))),
            ("Storage modulus E' (Pa)", Some(Some("Pa"))),
            ("E'/sin(delta)", None),
            ("E'", Some(None)),
            ("E''", None),
            ("storage_modulus_error", None),
            ("storage_modulus_s", None),
            ("modulus", None),
        ] {
            let found = unit_in(MODULUS, cell);
            let found = found.as_ref().map(Option::as_deref);
            assert_eq!(found, unit, "{cell}");
        }
        let compliance = Column::new(&["d"], Dimension::Compliance, "values");
        assert_eq!(compliance.name_in_si(), "d_per_pa");
        let unit = unit_in(compliance, "D_per_GPa");
        assert_eq!(unit.flatten().as_deref(), Some("1/GPa"));
        let rate = Column::new(&["w"], Dimension::AngularFrequency, "frequencies");
        assert_eq!(rate.name_in_si(), "w_rad_per_s");
        let unit = unit_in(rate, "w_rad_per_s");
        assert_eq!(unit.flatten().as_deref(), Some("rad/s"));
    }

    #[test]
    fn what_is_ambiguous_or_wrong_is_refused_at_its_place() {
        for (text, place, reason) in [
            (
                "f,E'\n1,2\n",
                "1:1",
                "the column of frequencies has no unit",
            ),
            ("f [Hz],E' [psi]\n1,2\n", "1:8", "1 psi is 6894.7573 Pa"),
            (
                "f,E'\nHz,s\n1,2\n",
                "2:4",
                "`s` is no unit of the column of moduli",
            ),
            (
                "f [Hz],E'\nkHz,MPa\n1,2\n",
                "2:1",
                "the header gives another unit",
            ),
            (
                "f_hz;E' [Pa]\n1,5;2.5\n",
                "2:1",
                "a decimal comma in a file with decimal points",
            ),
            (
                "f_hz;E' [Pa]\n1;2,500\n3;4\n",
                "2:3",
                "may separate decimals or thousands",
            ),
            (
                "f_hz,E' [Pa]\n1,2.5\n2,\"2,5\"\n",
                "3:4",
                "a decimal comma in a file with decimal points",
            ),
            ("f_hz;E' [Pa]\n1;1.23,4,5\n", "2:3", "not a number"),
            (
                "f_hz;E' [Pa]\n1;1.234,5\n2;2.5\n",
                "3:3",
                "not a number where thousands are grouped",
            ),
            (
                "f_hz,E' [Pa]\n1,2,5\n",
                "2:1",
                "a row of 3 cells in a table of 2 columns",
            ),
            (
                "w_hz,E' [Pa]\n1,2\n",
                "1:1",
                "2 columns, separated by commas",
            ),
        ] {
            let refused = read(text).unwrap_err();
            let words = refused.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains(&format!("dma.txt:{place}")), "{refused}");
            assert!(words.contains(reason), "{refused}");
        }
        // Between quotation marks a comma separates no cells.
        let quoted = read("f_hz,E' [Pa]\n1,\"2,5\"\n2,3\n").unwrap();
        assert_eq!(quoted, [[1.0, 2.5], [2.0, 3.0]]);
        // Where one comma separates no thousands, none does.
        assert_eq!(read("f_hz;E' [Pa]\n0,25;2,500\n").unwrap(), [[0.25, 2.5]]);
        // A number with both signs, or with one of them twice, tells which one groups thousands.
        let grouped = read("f_hz;E' [Pa]\n0,25;1.234,5\n1.000;2.500\n").unwrap();
        assert_eq!(grouped, [[0.25, 1234.5], [1000.0, 2500.0]]);
        let grouped = read("f_hz;E' [Pa]\n0.25;1,234,567\n").unwrap();
        assert_eq!(grouped, [[0.25, 1_234_567.0]]);
    }

    #[test]
    fn a_missing_number_has_one_fate_whatever_word_says_so() {
        for word in [
            "", "-", "--", "---", "n/a", "NA", "n.a.", "NaN", "#N/A", "none", "null",
        ] {
            let text = format!("f_hz,E' [Pa]\n1,2\n2,{word}\n3,4\n");
            let file = DataFile::from_bytes("dma.txt", text.as_bytes()).unwrap();
            let read = |holes| file.columns(&[FREQUENCY, MODULUS], holes, "leave it out");
            let refused = read(Holes::Refused).err().unwrap().to_string();
            assert!(refused.contains("dma.txt:3:3"), "{word}: {refused}");
            let table = read(Holes::PassedOver).unwrap();
            assert_eq!((table.column(0), table.passed_over()), (vec![1.0, 3.0], 1));
            assert_eq!((table.number_of(0), table.number_of(1)), (1, 3));
            let table = read(Holes::Kept).unwrap();
            assert_eq!((table.len(), table.number(1, 1)), (3, None), "{word}");
        }
    }

    #[test]
    fn a_column_may_be_optional_and_known_by_the_first_of_its_names() {
        let file = DataFile::from_bytes("dma.txt", b"E' [Pa],storage_modulus_pa,f_hz\n1,2,3\n");
        let file = file.unwrap();
        let read = |columns: &[Column]| file.columns(columns, Holes::Refused, "leave it out");
        let error = MODULUS.of_errors(Holds::Errors, "errors");
        let table = read(&[MODULUS.by_first_name(), error.optional()]).unwrap();
        assert_eq!((table.number(0, 0), table.has(1)), (Some(1.0), false));
        assert_eq!(error.name_in_si(), "e'_error_pa");
        assert!(error.is_named("Storage_Modulus_Error_MPa"));
        for columns in [[MODULUS, FREQUENCY], [FREQUENCY, error]] {
            assert!(read(&columns).is_err());
        }
    }

    /// The matrix of a text by the careful way.
    fn careful(text: &str) -> Option<(usize, Vec<f64>)> {
        let file = DataFile::from_bytes("a", text.as_bytes()).ok()?;
        let table = file.matrix("").ok()?;
        Some((table.width(), table.values))
    }

    #[test]
    fn plain_matrices_take_the_short_way_and_others_do_not() {
        for text in [
            "1 2\n3 4\n",
            "# m\n1;2\r\n\n 3 ; 4",
            "1,2\n3e0,4.\n",
            "1\t 2\n+3\t4",
        ] {
            let found = plain_matrix(text.as_bytes());
            assert_eq!(found, Some((2, vec![1.0, 2.0, 3.0, 4.0])), "{text}");
        }
        for text in [
            "1;2,5\n3;4",
            "1 2\n3",
            "1,2\n3,nan",
            "\"1\",2\n3,4",
            "1\r2",
            "x,y\n1,2",
        ] {
            assert_eq!(plain_matrix(text.as_bytes()), None, "{text}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn the_short_way_reads_what_the_careful_way_reads(
            pieces in prop::collection::vec(
                prop::sample::select(vec![
                    ",", ";", "\t", "|", " ", "\n", "\n", "\r\n", "1", "2.5", "1,234", "2e3", "-1", "NaN", "1.000", "#", "\u{feff}",
                ]),
                0..20,
            ),
        ) {
            let text = pieces.concat();
            if let Some(found) = plain_matrix(text.as_bytes()) {
                prop_assert_eq!(Some(found), careful(&text));
            }
        }

        #[test]
        fn any_text_is_read_or_refused_but_never_panics(
            pieces in prop::collection::vec(
                prop::sample::select(vec![
                    "f", "E'", "f_hz", "E' [MPa]", "[", "]", " / ", "Hz", "MPa", ",", ";", "\t", "|", " ", "\n", "\r\n", "\r",
                    "\"", "\"\"", "1", "2,5", "1,234", "2e3", "-1", "NaN", "1e999", "#", "µ", "\u{feff}", "\0", "f_hz;E' [Pa]\n1;2\n",
                ]),
                0..40,
            ),
        ) {
            let text = pieces.concat();
            if let Err(refused) = read(&text) {
                prop_assert!(refused.contains("dma.txt"), "{}", refused);
            }
            if let Ok(matrix) = DataFile::from_bytes("a", text.as_bytes()).and_then(|file| file.matrix("")) {
                prop_assert_eq!(matrix.values.len(), matrix.len() * matrix.width());
                prop_assert!(matrix.values.iter().all(|value| value.is_finite()));
            }
        }
    }
}
