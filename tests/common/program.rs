//! The program as the tests run it, and files for it.

#![allow(dead_code)] // Each test file uses its own part.

use std::fs;

use assert_cmd::Command;
use tempfile::TempDir;

/// The program, without what the surroundings might ask of it.
pub fn program() -> Command {
    let mut command = Command::cargo_bin("contact-dma").unwrap();
    command.env_remove("CONTACT_DMA_THREADS");
    command
}

/// Writes a file into a folder; its path.
pub fn write(folder: &TempDir, name: &str, text: &str) -> String {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}
