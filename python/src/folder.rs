//! Folders of results: what a call had as arrays is written as files there, so that the program reads the folder as one of its own.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use contact_dma::engine::SolverPlan;
use contact_dma::input::diagnostic::{Diagnostics, Tables};
use contact_dma::input::document::Document;
use contact_dma::quantity::setting::toml_string;
use contact_dma::sweep::store::files::{self, Found, Place};
use contact_dma::sweep::store::provenance::{Circumstances, Stopwatch};
use contact_dma::sweep::store::{RESOLVED, Store};
use pyo3::prelude::*;

use crate::failure;

/// The folder and the text of a plan, to be read.
pub fn document(folder: &Path) -> PyResult<(Store, Document)> {
    let opened = Store::reopen_to_read(folder);
    let (store, resolved) = opened.map_err(|error| failure::of_store(&error))?;
    let name = folder.join(RESOLVED).display().to_string();
    let document = Document::parse(&name, &resolved).map_err(|found| failure::of_input(&found))?;
    Ok((store, document.in_folder(folder)))
}

/// Every file that the program has written into a folder: its name in the present layout, and its path, which differs in folders of
/// earlier versions.
#[pyfunction]
pub fn files_of(folder: PathBuf) -> Vec<(String, PathBuf)> {
    let found = Found::of(&folder);
    let files = found.all();
    files.map(|(name, path)| (name.to_owned(), path)).collect()
}

/// How a kind of plan is written and read.
pub struct Format<P> {
    pub resolved: fn(&P) -> String,
    pub read: fn(&Document) -> Result<P, Diagnostics>,
}

impl<P: Clone> Format<P> {
    /// The folder for the results of a plan, with the tables that it names as files, and the plan that names these.
    pub fn open(
        &self,
        plan: &P,
        tables: &Tables,
        (folder, force): (&Path, bool),
    ) -> PyResult<(Store, P)> {
        let stored = |error| failure::of_store(&error);
        let resolved = (self.resolved)(plan);
        if tables.is_empty() {
            let store = Store::open(folder, &resolved, force).map_err(stored)?;
            return Ok((store, plan.clone()));
        }
        let (mut text, mut names, mut placed) = (resolved, Vec::new(), Tables::new());
        for (name, bytes) in tables {
            let is_map = bytes.starts_with(b"\x93NUMPY");
            let before = placed
                .iter()
                .filter(|(file, _)| file.ends_with(".npy") == is_map);
            let file = files::of_array(is_map, before.count());
            let place = Place::Record(&file).to_string();
            let path = std::path::absolute(folder.join(place)).map_err(failure::of_value)?;
            let path = path.to_str().ok_or_else(|| {
                failure::of_value("the path of the folder is not UTF-8, and cannot be written down")
            })?;
            text = text.replace(&toml_string(name), &toml_string(path));
            placed.push((path.to_owned(), Arc::clone(bytes)));
            names.push(file);
        }
        let document = Document::with_tables(RESOLVED, &text, placed.clone());
        let plan = document.and_then(|document| (self.read)(&document));
        let plan = plan.map_err(|found| failure::of_input(&found))?;
        let store = Store::open(folder, &(self.resolved)(&plan), force).map_err(stored)?;
        for (file, (_, bytes)) in names.iter().zip(&placed) {
            store.write(Place::Record(file), bytes).map_err(stored)?;
        }
        Ok((store, plan))
    }
}

/// Writes where results come from: solver and tolerance, threads and cases.
pub fn sign(
    store: &Store,
    clock: &Stopwatch,
    (solver, tolerance): (&SolverPlan, Option<f64>),
    (threads, cases): (usize, Option<usize>),
) -> PyResult<()> {
    let circumstances = Circumstances {
        command: "python",
        threads,
        shard: None,
        cases_computed: cases,
        cases_found: cases.map(|_| 0),
        interrupted: false,
    };
    let signed = clock.write(store, solver, tolerance, &circumstances);
    signed.map_err(|error| failure::of_store(&error))
}
