//! `contact-dma material export`: a material as input of a finite element program.

use std::io::Write;

use serde_json::json;

use super::arguments::{ExportFlags, OutputFormat};
use super::{Ended, Failure, json, material, print, write_out};
use crate::material::export::{self, Export};
use crate::report::words::wrapped;
use crate::sweep::store::write_atomically;

/// Runs the command.
pub(super) fn run(flags: &ExportFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let (material, _) = material::load(&flags.material)?;
    let program = flags.program;
    let export = export::export(&material, material.shift(), program).map_err(Failure::input)?;
    if let Some(file) = &flags.out {
        write_atomically(file, export.text.as_bytes()).map_err(Failure::run)?;
    }
    match (format, &flags.out) {
        (OutputFormat::Json, _) => json::print(&json!({
            "program": program.name(),
            "file": flags.out,
            "text": export.text,
            "conversion_error": export.conversion_error,
            "lowest_angular_frequency_rad_per_s": export.band_rad_per_s.0,
            "highest_angular_frequency_rad_per_s": export.band_rad_per_s.1,
            "remarks": export.remarks,
        })),
        (OutputFormat::Text, Some(file)) => print(&format!(
            "{}: {}\n{}",
            program.title(),
            file.display(),
            remarks(&export)
        )),
        (OutputFormat::Text, None) => {
            // The text may be on its way into a file; what is to be known of it is for the reader at the terminal.
            let _ = write!(anstream::stderr(), "{}", remarks(&export));
            write_out(&export.text)
        }
    }
}

fn remarks(export: &Export) -> String {
    let paragraphs = export.remarks.iter();
    paragraphs
        .map(|remark| wrapped(remark, 76, "    ", "    "))
        .collect()
}
