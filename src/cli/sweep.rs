//! `contact-dma sweep`: from a sweep file to the folder of results.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::arguments::SweepFlags;
use super::progress::Shown;
use super::{Ended, Failure, open_document, open_store, print, sweep_file};
use crate::report::{self, terminal};
use crate::sweep::case::Setup;
use crate::sweep::record::Status;
use crate::sweep::resolved;
use crate::sweep::run::{self, Outcome};

/// Runs the command.
pub(super) fn run(flags: &SweepFlags) -> Result<Ended, Failure> {
    let accuracy = flags.accuracy.map(|a| format!("cycle.accuracy={a:?}"));
    let set: Vec<String> = flags.set.iter().cloned().chain(accuracy).collect();
    let document = open_document(&flags.file, &set)?;
    let plan = sweep_file::plan(&document)?;
    let setup = Setup::new(plan).map_err(Failure::input)?;
    let resolved = resolved::resolved_text(setup.plan());
    let store = open_store(&flags.file, flags.out.as_deref(), &resolved, flags.force)?;
    let interrupt = interrupt_flag()?;
    let threads = match flags.threads {
        Some(threads) => threads.get(),
        None => std::thread::available_parallelism().map_or(1, usize::from),
    };
    let cases = setup.plan().cases().len();
    let progress = Shown::new(cases, flags.quiet);
    let outcome = run::run(&setup, &store, threads, &interrupt, &progress);
    progress.finish();
    let outcome = outcome.map_err(Failure::run)?;
    let left_out = report::write_sweep(&store, setup.plan(), &outcome).map_err(Failure::run)?;
    if !flags.quiet {
        print(&text(&setup, &outcome, &left_out, store.folder()))?;
    }
    Ok(ended(&outcome))
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
    } else if outcome.count(Status::Converged) < outcome.records.len() {
        Ended::SomeCasesWithoutResult
    } else {
        Ended::Done
    }
}

/// What is printed at the end.
fn text(setup: &Setup, outcome: &Outcome, left_out: &[String], folder: &Path) -> String {
    let plan = setup.plan();
    let mut text = format!("{}\n\n", plan.title);
    if let Some(fit) = plan.material.fit() {
        text.push_str(&report::fit::text(fit));
        text.push('\n');
    }
    text.push_str(&terminal::table(plan, outcome));
    for part in [
        terminal::peaks(plan, outcome),
        terminal::problems(outcome),
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
