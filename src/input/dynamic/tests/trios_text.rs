//! Text that TRIOS exports.

use crate::input::dynamic::DynamicFormat;
use crate::input::dynamic::tests::{assert_points, read_text};
use crate::material::ModulusKind;

const FILE: &str = "Filename\tsaos_1\nInstrument name\t5333-0052\nproceduresegments\tFrequency sweep#Amplitude sweep\n[File \
    Parameters]\nName\tsaos_1\nTrios version\t4.5\n[step]\nFrequency sweep - 1\nStorage modulus\tLoss modulus\tTan(delta)\tAngular \
    frequency\tTemperature\nPa\tPa\t\trad/s\t°C\n100\t10\t0.1\t1\t24.9\n200\t30\t0.15\t10\t25.1\n300\t50\t0.2\t100\t25.0\n[step]\n\
    Amplitude sweep - 2\nStorage modulus\tLoss modulus\tAngular frequency\tStrain\tTemperature\nPa\tPa\trad/s\t%\t°C\n100\t10\t6.28\t1\t25\n\
    90\t-10\t6.28\t10\t25\n80\t12\t6.28\t100\t25\n[step]\nArbitrary Wave - 3\nStep time\tStress\ns\tPa\n0\t1\n[step]\nEmpty\n";

#[test]
fn frequency_sweeps_are_read_among_other_steps() {
    let file = read_text(FILE, ModulusKind::Shear).unwrap();
    assert_eq!(file.format, DynamicFormat::TriosText);
    let expected = [
        [298.05, 1.0, 100.0, 10.0],
        [298.25, 10.0, 200.0, 30.0],
        [298.15, 100.0, 300.0, 50.0],
    ];
    assert_points(&file, &expected);
    let notes = file.notes.join("\n");
    assert!(
        notes.contains("`Amplitude sweep - 2` passed over: it does not vary the frequency"),
        "{notes}"
    );
    assert!(
        notes.contains("`Arbitrary Wave - 3` passed over: no column of frequencies"),
        "{notes}"
    );
}

#[test]
fn a_file_without_frequency_sweeps_says_what_to_export() {
    let refused = read_text(
        &FILE
            .replace("Loss modulus", "Loss compliance")
            .replace("Tan(delta)", "x"),
        ModulusKind::Shear,
    );
    let refused = refused.unwrap_err();
    assert!(
        refused.contains("no step with storage and loss modulus")
            && refused.contains("export the columns"),
        "{refused}"
    );
}
