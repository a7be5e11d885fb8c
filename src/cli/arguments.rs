//! What can be typed: commands, flags, their help texts.

use std::ffi::OsStr;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::builder::{
    EnumValueParser, PathBufValueParser, PossibleValue, PossibleValuesParser, TypedValueParser,
};
use clap::{ArgAction, Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use crate::input::dynamic::{self, DynamicFormat};
use crate::input::keys::material::{MOST_BRANCHES, MOST_REPLICAS};
use crate::material::ModulusKind;
use crate::material::export::Program;
use crate::quantity::{Dimension, parse};

/// Dynamic mechanical analysis by contact: what a viscoelastic half-space dissipates under an oscillating indenter.
#[derive(Debug, Parser)]
#[command(name = "contact-dma", version, about, long_about = None, after_help = EXIT_CODES)]
#[command(max_term_width = 100)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
    /// Output format; json prints one object for other programs, also with --quiet
    #[arg(
        long, value_name = "FORMAT", default_value = "text", global = true, value_parser = AnyFormat,
        action = ArgAction::Append
    )]
    pub(super) format: Vec<FormatWord>,
}

impl Arguments {
    /// What to print at the end: the last that was asked for.
    pub(super) fn output_format(&self) -> OutputFormat {
        let output = |word: &FormatWord| match word {
            FormatWord::Output(format) => Some(*format),
            FormatWord::Data(_) => None,
        };
        let asked = self.format.iter().rev().find_map(output);
        asked.unwrap_or(OutputFormat::Text)
    }

    /// The format of the data that `--format` names.
    pub(super) fn data_format(&self) -> Option<DynamicFormat> {
        let data = |word: &FormatWord| match word {
            FormatWord::Output(_) => None,
            FormatWord::Data(format) => Some(*format),
        };
        self.format.iter().rev().find_map(data)
    }
}

/// What `--format` may name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FormatWord {
    /// What is printed.
    Output(OutputFormat),
    /// How data are written that are read: in `material fit` alone.
    Data(DynamicFormat),
}

/// Reads a [`FormatWord`].
#[derive(Debug, Clone, Copy)]
struct AnyFormat;

impl TypedValueParser for AnyFormat {
    type Value = FormatWord;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<FormatWord, clap::Error> {
        let data = value.to_str().and_then(dynamic_format);
        match data.filter(|_| command.get_name() == "fit") {
            Some(format) => Ok(FormatWord::Data(format)),
            None => EnumValueParser::new()
                .parse_ref(command, argument, value)
                .map(FormatWord::Output),
        }
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let values = OutputFormat::value_variants().iter();
        Some(Box::new(values.filter_map(ValueEnum::to_possible_value)))
    }
}

/// The format of dynamic data of this name.
fn dynamic_format(name: &str) -> Option<DynamicFormat> {
    let found = dynamic::FORMATS.iter().find(|(word, _)| *word == name);
    found.map(|(_, format)| *format)
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
pub(super) enum Command {
    /// Compute energy loss, phase, moduli, radius and pressure of the stabilised cycle over frequency and up to four other axes
    Sweep(super::sweep::SweepFlags),
    /// Print the cases of a sweep file and their approximate cost, without computing them
    Plan(super::plan::PlanFlags),
    /// Join the shards of a sweep that have folders of their own
    Merge(super::stored::MergeFlags),
    /// Redraw tables and figures from stored records, without solving
    Report(super::stored::ReportFlags),
    /// Compare two results of a sweep and report where they differ
    Compare(super::compare::CompareFlags),
    /// Read frequency, drift, loss, phase, harmonics and moduli from measured loops, with 95 % intervals
    Analyse(super::analyse::AnalyseFlags),
    /// Follow one drive history: load or approach against time, from a scenario file, with profiles and fields
    Simulate(super::simulate::SimulateFlags),
    /// Find the material from measured cycles, creep or relaxation: moduli and times with confidence bands
    Identify(super::identify::IdentifyFlags),
    /// Recompute the figures of the base paper and compare every number with its exact value
    Reproduce(super::reproduce::ReproduceFlags),
    /// Show, fit and export materials: series, moduli over frequency, sources
    #[command(subcommand)]
    Material(MaterialCommand),
    /// Print the JSON Schema of sweep, scenario or setup files, with which editors complete and check them
    Schema(super::schema::SchemaFlags),
    /// Write anew what the repository repeats of the tables of keys and columns and of the commands
    #[command(hide = true)]
    Renew(super::renew::RenewFlags),
    /// Print a completion script for a shell
    #[command(after_help = "\
Example:
  contact-dma completions bash > ~/.local/share/bash-completion/completions/contact-dma")]
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// What a command prints at its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum OutputFormat {
    /// Tables and sentences, to be read
    Text,
    /// For other programs
    Json,
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
SVG, PNG and CSV, and index.html, one page of everything.")]
    Show(ShowFlags),
    /// Fit a series to measured creep compliance or relaxation modulus, or to storage and loss modulus over frequency and temperature
    #[command(after_help = "\
Examples:
  contact-dma material fit creep.csv --quantity creep --modulus shear --poisson-ratio 0.38
  contact-dma material fit stress.csv --quantity relaxation --modulus longitudinal \\
      --poisson-ratio 0.38 --out reports/fit
  contact-dma material fit dma.csv --quantity dynamic --modulus longitudinal \\
      --poisson-ratio 0.35 --reference-temperature '25 °C' --out reports/dma

A table of creep or relaxation is text: a line of column names, then rows. Columns: time_s, and
creep_compliance_per_pa or relaxation_modulus_pa, or in other units, as in time_min,
`Creep compliance [1/GPa]`, `J(t) (1/GPa)`, or with a row of units. Commas, semicolons, tabs or blanks
separate cells; numbers may have decimal commas where commas do not. Rows without a number are
passed over and counted. The command prints the misfit, what had to be assumed, the branches, and
a [material] block to paste into a sweep file. The same fit is made where a sweep file names the
table:

  [material.table]
  file = \"creep.csv\"          # from the folder of the sweep file
  quantity = \"creep\"
  modulus = \"shear\"

With --out, that block, the series as prony.csv, figures of data, fit and difference, and
index.html are written.

Dynamic data are one file or several of one specimen, tables with named columns or exports of
instruments; the format is found, or named by --data-format (`--format pyvisco` says the same).
Isotherms are shifted to one temperature, which gives shift.csv and master.csv, and summary.json
has every number of the fit.")]
    Fit(FitFlags),
    /// Write a material as input of a finite element program
    #[command(after_help = "\
Examples:
  contact-dma material export pmma --to abaqus
  contact-dma material export reports/fit/material.toml --to ansys --out rubber.mac
  contact-dma material export sweeps/pmma.toml --to csv --out prony.csv

The Prony series, and the WLF shift where the material knows one, in the normalisation and syntax
of the program, in SI units. Comments say what constant Poisson ratio means there, and how far E*
of the printed digits is from that of the material.")]
    Export(ExportFlags),
}

#[derive(Debug, Args)]
pub(super) struct ExportFlags {
    /// A name of the library, or a file with a [material] block; - reads standard input
    pub(super) material: String,
    /// The program
    #[arg(long = "to", value_name = "PROGRAM", value_parser = program())]
    pub(super) program: Program,
    /// The file to write; links are followed, and devices and pipes written to [default: standard output]
    #[arg(long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    /// Replace a file that this command has not written
    #[arg(long, requires = "out")]
    pub(super) force: bool,
}

/// One of the programs that a material is written for.
fn program() -> impl TypedValueParser<Value = Program> {
    named(Program::ALL.map(|program| {
        let help = match program {
            Program::Abaqus => "*ELASTIC, *VISCOELASTIC, TIME=PRONY, *TRS",
            Program::Ansys => "TB,PRONY in shear and bulk, TB,SHIFT",
            Program::LsDyna => "*MAT_GENERAL_VISCOELASTIC (076)",
            Program::Comsol => "Table of branches of the Viscoelasticity node",
            Program::Csv => "Columns modulus_pa, time_s; the equilibrium modulus first",
        };
        (program, program.name(), help)
    }))
}

#[derive(Debug, Args)]
pub(super) struct FitFlags {
    /// The table (CSV); files of dynamic data
    #[arg(required = true, value_name = "FILE")]
    pub(super) data: Vec<PathBuf>,
    /// What the table holds
    #[arg(long, value_name = "QUANTITY")]
    pub(super) quantity: FitQuantity,
    /// Which modulus, or which modulus the compliance belongs to
    #[arg(long, value_name = "KIND", value_parser = modulus())]
    pub(super) modulus: ModulusKind,
    /// Poisson ratio of the material; dynamic data are fitted without one too, and the block then says where it is to be written
    #[arg(
        long, value_name = "NU", allow_negative_numbers = true,
        required_if_eq_any([("quantity", "creep"), ("quantity", "relaxation")])
    )]
    pub(super) poisson_ratio: Option<f64>,
    /// Whether the material flows without end; without this flag the data decide
    #[arg(long, value_name = "true|false")]
    pub(super) flow: Option<bool>,
    #[command(flatten)]
    pub(super) dynamic: DynamicFlags,
    /// Folder for the material block, figures and their data
    #[arg(long, value_name = "DIR", value_parser = folder())]
    pub(super) out: Option<PathBuf>,
    /// Replace another result in the output folder, or add to a folder that has files of others, of which none is touched
    #[arg(long, requires = "out")]
    pub(super) force: bool,
}

/// What is made of dynamic data, and how.
#[derive(Debug, Default, Args, PartialEq)]
#[command(next_help_heading = "Dynamic data")]
pub(super) struct DynamicFlags {
    /// Temperature of the master curve, for example '25 °C' [default: that of the middle isotherm]
    #[arg(long, value_name = "T", value_parser = temperature, allow_hyphen_values = true)]
    pub(super) reference_temperature: Option<f64>,
    /// How isotherms are shifted: free, each for itself; wlf or arrhenius, by a law; none; or a file of shift factors
    /// (temperature_c,log10_a_t) [default: free]
    #[arg(long, value_name = "free|wlf|arrhenius|none|FILE")]
    pub(super) shift: Option<PathBuf>,
    /// Shift isotherms along the moduli too
    #[arg(long)]
    pub(super) vertical_shift: bool,
    /// Number of branches [default: auto, as many as the data resolve]
    #[arg(long, value_name = "auto|N", value_parser = branches)]
    pub(super) branches: Option<Branches>,
    /// Replicas of the series that carry the noise of the data on [default: 0]
    #[arg(long, value_name = "N", value_parser = replicas)]
    pub(super) replicas: Option<usize>,
    /// Format of the files [default: found from what they hold]
    #[arg(long, value_name = "FORMAT", value_parser = data_format())]
    pub(super) data_format: Option<DynamicFormat>,
}

/// Branches of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Branches {
    Auto,
    Number(NonZeroUsize),
}

fn branches(text: &str) -> Result<Branches, String> {
    let number = text
        .parse()
        .ok()
        .filter(|number: &NonZeroUsize| number.get() <= MOST_BRANCHES);
    match (text, number) {
        ("auto", _) => Ok(Branches::Auto),
        (_, Some(number)) => Ok(Branches::Number(number)),
        _ => Err(format!(
            "`{text}` is no number of branches: write auto, or a whole number from 1 to {MOST_BRANCHES}"
        )),
    }
}

fn replicas(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|number| *number <= MOST_REPLICAS);
    number.ok_or_else(|| {
        format!("`{text}` is no number of replicas: write a whole number from 0 to {MOST_REPLICAS}")
    })
}

fn temperature(text: &str) -> Result<f64, String> {
    let bare: Result<f64, _> = text.trim().parse();
    if bare.is_ok() {
        return Err(format!(
            "`{text}` has no unit: write '{text} °C' or '{text} K'"
        ));
    }
    let temperature_k = parse(text, Dimension::Temperature).map_err(|error| error.to_string())?;
    match temperature_k > 0.0 {
        true => Ok(temperature_k),
        false => Err(format!(
            "`{text}` is not above absolute zero: write a temperature above -273.15 °C"
        )),
    }
}

fn data_format() -> impl TypedValueParser<Value = DynamicFormat> {
    let names = dynamic::FORMATS.iter().map(|(name, _)| *name);
    PossibleValuesParser::new(names)
        .try_map(|name| dynamic_format(&name).ok_or("this is no format of dynamic data"))
}

/// What a file of measured data holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum FitQuantity {
    /// Creep compliance
    Creep,
    /// Relaxation modulus
    Relaxation,
    /// Storage and loss modulus over frequency, at one temperature or at several
    Dynamic,
}

fn modulus() -> impl TypedValueParser<Value = ModulusKind> {
    named([ModulusKind::Longitudinal, ModulusKind::Shear].map(|kind| {
        let help = match kind {
            ModulusKind::Longitudinal => "Uniaxial: E, D",
            ModulusKind::Shear => "Shear: G, J",
        };
        (kind, kind.name(), help)
    }))
}

/// One of these values, by its name and with its help.
fn named<T: Copy + Send + Sync + 'static, const N: usize>(
    values: [(T, &'static str, &'static str); N],
) -> impl TypedValueParser<Value = T> {
    let possible = values.map(|(_, name, help)| PossibleValue::new(name).help(help));
    PossibleValuesParser::new(possible).try_map(move |found| {
        let value = values.iter().find(|(_, name, _)| *name == found);
        value
            .map(|(value, ..)| *value)
            .ok_or("not one of the values")
    })
}

#[derive(Debug, Args)]
pub(super) struct ShowFlags {
    /// A name of the library, or a file with a [material] block; - reads standard input
    pub(super) material: String,
    /// Folder for figures and their data
    #[arg(long, value_name = "DIR", value_parser = folder())]
    pub(super) out: Option<PathBuf>,
    /// Replace another result in the output folder, or add to a folder that has files of others, of which none is touched
    #[arg(long, requires = "out")]
    pub(super) force: bool,
}

/// A folder for results, which need not be there.
pub(super) fn folder() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.is_file() {
        true => Err("this is a file; name a folder, which is made where there is none"),
        false => Ok(path),
    })
}

/// A number of threads.
pub(super) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let number = text.trim().parse().ok();
    number
        .ok_or_else(|| format!("`{text}` is no number of threads: write a whole number from 1 on"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_a_whole_number_from_one_on() {
        assert_eq!(threads(" 4 ").map(NonZeroUsize::get), Ok(4));
        for wrong in ["0", "-1", "1.5", "all", ""] {
            let message = threads(wrong).unwrap_err();
            assert!(message.contains("from 1 on"), "{message}");
        }
    }
}
