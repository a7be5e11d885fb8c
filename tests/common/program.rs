//! The program as the tests run it, and files for it.

#![allow(dead_code)] // Each test file uses its own part.

use std::fs;

use assert_cmd::Command;
use tempfile::TempDir;

/// The program, without what the surroundings might ask of it.
pub fn program() -> Command {
    let mut command = Command::cargo_bin("contact-dma").unwrap();
    command.env_remove("CONTACT_DMA_THREADS");
    command.env_remove("COLUMNS");
    command
}

/// Writes a file into a folder; its path.
pub fn write(folder: &TempDir, name: &str, text: &str) -> String {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// A sweep file: PMMA under a sphere of 10 mm, 10 N with 5 N about it, and the rest as given, from `[sweep]` on.
pub fn pmma_sweep(rest: &str) -> String {
    let question = r#"title = "PMMA under a sphere"
[material]
library = "pmma"
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
mean = "10 N"
amplitude = "5 N"
"#;
    format!("{question}{rest}")
}
