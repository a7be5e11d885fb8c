//! CSV that TRIOS (TA Instruments) exports: after descriptions of exports of a DMA 850.
//!
//! Lines `Filename,...`, `rundate,...`, `Geometry name,...`, then steps: `[step]`, the name, names, units, rows. A byte order mark
//! precedes all. Later steps may lack the column Frequency that the first has. The steps `TTS - shift factors` and `TTS - master
//! curve (20.0 °C)` are what TRIOS computed, not data. A name in the head may hold a stray byte, which must not change how the units are read.

use std::sync::Arc;

use super::{Reading, steps};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let is_step = |line: &str| {
        line.trim_matches([',', ';', ' ', '\r', '"'])
            .eq_ignore_ascii_case("[step]")
    };
    let mut lines = source.text().lines();
    let has_tabs = source
        .text()
        .lines()
        .take(40)
        .any(|line| line.contains('\t'));
    (!has_tabs && lines.any(is_step))
        .then(|| "lines `[step]` and cells separated by commas".to_owned())
}

/// Reads the frequency sweeps.
///
/// # Errors
/// No step, or what [`steps::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let semicolons = source
        .text()
        .lines()
        .filter(|line| line.contains(';'))
        .count();
    let commas = source
        .text()
        .lines()
        .filter(|line| line.contains(','))
        .count();
    // Where commas separate decimals, semicolons separate cells.
    let in_table = |grid: &Grid| {
        steps::bracketed(grid)
            .iter()
            .any(|step| step.header.len() > 2)
    };
    let by_semicolon = Grid::new(source, ';');
    let grid = match semicolons > 0 && (commas == 0 || in_table(&by_semicolon)) {
        true => by_semicolon,
        false => Grid::new(source, ','),
    };
    let found = steps::bracketed(&grid);
    if found.is_empty() {
        return Err(Diagnostic::at(
            &grid.place(0),
            "not a CSV of TRIOS: it has no line `[step]`",
        )
        .help("leave the format out, to have it found")
        .into());
    }
    steps::read(&grid, found, reading)
}
