//! Blocks that are values already: materials and indenters that a program holds, in place of text.

use std::path::Path;
use std::sync::Arc;

use super::diagnostic::{Diagnostic, Diagnostics, Problems};
use super::document::reader::TableReader;
use super::document::{Document, Located};
use super::field_file::Field;
use super::keys;
use super::material_table::DirectSum;
use super::{indenter_block, material_block};
use crate::indenter::{HeightMap, Indenter};
use crate::sweep::plan::body_material::BodyMaterial;

/// Values for blocks that a document leaves out; what it has counts.
#[derive(Debug, Clone, Default)]
pub struct Given {
    pub material: Option<BodyMaterial>,
    pub indenter: Option<Arc<dyn Indenter>>,
}

impl Given {
    /// The indenter of a document without axes: that of its block, or the one given.
    pub(super) fn indenter(
        &self,
        root: &mut TableReader<'_>,
        folder: &Path,
        problems: &Problems,
    ) -> Option<Arc<dyn Indenter>> {
        match (&self.indenter, root.key_location(&keys::INDENTER)) {
            (Some(given), None) => Some(Arc::clone(given)),
            _ => {
                let table = root.table(&keys::INDENTER)?;
                indenter_block::read(table, folder, problems)
            }
        }
    }
}

/// The material of a document that has this block alone; samples may be taken as they are.
///
/// # Errors
/// Everything that is wrong with the block.
pub fn material(document: &Document) -> Result<BodyMaterial, Diagnostics> {
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let read = material_block::read_body(&mut root, document.folder(), DirectSum::Taken, &problems);
    root.finish();
    problems.into_result(read.map(|material| material.value))
}

/// The indenter of a document that has this block alone.
///
/// # Errors
/// Everything that is wrong with the block.
pub fn indenter(document: &Document) -> Result<Arc<dyn Indenter>, Diagnostics> {
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let read = Given::default().indenter(&mut root, document.folder(), &problems);
    root.finish();
    problems.into_result(read)
}

/// A height map of these values, in the unit and with the spacing that the document says: its `[indenter]` block is that of a map
/// without `file`. The map is held to what one from a file is held to.
///
/// # Errors
/// Everything that is wrong with block and values.
pub fn height_map(document: &Document, field: Field) -> Result<HeightMap, Diagnostics> {
    if let Some(at) = field.values_m.iter().position(|z| !z.is_finite()) {
        let (row, column) = (at / field.cells_x.max(1), at % field.cells_x.max(1));
        let message = format!("the height in row {row}, column {column} is not finite");
        let problem = Diagnostic::new(message);
        return Err(problem
            .help("fill holes before, by interpolation say")
            .into());
    }
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let table = root.table(&keys::INDENTER);
    let read = table.and_then(|table| {
        let place = Located {
            value: String::new(),
            path: "indenter".to_owned(),
            location: table.as_ref().clone(),
        };
        indenter_block::map_of(table, document.folder(), &problems, (place, field))
    });
    root.finish();
    problems.into_result(read)
}
