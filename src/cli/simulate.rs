//! `contact-dma simulate`: from a scenario file to the folder of results.

use std::sync::Arc;
use std::time::Duration;

use clap::Args;

use super::failure::{Ended, Failure};
use super::flags::RunFlags;
use super::folders::open_store;
use super::memory;
use super::output::{OutputFormat, read_json, tell};
use super::progress::{bar, line};
use super::{interruption, meant_for};
use crate::input::scenario_file;
use crate::report::quantities::{self, Moment};
use crate::report::scenario_tables::History;
use crate::report::{self, forecast, machine, terminal_simulation};
use crate::simulation::checkpoint::{HistoryCheckpoint, HistoryState};
use crate::simulation::scenario::{self, ScenarioPlan};
use crate::simulation::{Simulation, SimulationEnd, SimulationOutcome};
use crate::sweep::search::run;
use crate::sweep::store::provenance::{Circumstances, Stopwatch};
use crate::sweep::store::{Store, checkpoint_file};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma simulate sweeps/zener-unloading.toml
  contact-dma simulate sweeps/zener-unloading.toml --set solver.engine=half-space \\
      --set output.fields_at='[\"4 s\"]' --out reports/fields

The same command again goes on where it was stopped, from the last checkpoint. The folder opens
with index.html, one page of everything; history.csv has one row per time step, two at a jump.")]
pub(super) struct SimulateFlags {
    #[command(flatten)]
    run: RunFlags,
    /// Do not estimate the errors of the rows, which saves more than half of the time; the same as
    /// --set output.error_bars=false
    #[arg(long)]
    no_error_bars: bool,
    /// Print what would be computed and the approximate memory it takes, and compute nothing
    #[arg(long)]
    dry_run: bool,
    /// Seconds between checkpoints of a long history
    #[arg(long, value_name = "SECONDS", default_value_t = checkpoint_file::EVERY.as_secs())]
    checkpoint_every: u64,
}

/// Runs the command.
pub(super) fn run(flags: &SimulateFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let clock = Stopwatch::start();
    let mut set = flags.run.set.clone();
    if flags.no_error_bars {
        set.push("output.error_bars=false".to_owned());
    }
    let document = meant_for::open(&meant_for::SCENARIO, &flags.run.file, &set)?;
    let plan = scenario_file::plan(&document)?;
    let simulation = Simulation::new(plan).map_err(Failure::input)?;
    if flags.dry_run {
        return tell(
            format,
            false,
            || Ok(forecast::of_history(&simulation)),
            || Ok(forecast::history_text(&simulation, &memory::free_here()).into()),
        );
    }
    let of_run = (simulation.predicted_memory_bytes(), 1);
    memory::check(&flags.run, of_run, &simulation.plan().figures)?;
    let resolved = scenario::resolved_text(simulation.plan());
    let store = open_store(&flags.run, &document, &resolved)?;
    let (interrupt, quiet) = (interruption::keep_finished(), flags.run.work.quiet);
    let simulation = simulation.interrupted_by(Arc::clone(&interrupt));
    let checkpoint = HistoryCheckpoint::of(&store, Duration::from_secs(flags.checkpoint_every));
    let state = found(&checkpoint, simulation.moments(), quiet);
    let template = "{wide_bar} {pos}/{len} steps, {eta} left";
    let bar = bar(simulation.moments(), template, quiet);
    let threads = flags.run.work.threads();
    let pool = run::pool(threads)?;
    let told = |done, _| bar.set_position(done as u64);
    let (simulation, flag, told) = (&simulation, &interrupt, &told);
    let (outcome, checkpoint) = pool.install(move || {
        let outcome = simulation.run_from(state, Some(&checkpoint), flag, told);
        (outcome, checkpoint)
    });
    bar.finish_and_clear();
    let run = Run {
        command: "simulate",
        clock,
        threads,
        figures: !flags.run.no_figures,
        quiet,
        format,
    };
    let history = History::from(outcome);
    let left_out = run.write(&store, simulation.plan(), &history)?;
    let ended = &history.outcome.ended;
    if *ended != SimulationEnd::Interrupted {
        checkpoint.remove();
    }
    if let SimulationEnd::Failed(message) = ended {
        return Err(Failure::run(format!(
            "{message}\n  what came before is in {}",
            store.folder().display()
        )));
    }
    run.tell(&store, simulation.plan(), (&history, &left_out))?;
    Ok(match ended {
        SimulationEnd::Interrupted => Ended::Interrupted,
        _ => Ended::Done,
    })
}

/// A command that has a history, and how it is written and printed.
pub(super) struct Run {
    pub(super) command: &'static str,
    pub(super) clock: Stopwatch,
    pub(super) threads: usize,
    /// Whether figures and page are drawn.
    pub(super) figures: bool,
    pub(super) quiet: bool,
    pub(super) format: OutputFormat,
}

impl Run {
    /// Writes tables, figures and where they come from. Returns what was left out and why.
    pub(super) fn write(
        &self,
        store: &Store,
        plan: &ScenarioPlan,
        history: &History,
    ) -> Result<Vec<String>, Failure> {
        let left_out = match self.figures {
            true => report::scenario::write(store, plan, history)?,
            false => report::scenario::write_tables(store, plan, history)?,
        };
        let circumstances = Circumstances {
            command: self.command,
            threads: self.threads,
            shard: None,
            cases_computed: None,
            cases_found: None,
            interrupted: history.outcome.ended == SimulationEnd::Interrupted,
        };
        self.clock
            .write(store, &plan.solver, None, &circumstances)?;
        Ok(left_out)
    }

    /// Prints the history, and what was left out.
    pub(super) fn tell(
        &self,
        store: &Store,
        plan: &ScenarioPlan,
        (History { outcome, .. }, left_out): (&History, &[String]),
    ) -> Result<Ended, Failure> {
        let text = || {
            let mut text = terminal_simulation::text(plan, outcome);
            text.append(left_out.join("\n"));
            text.append(format!("\nResults in {}", store.folder().display()));
            Ok(text)
        };
        tell(self.format, self.quiet, || found_in(store, outcome), text)
    }
}

/// What the folder holds, as one object.
fn found_in(store: &Store, outcome: &SimulationOutcome) -> Result<serde_json::Value, Failure> {
    let moments: Vec<Moment> = Moment::all(outcome).collect();
    Ok(serde_json::json!({
        "summary": read_json(&store.folder().join("summary.json"))?,
        "history": machine::rows(&quantities::of_moments(), &moments),
        "cycles": machine::rows(&quantities::of_cycles(), &outcome.cycles),
    }))
}

/// The state of an earlier run, of which a line is told.
fn found(
    checkpoint: &HistoryCheckpoint,
    steps: usize,
    quiet: bool,
) -> Option<HistoryState<'static>> {
    let (text, state) = match checkpoint.find() {
        Ok(None) => return None,
        Ok(Some(state)) => {
            let done = state.steps_done();
            let text = format!("{done} of {steps} steps were already done");
            (text, Some(state))
        }
        Err(unusable) => {
            let text = format!("{unusable}; the history is computed from its beginning");
            (text, None)
        }
    };
    if !quiet {
        line(&text);
    }
    state
}
