//! `contact-dma man`: manual pages.

use std::fs;
use std::path::PathBuf;

use clap::Args;

use super::failure::{Ended, Failure};
use super::flags::folder;
use super::output::print;

#[derive(Debug, Args)]
pub(super) struct ManFlags {
    /// Folder for the pages, which is made where there is none
    #[arg(value_name = "DIR", value_parser = folder())]
    folder: PathBuf,
}

/// Writes a page for the program and for each of its commands.
pub(super) fn run(flags: &ManFlags, program: clap::Command) -> Result<Ended, Failure> {
    let folder = flags.folder.display();
    let failed =
        |error: std::io::Error| Failure::run(format!("cannot write into {folder}: {error}"));
    fs::create_dir_all(&flags.folder).map_err(failed)?;
    clap_mangen::generate_to(program, &flags.folder).map_err(failed)?;
    print(&format!("Pages in {folder}").into())
}
