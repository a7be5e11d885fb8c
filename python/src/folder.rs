//! Maps of arrays in a folder of results: written as a file there, so that the program reads the folder as one of its own.

use std::sync::Arc;

use contact_dma::indenter::{
    DataFile, HEIGHT_UNITS, HeightMap, Indenter, MapLevel, MapQuantity, MapSource,
};
use contact_dma::report::npy;
use contact_dma::sweep::plan::resolved::hash_of_bytes;
use contact_dma::sweep::store::{Store, StoreError, files};
use pyo3::PyResult;
use std::path::Path;

use crate::failure;
use crate::shape::spacing_m;

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
        let source = MapSource {
            data: DataFile {
                file: file.to_owned(),
                sha256: hash_of_bytes(&bytes),
            },
            gives_places: false,
            height_unit: HEIGHT_UNITS[0].1,
            level: MapLevel::None,
        };
        let spacing_m = spacing_m(map)?;
        let gaps = map.gaps_m().to_vec();
        let same = HeightMap::new(map.cells(), spacing_m, gaps, MapQuantity::Gap, map.edge());
        let same = same.map_err(failure::of_value)?.with_source(source);
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
