//! Sweeps that are in a folder already: `contact-dma merge` and `contact-dma report`.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;

use super::failure::{Ended, Failure};
use super::flags::{folder, threads};
use super::interruption;
use super::output::OutputFormat;
use super::progress::Shown;
use super::sweep::Job;
use crate::input::document::Document;
use crate::input::sweep_file;
use crate::sweep::case::Setup;
use crate::sweep::plan::resolved::{self, identity};
use crate::sweep::plan::{Case, Condition};
use crate::sweep::search::run::{self, Mode, Progress};
use crate::sweep::store::difference;
use crate::sweep::store::manifest::{Kind, kind_of};
use crate::sweep::store::merge;
use crate::sweep::store::provenance::Stopwatch;
use crate::sweep::store::{RESOLVED, Store};

/// Names of cases in a message before the rest is counted.
const NAMED: usize = 10;

#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  contact-dma sweep sweeps/pmma.toml --shard 1/2 --out reports/part-1   # on one machine
  contact-dma sweep sweeps/pmma.toml --shard 2/2 --out reports/part-2   # on another
  contact-dma merge reports/part-1 reports/part-2 --out reports/pmma

The records of all cases are brought together; then the curve is refined where the sweep asks
for it and the peaks are located, which is solver work, and tables and figures are written. The
result is that of one process, bit for bit.")]
pub(super) struct MergeFlags {
    /// Folders of the parts
    #[arg(required = true, value_name = "DIR")]
    parts: Vec<PathBuf>,
    /// Folder for the whole
    #[arg(long, value_name = "DIR", value_parser = folder())]
    out: PathBuf,
    /// Number of threads [default: one per processor, at most four for each]
    #[arg(long, value_name = "N", env = "CONTACT_DMA_THREADS", value_parser = threads)]
    threads: Option<NonZeroUsize>,
    /// Replace the results of a different sweep in the output folder, or add to a folder that has files of others, of which none is
    /// touched
    #[arg(long)]
    force: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma report reports/pmma
  contact-dma report reports/pmma --set figures.column=one --set figures.dpi=600
  contact-dma report reports/pmma --out paper/figures

The [figures] table of resolved.toml says how figures look; what is changed is kept there.")]
pub(super) struct ReportFlags {
    /// Folder of a sweep, or of an analysis of measured loops
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Folder for tables and figures, without the records [default: the folder of the sweep]; nothing is then written into the
    /// folder of the sweep
    #[arg(long, value_name = "DIR", value_parser = folder())]
    out: Option<PathBuf>,
    /// Replace the results of a different sweep in the folder of --out, or add to a folder that has files of others, of which
    /// none is touched
    #[arg(long, requires = "out")]
    force: bool,
    /// Write only tables, without figures and page
    #[arg(long)]
    no_figures: bool,
    /// Write cycles.npz, all cycles for NumPy, also for more than 200 cases; without this flag an earlier one is removed
    #[arg(long)]
    cycles: bool,
    /// Change one key of [figures], for example figures.width='85 mm'; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Joins the parts and does what is left to do.
pub(super) fn merge(flags: &MergeFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let clock = Stopwatch::start();
    for folder in &flags.parts {
        refuse_other(folder, "merge")?;
    }
    let parts = flags
        .parts
        .iter()
        .map(|folder| Store::reopen_to_read(folder));
    let parts = parts.collect::<Result<Vec<_>, _>>()?;
    let Some((_, resolved)) = parts.first() else {
        return Err(Failure::Input("there is nothing to merge".to_owned()));
    };
    for (part, other) in &parts {
        if identity(other) != identity(resolved) {
            return Err(Failure::Input(format!(
                "{} holds a part of another sweep than {}:\n{}",
                part.folder().display(),
                flags.parts[0].display(),
                difference::lines(&identity(resolved), &identity(other), 12)
            )));
        }
    }
    let setup = setup_of(&flags.parts[0], resolved, &[])?;
    let out = Store::open(&flags.out, resolved, flags.force)?;
    let cases = setup.plan().cases();
    let progress = Shown::new(setup.plan(), cases.len(), flags.quiet);
    let parts: Vec<Store> = parts.into_iter().map(|(part, _)| part).collect();
    let missing = merge::gather(&parts, &out, &cases, &|what| progress.notice(what))?;
    if !missing.is_empty() {
        return Err(Failure::Run(lacking(&missing, cases.len(), &out)));
    }
    let interrupt = interruption::flag();
    let setup = setup.interrupted_by(Arc::clone(&interrupt));
    let threads = run::useful_threads(flags.threads);
    let mode = Mode::on_threads(threads);
    let outcome = run::run(&setup, &out, mode, &interrupt, &progress);
    let job = Job {
        threads,
        found: progress.finish(),
        ..Job::new("merge", clock, (&setup, &out), (format, flags.quiet))
    };
    job.finish(outcome?)
}

/// Draws tables and figures of a folder again.
pub(super) fn report(flags: &ReportFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let asked = (!flags.no_figures, flags.quiet, format);
    let to = (flags.out.as_deref(), flags.force);
    if let Some(done) = super::analyse::again(&flags.folder, to, asked) {
        return done;
    }
    let clock = Stopwatch::start();
    refuse_undrawn(flags)?;
    // A folder that is only read from may be one that nobody can write to.
    let (store, resolved) = match &flags.out {
        None => Store::reopen(&flags.folder)?,
        Some(_) => Store::reopen_to_read(&flags.folder)?,
    };
    let setup = setup_of(&flags.folder, &resolved, &flags.set)?;
    let progress = Shown::new(setup.plan(), setup.plan().cases().len(), flags.quiet);
    let outcome = run::run(&setup, &store, Mode::Read, &false.into(), &progress)?;
    progress.finish();
    if outcome.records.is_empty() {
        return Err(Failure::Input(format!(
            "{} holds no usable record of the sweep: run `contact-dma sweep` first",
            flags.folder.display()
        )));
    }
    let changed = resolved::resolved_text(setup.plan());
    let out = match &flags.out {
        None => &store,
        Some(out) => &Store::open(out, &changed, flags.force)?,
    };
    let job = Job {
        records: &store,
        figures: !flags.no_figures,
        cycles: flags.cycles,
        found: outcome.records.len(),
        ..Job::new("report", clock, (&setup, out), (format, flags.quiet))
    };
    let ended = job.finish(outcome)?;
    if changed != resolved || flags.out.is_some() {
        // What the folder says of its figures must be what they are.
        out.write(RESOLVED, changed.as_bytes())?;
    }
    Ok(match ended {
        Ended::Interrupted => Ended::SomeCasesWithoutResult,
        ended => ended,
    })
}

/// Refuses the folder of another command where a sweep is needed.
pub(super) fn refuse_other(folder: &Path, command: &str) -> Result<(), Failure> {
    match kind_of(folder)? {
        None | Some(Kind::Sweep) => Ok(()),
        Some(kind) => Err(Failure::Input(format!(
            "{} holds {}; `{command}` takes folders of sweeps",
            folder.display(),
            kind.text()
        ))),
    }
}

/// Refuses a folder whose figures can be made again only by the command that made them: it says by which.
fn refuse_undrawn(flags: &ReportFlags) -> Result<(), Failure> {
    let folder = flags.folder.display();
    let out = flags.out.as_deref().unwrap_or(&flags.folder).display();
    let kind = kind_of(&flags.folder)?;
    let set: String = flags
        .set
        .iter()
        .map(|set| format!(" --set {set}"))
        .collect();
    let again = match kind {
        None | Some(Kind::Sweep | Kind::Analysis) => return Ok(()),
        Some(Kind::Scenario) => format!(
            "`contact-dma simulate {folder}/{RESOLVED} --out {out}{set}` draws them, and computes the history again"
        ),
        Some(Kind::Identification) => {
            format!(
                "`contact-dma identify FILE --out {out}`, with the file of the identification, makes them again"
            )
        }
        Some(Kind::Material) => format!(
            "`contact-dma material show MATERIAL --out {out}`, with the name or file of the material, makes them again"
        ),
        Some(Kind::MaterialFit) => format!(
            "`contact-dma material fit TABLE --out {out}`, with the flags of the fit, makes them again"
        ),
        Some(Kind::Comparison) => {
            format!(
                "`contact-dma compare BASELINE NEW --out {out}`, with both results, makes them again"
            )
        }
        Some(Kind::Reproduction) => {
            format!("`contact-dma reproduce --out {out}{set}` makes them again")
        }
    };
    Err(Failure::Input(format!(
        "{folder} holds {}; `report` draws sweeps and analyses alone, the results of which are stored whole\n= help: {again}",
        kind.map_or("", Kind::text)
    )))
}

/// The sweep that a folder says it holds, its figures changed as asked.
fn setup_of(folder: &Path, text: &str, set: &[String]) -> Result<Setup, Failure> {
    let name = folder.join(RESOLVED).display().to_string();
    let mut document = Document::parse(&name, text)?.in_folder(folder);
    let mut plan = sweep_file::plan(&document)?;
    if resolved::resolved_text(&plan) != text {
        return Err(Failure::Input(format!(
            "{name} is not as this version of the program would write it: run the sweep again"
        )));
    }
    if !set.is_empty() {
        for assignment in set {
            document.set(assignment)?;
        }
        plan = sweep_file::plan(&document)?;
        let changed = resolved::resolved_text(&plan);
        if identity(&changed) != identity(text) {
            return Err(Failure::Input(format!(
                "`report` solves nothing, and --set can change [figures] alone; this is another sweep:\n{}for it run \
                 `contact-dma sweep`",
                difference::lines(&identity(text), &identity(&changed), NAMED)
            )));
        }
    }
    Setup::new(plan).map_err(Failure::input)
}

fn lacking(missing: &[Case], of: usize, out: &Store) -> String {
    let mut text = format!(
        "{} of {of} cases are in none of the parts:\n",
        missing.len()
    );
    for case in missing.iter().take(NAMED) {
        let Condition { values, drive, .. } = &case.condition;
        let values = values.all().iter();
        let value: String = values
            .map(|value| format!("axis {}, ", value.as_number()))
            .collect();
        text.push_str(&format!(
            "  case {}: ω = {:e} rad/s ({value}mean {}, amplitude {})\n",
            case.index,
            case.angular_frequency_rad_per_s,
            drive.mean(),
            drive.amplitude()
        ));
    }
    if missing.len() > NAMED {
        text.push_str(&format!("  and {} more\n", missing.len() - NAMED));
    }
    text.push_str(&format!(
        "What there is has been copied to {}: merge again with the rest, or run the sweep there",
        out.folder().display()
    ));
    text
}
