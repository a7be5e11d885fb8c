//! Text and CSV that RheoCompass (Anton Paar) exports: after files and readers in public repositories.
//!
//! UTF-16 with a byte order mark, or UTF-8; cells are separated by tabs, or by commas or semicolons. `Project:`, `Test:`, `Result:` and
//! `Interval and data points:`, the number of the interval and that of its points. Then the names, behind the label `Interval data:`; an
//! empty row; units in brackets, `[rad/s]`; rows that begin with an empty cell and the number of the point. Some exports hold only the
//! names. Names and labels are in the language of the program, and numbers have its decimal sign. `[mPa]` is a thousandth of a pascal.
//! A point that the program takes for invalid has no number.

use std::sync::Arc;

use super::block::Block;
use super::{Reading, steps};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostics, Source};

/// Why a text is taken for this format.
pub(super) fn detect(source: &Arc<Source>) -> Option<String> {
    let labels = [
        "Interval and data points:",
        "Interval data:",
        "Intervall und Messpunkte",
        "Intervalldaten",
    ];
    let label = labels.iter().find(|label| source.text().contains(*label));
    label
        .map(|label| format!("the label `{label}`"))
        .or_else(|| {
            let grid = Grid::new(source, '\t');
            let has_units = (1..grid.len().min(60)).any(|line| is_header(&grid, line - 1));
            has_units.then(|| "a row of units in brackets below the names".to_owned())
        })
}

/// Reads the frequency sweeps.
///
/// # Errors
/// No names with units in brackets below them, or what [`steps::read`] refuses.
pub(super) fn read(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let mut best: Option<(Grid, Vec<usize>)> = None;
    for grid in Grid::every(source).filter(|grid| grid.delimiter() != ' ') {
        let lines = (0..grid.len()).filter(|line| is_header(&grid, *line));
        let headers: Vec<usize> = lines.collect();
        if headers.len() > best.as_ref().map_or(0, |(_, most)| most.len()) {
            best = Some((grid, headers));
        }
    }
    let (grid, headers) = best.unwrap_or_else(|| (Grid::new(source, '\t'), Vec::new()));
    let ends = headers.iter().skip(1).copied().chain([grid.len()]);
    let blocks: Vec<Block<'_>> = headers
        .iter()
        .zip(ends)
        .map(|(header, end)| interval(&grid, *header, end, reading))
        .collect();
    let none = [
        "not an export of RheoCompass: no names with units in brackets below them",
        "export with names and units, or leave the format out, to have it found",
    ];
    steps::read(&grid, &blocks, none, reading)
}

/// Whether a line holds names, that is, the next one units in brackets.
fn is_header(grid: &Grid, line: usize) -> bool {
    let units = grid.line(line + 1);
    let filled = || units.texts().filter(|text| !text.is_empty());
    let is_bracketed = |text: &str| text.starts_with('[') && text.ends_with(']');
    filled().count() >= 2 && filled().all(is_bracketed) && grid.line(line).len() >= 2
}

fn interval<'a>(grid: &'a Grid, header: usize, next: usize, reading: &mut Reading) -> Block<'a> {
    let mut block = Block::new(grid, header, next).by_instrument();
    block.section.units = Some(grid.line(header + 1));
    // Behind the rows stands the label of another part.
    let is_label = |line: &usize| {
        let first = grid.line(*line);
        first.text(0).ends_with(':')
            || first.text(0).parse::<f64>().is_err()
                && !first.text(0).is_empty()
                && first.len() == 1
    };
    let first = header + 2;
    let end = (first..next).find(is_label).unwrap_or(next);
    block.section.rows = first.min(end)..end;
    block.name = name(grid, header);
    block.temperature_k = block.name.as_deref().and_then(steps::temperature_in);
    block.section.skipped = invalid(grid, &block);
    if !block.section.skipped.is_empty() {
        reading.note(format!(
            "{} points passed over: their number says that they are invalid",
            block.section.skipped.len()
        ));
    }
    block
}

/// What `Result:` or `Test:` above the header says.
fn name(grid: &Grid, header: usize) -> Option<String> {
    let above = (header.saturating_sub(12)..header)
        .rev()
        .map(|line| grid.line(line));
    let mut labels = above.take_while(|line| line.text(0).ends_with(':'));
    let label = labels.find(|line| ["Result:", "Ergebnis:", "Test:"].contains(&line.text(0)))?;
    Some(label.text(1).to_owned())
}

/// Rows whose point has no number, where points are numbered.
fn invalid(grid: &Grid, block: &Block<'_>) -> Vec<usize> {
    let names = [
        "point no.",
        "point no",
        "meas. pts.",
        "messpunkt",
        "punkt nr.",
        "mess-pkt.",
        "nr.",
        "no.",
    ];
    let place = block
        .section
        .header
        .texts()
        .position(|text| names.contains(&text.to_lowercase().as_str()));
    let Some(place) = place else {
        return Vec::new();
    };
    let is_valid = |line: &usize| {
        grid.line(*line)
            .aligned(block.section.header.len())
            .is_number(place)
    };
    if !block.section.rows.clone().any(|line| is_valid(&line)) {
        return Vec::new();
    }
    block
        .section
        .rows
        .clone()
        .filter(|line| !is_valid(line))
        .collect()
}

#[cfg(test)]
mod tests {
    use crate::input::dynamic::DynamicFormat;
    use crate::input::dynamic::tests::{assert_points, read_bytes, read_text};
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
            assert!(
                file.notes.iter().any(|note| note.contains("invalid")),
                "{:?}",
                file.notes
            );
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
}
