//! Tables of shift factors: `T,log_aT` with a row of units, as pyvisco has them, and `temperature_c,log10_a_t`, as this program writes
//! them; further columns are passed over.

use std::path::Path;

use super::columns::{self, Role};
use super::units::{self, Scale};
use crate::input::data_file::grid::{self, Cell, Grid, Line};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Problems};
use crate::input::document::{cannot_read, read_limited};
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
    let name = path.display().to_string();
    let bytes = read_limited(path, super::MAX_BYTES).map_err(|error| cannot_read(&name, &error))?;
    shift_factors_from_bytes(&name, &bytes)
}

/// As [`read_shift_factors`], from the bytes of a file that messages call `name`.
///
/// # Errors
/// No such columns, cells that are no numbers, temperatures not above absolute zero.
pub fn shift_factors_from_bytes(name: &str, bytes: &[u8]) -> Result<Vec<(f64, f64)>, Diagnostics> {
    super::within_limit(name, bytes)?;
    let (source, _) = grid::source(name, bytes)?;
    let found = Grid::every(&source).find_map(|grid| {
        let mut lines = 0..grid.len().min(50);
        let (header, places) = lines.find_map(|line| Some((line, places(&grid.line(line))?)))?;
        Some((grid, header, places))
    });
    let Some((grid, header, places)) = found else {
        return Err(Diagnostic::at(
            &Grid::new(&source, ',').place(0),
            "no table of shift factors",
        )
        .help(
            "begin it with `temperature_c,log10_a_t`, or with `T,log_aT` and a row of units `C,-`",
        )
        .into());
    };
    let (names, below) = (grid.line(header), grid.line(header + 1));
    let temperature = places[0];
    let has_units = !places.iter().any(|place| below.is_number(*place));
    let above = columns::recognise(names.text(temperature)).and_then(|named| named.unit);
    let below = if has_units {
        below.text(temperature)
    } else {
        ""
    };
    let unit = above.as_deref().unwrap_or(below);
    let scale = units::scale(Role::Temperature, Some(unit)).map_err(|why| {
        Diagnostic::at(&names.place(temperature), "the temperatures have no unit").help(why)
    })?;
    rows(&grid, header, usize::from(has_units), places, scale)
}

/// The pairs in the rows below the header and its units.
fn rows(
    grid: &Grid,
    header: usize,
    units: usize,
    places: [usize; 2],
    scale: Scale,
) -> Result<Vec<(f64, f64)>, Diagnostics> {
    let (names, problems) = (grid.line(header), Problems::new());
    let mut numbers = grid.numbers(header + 1..grid.len());
    let mut pairs = Vec::new();
    for line in (header + 1 + units..grid.len()).filter(|line| !grid.is_comment(*line)) {
        let row = grid.line(line);
        let read = places.map(|cell| match numbers.read(&row, cell) {
            Cell::Number(number) => Some(number),
            Cell::Missing | Cell::Bad(_) => {
                let message = format!(
                    "a cell of the column `{}` must be a number",
                    names.text(cell)
                );
                problems
                    .at(&row.place(cell), message)
                    .help("write it as `-1.5`, or leave the whole row out");
                None
            }
        });
        if let [Some(temperature), Some(log10_a_t)] = read {
            let temperature_k = scale.zero + scale.factor * temperature;
            if temperature_k <= 0.0 {
                let message = format!("the temperature must be above {} °C", -ZERO_CELSIUS_K);
                problems
                    .at(&row.place(places[0]), message)
                    .help("check the unit of the temperatures");
            }
            pairs.push((temperature_k, log10_a_t));
        }
    }
    numbers.check(&problems);
    if pairs.is_empty() && problems.is_empty() {
        problems
            .at(
                &grid.place(header),
                "the table of shift factors has no rows",
            )
            .help("give one row per temperature");
    }
    problems.into_result(Some(pairs))
}

/// Where temperature and shift factor stand.
fn places(header: &Line<'_>) -> Option<[usize; 2]> {
    let is_temperature =
        |text: &str| columns::recognise(text).is_some_and(|named| named.role == Role::Temperature);
    let temperature = header.texts().position(is_temperature)?;
    let factor = header
        .texts()
        .position(|text| NAMES.contains(&text.to_lowercase().as_str()))?;
    Some([temperature, factor])
}
