//! Tables that the program has written, read back: by the rows of their columns, so that names and units stand once.

use csv::{ErrorKind, StringRecord};

use super::quantities::{Column, Place, PlaceIn};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Source};

/// Bytes of a file that is read back, at most.
pub(super) const MAX_BYTES: usize = 1_000_000_000;

/// The rows of a table of these columns, at most so many; `row` is one without values. Messages call the table `name`.
///
/// # Errors
/// A column or a value that is missing, a cell that is not what its column holds, another number of cells than columns, too many
/// rows, bytes that are no text; with file and line.
pub fn rows<R: Clone>(
    (name, bytes): (&str, &[u8]),
    columns: &[Column<R>],
    row: &R,
    most: usize,
) -> Result<Vec<R>, Diagnostics> {
    let text = std::str::from_utf8(bytes).map_err(|_| {
        Diagnostic::at(
            &Location::whole(&Source::file(name, "")),
            "this table is not text",
        )
        .help(AGAIN)
    })?;
    // The place of a row that begins at this byte.
    let refuse = |start: usize, message: String| {
        let line = text.get(start..).unwrap_or("").lines().next().unwrap_or("");
        let place = Location::new(&Source::file(name, text), start..start + line.len());
        Diagnostics::from(Diagnostic::at(&place, message).help(AGAIN))
    };
    let mut reader = csv::Reader::from_reader(bytes);
    let head = reader
        .headers()
        .map_err(|error| refuse(0, error.to_string()))?;
    let mut places: Vec<(usize, String, PlaceIn<R>)> = Vec::new();
    for of in columns {
        for (column, place) in of.places() {
            match head.iter().position(|cell| cell == column) {
                Some(cell) => places.push((cell, column, place)),
                None if of.is_new => {}
                None => return Err(refuse(0, format!("no column `{column}`"))),
            }
        }
    }
    let (mut rows, mut record) = (Vec::new(), StringRecord::new());
    loop {
        let start = reader.position().byte() as usize;
        match reader.read_record(&mut record) {
            Ok(false) => return Ok(rows),
            Ok(true) if rows.len() == most => {
                return Err(refuse(start, format!("more than {most} rows")));
            }
            Ok(true) => {}
            Err(error) => return Err(refuse(start, of_row(&error))),
        }
        let mut next = row.clone();
        for (cell, column, place) in &places {
            let cell = record.get(*cell).unwrap_or("");
            let why = |why| refuse(start, format!("`{cell}` in the column `{column}` is {why}"));
            fill(place(&mut next), cell).map_err(why)?;
        }
        rows.push(next);
    }
}

/// What to do about a table that is not as it was written.
const AGAIN: &str =
    "the table is not as the program has written it: run the command again that made the folder";

/// What is wrong with a row.
fn of_row(error: &csv::Error) -> String {
    match error.kind() {
        ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => {
            format!("{len} cells in a row, for {expected_len} columns")
        }
        _ => error.to_string(),
    }
}

/// Puts what a cell holds into its place; otherwise what it is not.
fn fill(place: Place<'_>, cell: &str) -> Result<(), &'static str> {
    let number = || {
        let number = cell.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or("no finite number")
    };
    let count = || cell.parse().map_err(|_| "no whole number");
    match place {
        Place::Number(value) => *value = number()?,
        Place::Optional(value) if cell.is_empty() => *value = None,
        Place::Optional(value) => *value = Some(number()?),
        Place::Count(value) => *value = count()?,
        Place::OptionalCount(value) if cell.is_empty() => *value = None,
        Place::OptionalCount(value) => *value = Some(count()?),
        Place::Text(value) => cell.clone_into(value),
    }
    Ok(())
}
