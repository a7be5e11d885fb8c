//! Text that TRIOS (TA Instruments) exports: after public files of the Discovery rheometers (DHR, 2020) and of TRIOS 4.5.
//!
//! Lines `Filename TAB ...`, `Instrument name TAB ...`, `proceduresegments TAB ...`, then `[File Parameters]` and other parts. Every
//! step opens with `[step]` in lower case, then its name, a row of names, a row of units, and rows without a label. Steps of several
//! kinds are in one file: sweeps of frequency and of amplitude, ramps, waveforms.

use std::sync::Arc;

use super::{Reading, steps};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let text = source.text();
    let has_step = text
        .lines()
        .any(|line| line.trim().eq_ignore_ascii_case("[step]"));
    let has_head = text.lines().take(40).any(|line| {
        [
            "Filename\t",
            "proceduresegments\t",
            "[File Parameters]",
            "Instrument name\t",
            "Geometry name\t",
        ]
        .iter()
        .any(|head| line.starts_with(head))
    });
    (has_step && has_head).then(|| "lines `[step]` and a head of TRIOS".to_owned())
}

/// Reads the frequency sweeps.
///
/// # Errors
/// No step, or what [`steps::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let grid = Grid::new(source, '\t');
    let none = "not a text of TRIOS: it has no line `[step]`";
    let none = [none, steps::LEAVE_OUT];
    steps::read(&grid, &steps::bracketed(&grid), none, reading)
}

#[cfg(test)]
mod tests {
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
}
