//! `contact-dma sweep`: from a sweep file to the folder of results.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use serde_json::json;

use super::arguments::{OutputFormat, folder, threads};
use super::interruption;
use super::progress::Shown;
use super::{
    Ended, Failure, meant_for, memory, open_document, open_store, print, say_quietly, tell,
};
use crate::figures::paper::drawing_bytes;
use crate::input::sweep_file;
use crate::report::text::Text;
use crate::report::{self, terminal};
use crate::sweep::case::Setup;
use crate::sweep::plan::Block;
use crate::sweep::plan::resolved;
use crate::sweep::record::CaseRecord;
use crate::sweep::search::run::{self, Mode, Outcome};
use crate::sweep::share::shard::{self, Shard};
use crate::sweep::store::provenance::{Circumstances, Stopwatch};
use crate::sweep::store::{Store, checkpoint_file};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma sweep sweeps/pmma.toml
  contact-dma sweep sweeps/pmma.toml --set indenter.radius='5 mm' --out reports/small
  contact-dma sweep sweeps/pmma.toml --set solver.engine=half-space --threads 2
  contact-dma sweep sweeps/pmma.toml --shard 2/8

The same command again resumes an interrupted sweep: cases with intact records are read, not
computed, and a long case continues after the last of its resolutions that was solved.

Written to the output folder: index.html (one page of everything, to look at or to send),
sweep.csv (one row per frequency), loops/ (the stabilised cycles), pressures/ and work/
(contact pressure at some instants of each, and where its work goes in), summary.json (peaks,
counts), figures as SVG and PNG with their data as CSV, records/ (everything, for later),
resolved.toml (the sweep with every default).

The [figures] table affects only how figures look: the same sweep with another table reads its
records and redraws.")]
pub(super) struct SweepFlags {
    /// The sweep file (TOML); - reads standard input, from which paths start in the working folder
    file: PathBuf,
    /// Folder for the results [default: reports/<name of the file>]
    #[arg(long, value_name = "DIR", value_parser = folder())]
    out: Option<PathBuf>,
    /// Number of threads [default: one per processor, at most four for each]; the results do not depend on it
    #[arg(long, value_name = "N", env = "CONTACT_DMA_THREADS", value_parser = threads)]
    threads: Option<NonZeroUsize>,
    /// Change one key of the sweep file, for example drive.amplitude='2 N' or indenter.asperities.0.radius='1 mm' (items of a list count
    /// from 0); KEY= removes a key; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Choose steps and nodes so that the relative error of every loss is below this value; same as
    /// --set cycle.accuracy=X
    #[arg(long, value_name = "X")]
    accuracy: Option<f64>,
    /// Write only tables, without figures and page
    #[arg(long)]
    no_figures: bool,
    /// Write cycles.npz, all cycles for NumPy, also for more than 200 cases; without this flag an earlier one is removed
    #[arg(long)]
    cycles: bool,
    /// Compute only the part K of N; `merge` joins parts in separate folders
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Print what would be computed and its approximate cost, and compute nothing
    #[arg(long)]
    dry_run: bool,
    /// Print what was done: instants, iterations and convolutions per instant
    #[arg(long)]
    stats: bool,
    /// Seconds between two writes of what a long case has solved
    #[arg(long, value_name = "SECONDS", default_value_t = checkpoint_file::EVERY.as_secs())]
    checkpoint_every: u64,
    /// Replace the results of a different sweep, or of a newer program, in the output folder, or add to a folder that has files of
    /// others, of which none is touched
    #[arg(long)]
    force: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the command.
pub(super) fn run(flags: &SweepFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let clock = Stopwatch::start();
    let set = super::plan::with_accuracy(&flags.set, flags.accuracy)?;
    let document = open_document(&flags.file, &set)?;
    meant_for::sweep(&document, &flags.file)?;
    let plan = sweep_file::plan(&document)?;
    let setup = Setup::new(plan).map_err(Failure::input)?;
    if flags.dry_run {
        return super::plan::show(&setup, format);
    }
    let resolved = resolved::resolved_text(setup.plan());
    let out = (flags.out.as_deref(), flags.force);
    let store = open_store((&flags.file, &document), out, &resolved)?;
    let interrupt = interruption::flag();
    let setup = setup.interrupted_by(Arc::clone(&interrupt));
    let threads = run::useful_threads(flags.threads);
    let mode = Mode::Solve {
        threads,
        checkpoint_every: Duration::from_secs(flags.checkpoint_every),
        shard: flags.shard,
    };
    let drawing_bytes = match flags.no_figures {
        true => 0,
        false => drawing_bytes(&setup.plan().figures, threads),
    };
    memory::warn_if_short(setup.predicted_memory_bytes(), threads, drawing_bytes);
    let mut job = Job {
        figures: !flags.no_figures,
        cycles: flags.cycles,
        stats: flags.stats,
        threads,
        ..Job::new("sweep", clock, (&setup, &store), (format, flags.quiet))
    };
    let own = match flags.shard {
        Some(shard) => shard::cases(&setup, shard).len(),
        None => setup.plan().cases().len(),
    };
    let progress = Shown::new(setup.plan(), own, flags.quiet);
    let outcome = run::run(&setup, &store, mode, &interrupt, &progress);
    job.found = progress.finish();
    match flags.shard {
        Some(shard) => job.finish_shard(shard, own, outcome?),
        None => job.finish(outcome?),
    }
}

/// A run that has come to its end, and what it takes to tell of it.
pub(super) struct Job<'a> {
    pub(super) setup: &'a Setup,
    pub(super) store: &'a Store,
    /// Where the records are, which `report` may leave in another folder.
    pub(super) records: &'a Store,
    pub(super) quiet: bool,
    pub(super) format: OutputFormat,
    /// Whether to draw figures and page.
    pub(super) figures: bool,
    /// Whether to write the cycles of a large sweep for NumPy.
    pub(super) cycles: bool,
    /// Whether to print what was done.
    pub(super) stats: bool,
    pub(super) command: &'static str,
    pub(super) clock: Stopwatch,
    pub(super) threads: usize,
    /// Cases that had records before.
    pub(super) found: usize,
}

impl<'a> Job<'a> {
    /// One on a single thread that computed everything, with figures and page.
    pub(super) fn new(
        command: &'static str,
        clock: Stopwatch,
        (setup, store): (&'a Setup, &'a Store),
        (format, quiet): (OutputFormat, bool),
    ) -> Self {
        Self {
            setup,
            store,
            records: store,
            quiet,
            format,
            figures: true,
            cycles: false,
            stats: false,
            command,
            clock,
            threads: 1,
            found: 0,
        }
    }

    /// Writes tables, figures and where they come from, and prints the result.
    pub(super) fn finish(&self, mut outcome: Outcome) -> Result<Ended, Failure> {
        // What is computed is in the folder, from which `report` makes what is not written yet.
        interruption::at_once();
        let plan = self.setup.plan();
        report::load_drawn_cycles(self.records, plan, &mut outcome)?;
        let outcome = &outcome;
        let left_out = match self.figures {
            true => report::write_sweep(self.store, plan, outcome)?,
            false => report::write_tables_of_sweep(self.store, plan, outcome)?,
        };
        if self.cycles && !plan.is_small() {
            report::cycles::write(self.store, self.records, plan, outcome)?;
        }
        self.sign(outcome.records.len(), outcome.interrupted, None)?;
        let found = || {
            Ok(report::machine::sweep(
                plan,
                outcome,
                self.store.sweep_hash(),
            ))
        };
        say_quietly(self.quiet, || terminal::problems(plan, outcome));
        let text = || self.text(outcome, &left_out);
        tell(self.format, self.quiet, found, text)?;
        if self.stats && self.format == OutputFormat::Text {
            print(&terminal::work(outcome).into())?;
        }
        Ok(ended(outcome.interrupted, &outcome.records))
    }

    /// What is printed at the end.
    fn text(&self, outcome: &Outcome, left_out: &[String]) -> Text {
        let plan = self.setup.plan();
        let mut text = Text::from(format!("{}\n\n", plan.title));
        for (_, condition) in plan.each_of(Block::Material) {
            let material = &condition.contact.material;
            let fit = report::fit::fitted(material);
            let known = material.origin.approximation.as_ref();
            let approximation = known.map(|_| report::fit::approximation(material));
            for part in fit.into_iter().chain(approximation) {
                text.append(part);
                text.blank();
            }
        }
        text.append(terminal::table(plan, outcome));
        for part in [
            terminal::peaks(plan, outcome),
            terminal::problems(plan, outcome),
            terminal::warnings_of_sweep(plan, outcome),
            left_out.join("\n").into(),
        ] {
            text.append_apart(part);
        }
        if outcome.interrupted {
            text.append(format!(
                "\nInterrupted: {} of {} cases are done. The same command continues with the others.",
                outcome.records.len(),
                plan.cases().len()
            ));
        }
        text.append(format!("\nResults in {}", self.store.folder().display()));
        text
    }

    /// Writes run.json.
    fn sign(&self, records: usize, interrupted: bool, shard: Option<Shard>) -> Result<(), Failure> {
        let circumstances = Circumstances {
            command: self.command,
            threads: self.threads,
            shard: shard.map(|shard| shard.to_string()),
            cases_computed: Some(records.saturating_sub(self.found)),
            cases_found: Some(self.found),
            interrupted,
        };
        let plan = self.setup.plan();
        Ok(self.clock.write(
            self.store,
            &plan.solver,
            Some(plan.cycle.tolerance),
            &circumstances,
        )?)
    }

    /// Tells of a shard, or, where it was the last, of the whole sweep.
    fn finish_shard(&self, shard: Shard, own: usize, outcome: Outcome) -> Result<Ended, Failure> {
        let done = match outcome.missing {
            0 => own,
            _ => outcome.records.len(),
        };
        self.sign(done, outcome.interrupted, Some(shard))?;
        if outcome.missing == 0 {
            return self.finish(outcome);
        }
        let found = json!({
            "shard": shard.to_string(),
            "cases_done": done,
            "cases_of_shard": own,
            "cases_missing": outcome.missing,
            "interrupted": outcome.interrupted,
        });
        let next = match outcome.interrupted {
            true => "Interrupted: the same command goes on from here.".to_owned(),
            false => format!(
                "{} cases of the other shards are missing in this folder. The process that ends last locates the peaks and \
             draws the\nfigures; where the shards have folders of their own, `contact-dma merge` does.",
                outcome.missing
            ),
        };
        let folder = self.store.folder().display();
        let text =
            format!("Shard {shard}: {done} of {own} cases are done. {next}\n\nRecords in {folder}");
        tell(self.format, self.quiet, || Ok(found), || text.into())?;
        Ok(ended(outcome.interrupted, &outcome.records))
    }
}

fn ended(interrupted: bool, records: &[CaseRecord]) -> Ended {
    match interrupted {
        true => Ended::Interrupted,
        false if records.iter().all(|r| r.status.has_result()) => Ended::Done,
        false => Ended::SomeCasesWithoutResult,
    }
}
