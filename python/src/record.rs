//! What results are made of: values under names, which compare bit for bit, can be pickled, and are shown without the numbers of arrays.

use std::marker::PhantomData;

use numpy::{PyArray1, PyArray2};
use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple, PyType};

/// A tuple of any length, whose items are of one type.
pub struct Items<T>(Py<PyTuple>, PhantomData<fn() -> T>);

impl<T> Items<T> {
    pub fn new<'py>(py: Python<'py>, items: impl IntoIterator<Item = T>) -> PyResult<Self>
    where
        T: IntoPyObject<'py>,
    {
        let items: Vec<T> = items.into_iter().collect();
        Ok(Self(PyTuple::new(py, items)?.unbind(), PhantomData))
    }
}

impl<'py, T: IntoPyObject<'py>> IntoPyObject<'py> for Items<T> {
    type Target = PyTuple;
    type Output = Bound<'py, PyTuple>;
    type Error = PyErr;

    #[cfg(feature = "stubs")]
    const OUTPUT_TYPE: pyo3::inspect::PyStaticExpr =
        pyo3::type_hint_subscript!(PyTuple::TYPE_HINT, T::OUTPUT_TYPE, ELLIPSIS);

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        Ok(self.0.into_bound(py))
    }
}

impl<'py, T: IntoPyObject<'py>> IntoPyObject<'py> for &Items<T> {
    type Target = PyTuple;
    type Output = Bound<'py, PyTuple>;
    type Error = PyErr;

    #[cfg(feature = "stubs")]
    const OUTPUT_TYPE: pyo3::inspect::PyStaticExpr = Items::<T>::OUTPUT_TYPE;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        Ok(self.0.bind(py).clone())
    }
}

impl<'py, T: IntoPyObject<'py>> FromPyObject<'_, 'py> for Items<T> {
    type Error = PyErr;

    #[cfg(feature = "stubs")]
    const INPUT_TYPE: pyo3::inspect::PyStaticExpr = Items::<T>::OUTPUT_TYPE;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(
            given.cast::<PyTuple>()?.to_owned().unbind(),
            PhantomData,
        ))
    }
}

#[cfg(feature = "stubs")]
use pyo3::PyTypeInfo;

#[cfg(feature = "stubs")]
const ELLIPSIS: pyo3::inspect::PyStaticExpr = pyo3::inspect::PyStaticExpr::Constant {
    value: pyo3::inspect::PyStaticConstant::Ellipsis,
};

pub type Line = Py<PyArray1<f64>>;
type Matrix = Py<PyArray2<f64>>;

/// The functions of `contact_dma._result` that compare and show any record.
fn helper<'py>(record: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    record.py().import("contact_dma._result")?.getattr(name)
}

fn values<'py>(record: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyTuple>> {
    let names = record.get_type().getattr("__match_args__")?;
    let values = names
        .try_iter()?
        .map(|name| record.getattr(name?.cast::<PyString>()?));
    PyTuple::new(record.py(), values.collect::<PyResult<Vec<_>>>()?)
}

/// The next field that a constructor was given.
fn next<'py, T: FromPyObjectOwned<'py>>(
    fields: &mut impl Iterator<Item = Bound<'py, PyAny>>,
) -> PyResult<T> {
    let field = fields.next();
    let field = field.ok_or_else(|| PyTypeError::new_err("a field is missing"))?;
    field.extract().map_err(Into::into)
}

/// Classes of records: for each field its meaning and its type; then other methods. Fields are the arguments of the constructor.
macro_rules! records {
    ($($(#[doc = $about:literal])+ $Name:ident {
        $($(#[doc = $means:literal])+ $field:ident: $type:ty),+ $(,)?
    } $(with { $($method:item)+ })?)+) => { $(
        $(#[doc = $about])+
        #[pyclass(frozen, get_all, module = "contact_dma")]
        pub struct $Name { $($(#[doc = $means])+ pub $field: $type),+ }

        #[pymethods]
        impl $Name {
            #[new]
            #[pyo3(signature = (*values: "Any", **named: "Any"))]
            fn new(values: &Bound<'_, PyTuple>, named: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
                let names = [$(stringify!($field)),+];
                let filled = helper(values, "filled")?.call1((names, values, named))?;
                let mut fields = filled.cast::<PyTuple>()?.iter();
                Ok(Self { $($field: next(&mut fields)?),+ })
            }

            #[classattr]
            fn __match_args__(py: Python<'_>) -> PyResult<Items<&'static str>> {
                Items::new(py, [$(stringify!($field)),+])
            }

            /// As of a dataclass, whose functions then take it.
            #[classattr]
            fn __dataclass_fields__(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
                let made = py.import("dataclasses")?.getattr("make_dataclass")?;
                let made = made.call1((stringify!($Name), vec![$(stringify!($field)),+]))?;
                made.getattr("__dataclass_fields__")
            }

            fn __eq__(slf: &Bound<'_, Self>, other: &Bound<'_, PyAny>) -> PyResult<bool> {
                let is_one = slf.get_type().is(other.get_type());
                let same = helper(slf, "same")?;
                Ok(is_one && same.call1((values(slf)?, values(other)?))?.is_truthy()?)
            }

            fn __hash__(slf: &Bound<'_, Self>) -> PyResult<isize> {
                values(slf)?.hash()
            }

            fn __repr__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
                helper(slf, "brief")?.call1((slf,))
            }

            #[pyo3(signature = () -> "tuple[Any, tuple[Any, ...]]")]
            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
                Ok((slf.get_type(), values(slf)?))
            }

            $($($method)+)?
        }
    )+ };
}

records! {
    /// How a case ended.
    Status {
        /// ``"converged"``, ``"transient"``, ``"not-converged"`` or ``"failed"``.
        name: String,
        /// Why there is no result, or what else is to be known.
        reason: Option<String>,
    } with {
        /// Whether there is a result.
        #[getter]
        fn converged(&self) -> bool {
            matches!(self.name.as_str(), "converged" | "transient")
        }

        fn __str__(&self) -> String {
            match self.reason.as_deref() {
                None | Some("") => self.name.clone(),
                Some(reason) => format!("{}: {reason}", self.name),
            }
        }
    }

    /// What lies outside the model, or was not estimated.
    Warning {
        /// The program's code of it.
        code: String,
        /// A sentence.
        message: String,
    }

    /// A local maximum of the energy loss over frequency, located to a thousandth of its frequency.
    Peak {
        /// Its angular frequency (rad/s).
        angular_frequency: f64,
        /// The loss per cycle there (J).
        energy_loss: f64,
        /// Numerical uncertainty of the frequency (rad/s).
        angular_frequency_uncertainty: f64,
        /// Numerical error of the loss (J); None without error bars.
        energy_loss_error: Option<f64>,
        /// SI values of the axes besides the frequency, names of materials or indenters, empty where there are none.
        varied: Items<AxisValue>,
        /// Mean of the drive (N, Pa or m by its control), where there are several.
        drive_mean: Option<f64>,
        /// Amplitude of the drive (N, Pa or m), where there are several.
        drive_amplitude: Option<f64>,
        /// The column of the result that each value of `varied` belongs to.
        varied_columns: Items<String>,
    } with {
        /// Its frequency (Hz).
        #[getter]
        fn frequency(&self) -> f64 {
            self.angular_frequency / std::f64::consts::TAU
        }
    }

    /// The contact pressure along a line through the origin.
    PressureLine {
        /// ``"r"``, ``"x"`` or ``"y"``.
        along: String,
        /// Positions (m), shape (n,).
        position: Line,
        /// Pressures (Pa), shape (n,); NaN where it is unbounded.
        pressure: Line,
    }

    /// The contact pressure at a quarter of the oscillation.
    PressureProfile {
        /// Such as ``"greatest load"``.
        instant: String,
        /// Since the cycle began (s).
        time: f64,
        /// Load (N).
        load: f64,
        /// Approach (m).
        approach: f64,
        /// Contact radius (m).
        contact_radius: f64,
        /// Along the radius, or along x and y.
        lines: Items<PressureLine>,
    }

    /// The stabilised cycle of a case, sample by sample; arrays of length 0 where the case has no result.
    Cycle {
        /// rad/s.
        angular_frequency: f64,
        /// Since the cycle began (s), shape (samples,).
        time: Line,
        /// N, shape (samples,).
        load: Line,
        /// m, shape (samples,).
        approach: Line,
        /// m, shape (samples,).
        contact_radius: Line,
        /// Pa, shape (samples,); NaN where it is unbounded.
        peak_pressure: Line,
        /// The pressure over the contact at the quarters of the oscillation.
        profiles: Items<PressureProfile>,
    }

    /// The deformed surface along a line through the origin, arrays of shape (n,).
    SurfaceLine {
        /// ``"r"``, ``"x"`` or ``"y"``.
        along: String,
        /// m.
        position: Line,
        /// Pa; NaN where it is unbounded.
        pressure: Line,
        /// m, positive into the body.
        displacement: Line,
        /// m; NaN where there is no indenter.
        gap: Line,
    }

    /// The surface along lines at a requested time.
    SurfaceProfile {
        /// s.
        time: f64,
        /// N.
        load: f64,
        /// m; NaN where the indenter is clear of the surface.
        approach: f64,
        /// m.
        contact_radius: f64,
        /// Along the radius, or along x and y.
        lines: Items<SurfaceLine>,
    }

    /// Fields at a requested time, arrays of shape (cells along y, cells along x) that share the memory of the result.
    Field {
        /// s.
        time: f64,
        /// N.
        load: f64,
        /// m; NaN where the indenter is clear of the surface.
        approach: f64,
        /// m.
        contact_radius: f64,
        /// Of the cells along x and y (m).
        spacing: (f64, f64),
        /// Pa.
        pressure: Matrix,
        /// m, positive into the body.
        displacement: Matrix,
        /// m, infinite where there is no indenter; None where its place is unknown.
        gap: Option<Matrix>,
    }

    /// The mean cycle of a record, corrected, as uniform samples; arrays of length 0 where there is none.
    MeasuredCycle {
        /// s, shape (samples,).
        time: Line,
        /// N, shape (samples,).
        load: Line,
        /// m, shape (samples,).
        approach: Line,
    }
}

/// What an axis has for a peak: a number in SI units, or the name of a block.
#[derive(IntoPyObject)]
pub enum AxisValue {
    Number(f64),
    Name(String),
}

impl Warning {
    pub fn of(code: &str, message: impl std::fmt::Display) -> Self {
        let message = message.to_string();
        Self {
            code: code.to_owned(),
            message,
        }
    }
}
