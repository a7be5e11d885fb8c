//! `contact-dma material fit`: from a table of measured data to a material block.

use std::path::Path;

use super::arguments::{DynamicFlags, FitFlags, FitQuantity, OutputFormat};
use super::material::{commented, draw, print_place};
use super::{Ended, Failure, json, material_fit_dynamic, print};
use crate::input::dynamic::DynamicFormat;
use crate::input::table_file;
use crate::material::fit;
use crate::material::{Material, MaterialFunction};
use crate::report::caption::Setting;
use crate::report::dynamic::tables;
use crate::report::figure::press::Files;
use crate::report::page::{self, material::About};
use crate::report::text::Text;
use crate::report::{self, figure};
use crate::sweep::plan::resolved;
use crate::sweep::store::manifest::{Kind, Target};

/// Runs the command; `data_format` is what `--format` says of the data.
pub(super) fn run(
    flags: &FitFlags,
    format: OutputFormat,
    data_format: Option<DynamicFormat>,
) -> Result<Ended, Failure> {
    let function = match flags.quantity {
        FitQuantity::Dynamic => return material_fit_dynamic::run(flags, format, data_format),
        FitQuantity::Creep => MaterialFunction::Creep,
        FitQuantity::Relaxation => MaterialFunction::Relaxation,
    };
    if flags.dynamic != DynamicFlags::default() || data_format.is_some() {
        return Err(Failure::input(
            "--reference-temperature, --shift, --vertical-shift, --branches, --replicas and --data-format are for --quantity dynamic",
        ));
    }
    let ([data], Some(poisson_ratio)) = (&flags.data[..], flags.poisson_ratio) else {
        return Err(Failure::input(
            "creep and relaxation are fitted to one table: name one file, and --poisson-ratio",
        ));
    };
    fit_table(flags, (data, function, poisson_ratio), format)
}

/// The folder of a fit, where one is asked for.
pub(super) fn target(flags: &FitFlags) -> Option<Target<'_>> {
    flags.out.as_deref().map(|folder| Target {
        folder,
        kind: Kind::MaterialFit,
        force: flags.force,
        reads: &flags.data,
    })
}

/// A creep compliance or relaxation modulus over time.
fn fit_table(
    flags: &FitFlags,
    (data, function, poisson_ratio): (&Path, MaterialFunction, f64),
    format: OutputFormat,
) -> Result<Ended, Failure> {
    let target = target(flags);
    target.map_or(Ok(()), |target| target.check())?;
    let table = table_file::read(data, function, flags.modulus)?;
    let fit = fit::fit(&table, flags.flow).map_err(Failure::input)?;
    let material = fit.material(poisson_ratio).map_err(Failure::input)?;
    let block = block(data, &material);
    match format {
        OutputFormat::Json => json::print(&json::fit(&fit, &material)?)?,
        OutputFormat::Text => {
            let mut text = report::fit::text(fit.report());
            text.append_apart(report::fit::branches(&fit));
            print_block(flags, text, &block)?
        }
    };
    let Some(target) = target else {
        return Ok(Ended::Done);
    };
    let files = Files::default();
    files.insert("material.toml", block.clone());
    if let Some(series) = material.relaxation() {
        files.insert("prony.csv", tables::prony(series));
    }
    let figures = figure::fit::figures(&table, &fit);
    let setting = Setting::of_material(&material);
    draw(&files, &figures, &setting, |pictures, figure| {
        let name = data.file_name().unwrap_or_default();
        let about = About {
            title: &format!("Fit to {}", name.display()),
            text: &report::fit::text(fit.report()).to_string(),
            block: &block,
            pictures,
            figure,
            fit: Some((&table, &fit)),
        };
        page::material::page(&material, &about)
    })?;
    target.write(files.into_vec())?;
    print_place("Material and figures", target.folder, format)
}

/// Prints a fit, with the block to paste where that does not go into a file.
pub(super) fn print_block(flags: &FitFlags, mut text: Text, block: &str) -> Result<Ended, Failure> {
    if flags.out.is_none() {
        text.blank();
        text.append(block);
    }
    print(&text)
}

/// The material block of a sweep file, ready to paste, every number exact.
fn block(data: &Path, material: &Material) -> String {
    let fit = report::fit::fitted(material).unwrap_or_default();
    format!(
        "# From {}\n{}{}",
        data.display().to_string().escape_debug(),
        commented(&fit),
        resolved::material_text(material)
    )
}
