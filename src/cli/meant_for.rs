//! Sweeps given to `simulate`, scenarios given to `sweep`, and files that are both: one sentence instead of a list of keys that
//! do not fit.

use std::path::Path;

use super::documents::open_document;
use super::failure::Failure;
use crate::drive::segments::SEGMENTS;
use crate::input::diagnostic::Problems;
use crate::input::document::Document;
use crate::input::keys;

/// A kind of file by the command that takes it, and how it is known.
#[derive(PartialEq)]
pub(super) struct Kind {
    command: &'static str,
    known_by: &'static str,
}

pub(super) const SWEEP: Kind = Kind {
    command: "sweep",
    known_by: "a sweep: it has a table [sweep]",
};
pub(super) const SCENARIO: Kind = Kind {
    command: "simulate",
    known_by: "a scenario: its [drive] has segments",
};
pub(super) const IDENTIFICATION: Kind = Kind {
    command: "identify",
    known_by: "an identification: it has a table [identify]",
};

/// The file as changed by the `--set` flags, where it is of the kind that the command takes.
pub(super) fn open(wanted: &Kind, file: &Path, set: &[String]) -> Result<Document, Failure> {
    let document = open_document(file, set)?;
    refuse_other(wanted, &document, file)?;
    Ok(document)
}

fn refuse_other(wanted: &Kind, document: &Document, file: &Path) -> Result<(), Failure> {
    // What is wrong with the file is told when it is read in earnest.
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let (has_sweep, has_data) = (root.has(&keys::SWEEP), root.has(&keys::identify::IDENTIFY));
    let has_segments = root.has(&keys::HISTORY)
        && (root.table(&keys::HISTORY)).is_some_and(|mut drive| drive.has(&SEGMENTS));
    let is_identification = has_data && (!has_sweep || *wanted == IDENTIFICATION);
    let file = file.display();
    let kind = match (has_sweep, has_segments) {
        _ if is_identification => IDENTIFICATION,
        (true, true) if *wanted != IDENTIFICATION => {
            return Err(Failure::Input(format!(
                "{file} has segments in [drive], which are a scenario, beside a table [sweep]\n\
                 = help: for one history leave out [sweep] and [cycle] and run `contact-dma simulate {file}`;\n\
                 \x20       for a sweep give [drive] a mean and an amplitude in place of segments and run `contact-dma sweep {file}`"
            )));
        }
        (true, false) => SWEEP,
        (false, true) => SCENARIO,
        _ => return Ok(()),
    };
    match kind == *wanted {
        true => Ok(()),
        false => Err(Failure::Input(format!(
            "{file} is {}; run `contact-dma {} {file}`",
            kind.known_by, kind.command
        ))),
    }
}
