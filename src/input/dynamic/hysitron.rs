//! Dynamic text of Hysitron's TriboScan (Bruker, nanoDMA files `*_DYN.txt`): after readers in public repositories.
//!
//! Some lines of text, then a row of names with units, `Test Time (s)`, `Indent Disp. (nm)`, `Indent Act. Load (µN)`,
//! `Storage Mod. (GPa)`, `Loss Mod. (GPa)`, `Tan-Delta`, with a frequency among them; tabs separate cells, texts are Latin-1. The row of names is searched for. No temperature.

use std::sync::Arc;

use super::{Reading, generic};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let is_names = |line: &str| {
        line.contains("Test Time (s)") || (line.contains("Indent ") && line.contains("Storage Mod"))
    };
    let is_there = source.text().lines().take(300).any(is_names);
    is_there.then(|| "the column `Test Time (s)` or `Indent Disp. (nm)`".to_owned())
}

/// Reads the sweep.
///
/// # Errors
/// No row of names, no frequency, or what [`super::block::Block::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let Some((grid, header)) = generic::header(source) else {
        let grid = Grid::new(source, '\t');
        let names = (0..grid.len().min(300)).find(|line| grid.text(*line).contains("Mod. (GPa)"));
        return Err(Diagnostic::at(
            &grid.place(names.unwrap_or(0)),
            "no row of names with a frequency, `Storage Mod. (GPa)` and `Loss Mod. (GPa)`",
        )
        .help("export the frequency of the test with the dynamic data")
        .into());
    };
    reading.note("moduli as the instrument computed them from the contact");
    for block in generic::blocks(&grid, header) {
        let block = block.by_instrument();
        let content = block.read(reading.kind)?;
        reading.add_content(&block, content)?;
    }
    Ok(())
}
