//! Files `.osc` and `.tts` of RepTate (jorge-ramirez-upm/RepTate, `data/TTS`, `data/LVE` and its documentation).
//!
//! The first line holds parameters, `T=-10;Mw=94.9;chem=PI;label=...;`, of which `T` is the temperature in °C. In `.osc` a row of
//! names and a row of units follow, `Freq G' G" Temp Strain ...` and `rad/s Pa Pa ...`, with some names more than once; in `.tts`
//! there may be none. The first three columns are angular frequency, G' and G''; in rad/s and Pa where no units are given. Texts are
//! Latin-1, cells are separated by blanks or tabs. A `.tts` file is a master curve, reduced to its `T`.

use std::sync::Arc;

use super::Reading;
use super::block::{Measured, Skipped};
use super::columns::Role;
use super::units::{self, Scale};
use crate::input::data_file::grid::{Cell, Grid, Line, Numbers};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Problems, Source};
use crate::material::ModulusKind;
use crate::material::dynamic::DynamicPoint;

const ROLES: [Role; 3] = [Role::AngularFrequency, Role::Storage, Role::Loss];

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let grid = Grid::new(source, ' ');
    let line = grid.text(0);
    let parts = || {
        line.split(';')
            .map(str::trim)
            .filter(|part| !part.is_empty())
    };
    let is_set = |part: &str| {
        let name = part.split_once('=').map_or("", |(name, _)| name.trim());
        !name.is_empty() && !name.contains([' ', '\t', ','])
    };
    let are_parameters = line.contains(';') && parts().count() > 0 && parts().all(is_set);
    are_parameters.then(|| "a first line of parameters, `T=...;Mw=...;`".to_owned())
}

/// Reads the isotherm.
///
/// # Errors
/// The longitudinal modulus was asked for, a temperature or a cell that is no number, a value that is not positive.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let grid = Grid::new(source, ' ');
    if detect(source).is_none() {
        return Err(Diagnostic::at(
            &grid.place(0),
            "not a file of RepTate: the first line holds no parameters",
        )
        .help("begin it with `T=25;Mw=100;`, or leave the format out, to have it found")
        .into());
    }
    if reading.kind == ModulusKind::Longitudinal {
        return Err(Diagnostic::at(
            &grid.place(0),
            "files of RepTate hold shear moduli, and the longitudinal modulus was asked for",
        )
        .help("write modulus = \"shear\", or give --modulus shear")
        .into());
    }
    let temperature_k = temperature(&grid, reading)?;
    let first = (1..grid.len())
        .find(|line| is_row(&grid.line(*line)))
        .unwrap_or(grid.len());
    let units = (1..first).find_map(|line| scales(&grid.line(line)));
    if units.is_none() {
        reading.note("no row of units: taken in rad/s and Pa");
    }
    let scales = units.unwrap_or(ROLES.map(|_| Scale::ONE));
    reading.note("columns read: the first three, as angular frequency, G' and G''");
    let (problems, mut numbers, mut points) =
        (Problems::new(), grid.numbers(first..grid.len()), Vec::new());
    for line in (first..grid.len()).filter(|line| !grid.is_comment(*line)) {
        let row = grid.line(line);
        match row_values(&row, &mut numbers, &problems, scales) {
            Ok([omega, storage, loss]) => points.push(Measured {
                point: DynamicPoint {
                    temperature_k,
                    angular_frequency_rad_per_s: omega,
                    storage_modulus_pa: storage,
                    loss_modulus_pa: loss,
                    errors_pa: None,
                },
                place: grid.place(line),
                set: None,
            }),
            Err(Skipped::Missing) => reading.count(1, None),
            Err(Skipped::Noise) => reading.count(0, Some((grid.place(line), 1))),
            Err(Skipped::Bad) => {}
        }
    }
    numbers.check(&problems);
    reading.is_in_hertz = false;
    reading.isotherms.push(problems.into_result(Some(points))?);
    Ok(())
}

/// What a parameter is set to.
fn parameter<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    let set = line.split(';').filter_map(|part| part.split_once('='));
    set.into_iter()
        .find(|(name, _)| name.trim() == key)
        .map(|(_, value)| value.trim())
}

fn temperature(grid: &Grid, reading: &mut Reading) -> Result<Option<f64>, Diagnostic> {
    let Some(text) = parameter(grid.text(0), "T") else {
        reading.note("no parameter T: the temperature is not known");
        return Ok(None);
    };
    match units::kelvin(text) {
        Some(kelvin) => Ok(Some(kelvin)),
        None => Err(Diagnostic::at(
            &grid.place(0),
            format!("`T={text}` is no temperature in °C"),
        )
        .help("write it as `T=25`")),
    }
}

fn is_row(line: &Line<'_>) -> bool {
    (0..3).all(|cell| line.is_number(cell))
}

/// The units of the first three columns, where a line holds units.
fn scales(line: &Line<'_>) -> Option<[Scale; 3]> {
    let scale = |cell: usize, role| {
        let unit = line.text(cell);
        units::is_unit(unit)
            .then(|| units::scale(role, Some(unit)).ok())
            .flatten()
    };
    Some([
        scale(0, Role::Frequency)?,
        scale(1, Role::Storage)?,
        scale(2, Role::Loss)?,
    ])
}

/// The values of a row.
fn row_values(
    row: &Line<'_>,
    numbers: &mut Numbers<'_>,
    problems: &Problems,
    scales: [Scale; 3],
) -> Result<[f64; 3], Skipped> {
    let mut values = [0.0; 3];
    for (cell, ((value, scale), role)) in values.iter_mut().zip(scales).zip(ROLES).enumerate() {
        let what = role.what();
        match numbers.read(row, cell) {
            Cell::Number(number) if number > 0.0 => *value = scale.factor * number,
            Cell::Number(_) => return Err(Skipped::Noise),
            Cell::Missing => return Err(Skipped::Missing),
            Cell::Bad(why) => {
                let message = format!("a cell of the column of {what} must be a number");
                problems
                    .at(&row.place(cell), message)
                    .because(why)
                    .help("leave the row out");
                return Err(Skipped::Bad);
            }
        }
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use crate::input::dynamic::DynamicFormat;
    use crate::input::dynamic::tests::{assert_points, read_bytes, read_text};
    use crate::material::ModulusKind;

    const OSC: &str = "T=-10;Mw=94.9;chem=PI;label=PI88k;PDI=1.03;\nFreq\tG'\tG\"\tTemp\tStrain\tTorque\tTemp\nrad/s\tPa\tPa\t°C\t%\tN-m\t°C\n\
        \t 100\t 3.4801E5\t 70871\t -9.99\t 0.9\t1\t1\n  10   2E5 5E4 -10.1 0.9 1 1\n1\t1E5\t-2E4\n0.1\t1E4\t2E3\n";

    #[test]
    fn the_first_three_columns_and_the_temperature_of_the_head_are_read() {
        let expected = [
            [263.15, 0.1, 1e4, 2e3],
            [263.15, 10.0, 2e5, 5e4],
            [263.15, 100.0, 348_010.0, 70_871.0],
        ];
        let latin: Vec<u8> = OSC.chars().map(|c| c as u8).collect();
        for bytes in [OSC.as_bytes(), &latin] {
            let file = read_bytes(bytes, ModulusKind::Shear).unwrap();
            assert_eq!(file.format, DynamicFormat::Reptate);
            assert_points(&file, &expected);
            assert!(
                file.notes
                    .iter()
                    .any(|note| note.contains("1 row passed over")),
                "{:?}",
                file.notes
            );
        }
        let tts = "C1=8.8;T = -35 ;isof=true;Mw=1131;\n1e-3 100 1000\n1 2e4 3e4\n1e3\t5e5\t1e5\n";
        let file = read_text(tts, ModulusKind::Shear).unwrap();
        assert_points(
            &file,
            &[
                [238.15, 1e-3, 100.0, 1000.0],
                [238.15, 1.0, 2e4, 3e4],
                [238.15, 1e3, 5e5, 1e5],
            ],
        );
        assert!(
            file.notes
                .iter()
                .any(|note| note.contains("no row of units")),
            "{:?}",
            file.notes
        );
        let kilopascal = OSC.replace("\tPa\tPa\t", "\tkPa\tkPa\t");
        let file = read_text(&kilopascal, ModulusKind::Shear).unwrap();
        assert_eq!(file.data.isotherms()[0].points[0].storage_modulus_pa, 1e7);
    }

    #[test]
    fn what_cannot_be_read_is_refused_at_its_place() {
        assert!(
            read_text(OSC, ModulusKind::Longitudinal)
                .unwrap_err()
                .contains("--modulus shear")
        );
        let refused = read_text(&OSC.replace("T=-10", "T=cold"), ModulusKind::Shear).unwrap_err();
        assert!(refused.contains("`T=cold` is no temperature"), "{refused}");
        let refused =
            read_text(&OSC.replace("10   2E5", "10   x"), ModulusKind::Shear).unwrap_err();
        assert!(
            refused.contains("dma.csv:5:8") && refused.contains("storage moduli must be a number"),
            "{refused}"
        );
        let refused = read_text("T=1;\n", ModulusKind::Shear).unwrap_err();
        assert!(refused.contains("at least 3 points"), "{refused}");
    }
}
