//! Numbers of the library as arrays of NumPy.

use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use contact_dma::report::quantities::Named;
use contact_dma::report::table::Cell;

use crate::record::Line;

/// Columns that hold text, be it that no row has any.
const TEXTS: [&str; 2] = ["warnings", "message"];

/// Absent values as NaN.
fn numbers(values: impl IntoIterator<Item = Option<f64>>) -> Vec<f64> {
    let values = values.into_iter();
    values.map(|value| value.unwrap_or(f64::NAN)).collect()
}

/// The same as an array.
pub fn nullable(py: Python<'_>, values: impl IntoIterator<Item = Option<f64>>) -> Line {
    numbers(values).into_pyarray(py).unbind()
}

/// What a function makes of numbers in any shape, in this unit where they have none: as many, or one of one.
pub fn mapped<'py, T: Element>(
    given: &Bound<'py, PyAny>,
    unit: &str,
    of: impl Fn(f64) -> T,
) -> PyResult<Bound<'py, PyAny>> {
    let py = given.py();
    let si = py.import("contact_dma._toml")?.getattr("si")?;
    let numbers = si.call1((given, unit, "the argument"))?;
    let line: PyReadonlyArray1<'_, f64> = numbers.call_method0("ravel")?.extract()?;
    let made: Vec<T> = line.as_array().iter().map(|number| of(*number)).collect();
    let made = made.into_pyarray(py);
    let made = made.call_method1("reshape", (numbers.getattr("shape")?,))?;
    made.get_item(PyTuple::empty(py))
}

/// A list that its owner holds, as an array that cannot be written to; nothing is copied.
pub fn line<'py>(owner: &Bound<'py, PyAny>, values: &[f64]) -> Bound<'py, PyArray1<f64>> {
    let view = ArrayView1::from(values);
    // SAFETY: the array keeps its owner alive, which is frozen and never moves or changes the values.
    let array = unsafe { PyArray1::borrow_from_array(&view, owner.clone()) };
    array.readwrite().make_nonwriteable();
    array
}

/// The same of a matrix that is held row by row; `None` where its size is another.
pub fn matrix<'py>(
    owner: &Bound<'py, PyAny>,
    values: &[f64],
    shape: (usize, usize),
) -> Option<Bound<'py, PyArray2<f64>>> {
    let view = ArrayView2::from_shape(shape, values).ok()?;
    // SAFETY: as above.
    let array = unsafe { PyArray2::borrow_from_array(&view, owner.clone()) };
    array.readwrite().make_nonwriteable();
    Some(array)
}

/// Every column of a table: numbers as an array with NaN where a cell is empty, texts as a list.
pub fn columns<'py, R>(
    py: Python<'py>,
    columns: &[Named<R>],
    rows: &[R],
) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let of_column = |column: &Named<R>| {
        let cells: Vec<Cell> = rows.iter().map(|row| (column.cell)(row)).collect();
        let has_text = cells.iter().any(|cell| matches!(cell, Cell::Text(_)));
        let values = match has_text || TEXTS.contains(&column.name.as_str()) {
            true => {
                let texts: Vec<String> = cells.iter().map(Cell::text).collect();
                texts.into_pyobject(py)?
            }
            false => {
                let values = numbers(cells.iter().map(Cell::number));
                values.into_pyarray(py).into_any()
            }
        };
        Ok((column.name.clone(), values))
    };
    columns.iter().map(of_column).collect()
}
