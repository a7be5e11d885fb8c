//! Exports of RheoCompass.

use crate::input::dynamic::DynamicFormat;
use crate::input::dynamic::tests::{assert_noted, assert_points, read_bytes, read_text};
use crate::material::ModulusKind;

const FILE: &str = "Project:\tpolymer\r\nTest:\tFrequency sweep\r\n\r\nResult:\tFS 25 °C\r\n\r\nInterval and data \
    points:\t1\t3\r\nInterval data:\tPoint No.\tTemperature\tAngular Frequency\tStorage Modulus\tLoss Modulus\tStatus\r\n\
    \t\t\t\t\t\t\r\n\t\t[°C]\t[rad/s]\t[Pa]\t[mPa]\t\r\n\t1\t25.1\t100\t3000\t5E+05\tWMa,TruStrain\r\n\t2\t25.0\t10\t2000\t4E+05\t\r\n\
    \tx\t25.0\t5\t1\t1\tME-\r\n\t3\t24.9\t1\t1000\t3E+05\t\r\n\r\nResult:\tFS 50 °C\r\nInterval and data points:\t1\t2\r\n\
    Interval data:\tPoint No.\tTemperature\tAngular Frequency\tStorage Modulus\tLoss Modulus\tStatus\r\n\t\t\t\t\t\t\r\n\
    \t\t[°C]\t[rad/s]\t[Pa]\t[mPa]\t\r\n\t1\t50\t100\t300\t5E+04\t\r\n\t2\t50\t10\t200\t4E+04\t\r\n";

const EXPECTED: [[f64; 4]; 5] = [
    [298.05, 1.0, 1000.0, 300.0],
    [298.15, 10.0, 2000.0, 400.0],
    [298.25, 100.0, 3000.0, 500.0],
    [323.15, 10.0, 200.0, 40.0],
    [323.15, 100.0, 300.0, 50.0],
];

#[test]
fn intervals_are_read_from_every_encoding_and_delimiter() {
    let utf_16: Vec<u8> = FILE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    for bytes in [
        FILE.as_bytes().to_vec(),
        [b"\xff\xfe", utf_16.as_slice()].concat(),
        FILE.replace("WMa,TruStrain", "WMa")
            .replace('\t', ",")
            .into_bytes(),
        FILE.replace("WMa,TruStrain", "WMa")
            .replace('\t', ";")
            .into_bytes(),
    ] {
        let file = read_bytes(&bytes, ModulusKind::Shear).unwrap();
        assert_eq!(file.format, DynamicFormat::RheoCompass);
        assert_points(&file, &EXPECTED);
        assert_noted(&file, "invalid");
    }
}

#[test]
fn names_and_decimals_may_be_those_of_another_language() {
    let german = "Messpunkt\tKreisfrequenz\tSpeichermodul\tVerlustmodul\tVerlustfaktor\tTemperatur\n\n\t[1/s]\t[MPa]\t[MPa]\t[1]\t[°C]\n\
                  1\t0,5\t1,5\t0,25\t0,1667\t25\n2\t5\t2,5\t0,5\t0,2\t25,1\n\t3\t50\t3,5\t0,75\t0,21\t25,2\n";
    let file = read_text(german, ModulusKind::Shear).unwrap();
    assert_eq!(file.format, DynamicFormat::RheoCompass);
    assert_points(
        &file,
        &[
            [298.15, 0.5, 1.5e6, 2.5e5],
            [298.25, 5.0, 2.5e6, 5e5],
            [298.35, 50.0, 3.5e6, 7.5e5],
        ],
    );
}

#[test]
fn what_is_no_sweep_is_refused() {
    let refused = read_text(
        &FILE.replace("Storage Modulus", "Shear Stress"),
        ModulusKind::Shear,
    )
    .unwrap_err();
    assert!(
        refused.contains("no step with storage and loss modulus"),
        "{refused}"
    );
    let refused = read_text(&FILE.replace("[rad/s]", "rad/s"), ModulusKind::Shear).unwrap_err();
    assert!(refused.contains("units in brackets"), "{refused}");
    let refused = read_text(
        &FILE.replace("\t100\t3000", "\t1,00\t3.000"),
        ModulusKind::Shear,
    )
    .unwrap_err();
    assert!(
        refused.contains("decimal comma in a file with decimal points"),
        "{refused}"
    );
}
