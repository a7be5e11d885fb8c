//! Drive tables: a [`DataFile`] with a column of times and one of loads or approaches, among others if need be.

use super::data_file::{Column, DataFile, Holes, TIME};
use super::diagnostic::{Diagnostic, Diagnostics};
use crate::drive::Control;
use crate::quantity::Dimension;

/// Points of one table; more would take longer to follow than to measure.
const MAX_POINTS: usize = 200_000;

/// Times (s), which do not descend, and loads (N) or approaches (m).
///
/// # Errors
/// What [`DataFile`] refuses, times that descend, more than [`MAX_POINTS`] rows; each with its place.
pub(super) fn parse(
    name: &str,
    bytes: &[u8],
    control: Control,
) -> Result<(Vec<f64>, Vec<f64>), Diagnostics> {
    let value = match control {
        Control::Load => Column::new(&["load"], Dimension::Force, "loads"),
        Control::Approach => Column::new(&["approach"], Dimension::Length, "approaches"),
    };
    let without_number = "leave out the row where there is no value, or replace it";
    let table = DataFile::from_bytes(name, bytes)?.columns(
        &[TIME, value],
        Holes::Refused,
        without_number,
    )?;
    if table.len() > MAX_POINTS {
        let message = format!("a table of a drive has at most {MAX_POINTS} points");
        let diagnostic = Diagnostic::at(&table.row(MAX_POINTS), message);
        return Err(diagnostic.because("one more").help("thin it out").into());
    }
    let (times_s, values) = (table.column(0), table.column(1));
    if let Some(row) = (1..times_s.len()).find(|row| times_s[*row] < times_s[row - 1]) {
        let message = format!(
            "the time {} s lies before {} s of the line above",
            times_s[row],
            times_s[row - 1]
        );
        return Err(Diagnostic::at(&table.cell(row, 0), message)
            .help("times must ascend; two equal ones are a jump")
            .into());
    }
    Ok((times_s, values))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(text: &str) -> Result<(Vec<f64>, Vec<f64>), Diagnostics> {
        parse("load.csv", text.as_bytes(), Control::Load)
    }

    #[test]
    fn what_prescribes_has_no_holes() {
        for hole in ["", "-", "NaN", "#N/A"] {
            let refused = load(&format!("time_s,load_n\n0,1\n1,{hole}\n2,3\n"));
            let refused = refused.unwrap_err().to_string();
            assert!(refused.contains("load.csv:3:"), "{refused}");
            assert!(
                refused.contains("leave out the row where there is no value"),
                "{refused}"
            );
        }
    }

    #[test]
    fn two_columns_are_found_among_others_in_any_order() {
        let expected = (vec![0.0, 0.5], vec![1.5, 2.0]);
        for text in [
            "# measured\nload_n, note, time_s\n1.5,a,0\n# a pause\n2e0, b ,0.5\n",
            // As spreadsheets write it: a byte order mark and Windows line ends.
            "\u{feff}time_s,load_n\r\n0,1.5\r\n0.5,2\r\n",
            "time_s;load_n\n0;1,5\n0,5;2\n",
            "time_s load_n\n0 1.5\n0.5 2\n",
            "Time [ms]\tLoad (mN)\n0\t1500\n500\t2000\n",
            "time,load\nms,mN\n0,1500\n500,2000\n",
        ] {
            assert_eq!(load(text).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn a_table_that_cannot_be_followed_is_refused_at_its_place() {
        for (text, place, reason) in [
            ("t,load_n\n0,1\n", "load.csv:1:1", "no column `time_s`"),
            (
                "time_s,approach_m\n0,1\n",
                "load.csv:1:1",
                "no column `load_n`",
            ),
            (
                "time_s,load_n\n0,1\n1\n",
                "load.csv:3:1",
                "a row of 1 cell in",
            ),
            (
                "time_s,load_n\n0,1\n1,two\n",
                "load.csv:3:3",
                "not a number",
            ),
            ("time_s,load_n\n0,1\n1,\n", "load.csv:3:3", "empty"),
            (
                "time_s,load_n\n0,inf\n",
                "load.csv:2:3",
                "not a finite number",
            ),
            (
                "time_s,load_n\n1,1\n0,1\n",
                "load.csv:3:1",
                "the time 0 s lies before 1 s",
            ),
            ("", "load.csv", "the table is empty"),
        ] {
            let refused = load(text).unwrap_err().to_string();
            assert!(
                refused.contains(place) && refused.contains(reason),
                "{refused}"
            );
        }
        assert!(parse("load.csv", b"time_s,load_n\n0,\xff\n", Control::Load).is_err());
    }
}
