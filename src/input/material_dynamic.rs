//! The `[material.dynamic]` block: measured storage and loss modulus, made a material at any temperature that they reach.

use std::sync::Arc;

use super::data_file;
use super::document::Located;
use super::document::reader::TableReader;
use super::dynamic::{self, DynamicFile, FORMATS, shift_factors_from_bytes};
use super::keys::material::{
    DYNAMIC_BRANCHES, DYNAMIC_FILE, DYNAMIC_FILES, DYNAMIC_MODULUS, DYNAMIC_REPLICAS, FORMAT,
    REFERENCE_TEMPERATURE, SEED, SHIFT, SHIFT_FILE, VERTICAL_SHIFT,
};
use super::material_temperature::AtTemperature;
use crate::material::dynamic::master_curve::ShiftChoice;
use crate::material::dynamic::{Characterisation, Choices, characterise};
use crate::quantity::block::Field as _;
use crate::quantity::key::{Key, Kind, words_of};
use crate::quantity::rows::{Rows, table};
use crate::quantity::setting::Value;

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
    let format = table.chosen(&FORMAT, &FORMATS);
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
    let reference = table.value(&REFERENCE_TEMPERATURE);
    let shift = match table.parsed(&SHIFT) {
        None => table.chosen(&SHIFT, ShiftChoice::WORDS),
        Some(_) => table.table(&SHIFT).and_then(|mut table| {
            let file: Option<Located<String>> = table.read(&SHIFT_FILE);
            let (folder, problems) = (table.folder(), table.problems());
            table.finish();
            let factors = data_file::made_of(&file?, folder, problems, shift_factors_from_bytes);
            factors.map(|factors| Some(ShiftChoice::Given(factors)))
        }),
    };
    let vertical = table.value(&VERTICAL_SHIFT);
    let branches = number_of_branches(table, &DYNAMIC_BRANCHES);
    let (replicas, seed) = (table.value(&DYNAMIC_REPLICAS), table.value(&SEED));
    Some(Choices {
        reference_temperature_k: reference?,
        shift: shift?.unwrap_or(ShiftChoice::Free),
        vertical_shift: vertical?,
        branches: branches?,
        replicas: replicas?,
        seed: seed?,
    })
}

const SHIFT_WORDS: [&str; ShiftChoice::WORDS.len()] = words_of(ShiftChoice::WORDS);

static SHIFT_TABLE: Rows = table(" Shift factors of a file.", &[&[SHIFT_FILE]]);

/// How isotherms are shifted: a word, or a table that names a file.
pub(super) const SHIFT_KIND: Kind = Kind::Either(
    &Kind::Word(&SHIFT_WORDS),
    &Kind::Table(&SHIFT_TABLE),
    " with a file",
);

/// A number of branches, or `auto`.
pub(super) const fn branches(number: &'static Kind) -> Kind {
    Kind::Either(&Kind::Word(&["auto"]), number, "")
}

/// The number of branches under such a key, where it is asked for; `None` where a problem was reported.
pub(super) fn number_of_branches(table: &mut TableReader<'_>, key: &Key) -> Option<Option<usize>> {
    let found: Option<Value> = table.value(key)?;
    Some(found.and_then(usize::of))
}
