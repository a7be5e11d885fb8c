//! Drive tables: a CSV file with a column of times and one of loads or approaches, among others if need be.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::separator;

/// Points of one table; more would take longer to follow than to measure.
const MAX_POINTS: usize = 200_000;
/// Largest file read, bytes.
const MAX_BYTES: u64 = 100_000_000;

/// The two columns, as long as one another.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct TableColumns {
    pub(super) times_s: Vec<f64>,
    pub(super) values: Vec<f64>,
}

/// The column of times.
pub(super) const TIME_COLUMN: &str = "time_s";

/// Reads the columns [`TIME_COLUMN`] and `value_column`. Lines that open with `#` are comments.
///
/// # Errors
/// What is wrong, and in which line.
pub(super) fn read(path: &Path, value_column: &str) -> Result<TableColumns, String> {
    let name = path.display();
    let file = File::open(path).map_err(|error| format!("cannot read `{name}`: {error}"))?;
    let mut bytes = Vec::new();
    file.take(MAX_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| format!("cannot read `{name}`: {error}"))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(format!(
            "`{name}` is larger than {} MB",
            MAX_BYTES / 1_000_000
        ));
    }
    parse(&bytes, value_column).map_err(|reason| format!("`{name}`, {reason}"))
}

fn parse(bytes: &[u8], value_column: &str) -> Result<TableColumns, String> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(bytes);
    let header = reader.headers().map_err(plain)?.clone();
    let find = |wanted: &str| {
        let place = header
            .iter()
            .position(|name| name.trim_start_matches('\u{feff}') == wanted);
        place.ok_or_else(|| {
            let found: Vec<&str> = header.iter().collect();
            let line = found.join(",");
            let line = line.trim_start_matches('\u{feff}');
            if let Some((by, mended)) = separator::other_than_comma(line, |name| name == wanted) {
                return format!("line 1: the columns are separated by {by}; {}", separator::help(&mended));
            }
            format!(
                "line 1: no column `{wanted}` among `{}`; the columns {TIME_COLUMN} and {value_column} are needed",
                found.join("`, `")
            )
        })
    };
    let (time, value) = (find(TIME_COLUMN)?, find(value_column)?);
    let mut columns = TableColumns::default();
    for record in reader.records() {
        let record = record.map_err(plain)?;
        let line = record.position().map_or(0, csv::Position::line);
        let time_s = number(&record, line, TIME_COLUMN, time)?;
        if let Some(before_s) = columns.times_s.last().filter(|before| time_s < **before) {
            return Err(format!(
                "line {line}: the time {time_s} s lies before {before_s} s of the line above; times must ascend (two equal ones \
                 are a jump)"
            ));
        }
        columns.times_s.push(time_s);
        columns
            .values
            .push(number(&record, line, value_column, value)?);
        if columns.times_s.len() > MAX_POINTS {
            return Err(format!(
                "line {line}: a table has at most {MAX_POINTS} points; thin it out"
            ));
        }
    }
    Ok(columns)
}

fn number(
    record: &csv::StringRecord,
    line: u64,
    column: &str,
    place: usize,
) -> Result<f64, String> {
    let text = record.get(place).unwrap_or("");
    if text.is_empty() {
        return Err(format!(
            "line {line}: the column {column} is empty; leave out what has no value, or replace it"
        ));
    }
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!(
            "line {line}: `{text}` in the column {column} is not a finite number"
        )),
    }
}

/// A message of the CSV reader without its repetitions of where it comes from.
fn plain(error: csv::Error) -> String {
    let line = error.position().map_or(0, csv::Position::line);
    match error.kind() {
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => format!("line {line}: {len} cells, where the header has {expected_len}"),
        csv::ErrorKind::Utf8 { .. } => format!("line {line}: not UTF-8 text"),
        _ => format!("line {line}: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_columns_are_found_among_others_in_any_order() {
        let text = "# measured\nload_n, note, time_s\n1.5,a,0\n# a pause\n2e0, b ,0.5\n";
        let columns = parse(text.as_bytes(), "load_n").unwrap();
        assert_eq!(columns.times_s, [0.0, 0.5]);
        assert_eq!(columns.values, [1.5, 2.0]);
        // As spreadsheets write it: a byte order mark and Windows line ends.
        let text = "\u{feff}time_s,load_n\r\n0,1\r\n1,2\r\n";
        assert_eq!(parse(text.as_bytes(), "load_n").unwrap().values, [1.0, 2.0]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let refusal = |text: &str| parse(text.as_bytes(), "load_n").unwrap_err();
        let cases = [
            ("time,load_n\n0,1\n", "line 1: no column `time_s`"),
            ("time_s,approach_m\n0,1\n", "line 1: no column `load_n`"),
            (
                "time_s;load_n\n0;1,5\n",
                "line 1: the columns are separated by semicolons; separate columns by commas, as in `time_s,load_n`",
            ),
            (
                "time_s load_n\n0 1\n",
                "line 1: the columns are separated by spaces",
            ),
            ("time_s,load_n\n0,1\n1\n", "line 3: 1 cells"),
            (
                "time_s,load_n\n0,1\n1,two\n",
                "line 3: `two` in the column load_n",
            ),
            (
                "time_s,load_n\n0,1\n1,\n",
                "line 3: the column load_n is empty",
            ),
            ("time_s,load_n\n0,inf\n", "line 2: `inf`"),
            (
                "time_s,load_n\n1,1\n0,1\n",
                "line 3: the time 0 s lies before 1 s",
            ),
        ];
        for (text, expected) in cases {
            let found = refusal(text);
            assert!(found.contains(expected), "{found}");
        }
        assert!(parse(b"time_s,load_n\n0,\xff\n", "load_n").is_err());
        assert!(parse(b"", "load_n").is_err());
    }
}
