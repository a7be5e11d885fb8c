//! `contact-dma sweep`: from a sweep file to the folder of results.

use std::sync::Arc;
use std::time::Duration;

use clap::Args;

use super::failure::{Ended, Failure};
use super::flags::RunFlags;
use super::folders::open_store;
use super::output::{OutputFormat, print, say_quietly, tell};
use super::progress::Shown;
use super::{interruption, meant_for, memory, plan};
use crate::input::sweep_file;
use crate::report::{self, terminal};
use crate::sweep::case::Setup;
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

The same command again resumes an interrupted sweep. The folder opens with index.html, one page
of everything; sweep.csv has one row per frequency.")]
pub(super) struct SweepFlags {
    #[command(flatten)]
    run: RunFlags,
    /// Choose steps and nodes so that the relative error of every loss is below this value; same as
    /// --set cycle.accuracy=X
    #[arg(long, value_name = "X")]
    accuracy: Option<f64>,
    /// Write cases/cycles.npz, all cycles for NumPy, also for more than 200 cases; without this flag an earlier one is removed
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
}

/// Runs the command.
pub(super) fn run(flags: &SweepFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let clock = Stopwatch::start();
    let set = plan::with_accuracy(&flags.run.set, flags.accuracy)?;
    let document = meant_for::open(&meant_for::SWEEP, &flags.run.file, &set)?;
    let setup = Setup::new(sweep_file::plan(&document)?).map_err(Failure::input)?;
    if flags.dry_run {
        return plan::show(&setup, format);
    }
    let threads = flags.run.work.threads();
    let of_run = (setup.predicted_memory_bytes(), threads);
    memory::check(&flags.run, of_run, &setup.plan().figures)?;
    let resolved = resolved::resolved_text(setup.plan());
    let store = open_store(&flags.run, &document, &resolved)?;
    let (interrupt, quiet) = (interruption::flag(), flags.run.work.quiet);
    let setup = setup.interrupted_by(Arc::clone(&interrupt));
    let mode = Mode::Solve {
        threads,
        checkpoint_every: Duration::from_secs(flags.checkpoint_every),
        shard: flags.shard,
    };
    let mut job = Job {
        figures: !flags.run.no_figures,
        cycles: flags.cycles,
        stats: flags.stats,
        threads,
        ..Job::new("sweep", clock, (&setup, &store), (format, quiet))
    };
    let own = match flags.shard {
        Some(shard) => shard::cases(&setup, shard).len(),
        None => setup.plan().cases().len(),
    };
    let progress = Shown::new(setup.plan(), own, quiet);
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
        let text = || {
            let mut text = terminal::text(plan, outcome, &left_out);
            text.append(format!("\nResults in {}", self.store.folder().display()));
            Ok(text)
        };
        tell(self.format, self.quiet, found, text)?;
        if self.stats && self.format == OutputFormat::Text {
            print(&terminal::work(outcome).into())?;
        }
        Ok(ended(outcome.interrupted, &outcome.records))
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
        let told = terminal::ShardDone {
            shard,
            done,
            own,
            missing: outcome.missing,
            interrupted: outcome.interrupted,
        };
        let text = || Ok(told.text(self.store.folder()).into());
        tell(self.format, self.quiet, || Ok(told.to_json()), text)?;
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
