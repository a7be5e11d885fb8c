//! `contact-dma compare`: whether two results of a sweep are the same.

use std::path::{Path, PathBuf};

use clap::Args;

use serde_json::{Value, json};

use super::documents::read_bytes;
use super::failure::{Ended, Failure};
use super::flags::OutFlags;
use super::folders::{refuse_other, write_figures};
use super::output::{OutputFormat, tell};
use crate::report::caption::Setting;
use crate::report::comparison::{Comparison, Opened, Tolerances};
use crate::report::figure::{self, press::Files};
use crate::report::kept_figures::KeptFigures;
use crate::report::page::{self, comparison::Compared};
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::store::manifest::{Kind, Target, kind_of};

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma compare reports/baseline/pmma reports/pmma
  contact-dma compare reports/baseline/pmma reports/pmma --peaks 1e-3
  contact-dma compare a/sweep.csv b/sweep.csv --relative 1e-3 --tolerance peak_pressure_max_pa=1e-2

Cases are matched by drive and frequency, peaks by frequency. Values on the same steps and nodes
are the same within --relative and --absolute; on different ones, within their error bars too.
With --peaks, the verdict (exit code 0 or 4) is on the peaks and the columns of --tolerance alone.")]
pub(super) struct CompareFlags {
    /// Folder of a sweep, or a sweep.csv
    baseline: PathBuf,
    /// The same of what is compared with it
    new: PathBuf,
    /// Relative difference allowed
    #[arg(long, value_name = "R", allow_negative_numbers = true, default_value = "1e-6", value_parser = tolerance)]
    relative: f64,
    /// Absolute difference allowed, in SI units, on top
    #[arg(long, value_name = "A", allow_negative_numbers = true, default_value = "0", value_parser = tolerance)]
    absolute: f64,
    /// Relative difference allowed in one column (of the frequency: in the frequencies of the peaks); may be repeated
    #[arg(long, value_name = "COLUMN=R", value_parser = column_tolerance)]
    tolerance: Vec<(String, f64)>,
    /// Judge by the peaks: relative difference allowed in their frequencies and losses, beyond the uncertainty with which they were
    /// located
    #[arg(long, value_name = "R", num_args = 0..=1, allow_negative_numbers = true, default_missing_value = "1e-3", value_parser = tolerance)]
    peaks: Option<f64>,
    #[command(flatten)]
    to: OutFlags,
    /// Print nothing but errors
    #[arg(long, short)]
    quiet: bool,
}

/// A result larger than this is none of a sweep.
const MAX_BYTES: usize = 256_000_000;

/// Runs the command.
pub(super) fn run(flags: &CompareFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let tolerances = Tolerances {
        relative: flags.relative,
        absolute: flags.absolute,
        columns: flags.tolerance.clone(),
        peaks: flags.peaks,
    };
    let reads = [flags.baseline.clone(), flags.new.clone()];
    let target = flags.to.target(Kind::Comparison, &reads)?;
    for result in &reads {
        refuse_without_table(result)?;
    }
    let read = |path: &Path| read_bytes(path, MAX_BYTES);
    let baseline = Opened::read(&flags.baseline, None, read)?;
    let new = Opened::read(&flags.new, Some(&baseline.table), read)?;
    let comparison = Comparison::of(&baseline.table, &new.table, &tolerances)?;
    let mut text = comparison.text();
    if let Some(target) = &target {
        let left_out = write(target, &comparison, &tolerances, [&baseline, &new])?;
        text.append(left_out.join("\n"));
    }
    text.append(format!("\n{}", comparison.verdict()));
    if let Some(out) = &flags.to.out {
        text.append(format!("\nComparison in {}", out.display()));
    }
    let found = || Ok(to_json(&comparison));
    tell(format, flags.quiet, found, || Ok(text))?;
    Ok(match comparison.differs() {
        true => Ended::Differs,
        false => Ended::Done,
    })
}

/// What a comparison found.
fn to_json(comparison: &Comparison) -> Value {
    let mut value = json!(comparison);
    value["differs"] = comparison.differs().into();
    value["verdict"] = comparison.verdict().into();
    value
}

/// Refuses a folder without a table of cycles.
fn refuse_without_table(result: &Path) -> Result<(), Failure> {
    if !result.is_dir() {
        return Ok(());
    }
    let remedy = match kind_of(result) {
        Ok(Some(Kind::Analysis)) => "`contact-dma analyse` makes it anew".to_owned(),
        _ => {
            refuse_other(result, "compare")?;
            format!("`contact-dma report {}` writes it again", result.display())
        }
    };
    match result.join("sweep.csv").exists() {
        true => Ok(()),
        false => Err(Failure::Input(format!(
            "{} is not whole: its sweep.csv is missing; {remedy}",
            result.display()
        ))),
    }
}

/// Writes figure, data and page. Returns what was left out and why.
fn write(
    target: &Target<'_>,
    comparison: &Comparison,
    tolerances: &Tolerances,
    [baseline, new]: [&Opened; 2],
) -> Result<Vec<String>, Failure> {
    let (figures, why) = match figure::comparison::figure(comparison) {
        Ok(figure) => (vec![figure], None),
        Err(why) => (Vec::new(), Some(why.to_owned())),
    };
    let (kept, not_drawn) = KeptFigures::of(&figures, &Setting::default(), |pictures| {
        page::comparison::page(&Compared {
            comparison,
            tolerances,
            baseline: &baseline.table,
            new: &new.table,
            sources: [&baseline.source, &new.source],
            pictures,
        })
    })?;
    let files = Files::of([("comparison.csv", comparison.table())]);
    let left_out = write_figures(target, (kept, true), &FigurePlan::default(), files)?;
    Ok(why.into_iter().chain(not_drawn).chain(left_out).collect())
}

/// `COLUMN=RELATIVE`.
fn column_tolerance(text: &str) -> Result<(String, f64), String> {
    let (column, value) = text
        .split_once('=')
        .ok_or("write COLUMN=RELATIVE, for example energy_loss_j=1e-3")?;
    Ok((column.trim().to_owned(), tolerance(value)?))
}

/// A tolerance: a number, not negative.
fn tolerance(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err(format!(
            "`{text}` is no tolerance: write a number such as 1e-6"
        )),
    }
}
