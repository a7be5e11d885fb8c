//! Text and CSV that RheoCompass (Anton Paar) exports: after files and readers in public repositories.
//!
//! UTF-16 with a byte order mark, or UTF-8; cells are separated by tabs, or by commas or semicolons. `Project:`, `Test:`, `Result:` and
//! `Interval and data points:`, the number of the interval and that of its points. Then the names, behind the label `Interval data:`; an
//! empty row; units in brackets, `[rad/s]`; rows that begin with an empty cell and the number of the point. Some exports hold only the
//! names. Names and labels are in the language of the program, and numbers have its decimal sign. `[mPa]` is a thousandth of a pascal.
//! A point that the program takes for invalid has no number.

use std::cmp::Reverse;
use std::sync::Arc;

use super::block::Block;
use super::{Reading, steps};
use crate::input::data_file::Column;
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostics, Source};

/// The column that numbers the points.
#[rustfmt::skip]
const NUMBER_OF_POINT: Column =
    Column::pure(&["point_no", "meas_pts", "messpunkt", "punkt_nr", "mess_pkt", "nr", "no"], "numbers of points");

/// Why a text is taken for this format.
pub(super) fn mark(source: &Arc<Source>) -> Option<String> {
    let labels = [
        "Interval and data points:",
        "Interval data:",
        "Intervall und Messpunkte",
        "Intervalldaten",
    ];
    let label = labels.iter().find(|label| source.text().contains(*label));
    label
        .map(|label| format!("the label `{label}`"))
        .or_else(|| {
            let grid = Grid::new(source, '\t');
            let has_units = (1..grid.len().min(60)).any(|line| is_header(&grid, line - 1));
            has_units.then(|| "a row of units in brackets below the names".to_owned())
        })
}

/// Reads the frequency sweeps.
///
/// # Errors
/// No names with units in brackets below them, or what [`steps::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let cut = Grid::every(source).filter(|grid| grid.delimiter() != ' ');
    let cut = cut.map(|grid| {
        let headers = (0..grid.len()).filter(|line| is_header(&grid, *line));
        let headers: Vec<usize> = headers.collect();
        (grid, headers)
    });
    let best = cut.min_by_key(|(_, headers)| Reverse(headers.len()));
    let (grid, headers) = best.unwrap_or_else(|| (Grid::new(source, '\t'), Vec::new()));
    let ends = headers.iter().skip(1).copied().chain([grid.len()]);
    let blocks: Vec<Block<'_>> = headers
        .iter()
        .zip(ends)
        .map(|(header, end)| interval(&grid, *header, end, reading))
        .collect();
    let none = [
        "not an export of RheoCompass: no names with units in brackets below them",
        "export with names and units, or leave the format out, to have it found",
    ];
    steps::read(&grid, &blocks, none, reading)
}

/// Whether a line holds names, that is, the next one units in brackets.
fn is_header(grid: &Grid, line: usize) -> bool {
    let units = grid.line(line + 1);
    let filled = || units.texts().filter(|text| !text.is_empty());
    let is_bracketed = |text: &str| text.starts_with('[') && text.ends_with(']');
    filled().count() >= 2 && filled().all(is_bracketed) && grid.line(line).len() >= 2
}

fn interval<'a>(grid: &'a Grid, header: usize, next: usize, reading: &mut Reading) -> Block<'a> {
    let mut block = Block::new(grid, header, next).of_step(name(grid, header));
    let section = &mut block.section;
    section.units = Some(grid.line(header + 1));
    // Behind the rows stands the label of another part.
    let is_label = |line: &usize| {
        let cells = grid.line(*line);
        let first = cells.text(0);
        let is_text = first.parse::<f64>().is_err() && !first.is_empty();
        first.ends_with(':') || (is_text && cells.len() == 1)
    };
    let first = (header + 2).min(next);
    section.rows = first..(first..next).find(is_label).unwrap_or(next);
    // Where points are numbered, one without a number is invalid.
    let is_number = |cell| NUMBER_OF_POINT.is_named(cell);
    let number = section.header.texts().position(is_number);
    if let Some(place) = number {
        let columns = section.header.len();
        let is_invalid = |line: &usize| !grid.line(*line).aligned(columns).is_number(place);
        let invalid: Vec<usize> = section.rows.clone().filter(is_invalid).collect();
        if !invalid.is_empty() && invalid.len() < section.rows.len() {
            reading.note(format!(
                "{} points passed over: their number says that they are invalid",
                invalid.len()
            ));
            section.skipped = invalid;
        }
    }
    block
}

/// What `Result:` or `Test:` above the header says.
fn name(grid: &Grid, header: usize) -> Option<&str> {
    let above = (header.saturating_sub(12)..header)
        .rev()
        .map(|line| grid.line(line));
    let mut labels = above.take_while(|line| line.text(0).ends_with(':'));
    let label = labels.find(|line| ["Result:", "Ergebnis:", "Test:"].contains(&line.text(0)))?;
    Some(label.text(1))
}
