//! LIMS text that TRIOS exports.

use crate::input::dynamic::DynamicFormat;
use crate::input::dynamic::tests::{assert_points, read_text};
use crate::material::ModulusKind;

const HEAD: &str = "[Version]\nTA Instruments LIMS export format version\t0\n[Header]\nRun date\t1/2/2026\n[Procedure: Steps]\nStep \
                    1\tOscillation\n";

fn step(name: &str, modulus_unit: &str, rows: &[&str]) -> String {
    let rows: String = rows
        .iter()
        .map(|row| format!("Data point\t{row}\n"))
        .collect();
    format!(
        "[Step]\nStep name\t{name}\nNumber of points\t2\nVariables\tRun time\tTemperature\tAngular frequency\tOscillation \
         torque\tStatus bits\tDate and time\tFrequency\tTan(delta)\tComplex modulus\tStorage modulus\tLoss modulus\tG*/sin(delta)\n\
         Units\ts\t°C\trad/s\tg.cm\t\t\tHz\t\tPa\t{modulus_unit}\t{modulus_unit}\tkPa\n{rows}"
    )
}

fn file() -> String {
    let first = step(
        "Frequency sweep (150.0 °C)",
        "Pa",
        &[
            "1.5\t149.98\t2\t0.1\t0xB6453\t6/26/2023 1:43:31 PM\t0.31831\t0.25\t1\t20000\t5000\t1",
            "2.5\t149.96\t4\t0.1\t0xB6453\t6/26/2023 1:43:46 PM\t0.63662\t0.25\t1\t40000\t10000\t1",
        ],
    );
    let second = step(
        "Frequency sweep (130.0 °C)",
        "MPa",
        &[
            "1.5\t130.01\t2\t0.1\t0xB6\t6/26/2023\t0.31831\t0.25\t1\t0.05\t0.01\t1",
            "2.5\t130.03\t4\t0.1\t0xB6\t6/26/2023\t0.63662\t0.25\t1\t0.07\t-0.01\t1",
            "3.5\t130.03\t8\t0.1\t0xB6\t6/26/2023\t1.27\t0.25\t1\t0.09\t0.03\t1",
        ],
    );
    format!("{HEAD}{first}{second}")
}

#[test]
fn every_step_is_an_isotherm_in_its_own_units() {
    let read = read_text(&file(), ModulusKind::Shear).unwrap();
    assert_eq!(read.format, DynamicFormat::TriosLims);
    assert_eq!(read.data.isotherms().len(), 2);
    assert_points(
        &read,
        &[
            [403.16, 2.0, 5e4, 1e4],
            [403.18, 8.0, 9e4, 3e4],
            [423.13, 2.0, 2e4, 5e3],
            [423.11, 4.0, 4e4, 1e4],
        ],
    );
    let notes = read.notes.join("\n");
    assert!(
        notes.contains("1 row passed over: a value is not positive")
            && notes.contains("dma.csv:20"),
        "{notes}"
    );
    assert!(
        notes.contains("2 points are announced, and 3 are there"),
        "{notes}"
    );
    // Where no column holds the temperature, the name of the step does.
    let without = file()
        .replace("\tTemperature\t", "\tAxial force\t")
        .replace("°C\trad", "N\trad");
    let read = read_text(&without, ModulusKind::Shear).unwrap();
    assert_eq!(read.data.isotherms()[0].temperature_k, Some(403.15));
}

#[test]
fn what_cannot_be_read_is_refused_at_its_place() {
    for (from, to, reason) in [
        (
            "modulus",
            "compliance",
            "no step with storage and loss modulus over frequency",
        ),
        ("[Step]", "[Steps]", "no part `[Step]`"),
        ("\t20000\t", "\t2e4x\t", "dma.csv:12:"),
        ("\trad/s\t", "\tfurlong\t", "`furlong` is no unit"),
    ] {
        let refused = read_text(&file().replace(from, to), ModulusKind::Shear).unwrap_err();
        assert!(refused.contains(reason), "{from}: {refused}");
    }
}
