//! Sweeps given to `simulate`, scenarios given to `sweep`, and files that are both: one sentence instead of a list of keys that
//! do not fit.

use std::path::Path;

use super::Failure;
use crate::input::diagnostic::Problems;
use crate::input::document::Document;
use crate::input::keys;
use crate::input::keys::drive::SEGMENTS;

/// Refuses a scenario, and an identification.
pub(super) fn sweep(document: &Document, file: &Path) -> Result<(), Failure> {
    refuse_identification(document, file)?;
    match (has_sweep(document), has_segments(document)) {
        (false, true) => Err(other(
            file,
            "a scenario: its [drive] has segments",
            "simulate",
        )),
        (true, true) => Err(both(file)),
        (_, false) => Ok(()),
    }
}

/// Refuses a sweep, and an identification.
pub(super) fn simulate(document: &Document, file: &Path) -> Result<(), Failure> {
    refuse_identification(document, file)?;
    match (has_sweep(document), has_segments(document)) {
        (true, false) => Err(other(file, "a sweep: it has a table [sweep]", "sweep")),
        (true, true) => Err(both(file)),
        (false, _) => Ok(()),
    }
}

fn refuse_identification(document: &Document, file: &Path) -> Result<(), Failure> {
    // What is wrong with the file is told when it is read in earnest.
    let has_data = document
        .root(&Problems::new())
        .has(&keys::identify::IDENTIFY);
    match has_data && !has_sweep(document) {
        true => Err(other(
            file,
            "an identification: it has a table [identify]",
            "identify",
        )),
        false => Ok(()),
    }
}

/// Sends a sweep and a scenario to the commands that take them.
pub(super) fn identify(document: &Document, file: &Path) -> Result<(), Failure> {
    if document
        .root(&Problems::new())
        .has(&keys::identify::IDENTIFY)
    {
        return Ok(());
    }
    match (has_sweep(document), has_segments(document)) {
        (true, false) => Err(other(file, "a sweep: it has a table [sweep]", "sweep")),
        (false, true) => Err(other(
            file,
            "a scenario: its [drive] has segments",
            "simulate",
        )),
        _ => Ok(()),
    }
}

fn both(file: &Path) -> Failure {
    let file = file.display();
    Failure::Input(format!(
        "{file} has segments in [drive], which are a scenario, beside a table [sweep]\n\
         = help: for one history leave out [sweep] and [cycle] and run `contact-dma simulate {file}`;\n\
         \x20       for a sweep give [drive] a mean and an amplitude in place of segments and run `contact-dma sweep {file}`"
    ))
}

fn has_sweep(document: &Document) -> bool {
    // What is wrong with the file is told when it is read in earnest.
    document.root(&Problems::new()).has(&keys::SWEEP)
}

fn has_segments(document: &Document) -> bool {
    let problems = Problems::new();
    let mut root = document.root(&problems);
    root.has(&keys::HISTORY)
        && root
            .table(&keys::HISTORY)
            .is_some_and(|mut drive| drive.has(&SEGMENTS))
}

fn other(file: &Path, what: &str, command: &str) -> Failure {
    let file = file.display();
    Failure::Input(format!(
        "{file} is {what}; run `contact-dma {command} {file}`"
    ))
}
