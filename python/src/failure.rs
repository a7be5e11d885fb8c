//! What goes wrong, as exceptions of Python: what the program calls bad input is a `ValueError` with the program's message.

use contact_dma::input::diagnostic::{Diagnostics, Styling};
use contact_dma::report::ReportError;
use contact_dma::sweep::search::run::RunError;
use contact_dma::sweep::store::{Remedy, StoreError};
use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};

/// What the program's messages advise that is written otherwise in Python.
const IN_PYTHON: [(&str, &str); 2] = [
    (
        "follow one history with `contact-dma simulate`",
        "follow one history with contact_dma.simulate",
    ),
    (
        "`contact-dma material list` names all of them",
        "contact_dma.library_materials() names all of them",
    ),
];

/// A message of the program in the words of this package.
pub fn in_python(text: &str) -> String {
    let said = IN_PYTHON.iter();
    said.fold(text.to_owned(), |text, (program, python)| {
        text.replace(program, python)
    })
}

/// Bad input.
pub fn of_input(diagnostics: &Diagnostics) -> PyErr {
    let text = diagnostics.render(Styling::Plain);
    let text = text.trim_end();
    PyValueError::new_err(in_python(text.strip_prefix("error: ").unwrap_or(text)))
}

/// A value that is refused.
pub fn of_value(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(in_python(&error.to_string()))
}

/// A result that this build cannot be sure to read as it was meant.
pub fn of_other_build() -> PyErr {
    of_value(
        "this result was pickled by another build of contact-dma, which may read it otherwise: keep results with save(folder)",
    )
}

/// Anything that no other input would cure.
pub fn of_run(error: impl std::fmt::Display) -> PyErr {
    PyRuntimeError::new_err(in_python(&error.to_string()))
}

/// A folder that cannot be used, or not for this.
pub fn of_store(error: &StoreError) -> PyErr {
    let text = error.advised(|remedy| match remedy {
        Remedy::OtherFolder => "choose another folder",
        Remedy::OtherFolderOrWait | Remedy::OtherFolderOrShards => {
            "choose another folder, or wait until it has ended"
        }
        Remedy::OtherFolderOrForce => "choose another folder, or replace them with overwrite=True",
        Remedy::OtherFolderOrAdd => {
            "choose another folder, or add to this one with overwrite=True, which leaves every file that is there as it is"
        }
    });
    if error.is_of_input() {
        return PyValueError::new_err(text);
    }
    let source = std::error::Error::source(error);
    let number = source.and_then(|s| s.downcast_ref::<std::io::Error>()?.raw_os_error());
    // With its number Python knows the kind, such as FileNotFoundError.
    match number {
        Some(number) => PyOSError::new_err((number, text)),
        None => PyOSError::new_err(text),
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
