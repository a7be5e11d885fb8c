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
mod folder;
mod history;
mod measured;
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
    #[pymodule_export]
    use crate::history::{History, restore_history, simulate};
    #[pymodule_export]
    use crate::measured::{analyse, identify_material, quantity, restore_analysis, write_files};
    #[pymodule_export]
    use crate::shape::Shape;
    #[pymodule_export]
    use crate::sweep::{Sweep, read_sweep, restore_sweep, sweep};
    use contact_dma::material::library;
    use pyo3::prelude::*;

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// Names and titles of the materials of the library.
    #[pyfunction]
    fn library_materials() -> Vec<(&'static str, &'static str, &'static str)> {
        let entries = library::entries().iter();
        entries.map(|e| (e.name, e.title, e.source)).collect()
    }
}
