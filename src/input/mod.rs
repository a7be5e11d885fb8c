//! Files to plans: sweep files, scenario files and the data files that they name, read with every problem reported at its place.
//!
//! Knows nothing of flags or terminals but how a diagnostic is printed.

pub mod diagnostic;
pub mod document;
mod drive_table;
pub mod field_file;
pub(crate) mod figures_block;
mod harmonic_block;
mod indenter_block;
pub mod key_reference;
pub mod keys;
pub(crate) mod material_block;
pub(crate) mod material_table;
mod points;
pub mod scenario_file;
pub mod schema;
mod segments_block;
mod separator;
pub mod sweep_file;
pub(crate) mod table_file;
