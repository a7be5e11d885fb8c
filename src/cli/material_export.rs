//! `contact-dma material export`: a material as input of a finite element program.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::TypedValueParser;
use serde_json::json;

use super::failure::{Ended, Failure};
use super::flags::named;
use super::material_show::load;
use super::output::{OutputFormat, print, print_json, write_out};
use crate::material::export::{self, Export, Program};
use crate::report::text::Text;
use crate::sweep::store::write_atomically;

#[derive(Debug, Args)]
pub(super) struct ExportFlags {
    /// A name of the library, or a file with a [material] block; - reads standard input
    material: String,
    /// The program
    #[arg(long = "to", value_name = "PROGRAM", value_parser = program())]
    program: Program,
    /// The file to write; links are followed, and devices and pipes written to [default: standard output]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace a file that this command has not written
    #[arg(long, requires = "out")]
    force: bool,
}

/// One of the programs that a material is written for.
fn program() -> impl TypedValueParser<Value = Program> {
    named(Program::ALL.map(|program| {
        let help = match program {
            Program::Abaqus => "*ELASTIC, *VISCOELASTIC, TIME=PRONY, *TRS",
            Program::Ansys => "TB,PRONY in shear and bulk, TB,SHIFT",
            Program::LsDyna => "*MAT_GENERAL_VISCOELASTIC (076)",
            Program::Comsol => "Table of branches of the Viscoelasticity node",
            Program::Csv => "Columns modulus_pa, time_s; the equilibrium modulus first",
        };
        (program, program.name(), help)
    }))
}

/// Runs the command.
pub(super) fn run(flags: &ExportFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let (material, _, reads) = load(&flags.material)?;
    let program = flags.program;
    let export = export::export(&material, material.origin.shift.as_ref(), program)
        .map_err(Failure::input)?;
    if let Some(file) = &flags.out {
        write_to(file, &export.text, flags.force, &reads)?;
    }
    match (format, &flags.out) {
        (OutputFormat::Json, _) => print_json(&json!({
            "program": program.name(),
            "file": flags.out,
            "text": export.text,
            "conversion_error": export.conversion_error,
            "lowest_angular_frequency_rad_per_s": export.band_rad_per_s.0,
            "highest_angular_frequency_rad_per_s": export.band_rad_per_s.1,
            "remarks": export.remarks,
        })),
        (OutputFormat::Text, Some(file)) => {
            let mut text = Text::from(format!("{}: {}", program.title(), file.display()));
            text.append(unwritten(program, &export));
            print(&text)
        }
        (OutputFormat::Text, None) => {
            // The text may be on its way into a file; what is to be known of it is for the reader at the terminal.
            let _ = write!(anstream::stderr(), "{}", unwritten(program, &export));
            write_out(&export.text)
        }
    }
}

/// Writes a file: into what a link names, and to a device or pipe as it is.
fn write_to(path: &Path, text: &str, force: bool, reads: &[PathBuf]) -> Result<(), Failure> {
    let name = path.display();
    let Ok(target) = path.canonicalize() else {
        // There is none yet; a link to nothing makes what it names.
        return match path.is_symlink() {
            true => written(path, fs::write(path, text)),
            false => Ok(write_atomically(path, text.as_bytes())?),
        };
    };
    if !target.is_file() {
        let opened = File::options().write(true).open(&target);
        return written(
            path,
            opened.and_then(|mut file| file.write_all(text.as_bytes())),
        );
    }
    let is_read = |read: &&PathBuf| read.canonicalize().is_ok_and(|read| read == target);
    if let Some(read) = reads.iter().find(is_read) {
        return Err(Failure::Input(format!(
            "{name} would be written over {}, which is read; name another file with --out",
            read.display()
        )));
    }
    if !force && !is_export(&target) {
        return Err(Failure::Input(format!(
            "{name} is there, and was not written by this command; name another file with --out, or replace it with --force"
        )));
    }
    Ok(write_atomically(&target, text.as_bytes())?)
}

/// Whether a file is one that this command has written: it says so in a comment on one of its first lines.
fn is_export(path: &Path) -> bool {
    let text = fs::read(path).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    text.is_empty()
        || text
            .lines()
            .take(3)
            .any(|line| line.contains("written by contact-dma"))
}

fn written(path: &Path, result: io::Result<()>) -> Result<(), Failure> {
    result.map_err(|error| Failure::run(format!("cannot write {}: {error}", path.display())))
}

/// What the text does not say itself: of CSV, which has no comments, all; of the others the last alone, how exact the digits are.
fn unwritten(program: Program, export: &Export) -> Text {
    let said = match program {
        Program::Csv => 0,
        _ => export.remarks.len().saturating_sub(1),
    };
    let mut text = Text::default();
    for remark in export.remarks.iter().skip(said) {
        text.indented(remark, "    ", "    ");
    }
    text
}
