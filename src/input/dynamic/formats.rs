//! The formats of texts: by what each is known, and how it is read. The tables of RepTate and RheoCompass need more than that, and have
//! a file each.

use std::sync::Arc;

use super::block::Block;
use super::steps::{self, cell, is_step};
use super::{DynamicFormat, Reading, generic, reptate, rheocompass};
use crate::input::data_file::grid::Grid;
use crate::input::diagnostic::{Diagnostic, Diagnostics, Source};

/// What to do where a file is not of the format that was asked for.
pub(super) const LEAVE_OUT: &str = "leave the format out, to have it found";

/// A format of texts.
pub(super) struct Format {
    pub(super) format: DynamicFormat,
    /// Why a text is taken for it; `None` where it is not.
    pub(super) mark: fn(&Arc<Source>) -> Option<String>,
    pub(super) read: Read,
}

/// Reads a text.
pub(super) type Read = fn(&Arc<Source>, &mut Reading) -> Result<(), Diagnostics>;

/// Plain tables, which need no mark.
pub(super) static NAMED_COLUMNS: Format = Format {
    format: DynamicFormat::Generic,
    mark: |_| Some("named columns".to_owned()),
    read: generic::read,
};

/// Formats in the order in which they are tried.
pub(super) static OF_TEXTS: [&Format; 8] = [
    // LIMS text of TRIOS (TA Instruments), after the files of 3mcloud/hermes-rheo (`tests/fileio/test_data`, ARES-G2, 2023). The first
    // lines are `[Version]` and `TA Instruments LIMS export format version TAB 0`; parts in brackets follow, of which every `[Step]` is
    // an isotherm. Units differ between files of one run and are empty for some of the dozens of columns; cells hold status words like
    // `0xB6453`, dates, and texts cut short.
    &Format {
        format: DynamicFormat::TriosLims,
        mark: |source| {
            let is_there = opens(source, 10, |line| line.contains("LIMS export format"));
            is_there.then(|| "the line `TA Instruments LIMS export format version`".to_owned())
        },
        read: |source, reading| {
            let grid = Grid::new(source, '\t');
            let found = steps::labelled(&grid, reading);
            let none = "not a LIMS text of TRIOS: it has no part `[Step]` with `Variables`";
            steps::read(&grid, &found, [none, LEAVE_OUT], reading)
        },
    },
    // Text of TRIOS, after public files of the Discovery rheometers (DHR, 2020) and of TRIOS 4.5. Lines `Filename TAB ...`,
    // `Instrument name TAB ...`, `proceduresegments TAB ...`, then `[File Parameters]` and other parts. Steps of several kinds are in
    // one file: sweeps of frequency and of amplitude, ramps, waveforms.
    &Format {
        format: DynamicFormat::TriosText,
        mark: |source| {
            let heads = "Filename\t|proceduresegments\t|[File Parameters]|Instrument name\t|Geometry name\t";
            let has_step = opens(source, usize::MAX, |line| is_step(line.trim()));
            let is_there = has_step && opens_with(source, 40, heads);
            is_there.then(|| "lines `[step]` and a head of TRIOS".to_owned())
        },
        read: |source, reading| {
            let grid = Grid::new(source, '\t');
            let none = "not a text of TRIOS: it has no line `[step]`";
            steps::read(&grid, &steps::bracketed(&grid), [none, LEAVE_OUT], reading)
        },
    },
    // CSV of TRIOS, after descriptions of exports of a DMA 850: lines `Filename,...`, `rundate,...`, `Geometry name,...`, then steps.
    // Later steps may lack the column Frequency that the first has. The steps `TTS - shift factors` and `TTS - master curve (20.0 °C)`
    // are what TRIOS computed, not data.
    &Format {
        format: DynamicFormat::TriosCsv,
        mark: |source| {
            let heads = "Filename,|rundate,|Geometry name,|Instrument name,";
            let has_tab = || opens(source, 40, |line| line.contains('\t'));
            let is_there = (opens_with(source, 60, heads) || !has_tab())
                && opens(source, usize::MAX, |line| is_step(cell(line)));
            is_there.then(|| "lines `[step]` and cells separated by commas".to_owned())
        },
        read: |source, reading| {
            // Where commas separate decimals, semicolons separate cells.
            let in_table = |step: &Block<'_>| step.section.header.len() > 2;
            let (by_semicolon, by_comma) = (Grid::new(source, ';'), Grid::new(source, ','));
            let has = |sign: char| source.text().contains(sign);
            let is_by_semicolon =
                has(';') && (!has(',') || steps::bracketed(&by_semicolon).iter().any(in_table));
            let grid = if is_by_semicolon {
                by_semicolon
            } else {
                by_comma
            };
            let none = "not a CSV of TRIOS: it has no line `[step]`";
            steps::read(&grid, &steps::bracketed(&grid), [none, LEAVE_OUT], reading)
        },
    },
    &Format {
        format: DynamicFormat::Reptate,
        mark: reptate::mark,
        read: reptate::read,
    },
    &Format {
        format: DynamicFormat::Pyvisco,
        mark: pyvisco_mark,
        read: read_pyvisco,
    },
    // Dynamic text of Hysitron's TriboScan (Bruker, nanoDMA files `*_DYN.txt`), after readers in public repositories: some lines of
    // text, then a row of names with units, `Test Time (s)`, `Indent Disp. (nm)`, `Indent Act. Load (µN)`, `Storage Mod. (GPa)`,
    // `Loss Mod. (GPa)`, `Tan-Delta`, with a frequency among them; tabs separate cells, texts are Latin-1. No temperature.
    &Format {
        format: DynamicFormat::Hysitron,
        mark: |source| {
            let is_there = opens(source, 300, |line| {
                line.contains("Test Time (s)")
                    || (line.contains("Indent ") && line.contains("Storage Mod"))
            });
            is_there.then(|| "the column `Test Time (s)` or `Indent Disp. (nm)`".to_owned())
        },
        read: read_hysitron,
    },
    &Format {
        format: DynamicFormat::RheoCompass,
        mark: rheocompass::mark,
        read: rheocompass::read,
    },
    &NAMED_COLUMNS,
];

/// Whether one of the first lines of a text is such.
fn opens(source: &Source, lines: usize, is_such: impl Fn(&str) -> bool) -> bool {
    source.text().lines().take(lines).any(is_such)
}

/// Whether one of the first lines of a text begins with one of these, which `|` parts.
fn opens_with(source: &Source, lines: usize, heads: &str) -> bool {
    opens(source, lines, |line| {
        heads.split('|').any(|head| line.starts_with(head))
    })
}

/// CSV files of pyvisco (NREL/pyvisco, folder `examples` and documentation).
///
/// Two header rows: names, then units, both with blanks behind the commas. Measured isotherms (raw): `f,E_stor,E_loss,T,Set` and
/// `Hz, MPa, MPa, C, -`, where `Set` numbers the isotherms and `T` is the measured temperature. Master curve: the same without `T`
/// and `Set`; its temperature is not in the file. `G_stor` and `G_loss` in shear. Files over time, `t,E_relax,...`, are not dynamic data.
fn pyvisco_mark(source: &Arc<Source>) -> Option<String> {
    let grid = Grid::new(source, ',');
    let header = grid.line(0);
    let has = |names: &[&str]| header.texts().any(|text| names.contains(&text));
    let is_dynamic = has(&["f", "omega"]) && has(&["E_stor", "G_stor"]);
    let is_over_time = has(&["t"]) && has(&["E_relax", "G_relax"]);
    (is_dynamic || is_over_time).then(|| format!("the names `{}`", grid.text(0)))
}

fn read_pyvisco(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let grid = Grid::new(source, ',');
    let is_relaxation = |text: &str| matches!(text, "E_relax" | "G_relax");
    if grid.line(0).texts().any(is_relaxation) {
        let message = "relaxation over time, not storage and loss modulus over frequency";
        return Err(Diagnostic::at(&grid.place(0), message)
            .help("give pyvisco's frequency file, or read this one with `--quantity relaxation`")
            .into());
    }
    if pyvisco_mark(source).is_none() {
        return Err(Diagnostic::at(&grid.place(0), "not a file of pyvisco")
            .because("the first line should be `f,E_stor,E_loss,T,Set`")
            .help(LEAVE_OUT)
            .into());
    }
    generic::read(source, reading)
}

fn read_hysitron(source: &Arc<Source>, reading: &mut Reading) -> Result<(), Diagnostics> {
    let Some((grid, header)) = generic::header(source) else {
        let grid = Grid::new(source, '\t');
        let names = (0..grid.len().min(300)).find(|line| grid.text(*line).contains("Mod. (GPa)"));
        let message =
            "no row of names with a frequency, `Storage Mod. (GPa)` and `Loss Mod. (GPa)`";
        return Err(Diagnostic::at(&grid.place(names.unwrap_or(0)), message)
            .help("export the frequency of the test with the dynamic data")
            .into());
    };
    reading.note("moduli as the instrument computed them from the contact");
    for block in generic::blocks(&grid, header) {
        reading.add(&block.by_instrument())?;
    }
    Ok(())
}
