//! Files of RepTate.

use crate::input::dynamic::DynamicFormat;
use crate::input::dynamic::tests::{assert_noted, assert_points, read_bytes, read_text};
use crate::material::ModulusKind;

const OSC: &str = "T=-10;Mw=94.9;chem=PI;label=PI88k;PDI=1.03;\nFreq\tG'\tG\"\tTemp\tStrain\tTorque\tTemp\nrad/s\tPa\tPa\t°C\t%\tN-m\t°C\n\
    \t 100\t 3.4801E5\t 70871\t -9.99\t 0.9\t1\t1\n  10   2E5 5E4 -10.1 0.9 1 1\n1\t1E5\t-2E4\n0.1\t1E4\t2E3\n";

#[test]
fn the_first_three_columns_and_the_temperature_of_the_head_are_read() {
    let expected = [
        [263.15, 0.1, 1e4, 2e3],
        [263.15, 10.0, 2e5, 5e4],
        [263.15, 100.0, 348_010.0, 70_871.0],
    ];
    let latin: Vec<u8> = OSC.chars().map(|c| c as u8).collect();
    for bytes in [OSC.as_bytes(), &latin] {
        let file = read_bytes(bytes, ModulusKind::Shear).unwrap();
        assert_eq!(file.format, DynamicFormat::Reptate);
        assert_points(&file, &expected);
        assert_noted(&file, "1 row passed over");
    }
    let tts = "C1=8.8;T = -35 ;isof=true;Mw=1131;\n1e-3 100 1000\n1 2e4 3e4\n1e3\t5e5\t1e5\n";
    let file = read_text(tts, ModulusKind::Shear).unwrap();
    assert_points(
        &file,
        &[
            [238.15, 1e-3, 100.0, 1000.0],
            [238.15, 1.0, 2e4, 3e4],
            [238.15, 1e3, 5e5, 1e5],
        ],
    );
    assert_noted(&file, "no row of units");
    let kilopascal = OSC.replace("\tPa\tPa\t", "\tkPa\tkPa\t");
    let file = read_text(&kilopascal, ModulusKind::Shear).unwrap();
    assert_eq!(file.data.isotherms()[0].points[0].storage_modulus_pa, 1e7);
}

#[test]
fn what_cannot_be_read_is_refused_at_its_place() {
    assert!(
        read_text(OSC, ModulusKind::Longitudinal)
            .unwrap_err()
            .contains("--modulus shear")
    );
    let refused = read_text(&OSC.replace("T=-10", "T=cold"), ModulusKind::Shear).unwrap_err();
    assert!(refused.contains("`T=cold` is no temperature"), "{refused}");
    let refused = read_text(&OSC.replace("10   2E5", "10   x"), ModulusKind::Shear).unwrap_err();
    assert!(
        refused.contains("dma.csv:5:8") && refused.contains("storage moduli must be a number"),
        "{refused}"
    );
    let refused = read_text(&OSC.replace("rad/s", "Hz"), ModulusKind::Shear).unwrap_err();
    assert!(
        refused.contains("dma.csv:3:1") && refused.contains("`Hz` is no unit of the column"),
        "{refused}"
    );
    let refused = read_text("T=1;\n", ModulusKind::Shear).unwrap_err();
    assert!(refused.contains("at least 3 points"), "{refused}");
}
