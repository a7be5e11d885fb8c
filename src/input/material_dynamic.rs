//! The `[material.dynamic]` block: measured storage and loss modulus, made a material at any temperature that they reach.

use std::ops::RangeInclusive;
use std::sync::Arc;

use serde_json::{Value as Json, json};

use super::data_file;
use super::diagnostic::Diagnostics;
use super::document::Located;
use super::document::kind::{Choice, Describe, Integer, Kind, Spot, Text};
use super::document::reader::TableReader;
use super::document::row::Rows;
use super::document::row::table;
use super::document::tree::{Node, Value};
use super::dynamic::{self, DynamicFile, shift_factors_from_bytes};
use super::keys::material::{
    DYNAMIC_BRANCHES, DYNAMIC_FILE, DYNAMIC_FILES, DYNAMIC_MODULUS, DYNAMIC_REPLICAS, FORMAT,
    REFERENCE_TEMPERATURE, SEED, SHIFT, SHIFT_FILE, SHIFT_KEYS, VERTICAL_SHIFT,
};
use super::material_temperature::AtTemperature;
use crate::material::dynamic::master_curve::ShiftChoice;
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
    let files = match table.one_of(&[(&DYNAMIC_FILE as _, true), (&DYNAMIC_FILES as _, false)]) {
        Some(true) => table.read(&DYNAMIC_FILE).map(|file| vec![file]),
        Some(false) => table.value(&DYNAMIC_FILES),
        None => None,
    };
    let (format, kind) = (table.value(&FORMAT), table.value(&DYNAMIC_MODULUS));
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

fn choices(table: &mut TableReader<'_>) -> Option<Choices> {
    let reference = table.value(&REFERENCE_TEMPERATURE);
    let shift = table.value(&SHIFT).and_then(|shift| match shift {
        None => Some(ShiftChoice::Free),
        Some(ShiftValue::Word(choice)) => Some(choice),
        Some(ShiftValue::File(file)) => {
            let (folder, problems) = (table.folder(), table.problems());
            let factors = data_file::made_of(&file, folder, problems, shift_factors_from_bytes);
            factors.map(ShiftChoice::Given)
        }
    });
    let vertical = table.value(&VERTICAL_SHIFT);
    let branches = table.value(&DYNAMIC_BRANCHES);
    let (replicas, seed) = (table.value(&DYNAMIC_REPLICAS), table.value(&SEED));
    Some(Choices {
        reference_temperature_k: reference?,
        shift: shift?,
        vertical_shift: vertical?,
        branches: branches?.flatten(),
        replicas: replicas?,
        seed: seed? as u64,
    })
}

const SHIFT_WORDS: Choice<ShiftChoice> = Choice(ShiftChoice::WORDS);

static SHIFT_TABLE: Rows = table(" Shift factors of a file.", SHIFT_KEYS);

/// How isotherms are shifted: a word, or a table that names a file.
pub(crate) struct Shift;

/// What stands under `shift`.
#[derive(Debug, Clone)]
pub(crate) enum ShiftValue {
    Word(ShiftChoice),
    File(Located<String>),
}

impl Describe for Shift {
    fn expected(&self) -> String {
        format!("{}, or a table with a file", SHIFT_WORDS.expected())
    }

    fn example(&self) -> String {
        SHIFT_WORDS.example()
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [SHIFT_WORDS.schema(), SHIFT_TABLE.schema()] })
    }

    fn words(&self) -> Vec<&'static str> {
        SHIFT_WORDS.words()
    }

    fn rows(&self) -> Option<&'static Rows> {
        Some(&SHIFT_TABLE)
    }
}

impl Kind for Shift {
    type Value = ShiftValue;

    fn written(&self, value: &ShiftValue) -> Json {
        match value {
            ShiftValue::Word(word) => SHIFT_WORDS.written(word),
            ShiftValue::File(file) => json!({ "file": Text.written(&file.value) }),
        }
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<ShiftValue, Diagnostics> {
        let Value::Table(table) = &node.value else {
            return SHIFT_WORDS.convert(node, spot).map(ShiftValue::Word);
        };
        spot.read_table(table, node, |mut table| {
            let file = table.read(&SHIFT_FILE);
            table.finish();
            file.map(ShiftValue::File)
        })
    }
}

/// A number of branches, or `auto`.
pub(crate) struct Branches(pub(crate) RangeInclusive<usize>);

const AUTO: Choice<()> = Choice(&[("auto", ())]);

impl Branches {
    fn number(&self) -> Integer {
        Integer(self.0.clone())
    }
}

impl Describe for Branches {
    fn expected(&self) -> String {
        format!("{}, or {}", AUTO.expected(), self.number().expected())
    }

    fn example(&self) -> String {
        AUTO.example()
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [AUTO.schema(), self.number().schema()] })
    }

    fn words(&self) -> Vec<&'static str> {
        AUTO.words()
    }
}

impl Kind for Branches {
    type Value = Option<usize>;

    fn written(&self, value: &Option<usize>) -> Json {
        value.map_or_else(|| AUTO.written(&()), |number| json!(number))
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<Option<usize>, Diagnostics> {
        match &node.value {
            Value::Text(_) => AUTO.convert(node, spot).map(|()| None),
            _ => self.number().convert(node, spot).map(Some),
        }
    }
}
