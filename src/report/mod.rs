//! Tables and figures, from records alone: nothing here solves anything.
//!
//! The feature `tables` has columns and tables alone, the feature `report` figures and pages too.
//!
//! Its parts from top to bottom, each of which may use those above it: numbers, words, text that is laid out for a terminal; peaks; lines over the surface;
//! tables, and the quantities that are their columns, by which they are read back too; laws in words; tables of sweeps and scenarios; captions; comparison; chart; figure; material; page; figures that are kept; what an identification leaves; summary and results for
//! programs; terminal; what a computation would cost; scenario. A test holds them to that.
//!
//! ```
//! use contact_dma::prelude::*;
//! use contact_dma::report;
//! use contact_dma::sweep::case::Setup;
//! use contact_dma::sweep::plan::resolved::resolved_text;
//! use contact_dma::sweep::store::Store;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let folder = folder.path();
//! let pmma = library::find("pmma").ok_or("not in the library")?.material()?;
//! let sweep = Sweep::new(pmma, Sphere::new(0.01)?, HarmonicDrive::load(10.0, 5.0)?);
//! let sweep = sweep.title("PMMA").steps(32)?.springs(32)?.frequencies_hz([1e-4, 1e-3, 1e-2])?;
//! let outcome = sweep.clone().solve()?;
//! // As the program prepares it: the half-space engine takes its cells from some indenters.
//! let setup = Setup::new(sweep.into_plan())?;
//! let store = Store::open(folder, &resolved_text(setup.plan()), false)?;
//! report::write_sweep(&store, setup.plan(), &outcome)?;
//! assert!(folder.join("sweep.csv").exists() && folder.join("figures/energy-loss.svg").exists());
//! # Ok(())
//! # }
//! ```

#[cfg(feature = "report")]
pub mod caption;
#[cfg(feature = "report")]
pub mod chart;
#[cfg(feature = "report")]
pub mod comparison;
pub mod cycles;
pub mod dynamic;
#[cfg(feature = "report")]
pub mod figure;
pub mod fit;
pub mod force_curve;
#[cfg(feature = "report")]
pub mod forecast;
#[cfg(feature = "report")]
pub mod identified;
pub mod identify;
#[cfg(feature = "report")]
pub mod kept_figures;
pub mod laws;
pub mod machine;
#[cfg(feature = "report")]
pub mod material;
pub mod measured;
pub mod npy;
pub mod number;
#[cfg(feature = "report")]
pub mod page;
#[cfg(feature = "report")]
pub mod peaks;
pub mod profile_lines;
pub mod quantities;
#[cfg(feature = "report")]
pub mod rigid_indenter;
#[cfg(feature = "report")]
pub mod samples;
#[cfg(feature = "report")]
pub mod scenario;
pub mod scenario_folder;
pub mod scenario_tables;
pub mod summary;
pub mod sweep_tables;
pub mod table;
pub mod table_reader;
#[cfg(feature = "report")]
pub mod terminal;
#[cfg(feature = "report")]
pub mod terminal_simulation;
pub mod text;
pub mod vti;
pub mod warnings;
pub mod words;
pub mod work_line;

#[cfg(feature = "report")]
mod sweep_files;

#[cfg(feature = "report")]
pub use sweep_files::{load_drawn_cycles, write_sweep, write_tables_of_sweep};

use crate::figures::elastic::NoScale;
use crate::sweep::store::StoreError;

/// Why a report cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    #[error(transparent)]
    Store(#[from] StoreError),
    #[cfg(feature = "report")]
    #[error("cannot draw {name}: {source}")]
    Chart {
        name: String,
        source: chart::ChartError,
    },
    #[error("cannot normalise the figures: {0}")]
    Scale(#[from] NoScale),
    #[error("cannot make the table {name}: {reason}")]
    Table { name: &'static str, reason: String },
}
