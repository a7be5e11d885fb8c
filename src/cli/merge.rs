//! `contact-dma merge`: the shards of a sweep that are in folders of their own, joined.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;

use super::failure::{Ended, Failure};
use super::flags::{WorkFlags, folder};
use super::folders::{refuse_other, stored_sweep};
use super::interruption;
use super::output::OutputFormat;
use super::progress::Shown;
use super::sweep::Job;
use crate::report::terminal;
use crate::sweep::plan::resolved::identity;
use crate::sweep::search::run::{self, Mode, Progress};
use crate::sweep::store::provenance::Stopwatch;
use crate::sweep::store::{Store, difference, merge};

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
    /// Write only tables, without figures and page
    #[arg(long)]
    no_figures: bool,
    #[command(flatten)]
    work: WorkFlags,
}

/// Joins the parts and does what is left to do.
pub(super) fn run(flags: &MergeFlags, format: OutputFormat) -> Result<Ended, Failure> {
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
    let setup = stored_sweep((&flags.parts[0], resolved), &[])?;
    let out = Store::open(&flags.out, resolved, flags.work.force)?;
    let cases = setup.plan().cases();
    let progress = Shown::new(setup.plan(), cases.len(), flags.work.quiet);
    let parts: Vec<Store> = parts.into_iter().map(|(part, _)| part).collect();
    let missing = merge::gather(&parts, &out, &cases, &|what| progress.notice(what))?;
    if !missing.is_empty() {
        return Err(Failure::Run(terminal::lacking(
            &missing,
            cases.len(),
            out.folder(),
        )));
    }
    let interrupt = interruption::flag();
    let setup = setup.interrupted_by(Arc::clone(&interrupt));
    let threads = flags.work.threads();
    let mode = Mode::on_threads(threads);
    let outcome = run::run(&setup, &out, mode, &interrupt, &progress);
    let job = Job {
        threads,
        found: progress.finish(),
        figures: !flags.no_figures,
        ..Job::new("merge", clock, (&setup, &out), (format, flags.work.quiet))
    };
    job.finish(outcome?)
}
