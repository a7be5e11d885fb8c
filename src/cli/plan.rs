//! `contact-dma plan`: what a sweep file would compute, and about what that costs.

use std::path::PathBuf;

use clap::Args;

use super::failure::{Ended, Failure};
use super::meant_for;
use super::memory::free_here;
use super::output::{OutputFormat, tell};
use crate::figures::paper::drawing_bytes;
use crate::input::sweep_file;
use crate::report::forecast;
use crate::sweep::case::Setup;
use crate::sweep::share::cost::Cost;

#[derive(Debug, Args)]
pub(super) struct PlanFlags {
    /// The sweep file (TOML); - reads standard input, from which paths start in the working folder
    file: PathBuf,
    /// Change one key of the sweep file; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Choose steps and nodes so that the relative error of every loss is below this value; same as
    /// --set cycle.accuracy=X
    #[arg(long, value_name = "X")]
    accuracy: Option<f64>,
}

/// Runs the command.
pub(super) fn run(flags: &PlanFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let set = with_accuracy(&flags.set, flags.accuracy)?;
    let plan = sweep_file::plan(&meant_for::open(&meant_for::SWEEP, &flags.file, &set)?)?;
    show(&Setup::new(plan).map_err(Failure::input)?, format)
}

/// Changes of keys, with that of `--accuracy`.
///
/// # Errors
/// The accuracy is given by both.
pub(super) fn with_accuracy(set: &[String], accuracy: Option<f64>) -> Result<Vec<String>, Failure> {
    let is_accuracy = |set: &String| set.trim_start().starts_with("cycle.accuracy=");
    if accuracy.is_some() && set.iter().any(is_accuracy) {
        let both = "--accuracy X is --set cycle.accuracy=X: give one of the two";
        return Err(Failure::input(both));
    }
    let accuracy = accuracy.map(|a| format!("cycle.accuracy={a:?}"));
    Ok(set.iter().cloned().chain(accuracy).collect())
}

/// Prints cases and cost of a sweep.
pub(super) fn show(setup: &Setup, format: OutputFormat) -> Result<Ended, Failure> {
    let cost = Cost::of(setup, drawing_bytes(&setup.plan().figures, 1)).map_err(Failure::input)?;
    let found = || Ok(forecast::of_sweep(setup, &cost));
    let text = || Ok(forecast::sweep_text(setup, &cost, &free_here()));
    tell(format, false, found, text)
}
