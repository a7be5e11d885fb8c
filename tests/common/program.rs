//! The program as the tests run it, and files for it.

#![allow(dead_code)] // Each test file uses its own part.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

/// The program, without what the surroundings might ask of it.
pub fn program() -> Command {
    let mut command = Command::cargo_bin("contact-dma").unwrap();
    command.env_remove("CONTACT_DMA_THREADS");
    command.env_remove("COLUMNS");
    command
}

/// For tests that look at no PNG, which takes longer to make than everything else of a small run.
pub const SVG_ALONE: [&str; 2] = ["--set", "figures.formats=['svg']"];

/// Writes a file into a folder, or a folder of that; its path.
pub fn write(folder: impl AsRef<Path>, name: &str, text: &str) -> String {
    let path = folder.as_ref().join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
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
