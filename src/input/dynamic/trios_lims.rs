//! LIMS text that TRIOS (TA Instruments) exports: after the files of 3mcloud/hermes-rheo (`tests/fileio/test_data`, ARES-G2, 2023).
//!
//! The first lines are `[Version]` and `TA Instruments LIMS export format version TAB 0`; parts in brackets follow. Every isotherm is a
//! part `[Step]`: `Step name TAB Frequency sweep (150.0 °C)`, `Number of points TAB 17`, `Variables TAB ...`, `Units TAB ...`, rows
//! `Data point TAB ...`. Units differ between files of one run and are empty for some of the dozens of columns; cells hold status words
//! like `0xB6453`, dates, and texts cut short.

use std::sync::Arc;

use super::block::Block;
use super::{Reading, steps};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let has = |what: &str| {
        source
            .text()
            .lines()
            .take(10)
            .any(|line| line.contains(what))
    };
    has("LIMS export format")
        .then(|| "the line `TA Instruments LIMS export format version`".to_owned())
}

/// Reads the frequency sweeps.
///
/// # Errors
/// No step, fewer points than announced, or what [`steps::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let grid = Grid::new(source, '\t');
    let is_step = |line: &usize| grid.text(*line).trim().eq_ignore_ascii_case("[step]");
    let starts = (0..grid.len()).filter(is_step);
    let found: Vec<Block<'_>> = starts
        .filter_map(|start| step(&grid, start, reading))
        .collect();
    let none = "not a LIMS text of TRIOS: it has no part `[Step]` with `Variables`";
    let none = [none, steps::LEAVE_OUT];
    steps::read(&grid, &found, none, reading)
}

/// The table of a part.
fn step<'a>(grid: &'a Grid, start: usize, reading: &mut Reading) -> Option<Block<'a>> {
    let end = (start + 1..grid.len())
        .find(|line| grid.text(*line).starts_with('['))
        .unwrap_or(grid.len());
    let labelled = |label: &str| {
        (start + 1..end).find(|line| grid.line(*line).text(0).eq_ignore_ascii_case(label))
    };
    let header = labelled("Variables")?;
    let name = labelled("Step name").map(|line| grid.line(line).text(1).to_owned());
    let rows = labelled("Data point").unwrap_or(end);
    let is_row = |line: &usize| grid.line(*line).text(0).eq_ignore_ascii_case("Data point");
    let last = (rows..end).find(|line| !is_row(line)).unwrap_or(end);
    let announced =
        labelled("Number of points").and_then(|line| grid.line(line).text(1).parse::<usize>().ok());
    if let Some(announced) = announced.filter(|announced| *announced != last - rows) {
        let step = name.as_deref().unwrap_or("without a name");
        reading.note(format!(
            "step `{step}`: {announced} points are announced, and {} are there",
            last - rows
        ));
    }
    let mut step = Block::new(grid, header, end).by_instrument();
    step.section.units = labelled("Units").map(|line| grid.line(line));
    step.section.rows = rows..last;
    step.temperature_k = name.as_deref().and_then(steps::temperature_in);
    step.name = name;
    Some(step)
}

#[cfg(test)]
mod tests {
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
}
