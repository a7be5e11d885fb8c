//! Tables of measured creep compliance or relaxation modulus: a [`DataFile`] with the columns `time_s` and
//! `creep_compliance_per_pa` or `relaxation_modulus_pa`, or the same in other units and by their symbols: `t`, `J(t)`, `D`, `E(t)`, `G`.
//! Times without a unit are in seconds. Rows in which a number is missing are passed over.

use std::path::Path;

use super::data_file::{Column, DataFile, Holes, MAX_BYTES, TIME, contents};
use super::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::material::tabulated::{TableColumn, TableError, Tabulated};
use crate::material::{MaterialFunction, ModulusKind};
use crate::quantity::Dimension;

/// The column of times.
const TIMES: Column = Column {
    names: &["time", "test_time", "elapsed_time", "zeit", "t"],
    ..TIME.by_first_name()
};

/// The column of a quantity: `E` is no shear modulus, and `G` is nothing else.
fn values_of(function: MaterialFunction, kind: ModulusKind) -> Column {
    let (names, dimension): (&[&str], _) = match (function, kind) {
        (MaterialFunction::Creep, _) => (
            &[
                "creep_compliance",
                "kriechnachgiebigkeit",
                "j(t)",
                "d(t)",
                "j",
                "d",
            ],
            Dimension::Compliance,
        ),
        (MaterialFunction::Relaxation, ModulusKind::Longitudinal) => (
            &["relaxation_modulus", "relaxationsmodul", "e(t)", "e"],
            Dimension::Stress,
        ),
        (MaterialFunction::Relaxation, ModulusKind::Shear) => (
            &["relaxation_modulus", "relaxationsmodul", "g(t)", "g"],
            Dimension::Stress,
        ),
    };
    Column::new(names, dimension, "values").by_first_name()
}

fn other(function: MaterialFunction) -> MaterialFunction {
    match function {
        MaterialFunction::Creep => MaterialFunction::Relaxation,
        MaterialFunction::Relaxation => MaterialFunction::Creep,
    }
}

/// Reads a table from a file.
///
/// # Errors
/// The file cannot be opened, or [`parse`] refuses it.
pub(crate) fn read(
    path: &Path,
    function: MaterialFunction,
    kind: ModulusKind,
) -> Result<Tabulated, Diagnostics> {
    let (name, bytes) = contents(path, MAX_BYTES)?;
    parse(&name, &bytes, function, kind)
}

/// Reads a table from the bytes of a file that messages call `name`.
///
/// # Errors
/// What [`DataFile`] and [`Tabulated::new`] refuse, each with its place.
pub(crate) fn parse(
    name: &str,
    bytes: &[u8],
    function: MaterialFunction,
    kind: ModulusKind,
) -> Result<Tabulated, Diagnostics> {
    let file = DataFile::from_bytes(name, bytes)?;
    let values = values_of(function, kind);
    if !file.has_any(&[values])
        && let Some(help) = meant_for(&file, function, kind)
    {
        let message = format!("no column `{}`", values.name_in_si());
        return Err(Diagnostic::at(&file.first_line(), message)
            .help(help)
            .into());
    }
    let without_number =
        "write it as `1.5e-9`, or leave the cell empty where the number is missing";
    let table = file.columns(&[TIMES, values], Holes::PassedOver, without_number)?;
    let (times_s, numbers) = (table.column(0), table.column(1));
    let made = Tabulated::new(function, kind, times_s, numbers);
    let made = made.map(|data| data.with_rows_passed_over(table.passed_over()));
    made.map_err(|error| {
        let place = error
            .place()
            .map(|(row, column)| table.cell(row - 1, usize::from(column == TableColumn::Value)));
        explain(&place.unwrap_or(table.whole()), &error, function).into()
    })
}

/// What a table is for that has the column of the other quantity, or of the other modulus.
fn meant_for(file: &DataFile, function: MaterialFunction, kind: ModulusKind) -> Option<String> {
    let other_function = other(function);
    let word = other_function.name();
    let other_kind = match kind {
        ModulusKind::Longitudinal => ModulusKind::Shear,
        ModulusKind::Shear => ModulusKind::Longitudinal,
    };
    if file.has_any(&[values_of(function, other_kind)]) {
        return Some(format!(
            "its column is a {0} modulus: say \"{0}\"",
            other_kind.name()
        ));
    }
    let of_kind = [kind, other_kind].map(|kind| values_of(other_function, kind));
    file.has_any(&of_kind)
        .then(|| format!("the table holds the quantity \"{word}\": say so"))
}

/// What the material module refuses, at its place in the file.
fn explain(place: &Location, error: &TableError, function: MaterialFunction) -> Diagnostic {
    let diagnostic = Diagnostic::at(place, error.to_string());
    match error {
        TableError::Reversal { .. } | TableError::Trend { .. } => {
            let word = other(function).name();
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::diagnostic::Styling;
    use crate::material::tabulated::TableWarning;
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
        insta::assert_snapshot!(refusal(&GOOD.replace("time_s", "when")), @r"
        error: no column `time_s`
         --> data.csv:1:1
          |
        1 | when,creep_compliance_per_pa
          | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^ 2 columns, separated by commas
          |
          = help: name the column of times with its unit, such as `time_s` or
                  `time [s]`
        ");
        insta::assert_snapshot!(refusal(&GOOD.replace("creep_compliance_per", "relaxation_modulus")), @r#"
        error: no column `creep_compliance_per_pa`
         --> data.csv:1:1
          |
        1 | time_s,relaxation_modulus_pa
          | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^
          |
          = help: the table holds the quantity "relaxation": say so
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
        error: a row of 3 cells in a table of 2 columns
         --> data.csv:6:1
          |
        6 | 2,4,1e-10
          | ^^^^^^^^^
          |
          = help: give every row one cell per column; where commas separate cells,
                  numbers have a decimal point

        error: a cell of the column `time_s` must be a number
         --> data.csv:7:1
          |
        7 | ten,4.2e-10
          | ^^^ not a number
          |
          = help: write it as `1.5e-9`, or leave the cell empty where the number is
                  missing

        error: a cell of the column `creep_compliance_per_pa` must be a number
         --> data.csv:9:6
          |
        9 | 1000,-inf
          |      ^^^^ not a finite number
          |
          = help: write it as `1.5e-9`, or leave the cell empty where the number is
                  missing
        ");
    }

    #[test]
    fn a_row_in_which_a_number_is_missing_is_passed_over_and_counted() {
        let whole = read_creep(GOOD.as_bytes()).unwrap();
        for missing in [
            "2,",
            "2,-",
            ",4.15e-10",
            "NaN,4.15e-10",
            "n/a,n.a.",
            "2,#N/A",
            "2,NULL",
            "2,none",
        ] {
            let text = GOOD.replace("\n10,", &format!("\n{missing}\n10,"));
            let table = read_creep(text.as_bytes()).unwrap();
            assert_eq!(table.values(), whole.values(), "{missing}");
            assert_eq!(
                table.warnings(),
                [&[TableWarning::Missing { rows: 1 }], whole.warnings()].concat(),
                "{missing}"
            );
        }
    }

    #[test]
    fn columns_are_known_by_their_symbols_and_in_german() {
        let (rows, inverse) = (
            "0,1000;0,4\n1;0,41\n1.000,0;0,42\n10.000;0,43\n",
            "0.1,2.5\n1,2.4\n10,2.3\n100,2.2\n",
        );
        for names in [
            "t (s);J (1/GPa)",
            "t;D(t) [1/GPa]",
            "Zeit [s];Kriechnachgiebigkeit (1/GPa)",
            // Symbols of a temperature and of a diameter.
            "t (s);J (1/GPa);T (°C);D (mm)",
        ] {
            let others = ";1,5".repeat(names.matches(';').count() - 1);
            let rows = rows.replace('\n', &format!("{others}\n"));
            let table = read_creep(format!("{names}\n{rows}").as_bytes()).unwrap();
            assert_eq!(table.times_s(), [0.1, 1.0, 1000.0, 10_000.0], "{names}");
            assert!((table.values()[3] / 0.43e-9 - 1.0).abs() < 1e-12, "{names}");
        }
        let relaxation = |names: &str, kind| {
            let text = format!("{names}\n{inverse}");
            parse(
                "data.csv",
                text.as_bytes(),
                MaterialFunction::Relaxation,
                kind,
            )
            .map_err(|refused| refused.render(Styling::Plain))
        };
        for (kind, names) in [
            (ModulusKind::Longitudinal, "t,E(t) (GPa)"),
            (ModulusKind::Shear, "t (s),G (GPa)"),
        ] {
            let table = relaxation(names, kind).unwrap();
            assert!((table.values()[0] / 2.5e9 - 1.0).abs() < 1e-12, "{names}");
        }
        let other = relaxation("t,E(t) (GPa)", ModulusKind::Shear).unwrap_err();
        assert!(
            other.contains("its column is a longitudinal modulus"),
            "{other}"
        );
        // A unit is never guessed.
        assert!(refusal("t,J\n0,1\n1,2\n2,3\n3,4\n").contains("the column of values has no unit"));
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
