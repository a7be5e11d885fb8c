//! `contact-dma sweep`: from a sweep file to the folder of results.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use super::arguments::{OutputFormat, SweepFlags};
use super::progress::Shown;
use super::{Ended, Failure, json, meant_for, memory, open_document, open_store, print, write_out};
use crate::input::sweep_file;
use crate::report::{self, terminal};
use crate::sweep::case::Setup;
use crate::sweep::plan::resolved;
use crate::sweep::plan::{Block, Condition};
use crate::sweep::search::run::{self, Options, Outcome, RunError};
use crate::sweep::share::shard::{self, Shard};
use crate::sweep::store::provenance::{Circumstances, Stopwatch};
use crate::sweep::store::{Store, StoreError};

/// Runs the command.
pub(super) fn run(flags: &SweepFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let clock = Stopwatch::start();
    let accuracy = flags.accuracy.map(|a| format!("cycle.accuracy={a:?}"));
    let set: Vec<String> = flags.set.iter().cloned().chain(accuracy).collect();
    let document = open_document(&flags.file, &set)?;
    meant_for::sweep(&document, &flags.file)?;
    let plan = sweep_file::plan(&document)?;
    let setup = Setup::new(plan).map_err(Failure::input)?;
    if flags.dry_run {
        return super::plan::show(&setup, format);
    }
    let resolved = resolved::resolved_text(setup.plan());
    let store = open_store(&flags.file, flags.out.as_deref(), &resolved, flags.force)?;
    let interrupt = interrupt_flag()?;
    let setup = setup.interrupted_by(Arc::clone(&interrupt));
    let options = Options {
        threads: run::useful_threads(flags.threads),
        checkpoint_every: Duration::from_secs(flags.checkpoint_every),
    };
    memory::warn_if_short(setup.predicted_memory_bytes(), options.threads);
    let mut job = Job {
        setup: &setup,
        store: &store,
        quiet: flags.quiet,
        format,
        records: &store,
        figures: !flags.no_figures,
        cycles: flags.cycles,
        stats: flags.stats,
        command: "sweep",
        clock,
        threads: options.threads,
        found: 0,
    };
    if let Some(shard) = flags.shard {
        return run_shard(job, shard, &options, &interrupt);
    }
    let plan = setup.plan();
    let unit = plan.figures.frequency_unit;
    let progress = Shown::new(plan.cases().len(), unit, flags.quiet);
    let outcome = run::run_with(&setup, &store, &options, &interrupt, &progress);
    progress.finish();
    job.found = progress.found();
    job.finish(outcome.map_err(failure)?)
}

/// A folder whose contents must not be used is an input that is wrong; anything else that stops a run is not.
pub(super) fn failure(error: RunError) -> Failure {
    match error {
        RunError::Store(
            StoreError::NewerProgram { .. }
            | StoreError::OtherSweep { .. }
            | StoreError::InUse { .. }
            | StoreError::NoSweep { .. },
        ) => Failure::input(error),
        other => Failure::run(other),
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

impl Job<'_> {
    /// Writes tables, figures and where they come from, and prints the result.
    pub(super) fn finish(&self, mut outcome: Outcome) -> Result<Ended, Failure> {
        let plan = self.setup.plan();
        report::load_drawn_cycles(self.records, plan, &mut outcome).map_err(Failure::run)?;
        let outcome = &outcome;
        let left_out = match self.figures {
            true => report::write_sweep(self.store, plan, outcome),
            false => report::write_tables_of_sweep(self.store, plan, outcome),
        };
        let left_out = left_out.map_err(Failure::run)?;
        if self.cycles && !plan.is_small() {
            let written = report::cycles::write(self.store, self.records, plan, outcome);
            written.map_err(Failure::run)?;
        }
        self.sign(outcome.records.len(), outcome.interrupted, None)?;
        if self.format == OutputFormat::Json {
            let hash = self.store.sweep_hash();
            write_out(&report::machine::sweep(plan, outcome, hash).map_err(Failure::run)?)?;
            return Ok(ended(outcome));
        }
        if !self.quiet {
            let folder = self.store.folder();
            print(&text(self.setup, outcome, &left_out, folder))?;
        }
        if self.stats {
            print(&terminal::work(outcome))?;
        }
        Ok(ended(outcome))
    }

    /// Writes run.json.
    fn sign(&self, records: usize, interrupted: bool, shard: Option<Shard>) -> Result<(), Failure> {
        let circumstances = Circumstances {
            command: self.command,
            threads: self.threads,
            shard: shard.map(|shard| shard.to_string()),
            cases_computed: records.saturating_sub(self.found),
            cases_found: self.found,
            interrupted,
        };
        let plan = self.setup.plan();
        let written = self.clock.write(self.store, plan, &circumstances);
        written.map_err(Failure::run)
    }
}

fn run_shard(
    mut job: Job<'_>,
    shard: Shard,
    options: &Options,
    interrupt: &AtomicBool,
) -> Result<Ended, Failure> {
    let own = shard::cases(job.setup, shard).len();
    let unit = job.setup.plan().figures.frequency_unit;
    let progress = Shown::new(own, unit, job.quiet);
    let part = run::run_shard(job.setup, job.store, shard, options, interrupt, &progress);
    progress.finish();
    let part = part.map_err(failure)?;
    job.found = progress.found();
    let done = part.records.len();
    job.sign(done, part.interrupted, Some(shard))?;
    if let Some(whole) = part.whole {
        return job.finish(whole);
    }
    if job.format == OutputFormat::Json {
        json::print(&serde_json::json!({
            "shard": shard.to_string(),
            "cases_done": done,
            "cases_of_shard": own,
            "cases_missing": part.missing,
            "interrupted": part.interrupted,
        }))?;
    } else if !job.quiet {
        let folder = job.store.folder().display();
        let next = match part.interrupted {
            true => "Interrupted: the same command goes on from here.".to_owned(),
            false => format!(
                "{} cases of the other shards are missing in this folder. The process that ends last locates the peaks and \
                 draws the\nfigures; where the shards have folders of their own, `contact-dma merge` does.",
                part.missing
            ),
        };
        print(&format!(
            "Shard {shard}: {done} of {own} cases are done. {next}\n\nRecords in {folder}\n"
        ))?;
    }
    let without_result = part.records.iter().any(|r| !r.status.has_result());
    Ok(match (part.interrupted, without_result) {
        (true, _) => Ended::Interrupted,
        (false, true) => Ended::SomeCasesWithoutResult,
        (false, false) => Ended::Done,
    })
}

/// A flag that Ctrl-C, SIGTERM and SIGHUP set. A second signal ends the program at once; every file is whole even then.
pub(super) fn interrupt_flag() -> Result<Arc<AtomicBool>, Failure> {
    let flag = Arc::new(AtomicBool::new(false));
    let shared = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if shared.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    })
    .map_err(|error| Failure::run(format!("cannot listen for Ctrl-C: {error}")))?;
    Ok(flag)
}

fn ended(outcome: &Outcome) -> Ended {
    if outcome.interrupted {
        Ended::Interrupted
    } else if !outcome.records.iter().all(|r| r.status.has_result()) {
        Ended::SomeCasesWithoutResult
    } else {
        Ended::Done
    }
}

/// What is printed at the end.
fn text(setup: &Setup, outcome: &Outcome, left_out: &[String], folder: &Path) -> String {
    let plan = setup.plan();
    let mut text = format!("{}\n\n", plan.title);
    for (_, Condition { material, .. }) in plan.each_of(Block::Material) {
        if let Some(fit) = material.fit() {
            text.push_str(&report::fit::text(fit));
            text.push('\n');
        }
        if material.approximation().is_some() {
            text.push_str(&report::fit::approximation(&material));
            text.push('\n');
        }
    }
    text.push_str(&terminal::table(plan, outcome));
    for part in [
        terminal::peaks(plan, outcome),
        terminal::problems(plan, outcome),
        terminal::warnings_of_sweep(plan, outcome),
        left_out.iter().map(|line| format!("{line}\n")).collect(),
    ] {
        if !part.is_empty() {
            text.push('\n');
            text.push_str(&part);
        }
    }
    if outcome.interrupted {
        text.push_str(&format!(
            "\nInterrupted: {} of {} cases are done.\n",
            outcome.records.len(),
            plan.cases().len()
        ));
    }
    text.push_str(&format!("\nResults in {}\n", folder.display()));
    text
}
