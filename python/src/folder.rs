//! Folders of results: a map of an array is written as a file there, so that the program reads the folder as one of its own.

use std::path::Path;
use std::sync::Arc;

use contact_dma::engine::SolverPlan;
use contact_dma::indenter::{HeightMap, Indenter, MapQuantity, data_file};
use contact_dma::input::document::Document;
use contact_dma::report::npy;
use contact_dma::sweep::plan::resolved::hash_of_bytes;
use contact_dma::sweep::store::provenance::{Circumstances, Stopwatch};
use contact_dma::sweep::store::{RESOLVED, Store, files};
use pyo3::prelude::*;

use crate::failure;
use crate::shape::Shape;

/// The folder and the text of a plan, to be read.
pub fn document(folder: &Path) -> PyResult<(Store, Document)> {
    let opened = Store::reopen_to_read(folder);
    let (store, resolved) = opened.map_err(|error| failure::of_store(&error))?;
    let name = folder.join(RESOLVED).display().to_string();
    let document = Document::parse(&name, &resolved).map_err(|found| failure::of_input(&found))?;
    Ok((store, document.in_folder(folder)))
}

/// A plan whose results are to be written, where it has its indenter, and how it is written.
pub struct Opening<'a, P> {
    pub plan: &'a P,
    pub indenter: fn(&mut P) -> &mut Arc<dyn Indenter>,
    pub resolved: fn(&P) -> String,
    /// The indenter, of a plan whose text does not say all of it.
    pub shape: Option<&'a Py<Shape>>,
}

impl<P: Clone> Opening<'_, P> {
    /// The folder, and the plan with the file of its map.
    pub fn open(&self, folder: &Path, force: bool) -> PyResult<(Store, P)> {
        let mut plan = self.plan.clone();
        let map = self.shape.and_then(|shape| shape.get().map());
        let map = map.map(|map| file_of(map, folder)).transpose()?;
        let bytes = map.map(|(bytes, same)| {
            *(self.indenter)(&mut plan) = Arc::new(same);
            bytes
        });
        let stored = |error| failure::of_store(&error);
        let store = Store::open(folder, &(self.resolved)(&plan), force).map_err(stored)?;
        if let Some(bytes) = bytes {
            store.write(files::HEIGHT_MAP, &bytes).map_err(stored)?;
        }
        Ok((store, plan))
    }
}

/// The file that a map has in this folder, and the map as it is read from there.
fn file_of(map: &HeightMap, folder: &Path) -> PyResult<(Vec<u8>, HeightMap)> {
    let (cells_x, cells_y) = map.cells();
    let bytes = npy::matrix(cells_y, cells_x, map.gaps_m());
    let path = std::path::absolute(folder.join(files::HEIGHT_MAP)).map_err(failure::of_value)?;
    let file = path.to_str().ok_or_else(|| {
        failure::of_value("the path of the folder is not UTF-8, and cannot be written down")
    })?;
    let (spacing_m, gaps) = (map.spacing_m(), map.gaps_m().to_vec());
    let same = HeightMap::new(map.cells(), spacing_m, gaps, MapQuantity::Gap, map.edge());
    let same = same.map_err(failure::of_value)?;
    let mut parameters = data_file(file, &hash_of_bytes(&bytes));
    parameters.extend(same.parameters());
    Ok((bytes, same.made_from(HeightMap::SHAPE, parameters)))
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
