//! Files of pyvisco.

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
