//! `contact-dma analyse`: measured loops to the table of a sweep.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use clap::Args;
use rayon::prelude::*;
use serde_json::json;

use super::arguments::{OutputFormat, folder, threads};
use super::interruption;
use super::material::draw;
use super::{Ended, Failure, json, print, read_document, say_quietly};
use crate::input::document::read_limited;
use crate::input::loop_file;
use crate::input::setup_file::{self, Setup};
use crate::measured::Options;
use crate::quantity::{Dimension, parse};
use crate::report::caption::Setting as CaptionSetting;
use crate::report::comparison::SweepTable;
use crate::report::figure::press::Files;
use crate::report::measured::{
    self, ANALYSIS, Analysis, Computed, MeasuredRow, columns, ordered, text,
};
use crate::report::text::Text;
use crate::report::{figure, machine, page};
use crate::sweep::record::Status;
use crate::sweep::search::run;
use crate::sweep::store::RESOLVED;
use crate::sweep::store::manifest::{Kind, Target};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma analyse loop.csv --out reports/measured
  contact-dma analyse loops/*.csv --setup setup.toml --out reports/measured

A file has the columns time, load and approach (or force, depth, displacement, ...) with their
units, `Time (s),Load (mN),Depth (nm)` or `time_s,load_n,approach_m`; or it is a matrix of NumPy
(.npy) with these three columns in SI units. Times need not be uniform.

Written to the output folder: sweep.csv (one row per file, the columns of a sweep), loops/ (the
mean cycles), cycles/ (every cycle by itself), summary.json, figures and index.html, and
analysis.json (everything), from which `contact-dma report` draws again. `contact-dma compare`
holds the folder against that of a sweep.

A setup says what is known of instrument and contact; every table may be left out:

  [instrument]
  frame_compliance = \"0.5 um/N\"   # mass, damping, stiffness, time_lag, thermal_drift
  [contact]                         # for moduli
  poisson_ratio = 0.38
  [indenter]
  shape = \"sphere\"
  radius = \"1 mm\"")]
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
    /// Number of threads, which share the files [default: one per processor, at most four for each]; the results do not depend on it
    #[arg(long, value_name = "N", env = "CONTACT_DMA_THREADS", value_parser = threads)]
    threads: Option<NonZeroUsize>,
    /// Write only tables, without figures and page
    #[arg(long)]
    no_figures: bool,
    /// Replace another result in the output folder, or add to a folder that has files of others, of which none is touched
    #[arg(long)]
    force: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
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
        force: flags.force,
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
    let Some(rows) = rows(flags.files.clone(), options, flags.threads)? else {
        return Ok(Ended::Interrupted);
    };
    let analysis = Analysis {
        title: setup.title.unwrap_or_else(|| "Measured loops".to_owned()),
        setup: setup_text,
        rows: ordered(rows),
        computed: computed.unwrap_or_default(),
    };
    finish(&target, &analysis, (!flags.no_figures, flags.quiet, format))
}

/// What the files come to, in their order; `None` where Ctrl-C came first. Nothing is written until all are there, so that what is
/// still at work then may end with the program.
fn rows(
    files: Vec<PathBuf>,
    options: Options,
    threads: Option<NonZeroUsize>,
) -> Result<Option<Vec<MeasuredRow>>, Failure> {
    /// How often Ctrl-C is looked for.
    const EVERY: Duration = Duration::from_millis(50);
    let interrupt = interruption::keep_finished();
    let pool = run::pool(run::useful_threads(threads))?;
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

/// What is written and printed: whether there are figures, whether nothing is printed, and how it is.
type Asked = (bool, bool, OutputFormat);

/// Draws tables and figures of a folder again, where it holds an analysis; `None` where it holds none.
pub(super) fn again(
    folder: &Path,
    (out, force): (Option<&Path>, bool),
    asked: Asked,
) -> Option<Result<Ended, Failure>> {
    let path = folder.join(ANALYSIS);
    if !path.exists() || folder.join(RESOLVED).exists() {
        return None;
    }
    let name = path.display();
    let read = || {
        let bytes = read_limited(&path, MAX_BYTES)
            .map_err(|error| Failure::input(format!("cannot read {name}: {error}")))?;
        serde_json::from_slice::<Analysis>(&bytes).map_err(|error| {
            Failure::input(format!(
                "{name} is none that this version of the program wrote: {error}"
            ))
        })
    };
    let target = Target {
        folder: out.unwrap_or(folder),
        kind: Kind::Analysis,
        force,
        reads: &[],
    };
    Some(read().and_then(|analysis| finish(&target, &analysis, asked)))
}

/// The cases of a computed sweep, with their cycles.
fn computed(folder: &Path) -> Result<Vec<Computed>, Failure> {
    let table = folder.join("sweep.csv");
    if !table.exists() {
        let folder = folder.display();
        return Err(Failure::Input(format!(
            "--against {folder}: the folder of a sweep has a sweep.csv"
        )));
    }
    let name = table.display().to_string();
    let bytes = read_limited(&table, MAX_BYTES)
        .map_err(|error| Failure::input(format!("cannot read {name}: {error}")))?;
    let rows = SweepTable::parse(&name, &bytes, None)?.numbers_under([
        "angular_frequency_rad_per_s",
        "index",
        "energy_loss_j",
        "storage_modulus_pa",
        "loss_modulus_pa",
    ])?;
    let cases = rows
        .into_iter()
        .filter_map(|[angular, index, loss, storage, of_loss]| {
            let (angular_rad_per_s, index) = angular.zip(index)?;
            let cycle = cycle(&folder.join(format!("loops/{}.csv", index as u64)));
            Some(cycle.map(|cycle| Computed {
                angular_rad_per_s,
                energy_loss_j: loss,
                storage_modulus_pa: storage,
                loss_modulus_pa: of_loss,
                cycle,
            }))
        });
    cases.collect()
}

/// Loads (N) and approaches (m) of a computed cycle; none where the sweep did not write it.
fn cycle(file: &Path) -> Result<Vec<(f64, f64)>, Failure> {
    if !file.exists() {
        return Ok(Vec::new());
    }
    let signal = loop_file::read(file)?;
    Ok(signal.load_n.into_iter().zip(signal.approach_m).collect())
}

/// Writes and prints everything.
fn finish(
    target: &Target<'_>,
    analysis: &Analysis,
    (figures, quiet, format): Asked,
) -> Result<Ended, Failure> {
    write(target, analysis, figures)?;
    let folder = target.folder;
    match format {
        OutputFormat::Json => json::print(&json!({
            "folder": folder,
            "rows": machine::rows(&columns::of_records(), &analysis.rows),
            "summary": json::file(&folder.join("summary.json"))?,
        }))?,
        OutputFormat::Text if !quiet => print(&printed(folder, &analysis.rows))?,
        OutputFormat::Text => Ended::Done,
    };
    say_quietly(quiet, || text::without_mean(&analysis.rows));
    let mut rows = analysis.rows.iter();
    Ok(match rows.all(|row| row.status() == Status::Converged) {
        true => Ended::Done,
        false => Ended::SomeCasesWithoutResult,
    })
}

fn printed(folder: &Path, rows: &[MeasuredRow]) -> Text {
    let mut printed = Text::default();
    if let [row] = rows
        && let Some(measured) = &row.measured
    {
        printed.append(text::record(measured).into_iter().collect::<Text>());
        printed.blank();
    }
    printed.append(text::table(rows));
    printed.append_apart(text::moduli(rows));
    printed.append(text::findings(rows));
    printed.append(format!("\nResults in {}", folder.display()));
    printed
}

/// Writes everything.
fn write(target: &Target<'_>, analysis: &Analysis, with_figures: bool) -> Result<(), Failure> {
    let files = Files::default();
    for (name, bytes) in measured::files(analysis).map_err(Failure::run)? {
        files.insert(name, bytes);
    }
    if with_figures {
        let figures = figure::measured::figures(analysis);
        let setting = CaptionSetting::default();
        draw(&files, &figures, &setting, |pictures, _| {
            page::measured::page(analysis, &figures, pictures)
        })?;
    }
    Ok(target.write(files.into_vec())?)
}
