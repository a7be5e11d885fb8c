//! Indenters.

use std::sync::Arc;

use contact_dma::indenter::{Domain, Indenter, Setting, Value};
use contact_dma::input::given;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::failure;
use crate::source::{Held, document};

/// An indenter that was read from its block of a sweep file.
#[pyclass(frozen, module = "contact_dma._contact_dma")]
pub struct Shape(Arc<dyn Indenter>);

#[pymethods]
impl Shape {
    /// The indenter of a block, which may name these tables as files.
    #[new]
    fn new(py: Python<'_>, name: &str, text: &str, tables: Held) -> PyResult<Self> {
        // Files are read while other threads of Python go on.
        let indenter = py.detach(|| given::indenter(&document(name, text, tables)?));
        Ok(Self(indenter.map_err(|found| failure::of_input(&found))?))
    }

    /// Shape and settings, by which indenters are compared; a file counts by its content.
    fn key(&self) -> String {
        let settings = self.0.parameters().into_iter();
        let settings: Vec<Setting> = settings.filter(|s| s.key != "file").collect();
        format!("{} {settings:?}", self.0.shape())
    }

    /// Its settings by their keys, numbers in SI units.
    #[pyo3(signature = () -> "dict[str, Any]")]
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        settings(py, &self.0.parameters())
    }

    /// Gap (m) at the points of its grid, a row for each y.
    fn gaps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let map = self.0.made_of().unwrap_or(&*self.0);
        let (Some((columns, rows)), Domain::Cells { spacing_m, .. }) =
            (map.own_cells(), map.domain(0.0, 0.0))
        else {
            return Err(failure::of_value(
                "this indenter has no grid: its gap is gap(x, y)",
            ));
        };
        let place =
            |index: usize, count: usize| index as f64 - 0.5 * (count.saturating_sub(1)) as f64;
        let gaps = Array2::from_shape_fn((rows, columns), |(row, column)| {
            let x_m = place(column, columns) * spacing_m.0;
            map.gap_m(x_m, place(row, rows) * spacing_m.1)
        });
        Ok(gaps.into_pyarray(py))
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
        let gaps: Vec<f64> = points.map(|(x, y)| self.0.gap_m(*x, *y)).collect();
        gaps.into_pyarray(py)
    }
}

impl Shape {
    /// The indenter as plans take it.
    pub fn indenter(&self) -> Arc<dyn Indenter> {
        Arc::clone(&self.0)
    }
}

fn settings<'py>(py: Python<'py>, settings: &[Setting]) -> PyResult<Bound<'py, PyDict>> {
    let made = PyDict::new(py);
    for setting in settings {
        made.set_item(&*setting.key, object(py, &setting.value)?)?;
    }
    Ok(made)
}

/// What a key has, as Python has it.
fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::Quantity(number, _) | Value::Number(number) | Value::Tolerance(number) => {
            number.into_bound_py_any(py)
        }
        Value::Quantities(numbers, _)
        | Value::QuantityLines(numbers, _)
        | Value::Numbers(numbers) => Ok(PyTuple::new(py, numbers)?.into_any()),
        Value::Integer(integer) => integer.into_bound_py_any(py),
        Value::Flag(flag) => flag.into_bound_py_any(py),
        Value::Text(text) => text.into_bound_py_any(py),
        Value::Texts(texts) => Ok(PyTuple::new(py, texts)?.into_any()),
        Value::Tables(tables) | Value::TablesInLine(tables) => {
            let tables = tables.iter().map(|table| settings(py, table));
            let tables = tables.collect::<PyResult<Vec<_>>>()?;
            Ok(PyTuple::new(py, tables)?.into_any())
        }
    }
}
