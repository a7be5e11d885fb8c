//! What programs of instruments export: texts with settings above their table, and workbooks with a sheet for every test. Each is read as the
//! table in it.

use super::table;
use crate::force_curve::ForceCurve;
use crate::force_curve::resolved::Probe;
use crate::input::data_file::workbook;
use crate::input::diagnostic::{Diagnostic, Diagnostics};

/// A text of an instrument: what its first lines hold, how the names of its table begin, and columns that are not taken.
struct Export {
    mark: &'static str,
    names: &'static str,
    passed_over: &'static str,
}

/// Lines that are looked at for a mark.
const HEAD: usize = 40;

const EXPORTS: [Export; 2] = [
    // Chiaro and Piuma of Optics11, after files of AFM-analysis/afmformats: its indentation is zero before the contact that its own program
    // has found; position and bending of the cantilever are as measured.
    Export {
        mark: "Device:\tChiaro",
        names: "Time (s)\tLoad (uN)",
        passed_over: "Indentation (nm)",
    },
    // Hysitron (Bruker), `.hld`, after files of micromechanics/micromechanics: tables of the approach and of the drift come before that of
    // the test.
    Export {
        mark: "File Version: Hysitron",
        names: "Time_s\tDisp_nm\tForce_",
        passed_over: "",
    },
];

/// The text of an instrument as a table, whose lines have the numbers that they have in the file; `None` of other bytes.
pub(super) fn as_table(bytes: &[u8]) -> Option<String> {
    // These programs write Latin-1.
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    };
    let is_marked = |export: &&Export| {
        let head = text.lines().take(HEAD);
        head.into_iter().any(|line| line.starts_with(export.mark))
    };
    let export = EXPORTS.iter().find(is_marked)?;
    let names = text
        .lines()
        .enumerate()
        .filter(|(_, line)| line.starts_with(export.names));
    let (header, _) = names.last()?;
    let lines = text.lines().enumerate().map(|(number, line)| match number {
        number if number < header => format!("# {line}\n"),
        number if number == header => {
            let cells = line.trim_end().split('\t').enumerate();
            let cells = cells.map(|(place, cell)| match cell == export.passed_over {
                true => format!("not taken {place}"),
                false => cell.to_owned(),
            });
            cells.collect::<Vec<_>>().join("\t") + "\n"
        }
        _ => format!("{}\n", line.trim_end()),
    });
    Some(lines.collect())
}

/// What the columns of a sheet with a test are in NanoSuite (Agilent, Keysight, KLA), after a file of micromechanics/micromechanics, and what
/// they are called in a table.
const NAMES: [(&str, &str); 3] = [
    ("Time On Sample", "time"),
    ("Load On Sample", "force"),
    ("Displacement Into Surface", "indentation"),
];

/// The tests of a workbook.
///
/// # Errors
/// A workbook that cannot be read, or has no sheet with a test; what a table is refused for.
pub(super) fn of_workbook(
    name: &str,
    bytes: &[u8],
    probe: &Probe,
) -> Result<Vec<ForceCurve>, Diagnostics> {
    let mut curves = Vec::new();
    for (sheet, text) in workbook::read(name, bytes)? {
        let mut lines = text.lines();
        let (Some(names), Some(units)) = (lines.next(), lines.next()) else {
            continue;
        };
        let names: Vec<&str> = names.split('\t').collect();
        if !NAMES.iter().all(|(wanted, _)| names.contains(wanted)) {
            continue;
        }
        let units: Vec<&str> = units.split('\t').collect();
        let with_units = names.iter().enumerate().map(|(place, name)| {
            let known = NAMES.iter().find(|(wanted, _)| wanted == name);
            match known.zip(units.get(place)) {
                Some(((_, name), unit)) => format!("{name} ({unit})"),
                None => format!("not taken {place}"),
            }
        });
        // The row of units stands as a comment, so that rows keep their numbers.
        let with_units = with_units.collect::<Vec<_>>().join("\t");
        let rows = lines.filter(|row| row.split('\t').count() == names.len());
        let rows: String = rows.map(|row| format!("{row}\n")).collect();
        let text = format!("{with_units}\n# units\n{rows}");
        let read = table::parse(&format!("{name}[{sheet}]"), text.as_bytes(), probe)?;
        curves.extend(read.into_iter().map(|curve| ForceCurve {
            name: sheet.clone(),
            ..curve
        }));
    }
    match curves.is_empty() {
        false => Ok(curves),
        true => Err(Diagnostic::new(format!("the workbook `{name}` has no sheet with a force curve"))
            .because(format!("such a sheet has columns named {}", NAMES.map(|(name, _)| format!("`{name}`")).join(", ")))
            .help("save the sheet of the curve as CSV, with columns `time_s`, `force_n` and `indentation_m`")
            .into()),
    }
}
