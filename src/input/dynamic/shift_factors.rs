//! Tables of shift factors: `T,log_aT` with a row of units, as pyvisco has them, and `temperature_c,log10_a_t`, as this program writes
//! them; further columns are passed over.

use std::path::Path;

use super::columns::{self, Role};
use crate::input::data_file::grid::{self, Grid, Line};
use crate::input::data_file::section::{Asked, Section};
use crate::input::data_file::units::Scale;
use crate::input::data_file::{self, Holes};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Problems};
use crate::quantity::ZERO_CELSIUS_K;

/// Names of the shift factors, in lower case.
const NAMES: [&str; 9] = [
    "log_at",
    "log10_a_t",
    "log10_at",
    "log(at)",
    "log10(at)",
    "log at",
    "log a_t",
    "log_a_t",
    "log10 at",
];

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
    let is_header = |grid: &Grid, line| places(&grid.header(line)).map(|_| ());
    let found = Grid::best(&source, is_header);
    let Some((grid, header)) = found else {
        let place = Grid::new(&source, ',').place(0);
        let help =
            "begin it with `temperature_c,log10_a_t`, or with `T,log_aT` and a row of units `C,-`";
        return Err(Diagnostic::at(&place, "no table of shift factors")
            .help(help)
            .into());
    };
    let places = places(&grid.header(header)).unwrap_or_default();
    let end = grid.len();
    let mut section = Section::new(&grid, header, end, |place| places.contains(&place));
    section.by_instrument = true;
    let [temperature, factor] = places;
    let named = columns::recognise(section.header.text(temperature));
    let above = named.and_then(|named| named.unit);
    let scale = section.scale((temperature, "temperatures"), above.as_deref(), |unit| {
        columns::scale(Role::Temperature, unit)
    })?;
    let asked = [(temperature, scale), (factor, Scale::ONE)].map(|(place, scale)| {
        let what = "";
        Some(Asked { place, scale, what })
    });
    let (problems, help) = (
        Problems::new(),
        "write it as `-1.5`, or leave the whole row out",
    );
    let table = section.read(&asked, Holes::Refused, help, &problems);
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

/// Where temperature and shift factor stand.
fn places(header: &Line<'_>) -> Option<[usize; 2]> {
    let is_temperature =
        |text: &str| columns::recognise(text).is_some_and(|named| named.role == Role::Temperature);
    let is_factor = |text: &str| NAMES.contains(&text.to_lowercase().as_str());
    let temperature = header.texts().position(is_temperature)?;
    let factor = header.texts().position(is_factor)?;
    Some([temperature, factor])
}
