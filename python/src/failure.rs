//! What goes wrong, as exceptions of Python: what the program calls bad input is a `ValueError` with the program's message.

use contact_dma::input::diagnostic::{Diagnostics, Styling};
use contact_dma::report::ReportError;
use contact_dma::sweep::search::run::RunError;
use contact_dma::sweep::store::StoreError;
use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};

/// Bad input.
pub fn of_input(diagnostics: &Diagnostics) -> PyErr {
    let text = diagnostics.render(Styling::Plain);
    let text = text.trim_end();
    PyValueError::new_err(text.strip_prefix("error: ").unwrap_or(text).to_owned())
}

/// A value that is refused.
pub fn of_value(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A result that this build cannot be sure to read as it was meant.
pub fn of_other_build() -> PyErr {
    of_value(
        "this result was pickled by another build of contact-dma, which may read it otherwise: keep results with save(folder)",
    )
}

/// Anything that no other input would cure.
pub fn of_run(error: impl std::fmt::Display) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

/// A folder that cannot be used, or not for this.
pub fn of_store(error: &StoreError) -> PyErr {
    match error {
        StoreError::NewerProgram { .. }
        | StoreError::OtherSweep { .. }
        | StoreError::InUse { .. }
        | StoreError::NoSweep { .. } => of_value(error),
        _ => PyOSError::new_err(error.to_string()),
    }
}

/// A sweep that stopped.
pub fn of_sweep(error: &RunError) -> PyErr {
    match error {
        RunError::Store(error) => of_store(error),
        error => of_run(error),
    }
}

/// A table that could not be written.
pub fn of_report(error: &ReportError) -> PyErr {
    match error {
        ReportError::Store(error) => of_store(error),
        error => of_run(error),
    }
}
