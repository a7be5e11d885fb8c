//! LIMS text that TRIOS (TA Instruments) exports: after the files of 3mcloud/hermes-rheo (`tests/fileio/test_data`, ARES-G2, 2023).
//!
//! The first lines are `[Version]` and `TA Instruments LIMS export format version TAB 0`; parts in brackets follow. Every isotherm is a
//! part `[Step]`: `Step name TAB Frequency sweep (150.0 °C)`, `Number of points TAB 17`, `Variables TAB ...`, `Units TAB ...`, rows
//! `Data point TAB ...`. Units differ between files of one run and are empty for some of the dozens of columns; cells hold status words
//! like `0xB6453`, dates, and texts cut short.

use std::sync::Arc;

use super::block::Block;
use super::{Reading, steps};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let has = |what: &str| {
        source
            .text()
            .lines()
            .take(10)
            .any(|line| line.contains(what))
    };
    has("LIMS export format")
        .then(|| "the line `TA Instruments LIMS export format version`".to_owned())
}

/// Reads the frequency sweeps.
///
/// # Errors
/// No step, fewer points than announced, or what [`steps::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let grid = Grid::new(source, '\t');
    let is_step = |line: &usize| grid.text(*line).trim().eq_ignore_ascii_case("[step]");
    let starts: Vec<usize> = (0..grid.len()).filter(is_step).collect();
    let found: Vec<Block<'_>> = starts
        .into_iter()
        .filter_map(|start| step(&grid, start, reading))
        .collect();
    if found.is_empty() {
        return Err(Diagnostic::at(
            &grid.place(0),
            "not a LIMS text of TRIOS: it has no part `[Step]` with `Variables`",
        )
        .help("leave the format out, to have it found")
        .into());
    }
    steps::read(&grid, found, reading)
}

/// The table of a part.
fn step<'a>(grid: &'a Grid, start: usize, reading: &mut Reading) -> Option<Block<'a>> {
    let end = (start + 1..grid.len())
        .find(|line| grid.text(*line).starts_with('['))
        .unwrap_or(grid.len());
    let labelled = |label: &str| {
        (start + 1..end).find(|line| grid.line(*line).text(0).eq_ignore_ascii_case(label))
    };
    let header = labelled("Variables")?;
    let name = labelled("Step name").map(|line| grid.line(line).text(1).to_owned());
    let rows = labelled("Data point").unwrap_or(end);
    let is_row = |line: &usize| grid.line(*line).text(0).eq_ignore_ascii_case("Data point");
    let last = (rows..end).find(|line| !is_row(line)).unwrap_or(end);
    let announced =
        labelled("Number of points").and_then(|line| grid.line(line).text(1).parse::<usize>().ok());
    if let Some(announced) = announced.filter(|announced| *announced != last - rows) {
        let step = name.as_deref().unwrap_or("without a name");
        reading.note(format!(
            "step `{step}`: {announced} points are announced, and {} are there",
            last - rows
        ));
    }
    let mut step = Block::new(grid, header, end).by_instrument();
    step.units = labelled("Units").map(|line| grid.line(line));
    step.rows = rows..last;
    step.temperature_k = name.as_deref().and_then(steps::temperature_in);
    step.name = name;
    Some(step)
}
