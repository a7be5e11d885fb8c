//! Folders that commands write: where they are, and the figures in them.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::documents::STANDARD_INPUT;
use super::failure::Failure;
use super::flags::RunFlags;
use super::output::warn;
use super::progress;
use crate::input::document::Document;
use crate::report::ReportError;
use crate::report::caption::Setting;
use crate::report::figure::Figure;
use crate::report::figure::press::{Files, Press};
use crate::report::page::Pictures;
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::store::Store;
use crate::sweep::store::manifest::Target;

/// The folder for the results of a file: the one asked for, or `reports/<name of the file>`; of standard input, `reports/stdin`.
pub(super) fn folder_of(flags: &RunFlags) -> PathBuf {
    let stem = match flags.file == Path::new(STANDARD_INPUT) {
        true => OsStr::new("stdin"),
        false => flags.file.file_stem().unwrap_or_default(),
    };
    let default = || Path::new("reports").join(stem);
    flags.out.clone().unwrap_or_else(default)
}

/// The same, opened for the results of this file.
pub(super) fn open_store(
    flags: &RunFlags,
    document: &Document,
    resolved: &str,
) -> Result<Store, Failure> {
    let (out, reads) = (folder_of(flags), document.files());
    let _opening = progress::opening(&out);
    Ok(Store::open_reading(
        &out,
        resolved,
        flags.work.force,
        &reads,
    )?)
}

/// Writes the files of a result, with these figures and a page, which is made of the pictures and the name of the first one; without
/// figures there is no page.
pub(super) fn write_result<N: Into<String>>(
    target: &Target<'_>,
    result: impl IntoIterator<Item = (N, Vec<u8>)>,
    (figures, setting): (&[Figure], &Setting),
    page: impl FnOnce(&Pictures, &str) -> Result<String, ReportError>,
) -> Result<(), Failure> {
    let (files, pictures) = (Files::default(), Pictures::default());
    for (name, bytes) in result {
        files.insert(name, bytes);
    }
    let write = |name: &str, bytes: &[u8]| {
        files.insert(name, bytes);
        Ok(())
    };
    let press = Press {
        plan: &FigurePlan::default(),
        write: &write,
        pictures: &pictures,
    };
    press.figures(figures, setting)?;
    for reason in pictures.not_drawn() {
        warn(&reason);
    }
    if let Some(first) = figures.first() {
        files.insert("index.html", page(&pictures, first.name)?);
    }
    Ok(target.write(files.into_vec())?)
}

/// The lines that say where the files are; none where none were written.
pub(super) fn in_folder(what: &str, target: Option<&Target<'_>>) -> String {
    target.map_or_else(String::new, |target| {
        format!("\n{what} in {}", target.folder.display())
    })
}
