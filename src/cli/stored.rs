//! Sweeps that are in a folder already: `contact-dma merge` and `contact-dma report`.

use std::path::Path;
use std::sync::Arc;

use super::arguments::{MergeFlags, OutputFormat, ReportFlags};
use super::progress::Shown;
use super::sweep::{Job, failure, interrupt_flag};
use super::{Ended, Failure};
use crate::input::document::Document;
use crate::input::sweep_file;
use crate::sweep::case::Setup;
use crate::sweep::plan::resolved::{self, identity};
use crate::sweep::plan::{Case, Condition};
use crate::sweep::search::run::{self, Options, Progress, RunError};
use crate::sweep::store::difference;
use crate::sweep::store::merge;
use crate::sweep::store::provenance::Stopwatch;
use crate::sweep::store::{RESOLVED, Store};

/// Names of cases in a message before the rest is counted.
const NAMED: usize = 10;

/// Joins the parts and does what is left to do.
pub(super) fn merge(flags: &MergeFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let clock = Stopwatch::start();
    let mut parts = Vec::new();
    for folder in &flags.parts {
        parts.push(Store::reopen_to_read(folder).map_err(|e| failure(RunError::Store(e)))?);
    }
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
    let setup = setup_of(&flags.parts[0], resolved, &[])?;
    let out = Store::open(&flags.out, resolved, flags.force);
    let out = out.map_err(|error| failure(RunError::Store(error)))?;
    let cases = setup.plan().cases();
    let unit = setup.plan().figures.frequency_unit;
    let progress = Shown::new(cases.len(), unit, flags.quiet);
    let parts: Vec<Store> = parts.into_iter().map(|(part, _)| part).collect();
    let missing = merge::gather(&parts, &out, &cases, &|what| progress.told(what));
    let missing = missing.map_err(|error| failure(RunError::Store(error)))?;
    if !missing.is_empty() {
        return Err(Failure::Run(lacking(&missing, cases.len(), &out)));
    }
    let interrupt = interrupt_flag()?;
    let setup = setup.interrupted_by(Arc::clone(&interrupt));
    let options = Options::on_threads(run::useful_threads(flags.threads));
    let outcome = run::run_with(&setup, &out, &options, &interrupt, &progress);
    progress.finish();
    let job = Job {
        setup: &setup,
        store: &out,
        records: &out,
        quiet: flags.quiet,
        format,
        figures: true,
        cycles: false,
        stats: false,
        command: "merge",
        clock,
        threads: options.threads,
        found: progress.found(),
    };
    job.finish(outcome.map_err(failure)?)
}

/// Draws tables and figures of a folder again.
pub(super) fn report(flags: &ReportFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let asked = (!flags.no_figures, flags.quiet, format);
    if let Some(done) = super::analyse::again(&flags.folder, flags.out.as_deref(), asked) {
        return done;
    }
    let clock = Stopwatch::start();
    let refused = |error| failure(RunError::Store(error));
    // A folder that is only read from may be one that nobody can write to.
    let opened = match &flags.out {
        None => Store::reopen(&flags.folder),
        Some(_) => Store::reopen_to_read(&flags.folder),
    };
    let (store, resolved) = opened.map_err(refused)?;
    let setup = setup_of(&flags.folder, &resolved, &flags.set)?;
    let plan = setup.plan();
    let unit = plan.figures.frequency_unit;
    let progress = Shown::new(plan.cases().len(), unit, flags.quiet);
    let outcome = run::collect(&setup, &store, &progress).map_err(failure)?;
    progress.finish();
    if outcome.records.is_empty() {
        return Err(Failure::Input(format!(
            "{} holds no usable record of the sweep: run `contact-dma sweep` first",
            flags.folder.display()
        )));
    }
    let changed = resolved::resolved_text(setup.plan());
    let out = flags.out.as_deref();
    let out = out
        .map(|out| Store::open(out, &changed, flags.force))
        .transpose();
    let out = out.map_err(refused)?;
    let job = Job {
        setup: &setup,
        store: out.as_ref().unwrap_or(&store),
        records: &store,
        quiet: flags.quiet,
        format,
        figures: !flags.no_figures,
        cycles: flags.cycles,
        stats: false,
        command: "report",
        clock,
        threads: 1,
        found: outcome.records.len(),
    };
    let ended = job.finish(outcome)?;
    if changed != resolved || flags.out.is_some() {
        // What the folder says of its figures must be what they are.
        let store = out.as_ref().unwrap_or(&store);
        store.write(RESOLVED, changed.as_bytes()).map_err(refused)?;
    }
    Ok(match ended {
        Ended::Interrupted => Ended::SomeCasesWithoutResult,
        ended => ended,
    })
}

/// The sweep that a folder says it holds, its figures changed as asked.
fn setup_of(folder: &Path, text: &str, set: &[String]) -> Result<Setup, Failure> {
    let name = folder.join(RESOLVED).display().to_string();
    let mut document = Document::parse(&name, text)?.in_folder(folder);
    let mut plan = sweep_file::plan(&document)?;
    if resolved::resolved_text(&plan) != text {
        return Err(Failure::Input(format!(
            "{name} is not as this version of the program would write it: run the sweep again"
        )));
    }
    if !set.is_empty() {
        for assignment in set {
            document.set(assignment)?;
        }
        plan = sweep_file::plan(&document)?;
        let changed = resolved::resolved_text(&plan);
        if identity(&changed) != identity(text) {
            return Err(Failure::Input(format!(
                "`report` solves nothing, and --set can change [figures] alone; this is another sweep:\n{}for it run \
                 `contact-dma sweep`",
                difference::lines(&identity(text), &identity(&changed), NAMED)
            )));
        }
    }
    Setup::new(plan).map_err(Failure::input)
}

fn lacking(missing: &[Case], of: usize, out: &Store) -> String {
    let mut text = format!(
        "{} of {of} cases are in none of the parts:\n",
        missing.len()
    );
    for case in missing.iter().take(NAMED) {
        let Condition { values, drive, .. } = &case.condition;
        let values = values.all().iter();
        let value: String = values.map(|value| format!("axis {value}, ")).collect();
        text.push_str(&format!(
            "  case {}: ω = {:e} rad/s ({value}mean {}, amplitude {})\n",
            case.index,
            case.angular_frequency_rad_per_s,
            drive.mean(),
            drive.amplitude()
        ));
    }
    if missing.len() > NAMED {
        text.push_str(&format!("  and {} more\n", missing.len() - NAMED));
    }
    text.push_str(&format!(
        "What there is has been copied to {}: merge again with the rest, or run the sweep there",
        out.folder().display()
    ));
    text
}
