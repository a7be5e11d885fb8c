//! Files of instruments and tools to [`DynamicData`]: storage and loss modulus over frequency, isotherm by isotherm.
//!
//! The format is found from the content, or given: `formats` says by what each is known and where its tables stand. What they have in
//! common is in `columns` (names and units), `block` (moduli of rows) and `isotherms` (which rows belong together).
//! A number marked as missing takes its row out, which is counted. A loss that is not positive is noise, and takes its row out with a
//! note; a storage modulus or frequency likewise in the file of an instrument, while in a table it is refused at its place.
//!
//! ```
//! use contact_dma::input::dynamic::{DynamicFormat, from_bytes};
//! use contact_dma::material::ModulusKind;
//!
//! let text = "f,E_stor,E_loss,T,Set\nHz, MPa, MPa, C, -\n0.1,80,1,20.1,0\n1,90,2,20.0,0\n1,70,5,40.1,1\n";
//! let file = from_bytes("dma.csv", text.as_bytes(), None, ModulusKind::Longitudinal)?;
//! assert_eq!(file.format, DynamicFormat::Pyvisco);
//! assert_eq!(file.data.isotherms().len(), 2);
//! # Ok::<(), contact_dma::input::diagnostic::Diagnostics>(())
//! ```

mod block;
mod columns;
mod eplexor;
mod formats;
mod generic;
mod isotherms;
mod reptate;
mod rheocompass;
mod shift_factors;
mod steps;

#[cfg(feature = "cli")]
pub(crate) use super::data_file::workbook::silence_caught_panics;
use std::path::PathBuf;
use std::sync::Arc;

use super::data_file::workbook::is_workbook;
use super::data_file::{self, grid};
use super::diagnostic::{Diagnostic, Diagnostics, Location, Source};
use crate::material::ModulusKind;
use crate::material::dynamic::{DynamicData, DynamicDataError};
use crate::quantity::{FrequencyUnit, celsius};
use block::{Block, Content, Measured};
use contact_dma_core::words;
use formats::Format;
pub use shift_factors::{read_shift_factors, shift_factors_from_bytes};

/// Largest file read, bytes: ten thousand points of a hundred columns of thirty characters each.
pub const MAX_BYTES: usize = 32_000_000;

/// What to do about a file that is larger.
const FEWER: &str = "export fewer columns, and no waveforms";

words! {
    /// A format of files of dynamic data.
    pub enum DynamicFormat {
        /// Named columns with units.
        Generic = "table",
        Pyvisco = "pyvisco",
        TriosText = "trios-text",
        TriosLims = "trios-lims",
        TriosCsv = "trios-csv",
        TriosJson = "trios-json",
        RheoCompass = "rheocompass",
        Reptate = "reptate",
        Eplexor = "eplexor",
        Hysitron = "hysitron",
    }
}

/// What files hold.
#[derive(Debug, Clone, PartialEq)]
pub struct DynamicFile {
    pub data: DynamicData,
    /// Of the first file.
    pub format: DynamicFormat,
    /// Hz where all frequencies are in it.
    pub frequency_unit: FrequencyUnit,
    /// What was found, read, assumed and passed over, a line each.
    pub notes: Vec<String>,
}

/// Reads files as the isotherms of one specimen.
///
/// # Errors
/// A file cannot be read, or [`from_files`] refuses them.
pub fn read(
    files: &[PathBuf],
    format: Option<DynamicFormat>,
    kind: ModulusKind,
) -> Result<DynamicFile, Diagnostics> {
    let contents = files
        .iter()
        .map(|path| data_file::contents(path, MAX_BYTES));
    from_files(&contents.collect::<Result<Vec<_>, _>>()?, format, kind)
}

/// As [`read`], from the bytes of a file that messages call `name`.
///
/// # Errors
/// See [`from_files`].
pub fn from_bytes(
    name: &str,
    bytes: &[u8],
    format: Option<DynamicFormat>,
    kind: ModulusKind,
) -> Result<DynamicFile, Diagnostics> {
    from_files(&[(name.to_owned(), bytes.to_vec())], format, kind)
}

/// As [`read`], from names and bytes.
///
/// # Errors
/// No file; what is too large, binary or of an unknown format; columns that are absent, without a unit or of the other modulus; cells
/// that are no positive numbers; temperatures that make no isotherms.
pub fn from_files(
    files: &[(String, Vec<u8>)],
    format: Option<DynamicFormat>,
    kind: ModulusKind,
) -> Result<DynamicFile, Diagnostics> {
    let mut reading = Reading {
        kind,
        isotherms: Vec::new(),
        notes: Vec::new(),
        is_in_hertz: true,
        prefix: String::new(),
        missing: 0,
        noise: None,
    };
    let mut first = None;
    for (name, bytes) in files {
        if files.len() > 1 {
            reading.prefix = format!("{name}: ");
        }
        let found = one_file(name, bytes, format, &mut reading)?;
        first.get_or_insert(found);
    }
    let Some(format) = first else {
        return Err(Diagnostic::new("no file of dynamic data is named")
            .help("name at least one")
            .into());
    };
    let frequency_unit = match reading.is_in_hertz {
        true => FrequencyUnit::Hz,
        false => FrequencyUnit::RadPerS,
    };
    let (data, notes) = reading.finish(files)?;
    Ok(DynamicFile {
        data,
        format,
        frequency_unit,
        notes,
    })
}

fn one_file(
    name: &str,
    bytes: &[u8],
    format: Option<DynamicFormat>,
    reading: &mut Reading,
) -> Result<DynamicFormat, Diagnostics> {
    data_file::within(name, bytes, MAX_BYTES, FEWER)?;
    if name.to_lowercase().ends_with(".tri") {
        return Err(binary_trios(name).into());
    }
    if format == Some(DynamicFormat::Eplexor) || (format.is_none() && is_workbook(bytes)) {
        let reason = format.map_or("a workbook", |_| "as asked for");
        reading.note(format!("format eplexor: {reason}"));
        eplexor::read(name, bytes, reading)?;
        return Ok(DynamicFormat::Eplexor);
    }
    if format == Some(DynamicFormat::TriosJson) || (format.is_none() && trios_json::is_it(bytes)) {
        let reason = format.map_or("a JSON export of TRIOS", |_| "as asked for");
        reading.note(format!("format trios-json: {reason}"));
        eplexor::read_sheets(name, &trios_json::sheets(name, bytes)?, reading)?;
        return Ok(DynamicFormat::TriosJson);
    }
    let source = text(name, bytes, reading)?;
    let is_it = |known: &Format| match format {
        Some(format) => (known.format == format).then(|| "as asked for".to_owned()),
        None => (known.mark)(&source),
    };
    let mut known = formats::OF_TEXTS.iter();
    let found = known.find_map(|known| Some((*known, is_it(known)?)));
    let (known, reason) = found.unwrap_or((&formats::NAMED_COLUMNS, String::new()));
    reading.note(format!("format {}: {reason}", known.format.name()));
    (known.read)(&source, reading)?;
    Ok(known.format)
}

/// The text of a file, unless it is known to hold none that can be read.
fn text(name: &str, bytes: &[u8], reading: &mut Reading) -> Result<Arc<Source>, Diagnostics> {
    if is_workbook(bytes) {
        return Err(
            Diagnostic::new(format!("`{name}` is a workbook, and a text was asked for"))
                .help("leave the format out, to have it found, or write \"eplexor\"")
                .into(),
        );
    }
    let (source, stray) = grid::source(name, bytes)?;
    // Text in UTF-16 holds no zeros any more.
    if source.text().contains('\0') {
        return Err(binary_trios(name).into());
    }
    if stray > 0 {
        let bytes = if stray == 1 { "byte is" } else { "bytes are" };
        reading.note(format!("{stray} {bytes} no UTF-8, and taken as Latin-1"));
    }
    if source.text().trim_start().starts_with(['{', '<']) {
        return Err(Diagnostic::at(
            &grid::Grid::new(&source, ',').place(0),
            "JSON and XML of other programs than TRIOS are not read",
        )
        .help("export a table as text or CSV; of TRIOS: JSON, `Export to LIMS`, or CSV")
        .into());
    }
    Ok(source)
}

fn binary_trios(name: &str) -> Diagnostic {
    Diagnostic::new(format!("`{name}` is binary, and its moduli cannot be read"))
        .help("export it as text or CSV; of a `.tri` file, in TRIOS: File, Export, as CSV, as text or to LIMS")
}

/// What was read so far.
struct Reading {
    kind: ModulusKind,
    isotherms: Vec<Vec<Measured>>,
    notes: Vec<String>,
    /// Whether the frequencies of all blocks are.
    is_in_hertz: bool,
    /// Before notes, where there are several files.
    prefix: String,
    missing: usize,
    /// Rows of instruments in which a value is not positive: the first, and how many.
    noise: Option<(Location, usize)>,
}

impl Reading {
    /// Says how many rows were passed over, and why.
    fn note_rows(&mut self, count: usize, why: &str) {
        let s = if count == 1 { "" } else { "s" };
        self.note(format!("{count} row{s} passed over: {why}"));
    }

    /// Says something of the file, once.
    fn note(&mut self, text: impl Into<String>) {
        let note = format!("{}{}", self.prefix, text.into());
        if !self.notes.contains(&note) && self.notes.len() < 200 {
            self.notes.push(note);
        }
    }

    /// Reads a block and adds its isotherms.
    fn add(&mut self, block: &Block<'_>) -> Result<(), Diagnostics> {
        let content = block.read(self.kind)?;
        self.add_content(block, content)
    }

    /// Adds the isotherms of a block that was read.
    fn add_content(&mut self, block: &Block<'_>, content: Content) -> Result<(), Diagnostics> {
        for note in content.notes {
            self.note(note);
        }
        self.is_in_hertz &= content.is_in_hertz;
        self.missing += content.missing;
        if let Some((first, count)) = content.noise {
            self.noise.get_or_insert((first, 0)).1 += count;
        }
        self.isotherms
            .extend(isotherms::split(block, content.points)?);
        Ok(())
    }

    fn finish(
        mut self,
        files: &[(String, Vec<u8>)],
    ) -> Result<(DynamicData, Vec<String>), Diagnostics> {
        self.prefix.clear();
        if self.missing > 0 {
            self.note_rows(self.missing, "a number is empty or marked as missing");
        }
        if let Some((first, count)) = self.noise.take() {
            let why = "a value is not positive, which is noise";
            self.note_rows(count, &format!("{why} (first in {})", first.line()));
        }
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        let whole = Source::file(names.join("`, `"), "");
        let whole = Location::whole(&whole);
        let points = |set: &Vec<Measured>| set.iter().map(|measured| measured.point).collect();
        let sets = self.isotherms.iter().map(points).collect();
        let data = DynamicData::new(self.kind, sets)
            .map_err(|error| refused(&error, &self.isotherms, &whole))?;
        let mut isotherms = data.isotherms().iter();
        let has_none = isotherms.all(|isotherm| isotherm.temperature_k.is_none());
        if files.len() > 1 && has_none {
            return Err(
                Diagnostic::at(&whole, "several files, and none says its temperature")
                    .help("add a column `temperature_c` to each, or name one file")
                    .into(),
            );
        }
        let steps = self.isotherms.iter().filter(|set| !set.is_empty()).count();
        if steps > 1 && has_none {
            self.note(format!(
                "{steps} tables without a temperature, taken for one isotherm"
            ));
        }
        self.note(summary(&data));
        Ok((data, self.notes))
    }
}

/// What the material room refuses, at its place in the file.
fn refused(error: &DynamicDataError, isotherms: &[Vec<Measured>], whole: &Location) -> Diagnostic {
    let place = |point: usize| {
        let measured = isotherms.iter().flatten().nth(point);
        measured.map_or_else(|| whole.clone(), |measured| measured.place.clone())
    };
    let (place, help) = match error {
        DynamicDataError::NotPositive { point, .. } => {
            (place(*point), "leave the row out, or check its units")
        }
        DynamicDataError::SomeTemperatures { point } => (
            place(*point),
            "give every row a temperature, or leave the temperatures out",
        ),
        _ => (
            whole.clone(),
            "measure at more frequencies, or name further files",
        ),
    };
    Diagnostic::at(&place, error.to_string()).help(help)
}

fn summary(data: &DynamicData) -> String {
    let isotherms = data.isotherms();
    let points = data.points().count();
    let ends = isotherms.first().zip(isotherms.last());
    let ends = ends.and_then(|(first, last)| first.temperature_k.zip(last.temperature_k));
    match ends {
        Some((first, _)) if isotherms.len() == 1 => {
            format!("{points} points at {}", celsius(first))
        }
        Some((first, last)) => format!(
            "{points} points in {} isotherms from {} to {}",
            isotherms.len(),
            celsius(first),
            celsius(last)
        ),
        None => format!("{points} points without a temperature"),
    }
}

#[cfg(test)]
mod tests;
mod trios_json;
#[cfg(test)]
mod workbook;
