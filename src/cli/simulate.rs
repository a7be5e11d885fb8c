//! `contact-dma simulate`: from a scenario file to the folder of results.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use clap::Args;

use super::arguments::{OutputFormat, folder, threads};
use super::interruption;
use super::plan::{megabytes, nodes};
use super::progress::{bar, line};
use super::{Ended, Failure, json, meant_for, memory, open_document, open_store, tell};
use crate::figures::paper::drawing_bytes;
use crate::input::scenario_file;
use crate::report::quantities::{self, Moment};
use crate::report::{self, machine, terminal_simulation};
use crate::simulation::checkpoint::{HistoryCheckpoint, HistoryState};
use crate::simulation::scenario;
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

The same command again goes on where it was stopped, from the last checkpoint.

Written to the output folder: index.html (one page of everything, to look at or to send),
history.csv (one row per time step, two at a jump), profiles/ and fields/ at the times asked
for (CSV; NumPy .npy and ParaView .vti), history, profiles and pressure-map as SVG and PNG,
summary.json, resolved.toml (the scenario with every default).")]
pub(super) struct SimulateFlags {
    /// The scenario file (TOML); - reads standard input, from which paths start in the working folder
    file: PathBuf,
    /// Folder for the results [default: reports/<name of the file>]
    #[arg(long, value_name = "DIR", value_parser = folder())]
    out: Option<PathBuf>,
    /// Change one key of the scenario file, for example indenter.radius='5 mm'; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Do not estimate the errors of the rows, which saves more than half of the time; the same as
    /// --set output.error_bars=false
    #[arg(long)]
    no_error_bars: bool,
    /// Write only tables, without figures and page
    #[arg(long)]
    no_figures: bool,
    /// Number of threads, which share a large half-space grid [default: one per processor, at most four for each]; the
    /// results do not depend on it
    #[arg(long, value_name = "N", env = "CONTACT_DMA_THREADS", value_parser = threads)]
    threads: Option<NonZeroUsize>,
    /// Print what would be computed and the approximate memory it takes, and compute nothing
    #[arg(long)]
    dry_run: bool,
    /// Seconds between checkpoints of a long history
    #[arg(long, value_name = "SECONDS", default_value_t = checkpoint_file::EVERY.as_secs())]
    checkpoint_every: u64,
    /// Replace the results of a different sweep or scenario in the output folder, or add to a folder that has files of others,
    /// of which none is touched
    #[arg(long)]
    force: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the command.
pub(super) fn run(flags: &SimulateFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let clock = Stopwatch::start();
    let mut set = flags.set.clone();
    if flags.no_error_bars {
        set.push("output.error_bars=false".to_owned());
    }
    let document = open_document(&flags.file, &set)?;
    meant_for::simulate(&document, &flags.file)?;
    let plan = scenario_file::plan(&document)?;
    let simulation = Simulation::new(plan).map_err(Failure::input)?;
    if flags.dry_run {
        let found = || {
            let steps = simulation.schedule().moments.len();
            Ok(serde_json::json!({
                "title": simulation.plan().title,
                "engine": simulation.plan().solver.engine.name(),
                "time_steps": steps,
                "time_steps_for_errors": simulation.moments() - steps,
                "memory_bytes": simulation.predicted_memory_bytes(),
            }))
        };
        return tell(format, false, found, || predicted(&simulation).into());
    }
    let resolved = scenario::resolved_text(simulation.plan());
    let out = (flags.out.as_deref(), flags.force);
    let store = open_store((&flags.file, &document), out, &resolved)?;
    let interrupt = interruption::keep_finished();
    let simulation = simulation.interrupted_by(Arc::clone(&interrupt));
    let checkpoint = HistoryCheckpoint::of(&store, Duration::from_secs(flags.checkpoint_every));
    let state = found(&checkpoint, simulation.moments(), flags.quiet);
    let template = "{wide_bar} {pos}/{len} steps, {eta} left";
    let bar = bar(simulation.moments(), template, flags.quiet);
    let threads = run::useful_threads(flags.threads);
    let drawing_bytes = match flags.no_figures {
        true => 0,
        false => drawing_bytes(&simulation.plan().figures, threads),
    };
    memory::warn_if_short(simulation.predicted_memory_bytes(), 1, drawing_bytes);
    let pool = run::pool(threads)?;
    let told = |done, _| bar.set_position(done as u64);
    let (simulation, flag, told) = (&simulation, &interrupt, &told);
    let (outcome, checkpoint) = pool.install(move || {
        let outcome = simulation.run_from(state, Some(&checkpoint), flag, told);
        (outcome, checkpoint)
    });
    bar.finish_and_clear();
    let write = match flags.no_figures {
        true => report::scenario::write_tables,
        false => report::scenario::write,
    };
    let left_out = write(&store, simulation.plan(), &outcome)?;
    if outcome.ended != SimulationEnd::Interrupted {
        checkpoint.remove();
    }
    let circumstances = Circumstances {
        command: "simulate",
        threads,
        shard: None,
        cases_computed: None,
        cases_found: None,
        interrupted: outcome.ended == SimulationEnd::Interrupted,
    };
    clock.write(&store, &simulation.plan().solver, None, &circumstances)?;
    let folder = store.folder().display();
    if let SimulationEnd::Failed(message) = &outcome.ended {
        return Err(Failure::run(format!(
            "{message}\n  what came before is in {folder}"
        )));
    }
    let text = || {
        let mut text = terminal_simulation::text(simulation.plan(), &outcome);
        text.append(left_out.join("\n"));
        text.append(format!("\nResults in {folder}"));
        text
    };
    tell(format, flags.quiet, || found_in(&store, &outcome), text)?;
    Ok(match outcome.ended {
        SimulationEnd::Interrupted => Ended::Interrupted,
        _ => Ended::Done,
    })
}

/// What the folder holds, as one object.
fn found_in(store: &Store, outcome: &SimulationOutcome) -> Result<serde_json::Value, Failure> {
    let moments: Vec<Moment> = Moment::all(outcome).collect();
    Ok(serde_json::json!({
        "summary": json::file(&store.folder().join("summary.json"))?,
        "history": machine::rows(&quantities::of_moments(), &moments),
        "cycles": machine::rows(&quantities::of_cycles(), &outcome.cycles),
    }))
}

/// What would be computed, and about the memory it takes.
fn predicted(simulation: &Simulation) -> String {
    let plan = simulation.plan();
    let free = memory::free_here();
    format!(
        "{}\n\n{} time steps on {} ({} engine){}.\nMemory: about {}{free}.\n",
        plan.title,
        simulation.schedule().moments.len(),
        nodes(&plan.solver, plan.contact.indenter.as_ref()),
        plan.solver.engine.name(),
        match simulation.moments() - simulation.schedule().moments.len() {
            0 => String::new(),
            more => format!(";\n{more} more, most on fewer nodes, for the errors"),
        },
        megabytes(simulation.predicted_memory_bytes()),
    )
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
