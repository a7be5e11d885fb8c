//! Files `.osc` and `.tts` of RepTate (jorge-ramirez-upm/RepTate, `data/TTS`, `data/LVE` and its documentation).
//!
//! The first line holds parameters, `T=-10;Mw=94.9;chem=PI;label=...;`, of which `T` is the temperature in °C. In `.osc` a row of
//! names and a row of units follow, `Freq G' G" Temp Strain ...` and `rad/s Pa Pa ...`, with some names more than once; in `.tts`
//! there may be none. The first three columns are angular frequency, G' and G''; in rad/s and Pa where no units are given. Texts are
//! Latin-1, cells are separated by blanks or tabs. A `.tts` file is a master curve, reduced to its `T`.

use std::sync::Arc;

use super::Reading;
use super::block::{Block, Column, Columns};
use super::columns::Role;
use crate::input::data_file::grid::Grid;
use crate::input::data_file::section::Section;
use crate::input::data_file::{self, units};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::material::ModulusKind;

/// Why a text is taken for this format.
pub(super) fn mark(source: &Arc<Source>) -> Option<String> {
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
    if mark(source).is_none() {
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
    let is_row = |line: &usize| (0..3).all(|cell| grid.line(*line).is_number(cell));
    let is_units = |line: &usize| (0..3).all(|cell| units::is_unit(grid.line(*line).text(cell)));
    let first = (1..grid.len()).find(is_row).unwrap_or(grid.len());
    let mut block = Block::of(Section::without_names(&grid, first)).by_instrument();
    block.section.units = (1..first).find(is_units).map(|line| grid.line(line));
    if block.section.units.is_none() {
        reading.note("no row of units: taken in rad/s and Pa");
    }
    block.temperature_k = temperature(&grid, reading)?;
    let column = |place: usize, role: Role| {
        let unit_may_be_absent = true;
        let column = data_file::Column {
            unit_may_be_absent,
            ..*role.column()
        };
        Ok::<_, Diagnostic>(Some(Column::at(
            block.section.asked(&column, place, None)?,
            role,
        )))
    };
    let [omega, storage] = [
        column(0, Role::AngularFrequency)?,
        column(1, Role::Storage)?,
    ];
    let columns = Columns {
        numbers: [omega, storage, column(2, Role::Loss)?, None, None, None],
        moduli: |storage, loss| (storage, loss),
        set: None,
        has_one_error: false,
    };
    let note = "columns read: the first three, as angular frequency, G' and G''".to_owned();
    let content = block.content(&columns, vec![note])?;
    reading.add_content(&block, content)
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
