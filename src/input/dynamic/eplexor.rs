//! Workbooks `.xls` and `.xlsx` of Eplexor (Netzsch Gabo): after the files in the examples of NREL/pyvisco.
//!
//! The sheet `Exported Data` has a row of names, `Nr, F stat., ..., f, T, E', E'', |E*|, tan delta`, a row of units, and rows in which
//! `---` marks what is missing. In the workbook of a master curve the sheet `Shiftlist` holds the reference temperature and
//! `WLF | C1 : 13.50 | C2 : 141.19 K`; its frequencies are reduced, and `T` of its rows is not that of the curve.
//!
//! In a workbook without that sheet, every sheet with dynamic data is read, as TRIOS writes one for every step.

use super::{Reading, generic, steps};
use crate::input::data_file::grid::Grid;
use crate::input::data_file::{units, workbook};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::quantity::celsius;

/// The sheet of the data, and that of the shift factors.
const DATA: &str = "Exported Data";
const SHIFTS: &str = "Shiftlist";

/// Reads the isotherms, or the master curve.
///
/// # Errors
/// No workbook, no sheet with dynamic data, or what [`super::block::Block::read`] refuses.
pub(super) fn read(name: &str, bytes: &[u8], reading: &mut Reading) -> Result<(), Diagnostics> {
    read_sheets(name, &workbook::read(name, bytes)?, reading)
}

/// The same from sheets, each with its name, as a text with tabs.
pub(super) fn read_sheets(
    name: &str,
    sheets: &[(String, String)],
    reading: &mut Reading,
) -> Result<(), Diagnostics> {
    let shifts = sheets.iter().find(|(sheet, _)| sheet == SHIFTS);
    let is_named = sheets.iter().any(|(sheet, _)| sheet == DATA);
    let wanted = sheets.iter().filter(|(sheet, _)| match is_named {
        true => sheet == DATA,
        false => sheet != SHIFTS && !steps::is_derived(sheet),
    });
    let (mut first, mut read) = (None, false);
    for (sheet, text) in wanted {
        let source = Source::file(format!("{name}[{sheet}]"), text.clone());
        match generic::header(&source) {
            Some((grid, header)) => {
                reading.note(format!("sheet `{sheet}`"));
                let shifts = shifts.map(|(_, text)| text.as_str());
                one_sheet(&grid, header, shifts, reading)?;
                read = true;
            }
            None => first = first.or(Some(source)),
        }
    }
    match (read, first) {
        (true, _) => Ok(()),
        (false, Some(source)) => Err(generic::no_header(&source).into()),
        (false, None) => Err(Diagnostic::new(format!(
            "the workbook `{name}` has no sheet with data"
        ))
        .help(format!("name the sheet `{DATA}`"))
        .into()),
    }
}

/// Reads the tables of a sheet; those of a master curve where there is a list of shift factors.
fn one_sheet(
    grid: &Grid,
    header: usize,
    shifts: Option<&str>,
    reading: &mut Reading,
) -> Result<(), Diagnostics> {
    for block in generic::blocks(grid, header) {
        let mut block = block.by_instrument();
        if let Some(shifts) = shifts {
            block.is_master = true;
            block.temperature_k = reference(shifts);
            let at = block
                .temperature_k
                .map_or_else(|| "an unknown temperature".to_owned(), celsius);
            reading.note(format!(
                "a master curve at {at}: the workbook has a sheet `{SHIFTS}`"
            ));
        }
        reading.add(&block)?;
    }
    Ok(())
}

/// The reference temperature in the sheet of the shift factors (K): the first cell with one, `20.0 °C`.
fn reference(sheet: &str) -> Option<f64> {
    let cells = sheet.lines().take(3).flat_map(|line| line.split('\t'));
    cells.into_iter().find_map(|cell| {
        let number = cell
            .trim()
            .strip_suffix('C')?
            .trim_end_matches(['°', ' ', '\u{ba}']);
        units::kelvin(number.rsplit([' ', ':', '=']).next()?)
    })
}

#[cfg(test)]
mod tests {
    use crate::input::data_file::workbook::MOST_BYTES_OF_CELL;
    use crate::input::diagnostic::Styling;
    use crate::input::dynamic::tests::{TAU, assert_noted, assert_points, read_bytes};
    use crate::input::dynamic::workbook::{Sheet, xls, xlsx};
    use crate::input::dynamic::{DynamicFormat, MAX_BYTES, from_bytes};
    use crate::material::ModulusKind;

    fn data() -> Sheet<'static> {
        let rows = vec![
            vec!["Nr", "F stat.", "f", "T", "E'", "E''", "|E*|", "tan delta"],
            vec!["", "N", "Hz", "°C", "MPa", "MPa", "MPa", ""],
            vec!["1", "2.5", "1", "-20.1", "2000", "100", "2002.5", "0.05"],
            vec!["2", "2.5", "10", "-19.9", "2200", "90", "2201.8", "0.041"],
            vec!["3", "---", "100", "-20", "---", "---", "---", "---"],
            vec!["4", "2.5", "1", "20", "1000", "200", "1020", "0.2"],
            vec!["5", "", "10", "20.2", "1200", "190", "1215", "0.158"],
        ];
        ("Exported Data", rows)
    }

    fn shifts() -> Sheet<'static> {
        let rows = vec![
            vec!["RefT", "20.0 °C", ""],
            vec!["WLF", "C1 : 13.50", "C2 : 141.19 K"],
            vec!["T", "log aT", ""],
            vec!["-20", "5", ""],
        ];
        ("Shiftlist", rows)
    }

    #[test]
    fn a_cell_longer_than_excel_allows_is_refused_before_it_is_copied() {
        let long = "x".repeat(MOST_BYTES_OF_CELL + 1);
        let (name, mut rows) = data();
        rows.push(vec![&long]);
        let refused = from_bytes("a.xlsx", &xlsx(&[(name, rows)]), None, ModulusKind::Shear);
        let text = refused.unwrap_err().render(Styling::Plain);
        assert!(text.contains("row 8, column 1 is longer"), "{text}");
    }

    #[test]
    fn workbooks_of_both_kinds_hold_the_same_isotherms() {
        for bytes in [xls(&[("Other", vec![vec!["x"]]), data()]), xlsx(&[data()])] {
            let file = read_bytes(&bytes, ModulusKind::Longitudinal).unwrap();
            assert_eq!(file.format, DynamicFormat::Eplexor);
            assert_eq!(file.data.isotherms().len(), 2);
            let expected = [
                [253.05, TAU, 2e9, 1e8],
                [253.25, 10.0 * TAU, 2.2e9, 9e7],
                [293.15, TAU, 1e9, 2e8],
                [293.35, 10.0 * TAU, 1.2e9, 1.9e8],
            ];
            assert_points(&file, &expected);
            assert_noted(&file, "1 row passed over");
        }
    }

    #[test]
    fn a_workbook_with_a_sheet_for_every_step_is_read_but_for_what_was_computed() {
        let step = |celsius: &'static str| {
            vec![
                vec!["Frequency sweep"],
                vec![
                    "Angular frequency",
                    "Temperature",
                    "Storage modulus",
                    "Loss modulus",
                ],
                vec!["rad/s", "°C", "MPa", "MPa"],
                vec!["1", celsius, "2", "0.1"],
                vec!["10", celsius, "3", "0.2"],
            ]
        };
        let details = (
            "Details",
            vec![vec!["Filename", "x"], vec!["Operator", "y"]],
        );
        let sheets = [
            details,
            ("Step 1", step("20")),
            ("Step 2", step("40")),
            ("TTS - master curve", step("30")),
        ];
        let file = read_bytes(&xlsx(&sheets), ModulusKind::Shear).unwrap();
        assert_points(
            &file,
            &[
                [293.15, 1.0, 2e6, 1e5],
                [293.15, 10.0, 3e6, 2e5],
                [313.15, 1.0, 2e6, 1e5],
                [313.15, 10.0, 3e6, 2e5],
            ],
        );
    }

    #[test]
    fn a_master_curve_has_the_temperature_of_its_shift_list() {
        let file = read_bytes(&xls(&[data(), shifts()]), ModulusKind::Longitudinal).unwrap();
        assert_eq!(file.data.isotherms().len(), 1);
        assert_eq!(file.data.isotherms()[0].temperature_k, Some(293.15));
        assert_eq!(file.data.points().count(), 4);
    }

    #[test]
    fn what_cannot_be_read_is_refused_at_the_row_of_the_workbook() {
        let (name, mut rows) = data();
        rows[3][4] = "two";
        let refused = read_bytes(&xlsx(&[(name, rows)]), ModulusKind::Longitudinal).unwrap_err();
        assert!(
            refused.contains("dma.csv[Exported Data]:4:")
                && refused.contains("`E'` must be a number"),
            "{refused}"
        );
        let refused = read_bytes(&xls(&[data()]), ModulusKind::Shear).unwrap_err();
        assert!(refused.contains("--modulus longitudinal"), "{refused}");
        let refused = read_bytes(
            &xls(&[("Exported Data", vec![vec!["f", "x"], vec!["1", "2"]])]),
            ModulusKind::Shear,
        )
        .unwrap_err();
        assert!(refused.contains("no column of"), "{refused}");
        let whole = xls(&[data()]);
        assert!(
            read_bytes(&whole[..600], ModulusKind::Shear)
                .unwrap_err()
                .contains("cannot be read as a workbook")
        );
        let refused = read_bytes(
            &[whole.as_slice(), &vec![0; 5_000_000]].concat(),
            ModulusKind::Shear,
        )
        .unwrap_err();
        assert!(refused.contains("larger than 4 MB"), "{refused}");
        let text = from_bytes(
            "a.csv",
            b"f,E'\n",
            Some(DynamicFormat::Eplexor),
            ModulusKind::Shear,
        );
        assert!(
            text.unwrap_err()
                .to_string()
                .contains("cannot be read as a workbook")
        );
        let forced = from_bytes(
            "a.xls",
            &whole,
            Some(DynamicFormat::Generic),
            ModulusKind::Shear,
        );
        assert!(forced.unwrap_err().to_string().contains("is a workbook"));
        assert!(whole.len() < MAX_BYTES);
    }

    #[test]
    fn a_cell_far_away_takes_no_memory() {
        // The number in row 3, column 1 is moved to column 65535, then to row 65535 too.
        let whole = xls(&[data()]);
        let record = [0x03, 0x02, 14, 0, 2, 0, 0, 0, 0, 0];
        let at = whole
            .windows(record.len())
            .position(|part| part == record)
            .unwrap();
        let mut far = whole.clone();
        far[at + 4..at + 8].fill(0xff);
        let refused = read_bytes(&far, ModulusKind::Longitudinal).unwrap_err();
        assert!(
            refused.contains("a sheet spans 65536 rows and 65536 columns"),
            "{refused}"
        );
    }

    #[test]
    fn changed_workbooks_are_read_or_refused() {
        for whole in [xls(&[data(), shifts()]), xlsx(&[data(), shifts()])] {
            let mut seed = 1_u32;
            for _ in 0..300 {
                let mut changed = whole.clone();
                for _ in 0..3 {
                    seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let at = seed as usize / 256 % changed.len();
                    changed[at] = seed.to_le_bytes()[3];
                }
                // Whatever comes of it, it comes back.
                let _ = read_bytes(&changed, ModulusKind::Longitudinal);
            }
        }
    }
}
