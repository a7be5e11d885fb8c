//! `contact-dma identify`: from measured cycles to a material.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use clap::Args;

use super::arguments::{OutputFormat, folder, threads};
use super::interruption;
use super::material::{commented, draw, print_place};
use super::{Ended, Failure, default_folder, json, meant_for, open_document, print};
use crate::identify::{IdentifyError, curves, identify};
use crate::input::identify_file;
use crate::report::caption::Setting;
use crate::report::figure::press::Files;
use crate::report::identify::{IdentifyReport, summary};
use crate::report::text::Text;
use crate::report::{figure, page};
use crate::sweep::plan::resolved;
use crate::sweep::search::run;
use crate::sweep::store::manifest::{Kind, Target};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma identify sweeps/identify-polymer.toml
  contact-dma identify measured.toml --set identify.branches=2 --out /tmp/material

The file names a table of measured cycles under [identify], with the columns of sweep.csv
(energy_loss_j, phase_lag_rad, approach_max_m and so on, errors beside them where they are
known), and has the [indenter], the [drive] and the poisson_ratio of the measurement. Where
[drive] has segments, the table is a history: time_s and approach_m, or load_n.

Written to the output folder: material.toml (a [material] block for a sweep), prony.csv,
summary.json, fit.csv (data and model), moduli.csv (E' and E'' with bands), resolved.toml
(the file with every default), figures as SVG and PNG, index.html.")]
pub(super) struct IdentifyFlags {
    /// The identification file (TOML); - reads standard input, from which paths start in the working folder
    pub(super) file: PathBuf,
    /// Folder for the results [default: reports/<name of the file>]
    #[arg(long, value_name = "DIR", value_parser = folder())]
    pub(super) out: Option<PathBuf>,
    /// Change one key of the file, for example identify.branches=2; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
    /// Number of threads [default: one per processor, at most four for each]; the results do not depend on it
    #[arg(long, value_name = "N", env = "CONTACT_DMA_THREADS", value_parser = threads)]
    pub(super) threads: Option<NonZeroUsize>,
    /// Write only tables, without figures and page
    #[arg(long)]
    pub(super) no_figures: bool,
    /// Replace another result in the output folder, or add to a folder that has files of others, of which none is touched
    #[arg(long)]
    pub(super) force: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// Runs the command.
pub(super) fn run(flags: &IdentifyFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let document = open_document(&flags.file, &flags.set)?;
    meant_for::identify(&document, &flags.file)?;
    let plan = identify_file::plan(&document)?;
    let default = default_folder(&flags.file);
    let target = Target {
        folder: flags.out.as_deref().unwrap_or(&default),
        kind: Kind::Identification,
        force: flags.force,
        reads: &document.files(),
    };
    target.check()?;
    let interrupt = interruption::keep_finished();
    let pool = run::pool(run::useful_threads(flags.threads)).map_err(Failure::run)?;
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
    let block = block(&report)?;
    let files = Files::default();
    for (name, bytes) in report.files(&block) {
        files.insert(name, bytes);
    }
    if !flags.no_figures {
        let figures = figure::identify::figures(&report);
        draw(&files, &figures, &Setting::default(), |pictures, _| {
            page::identify::page(&report, &figures, &block, pictures)
        })?;
    }
    target.write(files.into_vec())?;
    match format {
        OutputFormat::Json => {
            let mut value = summary::summary(&report);
            value["material_toml"] = block.into();
            json::print(&value)
        }
        OutputFormat::Text if flags.quiet => Ok(Ended::Done),
        OutputFormat::Text => {
            let mut text = Text::from(format!("{}\n\n", plan.title));
            text.append(report.text());
            text.blank();
            text.append(report.unknowns());
            print(&text)?;
            print_place("Material and figures", target.folder, format)
        }
    }
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

/// The material block of a sweep file, every number exact, with where it comes from.
fn block(report: &IdentifyReport<'_>) -> Result<String, Failure> {
    let mut text = Text::from(report.plan.title.as_str());
    text.append(report.text());
    let material = report
        .plan
        .material_of(report.found)
        .map_err(Failure::run)?;
    Ok(commented(&text) + &resolved::material_text(&material))
}
