//! Dynamic text of Hysitron's TriboScan (Bruker, nanoDMA files `*_DYN.txt`): after readers in public repositories.
//!
//! Some lines of text, then a row of names with units, `Test Time (s)`, `Indent Disp. (nm)`, `Indent Act. Load (µN)`,
//! `Storage Mod. (GPa)`, `Loss Mod. (GPa)`, `Tan-Delta`, with a frequency among them; tabs separate cells, texts are Latin-1. The row of names is searched for. No temperature.

use std::sync::Arc;

use super::{Reading, generic};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let is_names = |line: &str| {
        line.contains("Test Time (s)") || (line.contains("Indent ") && line.contains("Storage Mod"))
    };
    let is_there = source.text().lines().take(300).any(is_names);
    is_there.then(|| "the column `Test Time (s)` or `Indent Disp. (nm)`".to_owned())
}

/// Reads the sweep.
///
/// # Errors
/// No row of names, no frequency, or what [`super::block::Block::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let Some((grid, header)) = generic::header(source) else {
        let grid = Grid::new(source, '\t');
        let names = (0..grid.len().min(300)).find(|line| grid.text(*line).contains("Mod. (GPa)"));
        return Err(Diagnostic::at(
            &grid.place(names.unwrap_or(0)),
            "no row of names with a frequency, `Storage Mod. (GPa)` and `Loss Mod. (GPa)`",
        )
        .help("export the frequency of the test with the dynamic data")
        .into());
    };
    reading.note("moduli as the instrument computed them from the contact");
    for block in generic::blocks(&grid, header) {
        reading.add(&block.by_instrument())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::input::dynamic::DynamicFormat;
    use crate::input::dynamic::tests::{TAU, assert_points, read_bytes, read_text};
    use crate::material::ModulusKind;

    const FILE: &str = "Mon Nov 2 2026\n\nNumber of Points = 3\nTest Time (s)\tIndent Disp. (nm)\tIndent Act. Load (µN)\tFrequency \
        (Hz)\tStorage Mod. (GPa)\tLoss Mod. (GPa)\tTan-Delta\n1.0\t100.0\t50.0\t10\t4.0\t0.1\t0.025\n2.0\t100.0\t50.0\t20\t4.1\t0.2\t0.05\n\
        3.0\t100.0\t50.0\t50\t4.2\t0.3\t0.07\n";

    #[test]
    fn the_row_of_names_is_searched_for() {
        let latin: Vec<u8> = FILE.chars().map(|c| c as u8).collect();
        for bytes in [FILE.as_bytes(), &latin] {
            let file = read_bytes(bytes, ModulusKind::Longitudinal).unwrap();
            assert_eq!(file.format, DynamicFormat::Hysitron);
            assert_points(
                &file,
                &[
                    [0.0, 10.0 * TAU, 4e9, 1e8],
                    [0.0, 20.0 * TAU, 4.1e9, 2e8],
                    [0.0, 50.0 * TAU, 4.2e9, 3e8],
                ],
            );
        }
    }

    #[test]
    fn a_file_without_a_frequency_is_refused() {
        let refused = read_text(
            &FILE.replace("Frequency (Hz)", "Force (nN)"),
            ModulusKind::Longitudinal,
        )
        .unwrap_err();
        assert!(
            refused.contains("dma.csv:4:1") && refused.contains("export the frequency"),
            "{refused}"
        );
    }
}
