//! The document that a call stands for: a file with changes, or the text that its arguments were made to.

use std::path::PathBuf;

use contact_dma::input::document::Document;
use contact_dma::input::given::Given;
use contact_dma::sweep::store::provenance::BUILD;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple, PyType};

use crate::body::Body;
use crate::shape::Shape;
use crate::{blocks, failure};

/// Where the blocks of a call come from.
#[derive(FromPyObject)]
pub struct Source<'py> {
    /// What messages call it: the path of a file, or the call.
    name: String,
    /// The text of the arguments; without it the name is that of a file.
    text: Option<String>,
    /// Arguments as of `--set`.
    set: Vec<String>,
    /// Tables that the text names as files: names and texts.
    tables: Vec<(String, String)>,
    material: Option<Bound<'py, Body>>,
    indenter: Option<Bound<'py, Shape>>,
}

impl<'py> Source<'py> {
    /// The document, in which paths start from the folder of the file or from the working folder.
    pub fn document(&self) -> PyResult<Document> {
        let read = match &self.text {
            Some(text) => Document::with_tables(&self.name, text, self.tables.clone()),
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

    /// The indenter, where no text says all of it.
    pub fn map(&self) -> Option<Py<Shape>> {
        let shape = self.indenter.as_ref()?;
        shape.get().map().map(|_| shape.clone().unbind())
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

/// A result for another process of the same build: the build, the resolved text, the indenter where no text says all of it, what was
/// computed, and the number of threads.
#[derive(FromPyObject, IntoPyObject)]
pub struct Packed(
    pub String,
    pub String,
    pub Option<Py<Shape>>,
    pub Py<PyBytes>,
    pub usize,
);

impl Packed {
    pub fn of(
        py: Python<'_>,
        resolved: String,
        shape: Option<&Py<Shape>>,
        bytes: &[u8],
        threads: usize,
    ) -> Self {
        let shape = shape.map(|shape| shape.clone_ref(py));
        Self(
            BUILD.to_owned(),
            resolved,
            shape,
            PyBytes::new(py, bytes).unbind(),
            threads,
        )
    }

    /// The document and the indenter, where the build is this one.
    pub fn document(&self, name: &str) -> PyResult<(Document, Given)> {
        if self.0 != BUILD {
            return Err(failure::of_other_build());
        }
        let text = match &self.2 {
            // The indenter is a value.
            Some(_) => blocks::without(&self.1, "indenter")?,
            None => self.1.clone(),
        };
        let document = Document::parse(name, &text).map_err(|found| failure::of_input(&found))?;
        let indenter = self.2.as_ref().map(|shape| shape.get().indenter());
        Ok((
            document,
            Given {
                material: None,
                indenter,
            },
        ))
    }
}

/// What a result is pickled as: its class, and the origin that makes it again.
pub fn reduced<'py>(
    result: &Bound<'py, PyAny>,
    origin: impl IntoPyObject<'py>,
) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
    Ok((result.get_type(), (origin,).into_pyobject(result.py())?))
}
