//! Text that TRIOS (TA Instruments) exports: after public files of the Discovery rheometers (DHR, 2020) and of TRIOS 4.5.
//!
//! Lines `Filename TAB ...`, `Instrument name TAB ...`, `proceduresegments TAB ...`, then `[File Parameters]` and other parts. Every
//! step opens with `[step]` in lower case, then its name, a row of names, a row of units, and rows without a label. Steps of several
//! kinds are in one file: sweeps of frequency and of amplitude, ramps, waveforms.

use std::sync::Arc;

use super::{Reading, steps};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let text = source.text();
    let has_step = text.lines().any(|line| line.trim_end() == "[step]");
    let has_head = text.lines().take(40).any(|line| {
        [
            "Filename\t",
            "proceduresegments\t",
            "[File Parameters]",
            "Instrument name\t",
            "Geometry name\t",
        ]
        .iter()
        .any(|head| line.starts_with(head))
    });
    (has_step && has_head).then(|| "lines `[step]` and a head of TRIOS".to_owned())
}

/// Reads the frequency sweeps.
///
/// # Errors
/// No step, or what [`steps::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let grid = Grid::new(source, '\t');
    let found = steps::bracketed(&grid);
    if found.is_empty() {
        return Err(Diagnostic::at(
            &grid.place(0),
            "not a text of TRIOS: it has no line `[step]`",
        )
        .help("leave the format out, to have it found")
        .into());
    }
    steps::read(&grid, found, reading)
}
