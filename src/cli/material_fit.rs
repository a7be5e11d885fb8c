//! `contact-dma material fit`: from a table of measured data to a material block.

use super::arguments::{FitFlags, OutputFormat};
use super::{Ended, Failure, json, print};
use crate::input::table_file;
use crate::material::Material;
use crate::material::fit;
use crate::report::caption::Setting;
use crate::report::figure::press::Press;
use crate::report::page::{self, Pictures, material::About};
use crate::report::{self, figure};
use crate::sweep::figures::figure_plan::FigurePlan;
use crate::sweep::plan::resolved;
use crate::sweep::store::write_atomically;

/// Runs the command.
pub(super) fn run(flags: &FitFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let table = table_file::read(&flags.data, flags.quantity.into(), flags.modulus.into())?;
    let fit = fit::fit(&table, flags.flow).map_err(Failure::input)?;
    let material = fit.material(flags.poisson_ratio).map_err(Failure::input)?;
    let block = block(flags, &material);
    match format {
        OutputFormat::Json => json::print(&json::fit(&fit, &material)?)?,
        OutputFormat::Text => print(&format!(
            "{}\n{}\n{block}",
            report::fit::text(fit.report()),
            report::fit::branches(&fit)
        ))?,
    };
    let Some(folder) = &flags.out else {
        return Ok(Ended::Done);
    };
    let figures = figure::fit::figures(&table, &fit);
    let pictures = Pictures::default();
    let write = |name: &str, bytes: &[u8]| write_atomically(&folder.join(name), bytes);
    write("material.toml", block.as_bytes()).map_err(Failure::run)?;
    let press = Press {
        plan: &FigurePlan::default(),
        write: &write,
        pictures: &pictures,
    };
    let drawn = press.figures(&figures, &Setting::of_material(&material));
    drawn.map_err(Failure::run)?;
    if let Some(figure) = figures.first() {
        let name = flags.data.file_name().unwrap_or_default();
        let about = About {
            title: &format!("Fit to {}", name.display()),
            text: &report::fit::text(fit.report()),
            block: &block,
            pictures: &pictures,
            figure: figure.name,
            fit: Some((&table, &fit)),
        };
        let page = page::material::page(&material, &about).map_err(Failure::run)?;
        write("index.html", page.as_bytes()).map_err(Failure::run)?;
    }
    match format {
        OutputFormat::Json => Ok(Ended::Done),
        OutputFormat::Text => print(&format!("\nMaterial and figures in {}\n", folder.display())),
    }
}

/// The material block of a sweep file, ready to paste, every number exact.
fn block(flags: &FitFlags, material: &Material) -> String {
    let comments: String = material.fit().map_or_else(String::new, |report| {
        let report = report::fit::text(report);
        report.lines().map(|line| format!("# {line}\n")).collect()
    });
    format!(
        "# From {}\n{comments}{}",
        flags.data.display().to_string().escape_debug(),
        resolved::material_text(material)
    )
}
