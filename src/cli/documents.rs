//! Files that commands read: from a path or standard input, and as changed by flags.

use std::io::{self, Read};
use std::path::Path;

use super::failure::Failure;
use crate::input::document::{self, Document, read_limited};

/// The name of standard input in the place of a file.
pub(super) const STANDARD_INPUT: &str = "-";

/// A file, or standard input, from which paths start in the working folder.
pub(super) fn read_document(file: &Path) -> Result<Document, Failure> {
    if file != Path::new(STANDARD_INPUT) {
        return Ok(Document::read(file)?);
    }
    let mut bytes = Vec::new();
    let limit = document::MAX_BYTES as u64 + 1;
    let read = io::stdin().lock().take(limit).read_to_end(&mut bytes);
    read.map_err(|error| Failure::run(format!("cannot read standard input: {error}")))?;
    Ok(Document::from_bytes("standard input", &bytes)?)
}

/// A file as changed by the `--set` flags.
pub(super) fn open_document(file: &Path, assignments: &[String]) -> Result<Document, Failure> {
    let mut document = read_document(file)?;
    for assignment in assignments {
        document.set(assignment)?;
    }
    Ok(document)
}

/// The bytes of a file, at most so many.
pub(super) fn read_bytes(path: &Path, most: usize) -> Result<Vec<u8>, Failure> {
    let name = path.display();
    match read_limited(path, most) {
        Ok(bytes) if bytes.len() <= most => Ok(bytes),
        Ok(_) => Err(Failure::input(format!(
            "{name} is larger than {} MB",
            most / 1_000_000
        ))),
        Err(error) => Err(Failure::input(format!("cannot read {name}: {error}"))),
    }
}
