//! `contact-dma material`: the library, one material in full, fits, and other programs.

use clap::Subcommand;

use super::failure::{Ended, Failure};
use super::material_export::{self, ExportFlags};
use super::material_fit::{self, FitFlags, FitQuantity};
use super::material_fit_dynamic;
use super::material_show::{self, ShowFlags};
use super::output::OutputFormat;
use crate::material::MaterialFunction;

#[derive(Debug, Subcommand)]
pub(super) enum MaterialCommand {
    /// List the materials of the library
    List,
    /// Print a material: series both ways, moduli over frequency, peaks, source
    #[command(after_help = "\
Examples:
  contact-dma material show pmma
  contact-dma material show pmma --out reports/material-pmma
  contact-dma material show sweeps/pmma.toml")]
    Show(ShowFlags),
    /// Fit a series to measured creep or relaxation, or to storage and loss modulus over frequency and temperature
    #[command(after_help = "\
Examples:
  contact-dma material fit creep.csv --quantity creep --modulus shear --poisson-ratio 0.38
  contact-dma material fit stress.csv --quantity relaxation --modulus longitudinal \\
      --poisson-ratio 0.38 --out reports/fit
  contact-dma material fit dma.csv --quantity dynamic --modulus longitudinal \\
      --poisson-ratio 0.35 --reference-temperature '25 °C' --out reports/dma

A table of creep or relaxation is text: column names, then rows. Columns are time_s and
creep_compliance_per_pa or relaxation_modulus_pa, or in other units, as in time_min,
`Creep compliance [1/GPa]`, `J(t) (1/GPa)`, or with a row of units. Dynamic data are one file or
several of one specimen, tables with named columns or exports of instruments.

The command prints the misfit, what had to be assumed, the branches, and a [material] block to
paste into a sweep file.")]
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

/// Runs one of the subcommands.
pub(super) fn run(command: &MaterialCommand, format: OutputFormat) -> Result<Ended, Failure> {
    match command {
        MaterialCommand::List => material_show::list(format),
        MaterialCommand::Show(flags) => material_show::run(flags, format),
        MaterialCommand::Fit(flags) => match flags.quantity {
            FitQuantity::Dynamic => material_fit_dynamic::run(flags, format),
            FitQuantity::Creep => material_fit::run(flags, MaterialFunction::Creep, format),
            FitQuantity::Relaxation => {
                material_fit::run(flags, MaterialFunction::Relaxation, format)
            }
        },
        MaterialCommand::Export(flags) => material_export::run(flags, format),
    }
}
