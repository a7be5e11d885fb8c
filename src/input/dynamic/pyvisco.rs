//! CSV files of pyvisco (NREL/pyvisco, folder `examples` and documentation).
//!
//! Two header rows: names, then units, both with blanks behind the commas. Measured isotherms (raw): `f,E_stor,E_loss,T,Set` and
//! `Hz, MPa, MPa, C, -`, where `Set` numbers the isotherms and `T` is the measured temperature. Master curve: the same without `T`
//! and `Set`; its temperature is not in the file. `G_stor` and `G_loss` in shear. A byte order mark may precede all.
//! Files over time, `t,E_relax,...`, are not dynamic data.

use std::sync::Arc;

use super::{Reading, generic};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let grid = Grid::new(source, ',');
    let header = grid.line(0);
    let has = |names: [&str; 2]| {
        names
            .iter()
            .any(|name| header.texts().any(|text| text == *name))
    };
    let is_dynamic = has(["f", "omega"]) && has(["E_stor", "G_stor"]);
    let is_over_time = has(["t", "t"]) && has(["E_relax", "G_relax"]);
    (is_dynamic || is_over_time).then(|| format!("the names `{}`", grid.text(0)))
}

/// Reads the isotherms.
///
/// # Errors
/// No such names, a file over time, or what [`generic::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let grid = Grid::new(source, ',');
    let has_relaxation = grid
        .line(0)
        .texts()
        .any(|text| matches!(text, "E_relax" | "G_relax"));
    if has_relaxation {
        return Err(Diagnostic::at(
            &grid.place(0),
            "relaxation over time, not storage and loss modulus over frequency",
        )
        .help("give pyvisco's frequency file, or read this one with `--quantity relaxation`")
        .into());
    }
    if detect(source).is_none() {
        return Err(Diagnostic::at(&grid.place(0), "not a file of pyvisco")
            .because("the first line should be `f,E_stor,E_loss,T,Set`")
            .help("leave the format out, to have it found")
            .into());
    }
    generic::read(source, reading)
}
