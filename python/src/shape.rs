//! Indenters.

use std::sync::Arc;

use contact_dma::indenter::{HeightMap, Indenter, MapEdge};
use contact_dma::input::document::Document;
use contact_dma::input::field_file::Field;
use contact_dma::input::given;
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::{arrays, failure};

/// An indenter that was read from its block of a sweep file, or a height map of an array.
#[pyclass(frozen, module = "contact_dma._contact_dma")]
pub struct Shape {
    indenter: Arc<dyn Indenter>,
    /// The map, of one that has no file.
    map: Option<Arc<HeightMap>>,
}

#[pymethods]
impl Shape {
    /// The indenter of a block.
    #[new]
    fn new(py: Python<'_>, name: &str, text: &str) -> PyResult<Self> {
        // Files are read while other threads of Python go on.
        let indenter = py.detach(|| given::indenter(&Document::parse(name, text)?));
        Ok(Self {
            indenter: indenter.map_err(|found| failure::of_input(&found))?,
            map: None,
        })
    }

    /// Shape and settings, by which indenters of text are compared.
    fn key(&self) -> String {
        format!("{} {:?}", self.indenter.shape(), self.indenter.parameters())
    }

    /// A map of heights, one row for each y, with the other keys of its block.
    #[staticmethod]
    fn of_heights(name: &str, text: &str, heights: PyReadonlyArray2<'_, f64>) -> PyResult<Self> {
        let document = Document::parse(name, text).map_err(|found| failure::of_input(&found))?;
        let (cells_y, cells_x) = (heights.shape()[0], heights.shape()[1]);
        let field = Field {
            cells_x,
            cells_y,
            values_m: heights.as_array().iter().copied().collect(),
            spacing_m: None,
        };
        let map = given::height_map(&document, field);
        let map = Arc::new(map.map_err(|found| failure::of_input(&found))?);
        Ok(Self {
            indenter: Arc::clone(&map) as Arc<dyn Indenter>,
            map: Some(map),
        })
    }

    /// Gap (m) at every point of a map of an array.
    fn gaps<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let map = slf.get().map_of_array()?;
        let (cells_x, cells_y) = map.cells();
        let gaps = arrays::matrix(slf.as_any(), map.gaps_m(), (cells_y, cells_x));
        gaps.ok_or_else(|| failure::of_run("the map has another size than it says"))
    }

    /// A map of an array by its gaps; other indenters are pickled by their text.
    #[pyo3(signature = () -> "tuple[Any, tuple[Any, ...]]")]
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let py = slf.py();
        let arguments = ("HeightMap(...)", slf.get().map_keys()?, Self::gaps(slf)?);
        let of_heights = py.get_type::<Self>().getattr("of_heights")?;
        Ok((of_heights, arguments.into_pyobject(py)?))
    }

    /// The block, without file, that a map of an array has together with its gaps.
    fn map_keys(&self) -> PyResult<String> {
        let map = self.map_of_array()?;
        let (x_m, y_m) = map.spacing_m();
        let edge = match map.edge() {
            MapEdge::Unknown => "unknown",
            MapEdge::Rim => "rim",
            MapEdge::Periodic => "periodic",
        };
        Ok(format!(
            "[indenter]\nshape = \"height-map\"\nquantity = \"gap\"\nspacing = [{x_m:?}, {y_m:?}]\nedge = \"{edge}\"\n"
        ))
    }

    /// Gap (m) between the undeformed indenter and the half-space at points x, y (m).
    fn gap<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
    ) -> Bound<'py, PyArray1<f64>> {
        let (x, y) = (x.as_array(), y.as_array());
        let points = x.iter().zip(y.iter());
        let gaps: Vec<f64> = points.map(|(x, y)| self.indenter.gap_m(*x, *y)).collect();
        gaps.into_pyarray(py)
    }
}

impl Shape {
    /// The indenter as plans take it.
    pub fn indenter(&self) -> Arc<dyn Indenter> {
        Arc::clone(&self.indenter)
    }

    fn map_of_array(&self) -> PyResult<&HeightMap> {
        let map = self.map();
        map.ok_or_else(|| PyValueError::new_err("this indenter is no map of an array"))
    }

    /// The map, of one that has no file.
    pub fn map(&self) -> Option<&HeightMap> {
        self.map.as_deref()
    }
}
