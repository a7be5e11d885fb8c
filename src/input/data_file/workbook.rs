//! The sheets of workbooks `.xls` and `.xlsx` as text with tabs, a line for every row, so that places in it are those of the workbook.

use std::cell::Cell;
use std::io::{Cursor, Read as _, copy, sink};
use std::panic::{AssertUnwindSafe, catch_unwind};

use calamine::{Data, DataRef, Reader, Xls, Xlsx};

use super::within;
use crate::input::diagnostic::Diagnostic;
use crate::input::file_kind;

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
pub(crate) const MOST_BYTES_OF_CELL: usize = 4 * 32_767;
/// Most bytes of the text of a sheet.
const MOST_BYTES_OF_SHEET: usize = 32_000_000;

/// Whether bytes begin as a workbook does.
pub(crate) fn is_workbook(bytes: &[u8]) -> bool {
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

/// Every sheet of a workbook, its name and its text.
///
/// # Errors
/// No workbook, a broken one, or one that is too large.
pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<Vec<(String, String)>, Diagnostic> {
    within(name, bytes, MAX_BYTES, "save the sheet of the data as CSV")?;
    // The crate that reads workbooks is not free of panics on broken ones.
    IS_READING.set(true);
    let sheets = catch_unwind(AssertUnwindSafe(|| sheets(bytes)));
    IS_READING.set(false);
    let sheets = sheets.unwrap_or_else(|_| Err("it is broken".into()));
    sheets.map_err(|why| {
        // A ZIP archive is a workbook only where Excel wrote it.
        let kind = file_kind::of(bytes).filter(|(what, _)| !what.contains("workbook"));
        match kind {
            Some((what, help)) => {
                Diagnostic::new(format!("`{name}` is {what}, not a table of dynamic data"))
                    .help(help)
            }
            None => Diagnostic::new(format!("`{name}` cannot be read as a workbook: {why}"))
                .help("open it and save it again, or save the sheet as CSV"),
        }
    })
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
        let names = wanted(book.sheet_names()).into_iter();
        let sheet = |sheet: String| Ok((sheet.clone(), xlsx_sheet(&mut book, &sheet)?));
        return names.map(sheet).collect();
    }
    check_records(bytes)?;
    let mut book: Xls<_> = Xls::new(Cursor::new(bytes))?;
    let names = wanted(book.sheet_names());
    let sheet = |sheet: String| {
        let range = book.worksheet_range(&sheet)?;
        let mut text = Rows::default();
        let (top, left) = range.start().unwrap_or((0, 0));
        for (row, column, cell) in range.used_cells() {
            let (row, column) = (u32::try_from(row)?, u32::try_from(column)?);
            text.push(top + row, left + column, &written(cell))?;
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
        self.text.len() > MOST_BYTES_OF_SHEET || self.row >= MOST_ROWS
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

/// What is read of a cell: no dates, and no errors of formulas.
fn written(cell: &Data) -> String {
    match cell {
        Data::Float(_) | Data::Int(_) | Data::String(_) | Data::Bool(_) => cell.to_string(),
        _ => String::new(),
    }
}
