//! `contact-dma identify`: from measured cycles to a material.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;

use super::failure::{Ended, Failure};
use super::flags::RunFlags;
use super::folders::{folder_of, in_folder, write_kept};
use super::output::{OutputFormat, tell, warn};
use super::progress::bar;
use super::{interruption, meant_for};
use crate::force_curve::resolved::CurvesPlan;
use crate::force_curve::{Kept, fit_all};
use crate::identify::{IdentifyError, IdentifyPlan, curves, identify};
use crate::input::given::Given;
use crate::input::identify_file::{self, Asked};
use crate::report::force_curve::CurvesReport;
use crate::report::identified::{Identification, IdentificationError};
use crate::report::identify::IdentifyReport;
use crate::report::text::Text;
use crate::sweep::search::run;
use crate::sweep::store::manifest::{Kind, Target};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma identify sweeps/identify-polymer.toml
  contact-dma identify measured.toml --set identify.branches=2 --out /tmp/material
  contact-dma identify sweeps/identify-curve.toml

The file names a table of measured cycles under [identify], with the columns of sweep.csv, and
has the [indenter], the [drive] and the poisson_ratio of the measurement. Or it names force curves
(curve = ...), which have no [drive]. The folder opens with index.html, one page of everything;
material.toml is a [material] block for a sweep.")]
pub(super) struct IdentifyFlags {
    #[command(flatten)]
    run: RunFlags,
}

/// Runs the command.
pub(super) fn run(flags: &IdentifyFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let flags = &flags.run;
    let document = meant_for::open(&meant_for::IDENTIFICATION, &flags.file, &flags.set)?;
    let asked = identify_file::plan(&document, &Given::default())?;
    let target = Target {
        folder: &folder_of(flags),
        kind: Kind::Identification,
        force: flags.work.force,
        reads: &document.files(),
    };
    target.check()?;
    let interrupt = interruption::keep_finished();
    let pool = run::pool(flags.work.threads()).map_err(Failure::run)?;
    let mut finished = None;
    let (title, made) = match &asked {
        Asked::Driven(plan) => (&plan.title, pool.install(|| of_series(plan, &interrupt))),
        Asked::Curves(plan) => {
            let bar = bar(
                plan.curves.len(),
                "{wide_bar} {pos}/{len} curves, {eta} left",
                flags.work.quiet || plan.curves.len() == 1,
            );
            let path = unfinished(target.folder);
            let kept = match plan.curves.len() {
                1 => Kept::default(),
                _ => Kept::in_file(&path).unwrap_or_default(),
            };
            let made = pool.install(|| of_curves(plan, &kept, &interrupt, &|| bar.inc(1)));
            bar.finish_and_clear();
            if interrupt.load(Ordering::Relaxed) && path.exists() {
                warn(&format!(
                    "curves that are done are kept in {}: the same command goes on",
                    path.display()
                ));
            } else {
                finished = Some(kept);
            }
            (&plan.title, made)
        }
    };
    let made = match made {
        _ if interrupt.load(Ordering::Relaxed) => return Ok(Ended::Interrupted),
        Err(IdentifyError::Interrupted) => return Ok(Ended::Interrupted),
        Err(error) => return Err(refused(&flags.file, &error)),
        Ok(made) => made.map_err(Failure::run)?,
    };
    write_kept(&target, made.files, made.figures, !flags.no_figures)?;
    if let Some(kept) = finished {
        kept.done();
    }
    let missing = made.missing;
    tell(
        format,
        flags.work.quiet,
        || Ok(made.summary),
        || {
            let mut text = Text::from(format!("{title}\n\n"));
            text.append(made.text);
            text.append(in_folder("Material and figures", Some(&target)));
            Ok(text)
        },
    )?;
    Ok(match missing {
        0 => Ended::Done,
        _ => Ended::SomeCasesWithoutResult,
    })
}

/// What is made of a plan, or why nothing is found; and what could not be told of it.
type Made = Result<Result<Identification, IdentificationError>, IdentifyError>;

fn of_series(plan: &IdentifyPlan, interrupt: &AtomicBool) -> Made {
    let found = identify(plan, interrupt)?;
    let curves = curves(plan, &found, interrupt)?;
    Ok(Identification::of_series(&IdentifyReport {
        plan,
        found: &found,
        curves: &curves,
    }))
}

/// Where the laws of curves that are done are kept until all are.
fn unfinished(folder: &Path) -> PathBuf {
    let mut name = folder.file_name().unwrap_or_default().to_owned();
    name.push(".unfinished.jsonl");
    folder.with_file_name(name)
}

fn of_curves(
    plan: &CurvesPlan,
    kept: &Kept,
    interrupt: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Made {
    let fits = fit_all(plan, kept, interrupt, done)?;
    Ok(Identification::of_curves(&CurvesReport::new(plan, &fits)))
}

/// What is wrong with the data is bad input; a cycle that was not found is not.
fn refused(file: &Path, error: &IdentifyError) -> Failure {
    let message = format!("{}: {error}", file.display());
    match error {
        IdentifyError::NoCycle { .. } | IdentifyError::NoHistory(_) | IdentifyError::NoFit(_) => {
            Failure::Run(message)
        }
        _ => Failure::Input(message),
    }
}
