//! `contact-dma material show` and `list`: the library, and one material in full.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::documents::{STANDARD_INPUT, read_document};
use super::failure::{Ended, Failure};
use super::flags::OutFlags;
use super::folders::{in_folder, write_result};
use super::output::{OutputFormat, tell};
use crate::input::diagnostic::Problems;
use crate::input::material_block;
use crate::input::material_table::DirectSum;
use crate::material::fit::FitReport;
use crate::material::{Material, library};
use crate::report::caption::Setting;
use crate::report::page::{self, material::About};
use crate::report::text::Text;
use crate::report::{self, material::MaterialReport};
use crate::sweep::plan::resolved;
use crate::sweep::store::manifest::Kind;

#[derive(Debug, Args)]
pub(super) struct ShowFlags {
    /// A name of the library, or a file with a [material] block; - reads standard input
    material: String,
    #[command(flatten)]
    to: OutFlags,
}

/// Lists the library.
pub(super) fn list(format: OutputFormat) -> Result<Ended, Failure> {
    let found = || Ok(json!({ "materials": library::entries() }));
    tell(format, false, found, || {
        let mut text = Text::default();
        for entry in library::entries() {
            text.line(format!("{}    {}", entry.name, entry.title));
            text.append(about(entry));
        }
        Ok(text)
    })
}

/// Shows a material.
pub(super) fn run(flags: &ShowFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let (material, (title, head), reads) = load(&flags.material)?;
    let target = flags.to.target(Kind::Material, &reads)?;
    let report = MaterialReport::new(&material);
    if let Some(target) = &target {
        let setting = Setting::of_material(&material);
        let drawn = (&report.figures()[..], &setting, true);
        let nothing_else: [(&str, _); 0] = [];
        write_result(target, nothing_else, drawn, |pictures, figure| {
            let about = About {
                title: material.name().unwrap_or("Material"),
                text: &head.to_string(),
                block: &resolved::material_text(&material),
                pictures,
                figure,
                fit: None,
            };
            page::material::page(&material, &about)
        })?;
    }
    let found = || to_json(&material);
    tell(format, false, found, || {
        let mut text = Text::from(format!("{title}\n"));
        text.append(head.clone());
        text.append(report.text().map_err(Failure::input)?);
        text.append(in_folder("Figures", target.as_ref()));
        Ok(text)
    })
}

/// A material, its title with what is to be said of it, and the files that were read.
type Loaded = (Material, (String, Text), Vec<PathBuf>);

/// A material by name or from a file.
pub(super) fn load(name: &str) -> Result<Loaded, Failure> {
    if let Some(entry) = library::find(name) {
        let material = entry.material().map_err(Failure::run)?;
        let head = (entry.title.to_owned(), about(entry));
        return Ok((material, head, Vec::new()));
    }
    let path = Path::new(name);
    if !path.exists() && name != STANDARD_INPUT {
        let near = library::suggest(name).map(|near| format!("; did you mean \"{near}\"?"));
        return Err(Failure::input(format!(
            "no material \"{name}\" in the library, and no file of that name{}\nThe library has {}.",
            near.unwrap_or_default(),
            library::names()
        )));
    }
    let document = read_document(path)?;
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let material = material_block::read(&mut root, DirectSum::Fitted);
    let material = problems.into_result(material)?.value;
    let title = format!("{} (from {name})", material.name().unwrap_or("Material"));
    let head = report::fit::origin(&material);
    Ok((material, (title, head), document.files()))
}

/// What the library says of a material, set in by four.
fn about(entry: &library::LibraryEntry) -> Text {
    let mut text = Text::default();
    text.indented(entry.notes, "    ", "    ");
    text.indented(format!("Source: {}", entry.source), "    ", "    ");
    text
}

/// A material: its series both ways, moduli over frequency, peaks of its losses, its fit where it has one.
pub(super) fn to_json(material: &Material) -> Result<Value, Failure> {
    let peaks = material.loss_peaks(material.kind());
    Ok(json!({
        "name": material.name(),
        "poisson_ratio": material.poisson_ratio(),
        "bulk_modulus_pa": material.compressibility().constant_bulk_modulus_pa(),
        "modulus": material.kind().name(),
        "relaxation": material.relaxation(),
        "creep": material.creep(),
        "moduli": MaterialReport::new(material).moduli(10),
        "peaks": peaks.map_err(Failure::input)?,
        "fit": material.origin.fit.as_ref().map(fit_json),
        "approximation": material.origin.approximation.as_ref(),
        "material_toml": resolved::material_text(material),
    }))
}

/// How well a series fits its table.
pub(super) fn fit_json(report: &FitReport) -> Value {
    let remarks = report
        .remarks
        .iter()
        .map(|remark| json!({ "text": remark.to_string(), "is_warning": remark.is_warning() }));
    json!({
        "samples": report.samples,
        "first_s": report.first_s,
        "last_s": report.last_s,
        "branches": report.branches,
        "relative_misfit": report.misfit,
        "remarks": remarks.collect::<Vec<_>>(),
    })
}
