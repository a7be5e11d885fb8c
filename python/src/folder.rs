//! Maps of arrays in a folder of results: written as a file there, so that the program reads the folder as one of its own.

use std::sync::Arc;

use contact_dma::indenter::{HeightMap, Indenter, MapQuantity, data_file};
use contact_dma::report::npy;
use contact_dma::sweep::plan::resolved::hash_of_bytes;
use contact_dma::sweep::store::{Store, StoreError, files};
use pyo3::PyResult;
use std::path::Path;

use crate::failure;

/// The file of the map.
const NAME: &str = files::HEIGHT_MAP;

/// The file of a map, and the map as it is read from there.
pub struct MapFile {
    bytes: Vec<u8>,
    pub indenter: Arc<dyn Indenter>,
}

impl MapFile {
    /// The file that a map has in this folder.
    pub fn of(map: &HeightMap, folder: &Path) -> PyResult<Self> {
        let (cells_x, cells_y) = map.cells();
        let bytes = npy::matrix(cells_y, cells_x, map.gaps_m());
        let path = std::path::absolute(folder.join(NAME)).map_err(failure::of_value)?;
        let file = path.to_str().ok_or_else(|| {
            failure::of_value("the path of the folder is not UTF-8, and cannot be written down")
        })?;
        let (spacing_m, gaps) = (map.spacing_m(), map.gaps_m().to_vec());
        let same = HeightMap::new(map.cells(), spacing_m, gaps, MapQuantity::Gap, map.edge());
        let same = same.map_err(failure::of_value)?;
        let mut parameters = data_file(file, &hash_of_bytes(&bytes));
        parameters.extend(same.parameters());
        let same = same.made_from(HeightMap::SHAPE, parameters);
        Ok(Self {
            bytes,
            indenter: Arc::new(same),
        })
    }

    /// Writes the file.
    pub fn write(&self, store: &Store) -> Result<(), StoreError> {
        store.write(NAME, &self.bytes)
    }
}
