//! Workbooks `.xls` and `.xlsx` of Eplexor (Netzsch Gabo): after the files in the examples of NREL/pyvisco.
//!
//! The sheet `Exported Data` has a row of names, `Nr, F stat., ..., f, T, E', E'', |E*|, tan delta`, a row of units, and rows in which
//! `---` marks what is missing. In the workbook of a master curve the sheet `Shiftlist` holds the reference temperature and
//! `WLF | C1 : 13.50 | C2 : 141.19 K`; its frequencies are reduced, and `T` of its rows is not that of the curve.
//!
//! The sheet is laid out as text with tabs, a line for every row, so that places in it are those of the workbook.

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use calamine::{Data, DataRef, Reader, Xls, Xlsx};

use super::{Reading, generic};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::quantity::{ZERO_CELSIUS_K, celsius};

/// Largest workbook, bytes: its contents may be a thousand times as large.
const MAX_BYTES: usize = 4_000_000;
/// Rows and columns that are looked at.
const MOST_ROWS: u32 = 200_000;
const MOST_COLUMNS: u32 = 500;
/// The sheet of the data, and that of the shift factors.
const DATA: &str = "Exported Data";
const SHIFTS: &str = "Shiftlist";

/// Whether bytes begin as a workbook does.
pub(super) fn detect(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1") || bytes.starts_with(b"PK\x03\x04")
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
    let sheets = catch_unwind(AssertUnwindSafe(|| sheets(bytes)))
        .unwrap_or_else(|_| Err("it is broken".to_owned()));
    let sheets = sheets.map_err(|why| {
        Diagnostic::new(format!("`{name}` cannot be read as a workbook: {why}"))
            .help("open it and save it again, or save the sheet as CSV")
    })?;
    let shifts = sheets.iter().find(|(sheet, _)| sheet == SHIFTS);
    let data = sheets.iter().find(|(sheet, _)| sheet == DATA);
    let Some((sheet, text)) = data.or_else(|| sheets.iter().find(|(sheet, _)| sheet != SHIFTS))
    else {
        return Err(
            Diagnostic::new(format!("the workbook `{name}` has no sheet with data"))
                .help(format!("name the sheet `{DATA}`"))
                .into(),
        );
    };
    let source = Source::file(format!("{name}[{sheet}]"), text.clone());
    reading.note(format!("sheet `{sheet}`"));
    let Some((grid, header)) = generic::header(&source) else {
        return Err(generic::no_header(&source).into());
    };
    for block in generic::blocks(&grid, header) {
        let mut block = block.by_instrument();
        if let Some((_, shifts)) = shifts {
            block.is_master = true;
            block.temperature_k = reference(shifts);
            let at = block
                .temperature_k
                .map_or_else(|| "an unknown temperature".to_owned(), celsius);
            reading.note(format!(
                "a master curve at {at}: the workbook has a sheet `{SHIFTS}`"
            ));
        }
        let content = block.read(reading.kind)?;
        reading.add_content(&block, content)?;
    }
    Ok(())
}

/// Every sheet as text.
fn sheets(bytes: &[u8]) -> Result<Vec<(String, String)>, String> {
    let wanted = |names: Vec<String>| -> Vec<String> { names.into_iter().take(20).collect() };
    if bytes.starts_with(b"PK") {
        let mut book: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(|error| error.to_string())?;
        let names = wanted(book.sheet_names());
        return names
            .into_iter()
            .map(|sheet| Ok((sheet.clone(), xlsx_sheet(&mut book, &sheet)?)))
            .collect();
    }
    let mut book: Xls<_> = Xls::new(Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let names = wanted(book.sheet_names());
    let sheet = |sheet: String| {
        let range = book
            .worksheet_range(&sheet)
            .map_err(|error| error.to_string())?;
        let mut text = Rows::default();
        let (top, left) = range.start().unwrap_or((0, 0));
        for (row, column, cell) in range.used_cells() {
            text.push(
                top + u32::try_from(row).unwrap_or(u32::MAX / 2),
                left + u32::try_from(column).unwrap_or(u32::MAX / 2),
                &written(cell),
            );
        }
        Ok((sheet, text.text))
    };
    names.into_iter().map(sheet).collect()
}

fn xlsx_sheet(book: &mut Xlsx<Cursor<&[u8]>>, sheet: &str) -> Result<String, String> {
    let mut cells = book
        .worksheet_cells_reader(sheet)
        .map_err(|error| error.to_string())?;
    let mut text = Rows::default();
    while let Some(cell) = cells.next_cell().map_err(|error| error.to_string())? {
        let (row, column) = cell.get_position();
        let value = match cell.get_value() {
            DataRef::SharedString(shared) => (*shared).to_owned(),
            other => written(&Data::from(other.clone())),
        };
        text.push(row, column, &value);
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
    fn push(&mut self, row: u32, column: u32, cell: &str) {
        let is_before = (row, column) < (self.row, self.column);
        if is_before
            || row >= MOST_ROWS
            || column >= MOST_COLUMNS
            || self.text.len() > super::MAX_BYTES
        {
            return;
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
        self.text.extend(cell.chars().map(|c| {
            if matches!(c, '\t' | '\n' | '\r') {
                ' '
            } else {
                c
            }
        }));
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
        let number = number
            .rsplit([' ', ':', '='])
            .next()?
            .replace(',', ".")
            .parse::<f64>()
            .ok()?;
        let kelvin = number + ZERO_CELSIUS_K;
        (kelvin.is_finite() && kelvin > 0.0).then_some(kelvin)
    })
}
