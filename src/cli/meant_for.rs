//! Sweeps given to `simulate`, scenarios given to `sweep`, and files that are both: one sentence instead of a list of keys that
//! do not fit.

use std::path::Path;

use super::Failure;
use crate::input::diagnostic::Problems;
use crate::input::document::Document;
use crate::input::keys;
use crate::input::segments_block::SEGMENTS;

/// A kind of file by the command that takes it, and how it is known.
#[derive(PartialEq)]
struct Kind {
    command: &'static str,
    known_by: &'static str,
}

const SWEEP: Kind = Kind {
    command: "sweep",
    known_by: "a sweep: it has a table [sweep]",
};
const SCENARIO: Kind = Kind {
    command: "simulate",
    known_by: "a scenario: its [drive] has segments",
};
const IDENTIFICATION: Kind = Kind {
    command: "identify",
    known_by: "an identification: it has a table [identify]",
};

/// Refuses a scenario, and an identification.
pub(super) fn sweep(document: &Document, file: &Path) -> Result<(), Failure> {
    refuse_other(&SWEEP, document, file)
}

/// Refuses a sweep, and an identification.
pub(super) fn simulate(document: &Document, file: &Path) -> Result<(), Failure> {
    refuse_other(&SCENARIO, document, file)
}

/// Sends a sweep and a scenario to the commands that take them.
pub(super) fn identify(document: &Document, file: &Path) -> Result<(), Failure> {
    refuse_other(&IDENTIFICATION, document, file)
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
