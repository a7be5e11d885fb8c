//! `contact-dma analyse`: measured loops to the table of a sweep.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use clap::Args;
use rayon::prelude::*;
use serde_json::json;

use super::documents::{read_bytes, read_document};
use super::failure::{Ended, Failure};
use super::flags::{WorkFlags, folder};
use super::folders::write_kept;
use super::interruption;
use super::output::{OutputFormat, read_json, say_quietly, tell};
use crate::input::loop_file;
use crate::input::setup_file::{self, Setup};
use crate::measured::Options;
use crate::quantity::{Dimension, parse};
use crate::report::comparison;
use crate::report::kept_figures::KeptFigures;
use crate::report::machine;
use crate::report::measured::{
    self, ANALYSIS, Analysis, Computed, MeasuredRow, columns, ordered, text,
};
use crate::sweep::record::Status;
use crate::sweep::search::run;
use crate::sweep::store::files::Found;
use crate::sweep::store::manifest::{Kind, Target};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma analyse loop.csv --out reports/measured
  contact-dma analyse loops/*.csv --setup setup.toml --out reports/measured

A file has the columns time, load and approach (or force, depth, displacement, ...) with their
units, `Time (s),Load (mN),Depth (nm)` or `time_s,load_n,approach_m`; or it is a matrix of NumPy
(.npy) with these three columns in SI units. Times need not be uniform.

The folder opens with index.html, one page of everything; sweep.csv has one row per file and the
columns of a sweep, with which `contact-dma compare` compares it.")]
pub(super) struct AnalyseFlags {
    /// Records of load and approach against time, one a file
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The frequency of all records, for example '10 Hz' [default: found in each]
    #[arg(long, value_name = "F", value_parser = frequency)]
    frequency: Option<f64>,
    /// What is known of instrument and contact (TOML): frame compliance, mass, damping, stiffness, lag, thermal drift; Poisson
    /// ratio, indenter
    #[arg(long, value_name = "SETUP.toml")]
    setup: Option<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR", value_parser = folder())]
    out: PathBuf,
    /// Folder of a computed sweep, whose loops and curves are drawn beside the measured ones
    #[arg(long, value_name = "DIR")]
    against: Option<PathBuf>,
    /// Write only tables, without figures and page
    #[arg(long)]
    no_figures: bool,
    #[command(flatten)]
    work: WorkFlags,
}

/// A frequency in Hz; rad/s is understood.
fn frequency(text: &str) -> Result<f64, String> {
    let hz = match (
        text.trim().parse::<f64>(),
        parse(text, Dimension::Frequency),
    ) {
        (Ok(hz), _) | (_, Ok(hz)) => hz,
        (_, Err(error)) => parse(text, Dimension::AngularFrequency)
            .map(|angular| angular / std::f64::consts::TAU)
            .map_err(|_| error.to_string())?,
    };
    match hz.is_finite() && hz > 0.0 {
        true => Ok(hz),
        false => Err(format!(
            "`{text}` is no frequency: write one above zero, such as '10 Hz'"
        )),
    }
}

/// Largest file that `report` reads.
const MAX_BYTES: usize = 1_000_000_000;

/// Runs the command.
pub(super) fn run(flags: &AnalyseFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let reads = flags.files.iter().chain(&flags.setup).chain(&flags.against);
    let reads: Vec<PathBuf> = reads.cloned().collect();
    let target = Target {
        folder: &flags.out,
        kind: Kind::Analysis,
        force: flags.work.force,
        reads: &reads,
    };
    target.check()?;
    let (setup, setup_text) = match &flags.setup {
        None => (Setup::default(), None),
        Some(file) => {
            let document = read_document(file)?;
            let setup = setup_file::setup(&document)?;
            (setup, Some(document.source().text().to_owned()))
        }
    };
    let options = Options {
        frequency_hz: flags.frequency,
        ..setup.options
    };
    let computed = flags.against.as_deref().map(computed).transpose()?;
    let Some(rows) = rows(flags.files.clone(), options, flags.work.threads())? else {
        return Ok(Ended::Interrupted);
    };
    let analysis = Analysis {
        title: setup.title.unwrap_or_else(|| "Measured loops".to_owned()),
        setup: setup_text,
        rows: ordered(rows),
        computed: computed.unwrap_or_default(),
    };
    let files = measured::files(&analysis).map_err(Failure::run)?;
    let kept = KeptFigures::of_loops(&analysis)?;
    write_kept(&target, files, kept, !flags.no_figures)?;
    told(&flags.out, &analysis, (flags.work.quiet, format))
}

/// What the files come to, in their order; `None` where Ctrl-C came first. Nothing is written until all are there, so that what is
/// still at work then may end with the program.
fn rows(
    files: Vec<PathBuf>,
    options: Options,
    threads: usize,
) -> Result<Option<Vec<MeasuredRow>>, Failure> {
    /// How often Ctrl-C is looked for.
    const EVERY: Duration = Duration::from_millis(50);
    let interrupt = interruption::keep_finished();
    let pool = run::pool(threads)?;
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        // One file a thread is in memory at a time.
        let row = |file: &PathBuf| {
            let signal = loop_file::read(file)?;
            let name = file.display().to_string();
            Ok(MeasuredRow::of(name, &signal, &options))
        };
        let rows: Vec<Result<_, Failure>> = pool.install(|| files.par_iter().map(row).collect());
        // Nobody listens after Ctrl-C.
        let _ = sender.send(rows);
    });
    while !interrupt.load(Ordering::Relaxed) {
        match receiver.recv_timeout(EVERY) {
            Ok(rows) => return rows.into_iter().collect::<Result<_, _>>().map(Some),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Failure::run("the analysis of a file broke off"));
            }
        }
    }
    Ok(None)
}

/// The analysis of a folder.
pub(super) fn stored(folder: &Path) -> Result<Analysis, Failure> {
    let path = Found::of(folder).path(ANALYSIS);
    serde_json::from_slice(&read_bytes(&path, MAX_BYTES)?).map_err(|error| {
        Failure::input(format!(
            "{} is none that this version of the program wrote: {error}",
            path.display()
        ))
    })
}

/// The cases of a computed sweep, with their cycles.
fn computed(folder: &Path) -> Result<Vec<Computed>, Failure> {
    if !folder.join("sweep.csv").exists() {
        let folder = folder.display();
        return Err(Failure::Input(format!(
            "--against {folder}: the folder of a sweep has a sweep.csv"
        )));
    }
    comparison::computed(folder, |path| read_bytes(path, MAX_BYTES))
}

/// Prints the analysis of a folder.
pub(super) fn told(
    folder: &Path,
    analysis: &Analysis,
    (quiet, format): (bool, OutputFormat),
) -> Result<Ended, Failure> {
    let found = || {
        Ok(json!({
            "folder": folder,
            "rows": machine::rows(&columns::of_records(), &analysis.rows),
            "summary": read_json(&folder.join("summary.json"))?,
        }))
    };
    tell(format, quiet, found, || {
        let mut text = text::text(&analysis.rows);
        text.append(format!("\nResults in {}", folder.display()));
        Ok(text)
    })?;
    say_quietly(quiet, || text::without_mean(&analysis.rows));
    let mut rows = analysis.rows.iter();
    Ok(match rows.all(|row| row.status() == Status::Converged) {
        true => Ended::Done,
        false => Ended::SomeCasesWithoutResult,
    })
}
