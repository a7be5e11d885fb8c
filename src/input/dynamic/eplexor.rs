//! Workbooks `.xls` and `.xlsx` of Eplexor (Netzsch Gabo): after the files in the examples of NREL/pyvisco.
//!
//! The sheet `Exported Data` has a row of names, `Nr, F stat., ..., f, T, E', E'', |E*|, tan delta`, a row of units, and rows in which
//! `---` marks what is missing. In the workbook of a master curve the sheet `Shiftlist` holds the reference temperature and
//! `WLF | C1 : 13.50 | C2 : 141.19 K`; its frequencies are reduced, and `T` of its rows is not that of the curve.
//!
//! In a workbook without that sheet, every sheet with dynamic data is read, as TRIOS writes one for every step.
//!
//! The sheet is laid out as text with tabs, a line for every row, so that places in it are those of the workbook.

use std::cell::Cell;
use std::io::{Cursor, Read as _, copy, sink};
use std::panic::{AssertUnwindSafe, catch_unwind};

use calamine::{Data, DataRef, Reader, Xls, Xlsx};

use super::{Reading, generic, steps};
use crate::input::data_file::grid::Grid;
use crate::input::data_file::units;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::input::file_kind;
use crate::quantity::celsius;

/// Largest workbook, bytes: its contents may be a thousand times as large.
const MAX_BYTES: usize = 4_000_000;
/// Most bytes that the files in a workbook may have, unpacked.
const MAX_UNPACKED_BYTES: u64 = 100_000_000;
/// Most cells that a sheet may span.
const MOST_CELLS: usize = 5_000_000;
/// Rows and columns that are looked at.
const MOST_ROWS: u32 = 200_000;
const MOST_COLUMNS: u32 = 500;
/// Most bytes of the text in a cell: Excel holds 32,767 characters.
const MOST_BYTES_OF_CELL: usize = 4 * 32_767;
/// The sheet of the data, and that of the shift factors.
const DATA: &str = "Exported Data";
const SHIFTS: &str = "Shiftlist";

/// Whether bytes begin as a workbook does.
pub(super) fn detect(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1") || bytes.starts_with(b"PK\x03\x04")
}

thread_local! {
    /// Whether this thread is in the crate that reads workbooks, whose panics are caught.
    static IS_READING: Cell<bool> = const { Cell::new(false) };
}

/// Keeps panics that are caught from being printed; for programs, once at their start.
#[cfg(feature = "cli")]
pub(crate) fn silence_caught_panics() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !IS_READING.get() {
            print(panic);
        }
    }));
}

/// Reads the isotherms, or the master curve.
///
/// # Errors
/// No workbook, no sheet with dynamic data, or what [`super::block::Block::read`] refuses.
pub(super) fn read(name: &str, bytes: &[u8], reading: &mut Reading) -> Result<(), Diagnostics> {
    if bytes.len() > MAX_BYTES {
        let message = format!(
            "the workbook `{name}` is larger than {} MB",
            MAX_BYTES / 1_000_000
        );
        return Err(Diagnostic::new(message)
            .help("save the sheet of the data as CSV")
            .into());
    }
    // The crate that reads workbooks is not free of panics on broken ones.
    IS_READING.set(true);
    let sheets = catch_unwind(AssertUnwindSafe(|| sheets(bytes)));
    IS_READING.set(false);
    let sheets = sheets.unwrap_or_else(|_| Err("it is broken".into()));
    let sheets = sheets.map_err(|why| {
        // A ZIP archive is a workbook only where Excel wrote it.
        if let Some((what, help)) = file_kind::of(bytes).filter(|_| !is_workbook(bytes)) {
            return Diagnostic::new(format!("`{name}` is {what}, not a table of dynamic data"))
                .help(help);
        }
        Diagnostic::new(format!("`{name}` cannot be read as a workbook: {why}"))
            .help("open it and save it again, or save the sheet as CSV")
    })?;
    let shifts = sheets.iter().find(|(sheet, _)| sheet == SHIFTS);
    let is_named = sheets.iter().any(|(sheet, _)| sheet == DATA);
    let wanted = sheets.iter().filter(|(sheet, _)| {
        let is_data = if is_named {
            sheet == DATA
        } else {
            sheet != SHIFTS
        };
        is_data && !steps::is_derived(sheet)
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

fn is_workbook(bytes: &[u8]) -> bool {
    file_kind::of(bytes).is_some_and(|(what, _)| what.contains("workbook"))
}

/// Why a workbook cannot be read.
type Broken = Box<dyn std::error::Error>;

/// The crate that reads workbooks unpacks their files whole: refuses those that are too large for that.
fn check_archive(bytes: &[u8]) -> Result<(), Broken> {
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes))?;
    let mut left = MAX_UNPACKED_BYTES;
    for place in 0..archive.len() {
        let file = archive.by_index(place)?;
        let unpacked = copy(&mut file.take(left + 1), &mut sink())?;
        left = left
            .checked_sub(unpacked)
            .ok_or("unpacked it is larger than 100 MB")?;
    }
    Ok(())
}

/// The crate lays a sheet out as the rectangle that its cells span, or that it says they span: refuses those that are too large for
/// that. Records of the stream are a kind and a length, of two bytes each, and the data.
fn check_records(bytes: &[u8]) -> Result<(), Broken> {
    let mut file = cfb::CompoundFile::open(Cursor::new(bytes))?;
    let stream = ["/Workbook", "/Book"]
        .into_iter()
        .find(|name| file.is_stream(name))
        .ok_or("it has no stream `Workbook`")?;
    let mut data = Vec::new();
    file.open_stream(stream)?.read_to_end(&mut data)?;
    let (mut at, mut rows, mut columns) = (0, 0, 0);
    let number = |at: usize| {
        data.get(at..at + 2)
            .map_or(0, |pair| usize::from(pair[0]) + 256 * usize::from(pair[1]))
    };
    while at + 4 <= data.len() {
        let (kind, length, start) = (number(at), number(at + 2), at + 4);
        match kind {
            0x809 => (rows, columns) = (0, 0),
            // Dimensions: first and last row, of four bytes, first and last column.
            0x200 if length >= 14 => {
                let ends = [0, 4, 8, 10].map(|offset| number(start + offset));
                let is_range = ends[0] <= ends[1]
                    && ends[2] <= ends[3]
                    && number(start + 2) <= 1
                    && number(start + 6) <= 1;
                if !is_range {
                    return Err("the dimensions of a sheet are broken".into());
                }
                rows = rows.max(ends[1]);
                columns = columns.max(ends[3]);
            }
            // Cells: row and column.
            0x06 | 0xbd | 0xd6 | 0xfd | 0x203 | 0x204 | 0x205 | 0x27e => {
                rows = rows.max(number(start) + 1);
                columns = columns.max(number(start + 2) + 1);
            }
            _ => {}
        }
        if rows * columns > MOST_CELLS {
            return Err(format!("a sheet spans {rows} rows and {columns} columns").into());
        }
        at = start + length;
    }
    Ok(())
}

/// Every sheet as text.
fn sheets(bytes: &[u8]) -> Result<Vec<(String, String)>, Broken> {
    let wanted = |names: Vec<String>| -> Vec<String> { names.into_iter().take(20).collect() };
    if bytes.starts_with(b"PK") {
        check_archive(bytes)?;
        let mut book: Xlsx<_> = Xlsx::new(Cursor::new(bytes))?;
        let names = wanted(book.sheet_names());
        return names
            .into_iter()
            .map(|sheet| Ok((sheet.clone(), xlsx_sheet(&mut book, &sheet)?)))
            .collect();
    }
    check_records(bytes)?;
    let mut book: Xls<_> = Xls::new(Cursor::new(bytes))?;
    let names = wanted(book.sheet_names());
    let sheet = |sheet: String| {
        let range = book.worksheet_range(&sheet)?;
        let mut text = Rows::default();
        let (top, left) = range.start().unwrap_or((0, 0));
        for (row, column, cell) in range.used_cells() {
            text.push(
                top + u32::try_from(row).unwrap_or(u32::MAX / 2),
                left + u32::try_from(column).unwrap_or(u32::MAX / 2),
                &written(cell),
            )?;
        }
        Ok((sheet, text.text))
    };
    names.into_iter().map(sheet).collect()
}

fn xlsx_sheet(book: &mut Xlsx<Cursor<&[u8]>>, sheet: &str) -> Result<String, Broken> {
    let mut cells = book.worksheet_cells_reader(sheet)?;
    let mut text = Rows::default();
    while let Some(cell) = cells.next_cell()? {
        let (row, column) = cell.get_position();
        match cell.get_value() {
            // Many cells may name one long text: it is not copied for those that are not kept.
            DataRef::SharedString(shared) => text.push(row, column, shared)?,
            DataRef::String(own) => text.push(row, column, own)?,
            other => text.push(row, column, &written(&Data::from(other.clone())))?,
        }
        if text.is_full() {
            break;
        }
    }
    Ok(text.text)
}

/// Cells that come row by row, laid out as lines with tabs.
#[derive(Default)]
struct Rows {
    text: String,
    row: u32,
    column: u32,
}

impl Rows {
    /// Whether nothing more is kept.
    fn is_full(&self) -> bool {
        self.text.len() > super::MAX_BYTES || self.row >= MOST_ROWS
    }

    fn push(&mut self, row: u32, column: u32, cell: &str) -> Result<(), Broken> {
        if cell.len() > MOST_BYTES_OF_CELL {
            return Err(format!(
                "the cell in row {}, column {} is longer than Excel allows",
                row + 1,
                column + 1
            )
            .into());
        }
        let is_before = (row, column) < (self.row, self.column);
        if is_before || row >= MOST_ROWS || column >= MOST_COLUMNS || self.is_full() {
            return Ok(());
        }
        while self.row < row {
            self.text.push('\n');
            self.row += 1;
            self.column = 0;
        }
        while self.column < column {
            self.text.push('\t');
            self.column += 1;
        }
        self.text += &cell.replace(['\t', '\n', '\r'], " ");
        Ok(())
    }
}

fn written(cell: &Data) -> String {
    match cell {
        Data::Float(number) => format!("{number}"),
        Data::Int(number) => format!("{number}"),
        Data::String(text) => text.clone(),
        Data::Bool(value) => format!("{value}"),
        _ => String::new(),
    }
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
    use super::MOST_BYTES_OF_CELL;
    use crate::input::diagnostic::Styling;
    use crate::input::dynamic::tests::{TAU, assert_points, read_bytes};
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
            assert!(
                file.notes
                    .iter()
                    .any(|note| note.contains("1 row passed over")),
                "{:?}",
                file.notes
            );
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
