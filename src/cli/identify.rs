//! `contact-dma identify`: from measured cycles to a material.

use std::path::Path;
use std::sync::atomic::Ordering;

use clap::Args;

use super::failure::{Ended, Failure};
use super::flags::RunFlags;
use super::folders::{folder_of, in_folder, write_kept};
use super::output::{OutputFormat, tell};
use super::{interruption, meant_for};
use crate::identify::{IdentifyError, curves, identify};
use crate::input::identify_file;
use crate::report::identify::{IdentifyReport, summary};
use crate::report::kept_figures::KeptFigures;
use crate::report::text::Text;
use crate::sweep::search::run;
use crate::sweep::store::manifest::{Kind, Target};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma identify sweeps/identify-polymer.toml
  contact-dma identify measured.toml --set identify.branches=2 --out /tmp/material

The file names a table of measured cycles under [identify], with the columns of sweep.csv, and
has the [indenter], the [drive] and the poisson_ratio of the measurement. The folder opens with
index.html, one page of everything; material.toml is a [material] block for a sweep.")]
pub(super) struct IdentifyFlags {
    #[command(flatten)]
    run: RunFlags,
}

/// Runs the command.
pub(super) fn run(flags: &IdentifyFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let flags = &flags.run;
    let document = meant_for::open(&meant_for::IDENTIFICATION, &flags.file, &flags.set)?;
    let plan = identify_file::plan(&document)?;
    let target = Target {
        folder: &folder_of(flags),
        kind: Kind::Identification,
        force: flags.work.force,
        reads: &document.files(),
    };
    target.check()?;
    let interrupt = interruption::keep_finished();
    let pool = run::pool(flags.work.threads()).map_err(Failure::run)?;
    let made = pool.install(|| {
        let found = identify(&plan, &interrupt)?;
        let curves = curves(&plan, &found, &interrupt)?;
        Ok((found, curves))
    });
    let (found, curves) = match made {
        _ if interrupt.load(Ordering::Relaxed) => return Ok(Ended::Interrupted),
        Err(IdentifyError::Interrupted) => return Ok(Ended::Interrupted),
        Err(error) => return Err(refused(&flags.file, &error)),
        Ok(made) => made,
    };
    let report = IdentifyReport {
        plan: &plan,
        found: &found,
        curves: &curves,
    };
    let block = report.block().map_err(Failure::run)?;
    let kept = KeptFigures::of_identification(&report, &block)?;
    write_kept(&target, report.files(&block), kept, !flags.no_figures)?;
    let found = || {
        let mut value = summary::summary(&report);
        value["material_toml"] = block.as_str().into();
        Ok(value)
    };
    tell(format, flags.work.quiet, found, || {
        let mut text = Text::from(format!("{}\n\n", plan.title));
        text.append(report.text());
        text.append_apart(report.unknowns().into());
        text.append(in_folder("Material and figures", Some(&target)));
        Ok(text)
    })
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
