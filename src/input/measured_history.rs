//! Tables of a measured history: times, and the approach under a prescribed load or the load under a prescribed approach.

use super::data_file::{Column, DataFile, Holds, Holes, TIME};
use super::diagnostic::{Diagnostic, Diagnostics, Problems};
use crate::drive::{Control, SegmentedDrive};
use crate::identify::data::{Reading, TableColumns};
use crate::quantity::{Dimension, format_human};

/// Rows of one table; more would take longer to read than to measure.
const MAX_ROWS: usize = 1_000_000;

/// By what part of its length a history may be over when its last row was taken: clocks are read to so many digits.
const AFTER: f64 = 1e-6;

/// Reads a table, whose rows are measured under this drive, from its first touch on.
///
/// # Errors
/// What [`DataFile`] refuses, times outside the drive or in no order, errors that are not above zero; each with its place.
pub(super) fn parse(
    name: &str,
    bytes: &[u8],
    drive: &SegmentedDrive,
) -> Result<(Vec<Reading>, TableColumns), Diagnostics> {
    let value = match drive.control() {
        Control::Load => Column::new(&["approach", "depth"], Dimension::Length, "approaches"),
        Control::Approach => Column::new(&["load", "force"], Dimension::Force, "loads"),
    };
    let error = value.of_errors(Holds::Errors, "errors");
    let file = DataFile::from_bytes(name, bytes)?;
    let wanted = [TIME, value, error.optional()];
    let without_number = "write a number, or leave the cell empty where nothing was measured";
    let table = file.columns(&wanted, Holes::PassedOver, without_number)?;
    if table.len() > MAX_ROWS {
        let message = format!("a measured history has at most {MAX_ROWS} rows");
        let diagnostic = Diagnostic::at(&table.row(MAX_ROWS), message);
        return Err(diagnostic.because("one more").help("thin it out").into());
    }
    let problems = Problems::new();
    let end_s = drive.duration_s();
    let (times, values) = (table.column(0), table.column(1));
    let errors = table.has(2).then(|| table.column(2));
    let mut readings = Vec::with_capacity(times.len());
    for (row, (time_s, value)) in times.iter().zip(values).enumerate() {
        if !(0.0..=end_s * (1.0 + AFTER)).contains(time_s) {
            let end = format_human(end_s, Dimension::Time, 6);
            problems
                .at(&table.cell(row, 0), "this time is not within the drive")
                .because(format!("the drive lasts from 0 s to {end}"))
                .help("times count from first touch; leave out the rows before and after, or complete the segments");
            break;
        }
        if row > 0 && *time_s <= times[row - 1] {
            problems
                .at(
                    &table.cell(row, 0),
                    "this time does not follow the one above",
                )
                .help("sort the rows by time, and keep one row per time");
            break;
        }
        let error = errors.as_ref().map(|errors| errors[row]);
        if error.is_some_and(|error| error <= 0.0) {
            problems
                .at(&table.cell(row, 2), "an error must be above zero")
                .help("write a standard deviation, or leave the column out: the noise is then estimated");
            break;
        }
        readings.push(Reading {
            row: table.number_of(row),
            time_s: time_s.min(end_s),
            value,
            error,
        });
    }
    let (read, unread) = file.headings(&wanted);
    let columns = TableColumns {
        read,
        unread,
        rows_passed_over: table.passed_over(),
        ..TableColumns::default()
    };
    problems.into_result(Some((readings, columns)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::Segment;

    fn readings(text: &str) -> Result<Vec<Reading>, Diagnostics> {
        let held = Segment::Step {
            to: 0.01,
            duration_s: 10.0,
        };
        let drive = SegmentedDrive::new(Control::Load, vec![held]).unwrap();
        Ok(parse("creep.csv", text.as_bytes(), &drive)?.0)
    }

    #[test]
    fn rows_without_a_number_are_passed_over_and_counted() {
        let held = Segment::Step {
            to: 0.01,
            duration_s: 10.0,
        };
        let drive = SegmentedDrive::new(Control::Load, vec![held]).unwrap();
        let text = "time_s,approach_m\n1,1e-9\n2,\nn/a,2e-9\n4,3e-9\n";
        let (found, columns) = parse("creep.csv", text.as_bytes(), &drive).unwrap();
        let times: Vec<f64> = found.iter().map(|reading| reading.time_s).collect();
        assert_eq!((times, columns.rows_passed_over), (vec![1.0, 4.0], 2));
        // Messages count the rows of the file.
        assert_eq!((found[0].row, found[1].row), (1, 4));
    }

    #[test]
    fn a_table_of_an_instrument_is_read_in_its_units() {
        let found =
            readings("Time [ms];Approach [nm];Approach Error [nm]\n500;100;1\n10000;120;1\n");
        let found = found.unwrap();
        assert_eq!((found[0].row, found[0].time_s), (1, 0.5));
        assert!((found[1].value / 120e-9 - 1.0).abs() < 1e-12);
        assert!((found[1].error.unwrap() / 1e-9 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn rows_that_are_none_of_the_history_are_refused_at_their_place() {
        for (text, place, reason) in [
            (
                "time_s,approach_m\n1,1e-6\n11,1e-6\n",
                "creep.csv:3:1",
                "not within the drive",
            ),
            (
                "time_s,approach_m\n-1,1e-6\n",
                "creep.csv:2:1",
                "not within the drive",
            ),
            (
                "time_s,approach_m\n1,1e-6\n1,1e-6\n",
                "creep.csv:3:1",
                "does not follow",
            ),
            (
                "time_s,load_n\n1,1\n",
                "creep.csv:1:1",
                "no column `approach_m`",
            ),
            (
                "time_s,approach_m,approach_error_m\n1,1e-6,0\n",
                "creep.csv:2:8",
                "above zero",
            ),
        ] {
            let refused = readings(text).unwrap_err().to_string();
            assert!(
                refused.contains(place) && refused.contains(reason),
                "{refused}"
            );
        }
    }
}
