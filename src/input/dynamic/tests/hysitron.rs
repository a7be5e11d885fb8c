//! Dynamic text of Hysitron.

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
