//! Tables of shift factors: `T,log_aT` with a row of units, as pyvisco has them, and `temperature_c,log10_a_t`, as this program writes
//! them; further columns are passed over.

use std::path::Path;

use super::columns::TEMPERATURE;
use crate::input::data_file::column::Column;
use crate::input::data_file::grid::{self, Grid};
use crate::input::data_file::section::Section;
use crate::input::data_file::{self, Holes};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Problems};
use crate::quantity::ZERO_CELSIUS_K;

/// Names of decadic logarithms of shift factors.
#[rustfmt::skip]
const FACTORS: [&str; 6] = ["log_at", "log10_a_t", "log10_at", "log(at)", "log10(at)", "log_a_t"];

/// Temperatures and shift factors.
const COLUMNS: [Column; 2] = [TEMPERATURE, Column::pure(&FACTORS, "shift factors")];

/// Temperatures (K) and decadic logarithms of the shift factors, in the order of the file.
///
/// # Errors
/// The file cannot be read, or [`shift_factors_from_bytes`] refuses it.
pub fn read_shift_factors(path: &Path) -> Result<Vec<(f64, f64)>, Diagnostics> {
    let (name, bytes) = data_file::contents(path, super::MAX_BYTES)?;
    shift_factors_from_bytes(&name, &bytes)
}

/// As [`read_shift_factors`], from the bytes of a file that messages call `name`.
///
/// # Errors
/// No such columns, cells that are no numbers, temperatures not above absolute zero.
pub fn shift_factors_from_bytes(name: &str, bytes: &[u8]) -> Result<Vec<(f64, f64)>, Diagnostics> {
    data_file::within(name, bytes, super::MAX_BYTES, super::FEWER)?;
    let (source, _) = grid::source(name, bytes)?;
    let found = Grid::best(&source, |grid, line| {
        let header = grid.header(line);
        COLUMNS.iter().all(|of| of.is_in(&header)).then_some(())
    });
    let Some((grid, header)) = found else {
        let place = Grid::new(&source, ',').place(0);
        let help =
            "begin it with `temperature_c,log10_a_t`, or with `T,log_aT` and a row of units `C,-`";
        return Err(Diagnostic::at(&place, "no table of shift factors")
            .help(help)
            .into());
    };
    let mut section = Section::of(&grid, header, &COLUMNS);
    section.by_instrument = true;
    let help = "write it as `-1.5`, or leave the whole row out";
    let table = section.table(&COLUMNS, Holes::Refused, help)?;
    let problems = Problems::new();
    let rows = table.values.chunks_exact(2);
    let pairs: Vec<(f64, f64)> = rows.map(|row| (row[0], row[1])).collect();
    for row in (0..pairs.len()).filter(|row| pairs[*row].0 <= 0.0) {
        let message = format!("the temperature must be above {} °C", -ZERO_CELSIUS_K);
        let report = problems.at(&table.cell(row, 0), message);
        report.help("check the unit of the temperatures");
    }
    if pairs.is_empty() && problems.is_empty() {
        let message = "the table of shift factors has no rows";
        let report = problems.at(&grid.place(header), message);
        report.help("give one row per temperature");
    }
    problems.into_result(Some(pairs))
}
