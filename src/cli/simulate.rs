//! `contact-dma simulate`: from a scenario file to the folder of results.

use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::arguments::SimulateFlags;
use super::document::Document;
use super::sweep::interrupt_flag;
use super::{Ended, Failure, print, scenario_file};
use crate::report::{self, terminal_simulation};
use crate::sweep::resolved;
use crate::sweep::scenario;
use crate::sweep::simulate::{Simulation, SimulationEnd, SimulationOutcome};
use crate::sweep::store::{Store, StoreError};

/// Runs the command.
pub(super) fn run(flags: &SimulateFlags) -> Result<Ended, Failure> {
    let mut document = Document::read(&flags.file)?;
    for assignment in &flags.set {
        document.set(assignment)?;
    }
    let folder = flags.file.parent().unwrap_or(Path::new(""));
    let plan = scenario_file::plan(&document, folder)?;
    let simulation = Simulation::new(plan).map_err(Failure::input)?;
    let store = open_store(flags, &simulation)?;
    let interrupt = interrupt_flag()?;
    let bar = bar(simulation.schedule().moments.len(), flags.quiet);
    let outcome = simulation.run(&interrupt, &|done, _| bar.set_position(done as u64));
    bar.finish_and_clear();
    let left_out =
        report::scenario::write(&store, simulation.plan(), &outcome).map_err(Failure::run)?;
    ended(flags, &simulation, &outcome, &left_out, &store)
}

fn open_store(flags: &SimulateFlags, simulation: &Simulation) -> Result<Store, Failure> {
    let resolved = scenario::resolved_text(simulation.plan());
    let hash = resolved::hash(&resolved);
    let folder = flags.out.clone().unwrap_or_else(|| {
        let stem = flags.file.file_stem().unwrap_or_default();
        PathBuf::from("reports").join(stem)
    });
    Store::open(&folder, &resolved, &hash, flags.force).map_err(|error| match error {
        StoreError::OtherSweep { .. } => Failure::input(error),
        other => Failure::run(other),
    })
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
    flags: &SimulateFlags,
    simulation: &Simulation,
    outcome: &SimulationOutcome,
    left_out: &[String],
    store: &Store,
) -> Result<Ended, Failure> {
    let folder = store.folder().display();
    if let SimulationEnd::Failed(message) = &outcome.ended {
        return Err(Failure::run(format!(
            "{message}\n  what came before is in {folder}"
        )));
    }
    if !flags.quiet {
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
