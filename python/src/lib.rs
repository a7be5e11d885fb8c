//! The compiled module of the Python package `contact_dma`: materials, indenters, sweeps, histories, measured loops and identification of
//! the crate `contact-dma`, with arrays of NumPy.
//!
//! What a user sees is written in Python, in `contact_dma/*.py`: it makes of its arguments the text of a sweep file, so that keys,
//! ranges, units and messages are the program's, and hands materials and indenters over as values. Here that text is read, the work is done
//! on threads of its own while the interpreter hears of signals, and numbers go back as arrays, of fields and cycles without a copy.

mod arrays;
mod blocks;
mod body;
mod failure;
mod figure;
mod folder;
mod history;
mod measured;
mod record;
mod shape;
mod source;
mod sweep;
mod wait;

use pyo3::prelude::*;

#[pymodule]
mod _contact_dma {
    #[pymodule_export]
    use crate::blocks::placed;
    #[pymodule_export]
    use crate::body::Body;
    use crate::failure;
    #[pymodule_export]
    use crate::figure::{Figure, kept_figures};
    #[pymodule_export]
    use crate::folder::files_of;
    #[pymodule_export]
    use crate::history::History;
    #[pymodule_export]
    use crate::measured::{Loops, identify_material, quantity, write_identification};
    #[pymodule_export]
    use crate::record::{
        Cycle, Field, MeasuredCycle, Peak, PressureLine, PressureProfile, Status, SurfaceLine,
        SurfaceProfile, Warning,
    };
    #[pymodule_export]
    use crate::shape::Shape;
    #[pymodule_export]
    use crate::sweep::{Sweep, packed_sweep, solve_shard};
    use std::ffi::OsString;

    use contact_dma::input::{keys::FileKind, python_calls, schema as schemas};
    use contact_dma::material::library;
    use contact_dma::sweep::store::provenance;
    use pyo3::prelude::*;

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    const BUILD: &str = provenance::BUILD;
    #[pymodule_export]
    const COMMIT: Option<&str> = provenance::COMMIT;

    /// Names and titles of the materials of the library.
    #[pyfunction]
    fn library_materials() -> Vec<(&'static str, &'static str, &'static str)> {
        let entries = library::entries().iter();
        entries.map(|e| (e.name, e.title, e.source)).collect()
    }

    /// The JSON Schema of a kind of input files, as text.
    #[pyfunction]
    fn schema(kind: &str) -> PyResult<String> {
        let mut kinds = FileKind::NAMES.iter();
        let named = kinds.find(|(name, _)| *name == kind);
        let error = || {
            let names: Vec<&str> = FileKind::NAMES.iter().map(|(name, _)| *name).collect();
            let names = names.join(", ");
            failure::of_value(format!("no files are \"{kind}\": write one of {names}"))
        };
        named
            .map(|(_, kind)| schemas::text(*kind))
            .ok_or_else(error)
    }

    /// Runs the program with these arguments, the first being its name; its exit code.
    #[pyfunction]
    fn run_program(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
        py.detach(|| contact_dma::cli::run(arguments))
    }

    /// What takes keys of the input files as its arguments, as JSON.
    #[pyfunction]
    fn calls() -> PyResult<String> {
        serde_json::to_string(&python_calls::calls()).map_err(failure::of_run)
    }
}
