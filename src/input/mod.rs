//! Files to plans: sweep files, scenario files and the data files that they name, read with every problem reported at its place.
//!
//! Knows nothing of flags or terminals but how a diagnostic is printed.
//!
//! ```
//! use contact_dma::input::diagnostic::{Diagnostics, Styling};
//! use contact_dma::input::document::Document;
//! use contact_dma::input::sweep_file;
//!
//! let text = r#"
//! title = "PMMA under a sphere"
//! [material]
//! library = "pmma"
//! [indenter]
//! shape = "sphere"
//! radius = "10 mm"
//! [drive]
//! mean = "10 N"
//! amplitude = "5 N"
//! [sweep]
//! frequency = ["1 mHz"]
//! "#;
//! let plan = sweep_file::plan(&Document::parse("sweep.toml", text)?)?;
//! assert_eq!(plan.base.drive.mean(), 10.0);
//!
//! let wrong = text.replace("mm", "mn");
//! let refused = sweep_file::plan(&Document::parse("sweep.toml", &wrong)?).unwrap_err();
//! assert!(refused.render(Styling::Plain).contains("sweep.toml:7:10"));
//! # Ok::<(), Diagnostics>(())
//! ```

mod adhesion_block;
mod assignment;
pub(crate) mod axis;
mod bodies_block;
pub(crate) mod data_file;
pub mod diagnostic;
pub mod document;
mod drive_table;
pub mod dynamic;
pub mod field_file;
pub(crate) mod figures_block;
mod file_kind;
mod force_curves;
pub mod given;
mod harmonic_block;
pub mod identify_file;
mod indenter_block;
pub mod key_reference;
pub mod keys;
pub mod loop_file;
mod map_values;
pub(crate) mod material_block;
pub(crate) mod material_dynamic;
mod material_fractional;
pub(crate) mod material_table;
mod material_temperature;
mod measured_history;
mod measured_table;
mod points;
pub mod python_calls;
pub mod scenario_file;
pub mod schema;
pub(crate) mod segments_block;
pub mod setup_file;
mod solver_block;
pub mod sweep_file;
pub(crate) mod table_file;
