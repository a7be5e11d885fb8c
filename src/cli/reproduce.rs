//! `contact-dma reproduce`: the computed figures of the base paper, from the files that are built into the program.

use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::{Ended, Failure};
use super::flags::{WorkFlags, folder};
use super::folders::figure_plan;
use super::interruption;
use super::output::{OutputFormat, tell};
use super::progress::line;
use crate::input::document::Document;
use crate::input::{scenario_file, sweep_file};
use crate::report::machine::object;
use crate::report::table::Cell;
use crate::report::text::Text;
use crate::reproduction::{
    self, FIGURES, Figure, Plans, ReproductionError, SCENARIOS, SWEEPS, Verdict,
};
use crate::sweep::store::manifest::{Kind, Target};

const DEFAULT_FOLDER: &str = "reports/spinu-2018";

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma reproduce
  contact-dma reproduce --figure 12 --figure 13 --out /tmp/two

The figures are those of S. Spinu, Advances in Tribology 2018, 9432894: 1 and 4 to 13. The folder
opens with index.html; claims.csv has every number as the paper states it, exact, and by both
engines.")]
pub(super) struct ReproduceFlags {
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = DEFAULT_FOLDER, value_parser = folder())]
    out: PathBuf,
    /// Make this figure alone; may be repeated
    #[arg(long = "figure", value_name = "N", value_parser = figure_number)]
    figures: Vec<u8>,
    /// Change how the figures look, for example figures.column=one, as the [figures] table of a
    /// sweep file does; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    work: WorkFlags,
}

/// The number of a figure that is computed.
fn figure_number(text: &str) -> Result<u8, String> {
    let number = text.trim().parse().ok();
    if let Some(number) = number.filter(|number| FIGURES.contains(number)) {
        return Ok(number);
    }
    let why = match number {
        Some(2 | 3) => "it is a flowchart; ",
        Some(_) => "the paper has figures 1 to 13; ",
        None => "",
    };
    let computed = FIGURES.map(|number| number.to_string()).join(", ");
    Err(format!("{why}the computed figures are {computed}"))
}

/// Runs the command.
pub(super) fn run(flags: &ReproduceFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let plans = plans()?;
    let figures = figure_plan("command line", "", &flags.set)?;
    let wanted = match &flags.figures[..] {
        [] => &FIGURES,
        some => some,
    };
    let target = Target {
        folder: &flags.out,
        kind: Kind::Reproduction,
        force: flags.work.force,
        reads: &[],
    };
    target.check()?;
    let threads = flags.work.threads();
    let interrupt = interruption::keep_finished();
    let finished = |number: u8| {
        if !flags.work.quiet {
            line(&format!("figure {number}"));
        }
    };
    let made = match reproduction::make(&plans, wanted, threads, &interrupt, &finished) {
        Err(ReproductionError::Interrupted) => return Ok(Ended::Interrupted),
        made => made.map_err(Failure::run)?,
    };
    target.write(reproduction::files(&made, &figures).map_err(Failure::run)?)?;
    let found = || {
        let (columns, claims) = reproduction::claims(&made);
        let row = |row: &Vec<Cell>| object(columns.iter().copied().zip(row.iter().cloned()));
        let numbers: Vec<u8> = made.iter().map(|figure| figure.number).collect();
        Ok(serde_json::json!({
            "figures": numbers,
            "claims": claims.iter().map(row).collect::<Vec<_>>(),
            "folder": flags.out.display().to_string(),
        }))
    };
    tell(format, flags.work.quiet, found, || {
        Ok(text(&made, &flags.out))
    })
}

/// The plans of the files built into the program.
fn plans() -> Result<Plans, Failure> {
    let mut plans = Plans::default();
    for (name, text) in SCENARIOS {
        let document = Document::parse(&format!("{name}.toml"), text)?;
        let plan = scenario_file::plan(&document)?;
        plans.scenarios.insert(name, plan);
    }
    for (name, text) in SWEEPS {
        let document = Document::parse(&format!("{name}.toml"), text)?;
        plans.sweeps.insert(name, sweep_file::plan(&document)?);
    }
    Ok(plans)
}

/// What is printed at the end.
fn text(made: &[Figure], folder: &Path) -> Text {
    let counted = format!("{} figures: {}", made.len(), reproduction::counted(made));
    let mut text = Text::default();
    text.paragraph(counted);
    for figure in made {
        let statements = figure.statements.iter();
        for statement in statements.filter(|s| s.verdict == Verdict::Disagrees) {
            let line = format!(
                "disagrees: figure {}, {}; the paper: {}",
                figure.number, statement.computed, statement.paper
            );
            text.indented(line, "  ", "    ");
        }
    }
    text.append(format!("\nResults in {}", folder.display()));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_computed_figures_can_be_asked_for() {
        for number in FIGURES {
            assert_eq!(figure_number(&number.to_string()), Ok(number));
        }
        for (wrong, why) in [
            ("2", "flowchart"),
            ("14", "1 to 13"),
            ("x", "computed"),
            ("-1", "computed"),
        ] {
            let message = figure_number(wrong).unwrap_err();
            assert!(message.contains(why), "{message}");
            assert!(message.contains("1, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13"));
        }
    }

    #[test]
    fn every_file_built_in_is_a_plan() {
        let plans = plans().unwrap_or_else(|_| panic!("a file is no plan"));
        assert_eq!((plans.scenarios.len(), plans.sweeps.len()), (12, 5));
    }
}
