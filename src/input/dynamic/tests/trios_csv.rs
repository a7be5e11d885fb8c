//! CSV that TRIOS exports.

use crate::input::dynamic::DynamicFormat;
use crate::input::dynamic::tests::{TAU, assert_noted, assert_points, read_bytes, read_text};
use crate::material::ModulusKind;

const FILE: &str = "\u{feff}Filename,film\nOperator,Müller\nrundate,3/6/2026\nGeometry name,\"Tension, film\"\n[step]\nTemperature Sweep \
    (Multifrequency) - 2\nAngular frequency,Temperature,Storage modulus,Loss modulus,Tan(delta),Frequency\nrad/s,°C,MPa,MPa,,Hz\n\
    6.283185307179586,0.1,2000,100,0.05,1\n62.83185307179586,0.0,2200,90,0.0409,10\n[step]\nTemperature Sweep (Multifrequency) - 3\n\
    Angular frequency,Temperature,Storage modulus,Loss modulus\nrad/s,°C,MPa,MPa\n6.283185307179586,20.0,1000,200\n\
    62.83185307179586,20.1,1200,190\n[step]\nTTS - shift factors\nTemperature,aT (x variable)\n°C,\n0,10\n20,1\n[step]\nTTS - master curve \
    (20.0 °C)\nFrequency,Storage modulus,Loss modulus\nHz,MPa,MPa\n1,1000,200\n10,1200,190\n100,2200,90\n";

const EXPECTED: [[f64; 4]; 4] = [
    [273.25, TAU, 2e9, 1e8],
    [273.15, 10.0 * TAU, 2.2e9, 9e7],
    [293.15, TAU, 1e9, 2e8],
    [293.25, 10.0 * TAU, 1.2e9, 1.9e8],
];

#[test]
fn measured_steps_are_read_and_derived_ones_are_not() {
    let file = read_text(FILE, ModulusKind::Longitudinal).unwrap();
    assert_eq!(file.format, DynamicFormat::TriosCsv);
    assert_points(&file, &EXPECTED);
    let notes = file.notes.join("\n");
    for step in ["TTS - shift factors", "TTS - master curve (20.0 °C)"] {
        assert!(
            notes.contains(&format!(
                "step `{step}` passed over: computed from the others"
            )),
            "{notes}"
        );
    }
}

#[test]
fn a_stray_byte_changes_nothing_but_itself() {
    let mut bytes = FILE.as_bytes().to_vec();
    let at = bytes
        .windows(2)
        .position(|pair| pair == "ü".as_bytes())
        .unwrap();
    bytes[at + 1] = b'?';
    let file = read_bytes(&bytes, ModulusKind::Longitudinal).unwrap();
    assert_points(&file, &EXPECTED);
    assert_noted(&file, "1 byte is no UTF-8");
    // The whole in Latin-1.
    let latin: Vec<u8> = FILE.chars().skip(1).map(|c| c as u8).collect();
    assert_points(
        &read_bytes(&latin, ModulusKind::Longitudinal).unwrap(),
        &EXPECTED,
    );
}

#[test]
fn semicolons_separate_cells_where_commas_separate_decimals() {
    let table = FILE.replace(',', ";").replace('.', ",");
    assert_points(
        &read_text(&table, ModulusKind::Longitudinal).unwrap(),
        &EXPECTED,
    );
}

#[test]
fn a_wrong_cell_is_shown_and_a_file_without_steps_refused() {
    let refused = read_text(
        &FILE.replace(",1000,200\n6", ",1e3,two\n6"),
        ModulusKind::Longitudinal,
    )
    .unwrap_err();
    assert!(
        refused.contains("dma.csv:15:") && refused.contains("`Loss modulus` must be a number"),
        "{refused}"
    );
    let only_derived = FILE.replace("Temperature Sweep", "TTS");
    let refused = read_text(&only_derived, ModulusKind::Longitudinal).unwrap_err();
    assert!(
        refused.contains("no step with storage and loss modulus over frequency"),
        "{refused}"
    );
}
