//! The `[material.dynamic]` block: measured storage and loss modulus, made a material at any temperature that they reach.

use std::sync::Arc;

use super::data_file;
use super::document::reader::TableReader;
use super::document::{Located, block};
use super::dynamic::{self, DynamicFile, DynamicFormat, shift_factors_from_bytes};
use super::keys::material::{DYNAMIC_FILE, DYNAMIC_FILES, DYNAMIC_MODULUS, FORMAT};
use super::material_temperature::AtTemperature;
use crate::material::dynamic::master_curve::{FACTORS, ShiftChoice};
use crate::material::dynamic::{Characterisation, Choices, characterise};

/// Measured storage and loss moduli, and what was made of them.
#[derive(Debug, Clone, PartialEq)]
pub struct DynamicFit {
    /// Names of the files.
    pub files: Vec<String>,
    /// Whether the format was named, and not found from the content.
    pub format_named: bool,
    pub file: DynamicFile,
    pub made: Characterisation,
}

impl DynamicFit {
    /// The material at each temperature that the data reach.
    pub(super) fn at_temperature(self: &Arc<Self>) -> AtTemperature {
        let fit = Arc::clone(self);
        Box::new(move |temperature_k, poisson_ratio| {
            let material = fit.made.whole_material(temperature_k, poisson_ratio);
            material.map_err(|error| error.to_string())
        })
    }
}

/// Reads the block and makes master curve, series and replicas of its data. `None` where a problem was reported.
pub(super) fn read(mut table: TableReader<'_>) -> Option<Arc<DynamicFit>> {
    let files = match table.one_of(&[(&DYNAMIC_FILE, true), (&DYNAMIC_FILES, false)]) {
        Some(true) => table.read(&DYNAMIC_FILE).map(|file| vec![file]),
        Some(false) => several(&mut table),
        None => None,
    };
    let format: Option<Option<DynamicFormat>> = table.value(&FORMAT);
    let kind = table.value(&DYNAMIC_MODULUS);
    let choices = choices(&mut table);
    let (place, folder, problems) = (table.as_ref().clone(), table.folder(), table.problems());
    table.finish();
    let (files, format, kind, choices) = (files?, format?, kind?, choices?);
    let named = files.iter();
    let named = named.map(|file| data_file::named(file, folder, problems));
    let named = named.collect::<Option<Vec<_>>>()?;
    let file = match (dynamic::from_files(&named, format, kind), files.first()) {
        (found, Some(first)) => data_file::accepted(found, first, problems)?,
        (found, None) => found.map_err(|refused| problems.extend(refused)).ok()?,
    };
    let made = problems.accept(&place, characterise(&file.data, &choices))?;
    Some(Arc::new(DynamicFit {
        files: named.into_iter().map(|(name, _)| name).collect(),
        format_named: format.is_some(),
        file,
        made,
    }))
}

/// The names of several files, each with its place.
fn several(table: &mut TableReader<'_>) -> Option<Vec<Located<String>>> {
    let files: Located<Vec<String>> = table.read(&DYNAMIC_FILES)?;
    let places = table.places_in(DYNAMIC_FILES.name).into_iter();
    let named = files.value.into_iter().zip(places);
    let named = named.map(|(value, location)| Located {
        value,
        path: files.path.clone(),
        location,
    });
    Some(named.collect())
}

fn choices(table: &mut TableReader<'_>) -> Option<Choices> {
    let choices: Option<Choices> = block::read_from(table, None);
    let given = table.table_if("shift", |mut table| {
        let file: Option<Located<String>> = table.read(&FACTORS);
        let (folder, problems) = (table.folder(), table.problems());
        table.finish();
        data_file::made_of(&file?, folder, problems, shift_factors_from_bytes)
    });
    let choices = choices?;
    Some(match given? {
        Some(factors) => Choices {
            shift: ShiftChoice::Given(factors),
            ..choices
        },
        None => choices,
    })
}
