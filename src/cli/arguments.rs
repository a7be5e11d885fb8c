//! What can be typed: commands, flags, their help texts.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;

/// Dynamic mechanical analysis by contact: what a viscoelastic half-space dissipates under an oscillating indenter.
#[derive(Debug, Parser)]
#[command(name = "contact-dma", version, about, long_about = None, after_help = EXIT_CODES)]
#[command(max_term_width = 100)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  1  could not run
  2  bad usage or bad input
  3  done, but some cases have no result (they are named, and absent from the curve)
  130  interrupted; what was finished is kept";

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Compute the energy loss per cycle over the load frequencies of a sweep file
    Sweep(SweepFlags),
    /// Look at materials: their series, moduli over frequency, sources
    #[command(subcommand)]
    Material(MaterialCommand),
    /// Print a completion script for a shell
    #[command(after_help = "\
Example:
  contact-dma completions bash > ~/.local/share/bash-completion/completions/contact-dma")]
    Completions {
        /// The shell
        shell: Shell,
    },
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  contact-dma sweep sweeps/pmma.toml
  contact-dma sweep sweeps/pmma.toml --set indenter.radius='5 mm' --out reports/small
  contact-dma sweep sweeps/pmma.toml --set solver.engine=half-space --threads 2

Written to the output folder: sweep.csv (one row per frequency), loops/ (the stabilised
cycles), summary.json (peaks, counts), energy-loss and loops as SVG and PNG with their data
as CSV, records/ (everything, for later), resolved.toml (the sweep with every default).")]
pub(super) struct SweepFlags {
    /// The sweep file (TOML)
    pub(super) file: PathBuf,
    /// Folder for the results [default: reports/<name of the file>]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Number of threads [default: one per processor]; the results do not depend on it
    #[arg(long, value_name = "N", env = "CONTACT_DMA_THREADS")]
    pub(super) threads: Option<std::num::NonZeroUsize>,
    /// Change one key of the sweep file, for example drive.amplitude='2 N'; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
    /// Replace the results of a different sweep in the output folder
    #[arg(long)]
    pub(super) force: bool,
    /// Print nothing but errors
    #[arg(long, short)]
    pub(super) quiet: bool,
}

#[derive(Debug, Subcommand)]
pub(super) enum MaterialCommand {
    /// List the materials of the library
    List,
    /// Print a material: series both ways, moduli over frequency, peaks, source
    #[command(after_help = "\
Examples:
  contact-dma material show pmma
  contact-dma material show pmma --out reports/material-pmma
  contact-dma material show sweeps/pmma.toml

With --out, the moduli over frequency and the relaxation modulus over time are written as
SVG, PNG and CSV.")]
    Show(ShowFlags),
}

#[derive(Debug, Args)]
pub(super) struct ShowFlags {
    /// A name of the library, or a file with a [material] block
    pub(super) material: String,
    /// Folder for figures and their data
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
}
