//! Tables of shift factors: `T,log_aT` with a row of units, as pyvisco has them, and `temperature_c,log10_a_t`, as this program writes
//! them; further columns are passed over.

use std::path::Path;

use super::columns::{self, Role};
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
        let line = (0..grid.len().min(50)).find(|line| places(&grid.line(*line)).is_some())?;
        Some((grid, line))
    });
    let Some((grid, header)) = found else {
        return Err(Diagnostic::at(
            &Grid::new(&source, ',').place(0),
            "no table of shift factors",
        )
        .help(
            "begin it with `temperature_c,log10_a_t`, or with `T,log_aT` and a row of units `C,-`",
        )
        .into());
    };
    let names = grid.line(header);
    let Some((temperature, factor)) = places(&names) else {
        return Ok(Vec::new());
    };
    let below = grid.line(header + 1);
    let has_units = !below.is_number(temperature) && !below.is_number(factor);
    let above = columns::recognise(names.text(temperature)).and_then(|named| named.unit);
    let unit = above.unwrap_or_else(|| {
        if has_units {
            below.text(temperature).to_owned()
        } else {
            String::new()
        }
    });
    let scale = columns::scale(Role::Temperature, Some(&unit)).map_err(|why| {
        Diagnostic::at(&names.place(temperature), "the temperatures have no unit").help(why)
    })?;
    let (problems, mut numbers, mut pairs) = (
        Problems::new(),
        grid.numbers(header + 1..grid.len()),
        Vec::new(),
    );
    for line in header + 1 + usize::from(has_units)..grid.len() {
        if grid.is_comment(line) {
            continue;
        }
        let row = grid.line(line);
        let mut number = |cell: usize| match numbers.read(&row, cell) {
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
        };
        let (celsius, factor_of) = (number(temperature), number(factor));
        if let (Some(temperature_c), Some(log)) = (celsius, factor_of) {
            let temperature_k = scale.zero + scale.factor * temperature_c;
            if temperature_k <= 0.0 {
                let message = format!("the temperature must be above {} °C", -ZERO_CELSIUS_K);
                problems
                    .at(&row.place(temperature), message)
                    .help("check the unit of the temperatures");
            }
            pairs.push((temperature_k, log));
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
fn places(header: &Line<'_>) -> Option<(usize, usize)> {
    let is_temperature =
        |text: &str| columns::recognise(text).is_some_and(|named| named.role == Role::Temperature);
    let temperature = header.texts().position(is_temperature)?;
    let factor = header
        .texts()
        .position(|text| NAMES.contains(&text.to_lowercase().as_str()))?;
    Some((temperature, factor))
}
