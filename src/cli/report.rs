//! `contact-dma report`: tables, figures and page of a folder made again, without solving.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::documents::read_bytes;
use super::failure::{Ended, Failure};
use super::flags::folder;
use super::folders::{SCENARIO, figure_plan, stored_plan, stored_sweep, write_figures};
use super::output::{OutputFormat, tell, warn};
use super::progress::Shown;
use super::sweep::Job;
use super::{analyse, simulate};
use crate::report::figure::press::Files;
use crate::report::kept_figures::{KEPT, KeptFigures};
use crate::report::scenario_folder;
use crate::simulation::{Simulation, SimulationEnd};
use crate::sweep::plan::resolved::resolved_text;
use crate::sweep::search::run::{self, Mode};
use crate::sweep::store::files::{Found, Place};
use crate::sweep::store::manifest::{Kind, RUN, Target, kind_of};
use crate::sweep::store::provenance::Stopwatch;
use crate::sweep::store::{RESOLVED, Store};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma report reports/pmma
  contact-dma report reports/pmma --set figures.column=one --set figures.dpi=600
  contact-dma report reports/pmma --out paper/figures

Sweeps and histories are drawn from their records and tables, everything else from records/figures.json.
How figures look is kept in the [figures] table of resolved.toml, or in records/figures.json.")]
pub(super) struct ReportFlags {
    /// Folder of a sweep, a history, an analysis, an identification, a material, a fit or a comparison
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Folder for tables and figures, without the records [default: the folder itself]; nothing is then written into the folder that
    /// is read
    #[arg(long, value_name = "DIR", value_parser = folder())]
    out: Option<PathBuf>,
    /// Replace other results in the folder of --out, or add to a folder that has files of others, of which
    /// none is touched
    #[arg(long, requires = "out")]
    force: bool,
    /// Write only tables, without figures and page
    #[arg(long)]
    no_figures: bool,
    /// Write cases/cycles.npz, all cycles for NumPy, also for more than 200 cases; without this flag an earlier one is removed
    #[arg(long)]
    cycles: bool,
    /// Change one key of [figures], for example figures.width='85 mm'; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// The largest file of a folder that is read.
const MAX_BYTES: usize = 1_000_000_000;

/// Runs the command.
pub(super) fn run(flags: &ReportFlags, format: OutputFormat) -> Result<Ended, Failure> {
    match kind_of(&flags.folder)? {
        None | Some(Kind::Sweep) => sweep(flags, format),
        Some(Kind::Scenario) => history(flags, format),
        Some(kind) => figures(flags, kind, format),
    }
}

impl ReportFlags {
    /// The folder that is written into, of the result with this plan: opened once everything has been read, so that what is
    /// refused leaves no trace.
    fn open(&self, plan: &str) -> Result<Store, Failure> {
        Ok(match &self.out {
            None => Store::reopen(&self.folder)?.0,
            Some(out) => Store::open(out, plan, self.force)?,
        })
    }

    /// Keeps what the folder says of its figures.
    fn keep(&self, out: &Store, (before, plan): (&str, &str)) -> Result<(), Failure> {
        if before != plan || self.out.is_some() {
            out.write(Place::Top(RESOLVED), plan.as_bytes())?;
        }
        Ok(())
    }
}

/// A sweep, from its records.
fn sweep(flags: &ReportFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let clock = Stopwatch::start();
    let (store, before) = Store::reopen_to_read(&flags.folder)?;
    let setup = stored_sweep((&flags.folder, &before), &flags.set)?;
    let progress = Shown::new(setup.plan(), setup.plan().cases().len(), flags.quiet);
    let outcome = run::run(&setup, &store, Mode::Read, &false.into(), &progress)?;
    progress.finish();
    if outcome.records.is_empty() {
        return Err(Failure::Input(format!(
            "{} holds no usable record of the sweep: run `contact-dma sweep` first",
            flags.folder.display()
        )));
    }
    let plan = resolved_text(setup.plan());
    let out = flags.open(&plan)?;
    let job = Job {
        records: &store,
        figures: !flags.no_figures,
        cycles: flags.cycles,
        found: outcome.records.len(),
        ..Job::new("report", clock, (&setup, &out), (format, flags.quiet))
    };
    let ended = job.finish(outcome)?;
    flags.keep(&out, (&before, &plan))?;
    Ok(match ended {
        Ended::Interrupted => Ended::SomeCasesWithoutResult,
        ended => ended,
    })
}

/// A history, from its tables.
fn history(flags: &ReportFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let clock = Stopwatch::start();
    let (_, before) = Store::reopen_to_read(&flags.folder)?;
    let plan = stored_plan(&SCENARIO, (&flags.folder, &before), &flags.set)?;
    let simulation = Simulation::new(plan).map_err(Failure::input)?;
    let history = scenario_folder::read(&flags.folder, &simulation)?;
    let plan = simulation.plan();
    let text = (SCENARIO.resolved)(plan);
    let out = flags.open(&text)?;
    let run = simulate::Run {
        command: "report",
        clock,
        threads: 1,
        figures: !flags.no_figures,
        quiet: flags.quiet,
        format,
    };
    let left_out = run.write(&out, plan, &history)?;
    run.tell(&out, plan, (&history, &left_out))?;
    flags.keep(&out, (&before, &text))?;
    Ok(match history.outcome.ended {
        SimulationEnd::Done => Ended::Done,
        _ => Ended::SomeCasesWithoutResult,
    })
}

/// What has the figures of its folder in figures.json.
fn figures(flags: &ReportFlags, kind: Kind, format: OutputFormat) -> Result<Ended, Failure> {
    let folder = flags.folder.as_path();
    let found = Found::of(folder);
    let path = found.path(KEPT);
    let name = path.display().to_string();
    let kept = match path.exists() {
        true => KeptFigures::read(&read_bytes(&path, MAX_BYTES)?).map_err(|error| {
            Failure::input(format!("{name} holds no figures of this program: {error}"))
        })?,
        // Without it an analysis, as earlier versions saved it from Python, has everything that its figures show.
        false if kind == Kind::Analysis => KeptFigures::of_loops(&analyse::stored(folder)?)?.0,
        false => return Err(without_figures(flags, kind)),
    };
    let asked = figure_plan(&name, kept.asked(), &flags.set)?;
    let files = Files::default();
    for (file, path) in found.all() {
        if file != RUN && !kept.make(file) {
            files.insert(file, read_bytes(&path, MAX_BYTES)?);
        }
    }
    let out = flags.out.as_deref().unwrap_or(folder);
    let target = Target {
        folder: out,
        kind,
        force: flags.force,
        reads: &[],
    };
    let names: Vec<String> = kept.names().into_iter().map(str::to_owned).collect();
    let left_out = write_figures(&target, (kept, !flags.no_figures), &asked, files)?;
    left_out.iter().for_each(|reason| warn(reason));
    if kind == Kind::Analysis {
        return analyse::told(out, &analyse::stored(out)?, (flags.quiet, format));
    }
    let found = || Ok(json!({ "folder": out, "figures": names }));
    let text = || Ok(format!("{} figures in {}", names.len(), out.display()).into());
    tell(format, flags.quiet, found, text)
}

/// A folder without `records/figures.json`, whose figures only the command that made it can make: it says by which.
fn without_figures(flags: &ReportFlags, kind: Kind) -> Failure {
    let folder = flags.folder.display();
    let again = match kind {
        Kind::Sweep => "sweep FILE",
        Kind::Scenario => "simulate FILE",
        Kind::Analysis => "analyse FILES",
        Kind::Identification => "identify FILE",
        Kind::Material => "material show MATERIAL",
        Kind::MaterialFit => "material fit FILE",
        Kind::Comparison => "compare BASELINE NEW",
        Kind::Reproduction => "reproduce",
    };
    let out = flags.out.as_deref().unwrap_or(&flags.folder).display();
    Failure::Input(format!(
        "{folder} holds {}, without the {KEPT} of which figures are drawn again\n= help: `contact-dma {again} --out {out}` makes them \
         again",
        kind.text()
    ))
}
