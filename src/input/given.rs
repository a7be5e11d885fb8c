//! Blocks that are values already: materials and indenters that a program holds, in place of text.

use std::sync::Arc;

use super::diagnostic::Diagnostics;
use super::document::Document;
use super::document::reader::TableReader;
use super::keys;
pub use super::material_dynamic::DynamicFit;
use super::material_table::DirectSum;
use super::{indenter_block, material_block};
use crate::indenter::Indenter;
use crate::simulation::body_material::BodyMaterial;

/// Values for blocks that a document leaves out; what it has counts.
#[derive(Debug, Clone, Default)]
pub struct Given {
    pub material: Option<BodyMaterial>,
    pub indenter: Option<Arc<dyn Indenter>>,
}

impl Given {
    /// The indenter of a document without axes: that of its block, or the one given.
    pub(super) fn indenter(&self, root: &mut TableReader<'_>) -> Option<Arc<dyn Indenter>> {
        match (&self.indenter, root.key_location(&keys::INDENTER)) {
            (Some(given), None) => Some(Arc::clone(given)),
            _ => indenter_block::read(root.table(&keys::INDENTER)?),
        }
    }
}

/// The material of a document that has this block alone; samples may be taken as they are.
///
/// # Errors
/// Everything that is wrong with the block.
pub fn material(document: &Document) -> Result<BodyMaterial, Diagnostics> {
    document.read_whole(|root| Some(material_block::read_body(root, DirectSum::Taken)?.value))
}

/// The same, with what was made of the measured moduli of a `[material.dynamic]`, where the block has one.
///
/// # Errors
/// Everything that is wrong with the block.
pub fn material_with_fit(
    document: &Document,
) -> Result<(BodyMaterial, Option<Arc<DynamicFit>>), Diagnostics> {
    document.read_whole(|root| {
        let block = root.table(&keys::MATERIAL)?;
        let (body, _, fit) = material_block::read_with_fit(block, DirectSum::Taken, None)?;
        Some((body.value, fit))
    })
}

/// The indenter of a document that has this block alone.
///
/// # Errors
/// Everything that is wrong with the block.
pub fn indenter(document: &Document) -> Result<Arc<dyn Indenter>, Diagnostics> {
    document.read_whole(|root| Given::default().indenter(root))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::sweep_file;
    use crate::sweep::plan::resolved::resolved_text;

    const MATERIAL: &str = "[material]\nlibrary = \"pmma\"\n";
    const INDENTER: &str = "[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n";
    const REST: &str = "[drive]\nmean = 10.0\namplitude = 5.0\n[sweep]\nfrequency = [1.0]\n";

    fn document(text: &str) -> Document {
        Document::parse("call", text).unwrap()
    }

    fn given() -> Given {
        Given {
            material: Some(material(&document(MATERIAL)).unwrap()),
            indenter: Some(indenter(&document(INDENTER)).unwrap()),
        }
    }

    #[test]
    fn values_give_the_plan_that_their_blocks_give() {
        let title = "title = \"a\"\n";
        let blocks = document(&format!("{title}{MATERIAL}{INDENTER}{REST}"));
        let from_blocks = sweep_file::plan(&blocks).unwrap();
        let values = document(&format!("{title}{REST}"));
        let from_values = sweep_file::plan_with(&values, &given()).unwrap();
        assert_eq!(resolved_text(&from_values), resolved_text(&from_blocks));
        // What the document has counts.
        let other = INDENTER.replace("10 mm", "3 mm");
        let with_block = document(&format!("{title}{other}{REST}"));
        let plan = sweep_file::plan_with(&with_block, &given()).unwrap();
        assert!(resolved_text(&plan).contains("radius = \"0.003 m\""));
        // And without either it is missing.
        let refused = sweep_file::plan_with(&values, &Given::default()).unwrap_err();
        assert!(refused.to_string().contains("material"), "{refused}");
    }

    #[test]
    fn a_map_in_memory_is_the_map_of_its_file_under_a_name_of_its_own() {
        let read = |scale: f64, hole: f64| {
            let height = |at: usize| {
                let (x, y) = ((at % 9) as f64 - 4.0, (at / 9) as f64 - 3.0);
                if at == 12 {
                    hole
                } else {
                    -scale * (x * x + y * y)
                }
            };
            let heights: Vec<f64> = (0..63).map(height).collect();
            let bytes = crate::report::npy::matrix(7, 9, &heights);
            let block = "[indenter]\nshape = \"height-map\"\nspacing = 1e-6\nfile = \"array\"\noffset = [1e-6, 0.0]\n";
            let tables = vec![("array".to_owned(), bytes.into())];
            indenter(&Document::with_tables("call", block, tables).unwrap())
        };
        let map = read(1e-9, -5e-9).unwrap();
        assert!((map.gap_m(5e-6, 3e-6) - 25e-9).abs() < 1e-20);
        assert_eq!(map.parameters().first().unwrap().toml(), "file = \"array\"");
        for (map, word) in [
            (read(1e-3, -0.01), "steeper"),
            (read(1e-9, f64::NAN), "row 2, column 4"),
        ] {
            let refused = map.unwrap_err().to_string();
            assert!(refused.contains(word), "{refused}");
        }
    }

    #[test]
    fn a_table_in_memory_is_read_as_the_file_that_it_stands_for_and_its_places_are_rows() {
        let block = "[material]\npoisson_ratio = 0.4\n[material.dynamic]\nmodulus = \"longitudinal\"\nfile = \"argument `file`\"\n";
        let read = |third: &str| {
            let head = "angular_frequency_rad_per_s,storage_modulus_pa,loss_modulus_pa\n1,1e9,1e8\n2,1.1e9,1e8\n";
            let table = format!("{head}4,{third},1e8\n8,1.3e9,1e8\n");
            let tables = vec![("argument `file`".to_owned(), table.into_bytes().into())];
            material_with_fit(&Document::with_tables("call", block, tables).unwrap())
        };
        let (_, fit) = read("1.2e9").unwrap();
        assert_eq!(fit.unwrap().files, ["argument `file`"]);
        let refused = read("-1.2e9").unwrap_err().to_string();
        assert!(refused.contains("argument `file`, row 3"), "{refused}");
        assert!(refused.contains("| 4,-1.2e9,1e8"), "{refused}");
        // Without the table it is a file that is not there.
        let refused = material_with_fit(&document(block)).unwrap_err();
        assert!(refused.to_string().contains("cannot read"), "{refused}");
    }
}
