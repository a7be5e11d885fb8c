//! Text and CSV that RheoCompass (Anton Paar) exports: after files and readers in public repositories.
//!
//! UTF-16 with a byte order mark, or UTF-8; cells are separated by tabs, or by commas or semicolons. `Project:`, `Test:`, `Result:` and
//! `Interval and data points:`, the number of the interval and that of its points. Then the names, behind the label `Interval data:`; an
//! empty row; units in brackets, `[rad/s]`; rows that begin with an empty cell and the number of the point. Some exports hold only the
//! names. Names and labels are in the language of the program, and numbers have its decimal sign. `[mPa]` is a thousandth of a pascal.
//! A point that the program takes for invalid has no number.

use std::sync::Arc;

use super::block::{self, Block};
use super::{Reading, steps};
use crate::input::data_file::grid::{Grid, Line};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
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
    let grids: Vec<Grid> = Grid::every(source)
        .filter(|grid| grid.delimiter() != ' ')
        .collect();
    let headers = |grid: &Grid| -> Vec<usize> {
        (0..grid.len())
            .filter(|line| is_header(grid, *line))
            .collect()
    };
    let best = grids
        .iter()
        .map(|grid| (grid, headers(grid)))
        .rev()
        .max_by_key(|(_, headers)| headers.len());
    let Some((grid, headers)) = best.filter(|(_, headers)| !headers.is_empty()) else {
        let place = Grid::new(source, '\t').place(0);
        return Err(Diagnostic::at(
            &place,
            "not an export of RheoCompass: no names with units in brackets below them",
        )
        .help("export with names and units, or leave the format out, to have it found")
        .into());
    };
    let ends = headers.iter().skip(1).copied().chain([grid.len()]);
    let blocks = headers
        .iter()
        .zip(ends)
        .map(|(header, end)| interval(grid, *header, end, reading))
        .collect();
    steps::read(grid, blocks, reading)
}

/// Whether a line holds names, that is, the next one units in brackets.
fn is_header(grid: &Grid, line: usize) -> bool {
    let units = grid.line(line + 1);
    let filled = || units.texts().filter(|text| !text.is_empty());
    let is_bracketed = |text: &str| text.starts_with('[') && text.ends_with(']');
    filled().count() >= 2 && filled().all(is_bracketed) && grid.line(line).len() >= 2
}

fn interval<'a>(grid: &'a Grid, header: usize, next: usize, reading: &mut Reading) -> Block<'a> {
    let mut block = Block::new(grid, header, next).by_instrument();
    block.units = Some(grid.line(header + 1));
    // Behind the rows stands the label of another part.
    let is_label = |line: &usize| {
        let first = grid.line(*line);
        first.text(0).ends_with(':')
            || first.text(0).parse::<f64>().is_err()
                && !first.text(0).is_empty()
                && first.len() == 1
    };
    let first = header + 2;
    let end = (first..next).find(is_label).unwrap_or(next);
    block.rows = first.min(end)..end;
    block.name = name(grid, header);
    block.temperature_k = block.name.as_deref().and_then(steps::temperature_in);
    block.skipped = invalid(grid, &block);
    if !block.skipped.is_empty() {
        reading.note(format!(
            "{} points passed over: their number says that they are invalid",
            block.skipped.len()
        ));
    }
    block
}

/// What `Result:` or `Test:` above the header says.
fn name(grid: &Grid, header: usize) -> Option<String> {
    let above = (header.saturating_sub(12)..header)
        .rev()
        .map(|line| grid.line(line));
    let mut labels: Vec<Line<'_>> = above
        .take_while(|line| line.text(0).ends_with(':'))
        .collect();
    labels.retain(|line| ["Result:", "Ergebnis:", "Test:"].contains(&line.text(0)));
    labels.first().map(|line| line.text(1).to_owned())
}

/// Rows whose point has no number, where points are numbered.
fn invalid(grid: &Grid, block: &Block<'_>) -> Vec<usize> {
    let names = [
        "point no.",
        "point no",
        "meas. pts.",
        "messpunkt",
        "punkt nr.",
        "mess-pkt.",
        "nr.",
        "no.",
    ];
    let place = block
        .header
        .texts()
        .position(|text| names.contains(&text.to_lowercase().as_str()));
    let Some(place) = place else {
        return Vec::new();
    };
    let is_valid =
        |line: &usize| block::aligned(grid.line(*line), block.header.len()).is_number(place);
    if !block.rows.clone().any(|line| is_valid(&line)) {
        return Vec::new();
    }
    block.rows.clone().filter(|line| !is_valid(line)).collect()
}
