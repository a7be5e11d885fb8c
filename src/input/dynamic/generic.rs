//! Plain tables of dynamic data.
//!
//! A line of column names, perhaps a row of units below it, rows of numbers. Needed are a frequency (Hz or rad/s) and storage and loss
//! modulus, or a loss tangent in place of the latter; a temperature, the number of the isotherm and errors of both moduli are taken
//! where they are there. Lines above the names are passed over, and the names may stand in a comment, as `numpy.savetxt` writes them.
//! Names repeated further down begin another table.
//!
//! After: tables that users publish beside papers, and those of mastercurves and RHEOS.

use std::cmp::Reverse;
use std::sync::Arc;

use super::Reading;
use super::block::{self, Block};
use crate::input::data_file::grid::{Grid, MOST_LINES_ABOVE};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};

/// Reads every table of the text.
///
/// # Errors
/// No header, or what [`Block::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let Some((grid, first)) = header(source) else {
        return Err(no_header(source).into());
    };
    for block in blocks(&grid, first) {
        reading.add(&block)?;
    }
    Ok(())
}

/// The tables of a text, the first with its header in this line.
pub(super) fn blocks(grid: &Grid, first: usize) -> Vec<Block<'_>> {
    let is_header = |line: &usize| {
        let cells = grid.header(*line);
        !cells.is_number(0) && block::is_dynamic(&block::names(&cells))
    };
    let headers: Vec<usize> = (first..grid.len()).filter(is_header).collect();
    let ends = headers.iter().skip(1).copied().chain([grid.len()]);
    headers
        .iter()
        .zip(ends)
        .map(|(header, end)| Block::new(grid, *header, end))
        .collect()
}

/// The line that names most columns of dynamic data, cut by the delimiter that shows them.
pub(super) fn header(source: &Arc<Source>) -> Option<(Grid, usize)> {
    Grid::best(source, |grid, line| {
        // A line of names with other delimiters is not one of names between blanks.
        if grid.delimiter() == ' ' && grid.text(line).contains([',', ';']) {
            return None;
        }
        let header = grid.header(line);
        let names = block::names(&header);
        // As many names as the rows further down have cells.
        let fits = header.len() == grid.line(line + 2).len();
        block::is_dynamic(&names).then(|| (names.iter().flatten().count(), fits))
    })
}

/// Why a text is no table of dynamic data: by the line that comes closest.
pub(super) fn no_header(source: &Arc<Source>) -> Diagnostic {
    let example = "`frequency_hz,storage_modulus_mpa,loss_modulus_mpa,temperature_c`";
    let found = Grid::every(source).filter_map(|grid| {
        let known = |line: usize| block::names(&grid.header(line)).iter().flatten().count();
        let lines = (0..grid.len().min(MOST_LINES_ABOVE)).map(|line| (known(line), line));
        let (count, line) = lines.min_by_key(|(count, _)| Reverse(*count))?;
        (count > 0).then_some((count, grid, line))
    });
    let closest = found.min_by_key(|(count, _, _)| Reverse(*count));
    let lower = source
        .text()
        .get(..2000)
        .unwrap_or(source.text())
        .to_lowercase();
    let in_time = ["relax", "creep"].iter().any(|word| lower.contains(word));
    let problem = match closest {
        Some((_, grid, line)) => {
            let what = match block::lacking(&block::names(&grid.header(line))) {
                Some([what, _]) => format!("the table has no column of {what}"),
                None => "no header of dynamic data".to_owned(),
            };
            Diagnostic::at(&grid.place(line), what)
        }
        None => Diagnostic::at(
            &Grid::new(source, ',').place(0),
            "no line names the columns of dynamic data",
        ),
    };
    let problem = match lower.contains("log") {
        true => problem.help("write plain values, not their logarithms"),
        false => problem,
    };
    let problem = problem.help(format!(
        "begin the table with a line of column names, such as {example}"
    ));
    match in_time {
        true => problem.help("relaxation and creep over time are read with `--quantity relaxation` and `--quantity creep`"),
        false => problem,
    }
}
