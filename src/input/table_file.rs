//! Tables of measured creep compliance or relaxation modulus: CSV files read, every mistake shown at its place.
//!
//! The first line names the columns; those not asked for are passed over, and so are empty lines and lines that begin with
//! `#`. Times come in `time_s` (or `time`, `time_min`, `time_h`); values in `creep_compliance_per_pa` (or `_per_kpa`,
//! `_per_mpa`, `_per_gpa`) or `relaxation_modulus_pa` (or `_kpa`, `_mpa`, `_gpa`).

use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::diagnostic::{Diagnostic, Diagnostics, Location, Problems, Source};
use super::document::{cannot_read, not_utf8};
use super::separator;
use crate::material::tabulated::{TableColumn, TableError, Tabulated};
use crate::material::{MaterialFunction, ModulusKind};

/// Largest file read, bytes: a million rows and more.
const MAX_BYTES: usize = 100_000_000;

/// Names of a column, each with what its numbers are multiplied by to be in SI units.
type Names = [(&'static str, f64); 4];

const TIME: Names = [
    ("time_s", 1.0),
    ("time", 1.0),
    ("time_min", 60.0),
    ("time_h", 3600.0),
];
const CREEP: Names = [
    ("creep_compliance_per_pa", 1.0),
    ("creep_compliance_per_kpa", 1e-3),
    ("creep_compliance_per_mpa", 1e-6),
    ("creep_compliance_per_gpa", 1e-9),
];
const RELAXATION: Names = [
    ("relaxation_modulus_pa", 1.0),
    ("relaxation_modulus_kpa", 1e3),
    ("relaxation_modulus_mpa", 1e6),
    ("relaxation_modulus_gpa", 1e9),
];

/// The words by which files and flags call the two quantities.
pub(crate) const QUANTITIES: [(&str, MaterialFunction); 2] = [
    ("creep", MaterialFunction::Creep),
    ("relaxation", MaterialFunction::Relaxation),
];

fn value_names(face: MaterialFunction) -> Names {
    match face {
        MaterialFunction::Creep => CREEP,
        MaterialFunction::Relaxation => RELAXATION,
    }
}

fn other(face: MaterialFunction) -> (&'static str, MaterialFunction) {
    match face {
        MaterialFunction::Creep => QUANTITIES[1],
        MaterialFunction::Relaxation => QUANTITIES[0],
    }
}

/// Reads a table from a file.
///
/// # Errors
/// The file cannot be opened, or [`parse`] refuses it.
pub(crate) fn read(
    path: &Path,
    face: MaterialFunction,
    kind: ModulusKind,
) -> Result<Tabulated, Diagnostics> {
    let name = path.display().to_string();
    let bytes = load(path).map_err(|error| cannot_read(&name, &error))?;
    parse(&name, &bytes, face, kind)
}

/// The bytes of a file, at most one more than is allowed, so that an endless file ends.
///
/// # Errors
/// What opening or reading it returns.
pub(crate) fn load(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let limit = MAX_BYTES as u64 + 1;
    File::open(path)?.take(limit).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a table from the bytes of a file that messages call `name`.
///
/// # Errors
/// A file that is too large, not UTF-8, empty, or without the columns; a row with more or fewer cells than the header; a
/// cell that is no number; and what [`Tabulated::new`] refuses. Each with its place, all rows at once.
pub(crate) fn parse(
    name: &str,
    bytes: &[u8],
    face: MaterialFunction,
    kind: ModulusKind,
) -> Result<Tabulated, Diagnostics> {
    if bytes.len() > MAX_BYTES {
        let megabytes = MAX_BYTES / 1_000_000;
        return Err(
            Diagnostic::new(format!("`{name}` is larger than {megabytes} MB"))
                .help("keep a few hundred rows per decade of time")
                .into(),
        );
    }
    let text =
        std::str::from_utf8(bytes).map_err(|error| not_utf8(name, bytes, error.valid_up_to()))?;
    let source = Source::file(name, text.trim_start_matches('\u{feff}'));
    let mut rows = Rows::new(&source);
    let Some(header) = rows.next().transpose()? else {
        let example = format!("{},{}", TIME[0].0, value_names(face)[0].0);
        return Err(
            Diagnostic::at(&Location::whole(&source), "the table is empty")
                .help(format!("begin it with a line of column names: `{example}`"))
                .into(),
        );
    };
    let time = column(&source, &header, &TIME, "times", None)?;
    let value = column(&source, &header, &value_names(face), "values", Some(face))?;
    let samples = samples(rows, &header, [time, value])?;
    let [times, values] = [0, 1].map(|which| samples.iter().map(|s| s[which].0).collect());
    Tabulated::new(face, kind, times, values).map_err(|error| {
        let place = error.place().and_then(|(row, column)| {
            let which = usize::from(column == TableColumn::Value);
            samples.get(row - 1).map(|sample| sample[which].1.clone())
        });
        explain(&source, place, &error, face).into()
    })
}

/// A column that was found: its place in a row, and its factor to SI units.
#[derive(Clone, Copy)]
struct Column {
    place: usize,
    to_si: f64,
}

/// Finds a column under one of its names.
fn column(
    source: &Arc<Source>,
    header: &Row,
    names: &Names,
    what: &str,
    face: Option<MaterialFunction>,
) -> Result<Column, Diagnostic> {
    let find = |names: &Names| -> Vec<(usize, f64)> {
        let cells = header.cells.iter().enumerate();
        cells
            .filter_map(|(place, cell)| {
                let name = cell.text.to_ascii_lowercase();
                let known = names.iter().find(|(known, _)| *known == name)?;
                Some((place, known.1))
            })
            .collect()
    };
    match find(names).as_slice() {
        [(place, to_si)] => Ok(Column {
            place: *place,
            to_si: *to_si,
        }),
        [(first, _), (second, _), ..] => Err(Diagnostic::at(
            &Location::new(source, header.cells[*second].span.clone()),
            format!("the table has two columns of {what}"),
        )
        .label(
            &Location::new(source, header.cells[*first].span.clone()),
            "the other one",
        )
        .help("keep one of them")),
        [] => {
            let known: Vec<String> = names.iter().map(|(name, _)| format!("`{name}`")).collect();
            let line = Location::new(source, header.span.clone());
            let is_wanted = |name: &str| {
                let name = name.to_ascii_lowercase();
                names.iter().any(|(known, _)| *known == name)
            };
            let separated = separator::other_than_comma(line.text(), is_wanted);
            let missing = Diagnostic::at(&line, format!("no column `{}`", names[0].0));
            let (word, other) = other(face.unwrap_or(MaterialFunction::Creep));
            Err(if face.is_some() && !find(&value_names(other)).is_empty() {
                missing.help(format!("this table wants the quantity \"{word}\""))
            } else if header.cells.iter().any(|c| c.text.parse::<f64>().is_ok()) {
                missing
                    .because("numbers")
                    .help("begin the table with a line of column names")
            } else if let Some((found, mended)) = separated {
                missing
                    .because(format!("separated by {found}"))
                    .help(separator::help(&mended))
            } else {
                missing.help(format!("name the column of {what} {}", known.join(" or ")))
            })
        }
    }
}

/// A number in SI units, and where it stands.
type Cell = (f64, Range<usize>);

/// Time and value of every row.
fn samples(
    rows: Rows<'_>,
    header: &Row,
    columns: [Column; 2],
) -> Result<Vec<[Cell; 2]>, Diagnostics> {
    let problems = Problems::new();
    let source = rows.source;
    let mut samples = Vec::new();
    for row in rows {
        let row = row?;
        let (found, expected) = (row.cells.len(), header.cells.len());
        if found != expected {
            problems
                .at(
                    &Location::new(source, row.span.clone()),
                    format!("a row of {found} cells in a table of {expected} columns"),
                )
                .help("give every row one cell per column; numbers have a decimal point, no comma");
            continue;
        }
        let [time, value] = columns.map(|column| {
            let cell = row.cells.get(column.place)?;
            let name = header.cells.get(column.place).map_or("", |c| &c.text);
            let number = number(source, &problems, cell, name)?;
            Some((number * column.to_si, cell.span.clone()))
        });
        if let (Some(time), Some(value)) = (time, value) {
            samples.push([time, value]);
        }
    }
    problems.into_result(Some(samples))
}

fn number(source: &Arc<Source>, problems: &Problems, cell: &Text, column: &str) -> Option<f64> {
    let why = match cell.text.parse::<f64>() {
        Ok(number) if number.is_finite() => return Some(number),
        Ok(_) => "not a finite number",
        Err(_) if cell.text.is_empty() => "empty",
        Err(_) => "not a number",
    };
    problems
        .at(
            &Location::new(source, cell.span.clone()),
            format!("a cell of the column `{column}` must be a number"),
        )
        .because(why)
        .help("write it as `1.5e-9`, or leave the whole row out");
    None
}

/// What the material room refuses, at its place in the file.
fn explain(
    source: &Arc<Source>,
    place: Option<Range<usize>>,
    error: &TableError,
    face: MaterialFunction,
) -> Diagnostic {
    let location = place.map_or(Location::whole(source), |span| Location::new(source, span));
    let diagnostic = Diagnostic::at(&location, error.to_string());
    match error {
        TableError::Reversal { .. } | TableError::Trend { .. } => {
            let (word, _) = other(face);
            diagnostic.help(format!(
                "check units and columns; if the values are of the other quantity, say \"{word}\""
            ))
        }
        TableError::TimeOrder { .. } => {
            diagnostic.help("sort the rows by time, and keep one row per time")
        }
        _ => diagnostic,
    }
}

/// A piece of the file.
struct Text {
    text: String,
    span: Range<usize>,
}

/// A line of the table, cut into cells.
struct Row {
    cells: Vec<Text>,
    span: Range<usize>,
}

/// Reads row by row.
struct Rows<'a> {
    source: &'a Arc<Source>,
    reader: csv::Reader<&'a [u8]>,
}

impl<'a> Rows<'a> {
    fn new(source: &'a Arc<Source>) -> Self {
        let reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(source.text().as_bytes());
        Self { source, reader }
    }

    /// The cells with their places. In a line with quotes, the whole line stands for each of them.
    fn row(&self, record: &csv::StringRecord) -> Row {
        let from = record.position().map_or(0, |position| position.byte());
        let span = line_at(self.source.text(), usize::try_from(from).unwrap_or(0));
        let line = &self.source.text()[span.clone()];
        let mut start = span.start;
        let mut places = line.split(',').map(|cell| {
            let begin = start + (cell.len() - cell.trim_start().len());
            start += cell.len() + 1;
            begin..begin + cell.trim().len()
        });
        let quoted = line.contains('"');
        let cells = record.iter().map(|text| Text {
            text: text.to_owned(),
            span: places
                .next()
                .filter(|_| !quoted)
                .unwrap_or_else(|| span.clone()),
        });
        Row {
            cells: cells.collect(),
            span: span.clone(),
        }
    }
}

impl Iterator for Rows<'_> {
    type Item = Result<Row, Diagnostic>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let mut record = csv::StringRecord::new();
            match self.reader.read_record(&mut record) {
                Ok(false) => return None,
                // A line of blanks.
                Ok(true) if record.iter().all(str::is_empty) && record.len() == 1 => {}
                Ok(true) => return Some(Ok(self.row(&record))),
                Err(error) => {
                    let message = format!("cannot read `{}`: {error}", self.source.name());
                    return Some(Err(Diagnostic::new(message)));
                }
            }
        }
    }
}

/// The first line from a byte on that is neither empty nor a comment, without its end: where the reader's record stands.
fn line_at(text: &str, from: usize) -> Range<usize> {
    let mut start = from;
    for line in text.get(from..).unwrap_or("").split_inclusive('\n') {
        let content = line.trim_end_matches(['\n', '\r']);
        if !content.is_empty() && !content.starts_with('#') {
            return start..start + content.len();
        }
        start += line.len();
    }
    from.min(text.len())..text.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::diagnostic::Styling;
    use proptest::prelude::*;

    fn read_creep(bytes: &[u8]) -> Result<Tabulated, Diagnostics> {
        parse(
            "data.csv",
            bytes,
            MaterialFunction::Creep,
            ModulusKind::Longitudinal,
        )
    }

    fn refusal(text: &str) -> String {
        read_creep(text.as_bytes())
            .unwrap_err()
            .render(Styling::Plain)
    }

    const GOOD: &str =
        "time_s,creep_compliance_per_pa\n0,4e-10\n1,4.1e-10\n10,4.2e-10\n100,4.3e-10\n";

    #[test]
    fn a_table_is_read_whatever_else_is_in_it() {
        let table = read_creep(GOOD.as_bytes()).unwrap();
        assert_eq!(table.times_s(), [0.0, 1.0, 10.0, 100.0]);
        assert_eq!(table.values(), [4e-10, 4.1e-10, 4.2e-10, 4.3e-10]);
        let other = "\u{feff}# PMMA, 23 C\r\n\r\nSample , Time , creep_compliance_per_GPa, note\r\n\
                     a, 0, 0.4,\"x, y\"\r\n# a comment\r\n  \r\na, 1, 0.41,\r\na, 10, 0.42,\r\na,100,0.43,\r\n";
        let other = read_creep(other.as_bytes()).unwrap();
        assert_eq!(other.times_s(), table.times_s());
        for (a, b) in other.values().iter().zip(table.values()) {
            // One product.
            assert!((a / b - 1.0).abs() < 1e-15);
        }
        let hours = GOOD.replace("time_s", "time_h");
        let hours = read_creep(hours.as_bytes()).unwrap();
        assert_eq!(hours.times_s(), [0.0, 3600.0, 36_000.0, 360_000.0]);
    }

    #[test]
    fn a_missing_column_is_named_with_what_would_do() {
        insta::assert_snapshot!(refusal(&GOOD.replace("time_s", "t")), @r"
        error: no column `time_s`
         --> data.csv:1:1
          |
        1 | t,creep_compliance_per_pa
          | ^^^^^^^^^^^^^^^^^^^^^^^^^
          |
          = help: name the column of times `time_s` or `time` or `time_min` or
                  `time_h`
        ");
        insta::assert_snapshot!(refusal(&GOOD.replace("creep_compliance_per", "relaxation_modulus")), @r#"
        error: no column `creep_compliance_per_pa`
         --> data.csv:1:1
          |
        1 | time_s,relaxation_modulus_pa
          | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^
          |
          = help: this table wants the quantity "relaxation"
        "#);
        insta::assert_snapshot!(refusal("0,4e-10\n1,4e-10\n"), @r"
        error: no column `time_s`
         --> data.csv:1:1
          |
        1 | 0,4e-10
          | ^^^^^^^ numbers
          |
          = help: begin the table with a line of column names
        ");
        insta::assert_snapshot!(refusal("time_s;creep_compliance_per_pa\n0;4e-10\n"), @r"
        error: no column `time_s`
         --> data.csv:1:1
          |
        1 | time_s;creep_compliance_per_pa
          | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ separated by semicolons
          |
          = help: separate columns by commas, as in `time_s,creep_compliance_per_pa`,
                  and write a decimal point
        ");
        insta::assert_snapshot!(refusal("time_s creep_compliance_per_pa\n0 4e-10\n"), @r"
        error: no column `time_s`
         --> data.csv:1:1
          |
        1 | time_s creep_compliance_per_pa
          | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ separated by spaces
          |
          = help: separate columns by commas, as in `time_s,creep_compliance_per_pa`,
                  and write a decimal point
        ");
        insta::assert_snapshot!(refusal("time,time_s,creep_compliance_per_pa\n"), @r"
        error: the table has two columns of times
         --> data.csv:1:6
          |
        1 | time,time_s,creep_compliance_per_pa
          | ---- ^^^^^^
          | |
          | the other one
          |
          = help: keep one of them
        ");
    }

    #[test]
    fn every_bad_cell_and_ragged_row_is_shown_at_its_place() {
        let text = "# measured\ntime_s,creep_compliance_per_pa\n0,4e-10\n1, NaN\n\n2,4,1e-10\nten,4.2e-10\n100,\n1000,-inf\n";
        insta::assert_snapshot!(refusal(text), @r"
        error: a cell of the column `creep_compliance_per_pa` must be a number
         --> data.csv:4:4
          |
        4 | 1, NaN
          |    ^^^ not a finite number
          |
          = help: write it as `1.5e-9`, or leave the whole row out

        error: a row of 3 cells in a table of 2 columns
         --> data.csv:6:1
          |
        6 | 2,4,1e-10
          | ^^^^^^^^^
          |
          = help: give every row one cell per column; numbers have a decimal point, no
                  comma

        error: a cell of the column `time_s` must be a number
         --> data.csv:7:1
          |
        7 | ten,4.2e-10
          | ^^^ not a number
          |
          = help: write it as `1.5e-9`, or leave the whole row out

        error: a cell of the column `creep_compliance_per_pa` must be a number
         --> data.csv:8:5
          |
        8 | 100,
          |     ^ empty
          |
          = help: write it as `1.5e-9`, or leave the whole row out

        error: a cell of the column `creep_compliance_per_pa` must be a number
         --> data.csv:9:6
          |
        9 | 1000,-inf
          |      ^^^^ not a finite number
          |
          = help: write it as `1.5e-9`, or leave the whole row out
        ");
    }

    #[test]
    fn impossible_data_are_shown_at_their_place() {
        insta::assert_snapshot!(refusal(&GOOD.replace("10,4.2", "0.5,4.2")), @r"
        error: the time of row 3, 0.5 s, does not come after that of the row before, 1 s: times must increase
         --> data.csv:4:1
          |
        4 | 0.5,4.2e-10
          | ^^^
          |
          = help: sort the rows by time, and keep one row per time
        ");
        insta::assert_snapshot!(refusal(&GOOD.replace("4.2e-10", "-4.2e-10")), @r"
        error: the creep compliance of row 3 is -4.2e-10: it must be finite and greater than zero
         --> data.csv:4:4
          |
        4 | 10,-4.2e-10
          |    ^^^^^^^^
        ");
        insta::assert_snapshot!(refusal(&GOOD.replace("4.3e-10", "2.3e-10")), @r#"
        error: the creep compliance falls by 45.2 % from row 3 to row 4, which no passive material does; up to 10 % is taken for noise
         --> data.csv:5:5
          |
        5 | 100,2.3e-10
          |     ^^^^^^^
          |
          = help: check units and columns; if the values are of the other quantity,
                  say "relaxation"
        "#);
    }

    #[test]
    fn an_empty_file_one_of_one_row_and_one_that_is_no_text_are_refused() {
        for empty in ["", "\n\n", "# only a comment\n"] {
            assert!(refusal(empty).contains("the table is empty"), "{empty:?}");
        }
        insta::assert_snapshot!(refusal("time_s,creep_compliance_per_pa\n1,4e-10\n"), @r"
        error: the table has too few samples, 1; it takes at least 4
        --> data.csv
        ");
        insta::assert_snapshot!(refusal("time_s,creep_compliance_per_pa\n"), @r"
        error: the table has no samples; it takes at least 4
        --> data.csv
        ");
        let latin = read_creep(b"time_s,creep_compliance_per_pa,\xb5\n").unwrap_err();
        assert!(latin.render(Styling::Plain).contains("not UTF-8"));
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused_but_never_panics(
            pieces in prop::collection::vec(
                prop::sample::select(vec![
                    "time_s", "creep_compliance_per_pa", ",", "\n", "\r\n", "\"", "1", "2e3", "-1", "NaN", " ", "#", ";",
                    "µ", "0,1\n", "1,2\n", "2,3\n", "3,4\n", "time_s,creep_compliance_per_pa\n",
                ]),
                0..40,
            ),
        ) {
            if let Err(refused) = read_creep(pieces.concat().as_bytes()) {
                prop_assert!(refused.render(Styling::Plain).contains("data.csv"));
            }
        }
    }
}
