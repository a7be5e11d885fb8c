//! Blocks of TOML text: given another place, whatever they look like.

use contact_dma::input::document::Document;
use pyo3::PyResult;
use pyo3::prelude::*;
use toml::{Table, Value};

use crate::failure;

/// The text of a block at another place of a file: `block` of `text` becomes `place`, `indenter.material` say; with a name it becomes an
/// entry of a list there.
#[pyfunction]
pub fn placed(text: &str, block: &str, place: &str, name: Option<String>) -> PyResult<String> {
    // Messages about text that is no TOML are those of the program.
    Document::parse(block, text).map_err(|found| failure::of_input(&found))?;
    let mut root = table(text)?;
    let mut value = root.remove(block).unwrap_or(Value::Table(Table::new()));
    if let Some(name) = name {
        if let Value::Table(entries) = &mut value {
            entries.insert("name".to_owned(), Value::String(name));
        }
        value = Value::Array(vec![value]);
    }
    for key in place.rsplit('.') {
        value = Value::Table(Table::from_iter([(key.to_owned(), value)]));
    }
    toml::to_string(&value).map_err(failure::of_value)
}

fn table(text: &str) -> PyResult<Table> {
    text.parse::<Table>().map_err(failure::of_value)
}
