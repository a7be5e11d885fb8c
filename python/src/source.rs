//! The document that a call stands for: a file with changes, or the text that its arguments were made to.

use std::path::PathBuf;

use contact_dma::input::diagnostic::{Diagnostics, Tables};
use contact_dma::input::document::Document;
use contact_dma::input::given::Given;
use contact_dma::sweep::store::provenance::BUILD;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple, PyType};

use crate::body::Body;
use crate::failure;
use crate::shape::Shape;

/// Tables that a text names as files: names and contents.
pub type Held = Vec<(String, Vec<u8>)>;

/// The document of a text.
pub fn document(name: &str, text: &str, tables: Held) -> Result<Document, Diagnostics> {
    Document::with_tables(name, text, shared(tables))
}

fn shared(tables: Held) -> Tables {
    let tables = tables.into_iter();
    tables.map(|(name, bytes)| (name, bytes.into())).collect()
}

/// Where the blocks of a call come from.
#[derive(FromPyObject)]
pub struct Source<'py> {
    /// What messages call it: the path of a file, or the call.
    name: String,
    /// The text of the arguments; without it the name is that of a file.
    text: Option<String>,
    /// Arguments as of `--set`.
    set: Vec<String>,
    tables: Held,
    material: Option<Bound<'py, Body>>,
    indenter: Option<Bound<'py, Shape>>,
}

impl Source<'_> {
    /// The document, in which paths start from the folder of the file or from the working folder.
    pub fn document(&self, tables: &Tables) -> PyResult<Document> {
        let read = match &self.text {
            Some(text) => Document::with_tables(&self.name, text, tables.clone()),
            None => Document::read(&PathBuf::from(&self.name)),
        };
        let mut document = read.map_err(|found| failure::of_input(&found))?;
        for assignment in &self.set {
            let set = document.set(assignment);
            set.map_err(|found| failure::of_input(&found))?;
        }
        Ok(document)
    }

    /// The blocks that are values.
    pub fn given(&self) -> Given {
        Given {
            material: self.material.as_ref().map(|body| body.get().material()),
            indenter: self.indenter.as_ref().map(|shape| shape.get().indenter()),
        }
    }

    /// What the text, or a block that is a value, names as files.
    pub fn tables(&mut self) -> Tables {
        shared(std::mem::take(&mut self.tables))
    }
}

/// What a result is made of.
#[derive(FromPyObject)]
pub enum Origin<'py> {
    /// A call, which is computed.
    Call(Source<'py>),
    /// What was pickled.
    Packed(Packed),
    /// A folder of the program, which is read.
    Folder(PathBuf),
}

/// A result for another process of the same build: the build, the resolved text, the tables that it names as files, what was computed, and
/// the number of threads.
#[derive(FromPyObject, IntoPyObject)]
pub struct Packed(
    pub String,
    pub String,
    pub Vec<(String, Py<PyBytes>)>,
    pub Py<PyBytes>,
    pub usize,
);

impl Packed {
    pub fn of(
        py: Python<'_>,
        resolved: String,
        tables: &Tables,
        bytes: &[u8],
        threads: usize,
    ) -> Self {
        let packed = |bytes: &[u8]| PyBytes::new(py, bytes).unbind();
        let tables = tables.iter();
        Self(
            BUILD.to_owned(),
            resolved,
            tables
                .map(|(name, bytes)| (name.clone(), packed(bytes)))
                .collect(),
            packed(bytes),
            threads,
        )
    }

    /// The document and its tables, where the build is this one.
    pub fn document(&self, py: Python<'_>, name: &str) -> PyResult<(Document, Tables)> {
        if self.0 != BUILD {
            return Err(failure::of_other_build());
        }
        let tables = self.2.iter();
        let tables: Tables = tables
            .map(|(name, bytes)| (name.clone(), bytes.as_bytes(py).into()))
            .collect();
        let document = Document::with_tables(name, &self.1, tables.clone());
        Ok((document.map_err(|found| failure::of_input(&found))?, tables))
    }
}

/// What a result is pickled as: its class, and the origin that makes it again.
pub fn reduced<'py>(
    result: &Bound<'py, PyAny>,
    origin: impl IntoPyObject<'py>,
) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
    Ok((result.get_type(), (origin,).into_pyobject(result.py())?))
}
