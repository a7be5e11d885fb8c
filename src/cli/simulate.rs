//! `contact-dma simulate`: from a scenario file to the folder of results.

use std::io::{self, IsTerminal, Write};
use std::sync::Arc;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::arguments::{OutputFormat, SimulateFlags};
use super::plan::{megabytes, nodes};
use super::sweep::interrupt_flag;
use super::{Ended, Failure, json, meant_for, memory, open_document, open_store, print};
use crate::input::scenario_file;
use crate::report::{self, terminal_simulation};
use crate::sweep::history::checkpoint::{HistoryCheckpoint, HistoryState};
use crate::sweep::history::{Simulation, SimulationEnd, SimulationOutcome};
use crate::sweep::plan::scenario;
use crate::sweep::search::run;
use crate::sweep::store::Store;

/// Runs the command.
pub(super) fn run(flags: &SimulateFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let mut set = flags.set.clone();
    if flags.no_error_bars {
        set.push("output.error_bars=false".to_owned());
    }
    let document = open_document(&flags.file, &set)?;
    meant_for::simulate(&document, &flags.file)?;
    let plan = scenario_file::plan(&document)?;
    let simulation = Simulation::new(plan).map_err(Failure::input)?;
    if flags.dry_run {
        return match format {
            OutputFormat::Text => print(&foretold(&simulation)),
            OutputFormat::Json => json::print(&serde_json::json!({
                "title": simulation.plan().title,
                "engine": simulation.plan().contact.solver.engine.name(),
                "time_steps": simulation.schedule().moments.len(),
                "time_steps_for_errors": simulation.moments() - simulation.schedule().moments.len(),
                "memory_bytes": simulation.predicted_memory_bytes(),
            })),
        };
    }
    let resolved = scenario::resolved_text(simulation.plan());
    let store = open_store(&flags.file, flags.out.as_deref(), &resolved, flags.force)?;
    let interrupt = interrupt_flag()?;
    let simulation = simulation.interrupted_by(Arc::clone(&interrupt));
    let checkpoint = HistoryCheckpoint::of(&store, Duration::from_secs(flags.checkpoint_every));
    let state = found(&checkpoint, simulation.moments(), flags.quiet);
    let bar = bar(simulation.moments(), flags.quiet);
    memory::warn_if_short(simulation.predicted_memory_bytes(), 1);
    let pool = run::pool(run::useful_threads(flags.threads)).map_err(Failure::run)?;
    let (outcome, checkpoint) = pool.install({
        let (simulation, interrupt, bar) = (&simulation, &interrupt, &bar);
        move || {
            let told = |done, _| bar.set_position(done as u64);
            let outcome = simulation.run_from(state, Some(&checkpoint), interrupt, &told);
            (outcome, checkpoint)
        }
    });
    bar.finish_and_clear();
    let write = match flags.no_figures {
        true => report::scenario::write_tables,
        false => report::scenario::write,
    };
    let left_out = write(&store, simulation.plan(), &outcome).map_err(Failure::run)?;
    if outcome.ended != SimulationEnd::Interrupted {
        checkpoint.remove();
    }
    ended(
        flags.quiet,
        format,
        (&simulation, &outcome),
        &left_out,
        &store,
    )
}

/// What would be computed, and about the memory it takes.
fn foretold(simulation: &Simulation) -> String {
    let plan = simulation.plan();
    let free = memory::free_here();
    format!(
        "{}\n\n{} time steps on {} ({} engine){}.\nMemory: about {}{free}.\n",
        plan.title,
        simulation.schedule().moments.len(),
        nodes(&plan.contact.solver, plan.contact.indenter.as_ref()),
        plan.contact.solver.engine.name(),
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
        // A closed standard error is no reason to stop.
        let _ = writeln!(io::stderr(), "{text}");
    }
    state
}

/// A bar on a terminal, nothing elsewhere.
fn bar(moments: usize, quiet: bool) -> ProgressBar {
    if quiet || !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::with_draw_target(Some(moments as u64), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} steps, {eta} left") {
        bar.set_style(style);
    }
    bar
}

fn ended(
    quiet: bool,
    format: OutputFormat,
    (simulation, outcome): (&Simulation, &SimulationOutcome),
    left_out: &[String],
    store: &Store,
) -> Result<Ended, Failure> {
    let folder = store.folder().display();
    if let SimulationEnd::Failed(message) = &outcome.ended {
        return Err(Failure::run(format!(
            "{message}\n  what came before is in {folder}"
        )));
    }
    if format == OutputFormat::Json {
        json::print(&serde_json::json!({
            "summary": json::file(&store.folder().join("summary.json"))?,
            "history": json::rows_of(&store.folder().join("history.csv"))?,
            "cycles": match outcome.cycles.is_empty() {
                true => Vec::new(),
                false => json::rows_of(&store.folder().join("cycles.csv"))?,
            },
        }))?;
    } else if !quiet {
        let mut text = terminal_simulation::text(simulation.plan(), outcome);
        for line in left_out {
            text.push_str(&format!("{line}\n"));
        }
        print(&format!("{text}\nResults in {folder}\n"))?;
    }
    Ok(match outcome.ended {
        SimulationEnd::Interrupted => Ended::Interrupted,
        _ => Ended::Done,
    })
}
