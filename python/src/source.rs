//! The document that a call stands for: a file with changes, or the text that its arguments were made to.

use std::path::PathBuf;

use contact_dma::input::document::Document;
use contact_dma::input::given::Given;
use pyo3::prelude::*;

use crate::body::Body;
use crate::failure;
use crate::shape::Shape;

/// Where the blocks of a call come from.
#[derive(FromPyObject)]
pub struct Source<'py> {
    /// What messages call it: the path of a file, or the call.
    name: String,
    /// The text of the arguments; without it the name is that of a file.
    text: Option<String>,
    /// Arguments as of `--set`.
    set: Vec<String>,
    material: Option<Bound<'py, Body>>,
    indenter: Option<Bound<'py, Shape>>,
}

impl<'py> Source<'py> {
    /// The document, in which paths start from the folder of the file or from the working folder.
    pub fn document(&self) -> PyResult<Document> {
        let read = match &self.text {
            Some(text) => Document::parse(&self.name, text),
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
