//! The commands: what can be typed, and which function runs it.

use clap::{CommandFactory, Parser, Subcommand};
use clap_complete::Shell;

use super::failure::{Ended, Failure};
use super::output::{OutputFormat, write_out};
use super::{
    analyse, cite, compare, identify, man, material, merge, plan, renew, report, reproduce, schema,
    simulate, sweep,
};

/// Dynamic mechanical analysis by contact: what a viscoelastic half-space dissipates under an oscillating indenter.
#[derive(Debug, Parser)]
#[command(name = "contact-dma", version, about, long_about = None, after_help = EXIT_CODES)]
#[command(max_term_width = 100)]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Output format; json prints one object for other programs, also with --quiet
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        global = true,
        overrides_with = "format"
    )]
    format: OutputFormat,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  1  could not run
  2  bad usage or bad input
  3  done, but some cases have no result (they are named, and absent from the curve)
  4  the results compared differ by more than the tolerances
  130  interrupted; what was finished is kept";

#[derive(Debug, Subcommand)]
enum Command {
    /// Compute energy loss, phase, moduli, radius and pressure of the stabilised cycle over frequency and up to four other axes
    Sweep(sweep::SweepFlags),
    /// Print the cases of a sweep file and their approximate cost
    Plan(plan::PlanFlags),
    /// Join the shards of a sweep that have folders of their own
    Merge(merge::MergeFlags),
    /// Redraw tables and figures of a folder of results, without solving
    Report(report::ReportFlags),
    /// Compare two results of a sweep and report where they differ
    Compare(compare::CompareFlags),
    /// Read frequency, drift, loss, phase, harmonics and moduli from measured loops, with 95 % intervals
    Analyse(analyse::AnalyseFlags),
    /// Follow one drive history, load or approach against time
    Simulate(simulate::SimulateFlags),
    /// Find the material from measured cycles, creep, relaxation or force curves: moduli and times with confidence bands
    Identify(identify::IdentifyFlags),
    /// Recompute the figures of the base paper and compare every number with its exact value
    Reproduce(reproduce::ReproduceFlags),
    /// Show, fit and export materials: series, moduli over frequency, sources
    #[command(subcommand)]
    Material(material::MaterialCommand),
    /// Print the JSON Schema by which editors complete and check input files
    Schema(schema::SchemaFlags),
    /// Print what to cite for a result: the program, the paper, methods, sources of materials
    Cite(cite::CiteFlags),
    /// Write anew what the repository repeats of the tables of keys and columns and of the commands
    #[command(hide = true)]
    Renew(renew::RenewFlags),
    /// Print a completion script for a shell
    #[command(after_help = "\
Example:
  contact-dma completions bash > ~/.local/share/bash-completion/completions/contact-dma")]
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Write a manual page for every command
    #[command(after_help = "\
Example:
  contact-dma man ~/.local/share/man/man1")]
    Man(man::ManFlags),
}

impl Arguments {
    /// The command line without what the help hides.
    fn shown() -> clap::Command {
        let all = Self::command();
        let shown = all.get_subcommands().filter(|inner| !inner.is_hide_set());
        clap::Command::new("contact-dma")
            .version(env!("CARGO_PKG_VERSION"))
            .about(all.get_about().cloned().unwrap_or_default())
            .after_help(EXIT_CODES)
            .args(all.get_arguments().cloned())
            .subcommands(shown.cloned())
    }

    /// Runs the command.
    pub(super) fn run(self) -> Result<Ended, Failure> {
        let format = self.format;
        match self.command {
            Command::Sweep(flags) => sweep::run(&flags, format),
            Command::Plan(flags) => plan::run(&flags, format),
            Command::Merge(flags) => merge::run(&flags, format),
            Command::Report(flags) => report::run(&flags, format),
            Command::Analyse(flags) => analyse::run(&flags, format),
            Command::Compare(flags) => compare::run(&flags, format),
            Command::Simulate(flags) => simulate::run(&flags, format),
            Command::Identify(flags) => identify::run(&flags, format),
            Command::Reproduce(flags) => reproduce::run(&flags, format),
            Command::Schema(flags) => schema::run(&flags),
            Command::Renew(flags) => renew::run(&flags, &Self::shown()),
            Command::Cite(flags) => cite::run(&flags, format),
            Command::Man(flags) => man::run(&flags, Self::shown()),
            Command::Material(command) => material::run(&command, format),
            Command::Completions { shell } => {
                let mut text = Vec::new();
                clap_complete::generate(shell, &mut Self::shown(), "contact-dma", &mut text);
                write_out(&String::from_utf8_lossy(&text))
            }
        }
    }
}
