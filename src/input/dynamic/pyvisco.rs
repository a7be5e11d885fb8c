//! CSV files of pyvisco (NREL/pyvisco, folder `examples` and documentation).
//!
//! Two header rows: names, then units, both with blanks behind the commas. Measured isotherms (raw): `f,E_stor,E_loss,T,Set` and
//! `Hz, MPa, MPa, C, -`, where `Set` numbers the isotherms and `T` is the measured temperature. Master curve: the same without `T`
//! and `Set`; its temperature is not in the file. `G_stor` and `G_loss` in shear. A byte order mark may precede all.
//! Files over time, `t,E_relax,...`, are not dynamic data.

use std::sync::Arc;

use super::{Reading, generic, steps};
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
            .help(steps::LEAVE_OUT)
            .into());
    }
    generic::read(source, reading)
}

#[cfg(test)]
mod tests {
    use crate::input::dynamic::DynamicFormat;
    use crate::input::dynamic::tests::{TAU, assert_points, read_text};
    use crate::material::ModulusKind;

    #[test]
    fn isotherms_and_master_curves_are_read() {
        let raw = "\u{feff}f,E_stor,E_loss,T,Set\r\nHz, MPa, MPa, C, -\r\n0.5,80,1,20.2,0\r\n1,90,2,19.8,0\r\n0.5,70,5,40,1\r\n1,75,6,40,1\r\n";
        let file = read_text(raw, ModulusKind::Longitudinal).unwrap();
        assert_eq!(file.format, DynamicFormat::Pyvisco);
        assert_eq!(file.data.isotherms().len(), 2);
        let expected = [
            [293.35, 0.5 * TAU, 8e7, 1e6],
            [292.95, TAU, 9e7, 2e6],
            [313.15, 0.5 * TAU, 7e7, 5e6],
            [313.15, TAU, 7.5e7, 6e6],
        ];
        assert_points(&file, &expected);
        let master = "f, G_stor, G_loss\nHz, GPa, GPa\n1e-9,1,0.1\n1,2,0.2\n1e9,3,0.1\n";
        let file = read_text(master, ModulusKind::Shear).unwrap();
        assert_eq!(file.data.isotherms().len(), 1);
        assert_points(
            &file,
            &[
                [0.0, 1e-9 * TAU, 1e9, 1e8],
                [0.0, TAU, 2e9, 2e8],
                [0.0, 1e9 * TAU, 3e9, 1e8],
            ],
        );
        assert!(
            read_text(master, ModulusKind::Longitudinal)
                .unwrap_err()
                .contains("--modulus shear")
        );
    }

    #[test]
    fn another_file_is_not_taken_for_one_of_pyvisco() {
        use crate::input::dynamic::from_bytes;
        let forced = |text: &str| {
            from_bytes(
                "a.csv",
                text.as_bytes(),
                Some(DynamicFormat::Pyvisco),
                ModulusKind::Longitudinal,
            )
        };
        let refused = forced("Frequency [Hz],E' [Pa],E'' [Pa]\n1,2,1\n")
            .unwrap_err()
            .to_string();
        assert!(
            refused.contains("not a file of pyvisco") && refused.contains("leave the format out"),
            "{refused}"
        );
        assert!(
            forced("t,E_relax\ns,MPa\n1,2\n")
                .unwrap_err()
                .to_string()
                .contains("--quantity relaxation")
        );
    }
}
